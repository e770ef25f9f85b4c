//! A master without manners: tens of thousands of random legal and illegal calls through the C functions of the
//! compiled library, in random order, with ordinary, extreme and impossible values.
//!
//! Deterministic: call sequences follow from a seed. `WHEELRAIL_ABUSE_CALLS` asks for more calls than the usual 8,000,
//! `WHEELRAIL_ABUSE_SEED` for the sequence of one seed only; a failure prints its seed and the last calls.
//!
//! After every call:
//! - the status is OK, Discard (steps only) or Error, never Warning, Pending or Fatal, and is the one that the state
//!   machine of the standard and the declared ranges demand;
//! - all real outputs are finite and within their declared ranges; temperatures are at least 1 K in calm runs below
//!   melting (known limit: in wild ones, steps much longer than the passage of a hot spot through the contact
//!   undershoot where it is carried away);
//! - unless the call was a success that may change outputs, they are those before it, bit for bit;
//! - a restored state has the outputs of the moment when it was saved;
//! - after a reset, the first steps are those of a new instance, bit for bit.
//!
//! Half of the runs are calm: driven by service moments, forces and loads with steps of at most 2 ms. Only in these the
//! energy residual is bounded; wild runs step over whole collisions, and then it says nothing (measured: from -1e6 to
//! 1e5). `tests/endurance.rs` has the bounds of driving.
#![allow(unsafe_code)]

use crate::common::{self, Random};
use crate::slave::*;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ptr;
use std::sync::OnceLock;
use wheelrail::fmi::lifecycle::{Call, Phase};
use wheelrail::fmi::v2::variables::variables;
use wheelrail::fmi::variable::{Causality, Kind, Variable};

/// Values that no real variable may take, and extremes of the number format.
const ODD: [f64; 7] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 1e30, -1e30];
/// Energy that calm runs may create, over that dissipated or the elastic energy of the contact: jumps of inputs within
/// steps are known to the time formula only by their ends (measured before in 24,000 calls, three times those of the
/// test: 1.4).
const MOST_CREATED: f64 = 5.0;
/// Energy that calm runs may lose: the time formula damps the vibrations that each jump of the load excites, of about
/// the elastic energy of the contact each (measured: 11).
const MOST_LOST: f64 = 40.0;
/// Above this the model means nothing, but must stay sane [K].
const MELTING: f64 = 2000.0;
const UNKNOWN: u32 = 987_654;

/// An instance that finds the basis of the coarse model.
fn new_slave(dll: &libfmi::Fmi2Dll) -> Slave<'_> {
    let arguments = Arguments { resources: Some(STORED_BASES), ..Default::default() };
    Slave::try_new(dll, &arguments).unwrap_or_else(|m| panic!("{m:?}"))
}

/// Outputs of the first steps of a new instance.
fn fresh(dll: &libfmi::Fmi2Dll) -> &'static Vec<Vec<u64>> {
    static RUN: OnceLock<Vec<Vec<u64>>> = OnceLock::new();
    RUN.get_or_init(|| {
        let slave = new_slave(dll);
        slave.coarsen();
        slave.initialize();
        slave.brake(0)
    })
}

/// A state that the master holds, and what it was like.
struct Saved {
    handle: libfmi::fmi2FMUstate,
    phase: Phase,
    time: f64,
    calm: bool,
    outputs: Option<Vec<u64>>,
}

/// Answers that a call may give.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expect {
    Ok,
    Refused,
    /// A step may fail, a stationary state may not exist.
    Either,
}

fn expect(ok: bool) -> Expect {
    if ok { Expect::Ok } else { Expect::Refused }
}

