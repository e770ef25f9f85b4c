//! Figures and tables of the thesis, one function each: the thesis's method, ours, the closed form and the quoted number.

mod annulus;
mod braking;
mod closed_forms;
mod corrugation;
mod friction_heat;
mod holes;
mod introduction;
mod lost_heat;
mod mesh_heat;
mod plate;
mod ramps;
mod rolling;
mod rough;
mod share;
mod tread_heat;
mod tread_map;

use crate::plot::{Curve, Plot, Source};
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

impl Figure {
    /// What is wrong with it: nothing that tests it, or something that does not hold.
    pub fn flaws(&self) -> Vec<String> {
        if self.predicates.is_empty() {
            return vec![format!("{}: nothing tests it", self.item)];
        }
        let broken = self.predicates.iter().filter(|predicate| !predicate.holds);
        broken.map(|predicate| format!("{}: {} does not hold", self.item, predicate.says)).collect()
    }
}

/// Every figure and table of the thesis that computes something, and the sentences with numbers, in the thesis's order.
pub const ITEMS: &[&str] = &[
    "I 4.2",
    "I 5.1",
    "A T1",
    "A T2",
    "A T3",
    "A 5–6",
    "A text",
    "A 7",
    "A 8–10",
    "A 11",
    "A 12",
    "A 13–14",
    "B 5",
    "B 6",
    "B 7",
    "B 11",
    "B 12",
    "B 13",
    "B 14",
    "B 15",
    "B 16",
    "B 17",
    "B 18–19",
    "C 6",
    "C 7",
    "C 8–11",
    "C 12",
    "C 13",
    "C 14",
    "C 15",
    "D 6",
    "D T1",
    "D 7–8",
    "D 9",
    "D 10",
    "D 11–15",
    "D 16–17",
    "D 18",
    "D 19–21",
];

/// Computes one figure, or says why not.
pub type Recipe = fn() -> Result<Figure, String>;

/// What is recomputed so far, with the items that each function covers.
pub const ALL: &[(&str, Recipe)] = &[
    ("I 4.2", introduction::rod),
    ("I 5.1", introduction::schemes),
    ("A text", closed_forms::hertz),
    ("A T1", corrugation::mesh),
    ("A T2", corrugation::step),
    ("A T3", corrugation::ends),
    ("A 5–6", plate::energy),
    ("A 7", rough::spectrum),
    ("A 8–10", rough::densities),
    ("A 11", corrugation::force),
    ("A 12", corrugation::excitation),
    ("A 13–14", holes::discontinuity),
    ("B 5", annulus::galerkin),
    ("B 6", annulus::supg),
    ("B 7", annulus::bubble),
    ("B 11", mesh_heat::convergence),
    ("B 12", tread_map::map),
    ("B 13", tread_heat::pressure),
    ("B 14", tread_heat::velocity),
    ("B 15", tread_heat::conductance),
    ("B 16", tread_heat::load),
    ("B 17", tread_heat::transient),
    ("B 18–19", holes::small),
    ("C 6", mesh_heat::regularisation),
    ("C 7", rolling::paper_c),
    ("C 8–11", friction_heat::profiles),
    ("C 12", lost_heat::temperature),
    ("C 13", friction_heat::locked),
    ("C 14", friction_heat::velocity),
    ("C 15", friction_heat::conductance),
    ("D 6", rolling::paper_d),
    ("D T1", ramps::table),
    ("D 7–8", ramps::force),
    ("D 9", ramps::profiles),
    ("D 10", ramps::temperature),
    ("D 11–15", braking::velocities),
    ("D 16–17", braking::moment),
    ("D 18", share::braking),
    ("D 19–21", holes::sharp),
];

/// What is not recomputed yet.
pub const MISSING: &[&str] = &[];

/// A statement and whether it holds.
fn must(says: impl Into<String>, holds: bool) -> Predicate {
    Predicate { says: says.into(), holds }
}

/// A curve of given points.
fn curve(source: Source, name: impl Into<String>, points: Vec<[f64; 2]>) -> Curve {
    Curve { source, name: name.into(), points }
}
