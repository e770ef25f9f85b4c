//! Table of the variables of the interface, each once. Getters, setters, `modelDescription.xml` and the documentation
//! are all made from it.
//!
//! Its rows come from the places of the values: [`Drive::ROWS`], [`Inputs::controls`], [`Outputs::ROWS`] and
//! [`Config::rows`]. A profile is one row, an array.
//!
//! Value references are fixed numbers by group, so that other people's scripts survive new variables: 100 control,
//! 200 drive, 250 rail, 260 brake, their time derivatives 20 more, 300 contact, 400 wheel, 500 hub, 600 heat, 700 damage, 800 solver, 1000 parameters,
//! 10000 profiles. Signs: x in travel direction, y up, `omega > 0` rolls forward, `contact.*` forces act on the wheel.

use super::units;
use super::variable::{Access, Enumeration, Kind, Reference, Start, Variable};
use crate::config::Config;
use crate::config::retired::{self, Retired};
use crate::simulation::{Drive, Inputs, Outputs, Read, STEEPEST};
use std::array::from_fn;
use std::fmt::Debug;
use std::sync::OnceLock;
use wheelrail_slave::{CallError, Outcome};

/// Number of rows: the preset, parameters, inputs and outputs.
const COUNT: usize = 1 + Config::COUNT + Inputs::CONTROLS + Drive::ROWS.len() + Drive::RAMPS + Outputs::ROWS.len();

/// Basic parameters that every run sets, the first of all rows.
const FIRST: [&str; 5] = ["preset", "initial.velocity", "model.nominal_load", "friction.coefficient", "wheel.radius"];

/// All rows in the order of their [`Group`](super::variable::Group)s: first what every run sets, time derivatives of inputs last.
pub fn table() -> &'static [Variable] {
    // Arrays here and below: vectors would be lost when the library is unloaded, for statics are never dropped.
    static ROWS: OnceLock<[Variable; COUNT]> = OnceLock::new();
    ROWS.get_or_init(|| {
        let mut rows: Vec<_> = inputs().into_iter().chain(outputs()).chain(parameters()).collect();
        let first = |row: &Variable| FIRST.iter().position(|name| *name == row.name).unwrap_or(FIRST.len());
        rows.sort_by_key(|row| (row.group(), first(row), row.dimension.is_some()));
        let mut rows = rows.into_iter();
        from_fn(|_| rows.next().unwrap_or_else(preset))
    })
}

/// Row with the given value reference.
pub fn find(reference: Reference) -> Option<&'static Variable> {
    static ORDER: Order<COUNT> = OnceLock::new();
    find_in(table(), &ORDER, reference)
}

/// Value references in ascending order, with the places of their variables.
pub type Order<const N: usize> = OnceLock<[(Reference, usize); N]>;

/// The one of all variables that has the value reference, by their order.
pub fn find_in<const N: usize>(
    all: &'static [Variable],
    order: &Order<N>,
    reference: Reference,
) -> Option<&'static Variable> {
    let order = order.get_or_init(|| {
        let mut order = from_fn(|k| (all[k].reference, k));
        order.sort_unstable();
        order
    });
    let position = order.binary_search_by_key(&reference, |entry| entry.0).ok()?;
    Some(&all[order[position].1])
}

/// Variables that `find` knows by their references, refusing unknown ones and types other than `wanted`.
pub fn of_type<T: PartialEq + Debug>(
    references: &[Reference],
    wanted: T,
    find: fn(Reference) -> Option<&'static Variable>,
    type_of: fn(Kind) -> T,
) -> Outcome<Vec<&'static Variable>> {
    let variable = |reference: &Reference| {
        let variable = find(*reference).ok_or_else(|| CallError::error(no_such_variable(*reference)))?;
        let (name, theirs) = (variable.name, type_of(variable.kind));
        if theirs == wanted {
            return Ok(variable);
        }
        Err(CallError::error(format!("{name} (value reference {reference}) is {theirs:?}, not {wanted:?}")))
    };
    references.iter().map(variable).collect()
}

/// The refusal of a value reference that no variable has: that of a retired parameter is refused by its name.
fn no_such_variable(reference: Reference) -> String {
    let unknown = || format!("value reference {reference} is unknown");
    let named = |retired: &Retired| format!("value reference {reference}: {retired}");
    retired::numbered(reference).map_or_else(unknown, named)
}

/// Row with the given name.
pub fn named(name: &str) -> Option<&'static Variable> {
    table().iter().find(|row| row.name == name)
}

/// The enumerations of the table, each once, in the order of their first row.
pub fn enumerations() -> Vec<&'static Enumeration> {
    let mut lists: Vec<&'static Enumeration> = Vec::new();
    for variable in table() {
        if let Kind::Enumeration(list) = variable.kind
            && !lists.contains(&list)
        {
            lists.push(list);
        }
    }
    lists
}

fn row(reference: Reference, name: &'static str, kind: Kind, access: Access, description: &'static str) -> Variable {
    let (dimension, element, start, tunable) = (None, None, Start::Stationary, false);
    Variable { reference, name, kind, dimension, element, access, start, tunable, description }
}

fn real(measure: units::Measure, [min, max]: [f64; 2], nominal: f64) -> Kind {
    Kind::Real { measure, min, max, nominal }
}

fn inputs() -> Vec<Variable> {
    let controls = Inputs::controls().into_iter();
    let controls = controls.map(|c| row(c.number, c.name, c.kind, Access::ChoiceInput(c.read, c.write), c.text));
    let values = Drive::ROWS.iter().map(|d| {
        row(d.number, d.name, real(d.measure, [d.low, d.high], d.nominal), Access::RealInput(d.field), d.text)
    });
    let ramps = Drive::ROWS.iter().filter_map(|d| {
        let ramp = d.ramp?;
        let kind = real(ramp.measure, [-STEEPEST, STEEPEST], ramp.nominal);
        Some(row(ramp.number, ramp.name, kind, Access::Ramp(d.field), ramp.text))
    });
    let mut rows: Vec<Variable> = controls.chain(values).chain(ramps).collect();
    rows.sort_by_key(|row| row.reference);
    rows
}

/// The name of the parameter set, which is no part of it.
pub fn preset() -> Variable {
    let text = "Name of a parameter set resources/<preset>.json; parameters that are set explicitly override it";
    row(1000, "preset", Kind::String, Access::Preset, text)
}

fn parameters() -> impl Iterator<Item = Variable> {
    let parameter = |p: &'static crate::config::row::Row<Config>| Variable {
        tunable: p.tunable,
        ..row(p.number, p.name, p.kind, Access::Parameter(p), p.text)
    };
    std::iter::once(preset()).chain(Config::rows().iter().map(parameter))
}

fn outputs() -> impl Iterator<Item = Variable> {
    let rows: &'static [_] = &Outputs::ROWS;
    rows.iter().map(|o| {
        let kind = match o.read {
            Read::Real(_) | Read::Profile(_) | Read::Deferred(_) => real(o.measure, [o.low, o.high], o.nominal),
            Read::Count(_) => Kind::Integer { min: 0, max: i32::MAX },
            Read::Flag(_) => Kind::Boolean,
        };
        Variable {
            dimension: Some(o.points.len()).filter(|&points| points > 0),
            start: if o.starts_at_zero { Start::Zero } else { Start::Stationary },
            ..row(o.number, o.name, kind, Access::Output(o), o.text)
        }
    })
}