struct Master<'a> {
    slave: Slave<'a>,
    random: Random,
    seed: u64,
    phase: Phase,
    time: f64,
    /// True while the run since the last initialization has been free of jumps.
    calm: bool,
    saved: Vec<Saved>,
    /// All real outputs, where they can be read.
    outputs: Option<Vec<u64>>,
    /// Highest temperature of these [K].
    hottest: f64,
    trace: VecDeque<String>,
    calls: usize,
    steps: usize,
    discarded: usize,
    /// True once a ramp may be given: the other way to give it is refused then.
    ramped: bool,
    resets: usize,
}

impl<'a> Master<'a> {
    fn new(dll: &'a libfmi::Fmi2Dll, seed: u64) -> Self {
        Master {
            slave: new_slave(dll),
            random: Random(seed),
            seed,
            phase: Phase::Instantiated,
            time: 0.0,
            calm: true,
            saved: Vec::new(),
            outputs: None,
            hottest: 0.0,
            trace: VecDeque::new(),
            calls: 0,
            steps: 0,
            discarded: 0,
            ramped: false,
            resets: 0,
        }
    }

    fn chance(&mut self, share: f64) -> bool {
        self.random.between(0.0, 1.0) < share
    }

    fn fail(&self, why: &str) -> ! {
        let calls: Vec<&str> = self.trace.iter().map(String::as_str).collect();
        panic!("seed {}, call {}: {why}\n{}", self.seed, self.calls, calls.join("\n"))
    }

    /// Checks what the call `text` answered. `silent`: it may not change outputs even if it succeeds.
    fn check(&mut self, text: String, status: fmi2Status, expected: Expect, silent: bool) -> bool {
        self.calls += 1;
        if self.trace.len() == 40 {
            self.trace.pop_front();
        }
        let reason = self.slave.messages().pop().map_or(String::new(), |message| message.text);
        self.trace.push_back(format!("  {:?} t = {}: {text} -> {status:?} {reason}", self.phase, self.time));
        let fits = match expected {
            Expect::Ok => status == fmi2OK,
            Expect::Refused => status == fmi2Error,
            Expect::Either => matches!(status, fmi2OK | fmi2Discard | fmi2Error),
        };
        if !fits {
            self.fail(&format!("expected {expected:?}, got {status:?}"));
        }
        if status != fmi2OK && reason.is_empty() {
            self.fail("no reason given");
        }
        self.observe(status != fmi2OK || silent);
        status == fmi2OK
    }

    /// Reads and checks all outputs; `unchanged`: they must be those read before.
    fn observe(&mut self, unchanged: bool) {
        if !Call::Get.legal(self.phase) {
            self.outputs = None;
            return;
        }
        let wanted = |v: &&Variable| v.causality() == Causality::Output && matches!(v.kind, Kind::Real { .. });
        let rows: Vec<&Variable> = variables().iter().filter(wanted).collect();
        let references: Vec<u32> = rows.iter().map(|v| v.reference).collect();
        let Ok(values) = self.slave.get_reals(&references) else {
            // Only a missing stationary state may keep outputs away.
            self.slave.messages();
            if self.phase != Phase::Initialization || (unchanged && self.outputs.is_some()) {
                self.fail("outputs cannot be read");
            }
            self.outputs = None;
            return;
        };
        let is_relative = |v: &Variable| matches!(v.kind, Kind::Real { measure, .. } if measure.is_relative());
        let is_temperature = |v: &Variable| v.name.contains("temperature") && !is_relative(v);
        let kelvins = rows.iter().zip(&values).filter(|(row, _)| is_temperature(row)).map(|(_, value)| *value);
        let hottest = kelvins.fold(0.0, f64::max);
        let before = std::mem::replace(&mut self.hottest, hottest);
        let hottest = hottest.max(before);
        let coldest = if self.calm && hottest < MELTING { 1.0 } else { f64::MIN };
        for (row, value) in rows.iter().zip(&values) {
            if !value.is_finite() {
                self.fail(&format!("{} = {value}", row.name));
            }
            if row.name == "solver.energy_residual" && self.calm && !(-MOST_CREATED..=MOST_LOST).contains(value) {
                self.fail(&format!("{} = {value}", row.name));
            }
            if is_temperature(row) && *value != 0.0 && *value < coldest {
                self.fail(&format!("{} = {value} K", row.name));
            }
            if let (false, Kind::Real { min, max, .. }) = (is_temperature(row), row.kind)
                && !(min..=max).contains(value)
            {
                self.fail(&format!("{} = {value} is outside its declared range {min} to {max}", row.name));
            }
        }
        let bits: Vec<u64> = values.into_iter().map(f64::to_bits).collect();
        if unchanged
            && let Some(before) = &self.outputs
            && let Some(i) = (0..bits.len()).find(|&i| before[i] != bits[i])
        {
            let (was, is) = (f64::from_bits(before[i]), f64::from_bits(bits[i]));
            self.fail(&format!("{} was {was} and is {is}", rows[i].name));
        }
        self.outputs = Some(bits);
    }

