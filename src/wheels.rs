//! Many wheels, stepped side by side on the cores of the machine.

use crate::simulation::{Inputs, Simulation, StepError};
use rayon::prelude::*;

/// Advances every simulation by `h` seconds with its own inputs, on as many threads as the machine has cores; what
/// became of each, in their order.
///
/// Wheels do not see each other within a step, so that the results are those of one after the other, bit for bit. A
/// wheel whose step fails stays where it was; those beside it have advanced. Equal wheels share one
/// [`Model`](crate::simulation::Model).
///
/// ```no_run
/// use wheelrail::config::Config;
/// use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};
/// use wheelrail::wheels::advance_all;
///
/// let model = Model::shared(Config::default(), &BasisStore::of_user(), &mut |_, _| {})?;
/// let inputs = vec![Inputs::rolling(model.config()); 8];
/// let mut wheels = inputs.iter().map(|i| Simulation::new(model.clone(), i)).collect::<Result<Vec<_>, _>>()?;
/// for _ in 0..1000 {
///     advance_all(&mut wheels, &inputs, 1e-3).into_iter().collect::<Result<(), _>>()?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Panics
///
/// If there are not as many inputs as simulations.
pub fn advance_all(simulations: &mut [Simulation], inputs: &[Inputs], h: f64) -> Vec<Result<(), StepError>> {
    assert_eq!(simulations.len(), inputs.len(), "every wheel has its own inputs");
    let wheels = simulations.par_iter_mut().zip(inputs);
    wheels.map(|(simulation, inputs)| simulation.advance(inputs, h)).collect()
}
