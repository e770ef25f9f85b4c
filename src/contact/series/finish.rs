//! What is done once with a solution: histories move on, power and traction are taken.

use super::hot_layers::Warmth;
use super::iterate::Iterate;
use super::state::{Past, SeriesState, Tractions};
use super::surface::{less, plus};
use super::tables::{POWER, PROFILE};
use crate::contact::traction::Traction;
use crate::linalg::POINTS;
use crate::multistep::History;
use crate::piecewise::{Interval, Piecewise};
use nalgebra::DVector;

impl Iterate<'_> {
    /// Ends of the slipping part \[m]; `None` where all sticks.
    fn slipping_ends(&self) -> [f64; 2] {
        let (patch, stick) = (self.tractions.pressure.ends(), self.tractions.stick.ends());
        match (self.tractions.slides(), self.upstream() > 0.0) {
            (true, _) => patch,
            (false, true) => [patch[0], stick[0]],
            (false, false) => [stick[1], patch[1]],
        }
    }

    /// Places of the slipping part \[m], and the friction forces that belong to them [N/m].
    pub(super) fn slipping(&self) -> ([f64; POWER], [f64; POWER]) {
        let (tables, [low, high]) = (&self.constants.tables, self.slipping_ends());
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let places = tables.places.map(|t| centre + half * t);
        let densities = self.tractions.pressure.density(&places);
        let force = |q: usize| half * tables.weights[q] * self.tractions.slide * densities[q];
        (places, std::array::from_fn(force))
    }

    /// Elastic energy of both half-planes [J/m].
    fn energy(&self) -> f64 {
        let Tractions { slide, stick, .. } = self.tractions;
        let pressed: f64 = self.pressed.iter().map(|place| place.force * place.logarithm).sum();
        let own = stick.logarithm(&self.stuck.map(|place| place.x));
        let stuck = self.stuck.iter().zip(own);
        let stuck: f64 = stuck.map(|(place, own)| place.force * (2.0 * slide * place.logarithm + own)).sum();
        // Pulls do little beside friction: of the tangential part the mean under the pressure is enough.
        let along = self.over_pressure(|warmth, _| less(&warmth.along[0], &warmth.along[1]));
        let along = along * self.resultant()[0] / self.load();
        let lift = self.over_pressure(|warmth, x| less(&warmth.wheel.lift.at(x), &warmth.rail.lift.at(x)));
        along + lift - self.constants.half_plane.kernel * (pressed * (1.0 + slide * slide) + stuck)
    }

    /// Power of pressure on the slope of the rail that slides past it [W/m].
    fn slope_power(&self) -> f64 {
        let (coupling, Tractions { pressure, slide, .. }) = (self.constants.half_plane.coupling, &self.tractions);
        let smooth = self.constants.points.polynomial(&self.surface.rail.normal);
        let [pressed, stuck] =
            [&self.pressed, &self.stuck].map(|places| pressure.density(&places.map(|place| place.x)));
        let pressed = self.pressed.iter().zip(pressed);
        let pressed: f64 = pressed.map(|(at, p)| at.force * (smooth.slope(at.x) + coupling * slide * p)).sum();
        let stuck: f64 = self.stuck.iter().zip(stuck).map(|(at, p)| at.force * coupling * p).sum();
        let warm = self.over_pressure(|Warmth { rail, .. }, x| plus(&rail.lift.slope(x), &rail.swelling.slope(x)));
        (self.rim_velocity() - self.rigid[0]) * (pressed + stuck + warm) - self.expansion()
    }

    /// Power [W/m] that the passing material adds by expanding and shrinking against the contact forces.
    fn expansion(&self) -> f64 {
        if self.warmth.is_none() {
            return 0.0;
        }
        let (v, rim) = (self.rigid[0], self.rim_velocity());
        let (points, compliance) = (&self.constants.points, self.problem.bodies.compliance);
        // What the pulls do to the bodies less the half-planes.
        let [[wheel, wheel_lift], [rail, rail_lift]] = [0, 1].map(|body| {
            [0, 1].map(|component| {
                let entry = |k: usize, l: usize| compliance[body][(2 * k + component, 2 * l)] * self.pulls[body][l];
                points.polynomial(&std::array::from_fn(|k| (0..POINTS).map(|l| entry(k, l)).sum()))
            })
        });
        let turning = rim / self.problem.surfaces.radius;
        let along = self.over_shear(|warmth, x| {
            let stretch = warmth.stretch(x, [rim, -v]);
            let smooth = |x: f64| rim * wheel.slope(x) - v * rail.slope(x) + turning * wheel_lift.at(x);
            std::array::from_fn(|i| stretch[i] + smooth(x[i]))
        });
        let lift = self.over_pressure(|warmth, x| {
            let of_wheel = less(&warmth.wheel.lift.slope(x), &warmth.wheel.swelling.slope(x));
            let of_rail = plus(&warmth.rail.lift.slope(x), &warmth.rail.swelling.slope(x));
            let smooth = |x: f64| rim * wheel_lift.slope(x) - v * rail_lift.slope(x) - turning * wheel.at(x);
            let along = warmth.along[0];
            std::array::from_fn(|i| rim * of_wheel[i] - v * of_rail[i] - turning * along[i] + smooth(x[i]))
        });
        along + lift
    }

    /// Moves the histories on and takes the power: that of friction at the end of the step [W/m] and its energy in the step
    /// [J/m].
    fn remember(&self, slip: &[f64; POWER], force: &[f64; POWER], state: &mut SeriesState) -> [f64; 2] {
        let time = &self.problem.time;
        state.tractions = self.tractions;
        let now = Past::Patch(self.tractions, self.relative(&self.surface));
        let push = |history: &mut History, value: f64| match time.is_stationary() {
            true => *history = History::constant(value),
            false => history.push(time, value),
        };
        push(&mut state.rim_angle, self.rim_angle);
        state.past[1] = if time.is_stationary() { now.clone() } else { std::mem::take(&mut state.past[0]) };
        state.past[0] = now;
        (state.slope, state.energy) = (self.slope, self.energy());
        let slope_power = self.slope_power();
        let history = &mut state.friction;
        let (mut power, mut work) = (slope_power, 0.0);
        for q in 0..POWER {
            power -= force[q] * slip[q];
            if !time.is_stationary() {
                history.impulse[q] = time.impulse(force[q], history.force[q], history.impulse[q]);
                work -= history.impulse[q] * 0.5 * (history.slip[q] + slip[q]);
            }
        }
        (history.force, history.slip) = (*force, *slip);
        if !time.is_stationary() {
            history.slope_work = time.impulse(slope_power, history.slope_power, history.slope_work);
            work += history.slope_work;
        }
        history.slope_power = slope_power;
        [power, work]
    }

    /// Writes the traction and the memory.
    pub(super) fn finish(&self, state: &mut SeriesState, traction: &mut Traction) {
        let (_, force) = self.slipping();
        let slip = self.slips;
        let [friction, work] = self.remember(&slip, &force, state);
        traction.friction = self.friction;
        let power = traction.dissipate(friction, work, self.problem.duration);
        let weighted: f64 = force.iter().zip(&slip).map(|(f, s)| f * s).sum();
        let slide = self.tractions.slide;
        traction.tread_slip = if slide == 0.0 { self.mean_slip() } else { weighted / (slide * self.load()) };
        traction.rigid = self.rigid;
        traction.resultant = self.resultant();
        self.write_ports(traction);
        let [low, high] = self.tractions.pressure.ends();
        for patches in [&mut traction.edges, &mut traction.patches] {
            patches.clear();
            patches.push(Interval { low, high });
        }
        traction.stick_fraction = self.tractions.stick.half_width / self.tractions.pressure.half_width;
        traction.overlap.clear();
        (traction.plastic_work, traction.yielding, traction.iterations) = (0.0, 0.0, 1);
        self.write_profiles(traction);
        scale_to(&mut traction.dissipation, power, &traction.pressure);
    }

    /// Mean slip over the pressure without friction [m/s].
    fn mean_slip(&self) -> f64 {
        let slips = self.slip(&self.pressed.map(|place| place.x), &self.surface, true);
        self.pressed.iter().zip(slips).map(|(place, slip)| place.force * slip).sum::<f64>() / self.load()
    }

    fn write_ports(&self, traction: &mut Traction) {
        let fit = |values: &mut DVector<f64>| {
            if values.len() != 2 * POINTS {
                *values = DVector::zeros(2 * POINTS);
            }
        };
        let Traction { port_forces, loads, surface, .. } = traction;
        loads.iter_mut().chain(surface.iter_mut()).chain([&mut *port_forces]).for_each(fit);
        for k in 0..POINTS {
            let forces = [self.moments.tangential[k], self.moments.normal[k]];
            let bodies = [&self.surface.wheel, &self.surface.rail];
            for (component, force) in forces.into_iter().enumerate() {
                let port = 2 * k + component;
                port_forces[port] = force;
                let pull = if component == 0 { self.pulls.map(|pull| pull[k]) } else { [0.0; 2] };
                (loads[0][port], loads[1][port]) = (force + pull[0], pull[1] - force);
                for (u, body) in surface.iter_mut().zip(bodies) {
                    u[port] = if component == 0 { body.tangential[k] } else { body.normal[k] };
                }
            }
        }
    }

    fn write_profiles(&self, traction: &mut Traction) {
        let Traction { pressure, shear, slip, dissipation, .. } = traction;
        [&mut *pressure, shear, slip, dissipation].into_iter().for_each(Piecewise::clear);
        let ([low, high], part) = (self.tractions.pressure.ends(), self.slipping_ends());
        [&mut *pressure, shear, slip, dissipation].into_iter().for_each(|profile| profile.push(low, 0.0));
        let stretches = [(low, part[0], false), (part[0], part[1], true), (part[1], high, false)];
        for (from, to, slips) in stretches.into_iter().filter(|(from, to, _)| to - from > 1e-9 * (high - low)) {
            let mut places = self.constants.tables.profile.map(|share| from + share * (to - from));
            places[PROFILE - 1] = to;
            let (p, q) = (self.tractions.pressure.density(&places), self.tractions.shear(&places));
            let mut s = if slips { self.slip(&places, &self.surface, true) } else { [0.0; PROFILE] };
            s[PROFILE - 1] = 0.0;
            for (i, &x) in places.iter().enumerate() {
                pressure.push(x, p[i]);
                shear.push(x, q[i]);
                slip.push(x, s[i]);
                dissipation.push(x, (-q[i] * s[i]).max(0.0));
            }
        }
        traction.pressure_max = self.tractions.pressure.peak();
    }
}

/// Scales a profile to the given integral; where it is zero itself it takes the shape of the `fallback`.
fn scale_to(profile: &mut Piecewise, total: f64, fallback: &Piecewise) {
    let factor = total / profile.integral();
    if factor.is_finite() {
        return profile.scale(factor);
    }
    profile.value.clone_from(&fallback.value);
    let load = profile.integral();
    profile.scale(if load > 0.0 { total / load } else { 0.0 });
}
