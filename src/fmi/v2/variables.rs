//! The scalar variables of FMI 2.0: the table with its arrays spread over one variable per element.

use crate::config::Config;
use crate::fmi::table::{Order, find_in, preset, table};
use crate::fmi::variable::{Reference, Variable};
use crate::simulation::{Drive, Inputs, Outputs};
use std::array::from_fn;
use std::sync::OnceLock;

/// Number of scalar variables: the preset, parameters, inputs and outputs.
const COUNT: usize = 1 + Config::COUNT + Inputs::CONTROLS + Drive::ROWS.len() + Drive::RAMPS + output_count();

/// Number of scalar outputs.
const fn output_count() -> usize {
    let (mut count, mut k) = (0, 0);
    while k < Outputs::ROWS.len() {
        let points = Outputs::ROWS[k].points.len();
        count += if points > 0 { points } else { 1 };
        k += 1;
    }
    count
}

/// All scalar variables, in the order of the model description.
pub fn variables() -> &'static [Variable] {
    // Arrays here and below: vectors would be lost when the library is unloaded, for statics are never dropped.
    static SCALARS: OnceLock<[Variable; COUNT]> = OnceLock::new();
    SCALARS.get_or_init(|| {
        let mut scalars: Vec<_> = table().iter().flat_map(Variable::elements).collect();
        scalars.sort_by_key(Variable::group);
        let mut scalars = scalars.into_iter();
        from_fn(|_| scalars.next().unwrap_or_else(preset))
    })
}

/// Variable with the given value reference.
pub fn find(reference: Reference) -> Option<&'static Variable> {
    static ORDER: Order<COUNT> = OnceLock::new();
    find_in(variables(), &ORDER, reference)
}
