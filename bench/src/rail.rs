//! Conditions of the rail, and the stretches of it that come under the wheel one after the other.

use wheelrail::config::{Config, presets};

/// Layer on the rail. Friction is that of the preset of this name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Nothing: `railway_dry`.
    Dry,
    /// Water: `railway_wet`.
    Wet,
    /// Leaves, pressed to a film: `railway_low_adhesion`.
    Leaves,
}

/// Friction of a condition: a coefficient that falls with the slip of the tread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailFriction {
    /// Coefficient of a tread that does not slip \[1].
    pub coefficient: f64,
    /// Share of it that is left at high slip \[1].
    pub falling_ratio: f64,
    /// Decay of the rest with the slip [s/m].
    pub falling_decay: f64,
}

impl Condition {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Dry, Self::Wet, Self::Leaves];

    /// Name in links.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dry => "dry",
            Self::Wet => "wet",
            Self::Leaves => "leaves",
        }
    }

    /// The condition of a name in links.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|condition| condition.name() == name)
    }

    /// Text of the preset.
    pub(crate) fn preset(self) -> &'static str {
        match self {
            Self::Dry => include_str!("../../resources/railway_dry.json"),
            Self::Wet => include_str!("../../resources/railway_wet.json"),
            Self::Leaves => include_str!("../../resources/railway_low_adhesion.json"),
        }
    }

    /// Friction by the preset; an error names what is wrong with its text.
    pub fn friction(self) -> Result<RailFriction, String> {
        let Config { friction, tuning, .. } = presets::parse(self.preset())?;
        Ok(RailFriction {
            coefficient: friction.coefficient,
            falling_ratio: tuning.falling_ratio,
            falling_decay: tuning.falling_decay,
        })
    }
}

/// Distance from the wheel at which a new stretch of rail begins \[m].
pub const AHEAD: f64 = 5.0;

/// Stretches of rail, each to the beginning of the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Places where they begin \[m], ascending, and their condition; the first begins behind the wheel.
    stretches: Vec<(f64, Condition)>,
}

impl Track {
    /// One condition everywhere.
    pub fn uniform(condition: Condition) -> Self {
        Self { stretches: vec![(f64::NEG_INFINITY, condition)] }
    }

    /// Lays a stretch of another condition, from [`AHEAD`] of the wheel at `distance` \[m] on, in the place of all that
    /// was laid farther ahead.
    pub fn lay(&mut self, distance: f64, condition: Condition) {
        let begin = distance + AHEAD;
        self.stretches.retain(|(other, _)| *other < begin);
        if self.stretches.last().is_none_or(|(_, last)| *last != condition) {
            self.stretches.push((begin, condition));
        }
    }

    /// Condition at a place \[m].
    pub fn at(&self, place: f64) -> Condition {
        let under = self.stretches.iter().rev().find(|(begin, _)| *begin <= place);
        under.map_or(Condition::Dry, |(_, condition)| *condition)
    }

    /// Stretches that reach beyond a place \[m]: where they begin, and their condition.
    pub fn beyond(&self, place: f64) -> &[(f64, Condition)] {
        let first = self.stretches.iter().rposition(|(begin, _)| *begin <= place).unwrap_or(0);
        &self.stretches[first..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_comes_when_the_wheel_has_travelled_to_it_and_replaces_what_was_laid_farther_ahead() {
        let mut track = Track::uniform(Condition::Wet);
        track.lay(10.0, Condition::Leaves);
        assert_eq!(
            [track.at(14.9), track.at(15.0), track.at(1e6)],
            [Condition::Wet, Condition::Leaves, Condition::Leaves]
        );
        track.lay(9.0, Condition::Dry);
        assert_eq!([track.at(13.9), track.at(14.0), track.at(1e6)], [Condition::Wet, Condition::Dry, Condition::Dry]);
        assert_eq!(track.beyond(20.0), [(14.0, Condition::Dry)]);
        assert_eq!(track.beyond(0.0).len(), 2);
        track.lay(20.0, Condition::Dry);
        assert_eq!(track.beyond(0.0).len(), 2, "the same condition is no new stretch");
    }

    #[test]
    fn leaves_are_more_slippery_than_water_and_water_than_nothing() {
        let [dry, wet, leaves] = Condition::ALL.map(|condition| condition.friction().unwrap().coefficient);
        assert!(leaves < 0.5 * wet && wet < dry, "{dry} {wet} {leaves}");
        assert!(Condition::ALL.iter().all(|condition| Condition::named(condition.name()) == Some(*condition)));
    }
}
