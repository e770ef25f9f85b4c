//! Parameters with which contact in two directions, `contact.lateral`, is refused.

use super::dependent::ConfigError;
use super::table::Config;

/// Refuses parameters with which a contact of two directions is not computed.
pub fn check(config: &Config) -> Result<(), ConfigError> {
    let (contact, solver) = (&config.contact, &config.solver);
    let others = [
        (
            contact.shape.is_line(),
            "contact.shape = line, whose contact has no width",
            "contact.shape = ellipse or rows",
        ),
        (!solver.reduced, "all finite elements", "solver.reduced = true"),
    ];
    if config.wheelset.side.is_known() && !contact.lateral {
        return Err(ConfigError::NotSideways);
    }
    let refused = others.into_iter().find(|(found, ..)| config.contact.lateral && *found);
    refused.map_or(Ok(()), |(_, other, remedy)| Err(ConfigError::Lateral { other, remedy }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::ContactShape;

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
        refused(|c| c.solver.reduced = false, &both("all finite elements", "set solver.reduced = true"));
    }
}
