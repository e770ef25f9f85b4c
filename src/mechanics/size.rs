//! How large the finite-element model of a body may become, checked before any memory is taken.

use super::damping::BodyDamping;
use super::error::MechanicsError;
use super::layout::{largest_rail_cell, nominal_half_width, winged_zone};
use crate::config::Config;
use crate::fem::{ContactZone, FemError, graded};

/// Largest number of unknown displacements of one body. With 80 and 40 modes, bodies of 84,480 and 48,762 unknowns (60
/// elements per half-width) took 22 s and 0.67 GB to prepare.
pub const LARGEST_UNKNOWNS: f64 = 150e3;
/// Largest memory for the vectors from which the vibration modes of one body are usually computed \[bytes], of which
/// about half is used; a very long rail may take 800 vectors more, see `largest_space`. With 200 and 100 modes, bodies
/// of 51,840 and 24,766 unknowns (0.52 GB by this count) took 25 s and 0.77 GB.
pub const LARGEST_KRYLOV: f64 = 0.8e9;

/// Fine zone of the meshes for the nominal load, with wings for wider patches where the bodies have room for them and
/// do not become too large by them.
pub fn contact_zone(config: &Config) -> ContactZone {
    let winged = winged_zone(config);
    if check(config, winged).is_ok() { winged } else { ContactZone { reach: 0.0, ..winged } }
}

/// Refuses a configuration whose meshes or vibration modes need more memory and time than is sensible; the error names
/// the parameters that drive the size.
pub fn check_size(config: &Config) -> Result<(), MechanicsError> {
    check(config, contact_zone(config))
}

/// Refuses bodies with a given fine zone that are too large.
fn check(config: &Config, zone: ContactZone) -> Result<(), MechanicsError> {
    let damped = [BodyDamping::wheel(config), BodyDamping::rail(config)].iter().any(|damping| !damping.is_none());
    let with_modes = config.solver.response.is_reduced() || damped;
    let check = |body, unknowns: f64, modes: usize| {
        if unknowns > LARGEST_UNKNOWNS {
            return Err(MechanicsError::TooLarge { body, unknowns, limit: LARGEST_UNKNOWNS, causes: causes(config) });
        }
        let memory = 8.0 * unknowns * crate::linalg::modes::usual_space(modes) as f64;
        if with_modes && memory > LARGEST_KRYLOV {
            return Err(MechanicsError::TooManyModes { body, modes, unknowns, memory, limit: LARGEST_KRYLOV });
        }
        Ok(())
    };
    check("wheel", wheel_unknowns(config, zone)?, config.solver.modes_wheel)?;
    check("rail", rail_unknowns(config, zone)?, config.solver.modes_rail)
}

/// Values of the parameters from which the number of unknowns follows.
fn causes(config: &Config) -> String {
    let half_width = nominal_half_width(config);
    config.told(&format!(
        "cells grow from the half-width of the nominal contact, {half_width:.3e} m, over {{mesh.elements_per_half_width}} \
         to 1/20 of {{wheel.radius}}, or 1/150 of a longer rail, and fill {{rail.length}} times {{rail.height}}"
    ))
}

fn wheel_unknowns(config: &Config, zone: ContactZone) -> Result<f64, MechanicsError> {
    let unknowns = graded::wheel_unknowns(config.wheel.radius, config.wheel.hub_radius, zone);
    unknowns.map_err(|source| unmeshable("wheel", source))
}

fn rail_unknowns(config: &Config, zone: ContactZone) -> Result<f64, MechanicsError> {
    let rail = &config.rail;
    let unknowns = graded::rail_unknowns(rail.length, rail.height, largest_rail_cell(config), zone);
    unknowns.map_err(|source| unmeshable("rail", source))
}

