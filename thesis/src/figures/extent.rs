//! How much of a figure is computed: as many points and meshes as show it, or all of them, `make thesis FULL=1`.

/// Points at least that a curve over a parameter has in full.
const POINTS: usize = 16;

/// How much is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Extent that shows each figure within minutes.
    Quick,
    /// Finer meshes and more points.
    Full,
}

/// Values of a parameter over which a curve is drawn.
pub(super) struct Axis {
    /// The values.
    pub values: Vec<f64>,
    /// Every so many of them is one of the list from which they were made.
    pub every: usize,
}

impl Axis {
    /// Entry of a list that belongs to point `i` of the axis.
    pub(super) fn listed<'a, T>(&self, found: &'a [T], i: usize) -> &'a T {
        &found[self.every * i]
    }
}

impl Extent {
    /// A figure's own list; in full, with each interval divided equally until there are sixteen points or more.
    pub(super) fn axis(self, list: &[f64]) -> Axis {
        let intervals = list.len() - 1;
        let every = if self == Self::Full { (POINTS - 1).div_ceil(intervals) } else { 1 };
        let between = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            (0..every).map(move |k| from + (to - from) * k as f64 / every as f64).collect::<Vec<_>>()
        };
        let values = list.windows(2).flat_map(between).chain([list[intervals]]).collect();
        Axis { values, every }
    }

    /// Quick or full.
    pub(super) fn choose<T>(self, quick: T, full: T) -> T {
        if self == Self::Full { full } else { quick }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_full_every_listed_point_stays_among_sixteen_or_more_and_quickly_there_are_no_others() {
        for list in [vec![1.0, 2.0], vec![2.5e3, 5e3, 10e3, 20e3, 40e3], (0..9).map(f64::from).collect(), vec![0.0; 17]]
        {
            let (quick, full) = (Extent::Quick.axis(&list), Extent::Full.axis(&list));
            assert_eq!(quick.values, list);
            assert!(full.values.len() >= 16 && full.values.len() >= list.len());
            assert!((0..list.len()).all(|i| *full.listed(&full.values, i) == list[i]));
            assert_eq!(full.values.len(), full.every * (list.len() - 1) + 1);
        }
    }
}
