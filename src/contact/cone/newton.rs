//! Newton's method on the law of [`super::law`] under given pressures, all lines and motions at once.

use super::law::{ByDirection, ConeProblem, ConeVerdict, Polynomials};
use super::linear::{ConeProblems, FreeMotion, Linearised, TangentialCoupling, sum_between};
use crate::axes::PerAxis;
use crate::contact::error::ContactError;

/// Times that the law is made linear before the shear is drawn.
const MOST: usize = 12;
/// First strength with which the shear is drawn, and what it is multiplied with where that succeeds and where it fails \[1].
const FIRST: f64 = 0.5;
const WEAKER: f64 = 0.2;
const STRONGER: f64 = 5.0;
/// Strength below which nothing is drawn \[1].
const WEAKEST: f64 = 1e-3;
/// Times that it is drawn at most.
const MOST_DRAWN: usize = 60;
/// Share of the violation of friction that a solution of a drawn shear leaves \[1].
const DRAWN: f64 = 0.05;
/// Violation of friction beyond which steps lead nowhere \[1].
const LOST: f64 = 1e3;
/// Part of a momentum that is lost in rounding \[1].
const ROUNDING: f64 = 1e-14;
/// Relative difference of violations that repeat themselves \[1].
const REPEATED: f64 = 1e-6;
/// Share of the violation that a step with a linear law of before may leave \[1].
const SLOW: f64 = 0.2;

/// Where a search is, or was.
pub struct Begun<const N: usize, const D: usize> {
    shears: Vec<ByDirection<N, D>>,
    rigid: PerAxis<f64>,
    /// Largest violation of friction and balances \[1].
    pub largest: f64,
}

/// The tangential problem of all lines under given pressures, and where the search is in it.
pub struct Newton<'a, const N: usize, const D: usize> {
    problems: &'a mut [ConeProblem<N, D>],
    coupling: &'a mut TangentialCoupling<D>,
    pub shears: Vec<ByDirection<N, D>>,
    /// Present motions.
    pub rigid: PerAxis<f64>,
    /// Slips by all but the known one, as polynomials.
    slips: Vec<Polynomials<D>>,
    pub verdicts: Vec<ConeVerdict<N, D>>,
    /// Missing parts of the balances of the free motions [N/m, N].
    unbalance: Vec<f64>,
    /// Linear law of before.
    pub linear: Option<Linearised<N, D>>,
    /// Times that the law was made linear.
    pub linear_laws: usize,
}

impl<'a, const N: usize, const D: usize> Newton<'a, N, D> {
    /// Begins with given shears, with motions that differ from those of the known slip by `motion`.
    pub fn new(
        coupling: &'a mut TangentialCoupling<D>,
        problems: &'a mut [ConeProblem<N, D>],
        shears: &[ByDirection<N, D>],
        motion: PerAxis<f64>,
    ) -> Self {
        let rigid = PerAxis::from_fn(|axis| coupling.base[axis] + motion[axis]);
        let (slips, verdicts, unbalance) = Default::default();
        let (shears, linear) = (shears.to_vec(), None);
        let mut newton = Self { problems, coupling, shears, rigid, slips, verdicts, unbalance, linear, linear_laws: 0 };
        newton.judge();
        newton
    }

    /// Goes on from given shears, with the motions of the known slip.
    pub fn take(&mut self, shears: &[ByDirection<N, D>]) {
        self.shears.clone_from_slice(shears);
        self.rigid = self.coupling.base;
        self.judge();
    }

    /// Finds what friction and balances ask for under the present shears and motions.
    fn judge(&mut self) {
        let lines = self.problems.iter().zip(&self.shears);
        let moments: Vec<_> = lines.map(|(problem, shear)| problem.moments(shear)).collect();
        let TangentialCoupling { between, motions, base, .. } = &*self.coupling;
        let slips = |at: usize| {
            let mut sum = sum_between(between, at, &moments);
            for FreeMotion { axis, slips, .. } in motions {
                let change = self.rigid[*axis] - base[*axis];
                let sum = sum.as_flattened_mut().iter_mut().zip(slips[at].as_flattened());
                sum.for_each(|(sum, slip)| *sum += change * slip);
            }
            sum
        };
        self.slips = (0..self.problems.len()).map(slips).collect();
        let lines = self.problems.iter().zip(&self.shears).zip(&self.slips);
        self.verdicts = lines.map(|((problem, shear), slips)| problem.verdict(shear, slips)).collect();
        let balance = |motion: &FreeMotion<D>| {
            let resisted =
                motions.iter().map(|other| motion.resistance(other.axis) * (self.rigid[other.axis] - base[other.axis]));
            let [resistance, way] = motion.drawn;
            motion.missing + resistance * way + motion.pulls(&moments) - resisted.sum::<f64>()
        };
        self.unbalance = motions.iter().map(balance).collect();
    }

