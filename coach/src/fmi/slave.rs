//! The coach as a slave: parameters, inputs and the running coach.

use super::description::{self, Version};
use super::variable::{Access, Variable};
use super::variables::{find, variables};
use crate::AXLES;
use crate::coupling::{Running, Seen};
use crate::parameters::Parameters;
use std::fmt::Debug;
use std::path::PathBuf;
use wheelrail_slave::array_access::check_length;
use wheelrail_slave::lifecycle::Phase;
use wheelrail_slave::{
    ArrayAccess, CallError, ElementType, Life, Outcome, Reference, Scalar, ScalarAccess, Slave, Type,
};

/// A coach with what its master has set.
pub struct CoachSlave {
    table: Vec<Variable>,
    state: CoachState,
}

/// Values that a master has set.
#[derive(Clone, Debug)]
struct CoachSettings {
    parameters: Parameters,
    seen: [Seen; AXLES],
    demand: f64,
}

impl Default for CoachSettings {
    fn default() -> Self {
        Self { parameters: Parameters::default(), seen: [Seen::default(); AXLES], demand: 1.0 }
    }
}

/// Everything that is needed to continue a run.
#[derive(Clone, Debug, Default)]
pub struct CoachState {
    settings: CoachSettings,
    /// `None` until outputs are wanted, and again when a parameter changes before the first step.
    running: Option<Running>,
}

impl CoachState {
    /// The coach, started if it is not running yet.
    fn running(&mut self) -> &mut Running {
        self.running.get_or_insert_with(|| Running::start(&self.settings.parameters))
    }

    /// Present value of a variable.
    fn value(&mut self, access: Access) -> Scalar {
        match access {
            Access::Parameter(row) => Scalar::Real(self.settings.parameters.value(row).copied().unwrap_or_default()),
            Access::Demand => Scalar::Real(self.settings.demand),
            Access::Seen(axle, field) => Scalar::Real(*field(&mut self.settings.seen[axle])),
            Access::Driven(axle, field) => Scalar::Real(field(&self.running().driven[axle])),
            Access::Output(read) => Scalar::Real(read(self.running())),
            Access::Valve(axle) => Scalar::Integer(self.running().brakes.protection.valves[axle] as i32),
        }
    }
}

impl CoachSlave {
    /// The variable of a reference.
    fn variable(&self, reference: Reference) -> Outcome<&Variable> {
        let found = self.table.iter().find(|variable| variable.reference == reference);
        found.ok_or_else(|| CallError::error(format!("value reference {reference} is unknown")))
    }

    /// Refuses a variable that is of another type than the wanted one.
    fn check_type<T: PartialEq + Debug>(variable: &Variable, theirs: T, wanted: T) -> Outcome {
        if theirs == wanted {
            return Ok(());
        }
        let Variable { name, reference, .. } = variable;
        Err(CallError::error(format!("{name} (value reference {reference}) is {theirs:?}, not {wanted:?}")))
    }

    /// Values of variables that `check` admits.
    fn values(&mut self, references: &[Reference], check: impl Fn(&Variable) -> Outcome) -> Outcome<Vec<Scalar>> {
        let access = |reference: &Reference| {
            let variable = self.variable(*reference)?;
            check(variable).map(|()| variable.access)
        };
        let accesses = references.iter().map(access).collect::<Outcome<Vec<_>>>()?;
        Ok(accesses.into_iter().map(|access| self.state.value(access)).collect())
    }

    /// Sets variables that `check` admits, all or none.
    fn set_values(
        &mut self,
        references: &[Reference],
        values: Vec<Scalar>,
        life: &Life,
        check: impl Fn(&Variable, &Scalar) -> Outcome,
    ) -> Outcome {
        let mut next = self.state.settings.clone();
        for (reference, value) in references.iter().zip(values) {
            let variable = self.variable(*reference)?;
            check(variable, &value)?;
            let output = || CallError::error(format!("{} is an output and cannot be set", variable.name));
            let Scalar::Real(number) = value else { return Err(output()) };
            variable.check(number).map_err(CallError::error)?;
            match variable.access {
                Access::Parameter(_) if !life.is_early() => {
                    let why = "is a fixed parameter and can only be set before the end of initialization";
                    return Err(CallError::error(format!("{} {why}", variable.name)));
                }
                Access::Parameter(row) => next.parameters.value(row).into_iter().for_each(|place| *place = number),
                Access::Demand => next.demand = number,
                Access::Seen(axle, field) => *field(&mut next.seen[axle]) = number,
                _ => return Err(output()),
            }
        }
        if next.parameters != self.state.settings.parameters {
            self.state.running = None;
        }
        self.state.settings = next;
        Ok(())
    }
}

impl Slave for CoachSlave {
    type State = CoachState;

    /// Longest step that resolves the primary suspension \[s].
    const LONGEST_STEP: f64 = 0.01;

    fn new(_resources: Option<PathBuf>) -> Outcome<Self> {
        Ok(Self { table: variables(), state: CoachState::default() })
    }

    fn initialize(&mut self, _life: &Life) -> Outcome<String> {
        Ok(String::new())
    }

    fn reset(&mut self) -> Outcome {
        self.state = CoachState::default();
        Ok(())
    }

    fn step(&mut self, _start: f64, h: f64, _life: &Life) -> Outcome {
        let CoachSettings { parameters, seen, demand } = self.state.settings.clone();
        self.state.running().step(&parameters, h, demand, &seen);
        Ok(())
    }

    fn save(&self) -> CoachState {
        self.state.clone()
    }

    fn restore(&mut self, state: &CoachState, _life: &Life) -> Outcome {
        self.state.clone_from(state);
        Ok(())
    }
}

impl ScalarAccess for CoachSlave {
    type Value = Scalar;

    fn guid() -> String {
        description::identity(Version::Two)
    }

    fn name_of(reference: Reference) -> Option<String> {
        find(reference).map(|variable| variable.name)
    }

    fn get(&mut self, references: &[Reference], wanted: Type, _life: &Life) -> Outcome<Vec<Scalar>> {
        self.values(references, |variable| Self::check_type(variable, variable.kind(), wanted))
    }

    fn set(&mut self, references: &[Reference], values: Vec<Scalar>, life: &Life) -> Outcome {
        self.set_values(references, values, life, |variable, value| {
            Self::check_type(variable, variable.kind(), value.of())
        })
    }
}

/// All variables are scalars.
impl ArrayAccess for CoachSlave {
    fn token() -> String {
        description::identity(Version::Three)
    }

    fn read(&mut self, references: &[Reference], wanted: ElementType, life: &Life) -> Outcome<Vec<Scalar>> {
        self.values(references, |variable| {
            if life.phase() == Phase::Instantiated && variable.causality() == "output" {
                let why = "is an output, which has no start value: read it from Initialization Mode on";
                return Err(CallError::error(format!("{} {why}", variable.name)));
            }
            Self::check_type(variable, variable.element_type(), wanted)
        })
    }

    fn write(&mut self, references: &[Reference], wanted: ElementType, values: Vec<Scalar>, life: &Life) -> Outcome {
        check_length("nValues", values.len(), references.len())?;
        self.set_values(references, values, life, |variable, _| {
            Self::check_type(variable, variable.element_type(), wanted)
        })
    }
}
