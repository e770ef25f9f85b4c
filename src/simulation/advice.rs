//! Advice on a failure: the one place for the words that follow a message.

use super::validity::ZONE_LOAD;
use super::{Inputs, PrepareError, StepError, start};
use crate::config::Config;
use crate::fem::FemError;
use crate::heat::HeatError;
use crate::linalg::LinalgError;
use crate::mechanics::MechanicsError;
use crate::rolling::ModelError;

/// The message of a step that failed, with advice.
pub fn failed_step(error: &StepError, config: &Config) -> String {
    let shorter = config.told(
        "take shorter communication steps, lower {solver.max_step now} or {solver.tolerance now} (0: not used), and \
         change prescribed velocities and loads more gently",
    );
    let advice = match error {
        StepError::ZoneExceeded { load, zone: reached } => zone(*load, config)
            .or_else(|| uneven(*reached, config))
            .unwrap_or_else(|| flattened(*reached, config, shorter)),
        StepError::Contact { .. } | StepError::NotFinite { .. } => unsettled(shorter, config),
        StepError::Heat(HeatError::Input { .. }) => shorter,
        StepError::Heat(error) => heat(error, config),
        StepError::BelowAbsoluteZero { .. } => cold(config),
        StepError::Overheated { .. } => config.told(&format!(
            "{shorter}; check friction.coefficient and rail.friction, drive.tread_heat, {{material.conductivity now}} and \
             {{thermal.conductance now}}, or set material.latent_heat = 0 to leave melting out"
        )),
        StepError::Motion(_) => {
            "check drive.force, drive.moment and drive.load, or the prescribed velocities".to_owned()
        }
        StepError::Body(_) => body(config),
        _ => return error.to_string(),
    };
    format!("{error}: {advice}")
}

/// The message of a start that failed under the inputs, with advice.
pub fn failed_start(error: &StepError, config: &Config, inputs: &Inputs) -> String {
    let advice = match error {
        StepError::ZoneExceeded { load, zone: reached } => {
            zone(*load, config).or_else(|| uneven(*reached, config)).unwrap_or_else(|| {
                config.told(&format!(
                    "the zone carries this load, so a higher model.nominal_load does not help: check \
                     drive.displacement, {}, {{thermal.wheel_excess now}} and {{rail.length now}}",
                    creepage(config)
                ))
            })
        }
        StepError::BeyondAdhesion { asked, load, .. }
            if config.initial.temperature.is_stationary()
                && asked.abs() < inputs.drive.friction * load =>
        {
            // What endless heat has softened, gentler forces do not meet.
            unsettled(start::gentler(config, inputs), config)
        }
        StepError::BeyondAdhesion { .. } => {
            "start with gentler drive.moment, drive.force and drive.lateral_force and bring them to their values in the first \
             steps, or set initial.creepage: then the run starts sliding, and the force that adhesion does not carry accelerates it"
                .to_owned()
        }
        StepError::Unpressed { .. } => {
            "set drive.load above 0, or control.vertical = displacement to hold the hub at a height".to_owned()
        }
        StepError::Contact { .. }
        | StepError::NotFinite { .. }
        | StepError::Unsettled
        | StepError::Softened { .. } => {
            unsettled(start::gentler(config, inputs), config)
        }
        StepError::Motion(_) => config.told(&format!(
            "choose {{initial.velocity now}} and {}, or the prescribed velocities, within this range",
            creepage(config)
        )),
        StepError::Heat(error) => heat(error, config),
        StepError::BelowAbsoluteZero { .. } => cold(config),
        StepError::Body(_) => body(config),
        _ => return error.to_string(),
    };
    format!("{error}: {advice}")
}

/// Zone that is advised over the one that was too short \[1].
const WIDER: f64 = 1.5;

/// Advice where the surfaces may touch beyond the zone because of their profiles; `None` for smooth ones.
fn uneven(zone: f64, config: &Config) -> Option<String> {
    profiles(config).map(|profiles| {
        format!(
            "{profiles} is too deep or too long for the zone: the surfaces touch beyond it; {}, or make the profile shallower or \
             shorter. If a larger mesh.reach does not widen the zone, wheel and rail have no more room for it",
            wider(zone, config)
        )
    })
}

/// Names of the profiles that are set; `None` on smooth surfaces.
fn profiles(config: &Config) -> Option<String> {
    let profiles = [("wheel.profile", &config.wheel.profile), ("rail.profile", &config.rail.profile)];
    let set: Vec<_> = profiles.iter().filter(|(_, text)| !text.is_empty()).map(|(name, _)| *name).collect();
    (!set.is_empty()).then(|| set.join(" or "))
}

/// The advice `otherwise` where no contact state is found, and what helps if a profile is the reason.
fn unsettled(otherwise: String, config: &Config) -> String {
    match profiles(config) {
        Some(profiles) => {
            format!("{otherwise}; or make {profiles} less deep and less steep: the profile may be the reason")
        }
        None => otherwise,
    }
}

/// The advice `otherwise`, and what helps where the run has flattened the wheel beyond the zone.
fn flattened(zone: f64, config: &Config, otherwise: String) -> String {
    if config.physics.yielding || config.damage.wear.is_on() {
        format!("{otherwise}; where wear or yielding has flattened the wheel, {}", wider(zone, config))
    } else {
        otherwise
    }
}

/// Advice to look for contact farther than in a zone of the half-width `zone` \[m].
fn wider(zone: f64, config: &Config) -> String {
    let enough = WIDER * zone;
    config.told(&format!("set {{mesh.reach now}}, up to which contact is looked for, to {enough:.3} m or more"))
}