    /// One random call; a run that does not step is often taken further.
    fn call(&mut self) {
        if !Call::DoStep.legal(self.phase) && self.chance(0.3) {
            return if self.phase == Phase::Terminated { self.reset() } else { self.lifecycle() };
        }
        match self.random.below(100) {
            0..30 => self.step(),
            30..52 => self.set_input(),
            52..57 => self.set_control(),
            57..60 => self.set_parameter(),
            60..65 => self.set_nonsense(),
            65..69 => self.set_rate(),
            69..72 => self.get_nonsense(),
            72..77 => self.save(),
            77..81 => self.restore(),
            81..82 => self.differentiate(),
            82..85 => self.serialize(),
            85..89 => self.ask(),
            89..97 => self.lifecycle(),
            97..99 => self.logging(),
            _ => self.reset(),
        }
    }

    fn step(&mut self) {
        let legal = !self.chance(0.1);
        let h = match (legal, self.calm) {
            (true, true) => self.random.logarithmic(1e-6, 2e-3),
            (true, false) if self.chance(0.1) => {
                // A second takes as long as hundreds of other calls.
                let longest = if self.chance(0.1) { 1.0 } else { 0.1 };
                self.random.logarithmic(1e-2, longest)
            }
            (true, false) => self.random.logarithmic(1e-6, 1e-2),
            _ => self.random.of(&[0.0, -1e-3, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 3601.0]),
        };
        let right = !self.chance(0.05);
        let t =
            if right { self.time } else { self.random.of(&[self.time + 0.5 + h.abs(), -7.0, f64::NAN, f64::INFINITY]) };
        let status = self.slave.step(t, h);
        let allowed = legal && right && Call::DoStep.legal(self.phase);
        if allowed {
            self.steps += 1;
            match status {
                fmi2OK => (self.phase, self.time) = (Phase::StepComplete, t + h),
                fmi2Discard => {
                    self.phase = Phase::StepFailed;
                    self.discarded += 1;
                }
                _ => {}
            }
        }
        let expected = if allowed { Expect::Either } else { Expect::Refused };
        self.check(format!("DoStep({t}, {h})"), status, expected, false);
    }

    fn is_early(&self) -> bool {
        matches!(self.phase, Phase::Instantiated | Phase::Initialization)
    }

    /// A value of the input, ordinary unless the run is wild.
    fn input_value(&mut self, name: &str, min: f64, max: f64) -> f64 {
        let sign = self.random.sign();
        let ordinary = match name {
            "drive.omega" => self.random.between(-60.0, 60.0),
            "drive.velocity" => self.random.between(-28.0, 28.0),
            "drive.moment" => sign * self.random.logarithmic(1.0, 2e4),
            "drive.force" => sign * self.random.logarithmic(1.0, 2e4),
            "drive.load" => self.random.between(6e4, 1.4e5),
            "drive.displacement" => self.random.between(-1.2e-4, 5e-5),
            "rail.friction" => self.random.logarithmic(0.02, 0.7),
            _ => self.random.between(0.0, 5e4),
        };
        if self.calm {
            return ordinary;
        }
        match self.random.below(20) {
            0 => min,
            1 => max,
            2 => 0.0,
            3 if min < 0.0 => -ordinary,
            4 => self.random.between(min, max),
            5 => f64::MIN_POSITIVE,
            6 => self.random.of(&ODD),
            7 => max * (1.0 + 1e-15) + 1.0,
            _ => ordinary,
        }
    }

