//! Access through variables that may be arrays, as FMI 3.0 has it.

use crate::course::Course;
use crate::instance::{Instance, Slave};
use crate::life::Life;
use crate::lifecycle::{Call, Phase};
use crate::log::{CallError, Outcome};
use crate::value::{ElementType, Reference, Scalar};

/// Value reference of the independent variable, the time, which every description has.
pub const TIME: Reference = 0;

/// Access to a slave through variables of one or many elements. Values stand in the order of the references, those of an array
/// in the order of its elements.
pub trait ArrayAccess: Slave {
    /// The instantiation token of the model description.
    fn token() -> String;

    /// Values of variables of one type, all but the time.
    fn read(&mut self, references: &[Reference], wanted: ElementType, life: &Life) -> Outcome<Vec<Scalar>>;

    /// Sets variables of one type, all or none; refuses more or fewer values than they have elements.
    fn write(&mut self, references: &[Reference], wanted: ElementType, values: Vec<Scalar>, life: &Life) -> Outcome;

    /// Derivatives of outputs along a direction of inputs: `seed` has a component for every known.
    fn directional(
        &mut self,
        _unknowns: &[Reference],
        _knowns: &[Reference],
        _seed: &[f64],
        _life: &Life,
    ) -> Outcome<Vec<f64>> {
        Err(CallError::error("directional derivatives are not provided"))
    }

    /// Time derivatives of real outputs, each of an order.
    fn output_rates(&mut self, _references: &[Reference], _orders: &[i32], _life: &Life) -> Outcome<Vec<f64>> {
        Err(CallError::error("derivatives of outputs are not provided"))
    }

    /// True if a master can give values of some inputs within a step.
    const INTERMEDIATE_UPDATE: bool = false;

    /// True for a real input of which a master can give values within a step.
    fn is_intermediate(_reference: Reference) -> bool {
        false
    }

    /// Present values of inputs that can be given within a step, each with the distance from a straight line that matters, in the
    /// unit of the variable.
    fn present(&mut self, _references: &[Reference], _life: &Life) -> Outcome<Vec<(f64, f64)>> {
        Ok(Vec::new())
    }

    /// Refuses a value of an input that can be given within a step.
    fn check_present(&self, _reference: Reference, _value: f64) -> Outcome {
        Ok(())
    }

    /// Simulates from `start` along a course of inputs, or to an event where steps may end early; returns the time it took \[s], that
    /// of the last point exactly without an event. Errors are those of [`Slave::step`].
    fn step_along(&mut self, _start: f64, _course: &Course, _life: &Life) -> Outcome<f64> {
        Err(CallError::error("inputs are held within a step"))
    }
}

/// Refuses another number of values than variables have.
pub fn check_length(argument: &str, given: usize, wanted: usize) -> Outcome {
    if given == wanted {
        return Ok(());
    }
    Err(CallError::error(format!("{argument} = {given}, but these variables have {wanted} values")))
}

impl<S: ArrayAccess> Instance<S> {
    /// Values of variables of one type, those that a master has set and start values before initialization.
    pub fn read(&mut self, references: &[Reference], wanted: ElementType) -> Outcome<Vec<Scalar>> {
        self.life().allow(Call::GetOrStart)?;
        let (slave, life) = self.parts();
        if wanted != ElementType::Float64 || !references.contains(&TIME) {
            return slave.read(references, wanted, life);
        }
        let mut values = Vec::new();
        for reference in references {
            match *reference {
                TIME => values.push(Scalar::Real(life.time())),
                _ => values.extend(slave.read(&[*reference], wanted, life)?),
            }
        }
        Ok(values)
    }

    /// Sets variables of one type, all or none; while the master is asked for values within a step, those at the time of the
    /// question.
    pub fn write(&mut self, references: &[Reference], wanted: ElementType, values: Vec<Scalar>) -> Outcome {
        if self.life().phase() == Phase::Intermediate {
            return self.write_intermediate(references, wanted, values);
        }
        self.life().allow(Call::Set)?;
        if references.contains(&TIME) {
            return Err(CallError::error("time is the independent variable and cannot be set"));
        }
        let (slave, life) = self.parts();
        slave.write(references, wanted, values, life)
    }

    /// Derivatives of outputs along a direction of inputs.
    pub fn directional(&mut self, unknowns: &[Reference], knowns: &[Reference], seed: &[f64]) -> Outcome<Vec<f64>> {
        self.life().allow(Call::GetDirectionalDerivative)?;
        check_length("nSeed", seed.len(), knowns.len())?;
        let (slave, life) = self.parts();
        slave.directional(unknowns, knowns, seed, life)
    }

    /// Derivatives of the sum of outputs, each with its finite weight in `seed`, by every known input: one directional derivative
    /// for each of these.
    pub fn adjoint(&mut self, unknowns: &[Reference], knowns: &[Reference], seed: &[f64]) -> Outcome<Vec<f64>> {
        self.life().allow(Call::GetDirectionalDerivative)?;
        if let Some((k, weight)) = (1..).zip(seed).find(|(_, weight)| !weight.is_finite()) {
            return Err(CallError::error(format!("seed[{k}] = {weight:?} is outside its range: finite numbers")));
        }
        let (slave, life) = self.parts();
        let by = |known: &Reference| {
            let column = slave.directional(unknowns, &[*known], &[1.0], life)?;
            check_length("nSeed", seed.len(), column.len())?;
            let sum: f64 = column.iter().zip(seed).map(|(derivative, weight)| derivative * weight).sum();
            let failed = || CallError::error(format!("adjoint derivative = {sum}: the seed is too large"));
            sum.is_finite().then_some(sum).ok_or_else(failed)
        };
        knowns.iter().map(by).collect()
    }

    /// Time derivatives of real outputs, each of an order.
    pub fn output_rates(&mut self, references: &[Reference], orders: &[i32]) -> Outcome<Vec<f64>> {
        self.life().allow(Call::GetRealOutputDerivatives)?;
        let (slave, life) = self.parts();
        slave.output_rates(references, orders, life)
    }
}