/// The initial creepage in words.
fn creepage(config: &Config) -> &'static str {
    if config.initial.creepage.is_some() { "{initial.creepage now}" } else { "initial.creepage (now not set)" }
}

/// The message of a model that could not be prepared, with advice.
pub fn failed_preparation(error: &PrepareError, config: &Config) -> String {
    let advice = match error {
        PrepareError::Mechanics(error) | PrepareError::Model(ModelError::Mechanics(error)) => mechanics(error, config),
        PrepareError::Model(ModelError::Heat(source)) if !matches!(source, HeatError::Range { .. }) => {
            heat(source, config)
        }
        _ => return error.to_string(),
    };
    format!("{error}: {advice}")
}

/// Advice where the candidate zone is too short for the load; `None` where the load is not the reason.
fn zone(load: f64, config: &Config) -> Option<String> {
    (load > ZONE_LOAD * config.model.nominal_load).then(|| {
        config.told(&format!(
            "the mesh is laid out for {ZONE_LOAD} x {{model.nominal_load now}}; lower drive.load, or raise \
             model.nominal_load and set drive.load, which follows it unless set"
        ))
    })
}

fn heat(error: &HeatError, config: &Config) -> String {
    config.told(match error {
        HeatError::Eigen { .. } => {
            "change the layers of the thermal mesh by {thermal.max_speed now} or {thermal.smallest_load_ratio now}"
        }
        _ => {
            "take shorter steps, or more usual values of {thermal.conductance now}, {thermal.convection now} and \
             {material.conductivity now}; thermal.enabled = false runs without temperatures"
        }
    })
}

/// Advice where a temperature falls below absolute zero.
fn cold(config: &Config) -> String {
    let reversible = match config.physics.thermoelastic_heating {
        true => "lower {material.expansion now} or set physics.thermoelastic_heating = false, or ",
        false => "",
    };
    let usual = "take shorter steps, or more usual values of rail.temperature, {thermal.reference now}, \
                 {thermal.wheel_excess now} and {thermal.conductance now}; temperatures are in kelvin";
    config.told(&[reversible, usual].concat())
}

fn mechanics(error: &MechanicsError, config: &Config) -> String {
    config.told(match error {
        MechanicsError::Fem(FemError::ZoneTooLarge { .. }) => {
            "the contact is too wide for the bodies; lower {model.nominal_load now} and set drive.load, or raise \
             {model.contact_width now} (with contact.shape = ellipse contact.rail_lateral_radius), \
             {material.youngs_modulus now}, {rail.length now} or {rail.height now}, or lower {wheel.hub_radius now}"
        }
        MechanicsError::Linalg(LinalgError::ModesNotConverged { .. } | LinalgError::TooManyModes { .. }) => {
            return body(config);
        }
        _ => {
            "choose more usual proportions of {wheel.radius now}, {wheel.hub_radius now}, {rail.length now}, \
             {rail.height now} and {model.nominal_load now}"
        }
    })
}

fn body(config: &Config) -> String {
    config.told("change {mesh.elements_per_half_width now}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactError;

    fn config() -> Config {
        Config::default()
    }

    #[test]
    fn a_higher_nominal_load_is_advised_only_where_the_load_is_the_reason() {
        let config = config();
        let nominal = config.model.nominal_load;
        let text = |load| failed_step(&StepError::ZoneExceeded { zone: 0.018, load }, &config);
        assert!(text(2.1 * nominal).contains("raise model.nominal_load and set drive.load"));
        let wound_up = text(0.9 * nominal);
        assert!(!wound_up.contains("model.nominal_load") && wound_up.contains("solver.max_step"), "{wound_up}");
        let inputs = Inputs::rolling(&config);
        let start = failed_start(&StepError::ZoneExceeded { zone: 0.018, load: 0.9 * nominal }, &config, &inputs);
        assert!(start.contains("does not help") && start.contains("rail.length"), "{start}");
    }

    #[test]
    fn every_failure_of_the_numerics_names_a_parameter() {
        let config = config();
        let source = ContactError::NotConverged { iterations: 40 };
        let heat = HeatError::NotConverged { residual: 1e-3, iterations: 50, direct_below: 0.01 };
        let modes = LinalgError::ModesNotConverged { wanted: 40, converged: 0, space: 80, residual: 1.0 };
        let zone = FemError::ZoneTooLarge { zone: 0.2, half_width: 0.1, limit: 0.115, what: "a quarter" };
        for (text, name) in [
            (failed_step(&StepError::Contact { time: 0.0, step: 1e-3, source }, &config), "solver.max_step"),
            (failed_step(&StepError::NotFinite { time: 0.0, step: 1e-3 }, &config), "solver.max_step"),
            (failed_step(&StepError::Overheated { temperature: 2e3, highest: 1853.0 }, &config), "rail.friction"),
            (failed_step(&StepError::Heat(heat), &config), "thermal.conductance"),
            (failed_step(&StepError::BelowAbsoluteZero { temperature: -1.0 }, &config), "thermal.reference"),
            (failed_start(&StepError::Unsettled, &config, &Inputs::rolling(&config)), "initial.velocity"),
            (failed_preparation(&PrepareError::Mechanics(modes.into()), &config), "mesh.elements_per_half_width"),
            (failed_preparation(&PrepareError::Mechanics(zone.into()), &config), "model.nominal_load"),
        ] {
            assert!(text.contains(name) && text.contains("(now ") | text.contains("gentler"), "{text}");
        }
    }
}
