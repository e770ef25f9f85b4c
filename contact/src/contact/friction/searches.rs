//! Search for the friction coefficients of all lines of one contact problem: together, and where that finds nothing, each
//! by itself.

use super::coefficient::CoefficientSearch;
use super::together::CoefficientsTogether;

/// Coefficients that are tried for all lines together, and in all.
const TOGETHER: usize = 50;
const MOST: usize = 200;

/// The searches of one contact problem. An evaluation gives each line a coefficient and finds that of its law at the slip
/// which follows.
pub(in crate::contact) struct CoefficientSearches {
    /// Smallest and largest coefficient of every line \[1].
    bounds: Vec<[f64; 2]>,
    method: CoefficientMethod,
    tried: usize,
}

/// A search on all lines together, or one on each.
enum CoefficientMethod {
    Together(Box<CoefficientsTogether>),
    Apart(Vec<CoefficientSearch>),
}

/// Outcome of an evaluation.
pub(in crate::contact) enum Tried {
    /// Laws are obeyed on all lines.
    Obeyed,
    /// Coefficients to try next; on a line by itself `None` where its law is obeyed.
    Next(Vec<Option<f64>>),
    /// No coefficients belong to their slips: none of so many that were tried.
    Exhausted(usize),
}

impl CoefficientSearches {
    /// Searches between the bounds of the laws, with the slopes of earlier ones \[1].
    pub fn new(bounds: Vec<[f64; 2]>, slopes: impl Iterator<Item = f64>) -> Self {
        let method = CoefficientMethod::Together(Box::new(CoefficientsTogether::new(bounds.clone(), slopes)));
        Self { bounds, method, tried: 0 }
    }

    /// True if evaluations may be those of a contact that has not settled yet.
    pub fn follows(&self) -> bool {
        matches!(self.method, CoefficientMethod::Together(_))
    }

    /// Change of the excess of a line over its law by a common change of all coefficients, for a later search \[1]; `None`:
    /// it is not known.
    pub fn slope(&self, line: usize) -> Option<f64> {
        match &self.method {
            CoefficientMethod::Together(search) => Some(search.slope(line)),
            CoefficientMethod::Apart(_) => None,
        }
    }

    /// Takes an evaluation: coefficients `used` gave slips at which the laws give `found`, in a contact with a relative
    /// `error`.
    pub fn take(&mut self, used: &[f64], found: &[f64], error: f64) -> Tried {
        let next: Vec<Option<f64>> = match &mut self.method {
            CoefficientMethod::Together(search) => match search.next(used.to_vec(), found, error) {
                Some(next) => next.into_iter().map(Some).collect(),
                None => return Tried::Obeyed,
            },
            CoefficientMethod::Apart(searches) => searches
                .iter_mut()
                .zip(used.iter().zip(found))
                .map(|(search, (used, found))| search.next(*used, *found))
                .collect(),
        };
        if next.iter().all(Option::is_none) {
            return Tried::Obeyed;
        }
        self.tried += 1;
        match self.tried {
            TOGETHER => {
                self.method = CoefficientMethod::Apart(
                    self.bounds.iter().map(|bounds| CoefficientSearch::new(*bounds)).collect(),
                );
            }
            tried if tried > MOST => return Tried::Exhausted(tried),
            _ => {}
        }
        Tried::Next(next)
    }
}
