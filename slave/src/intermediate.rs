//! Values of inputs within a step, as FMI 3.0 has it: intermediate update.
//!
//! A master is asked for them before a step is computed, at a quarter, a half, three quarters and the end of the step. Where an
//! input bends more than its slave cares for, the master is asked for values in the middle of the pieces, again and again. So
//! nothing is computed while the master has control, and what it sets is kept apart until the step begins.

use crate::array_access::{ArrayAccess, check_length};
use crate::course::Inquiry;
use crate::instance::Instance;
use crate::lifecycle::{Call, Phase};
use crate::log::{CallError, Outcome, Status};
use crate::value::{ElementType, Reference, Scalar};

impl<S: ArrayAccess> Instance<S> {
    /// Takes the variables that a master may set within steps; others that it names are told and left out.
    pub fn require_intermediate(&mut self, references: &[Reference]) -> Outcome {
        if let Some(first) = references.first()
            && !S::INTERMEDIATE_UPDATE
        {
            let why = "this FMU has no intermediate update (providesIntermediateUpdate = false): require no variables";
            return Err(CallError::error(format!("requiredIntermediateVariables begins with {first}, but {why}")));
        }
        let (mut chosen, others): (Vec<_>, Vec<_>) =
            references.iter().partition(|reference| S::is_intermediate(**reference));
        if let Some(first) = others.first() {
            let message = format!(
                "requiredIntermediateVariables has {} variables without intermediateUpdate = true, such as {first}: they are not \
                 accessed within steps",
                others.len()
            );
            self.log().report(Status::Warning, &message);
        }
        chosen.sort_unstable();
        chosen.dedup();
        self.intermediate = chosen;
        Ok(())
    }

    /// Begins to ask for values within a step.
    pub fn begin_inquiry(&mut self, start: f64, h: f64) -> Outcome {
        self.life().allow(Call::DoStep)?;
        self.life().check_step(start, h, S::LONGEST_STEP)?;
        let references = self.intermediate.clone();
        let (slave, life) = self.parts();
        let present = slave.present(&references, life)?;
        self.inquiry = Some(Inquiry::new(references, present, (start, h), self.life().phase()));
        Ok(())
    }

    /// Takes what the master has set since the last question and returns the time of the next one \[s]; until then the instance
    /// is in Intermediate Update Mode. `None` if there are no more questions.
    pub fn next_question(&mut self) -> Option<f64> {
        let inquiry = self.inquiry.as_mut()?;
        let time = inquiry.next().map(|share| inquiry.start + share * inquiry.length);
        let phase = if time.is_some() { Phase::Intermediate } else { inquiry.before };
        self.enter(phase);
        time
    }

    /// Keeps values of variables at the time of the open question, all or none.
    pub(crate) fn write_intermediate(
        &mut self,
        references: &[Reference],
        wanted: ElementType,
        values: Vec<Scalar>,
    ) -> Outcome {
        self.life().allow(Call::SetIntermediate)?;
        check_length("nValues", values.len(), references.len())?;
        let Some(inquiry) = &self.inquiry else { return Err(CallError::error("no value is asked for")) };
        let place = |reference: &Reference| {
            let missing = || {
                format!(
                    "{reference} is none of the inputs in requiredIntermediateVariables: only these can be set within a step"
                )
            };
            inquiry.references.binary_search(reference).map_err(|_| CallError::error(missing()))
        };
        let places = references.iter().map(place).collect::<Outcome<Vec<usize>>>()?;
        let numbers = values.into_iter().map(|value| match value {
            Scalar::Real(number) if wanted == ElementType::Float64 => Ok(number),
            _ => Err(CallError::error("only real inputs can be set within a step")),
        });
        let numbers = numbers.collect::<Outcome<Vec<f64>>>()?;
        references
            .iter()
            .zip(&numbers)
            .try_for_each(|(reference, number)| self.slave().check_present(*reference, *number))?;
        if let Some(inquiry) = &mut self.inquiry {
            for (place, number) in places.into_iter().zip(numbers) {
                (inquiry.values[place], inquiry.set[place]) = (number, true);
            }
        }
        Ok(())
    }

    /// Simulates one step, along the course for which the master has been asked if it has.
    pub fn do_step_as_asked(&mut self, start: f64, h: f64) -> Outcome {
        match self.inquiry.take().map(Inquiry::course) {
            Some(course) if !course.references.is_empty() => {
                self.step_by(start, h, |slave, life| slave.step_along(start, &course, life))
            }
            _ => self.do_step(start, h),
        }
    }
}
