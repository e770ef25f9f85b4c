//! `steady`: stationary rolling at one or many creepages.

use super::interrupt::Interrupt;
use super::setting::{Setting, find};
use super::setup::{Setup, wrong};
use super::table::{self, Csv};
use super::{Failure, model, told};
use std::path::PathBuf;
use std::str::FromStr;
use wheelrail::analytic;
use wheelrail::config::parameter_range;
use wheelrail::fmi::instance::Instance;
use wheelrail::fmi::variable::{Value, Variable};
use wheelrail::simulation::{STANDSTILL, peripheral_velocity};

/// Columns of the table.
const OUTPUTS: [&str; 12] = [
    "contact.creepage",
    "contact.force_x",
    "contact.adhesion",
    "contact.utilisation",
    "contact.stick_fraction",
    "contact.half_width",
    "contact.pressure_max",
    "contact.moment",
    "contact.friction",
    "temperature.wheel_max",
    "temperature.rail_max",
    "heat.friction_power",
];
/// Default range of creepages in units of Carter's full slip, and their number.
const RANGE: f64 = 1.5;
const COUNT: usize = 16;

/// Stationary rolling with prescribed speeds: force-creepage curve or one operating point. CSV on standard output or to
/// a file.
#[derive(clap::Args)]
pub struct Steady {
    #[command(flatten)]
    setup: Setup,
    /// Travel velocity [m/s]; initial.velocity if not given.
    #[arg(long, value_name = "M/S", allow_hyphen_values = true)]
    velocity: Option<f64>,
    /// Creepages 2 (V - r omega)/(V + r omega), braking positive: one, or FROM:TO:COUNT; up to 1.5 times Carter's full
    /// slip in 16 points if not given.
    #[arg(long, value_name = "X | FROM:TO:COUNT", allow_hyphen_values = true)]
    creepage: Option<Range>,
    /// File for the results instead of standard output.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// A table in everyday units on standard output instead of CSV.
    #[arg(long, conflicts_with = "out")]
    table: bool,
}

/// Evenly spaced values, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    from: f64,
    to: f64,
    count: usize,
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Range, String> {
        let parts: Vec<&str> = text.split(':').collect();
        let (from, to, count) = match parts[..] {
            [one] => (one, one, "1"),
            [from, to, count] => (from, to, count),
            _ => return Err("expected one number or FROM:TO:COUNT".to_owned()),
        };
        let range = Range {
            from: parse_creepage(from)?,
            to: parse_creepage(to)?,
            count: count.trim().parse().map_err(|_| format!("COUNT = \"{count}\" is not a whole number"))?,
        };
        if range.count == 0 || (range.count == 1 && range.from != range.to) {
            return Err(format!("COUNT = {} is outside its range: at least 2 points for a range", range.count));
        }
        Ok(range)
    }
}

/// A creepage that a travelling wheel can have.
pub fn parse_creepage(text: &str) -> Result<f64, String> {
    let creepage: f64 = text.trim().parse().map_err(|_| format!("\"{text}\" is not a number"))?;
    let [low, high] = parameter_range("initial.creepage");
    if (low..=high).contains(&creepage) {
        return Ok(creepage);
    }
    Err(format!("creepage = {creepage} is outside its range: {low} to {high}"))
}

impl Range {
    fn values(self) -> impl Iterator<Item = f64> {
        let Range { from, to, count } = self;
        let share = move |k: usize| k as f64 / (count - 1).max(1) as f64;
        (0..count).map(move |k| if k + 1 == count { to } else { from + share(k) * (to - from) })
    }
}

/// A slave in Initialization Mode with prescribed speeds.
pub struct OperatingPoint {
    /// The slave.
    pub instance: Instance,
    /// Travel velocity [m/s].
    pub velocity: f64,
}

/// Passes that find the growth of a wheel at a creepage of its grown radius, and what they may miss of the creepage.
const GROWTH_PASSES: usize = 8;
const GROWTH_TOLERANCE: f64 = 1e-12;

impl OperatingPoint {
    /// The slave with preset and settings; `fixed` are what the command decides.
    pub fn new(setup: &Setup, velocity: Option<f64>, fixed: &[Setting]) -> Result<OperatingPoint, Failure> {
        let prescribed = ["control.rotation", "control.translation"].map(|name| Setting::new(name, "velocity"));
        let temperatures = Setting::new("initial.temperature", "stationary");
        let fixed = prescribed
            .into_iter()
            .chain([temperatures])
            .chain(fixed.iter().cloned().map(Ok))
            .collect::<Result<Vec<_>, _>>()?;
        for Setting { variable, .. } in setup.settings()? {
            if ["drive.velocity", "drive.omega", "initial.creepage"].contains(&variable.name) {
                let name = &variable.name;
                return Err(Failure::Usage(format!("{name} follows from --velocity and --creepage and cannot be set")));
            }
        }
        let instance = setup.initialize(&fixed, None)?;
        let velocity = velocity.unwrap_or(instance.slave().config().initial.velocity);
        let [low, high] = parameter_range("initial.velocity");
        if !(velocity.abs() > STANDSTILL && (low..=high).contains(&velocity)) {
            let range = format!("{low} to {high} m/s without standstill");
            return Err(Failure::Usage(format!("--velocity = {velocity} is outside its range: {range}")));
        }
        Ok(OperatingPoint { instance, velocity })
    }

