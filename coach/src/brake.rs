//! Brake of a coach: control pressure, cylinders, wheel slide protection; the laws of `brake.py`.

use crate::AXLES;
use crate::parameters::Parameters;

/// Position of the valve of an axle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Valve {
    /// Follows the control pressure.
    Apply = 0,
    /// Keeps the pressure.
    Hold = 1,
    /// Lets the air out.
    Vent = 2,
}

/// The brakes of all axles.
#[derive(Clone, Debug)]
pub struct Brakes {
    /// Control pressure \[Pa].
    pub control: f64,
    waited: f64,
    /// Pressures of the cylinders \[Pa].
    pub pressures: [f64; AXLES],
    /// Air let into the cylinders, at ambient pressure \[m3].
    pub air: f64,
    /// The slide protection.
    pub protection: SlideProtection,
}

impl Brakes {
    /// Released brakes of a coach at a speed \[m/s].
    pub fn new(speed: f64) -> Self {
        let protection = SlideProtection::new(speed);
        Self { control: 0.0, waited: 0.0, pressures: [0.0; AXLES], air: 0.0, protection }
    }

    /// Torques \[N m] after `h` \[s] under a demand of 0 to 1; `speeds` are peripheral \[m/s].
    pub fn step(&mut self, p: &Parameters, h: f64, demand: f64, speeds: [f64; AXLES]) -> [f64; AXLES] {
        self.distribute(p, h, demand);
        self.protection.step(p, h, speeds);
        for (pressure, valve) in self.pressures.iter_mut().zip(self.protection.valves) {
            let before = *pressure;
            if valve == Valve::Vent {
                *pressure *= (-h / p.vent_time).exp();
            } else if valve == Valve::Apply || self.control < *pressure {
                *pressure += (self.control - *pressure) * -(-h / p.valve_fill_time).exp_m1();
            }
            self.air += p.cylinder_volume * (*pressure - before).max(0.0) / 101_325.0;
        }
        self.pressures.map(|pressure| p.torque * pressure / p.pressure)
    }

    /// Control pressure: 95 % of the full one in `fill_time`, down to 5 % in `release_time`, linearly, after a delay.
    fn distribute(&mut self, p: &Parameters, h: f64, demand: f64) {
        let target = demand * p.pressure;
        self.waited = if target > 0.0 { self.waited + h } else { 0.0 };
        if target > 0.0 && self.waited <= p.delay {
            return;
        }
        let (rise, fall) = (0.95 * p.pressure / p.fill_time, 0.95 * p.pressure / p.release_time);
        self.control += (target - self.control).clamp(-fall * h, rise * h);
    }
}

/// Slide and deceleration thresholds, and a reference speed from the axles themselves.
///
/// While it acts, one axle after the other is vented for a while, so that the reference does not sink with all of them.
#[derive(Clone, Debug)]
pub struct SlideProtection {
    /// Reference speed \[m/s].
    pub reference: f64,
    /// Positions of the valves.
    pub valves: [Valve; AXLES],
    waited: f64,
    before: [f64; AXLES],
    since_sounding: f64,
    sounded: usize,
    sounding_for: Option<f64>,
}

impl SlideProtection {
    fn new(speed: f64) -> Self {
        let (valves, before) = ([Valve::Apply; AXLES], [speed; AXLES]);
        Self { reference: speed, valves, waited: 0.0, before, since_sounding: 0.0, sounded: 0, sounding_for: None }
    }

    /// Decides every `period`; `speeds` are peripheral \[m/s].
    fn step(&mut self, p: &Parameters, h: f64, speeds: [f64; AXLES]) {
        if p.wsp_active == 0.0 {
            return;
        }
        self.waited += h;
        if self.waited < p.period - 1e-9 {
            return;
        }
        let fastest = speeds.into_iter().fold(f64::NEG_INFINITY, f64::max);
        self.reference = (self.reference - p.reference_deceleration * self.waited).max(fastest);
        let rates: [f64; AXLES] = std::array::from_fn(|k| (speeds[k] - self.before[k]) / self.waited);
        self.valves = std::array::from_fn(|k| self.decide(p, speeds[k], rates[k]));
        self.sound(p, self.waited, &rates);
        (self.before, self.waited) = (speeds, 0.0);
    }

    /// The valve of one axle from its peripheral speed \[m/s] and its acceleration \[m/s2].
    fn decide(&self, p: &Parameters, speed: f64, rate: f64) -> Valve {
        if self.reference < p.off_speed {
            return Valve::Apply;
        }
        let slide = self.reference - speed;
        let low = (p.slide_low * self.reference).max(p.least_slide);
        let high = (p.slide_high * self.reference).max(2.0 * p.least_slide);
        let returning = rate > p.recovery;
        if !returning && (slide > high || (slide > low && rate < -p.deceleration)) {
            Valve::Vent
        } else if slide > low || (returning && slide > 0.5 * low) {
            Valve::Hold
        } else {
            Valve::Apply
        }
    }

    /// Vents the axle whose turn it is to find the speed of the train.
    fn sound(&mut self, p: &Parameters, h: f64, rates: &[f64; AXLES]) {
        let acting = self.valves.iter().any(|valve| *valve != Valve::Apply);
        let so_far = match self.sounding_for {
            Some(so_far) => so_far,
            None => {
                self.since_sounding = if acting { self.since_sounding + h } else { 0.0 };
                if self.since_sounding < p.sounding {
                    return;
                }
                0.0
            }
        };
        let sounding_for = so_far + h;
        let rolls = sounding_for > 2.0 * p.vent_time && rates[self.sounded] < 0.5 * p.recovery;
        if rolls || sounding_for > p.longest_sounding || self.reference < p.off_speed {
            (self.sounded, self.sounding_for, self.since_sounding) = ((self.sounded + 1) % AXLES, None, 0.0);
        } else {
            self.sounding_for = Some(sounding_for);
            self.valves[self.sounded] = Valve::Vent;
        }
    }
}
