//! What is done once with a solution: histories move on, power and traction are taken.

use super::iterate::Iterate;
use super::state::{Past, PatchState, Tractions};
use super::surface::dot;
use super::tables::POWER;
use crate::contact::traction::Traction;
use crate::linalg::POINTS;
use crate::multistep::History;
use crate::piecewise::{Interval, Piecewise};
use nalgebra::DVector;
use std::f64::consts::PI;

/// Points of the profiles over the part that slips and the part that sticks.
const PROFILE: usize = 20;

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
        let force =
            |q: usize| half * tables.weights[q] * self.tractions.slide * self.tractions.pressure.density(places[q]);
        (places, std::array::from_fn(force))
    }

    /// Elastic energy of both half-planes [J/m].
    fn energy(&self) -> f64 {
        let Tractions { slide, stick, .. } = self.tractions;
        let pressed: f64 = self.pressed.iter().map(|place| place.force * place.logarithm).sum();
        let stuck =
            |place: &super::iterate::Place| place.force * (2.0 * slide * place.logarithm + stick.logarithm(place.x));
        let stuck = if stick.half_width > 0.0 { self.stuck.iter().map(stuck).sum() } else { 0.0 };
        -self.constants.half_plane.kernel * (pressed * (1.0 + slide * slide) + stuck)
    }

    /// Power of pressure on the slope of the rail that slides past it [W/m].
    fn slope_power(&self) -> f64 {
        let coupling = self.constants.half_plane.coupling;
        let slope = |place: &super::iterate::Place| {
            let smooth = dot(&self.constants.points.slopes(place.x), &self.surface.rail.normal);
            place.force * (smooth + coupling * self.tractions.slide * self.tractions.pressure.density(place.x))
        };
        let pressed: f64 = self.pressed.iter().map(slope).sum();
        let stuck = |place: &super::iterate::Place| place.force * coupling * self.tractions.pressure.density(place.x);
        (self.rim_velocity() - self.rigid[0]) * (pressed + self.stuck.iter().map(stuck).sum::<f64>())
    }

    /// Moves the histories on and takes the power: that of friction at the end of the step [W/m] and its energy in the step
    /// [J/m].
    fn remember(&self, slip: &[f64; POWER], force: &[f64; POWER], state: &mut PatchState) -> [f64; 2] {
        let time = &self.problem.time;
        state.tractions = self.tractions;
        let now = Past::Patch(self.tractions, self.surface.relative());
        let push = |history: &mut History, value: f64| match time.is_stationary() {
            true => *history = History::constant(value),
            false => history.push(time, value),
        };
        push(&mut state.turn, self.turn);
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
    pub(super) fn conclude(&self, state: &mut PatchState, traction: &mut Traction) {
        let (places, force) = self.slipping();
        let slip = places.map(|x| self.slip(x, &self.surface, true));
        let [friction, work] = self.remember(&slip, &force, state);
        let power = traction.dissipate(friction, work, self.problem.duration);
        traction.friction = self.friction;
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
        let sum: f64 = self.pressed.iter().map(|place| place.force * self.slip(place.x, &self.surface, true)).sum();
        sum / self.load()
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
                (loads[0][port], loads[1][port]) = (force, -force);
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
        let mut peak = 0.0_f64;
        let mut add = |x: f64, slips: bool| {
            let p = self.tractions.pressure.density(x);
            let (q, s) = (self.tractions.shear(x), if slips { self.slip(x, &self.surface, true) } else { 0.0 });
            peak = peak.max(p);
            for (profile, value) in [(&mut *pressure, p), (shear, q), (slip, s), (dissipation, (-q * s).max(0.0))] {
                profile.push(x, value);
            }
        };
        let between = |from: f64, to: f64, k: usize| {
            let c = (PI * k as f64 / PROFILE as f64).cos();
            0.5 * (from * (1.0 + c) + to * (1.0 - c))
        };
        add(low, false);
        let stretches = [(low, part[0], false), (part[0], part[1], true), (part[1], high, false)];
        for (from, to, slips) in stretches.into_iter().filter(|(from, to, _)| to - from > 1e-9 * (high - low)) {
            for k in 1..=PROFILE {
                let x = between(from, to, k);
                add(if k == PROFILE { to } else { x }, slips && k < PROFILE);
            }
        }
        traction.pressure_max = self.peak(peak);
    }

    /// Largest pressure \[Pa]: of the parabola through `p²` about the largest of the samples, whose value `found` is.
    fn peak(&self, found: f64) -> f64 {
        let pressure = &self.tractions.pressure;
        let at = |t: f64| pressure.density(pressure.centre + t * pressure.half_width);
        // The maximum lies near the middle: Newton's method on the slope of the pressure, by differences.
        let (mut t, h) = (0.0, 1e-3);
        for _ in 0..4 {
            let (low, mid, high) = (at(t - h), at(t), at(t + h));
            let bend = high - 2.0 * mid + low;
            if bend >= 0.0 {
                return found;
            }
            t = (t - 0.5 * h * (high - low) / bend).clamp(-0.5, 0.5);
        }
        at(t).max(found)
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
