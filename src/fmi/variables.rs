//! The scalar variables of FMI 2.0: the table with its arrays spread over one variable per element.

use super::table::table;
use super::variable::{Access, Reference, Variable};
use std::sync::OnceLock;

/// All scalar variables, in the order of the model description.
pub fn variables() -> &'static [Variable] {
    static SCALARS: OnceLock<Vec<Variable>> = OnceLock::new();
    SCALARS.get_or_init(|| table().iter().flat_map(scalars).collect())
}

/// Variable with the given value reference.
pub fn find(reference: Reference) -> Option<&'static Variable> {
    static ORDER: OnceLock<Vec<(Reference, usize)>> = OnceLock::new();
    let order = ORDER.get_or_init(|| {
        let mut order: Vec<_> = variables().iter().enumerate().map(|(i, v)| (v.reference, i)).collect();
        order.sort_unstable();
        order
    });
    let position = order.binary_search_by_key(&reference, |entry| entry.0).ok()?;
    Some(&variables()[order[position].1])
}

/// A scalar itself; the elements of an array, whose references follow that of the array.
fn scalars(row: &Variable) -> Vec<Variable> {
    let (Some(dimension), Access::ArrayOutput(get)) = (row.dimension, row.access) else {
        return vec![row.clone()];
    };
    let element = |point: usize| Variable {
        reference: row.reference + 1 + point as Reference,
        name: format!("{}[{}]", row.name, point + 1),
        dimension: None,
        access: Access::ProfileOutput(get, point),
        description: format!("{}, point {}", row.description, point + 1),
        ..row.clone()
    };
    (0..dimension).map(element).collect()
}
