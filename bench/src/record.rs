//! Numbers of a run over time, at the end of every step or, of a long run, of every second, fourth, … one.

use wheelrail::simulation::{Outputs, Read};

/// Outputs that the page shows and the CSV holds, by their names in the FMU.
pub const COLUMNS: [&str; 34] = [
    "wheel.velocity",
    "wheel.omega",
    "wheel.distance",
    "contact.creepage",
    "contact.slip_velocity",
    "contact.force_x",
    "contact.force_y",
    "contact.force_z",
    "contact.lateral_creepage",
    "contact.friction",
    "contact.utilisation",
    "contact.stick_fraction",
    "contact.half_width",
    "contact.width",
    "contact.pressure_max",
    "temperature.wheel_max",
    "temperature.rail_max",
    "damage.peak_temperature",
    "heat.friction_power",
    "heat.to_wheel",
    "heat.to_rail",
    "brake.torque_actual",
    "brake.power",
    "energy.hub_work",
    "energy.thermal_work",
    "energy.gravity",
    "energy.rail_work",
    "energy.stored",
    "energy.brake",
    "energy.friction",
    "energy.damping",
    "energy.plastic",
    "solver.energy_residual",
    "solver.heat_residual",
];
/// Rows that are kept; when there are more, every second one goes.
const MOST_ROWS: usize = 60_000;

/// A column: its name, and what reads it.
pub type Column = (&'static str, fn(&Outputs) -> f64);

/// The columns of [`COLUMNS`].
pub fn columns() -> Vec<Column> {
    let real = |name: &&str| {
        let row = Outputs::ROWS.iter().find(|row| row.name == *name)?;
        if let Read::Real(read) = row.read { Some((row.name, read)) } else { None }
    };
    COLUMNS.iter().filter_map(real).collect()
}

/// Rows of numbers at equal distances of time.
#[derive(Clone, Debug)]
pub struct Record {
    /// Length of a step \[s].
    step: f64,
    /// Steps from row to row.
    stride: usize,
    /// Steps seen, the start included.
    seen: usize,
    most: usize,
    rows: Vec<Vec<f64>>,
}

impl Record {
    /// Without rows, for steps of `step` \[s].
    pub fn new(step: f64) -> Self {
        Self { step, stride: 1, seen: 0, most: MOST_ROWS, rows: Vec::new() }
    }

    /// Takes the numbers at the end of the next step; the first ones are those at the start.
    pub fn take(&mut self, row: Vec<f64>) {
        if self.seen.is_multiple_of(self.stride) {
            if self.rows.len() == self.most {
                let mut number = 0;
                self.rows.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.rows.push(row);
            }
        }
        self.seen += 1;
    }

    /// The rows as a table with a header: time \[s], then [`COLUMNS`] in SI units, with all digits.
    pub fn csv(&self) -> String {
        let mut text = format!("time,{}\n", COLUMNS.join(","));
        for (k, row) in self.rows.iter().enumerate() {
            text += &time(k * self.stride, self.step).to_string();
            row.iter().for_each(|value| text += &format!(",{value:e}"));
            text.push('\n');
        }
        text
    }
}

/// Time after a number of steps \[s], without the rounding of a product.
pub fn time(steps: usize, step: f64) -> f64 {
    steps as f64 / (1.0 / step).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_is_a_number_of_the_model() {
        let found: Vec<_> = columns().iter().map(|(name, _)| *name).collect();
        assert_eq!(found, COLUMNS);
    }

    #[test]
    fn a_long_record_keeps_rows_at_equal_distances_from_the_start_on() {
        let mut record = Record { most: 8, ..Record::new(1e-3) };
        for k in 0..100 {
            record.take(vec![f64::from(k)]);
        }
        let kept: Vec<_> = record.rows.iter().map(|row| row[0]).collect();
        assert_eq!(kept, [0.0, 16.0, 32.0, 48.0, 64.0, 80.0, 96.0]);
        let csv = record.csv();
        let second = csv.lines().nth(2).unwrap();
        assert_eq!(second.split(',').map(|text| text.parse().unwrap()).collect::<Vec<f64>>(), [0.016, 16.0]);
    }
}