    /// Largest violation of friction and balances \[1].
    pub fn largest(&self) -> f64 {
        let TangentialCoupling { motions, radius, friction, .. } = &*self.coupling;
        let balances = motions.iter().zip(&self.unbalance).map(|(motion, missing)| {
            let axis = motion.axis;
            let rounding = ROUNDING * (motion.resistance(axis) * self.rigid[axis]).abs();
            (missing.abs() - rounding).max(0.0) / (axis.arm(*radius) * friction)
        });
        self.verdicts.iter().map(|verdict| verdict.largest).chain(balances).fold(0.0, f64::max)
    }

    /// Goes on until friction and balances are violated by no more than the `tolerance`, by steps that are taken whole. Where
    /// these end nowhere the shear is drawn to the one before, less and less: the slips of points are monotone in their
    /// shear, so that there is one solution and this way leads there (R. T. Rockafellar, *SIAM J. Control Optim.* 14 (1976)
    /// 877).
    pub fn run(&mut self, tolerance: f64) -> Result<(), ContactError> {
        if self.largest() <= tolerance {
            return Ok(());
        }
        let begun = self.now();
        if self.steps(tolerance) {
            return Ok(());
        }
        self.restart(&begun);
        let mut strength = FIRST;
        for _ in 0..MOST_DRAWN {
            let begun = self.now();
            let found = self.draw(strength, (DRAWN * begun.largest).max(tolerance));
            if !found {
                self.restart(&begun);
            } else if self.largest() <= tolerance {
                return Ok(());
            }
            strength *= if found { WEAKER } else { STRONGER };
            if found && strength < WEAKEST {
                let begun = self.now();
                if self.steps(tolerance) {
                    return Ok(());
                }
                self.restart(&begun);
                strength = WEAKEST;
            }
        }
        Err(ContactError::Unsuited { reason: "the shear of points along and across is not found" })
    }

    /// Goes to the solution of a shear that is drawn to the present one; true if it is found.
    fn draw(&mut self, strength: f64, tolerance: f64) -> bool {
        let (problems, shears) = (self.problems.to_vec(), &self.shears);
        let resists = |(problem, share): (&ConeProblem<N, D>, &f64)| share * problem.resistance();
        let resistance = strength * self.problems.iter().zip(&self.coupling.shares).map(resists).sum::<f64>();
        self.problems.iter_mut().zip(shears).for_each(|(problem, shear)| problem.draw(strength, shear));
        let TangentialCoupling { motions, base, radius, .. } = &mut *self.coupling;
        for FreeMotion { axis, drawn, .. } in motions {
            let arm = axis.arm(*radius);
            *drawn = [resistance * arm * arm, self.rigid[*axis] - base[*axis]];
        }
        self.judge();
        self.linear = None;
        let found = self.steps(tolerance);
        self.coupling.motions.iter_mut().for_each(|motion| motion.drawn = [0.0; 2]);
        self.linear = None;
        self.problems.clone_from_slice(&problems);
        self.judge();
        found
    }

    /// Present shears and motions.
    pub fn now(&self) -> Begun<N, D> {
        Begun { shears: self.shears.clone(), rigid: self.rigid, largest: self.largest() }
    }

    /// Begins anew with shears and motions.
    pub fn restart(&mut self, begun: &Begun<N, D>) {
        self.shears.clone_from(&begun.shears);
        self.rigid = begun.rigid;
        self.judge();
    }

    /// Corrects the known slips by those in the places of the present shear.
    pub fn correct(&mut self) {
        for ((problem, shear), slips) in self.problems.iter_mut().zip(&self.shears).zip(&self.slips) {
            problem.add(&problem.correction(shear, slips));
        }
        self.judge();
    }

    /// True if a few steps were enough. The linear law of before is used as long as the same points stick and it leads on.
    fn steps(&mut self, tolerance: f64) -> bool {
        let (mut before, mut made) = ([f64::INFINITY; 2], 0);
        loop {
            let largest = self.largest();
            if largest <= tolerance {
                return true;
            }
            if self.linear.as_ref().is_some_and(|law| law.is_of(&self.verdicts)) {
                let begun = self.now();
                if self.step().is_some() && self.largest() < SLOW * largest {
                    continue;
                }
                self.restart(&begun);
            }
            // Two states that ask for each other have the same violations again and again.
            made += 1;
            if made > MOST || (largest / before[0] - 1.0).abs() < REPEATED {
                return false;
            }
            self.linear_laws += 1;
            self.linear = Linearised::new(&self.problem(), &self.verdicts);
            if self.step().is_none() || self.largest() > LOST {
                return false;
            }
            before = [before[1], largest];
        }
    }