    fn set_input(&mut self) {
        let inputs: Vec<&Variable> = variables().iter().filter(|v| matches!(v.kind, Kind::Real { .. })).collect();
        let inputs: Vec<&Variable> = inputs.into_iter().filter(|v| v.causality() == Causality::Input).collect();
        let count = 1 + self.random.below(3);
        let (mut references, mut values, mut legal, mut text) = (vec![], vec![], true, String::new());
        for _ in 0..count {
            let variable = self.random.of(&inputs);
            let Kind::Real { min, max, .. } = variable.kind else { unreachable!() };
            let value = self.input_value(variable.name, min, max);
            legal &= (min..=max).contains(&value);
            references.push(variable.reference);
            values.push(value);
            text += &format!("{} = {value:?} ", variable.name);
        }
        let status = self.slave.set_reals(&references, &values);
        let mut expected = expect(legal && Call::Set.legal(self.phase));
        if text.contains("_rate") && legal && std::mem::replace(&mut self.ramped, true) {
            expected = Expect::Either;
        }
        let silent = !self.is_early();
        self.check(format!("SetReal({text})"), status, expected, silent);
    }

    fn set_control(&mut self) {
        let name = self.random.of(&["control.rotation", "control.translation", "control.vertical"]);
        let usual = if name == "control.vertical" { 1 } else { 2 };
        let value = if self.calm { usual } else { self.random.of(&[1, 2, 1, 2, 0, 3, -1, i32::MAX, i32::MIN]) };
        let status = self.slave.set_integer(name, value);
        let expected = expect((1..=2).contains(&value) && Call::Set.legal(self.phase));
        let silent = !self.is_early();
        self.check(format!("SetInteger({name} = {value})"), status, expected, silent);
    }

    /// Legal parameters; refused once the run has begun, but for tunable ones.
    fn set_parameter(&mut self) {
        let pairs = [
            ("initial.velocity", -30.0, 30.0),
            ("initial.creepage", -0.01, 0.01),
            ("friction.coefficient", 0.01, 0.9),
            ("friction.falling_ratio", 0.0, 1.0),
            ("friction.falling_decay", 0.0, 2.0),
            ("vehicle.mass", 0.0, 2e4),
            ("wheel.hub_mass", 0.0, 500.0),
            ("material.conductivity", 1.0, 100.0),
            ("thermal.conductance", 0.0, 1e9),
            ("thermal.reference", 200.0, 400.0),
            ("thermal.wheel_excess", -50.0, 300.0),
            ("solver.max_step", 1e-3, 0.1),
            ("solver.tolerance", 0.01, 0.1),
        ];
        let (name, low, high) = self.random.of(&pairs);
        let value = self.random.between(low, high);
        let expected = expect(self.is_early());
        let tunable = variable(name).tunable && Call::Set.legal(self.phase);
        let status = self.slave.set_real(name, value);
        let silent = !self.is_early();
        self.check(format!("SetReal({name} = {value:?})"), status, expect(self.is_early() || tunable), silent);
        let flag = self.random.of(&["thermal.enabled", "physics.yielding", "physics.thermoelastic_heating"]);
        let on = self.random.below(2) == 0;
        let status = self.slave.set_boolean(flag, on);
        self.check(format!("SetBoolean({flag} = {on})"), status, expected, false);
        let hub = 1 + self.random.below(2) as i32;
        let status = self.slave.set_integer("thermal.hub", hub);
        self.check(format!("SetInteger(thermal.hub = {hub})"), status, expected, false);
    }

