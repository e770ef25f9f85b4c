//! Parameters of earlier versions. Their names are refused with the version that had them, wherever a name or a number
//! of a parameter can be given, and their numbers are never used again.

/// A parameter that no longer exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Retired {
    /// Its number, which no other parameter will have.
    pub number: u32,
    /// Its name in the form `group.name`.
    pub name: &'static str,
    /// First version without it.
    pub since: &'static str,
    /// Last version that had it.
    pub last: &'static str,
    /// The present behaviour in its place, and what a user has to do.
    pub instead: &'static str,
}

/// Every retired parameter, by its number.
pub const RETIRED: &[Retired] = &[
    Retired {
        number: 1093,
        name: "solver.time_scheme",
        since: "0.2.0",
        last: "0.1.1",
        instead: "time steps are always second-order backward differences (bdf2); remove it",
    },
    Retired {
        number: 1094,
        name: "solver.theta",
        since: "0.2.0",
        last: "0.1.1",
        instead: "time steps are always second-order backward differences without a weight; remove it",
    },
    Retired {
        number: 1189,
        name: "solver.contact",
        since: "0.17.0",
        last: "0.16.4",
        instead: "contact forces are always found on contact nodes (mesh.grid_elements_per_half_width); remove it",
    },
];

/// The refusal as users read it.
impl std::fmt::Display for Retired {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, since, last, instead, .. } = self;
        write!(f, "{name} was retired in {since} (last in {last}): {instead}")
    }
}

/// The retired parameter with that name.
pub fn named(name: &str) -> Option<&'static Retired> {
    RETIRED.iter().find(|retired| retired.name == name)
}

/// The retired parameter with that number.
pub fn numbered(number: u32) -> Option<&'static Retired> {
    RETIRED.iter().find(|retired| retired.number == number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    #[test]
    fn no_parameter_has_the_name_or_number_of_a_retired_one() {
        for row in Config::rows() {
            assert_eq!((named(row.name), numbered(row.number)), (None, None), "{}", row.name);
        }
        assert!(RETIRED.windows(2).all(|pair| pair[0].number < pair[1].number));
    }

    #[test]
    fn a_refusal_names_the_parameter_both_versions_and_what_to_do() {
        let message = named("solver.theta").unwrap().to_string();
        assert!(message.starts_with("solver.theta was retired in 0.2.0 (last in 0.1.1): "), "{message}");
        assert!(message.ends_with("remove it"), "{message}");
        assert_eq!(numbered(1094), named("solver.theta"));
    }
}
