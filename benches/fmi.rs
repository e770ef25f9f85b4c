//! Cost of the FMI layer alone, through the C functions of the shared library, on the default mesh.
//!
//! A refused step passes every check but the last and does no mechanics: it stands for what `fmi2DoStep` adds to a
//! step.

#[path = "../tests/slave/mod.rs"]
mod slave;

use criterion::{Criterion, criterion_group, criterion_main};
use slave::*;
use std::hint::black_box;
use std::ptr;
use std::time::Duration;
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Kind, Variable};

/// References of the first `count` real variables of a causality.
fn reals(causality: Causality, count: usize) -> Vec<u32> {
    let wanted = |v: &&Variable| v.causality() == causality && matches!(v.kind, Kind::Real { .. });
    variables().iter().filter(wanted).map(|v| v.reference).take(count).collect()
}

fn layer(c: &mut Criterion) {
    let dll = load();
    let slave = Slave::new(&dll);
    slave.initialize();
    for name in ["drive.moment", "drive.force", "drive.load", "rail.friction"] {
        assert_eq!(slave.set_real(name, slave.real(name)), fmi2OK);
    }
    assert_eq!(slave.step(0.0, 1e-3), fmi2OK);

    let (outputs, inputs, parameters) =
        (reals(Causality::Output, 50), reals(Causality::Input, 1), reals(Causality::Parameter, 1));
    c.bench_function("get 1 output", |b| b.iter(|| slave.get_reals(black_box(&outputs[..1])).expect("value")));
    c.bench_function("get 1 input", |b| b.iter(|| slave.get_reals(black_box(&inputs)).expect("value")));
    c.bench_function("get 1 parameter", |b| b.iter(|| slave.get_reals(black_box(&parameters)).expect("value")));
    c.bench_function("get 50 outputs", |b| b.iter(|| slave.get_reals(black_box(&outputs)).expect("values")));

    let moment = [variable("drive.moment").reference];
    c.bench_function("set 1 input", |b| b.iter(|| assert_eq!(slave.set_reals(&moment, &[black_box(-10.0)]), fmi2OK)));
    let (many, values) = ([moment[0]; 50], [-10.0; 50]);
    c.bench_function("set 50 inputs", |b| b.iter(|| assert_eq!(slave.set_reals(&many, black_box(&values)), fmi2OK)));

    assert_eq!(slave.set_rate("drive.load", 1, -1e12), fmi2OK);
    c.bench_function("refused step", |b| b.iter(|| assert_eq!(slave.step(black_box(1e-3), 1e-3), fmi2Error)));
    slave.explained(&["at the end of the step", "drive.load"]);
    assert_eq!(slave.set_real("drive.load", real_start("drive.load")), fmi2OK);

    let mut state = ptr::null_mut();
    assert_eq!(slave.save(&mut state), fmi2OK);
    c.bench_function("get state", |b| b.iter(|| assert_eq!(slave.save(&mut state), fmi2OK)));
    c.bench_function("set state", |b| b.iter(|| assert_eq!(slave.restore(state), fmi2OK)));
    let bytes = slave.serialize(state);
    println!("serialized state: {} kB", bytes.len() / 1024);
    c.bench_function("serialize (size and bytes)", |b| b.iter(|| slave.serialize(state)));
    c.bench_function("deserialize", |b| b.iter(|| assert_eq!(slave.deserialize(&bytes, &mut state), fmi2OK)));
}

/// Cost of a second wheel like one that rolls already, until it can step.
fn second_instance(c: &mut Criterion) {
    let dll = load();
    let first = Slave::new(&dll);
    first.initialize();
    c.bench_function("second equal instance, ready to step", |b| {
        b.iter(|| {
            let second = Slave::new(&dll);
            second.initialize();
            second
        })
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(1));
    targets = second_instance, layer
}
criterion_main!(benches);
