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
        number: 1070,
        name: "physics.centrifugal",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the centrifugal load of the spinning wheel always acts; remove it",
    },
    Retired {
        number: 1071,
        name: "physics.thermal_expansion",
        since: "0.21.0",
        last: "0.20.0",
        instead: "thermal expansion always acts back on the contact; remove it, or set material.expansion = 0 for a \
                  wheel that does not expand",
    },
    Retired {
        number: 1090,
        name: "solver.response",
        since: "0.24.0",
        last: "0.23.0",
        instead: "the bodies always answer by their vibration modes; remove it. The Rust library still has all finite \
                  elements",
    },
    Retired {
        number: 1091,
        name: "solver.modes_wheel",
        since: "0.21.0",
        last: "0.20.0",
        instead: "80 vibration modes of the wheel are always kept; remove it",
    },
    Retired {
        number: 1092,
        name: "solver.modes_rail",
        since: "0.21.0",
        last: "0.20.0",
        instead: "40 vibration modes of the rail are always kept; remove it",
    },
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
        number: 1114,
        name: "thermal.conductance_law",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the contact conductance no longer depends on the pressure; remove it, and set thermal.conductance to \
                  its value at the mean pressure of the patch",
    },
    Retired {
        number: 1115,
        name: "thermal.reference_pressure",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the contact conductance no longer depends on the pressure; remove it, and set thermal.conductance to \
                  its value at the mean pressure of the patch",
    },
    Retired {
        number: 1117,
        name: "thermal.wheel_share",
        since: "0.21.0",
        last: "0.20.0",
        instead: "friction heats both surfaces alike, and conduction decides where the heat goes; remove it",
    },
    Retired {
        number: 1130,
        name: "damping.modal",
        since: "0.21.0",
        last: "0.20.0",
        instead: "vibration modes always have the damping ratios of damping.wheel_torsion and the like; remove it, or \
                  set all five to 0 instead of damping.modal = false",
    },
    Retired {
        number: 1136,
        name: "damping.rayleigh_mass",
        since: "0.21.0",
        last: "0.20.0",
        instead: "damping is that of the vibration modes alone; remove it, and set their ratios, damping.wheel_torsion \
                  and the like",
    },
    Retired {
        number: 1137,
        name: "damping.rayleigh_stiffness",
        since: "0.21.0",
        last: "0.20.0",
        instead: "damping is that of the vibration modes alone; remove it, and set their ratios, damping.wheel_torsion \
                  and the like, or vehicle.damping for the bounce of the wheel on its contact",
    },
    Retired {
        number: 1154,
        name: "thermal.boss_width",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the boss is always 1.26 times as wide as the rim (170 mm beside 135 mm); remove it, or set \
                  thermal.rim_width",
    },
    Retired {
        number: 1158,
        name: "thermal.emissivity",
        since: "0.21.0",
        last: "0.20.0",
        instead: "there is no radiation; remove it, and add its linear part to thermal.convection, 4 x emissivity x \
                  5.67e-8 x (absolute temperature)^3, 55 W/(m2.K) for 0.8 at 400 degC",
    },
    Retired {
        number: 1172,
        name: "damage.wear_mild",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wear law is always that of the wheel steel R8T; remove it, and set damage.wear_factor for \
                  another steel or a lubricated rail",
    },
    Retired {
        number: 1173,
        name: "damage.wear_severe",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wear law is always that of the wheel steel R8T; remove it, and set damage.wear_factor for \
                  another steel or a lubricated rail",
    },
    Retired {
        number: 1174,
        name: "damage.wear_catastrophic",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wear law is always that of the wheel steel R8T; remove it, and set damage.wear_factor for \
                  another steel or a lubricated rail",
    },
    Retired {
        number: 1175,
        name: "damage.wear_severe_from",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wear law is always that of the wheel steel R8T; remove it, and set damage.wear_factor for \
                  another steel or a lubricated rail",
    },
    Retired {
        number: 1176,
        name: "damage.wear_catastrophic_from",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wear law is always that of the wheel steel R8T; remove it, and set damage.wear_factor for \
                  another steel or a lubricated rail",
    },
    Retired {
        number: 1189,
        name: "solver.contact",
        since: "0.17.0",
        last: "0.16.4",
        instead: "contact forces are always found on contact nodes (mesh.grid_elements_per_half_width); remove it",
    },
    Retired {
        number: 1205,
        name: "wheel.lateral_stiffness",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wheel carries the contact sideways without a spring; remove it, and let the host hold the wheel \
                  by a spring with control.lateral",
    },
    Retired {
        number: 1206,
        name: "wheel.lateral_damping",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wheel carries the contact sideways without a spring; remove it, and let the host hold the wheel \
                  by a spring with control.lateral",
    },
    Retired {
        number: 1207,
        name: "wheel.lateral_tread_mass",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the wheel carries the contact sideways without a spring; remove it, and let the host hold the wheel \
                  by a spring with control.lateral",
    },
    Retired {
        number: 1208,
        name: "rail.lateral_stiffness",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the rail carries the contact sideways without a spring; remove it",
    },
    Retired {
        number: 1209,
        name: "rail.lateral_damping",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the rail carries the contact sideways without a spring; remove it",
    },
    Retired {
        number: 1210,
        name: "rail.lateral_mass",
        since: "0.21.0",
        last: "0.20.0",
        instead: "the rail carries the contact sideways without a spring; remove it",
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