    fn problem(&self) -> ConeProblems<'_, N, D> {
        ConeProblems { lines: self.problems, coupling: &*self.coupling, unbalance: &self.unbalance }
    }

    /// One step with the linear law; `None`: there is none.
    fn step(&mut self) -> Option<()> {
        let mut linear = self.linear.take()?;
        let (changes, motions) = linear.changes(&self.problem(), &self.verdicts)?;
        self.linear = Some(linear);
        for (shear, change) in self.shears.iter_mut().zip(&changes) {
            let shear = shear.as_flattened_mut().iter_mut();
            shear.zip(change.as_flattened()).for_each(|(shear, change)| *shear += change);
        }
        let motions = self.coupling.motions.iter().zip(motions);
        motions.for_each(|(motion, change)| self.rigid[motion.axis] += change);
        self.judge();
        self.largest().is_finite().then_some(())
    }
}

/// The law on the paired nodes of a line in steady rolling: upwind differences and flexibility are those of a grid, pressure
/// that of a cylinder on it. Lengths are over half of that of the patch, forces over friction times load.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::axes::Axis;
    use crate::contact::cone::law::SlipRows;
    use crate::contact::flexibility::ByPowers;
    use crate::contact::line::NodeStatus;
    use crate::contact::line::kernel::logarithms;
    use crate::contact::line::streamline::upwind_rows;
    use crate::linalg::POINTS;
    use nalgebra::{DMatrix, DVector};
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Steady state: forces along and across, moment of these, and the lateral velocity that was sought.
    struct SteadyRolling<const N: usize> {
        shear: ByDirection<N, 2>,
        pressure: [f64; N],
        force: [f64; 2],
        moment: f64,
        lateral: f64,
    }

    fn place<const N: usize>(i: usize) -> f64 {
        (2 * i + 1) as f64 / N as f64 - 1.0
    }

    /// Displacements of the nodes, and of two beyond at the leading edge, by unit tractions at those of the patch.
    fn displacements<const N: usize>() -> DMatrix<f64> {
        let nodes: Vec<f64> = (0..N + 2).map(place::<N>).collect();
        let spacing = 2.0 / N as f64;
        spacing * logarithms(&nodes, spacing).columns(0, N)
    }

    /// Pressure under a round body whose load is that of `√(1 − x²)`.
    fn pressure<const N: usize>(displaced: &DMatrix<f64>) -> [f64; N] {
        let system = DMatrix::from_fn(N + 1, N + 1, |i, j| match (i < N, j < N) {
            (true, true) => displaced[(i, j)],
            (true, false) => -1.0,
            (false, true) => 2.0 / N as f64,
            (false, false) => 0.0,
        });
        let given = DVector::from_fn(N + 1, |i, _| if i < N { -FRAC_PI_2 * place::<N>(i).powi(2) } else { FRAC_PI_2 });
        let found = system.lu().solve(&given).unwrap();
        std::array::from_fn(|i| found[i])
    }

    fn line<const N: usize>([along, across, spin]: [f64; 3]) -> (ConeProblem<N, 2>, [f64; N]) {
        let displaced = displacements::<N>();
        let pressure = pressure(&displaced);
        assert!(pressure.iter().all(|p| *p > 0.0));
        let (mut rows, spacing) = (Vec::new(), 2.0 / N as f64);
        upwind_rows(&[NodeStatus::Stick; N], |i| pressure[i], true, &mut rows);
        let slip = |i: usize, by: usize| {
            let stencil = rows[i].stencil(true, [spacing; 2]);
            -(0..3).map(|k| stencil[k] * displaced[(i + k, by)]).sum::<f64>()
        };
        let by_shear: Vec<[f64; N]> = (0..N).map(|by| std::array::from_fn(|i| slip(i, by))).collect();
        let rows = SlipRows {
            by_shear: [by_shear.clone(), by_shear],
            known: [[along; N], std::array::from_fn(|i| across + spin * place::<N>(i))],
            powers: (0..POINTS).map(|k| std::array::from_fn(|i| place::<N>(i).powi(k as i32))).collect(),
        };
        let most = pressure.iter().fold(0.0_f64, |most, p| most.max(*p));
        (ConeProblem::new(rows, None, &[spacing; N], pressure, most), pressure)
    }

    /// Steady rolling with creepages along and across and a spin; with a lateral force on the body the creepage across is
    /// that which holds it.
    fn roll<const N: usize>(slip: [f64; 3], held: Option<f64>) -> SteadyRolling<N> {
        let (problem, pressure) = line(slip);
        let mut across = [ByPowers::default(); 2];
        across[1][0] = 1.0;
        let motion = |force: f64| FreeMotion {
            axis: Axis::Lateral,
            slips: vec![across],
            pulls: vec![across],
            resistance: PerAxis::default(),
            missing: force * FRAC_PI_2,
            drawn: [0.0; 2],
        };
        let mut coupling = TangentialCoupling {
            between: vec![Default::default()],
            motions: held.map(motion).into_iter().collect(),
            base: PerAxis::default(),
            radius: 1.0,
            shares: vec![1.0],
            friction: FRAC_PI_2,
        };
        let mut problems = [problem];
        let mut newton = Newton::new(&mut coupling, &mut problems, &[[[0.0; N]; 2]], PerAxis::default());
        newton.run(1e-12).unwrap();
        let (shear, lateral) = (newton.shears[0], newton.rigid.lateral);
        let moments = problems[0].moments(&shear).map(|moments| moments.map(|moment| moment / FRAC_PI_2));
        SteadyRolling { shear, pressure, force: moments.map(|moments| moments[0]), moment: moments[1][1], lateral }
    }

    #[test]
    fn forces_of_nodes_tend_to_those_of_carter_whatever_the_direction_of_creepage() {
        let carter = 1.0 - (1.0 - 1.0 / PI).powi(2);
        let [coarse, fine] = [roll::<20>([1.0, 0.0, 0.0], None).force, roll::<40>([1.0, 0.0, 0.0], None).force];
        println!("{} {} against {carter}", coarse[0], fine[0]);
        assert!((coarse[0] + carter).abs() < 1.2e-3 && (fine[0] + carter).abs() < 5e-4);
        let turned = roll::<40>([0.6, -0.8, 0.0], None).force;
        assert!((turned[0] - 0.6 * fine[0]).abs() < 1e-10 && (turned[1] + 0.8 * fine[0]).abs() < 1e-10);
    }

    /// Slips stand where their shear does: half a cell upstream of it the moment is off by .015 and .013 here on the finer nodes.
    #[test]
    fn spin_on_nodes_needs_no_correction_of_the_slip() {
        for (slip, [force, moment]) in [([0.0, 0.0, 2.0], [-0.637, 0.0]), ([0.3, 0.0, 8.0], [-0.673, -0.2363])] {
            for (of, allowed) in [
                (roll::<20>(slip, None).into_moments(), [0.018, 4e-3]),
                (roll::<40>(slip, None).into_moments(), [7e-3, 1e-3]),
            ] {
                println!("{slip:?}: {of:?} against {force} {moment}");
                assert!((of[0] - force).abs() < allowed[0] && (of[1] - moment).abs() < allowed[1]);
            }
        }
    }

    #[test]
    fn mirror_images_have_mirrored_shear_and_none_is_beyond_the_cone() {
        for [along, across, spin] in [[0.0, 0.0, 2.0], [0.5, 0.5, 1.0], [0.3, 0.0, 8.0], [-0.2, 1.5, -3.0]] {
            let (one, other) = (roll::<40>([along, across, spin], None), roll::<40>([along, -across, -spin], None));
            for i in 0..40 {
                let ([t, z], [mt, mz]) = ([0, 1].map(|c| one.shear[c][i]), [0, 1].map(|c| other.shear[c][i]));
                assert!((t - mt).abs() < 1e-10 && (z + mz).abs() < 1e-10, "{t} {mt} {z} {mz}");
                assert!(libm::hypot(t, z) < one.pressure[i] + 1e-11);
            }
        }
    }

    #[test]
    fn a_lateral_force_that_is_held_leads_to_the_creepage_of_this_force() {
        for [along, across, spin] in [[0.0, 0.4, 0.0], [0.5, -0.7, 1.0], [0.3, 0.2, 4.0]] {
            let given = roll::<40>([along, across, spin], None);
            let held = roll::<40>([along, 0.0, spin], Some(-given.force[1]));
            println!("{} against {across}", held.lateral);
            assert!((held.lateral - across).abs() < 1e-8 && (held.force[0] - given.force[0]).abs() < 1e-9);
        }
    }

    impl<const N: usize> SteadyRolling<N> {
        /// Force across and its moment.
        fn into_moments(self) -> [f64; 2] {
            [self.force[1], self.moment]
        }
    }
}
