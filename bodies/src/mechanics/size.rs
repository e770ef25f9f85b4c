//! How large the finite-element model of a body may become, checked before any memory is taken.

use super::error::MechanicsError;
use super::parameters::BodyParameters;
use crate::display::display_number;
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
pub fn contact_zone(c: &BodyParameters) -> ContactZone {
    let winged = c.winged_zone();
    if check(c, winged).is_ok() { winged } else { ContactZone { reach: 0.0, ..winged } }
}

/// Refuses parameters whose meshes or vibration modes need more memory and time than is sensible; the error names
/// the parameters that drive the size.
pub fn check_size(c: &BodyParameters) -> Result<(), MechanicsError> {
    check(c, contact_zone(c))
}

/// Refuses bodies with a given fine zone that are too large.
fn check(c: &BodyParameters, zone: ContactZone) -> Result<(), MechanicsError> {
    let damped = c.damping.iter().any(|damping| !damping.is_none());
    let with_modes = c.reduced || damped;
    let check = |body, unknowns: f64, modes: usize| {
        if unknowns > LARGEST_UNKNOWNS {
            return Err(MechanicsError::TooLarge { body, unknowns, limit: LARGEST_UNKNOWNS, causes: causes(c) });
        }
        let memory = 8.0 * unknowns * crate::linalg::modes::usual_space(modes) as f64;
        if with_modes && memory > LARGEST_KRYLOV {
            return Err(MechanicsError::TooManyModes { body, modes, unknowns, memory, limit: LARGEST_KRYLOV });
        }
        Ok(())
    };
    check("wheel", wheel_unknowns(c, zone)?, c.modes[0])?;
    check("rail", rail_unknowns(c, zone)?, c.modes[1])
}

/// Values of the parameters from which the number of unknowns follows.
fn causes(c: &BodyParameters) -> String {
    let [radius, length, height] = [c.radius, c.rail_length, c.rail_height].map(display_number);
    format!(
        "cells grow from the half-width of the nominal contact, {:.3e} m, over mesh.elements_per_half_width = {} to 1/20 of \
         wheel.radius = {radius} m, or 1/150 of a longer rail, and fill rail.length = {length} m times rail.height = {height} m",
        c.half_width, c.elements
    )
}

fn wheel_unknowns(c: &BodyParameters, zone: ContactZone) -> Result<f64, MechanicsError> {
    let unknowns = graded::wheel_unknowns(c.radius, c.hub_radius, zone);
    unknowns.map_err(|source| unmeshable("wheel", source))
}

fn rail_unknowns(c: &BodyParameters, zone: ContactZone) -> Result<f64, MechanicsError> {
    let unknowns = graded::rail_unknowns(c.rail_length, c.rail_height, c.largest_rail_cell(), zone);
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
    use crate::mechanics::testing::{half_width, paper_d};
    use crate::mechanics::{Basis, pair, rail_mesh, wheel_mesh};

    /// Parameters whose rail would have more cells than is sensible.
    fn far_too_large() -> BodyParameters {
        let mut bodies = paper_d(80);
        (bodies.radius, bodies.hub_radius, bodies.rail_length, bodies.rail_height) = (0.1, 0.01, 2.0, 2.0);
        bodies.half_width = half_width(&bodies, 100.0);
        bodies
    }

    #[test]
    fn meshes_beyond_the_limit_are_refused_by_name_before_anything_is_computed() {
        let bodies = far_too_large();
        let errors = [
            check_size(&bodies).unwrap_err(),
            Basis::compute(&bodies, &mut |_, share| assert!(share == 0.0)).unwrap_err(),
            pair::bodies(&bodies, None, &mut |_, share| assert!(share == 0.0)).err().unwrap(),
            rail_mesh(&bodies).unwrap_err(),
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
        let mut bodies = far_too_large();
        let sizes = |c: &BodyParameters| {
            let winged = c.winged_zone();
            [ContactZone { reach: 0.0, ..winged }, winged].map(|zone| rail_unknowns(c, zone).unwrap())
        };
        let [mut plain, mut winged] = sizes(&bodies);
        while plain > LARGEST_UNKNOWNS {
            bodies.rail_height -= 0.01;
            [plain, winged] = sizes(&bodies);
        }
        println!("{plain} unknowns without wings, {winged} with them");
        assert!(winged > LARGEST_UNKNOWNS);
        assert_eq!((check_size(&bodies), contact_zone(&bodies).wing_nodes()), (Ok(()), 0));
        bodies.elements = 40;
        assert!(check_size(&bodies).is_ok() && contact_zone(&bodies).wing_nodes() > 0);
    }

    #[test]
    fn more_modes_than_memory_are_refused_by_name() {
        let mut bodies = paper_d(60);
        bodies.modes[0] = 200;
        let error = check_size(&bodies).unwrap_err();
        assert!(matches!(error, MechanicsError::TooManyModes { body: "wheel", .. }), "{error}");
        bodies.reduced = false;
        assert_eq!(check_size(&bodies), Ok(()));
    }

    #[test]
    fn contact_zones_that_do_not_fit_are_refused_by_name() {
        let mut bodies = paper_d(8);
        bodies.material.youngs_modulus = 1e7;
        bodies.half_width = half_width(&bodies, 1e5);
        for error in [wheel_mesh(&bodies).unwrap_err(), rail_mesh(&bodies).unwrap_err()] {
            assert!(error.to_string().contains("lower model.nominal_load"), "{error}");
        }
    }
}
