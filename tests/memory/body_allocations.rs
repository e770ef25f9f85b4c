//! A step of the reduced bodies works in the memory of its buffers.

use crate::common::*;
use crate::heap;
use nalgebra::DVector;
use wheelrail::axes::PerAxis;
use wheelrail::mechanics::{
    BodyDamping, BodyResponse, BodyState, BodySystem, Convection, FreeResponse, ReducedBasis, ReducedBody, wheel_system,
};
use wheelrail::multistep::TimeDerivative;

#[test]
fn a_step_of_a_reduced_body_allocates_nothing() {
    let config = preset("paper_d", 6);
    let undamped = wheel_system(&(&config).into()).unwrap();
    let dashpots = BodySystem { damping: Some(undamped.mass.clone()), ..undamped.clone() };
    let damping = BodyDamping { ratios: [1e-2; 4] };
    let cases = [(undamped.clone(), BodyDamping::NONE), (dashpots, BodyDamping::NONE), (undamped, damping)];
    for (system, damping) in cases {
        let basis = ReducedBasis::compute(&system, 12, &mut |_| {}).unwrap();
        let body = ReducedBody::new(basis, true, &damping);
        let td = TimeDerivative { a0: 1.5e3, a1: -2e3, a2: 0.5e3, b1: 0.0 };
        let op = body.operator(td.a0).unwrap();
        let forces = DVector::from_element(op.surface.nrows(), 1e3);
        let mut states = [BodyState::zeros(body.state_len()), BodyState::zeros(0)];
        let mut free = FreeResponse::default();
        let mut step = |states: &mut [BodyState; 2]| {
            let [state, next] = states;
            body.free_response(&op, state, &td, Convection { speed: 60.0, acceleration: 1.0 }, &mut free);
            body.commit(
                &op,
                &free,
                &forces,
                PerAxis { travel: 1.0, rotation: 2.0, ..PerAxis::default() },
                &td,
                state,
                next,
            );
            let energy = body.energy(next, &forces, PerAxis { travel: 30.0, rotation: 60.0, ..PerAxis::default() })
                + body.dissipation(next, 60.0);
            states.swap(0, 1);
            energy
        };
        // The buffers take their size.
        step(&mut states);
        step(&mut states);
        let before = heap::requests();
        let energy: f64 = (0..20).map(|_| step(&mut states)).sum();
        assert_eq!(heap::requests(), before);
        assert!(energy.is_finite() && energy != 0.0);
    }
}