/// A failed mesh in words of the parameters.
pub(super) fn unmeshable(body: &'static str, source: FemError) -> MechanicsError {
    let advice = match (&source, body) {
        (FemError::ZoneTooLarge { .. }, "wheel") => {
            "lower model.nominal_load and set drive.load, or raise model.contact_width (with contact.shape = ellipse \
             contact.rail_lateral_radius), material.youngs_modulus or wheel.radius, or lower wheel.hub_radius"
        }
        (FemError::ZoneTooLarge { .. }, _) => {
            "lower model.nominal_load and set drive.load, or raise model.contact_width (with contact.shape = ellipse \
             contact.rail_lateral_radius), material.youngs_modulus, rail.length or rail.height"
        }
        (_, "wheel") => "check wheel.radius and wheel.hub_radius",
        _ => "check rail.length and rail.height",
    };
    MechanicsError::Mesh { body, source, advice }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Response;
    use crate::mechanics::testing::paper_d;
    use crate::mechanics::{Basis, bodies, rail_mesh, wheel_mesh};

    /// Valid parameters whose rail would have more cells than is sensible.
    fn far_too_large() -> Config {
        let mut config = paper_d(80);
        (config.wheel.radius, config.wheel.hub_radius) = (0.1, 0.01);
        (config.rail.length, config.rail.height) = (2.0, 2.0);
        (config.model.nominal_load, config.model.contact_width) = (100.0, 1.0);
        config
    }

    #[test]
    fn meshes_beyond_the_limit_are_refused_by_name_before_anything_is_computed() {
        let config = far_too_large();
        assert_eq!(config.validate(), Ok(()));
        let errors = [
            check_size(&config).unwrap_err(),
            Basis::compute(&config, &mut |_, share| assert!(share == 0.0)).unwrap_err(),
            bodies(&config, None, &mut |_, share| assert!(share == 0.0)).err().unwrap(),
            rail_mesh(&config).unwrap_err(),
        ];
        for error in errors {
            let MechanicsError::TooLarge { body: "rail", unknowns, .. } = error else { panic!("{error}") };
            assert!(unknowns > LARGEST_UNKNOWNS);
            let text = error.to_string();
            let names = ["rail.height = 2 m", "wheel.radius = 0.1 m", "mesh.elements_per_half_width = 80"];
            assert!(names.iter().all(|name| text.contains(name)), "{text}");
        }
    }

    /// Rail without wings smaller than allowed, with them larger.
    #[test]
    fn wings_are_left_out_where_they_would_make_a_body_too_large() {
        let mut config = far_too_large();
        let sizes = |config: &Config| {
            let winged = winged_zone(config);
            [ContactZone { reach: 0.0, ..winged }, winged].map(|zone| rail_unknowns(config, zone).unwrap())
        };
        let [mut plain, mut winged] = sizes(&config);
        while plain > LARGEST_UNKNOWNS {
            config.rail.height -= 0.01;
            [plain, winged] = sizes(&config);
        }
        println!("{plain} unknowns without wings, {winged} with them");
        assert!(winged > LARGEST_UNKNOWNS);
        assert_eq!((check_size(&config), contact_zone(&config).wing_nodes()), (Ok(()), 0));
        config.mesh.elements_per_half_width = 40;
        assert!(check_size(&config).is_ok() && contact_zone(&config).wing_nodes() > 0);
    }

    #[test]
    fn more_modes_than_memory_are_refused_by_name() {
        let mut config = paper_d(60);
        config.solver.modes_wheel = 200;
        let error = check_size(&config).unwrap_err();
        assert!(matches!(error, MechanicsError::TooManyModes { body: "wheel", .. }), "{error}");
        config.solver.response = Response::Full;
        assert_eq!(check_size(&config), Ok(()));
    }

    #[test]
    fn contact_zones_that_do_not_fit_are_refused_by_name() {
        let mut config = paper_d(8);
        config.material.youngs_modulus = 1e7;
        for error in [wheel_mesh(&config).unwrap_err(), rail_mesh(&config).unwrap_err()] {
            assert!(error.to_string().contains("lower model.nominal_load"), "{error}");
        }
    }
}