    /// Moves on to another creepage, that of the radius to which the wheel then grows.
    pub fn set(&mut self, creepage: f64) -> Result<(), Failure> {
        let radius = self.instance.slave().config().wheel.radius;
        let references = [find("drive.velocity", |_| true)?.reference, find("drive.omega", |_| true)?.reference];
        let mut growth = 0.0;
        for _ in 0..GROWTH_PASSES {
            let omega = peripheral_velocity(self.velocity, creepage) / (radius + growth);
            self.instance.set(&references, vec![Value::Real(self.velocity), Value::Real(omega)]).map_err(wrong)?;
            let before = std::mem::replace(&mut growth, self.real("thermal.growth")?);
            if (growth - before).abs() <= GROWTH_TOLERANCE * radius {
                break;
            }
        }
        Ok(())
    }

    fn real(&mut self, name: &str) -> Result<f64, Failure> {
        let values = table::read(&mut self.instance, &[find(name, |_| true)?])?;
        Ok(if let Some(Value::Real(v)) = values.first() { *v } else { 0.0 })
    }

    /// Creepages up to well beyond full slip, in braking.
    fn default_range(&mut self) -> Result<Range, Failure> {
        self.set(0.0)?;
        let (friction, half_width) = (self.real("contact.friction")?, self.real("contact.half_width")?);
        let full_slip = analytic::carter_full_slip(friction, half_width, self.instance.slave().config().wheel.radius);
        if full_slip > 0.0 {
            return Ok(Range { from: 0.0, to: RANGE * full_slip, count: COUNT });
        }
        Err(Failure::Usage("no full slip without friction and load to range up to: name a --creepage".to_owned()))
    }
}

impl Steady {
    /// Writes one row per creepage, those that were computed if not all can be.
    pub fn run(self, interrupt: &Interrupt) -> Result<(), Failure> {
        let columns = OUTPUTS.iter().map(|name| find(name, |_| true)).collect::<Result<Vec<_>, _>>()?;
        let mut point = OperatingPoint::new(&self.setup, self.velocity, &[])?;
        let range = match self.creepage {
            Some(range) => range,
            None => point.default_range()?,
        };
        let bar = model::bar("steady", range.count as u64);
        let mut rows = Vec::new();
        let ended = range.values().try_for_each(|creepage| {
            interrupt.check()?;
            point.set(creepage)?;
            rows.push(table::read(&mut point.instance, &columns)?);
            bar.inc(1);
            Ok(())
        });
        bar.finish_and_clear();
        if ended.is_err() && rows.is_empty() {
            return ended;
        }
        if self.table {
            print_table(&columns, &rows);
            return ended;
        }
        let mut csv = Csv::create(self.out.as_deref())?;
        csv.header(columns.iter().map(|v| v.name))?;
        rows.iter().try_for_each(|row| csv.row(None, &columns, row))?;
        csv.finish()?;
        if let (Err(_), Some(out)) = (&ended, &self.out) {
            told(&format!("{} holds the first {} of {} creepages", out.display(), rows.len(), range.count));
        }
        ended
    }
}

/// Columns under short names and units for people.
fn print_table(columns: &[&Variable], rows: &[Vec<Value>]) {
    let line = |cells: Vec<String>| {
        let cells: Vec<_> = cells.iter().map(|cell| format!("{cell:>14}")).collect();
        println!("{}", cells.join(" "));
    };
    line(columns.iter().map(|v| v.name.rsplit('.').next().unwrap_or_default().to_owned()).collect());
    line(columns.iter().map(|v| format!("[{}]", table::unit(v))).collect());
    for row in rows {
        line(columns.iter().zip(row).map(|(variable, value)| table::shown(variable, value)).collect());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_include_both_ends() {
        let values: Vec<f64> = "-1e-3:1e-3:5".parse::<Range>().unwrap().values().collect();
        assert_eq!(values, [-1e-3, -5e-4, 0.0, 5e-4, 1e-3]);
        assert_eq!("2".parse::<Range>().unwrap().values().collect::<Vec<_>>(), [2.0]);
    }

    #[test]
    fn ranges_without_meaning_are_refused_by_value() {
        for (text, word) in [
            ("a", "\"a\""),
            ("0:1", "FROM:TO:COUNT"),
            ("0:1:1", "COUNT = 1"),
            ("0:3:4", "creepage = 3"),
            ("nan", "NaN"),
        ] {
            let message = text.parse::<Range>().unwrap_err();
            assert!(message.contains(word), "{message}");
        }
    }
}
