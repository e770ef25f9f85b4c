//! Mixed driving without end: the wheel starts from rest, accelerates, coasts over uneven track, brakes, blocks on a
//! wet rail, recovers on a dry one, stops, stands, and starts again with other speeds, moments, adhesion and loads.

use wheelrail::simulation::{Inputs, Model, Rotation, Simulation, StepError};

const DRY: f64 = 0.3;

/// Present action of the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Standing with the brake released.
    Rest,
    /// Traction up to the top speed of the cycle.
    Accelerate,
    /// No moment; the load swings and the track is inclined.
    Coast,
    /// Service brake on a dry rail.
    Brake,
    /// Full brake on a suddenly wet rail: the wheel loses its grip until it blocks.
    Skid,
    /// Blocked wheel sliding on the wet rail.
    Slide,
    /// Brake released, rail suddenly dry: the wheel is spun up by friction.
    Recover,
    /// Service brake down to walking speed.
    Stop,
    /// The brake holds the wheel, the vehicle comes to rest.
    Hold,
}

pub const PHASES: [Phase; 9] = {
    use Phase::*;
    [Rest, Accelerate, Coast, Brake, Skid, Slide, Recover, Stop, Hold]
};

/// Values that differ from cycle to cycle.
#[derive(Clone, Copy, Debug)]
struct Cycle {
    /// Speed at which traction ends [m/s].
    top_speed: f64,
    /// Moment of traction and of the brake over the dry adhesion limit [1].
    effort: f64,
    /// Friction coefficient of the wet rail [1].
    wet: f64,
    /// Amplitude over nominal load [1] and frequency [Hz] of the load.
    swing: (f64, f64),
    /// Downhill force [N].
    slope: f64,
}

impl Cycle {
    /// Cycle `number`: additive recurrence `½ + n φ⁻ᵏ mod 1` with `φ⁷ = φ + 1` (Roberts 2018), so that few cycles
    /// already cover all ranges and every run is the same.
    fn new(number: u64) -> Cycle {
        let share = |k: i32| (0.5 + (number + 1) as f64 * 1.112_775_684_278_705_5_f64.powi(-k)).fract();
        let between = |k, low: f64, high: f64| low + (high - low) * share(k);
        Cycle {
            top_speed: between(1, 4.0, 10.0),
            effort: between(2, 0.5, 0.8),
            wet: between(3, 0.05, 0.12),
            swing: (between(4, 0.05, 0.15), between(5, 1.0, 8.0)),
            slope: between(6, -800.0, 800.0),
        }
    }
}

/// Energy that appeared or vanished, and what friction dissipated, during one phase over the whole run, whole wheel
/// [J].
#[derive(Clone, Copy, Debug, Default)]
pub struct Balance {
    pub steps: u64,
    pub imbalance: f64,
    pub dissipation: f64,
}

/// A wheel with its driver.
pub struct Drive {
    pub simulation: Simulation,
    /// Communication step [s].
    step: f64,
    inputs: Inputs,
    pub phase: Phase,
    /// Steps since the start of the phase.
    age: u64,
    /// Completed cycles.
    pub cycles: u64,
    cycle: Cycle,
    /// By phase, in the order of [`PHASES`].
    pub balances: [Balance; PHASES.len()],
}

impl Drive {
    /// At rest, or rolling if the model starts so, under the nominal load; `step` [s] is the communication step.
    pub fn new(model: std::sync::Arc<Model>, step: f64) -> Result<Drive, StepError> {
        let inputs = Inputs::rolling(model.config());
        let simulation = Simulation::new(model, &inputs)?;
        let (phase, cycle) = (Phase::Rest, Cycle::new(0));
        Ok(Drive { simulation, step, inputs, phase, age: 0, cycles: 0, cycle, balances: Default::default() })
    }

    /// One communication step; on failure the run goes on in the next phase.
    pub fn step(&mut self) -> Result<(), StepError> {
        self.steer();
        let (before, phase) = (self.imbalance(), self.phase);
        let result = self.simulation.advance(&self.inputs, self.step);
        let (after, balance) = (self.imbalance(), &mut self.balances[phase as usize]);
        balance.steps += 1;
        balance.imbalance += after.0 - before.0;
        balance.dissipation += after.1 - before.1;
        self.age += 1;
        if result.is_err() || self.complete() {
            self.next_phase();
        }
        result
    }

    /// Unaccounted and dissipated energy since the start, whole wheel [J].
    fn imbalance(&self) -> (f64, f64) {
        let (audit, width) = (&self.simulation.state().audit, self.simulation.model().config().model.contact_width);
        (audit.imbalance() * width, audit.dissipation() * width)
    }

    /// Inputs of the next step.
    fn steer(&mut self) {
        let config = self.simulation.model().config();
        let (load, radius) = (config.model.nominal_load, config.wheel.radius);
        let time = self.age as f64 * self.step;
        let effort = self.cycle.effort * DRY * load * radius * (time / 0.2).min(1.0);
        let (drive, cycle) = (&mut self.inputs.drive, &self.cycle);
        drive.omega = 0.0;
        drive.force = 0.0;
        drive.load = load;
        drive.friction = DRY;
        self.inputs.rotation = Rotation::Moment;
        drive.moment = match self.phase {
            Phase::Rest | Phase::Recover => 0.0,
            Phase::Accelerate => effort,
            Phase::Coast => {
                drive.force = cycle.slope;
                drive.load *= 1.0 + cycle.swing.0 * (std::f64::consts::TAU * cycle.swing.1 * time).sin();
                0.0
            }
            Phase::Brake | Phase::Stop => -effort,
            Phase::Skid | Phase::Slide => {
                drive.friction = cycle.wet;
                -cycle.effort * DRY * load * radius
            }
            Phase::Hold => 0.0,
        };
        if matches!(self.phase, Phase::Slide | Phase::Hold) {
            self.inputs.rotation = Rotation::Velocity;
        }
    }

    /// True once the phase has reached its goal.
    fn complete(&self) -> bool {
        let (outputs, time) = (self.simulation.outputs(), self.age as f64 * self.step);
        let (speed, top) = (outputs.wheel_velocity, self.cycle.top_speed);
        match self.phase {
            Phase::Rest => time > 0.2,
            Phase::Accelerate => speed > top,
            Phase::Coast => time > 1.0,
            Phase::Brake => speed < 0.7 * top,
            Phase::Skid => outputs.wheel_omega < 0.5 || time > 2.0,
            Phase::Slide => time > 0.4 || speed < 1.0,
            Phase::Recover => time > 0.4,
            Phase::Stop => speed < 0.05,
            Phase::Hold => time > 0.5,
        }
    }

    fn next_phase(&mut self) {
        let next = self.phase as usize + 1;
        self.age = 0;
        if next == PHASES.len() {
            self.cycles += 1;
            self.cycle = Cycle::new(self.cycles);
        }
        self.phase = PHASES[next % PHASES.len()];
    }
}
