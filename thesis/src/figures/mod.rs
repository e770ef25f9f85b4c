//! Figures and tables of the thesis, one function each: the thesis's method, ours, the closed form and the quoted number.

mod annulus;
mod closed_forms;
mod introduction;
mod rolling;

use crate::plot::Plot;
use crate::quoted::Status;

/// Something that a figure must show; if it does not, the run fails.
#[derive(Clone, Debug)]
pub struct Predicate {
    /// In words.
    pub says: String,
    /// Whether it is so.
    pub holds: bool,
}

/// One figure, table or statement recomputed.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Its name in the thesis: `I 5.1`, `B 5`.
    pub item: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What came out.
    pub status: Status,
    /// Parameters; assumed ones are marked in words.
    pub parameters: &'static str,
    /// What was found, in words.
    pub finding: String,
    /// Drawings.
    pub plots: Vec<Plot>,
    /// Recomputed values by name.
    pub values: Vec<(String, f64)>,
    /// Never empty: a figure that nothing tests is refused.
    pub predicates: Vec<Predicate>,
}

/// Computes one figure, or says why not.
pub type Recipe = fn() -> Result<Figure, String>;

/// What is recomputed so far, with the items that each function covers.
pub const ALL: &[(&str, Recipe)] = &[
    ("I 4.2", introduction::rod),
    ("I 5.1", introduction::schemes),
    ("A text", closed_forms::hertz),
    ("A 12", closed_forms::corrugation),
    ("B 5", annulus::galerkin),
    ("B 6", annulus::supg),
    ("B 7", annulus::bubble),
    ("C 7", rolling::paper_c),
    ("C 12", rolling::temperature),
    ("D 6", rolling::paper_d),
    ("D 18", closed_forms::braking),
];

/// What is not recomputed yet.
pub const MISSING: &[&str] = &[
    "A T1",
    "A T2",
    "A T3",
    "A 5–6",
    "A 7",
    "A 8–10",
    "A 11",
    "A 13–14",
    "B 11",
    "B 12",
    "B 13",
    "B 14",
    "B 15",
    "B 16",
    "B 17",
    "B 18–19",
    "C 6",
    "C 8–11",
    "C 13",
    "C 14",
    "C 15",
    "D T1",
    "D 7–8",
    "D 9",
    "D 10",
    "D 11–15",
    "D 16–17",
    "D 19–21",
];

/// A statement and whether it holds.
fn must(says: impl Into<String>, holds: bool) -> Predicate {
    Predicate { says: says.into(), holds }
}
