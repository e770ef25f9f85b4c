//! Instances of the compiled library do not know of each other, and results do not depend on what a master reads.

use crate::slave::*;

#[test]
fn interleaved_instances_do_not_know_of_each_other() {
    let dll = load();
    let alone = Slave::ready(&dll).brake(0);
    let [a, b] = [Slave::ready(&dll), Slave::coarse(&dll)];
    assert_eq!(b.set_real("initial.velocity", 5.0), fmi2OK);
    b.initialize();
    let mut together = Vec::new();
    for i in 0..10 {
        assert_eq!(a.set_real("drive.moment", -200.0 * (1 + i % 7) as f64), fmi2OK);
        assert_eq!(b.set_real("drive.moment", 500.0), fmi2OK);
        assert_eq!(b.step(1e-3 * i as f64, 1e-3), fmi2OK);
        assert_eq!(a.step(1e-3 * i as f64, 1e-3), fmi2OK);
        together.push(a.outputs());
    }
    assert_eq!(together, alone);
}

#[test]
fn instances_on_several_threads_agree() {
    // Two kinds of instances, three of each, take their steps at the same time.
    let run = |velocity: f64| {
        let dll = load();
        let slave = Slave::coarse(&dll);
        assert_eq!(slave.set_real("initial.velocity", velocity), fmi2OK);
        slave.initialize();
        (0..3).map(|k| slave.brake(10 * k)).collect::<Vec<_>>()
    };
    let velocities = [20.0, 5.0, 20.0, 5.0, 20.0, 5.0];
    let alone = [20.0, 5.0].map(run);
    assert_ne!(alone[0], alone[1]);
    std::thread::scope(|scope| {
        let runs: Vec<_> = velocities.iter().map(|v| scope.spawn(|| run(*v))).collect();
        for (i, together) in runs.into_iter().enumerate() {
            assert_eq!(together.join().unwrap(), alone[i % 2]);
        }
    });
}

#[test]
fn results_do_not_depend_on_what_a_master_reads_saves_or_logs() {
    let dll = load();
    let quiet = Slave::ready(&dll);
    for i in 0..9 {
        assert_eq!(quiet.set_real("drive.moment", -200.0 * (1 + i % 7) as f64), fmi2OK);
        assert_eq!(quiet.step(1e-3 * i as f64, 1e-3), fmi2OK);
    }
    let unread = quiet.outputs();

    let curious = Slave::try_new(&dll, &Arguments { logging: 1, ..Default::default() }).ok().unwrap();
    curious.coarsen();
    assert_eq!(curious.enter(), fmi2OK);
    let stationary = curious.outputs();
    assert_eq!(curious.set_real("drive.load", 7e4), fmi2OK);
    assert_ne!(curious.outputs(), stationary);
    assert_eq!(curious.set_real("drive.load", real_start("drive.load")), fmi2OK);
    assert_eq!(curious.exit(), fmi2OK);
    assert_eq!(curious.outputs(), stationary);
    for i in 0..9 {
        assert_eq!(curious.set_real("drive.moment", 1e4), fmi2OK);
        assert_eq!(curious.set_real("drive.moment", -200.0 * (1 + i % 7) as f64), fmi2OK);
        let mut state = std::ptr::null_mut();
        assert_eq!(curious.save(&mut state), fmi2OK);
        assert_eq!(curious.step(1e-3 * i as f64, 1e-3), fmi2OK);
        assert_eq!(curious.outputs(), curious.outputs());
        assert_eq!(curious.set_logging(i % 2 == 0, &[]), fmi2OK);
    }
    assert_eq!(curious.outputs(), unread);
}
