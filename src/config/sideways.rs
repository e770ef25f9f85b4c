//! Parameters with which contact in two directions, `contact.lateral`, is refused.

use super::dependent::{ConfigError, Dependent, beside};
use super::table::Config;
use std::f64::consts::PI;

/// Refuses parameters with which a contact of two directions is not computed.
pub fn check(config: &Config) -> Result<(), ConfigError> {
    let (contact, solver) = (&config.contact, &config.solver);
    let others = [
        (
            contact.shape.is_line(),
            "contact.shape = line, whose contact has no width",
            "contact.shape = ellipse or rows",
        ),
        (!solver.response.is_reduced(), "solver.response = full", "solver.response = reduced"),
    ];
    if config.wheelset.side.is_known() && !contact.lateral {
        return Err(ConfigError::NotSideways);
    }
    let refused = others.into_iter().find(|(found, ..)| config.contact.lateral && *found);
    refused.map_or(Ok(()), |(_, other, remedy)| Err(ConfigError::Lateral { other, remedy }))
}

/// Dampers and masses beside lateral springs, which need them, and a tread that is no heavier than all that moves sideways.
pub fn ranges(config: &Config) -> Vec<Dependent> {
    let wheel = &config.wheel;
    let annulus = PI * (wheel.radius.powi(2) - wheel.hub_radius.powi(2)) * config.width() * config.material.density;
    let moving = annulus + wheel.hub_mass + wheel.lateral_mass;
    let (of_wheel, of_rail) = (["wheel.lateral_stiffness"], ["rail.lateral_stiffness"]);
    vec![
        beside(config, "wheel.lateral_damping", &of_wheel, f64::INFINITY),
        beside(config, "wheel.lateral_tread_mass", &of_wheel, moving),
        beside(config, "rail.lateral_damping", &of_rail, f64::INFINITY),
        beside(config, "rail.lateral_mass", &of_rail, f64::INFINITY),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{ContactShape, Response};

    fn refused(change: impl Fn(&mut Config), words: &[&str]) {
        let mut config = Config::default();
        (config.contact.lateral, config.contact.shape) = (true, ContactShape::Ellipse);
        assert_eq!(config.validate(), Ok(()));
        change(&mut config);
        let message = config.validate().unwrap_err().to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }

    #[test]
    fn what_does_not_go_with_two_directions_is_refused_with_what_to_set() {
        let both = |other: &'static str, remedy: &'static str| ["contact.lateral = true", other, remedy];
        refused(|c| c.contact.shape = ContactShape::Line, &both("contact.shape = line", "set contact.shape = ellipse"));
        refused(
            |c| c.solver.response = Response::Full,
            &both("solver.response = full", "set solver.response = reduced"),
        );
        refused(|c| c.wheel.lateral_damping = 1e3, &["wheel.lateral_damping = 1000", "wheel.lateral_stiffness = 0"]);
        let heavy = |c: &mut Config| (c.wheel.lateral_stiffness, c.wheel.lateral_tread_mass) = (1e8, 1e4);
        refused(heavy, &["wheel.lateral_tread_mass = 10000", "wheel.lateral_stiffness = 1e8"]);
    }
}
