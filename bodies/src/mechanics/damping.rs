//! Damping of a body: a ratio for each vibration mode.
//!
//! It acts on the rate of the deformation *of the material*, `ẏ + Ω L y` with `L = M⁻¹ T` and the transport matrix `T`
//! of [`super::BodySystem`]: a wheel that rolls with a constant dent is strained anew with every turn. For deformation
//! without nodal diameters (torsion on the hub, growth of the radius) `T y = 0`. The part of the stream is taken of the
//! kept modes alone. Theory: `docs/theory/damping.md`.

use super::MechanicsError;
use super::shapes::{Shapes, StaticPart};
use super::system::BodySystem;
use crate::linalg::Parity;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Damping of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyDamping {
    /// Damping ratios of the vibration modes, by [`ModeCharacter::group`] \[1].
    pub ratios: [f64; GROUPS],
}

/// Number of groups of modes.
pub const GROUPS: usize = 4;
const TORSION: usize = 0;
const RADIAL: usize = 1;
const ONE_DIAMETER: usize = 2;
const MORE_DIAMETERS: usize = 3;

impl BodyDamping {
    /// No damping at all.
    pub const NONE: Self = Self::even(0.0);

    /// Damping ratios of the four kinds of modes: torsion, radial, of one and of more diameters \[1].
    pub const fn of([torsion, radial, one_diameter, more_diameters]: [f64; GROUPS]) -> Self {
        let mut ratios = [0.0; GROUPS];
        ratios[TORSION] = torsion;
        ratios[RADIAL] = radial;
        ratios[ONE_DIAMETER] = one_diameter;
        ratios[MORE_DIAMETERS] = more_diameters;
        Self { ratios }
    }

    /// Damping of all modes by one ratio \[1].
    pub const fn even(ratio: f64) -> Self {
        Self { ratios: [ratio; GROUPS] }
    }

    /// True if nothing is damped.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// Damping `2 ζ ω` of each mode [1/s].
    pub(super) fn modal(&self, squared_frequencies: &DVector<f64>, character: &ModeCharacter) -> DVector<f64> {
        DVector::from_fn(squared_frequencies.len(), |i, _| {
            2.0 * self.ratios[character.group(i)] * squared_frequencies[i].sqrt()
        })
    }
}

/// How the material streams through the modes, and what kind of modes they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModeCharacter {
    /// `Φᵀ T Φ`, `m × m`: for the wheel about `± n` between the two modes of a pair with `n` nodal diameters, else 0.
    pub transport: DMatrix<f64>,
    /// Number of nodal diameters of the modes of the wheel, as root mean square; zero for the rail.
    pub diameters: DVector<f64>,
    /// Share of circumferential motion in the kinetic energy of the modes of the wheel \[1]; zero for the rail.
    pub circumferential: DVector<f64>,
}

impl ModeCharacter {
    /// Of mass-normalised modes.
    pub(super) fn new(system: &BodySystem, modes: &Shapes) -> Self {
        let squares = |which: usize| match &system.circles {
            Some(circles) => modes.squares(&circles[which]),
            None => DVector::zeros(modes.count()),
        };
        let transport = modes.project(&system.transport, Parity::Odd);
        Self { transport, diameters: squares(0).map(f64::sqrt), circumferential: squares(1) }
    }

    /// Group of mode `i` among the ratios of [`BodyDamping`].
    pub fn group(&self, i: usize) -> usize {
        match self.diameters[i] {
            n if n < 0.5 && self.circumferential[i] > 0.5 => TORSION,
            n if n < 0.5 => RADIAL,
            n if n < 1.5 => ONE_DIAMETER,
            _ => MORE_DIAMETERS,
        }
    }

    /// True if the arrays belong to `m` modes and hold finite numbers.
    pub(super) fn is_consistent(&self, m: usize) -> bool {
        let Self { transport, diameters, circumferential } = self;
        transport.shape() == (m, m)
            && [diameters.len(), circumferential.len()] == [m; 2]
            && transport.iter().chain(diameters).chain(circumferential).all(|x| x.is_finite())
    }
}