    /// Things that cannot be set at any time.
    fn set_nonsense(&mut self) {
        let load = variable("drive.load").reference;
        let (dll, c) = (self.slave.dll, self.slave.component);
        let (text, status) = unsafe {
            match self.random.below(9) {
                0 => ("unknown reference", self.slave.set_reals(&[load, UNKNOWN], &[1.0, 1.0])),
                1 => ("output", self.slave.set_real("contact.force_x", 1.0)),
                2 => ("Integer into Real", self.slave.set_integer("drive.load", 1)),
                3 => ("Boolean into Real", self.slave.set_boolean("drive.load", true)),
                4 => ("String into Real", self.slave.set_string("drive.load", "%s%n")),
                5 => ("NULL references", dll.fmi2SetReal(c, ptr::null(), 1, &1.0)),
                6 => ("NULL values", dll.fmi2SetReal(c, &load, 1, ptr::null())),
                7 => ("NULL string", dll.fmi2SetString(c, &variable("preset").reference, 1, &ptr::null())),
                _ => ("unknown preset", self.slave.set_string("preset", "../../etc/passwd")),
            }
        };
        self.check(format!("Set: {text}"), status, Expect::Refused, true);
    }

    fn set_rate(&mut self) {
        let name = self.random.of(&["drive.load", "drive.moment", "rail.friction", "drive.velocity", "wheel.omega"]);
        let order = if self.chance(0.2) { self.random.of(&[0, 2, -1, i32::MAX]) } else { 1 };
        let value = if self.chance(0.1) { self.random.of(&ODD) } else { self.random.between(-10.0, 10.0) };
        let legal = name != "wheel.omega" && order == 1 && value.is_finite();
        // A ramp that leaves the range is refused by the step.
        self.calm &= !legal;
        let mut expected = expect(legal && Call::SetRealInputDerivatives.legal(self.phase));
        if legal && std::mem::replace(&mut self.ramped, true) {
            expected = Expect::Either;
        }
        let status = self.slave.set_rate(name, order, value);
        self.check(format!("SetRealInputDerivatives({name}, {order}, {value:?})"), status, expected, true);
    }

    fn get_nonsense(&mut self) {
        let load = variable("drive.load").reference;
        let (dll, c) = (self.slave.dll, self.slave.component);
        let legal = Call::Get.legal(self.phase);
        let (text, status, expected) = unsafe {
            match self.random.below(8) {
                0 => ("unknown reference", self.slave.get_reals(&[load, UNKNOWN]).err().unwrap(), Expect::Refused),
                1 => ("NULL references", dll.fmi2GetReal(c, ptr::null(), 1, &mut 0.0), Expect::Refused),
                2 => ("NULL values", dll.fmi2GetReal(c, &load, 1, ptr::null_mut()), Expect::Refused),
                3 => ("Integer of Real", dll.fmi2GetInteger(c, &load, 1, &mut 0), Expect::Refused),
                4 => ("String of Real", dll.fmi2GetString(c, &load, 1, &mut ptr::null()), Expect::Refused),
                5 => ("nothing", dll.fmi2GetReal(c, ptr::null(), 0, ptr::null_mut()), expect(legal)),
                6 => ("NULL places", dll.fmi2GetFMUstate(c, ptr::null_mut()), Expect::Refused),
                _ => ("NULL state", dll.fmi2SetFMUstate(c, ptr::null_mut()), Expect::Refused),
            }
        };
        self.check(format!("Get: {text}"), status, expected, true);
    }

