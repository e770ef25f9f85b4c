//! A run as a text: how it starts and what is changed when. It is the part of the page's address behind `#`.

use crate::link::{LinkError, MOST_CHANGES, condition, number};
use crate::rail::Condition;
use crate::script::Change;
use std::fmt;
use wheelrail::config::{Config, presets};
use wheelrail_slave::uri::decode;

/// Shape of the contact patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Patch {
    /// A line of constant width: the preset `railway`.
    Line,
    /// An ellipse: `railway_ellipse`.
    Ellipse,
    /// The patch of a wheel S1002 on a rail UIC 60, not displaced: `railway_s1002_0mm`.
    S1002,
}

impl Patch {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Line, Self::Ellipse, Self::S1002];

    /// Name in links.
    pub fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Ellipse => "ellipse",
            Self::S1002 => "s1002",
        }
    }

    /// The patch of a name in links.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|patch| patch.name() == name)
    }

    /// Name of the preset.
    pub fn preset_name(self) -> &'static str {
        match self {
            Self::Line => "railway",
            Self::Ellipse => "railway_ellipse",
            Self::S1002 => "railway_s1002_0mm",
        }
    }

    /// Text of the preset.
    fn preset(self) -> &'static str {
        match self {
            Self::Line => include_str!("../../resources/railway.json"),
            Self::Ellipse => include_str!("../../resources/railway_ellipse.json"),
            Self::S1002 => include_str!("../../resources/railway_s1002_0mm.json"),
        }
    }
}

/// Rows of the patch of the preset `railway_s1002_0mm`, which names them as a file.
const ROWS: &str = include_str!("../../resources/s1002_uic60_0mm.csv");
/// Length of a step \[ms].
pub const STEP_MS: f64 = 1.0;

/// Everything that decides about a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Shape of the patch.
    pub patch: Patch,
    /// Rail on which the run starts.
    pub rail: Condition,
    /// Speed at the start [km/h].
    pub speed: f64,
    /// Load at the start \[kN].
    pub load: f64,
    /// Torque of the brake from the first step on [kN m].
    pub torque: f64,
    /// Angle of attack, positive where the wheel is turned to the right \[mrad]; 0 on a line, which has no width.
    pub angle: f64,
    /// Changes after the start, in order of their time: number of steps done before them, and what changes.
    pub changes: Vec<(u32, Change)>,
}

impl Default for Settings {
    fn default() -> Self {
        let (patch, rail, changes) = (Patch::Line, Condition::Dry, Vec::new());
        Self { patch, rail, speed: 100.0, load: 100.0, torque: 2.0, angle: 0.0, changes }
    }
}

impl Settings {
    /// Reads a link: pairs `name=value` with `&` between them, changes as `at=1250:torque=6`, the time in milliseconds.
    /// Settings that are not named have their usual values. Percent codes, which mail programs put into links, are read.
    ///
    /// # Errors
    /// Unknown names, values that do not exist or are out of range, changes that are not in the order of time.
    pub fn from_link(link: &str) -> Result<Self, LinkError> {
        let mut settings = Self::default();
        let readable = decode(link.as_bytes()).and_then(|bytes| String::from_utf8(bytes).ok());
        let link = readable.ok_or_else(|| LinkError::Part { part: link.into() })?;
        for part in link.trim().trim_start_matches('#').split('&').filter(|part| !part.is_empty()) {
            let Some((name, value)) = part.split_once('=') else { return Err(LinkError::Part { part: part.into() }) };
            match name {
                "patch" => {
                    let names = || Patch::ALL.map(Patch::name).join(", ");
                    settings.patch = Patch::named(value).ok_or_else(|| LinkError::value(name, value, names()))?;
                }
                "rail" => settings.rail = condition(value)?,
                "speed" => settings.speed = number(name, value)?,
                "load" => settings.load = number(name, value)?,
                "torque" => settings.torque = number(name, value)?,
                "angle" => settings.angle = number(name, value)?,
                "at" => settings.add(value)?,
                _ => return Err(LinkError::Part { part: part.into() }),
            }
        }
        if settings.patch == Patch::Line && settings.angle != 0.0 {
            return Err(LinkError::value(
                "angle",
                &settings.angle.to_string(),
                "0 with patch=line, which has no width",
            ));
        }
        Ok(settings)
    }

    /// Adds the change of a link: `1250:lock`.
    fn add(&mut self, text: &str) -> Result<(), LinkError> {
        let possible = "milliseconds, a colon, and lock, release, hold, coast, torque=, load= or rail=";
        let refused = || LinkError::value("at", text, possible);
        let (time, change) = text.split_once(':').ok_or_else(refused)?;
        let time = time.parse().map_err(|_| refused())?;
        let change = Change::parse(change)?.ok_or_else(refused)?;
        match self.changes.last() {
            Some((late, _)) if *late > time => Err(LinkError::Order { late: *late, early: time }),
            _ if self.changes.len() == MOST_CHANGES => Err(LinkError::Long),
            _ => {
                self.changes.push((time, change));
                Ok(())
            }
        }
    }