/// Vibration modes of a body with all finite elements, and how they are damped.
pub(super) struct DampedModes {
    /// Modes, mass-normalised.
    pub shapes: Arc<DMatrix<f64>>,
    /// Squared frequencies [rad²/s²].
    pub squared_frequencies: DVector<f64>,
    /// Damping `2 ζ ω` [1/s].
    pub rates: DVector<f64>,
}

impl DampedModes {
    /// The `count` lowest modes of a body.
    pub fn compute(system: &BodySystem, count: usize, damping: &BodyDamping) -> Result<Self, MechanicsError> {
        let (squared_frequencies, modes) = Shapes::lowest(&StaticPart::all(system)?, count, &mut |_| {})?;
        let character = ModeCharacter::new(system, &modes);
        Ok(Self {
            rates: damping.modal(&squared_frequencies, &character),
            shapes: Arc::new(modes.rows(0..system.unknowns())),
            squared_frequencies,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::{Axis, PerAxis};
    use crate::linalg::{Cholesky, lowest_modes};
    use crate::mechanics::testing::{committed, exact_torsion, free, paper_d};
    use crate::mechanics::{
        BodyResponse, BodyState, Convection, FullBody, ReducedBasis, ReducedBody, rail_system, wheel_system,
    };
    use crate::multistep::TimeDerivative;

    /// Trapezoidal rule.
    fn trapezoidal(dt: f64) -> TimeDerivative {
        TimeDerivative { a0: 2.0 / dt, a1: -2.0 / dt, a2: 0.0, b1: -1.0 }
    }

    /// On the graded mesh: numbers of diameters are integers, every pair has two modes, and the stream of the material
    /// turns one into the other.
    #[test]
    fn modes_of_the_wheel_have_whole_numbers_of_diameters_and_come_in_pairs() {
        let bodies = paper_d(8);
        let basis = ReducedBasis::compute(&wheel_system(&bodies).unwrap(), 60, &mut |_| {}).unwrap();
        let ModeCharacter { transport, diameters, circumferential } = &basis.character;
        let deviation = diameters.iter().map(|n| (n - n.round()).abs()).fold(0.0, f64::max);
        println!("diameters {:.4?}, at most {deviation:.3} from whole", diameters.as_slice());
        assert!(deviation < 0.2);
        let mut ascending: Vec<usize> = (0..60).collect();
        ascending.sort_by(|&i, &j| basis.squared_frequencies[i].total_cmp(&basis.squared_frequencies[j]));
        let kept = &ascending[..40];
        let of_group =
            |group: usize| kept.iter().copied().filter(|&i| basis.character.group(i) == group).collect::<Vec<_>>();
        let (torsion, radial, one) = (of_group(TORSION), of_group(RADIAL), of_group(ONE_DIAMETER));
        // The first of each, against the closed form or the participation in a rigid motion.
        let lowest = basis.squared_frequencies[torsion[0]].sqrt();
        assert!((lowest / exact_torsion(&bodies).frequency - 1.0).abs() < 2e-3);
        assert_eq!(torsion[0], basis.rigid.column(Axis::Rotation.number()).iamax());
        assert!(circumferential[torsion[0]] > 0.999 && circumferential[radial[0]] < 1e-3);
        assert!(basis.rigid.row(radial[0]).amax() < 1e-3 * basis.rigid.amax());
        assert_eq!(radial[0], basis.centrifugal.iamax());
        assert!(one.contains(&basis.rigid.column(0).iamax()) && one.contains(&basis.rigid.column(1).iamax()));
        assert!(one.len() >= 4 && one.len() % 2 == 0);
        let pair = transport[(one[0], one[1])];
        assert!((pair.abs() - 1.0).abs() < 1e-2 && (pair + transport[(one[1], one[0])]).abs() < 1e-2);
        for i in [torsion[0], radial[0]] {
            let coupling = kept.iter().map(|&j| transport[(i, j)].abs()).fold(0.0, f64::max);
            println!("transport of mode {i}: {coupling:.1e}");
            assert!(coupling < 2e-2);
        }
    }

    #[test]
    fn characters_of_modes_do_not_depend_on_how_a_pair_is_rotated() {
        let system = wheel_system(&paper_d(6)).unwrap();
        let factor = Cholesky::new(&system.stiffness).unwrap();
        let modes = lowest_modes(&factor, &system.mass, 12, &mut |_| {}).unwrap();
        let squares = &modes.squared_frequencies;
        let first = (0..11).find(|&i| squares[i + 1] / squares[i] < 1.0 + 1e-3).unwrap();
        let expected = ModeCharacter::new(&system, &Shapes::whole(modes.shapes.clone()));
        for angle in [0.3_f64, 1.1, 2.7] {
            let mut phi = modes.shapes.clone();
            let (a, b) = (modes.shapes.column(first), modes.shapes.column(first + 1));
            phi.set_column(first, &(a * angle.cos() + b * angle.sin()));
            phi.set_column(first + 1, &(b * angle.cos() - a * angle.sin()));
            let turned = ModeCharacter::new(&system, &Shapes::whole(phi));
            assert!((&turned.diameters - &expected.diameters).amax() < 1e-2);
            assert!((0..12).all(|i| turned.group(i) == expected.group(i)));
        }
    }

    /// Free decay of one mode after a unit displacement: `e^{−ζωt}` in `n` periods. While it turns, the two modes of a
    /// pair with one diameter make a wave that rests in the material; its decay is not that of the frame.
    #[test]
    fn single_modes_decay_with_their_ratio_standing_and_turning() {
        let bodies = paper_d(6);
        let system = wheel_system(&bodies).unwrap();
        let basis = ReducedBasis::compute(&system, 24, &mut |_| {}).unwrap();
        let mut damping = BodyDamping::NONE;
        damping.ratios = [1e-2, 2e-3, 5e-3, 1e-3];
        for speed in [0.0, 60.0] {
            let body = ReducedBody::new(basis.clone(), false, &damping);
            for mode in [TORSION, RADIAL].map(|group| (0..24).find(|&i| basis.character.group(i) == group).unwrap()) {
                let square = basis.squared_frequencies[mode];
                let omega = square.sqrt();
                let ratio = damping.ratios[basis.character.group(mode)];
                let errors = [200.0, 400.0].map(|steps| {
                    let dt = std::f64::consts::TAU / omega / steps;
                    let td = trapezoidal(dt);
                    let op = body.operator(td.a0).unwrap();
                    let none = DVector::zeros(op.surface.nrows());
                    let mut state = BodyState::zeros(body.state_len());
                    state.displacement[mode] = 1.0;
                    state.acceleration[mode] = -square;
                    let amplitude = |state: &BodyState| {
                        (state.displacement[mode].powi(2) + state.velocity[mode].powi(2) / square).sqrt()
                    };
                    let stream = Convection { speed, acceleration: 0.0 };
                    for _ in 0..(20.0 * steps) as usize {
                        let known = free(&body, &op, &state, &td, stream);
                        state = committed(&body, &op, &known, &none, PerAxis::default(), &td, &state);
                    }
                    let time = 20.0 * steps * dt;
                    let found = -amplitude(&state).ln() / (omega * time);
                    println!("mode {mode}, speed {speed}: ratio {found:.6e} for {ratio:.6e} with {steps} steps");
                    found / ratio - 1.0
                });
                println!("figure: damping.modes = {:.3e}", errors[1]);
                assert!(errors[1].abs() < 1e-2, "{errors:?}");
            }
        }
    }

    /// Operators and a rolling run under a ramped load; with few modes in the reduced body, but the same in both
    /// dampings. In the rail the stream carries much of what the truncated modes hold, which only the full body knows.
    #[test]
    fn damped_reduced_and_full_bodies_answer_alike() {
        let bodies = paper_d(5);
        let damping = BodyDamping { ratios: [3e-2, 2e-2, 5e-2, 1e-2] };
        for (system, carried) in [(wheel_system(&bodies).unwrap(), 2e-2), (rail_system(&bodies).unwrap(), 0.1)] {
            let basis = ReducedBasis::compute(&system, 40, &mut |_| {}).unwrap();
            let reduced = ReducedBody::new(basis, false, &damping);
            let full = FullBody::damped(system, false, &damping, 40).unwrap();
            let dt = 2e-4;
            let td = TimeDerivative { a0: 1.5 / dt, a1: -2.0 / dt, a2: 0.5 / dt, b1: 0.0 };
            let histories = [&reduced as &dyn BodyResponse, &full].map(|body| {
                let op = body.operator(td.a0).unwrap();
                let n = op.surface.nrows();
                let mut state = BodyState::zeros(body.state_len());
                let run = (1..=30).map(|k| {
                    let level = (f64::from(k) / 10.0).min(1.0);
                    let forces = DVector::from_fn(n, |i, _| match (i.abs_diff(n / 2) < 8, i % 2) {
                        (true, 1) => -2e4 * level,
                        (true, _) => 4e3 * level,
                        _ => 0.0,
                    });
                    let known = free(body, &op, &state, &td, Convection { speed: 40.0, acceleration: 0.0 });
                    let surface = &known.surface + &op.surface * &forces;
                    state = committed(body, &op, &known, &forces, PerAxis::default(), &td, &state);
                    (surface, body.dissipation(&state, 40.0), body.energy(&state, &forces, PerAxis::default()))
                });
                run.collect::<Vec<_>>()
            });
            let [mut surface, mut power, mut energy, mut largest] = [0.0_f64; 4];
            let size = histories[1].iter().map(|h| h.0.amax()).fold(0.0, f64::max);
            for (a, b) in histories[0].iter().zip(&histories[1]) {
                surface = surface.max((&a.0 - &b.0).amax() / size);
                power = power.max((a.1 - b.1).abs());
                largest = largest.max(b.1);
                energy = energy.max((a.2 / b.2 - 1.0).abs());
            }
            println!("surface {surface:.1e}, power {:.1e}, energy {energy:.1e}", power / largest);
            assert!(surface < 2e-3 && power < carried * largest && energy < 2e-2);
        }
    }

    #[test]
    fn statics_of_a_body_at_rest_are_not_damped() {
        let bodies = paper_d(5);
        let basis = ReducedBasis::compute(&rail_system(&bodies).unwrap(), 10, &mut |_| {}).unwrap();
        let damping = BodyDamping { ratios: [0.1; GROUPS] };
        let [damped, plain] = [damping, BodyDamping::NONE].map(|d| ReducedBody::new(basis.clone(), false, &d));
        let (a, b) = (damped.operator(0.0).unwrap(), plain.operator(0.0).unwrap());
        assert_eq!(a.surface, b.surface);
        // A force held for many relaxation times.
        let dt = 1e-3;
        let td = TimeDerivative { a0: 1.0 / dt, a1: -1.0 / dt, a2: 0.0, b1: 0.0 };
        let op = damped.operator(td.a0).unwrap();
        let n = op.surface.nrows();
        let forces = DVector::from_fn(n, |i, _| if i.abs_diff(n / 2) < 4 { -1e4 } else { 0.0 });
        let mut state = BodyState::zeros(damped.state_len());
        let mut surface = DVector::zeros(n);
        for _ in 0..200 {
            let known = free(&damped, &op, &state, &td, Convection::default());
            surface = &known.surface + &op.surface * &forces;
            state = committed(&damped, &op, &known, &forces, PerAxis::default(), &td, &state);
        }
        let exact = &b.surface * &forces;
        assert!((surface - &exact).amax() < 1e-9 * exact.amax());
    }
}