    /// Derivatives of all outputs along a random direction, and in time; they leave no trace.
    fn differentiate(&mut self) {
        let real = |v: &&Variable| matches!(v.kind, Kind::Real { .. });
        let outputs = variables().iter().filter(real).filter(|v| v.causality() == Causality::Output);
        let references: Vec<u32> = outputs.map(|v| v.reference).collect();
        let inputs: Vec<&Variable> = variables().iter().filter(real).collect();
        let inputs: Vec<&Variable> = inputs.into_iter().filter(|v| v.causality() == Causality::Input).collect();
        let (count, input) = (references.len(), self.random.of(&inputs));
        let seed = if self.chance(0.1) { self.random.of(&ODD) } else { self.random.between(-1.0, 1.0) };
        let mut values = vec![0.0; count];
        let (dll, c) = (self.slave.dll, self.slave.component);
        let (first, place) = (references.as_ptr(), values.as_mut_ptr());
        let status = unsafe { dll.fmi2GetDirectionalDerivative(c, first, count, &input.reference, 1, &seed, place) };
        let legal = Call::GetDirectionalDerivative.legal(self.phase) && seed.is_finite();
        // At a kink to both sides, and where no stationary state exists, there is none.
        let expected = if legal { Expect::Either } else { Expect::Refused };
        self.check(format!("GetDirectionalDerivative({}, {seed:?})", input.name), status, expected, true);
        let (orders, place) = (vec![1; count], values.as_mut_ptr());
        let status = unsafe { dll.fmi2GetRealOutputDerivatives(c, first, count, orders.as_ptr(), place) };
        let legal = Call::GetRealOutputDerivatives.legal(self.phase);
        self.check("GetRealOutputDerivatives".to_owned(), status, expect(legal), true);
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            self.fail(&format!("a derivative is {value}"));
        }
    }

    fn save(&mut self) {
        let overwrite = self.saved.len() > 20 || (!self.saved.is_empty() && self.chance(0.5));
        let at = if overwrite { self.random.below(self.saved.len()) } else { self.saved.len() };
        let mut handle = if overwrite { self.saved[at].handle } else { ptr::null_mut() };
        let status = self.slave.save(&mut handle);
        self.check(format!("GetFMUstate -> {at}"), status, Expect::Ok, true);
        let state =
            Saved { handle, phase: self.phase, time: self.time, calm: self.calm, outputs: self.outputs.clone() };
        if overwrite { self.saved[at] = state } else { self.saved.push(state) }
    }

    fn restore(&mut self) {
        if self.saved.is_empty() {
            return;
        }
        let at = self.random.below(self.saved.len());
        let status = self.slave.restore(self.saved[at].handle);
        let Saved { phase, time, calm, outputs, .. } = &self.saved[at];
        (self.phase, self.time, self.calm) = (*phase, *time, *calm);
        self.outputs.clone_from(outputs);
        self.check(format!("SetFMUstate {at}"), status, Expect::Ok, true);
        if self.chance(0.2) {
            let mut freed = self.saved.swap_remove(at);
            let status = self.slave.free_state(&mut freed.handle);
            self.check(format!("FreeFMUstate {at}"), status, Expect::Ok, true);
        }
    }

    /// A state as bytes and back; damaged bytes are refused.
    fn serialize(&mut self) {
        if self.saved.is_empty() {
            return;
        }
        let at = self.random.below(self.saved.len());
        let mut bytes = self.slave.serialize(self.saved[at].handle);
        if self.chance(0.3) {
            let status = self.slave.deserialize(&bytes, &mut self.saved[at].handle);
            self.check(format!("DeSerializeFMUstate {at}"), status, Expect::Ok, true);
            return;
        }
        let place = self.random.below(bytes.len());
        if self.chance(0.5) {
            bytes.truncate(place)
        } else {
            bytes[place] ^= 1 << self.random.below(8)
        }
        let status = self.slave.deserialize(&bytes, &mut ptr::null_mut());
        self.check(format!("DeSerializeFMUstate, damaged at {place}"), status, Expect::Refused, true);
    }

    fn ask(&mut self) {
        let legal = Call::GetStatus.legal(self.phase);
        if legal && self.slave.last_successful_time() != self.time {
            self.fail(&format!("last successful time {}", self.slave.last_successful_time()));
        }
        if legal && self.phase == Phase::StepComplete && self.slave.terminated() {
            self.fail("terminated after a successful step");
        }
        let status = unsafe { self.slave.dll.fmi2CancelStep(self.slave.component) };
        self.check("CancelStep".to_owned(), status, Expect::Refused, true);
    }

    fn lifecycle(&mut self) {
        match self.random.below(8) {
            0 => {
                let start = self.random.of(&[0.0, 1e6, -5.0, f64::NAN]);
                let expected = expect(start.is_finite() && Call::SetupExperiment.legal(self.phase));
                let status = self.slave.setup(start, None);
                if status == fmi2OK {
                    self.time = start;
                }
                self.check(format!("SetupExperiment({start})"), status, expected, true);
            }
            1 if self.chance(0.2) => {
                let expected = expect(Call::Terminate.legal(self.phase));
                let status = self.slave.terminate();
                if status == fmi2OK {
                    self.phase = Phase::Terminated;
                }
                self.check("Terminate".to_owned(), status, expected, true);
            }
            2..5 => {
                let expected = expect(Call::EnterInitializationMode.legal(self.phase));
                let status = self.slave.enter();
                if status == fmi2OK {
                    self.phase = Phase::Initialization;
                }
                self.check("EnterInitializationMode".to_owned(), status, expected, true);
            }
            _ => {
                let legal = Call::ExitInitializationMode.legal(self.phase);
                let status = self.slave.exit();
                if status == fmi2OK {
                    self.phase = Phase::StepComplete;
                }
                let expected = if legal { Expect::Either } else { Expect::Refused };
                self.check("ExitInitializationMode".to_owned(), status, expected, true);
                // A run without a stationary state, or terminated, starts anew.
                if status != fmi2OK && (legal || self.phase == Phase::Terminated) {
                    self.reset();
                }
            }
        }
    }

    fn logging(&mut self) {
        let on = self.random.below(2) == 0;
        let name = self.random.of(&["logEvents", "logAll", "logStatusError", "%n%s", ""]);
        let status = self.slave.set_logging(on, &[name]);
        self.check(format!("SetDebugLogging({on}, {name})"), status, expect(name.starts_with("log")), true);
    }

    /// Resets; the first steps afterwards are those of a new instance. Then another run with other parameters begins.
    fn reset(&mut self) {
        self.resets += 1;
        for again in [true, false] {
            let status = self.slave.reset();
            (self.phase, self.time) = (Phase::Instantiated, 0.0);
            self.check("Reset".to_owned(), status, Expect::Ok, false);
            self.slave.coarsen();
            if again {
                self.slave.initialize();
                if self.slave.brake(0) != *fresh(self.slave.dll) {
                    self.fail("a reset instance differs from a new one");
                }
            }
        }
        self.calm = self.chance(0.5);
    }
}

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|error| panic!("{variable} = {text}: {error}")))
}

fn abuse(seed: u64, calls: usize) {
    let config = common::preset("railway", 4);
    common::model(config);
    let dll = load();
    let mut master = Master::new(&dll, seed);
    master.reset();
    while master.calls < calls {
        master.call();
    }
    let Master { calls, steps, discarded, resets, .. } = master;
    println!("seed {seed}: {calls} calls, {steps} steps, {discarded} discarded, {resets} resets");
    assert!(steps > calls / 10 && discarded > 0 && resets > 3, "a master that does nothing proves nothing");
}

#[test]
fn no_sequence_of_calls_breaks_an_instance() {
    let calls = number("WHEELRAIL_ABUSE_CALLS").unwrap_or(8_000) as usize;
    match number("WHEELRAIL_ABUSE_SEED") {
        Some(seed) => abuse(seed, calls),
        None => (1..=8).into_par_iter().for_each(|seed| abuse(seed, calls / 8)),
    }
}