    /// Lateral velocity of the wheel on the rail over its velocity \[1]: a wheel turned to the right slides to the left.
    pub fn sideways(&self) -> f64 {
        -1e-3 * self.angle
    }

    /// Parameters of the model.
    ///
    /// # Errors
    /// A preset that cannot be read.
    pub fn config(&self) -> Result<Config, String> {
        let mut config = presets::parse(self.patch.preset())?;
        let Config { friction, tuning, .. } = presets::parse(self.rail.preset())?;
        (config.friction, config.tuning) = (friction, tuning);
        if self.patch == Patch::S1002 {
            config.contact.rows = ROWS.to_owned();
        }
        config.contact.lateral = self.angle != 0.0;
        config.initial.velocity = self.speed / 3.6;
        Ok(config)
    }
}

impl fmt::Display for Settings {
    /// The link that [`Settings::from_link`] reads.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { patch, rail, speed, load, torque, angle, changes } = self;
        let (patch, rail) = (patch.name(), rail.name());
        write!(f, "patch={patch}&rail={rail}&speed={speed}&load={load}&torque={torque}")?;
        if *angle != 0.0 {
            write!(f, "&angle={angle}")?;
        }
        changes.iter().try_for_each(|(time, change)| write!(f, "&at={time}:{change}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_written_and_read_is_the_same_run() {
        let changes = vec![
            (0, Change::Load(123.456)),
            (7, Change::Rail(Condition::Leaves)),
            (7, Change::Lock),
            (1250, Change::Release),
            (1250, Change::Hold),
            (1300, Change::Torque(0.1 + 0.2)),
            (1301, Change::Coast),
        ];
        for patch in Patch::ALL {
            let angle = if patch == Patch::Line { 0.0 } else { -7.3 };
            let (rail, changes) = (Condition::Wet, changes.clone());
            let run = Settings { patch, rail, speed: 61.7, load: 99.0, torque: 0.0, angle, changes };
            let link = run.to_string();
            assert_eq!(Settings::from_link(&link), Ok(run.clone()), "{link}");
            assert_eq!(Settings::from_link(&format!("#{link}")), Ok(run.clone()));
            assert_eq!(Settings::from_link(&link.replace(':', "%3A").replace('&', "%26")), Ok(run.clone()));
            let all: String = link.bytes().map(|byte| format!("%{byte:02x}")).collect();
            assert_eq!(Settings::from_link(&all), Ok(run));
        }
        assert_eq!(Settings::from_link(""), Ok(Settings::default()));
    }

    #[test]
    fn what_is_wrong_in_a_link_is_named() {
        let said = |link: &str| Settings::from_link(link).unwrap_err().to_string();
        assert!(said("patch=square").contains("line, ellipse, s1002"));
        assert!(said("rail=ice").contains("dry, wet, leaves"));
        for number in ["speed=0", "speed=1e9", "load=-1", "torque=NaN", "torque=", "speed=inf"] {
            assert!(said(number).contains(" to "), "{number}: {}", said(number));
        }
        assert!(
            said("at=5%3").contains("at=5%3") && said("at=5%zzlock").contains("%zz") && said("%ff").contains("%ff")
        );
        assert!(said("colour=red").contains("colour=red") && said("lock").contains("\"lock\""));
        assert!(said("at=5:jump").contains("lock, release") && said("at=-5:lock").contains("milliseconds"));
        assert!(said("angle=3").contains("patch=line") && said("patch=ellipse&angle=99").contains("-20 to 20 mrad"));
        assert!(said("at=5:load=1000").contains("20 to 200 kN"));
        assert!(said("at=5:lock&at=4:release").contains("at=5 before at=4"));
        let long = "at=1:lock&".repeat(MOST_CHANGES + 1);
        assert_eq!(Settings::from_link(&long), Err(LinkError::Long));
    }

    #[test]
    fn a_run_has_the_patch_and_the_friction_of_its_presets() {
        for patch in Patch::ALL {
            for rail in Condition::ALL {
                let config = Settings { patch, rail, speed: 72.0, ..Settings::default() }.config().unwrap();
                config.validate().unwrap();
                assert_eq!((config.initial.velocity, config.contact.shape.is_line()), (20.0, patch == Patch::Line));
                assert_eq!(config.friction.coefficient, rail.friction().unwrap().coefficient);
            }
        }
    }
}
