//! Parameters of the bodies that a configuration says.

use super::choices::RailEnds;
use super::table::{Config, Material};
use crate::material::Isotropic;
use crate::mechanics::{BodyDamping, BodyParameters, Ends};
use crate::surface::longest_flat;

/// Half-widths beyond the edges of flats, on which a patch may lie.
const BEYOND_FLAT: f64 = 1.0;

impl From<&Material> for Isotropic {
    fn from(material: &Material) -> Self {
        let &Material { youngs_modulus, poissons_ratio, density, expansion, conductivity, specific_heat, .. } =
            material;
        Self { youngs_modulus, poissons_ratio, density, expansion, conductivity, specific_heat }
    }
}

impl From<RailEnds> for Ends {
    fn from(ends: RailEnds) -> Self {
        match ends {
            RailEnds::Free => Self::Free,
            RailEnds::Fixed => Self::Fixed,
            RailEnds::Nonreflecting => Self::Nonreflecting,
        }
    }
}

impl From<&Config> for BodyParameters {
    fn from(config: &Config) -> Self {
        let Config { wheel, rail, mesh, solver, damping, .. } = config;
        let half_width = config.nominal_patch().half_length;
        let flat = longest_flat(&wheel.profile);
        let of_flat = if flat > 0.0 { 0.5 * flat + BEYOND_FLAT * half_width } else { 0.0 };
        let of_wheel = BodyDamping::of([
            damping.wheel_torsion,
            damping.wheel_radial,
            damping.wheel_one_diameter,
            damping.wheel_more_diameters,
        ]);
        Self {
            radius: wheel.radius,
            hub_radius: wheel.hub_radius,
            rail_length: rail.length,
            rail_height: rail.height,
            rail_ends: rail.ends.into(),
            material: Isotropic::from(&config.material),
            half_width,
            reach: mesh.reach.max(of_flat),
            elements: mesh.elements_per_half_width,
            grid_elements: mesh.grid_elements_per_half_width,
            reduced: solver.reduced,
            modes: [solver.modes_wheel, solver.modes_rail],
            damping: [of_wheel, BodyDamping::even(damping.rail)],
            centrifugal: config.physics.centrifugal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::presets;
    use crate::mechanics::basis::key;
    use crate::mechanics::{rail_mesh, wheel_mesh};

    fn paper_d(elements: usize) -> Config {
        let mut config = presets::parse(include_str!("../../resources/paper_d.json")).unwrap();
        config.mesh.elements_per_half_width = elements;
        config
    }

    #[test]
    fn key_of_a_basis_depends_on_what_the_basis_depends_on_and_nothing_else() {
        let key = |config: &Config| key(&config.into());
        let base = paper_d(4);
        let mut same = base.clone();
        same.vehicle.mass = 1e4;
        same.wheel.hub_inertia = 3.0;
        same.friction.coefficient = 0.1;
        same.tuning.max_step = 1e-5;
        same.physics.centrifugal = false;
        (same.model.nominal_load, same.model.contact_width) = (2e5, 2.0);
        assert_eq!(key(&base), key(&same));
        let changes: [fn(&mut Config); 7] = [
            |c| c.mesh.reach = 0.1,
            |c| c.wheel.profile = "flat(length = 0.1)".into(),
            |c| c.wheel.hub_radius = 0.06,
            |c| c.material.density = 7800.0,
            |c| c.model.nominal_load = 1.1e5,
            |c| c.mesh.elements_per_half_width = 5,
            |c| c.solver.modes_rail = 6,
        ];
        for change in changes {
            let mut other = base.clone();
            change(&mut other);
            assert_ne!(key(&base), key(&other));
        }
    }

    #[test]
    fn bodies_of_extreme_but_valid_configurations_can_be_meshed() {
        let changes: [fn(&mut Config); 6] = [
            |c| c.model.nominal_load = 10.0,
            |c| c.mesh.elements_per_half_width = 80,
            |c| c.wheel.hub_radius = 0.4,
            |c| (c.wheel.hub_radius, c.rail.height, c.rail.length) = (0.01, 0.02, 0.12),
            |c| (c.model.nominal_load, c.wheel.radius) = (4.7e6, 0.46),
            |c| (c.rail.length, c.rail.height) = (2.0, 2.0),
        ];
        for change in changes {
            let mut config = paper_d(10);
            change(&mut config);
            assert_eq!(config.validate(), Ok(()));
            let (bodies, mut dofs) = (BodyParameters::from(&config), Vec::new());
            for mesh in [wheel_mesh(&bodies).unwrap(), rail_mesh(&bodies).unwrap()] {
                assert!((0..mesh.cells.len()).all(|c| crate::fem::element::points(&mesh.corners(c)).is_ok()));
                dofs.push(2 * (mesh.nodes.len() - mesh.fixed.len()));
            }
            assert!(dofs.iter().all(|n| *n < 200_000));
            println!("{dofs:?} dofs, a = {:.2e} m", bodies.half_width);
        }
    }
}
