//! Wheels that are stepped side by side.

use crate::common;
use wheelrail::simulation::{Inputs, Model, Simulation};
use wheelrail::wheels::advance_all;

#[test]
fn wheels_on_threads_are_those_of_one_after_the_other_bit_for_bit() {
    let config = common::preset("railway", 10);
    let model = Model::shared(config, &common::store(), &mut |_, _| {}).unwrap();
    // Every wheel brakes in its own way, the last one until it slides.
    let mut inputs = vec![Inputs::rolling(model.config()); 5];
    let start = |inputs: &[Inputs]| -> Vec<Simulation> {
        inputs.iter().map(|inputs| Simulation::new(model.clone(), inputs).unwrap()).collect()
    };
    let (mut together, mut alone) = (start(&inputs), start(&inputs));
    inputs.iter_mut().enumerate().for_each(|(k, inputs)| inputs.drive.moment = -6e3 * k as f64);
    for _ in 0..40 {
        assert!(advance_all(&mut together, &inputs, 1e-3).iter().all(Result::is_ok));
        alone.iter_mut().zip(&inputs).for_each(|(wheel, inputs)| wheel.advance(inputs, 1e-3).unwrap());
    }
    for (a, b) in together.iter().zip(&alone) {
        assert_eq!(a.state(), b.state());
    }
    assert!(together[4].outputs().contact_creepage > 2.0 * together[1].outputs().contact_creepage);
}

#[test]
fn a_wheel_that_fails_stays_where_it_was_and_leaves_the_others_alone() {
    let config = common::preset("railway", 10);
    let model = Model::shared(config, &common::store(), &mut |_, _| {}).unwrap();
    let mut inputs = vec![Inputs::rolling(model.config()); 3];
    let mut wheels: Vec<_> = inputs.iter().map(|inputs| Simulation::new(model.clone(), inputs).unwrap()).collect();
    inputs[1].drive.load = f64::NAN;
    let before = wheels[1].state().clone();
    let results = advance_all(&mut wheels, &inputs, 1e-3);
    assert_eq!(results.iter().map(Result::is_ok).collect::<Vec<_>>(), [true, false, true]);
    assert_eq!(wheels[1].state(), &before);
    assert!(wheels[0].time() > 0.0 && wheels[2].state() == wheels[0].state());
}

#[test]
fn no_wheel_one_wheel_and_a_hundred_of_which_every_third_fails() {
    let model = common::without_heat("railway", |_| {});
    for count in [0, 1, 100] {
        let mut inputs = vec![Inputs::rolling(model.config()); count];
        let start = || Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap();
        let (first, mut wheels) = (start(), (0..count).map(|_| start()).collect::<Vec<_>>());
        inputs.iter_mut().skip(2).step_by(3).for_each(|inputs| inputs.drive.load = f64::NAN);
        for _ in 0..2 {
            let results = advance_all(&mut wheels, &inputs, 1e-3);
            assert_eq!(results.len(), count);
            assert!(results.iter().enumerate().all(|(k, result)| result.is_err() == (k % 3 == 2)));
        }
        let moved = |k: usize| if k % 3 == 2 { first.state() } else { wheels[0].state() };
        assert!(wheels.iter().enumerate().all(|(k, wheel)| wheel.state() == moved(k)));
    }
}
