//! Sampled profiles: a CSV file with the columns `position,height` in metres.

use super::error::ProfileError;
use crate::display::display_number;
use crate::files;
use crate::files::table::{Table, TableError};
use crate::piecewise::Piecewise;
use std::path::Path;

/// Heights over positions: linear between samples, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightSamples {
    points: Piecewise,
}

/// Text of a CSV file of samples (position, height) \[m], which reads back to the same numbers.
pub fn csv(samples: &[[f64; 2]]) -> String {
    let rows = samples.iter().map(|[position, height]| format!("{position:?},{height:?}\n"));
    std::iter::once(format!("{}\n", COLUMNS.join(","))).chain(rows).collect()
}

/// Largest height and depth of a sample [m]: that of `rail.elevation`.
const HIGHEST: f64 = 0.1;
/// Difference of the heights at both ends that is rounding: in metres, and as share of the range of all heights.
const ROUNDED: [f64; 2] = [1e-9, 1e-4];
/// Difference of the distance of the ends from the period that is rounding, as share of the period: of positions on the
/// circumference of a wheel that are written with four digits behind the point.
pub const ROUNDED_PERIOD: f64 = 5e-5;
/// Rounding of a difference of two positions, as share of it, against a period that is given beside the samples.
pub const ROUNDED_SUM: f64 = 1e-9;
/// Smallest height \[m] and steepness of short samples that are those of a cross-section, and their largest length \[m].
const SECTION: [f64; 3] = [3e-3, 0.05, 0.3];
/// Distance of samples, in usual ones, from which it is a gap; fewer samples than some have no usual distance \[1].
const GAP: f64 = 10.0;
const FEW: usize = 10;
/// Columns of a file.
const COLUMNS: [&str; 2] = ["position", "height"];

impl HeightSamples {
    /// At least one sample at ascending positions \[m].
    pub fn new(points: Piecewise) -> Self {
        Self { points }
    }

    /// Reads a file, from the working directory or else from `folder`; `factor` multiplies its heights.
    pub fn read(path: &str, folder: Option<&Path>, factor: f64) -> Result<Self, ProfileError> {
        let (found, text) = files::read_named(path, folder).map_err(ProfileError::new)?;
        Self::from_csv(&text, &found.display().to_string(), factor)
    }

    /// Reads the text of a file.
    pub fn from_csv(text: &str, path: &str, factor: f64) -> Result<Self, ProfileError> {
        Self::from_table(text, factor).map_err(|error| ProfileError::new(format!("file {path}, {error}")))
    }

    fn from_table(text: &str, factor: f64) -> Result<Self, TableError> {
        let table = Table::read(text)?;
        let columns = table.columns(COLUMNS, &[])?;
        let mut points = Piecewise::default();
        for row in table.rows() {
            let row = row?;
            let number = |k: usize| row.number(columns[k], COLUMNS[k], "m");
            let (position, height) = (number(0)?, number(1)?);
            if let Some(&before) = points.x.last().filter(|before| **before >= position) {
                let problem =
                    format!("position = {position} m must be larger than {before} m before it; sort the lines");
                return Err(TableError::new(row.line, problem));
            }
            if (factor * height).abs() > HIGHEST {
                let problem = format!(
                    "height = {height} m times the factor {factor} is outside -{HIGHEST} to {HIGHEST} m; columns are in metres"
                );
                return Err(TableError::new(row.line, problem));
            }
            points.push(position, factor * height);
        }
        match points.x.len() {
            0 => Err(TableError::new(1, "no sample follows, at least 2 are needed")),
            1 => Err(TableError::new(1, "1 sample, at least 2 are needed")),
            _ => Ok(Self { points }),
        }
    }

    /// Closes the samples into one period \[m]: the line from the last sample leads back to the first. The error says
    /// what is wrong with the period.
    pub fn close(&mut self, period: f64) -> Result<(), String> {
        let last = self.points.x.len() - 1;
        let (x, height) = (self.points.x[0] + period, self.points.value[0]);
        let [before, end] = [last.saturating_sub(1), last].map(|k| self.points.x[k]);
        if before >= x {
            let x = display_number(x);
            return Err(format!("more, or no more than one sample from {x} m on, where the next period begins"));
        }
        if end >= x - (ROUNDED_PERIOD * period).min(0.5 * (end - before)) {
            let [low, high] = self.range();
            let found = self.points.value[last];
            if (found - height).abs() > ROUNDED[0].max(ROUNDED[1] * (high - low)) {
                let [found, height] = [found, height].map(display_number);
                return Err(format!("more, or the last height {found} m as the first, {height} m"));
            }
            (self.points.x[last], self.points.value[last]) = (x, height);
        } else {
            self.points.push(x, height);
        }
        Ok(())
    }

    /// Height at a position \[m].
    pub fn height(&self, at: f64) -> f64 {
        crate::piecewise::interpolate(&self.points.x, &self.points.value, at)
    }

    /// First and last position \[m].
    pub fn reach(&self) -> [f64; 2] {
        [self.points.x[0], self.points.x[self.points.x.len() - 1]]
    }

    /// Lowest and highest sample \[m].
    fn range(&self) -> [f64; 2] {
        let heights = || self.points.value.iter().copied();
        [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Usual distance of samples \[m], the median; none of few.
    fn usual_distance(&self) -> Option<f64> {
        let mut lengths: Vec<f64> = self.points.x.windows(2).map(|x| x[1] - x[0]).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        lengths.get(lengths.len() / 2).copied().filter(|_| lengths.len() >= FEW)
    }

    /// Ends \[m] of the longest distance between two samples of different height, where it is [`GAP`] times as long as
    /// usual, and the usual distance.
    pub fn gap(&self) -> Option<([f64; 2], f64)> {
        let usual = self.usual_distance()?;
        let pairs = self.points.x.windows(2).zip(self.points.value.windows(2));
        let uneven = pairs.filter(|(_, height)| height[0] != height[1]).map(|(x, _)| [x[0], x[1]]);
        let longest = uneven.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
        (longest[1] - longest[0] > GAP * usual).then_some((longest, usual))
    }

    /// Height and length \[m] of samples that are as short and steep as the cross-section of a rail head or a tread.
    pub fn cross_section(&self) -> Option<[f64; 2]> {
        let [low, high] = self.range();
        let (height, length) = (high - low, self.usual_distance()? * (self.points.x.len() - 1) as f64);
        let [least, steepness, longest] = SECTION;
        (height >= least && height >= steepness * length && length <= longest).then_some([height, length])
    }

    /// Shortest wavelength that they can hold \[m]: twice their smallest distance.
    pub fn wavelength(&self) -> f64 {
        2.0 * self.points.x.windows(2).map(|x| x[1] - x[0]).fold(f64::INFINITY, f64::min)
    }
}
