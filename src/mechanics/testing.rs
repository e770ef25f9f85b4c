//! Configurations for the tests.

use crate::config::*;

/// The wheel and rail of Paper D with a choice of mesh.
pub fn paper_d(elements: usize) -> Config {
    Config {
        model: ModelParameters { contact_width: 1.0, nominal_load: 1e5 },
        wheel: Wheel { radius: 0.5, hub_radius: 0.05, hub_mass: 0.0, hub_inertia: 0.0 },
        vehicle: Vehicle { mass: 0.0 },
        rail: Rail { length: 1.0, height: 0.1 },
        material: Material { youngs_modulus: 2e11, poissons_ratio: 0.3, density: 8000.0 },
        friction: Friction { coefficient: 0.4 },
        physics: Physics { centrifugal: true },
        mesh: MeshParameters { elements_per_half_width: elements },
        solver: SolverParameters {
            response: Response::Reduced,
            modes_wheel: 80,
            modes_rail: 40,
            time_scheme: TimeScheme::Bdf2,
            theta: 1.0,
            max_step: 1e-3,
        },
        initial: Initial { velocity: 50.0 / 3.6, creepage: 0.0 },
    }
}
