//! Parameters of the bodies, and what follows from them without a mesh.

use super::damping::BodyDamping;
use crate::fem::ContactZone;
use crate::material::Isotropic;
use std::f64::consts::PI;

/// Parameters of wheel and rail.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyParameters {
    /// Radius of the tread \[m].
    pub radius: f64,
    /// Radius of the rigid hub \[m].
    pub hub_radius: f64,
    /// Length of the rail \[m].
    pub rail_length: f64,
    /// Height of the rail \[m].
    pub rail_height: f64,
    /// Ends of the rail.
    pub rail_ends: Ends,
    /// Material of both bodies.
    pub material: Isotropic,
    /// Half of the length of the contact under the nominal load along the direction of rolling \[m].
    pub half_width: f64,
    /// Distance from the contact point up to which contact is to be looked for at least \[m].
    pub reach: f64,
    /// Finite elements per half-width of the nominal contact.
    pub elements: usize,
    /// Cells of the contact grid per half-width at least.
    pub grid_elements: usize,
    /// True if the bodies answer by modes, false if by all their finite elements.
    pub reduced: bool,
    /// Vibration modes of wheel and rail.
    pub modes: [usize; 2],
    /// Damping of wheel and rail.
    pub damping: [BodyDamping; 2],
    /// True if centrifugal forces stretch the wheel.
    pub centrifugal: bool,
}

/// Ends of the rail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Held.
    Fixed,
    /// Free of forces.
    Free,
    /// Absorbing waves.
    Nonreflecting,
}

/// Distance from the contact point up to which surface nodes are paired, in nominal half-widths: patches of softened
/// steel grow to about 3.5 of them within two seconds of sliding, and thermal expansion may move them.
const REACH: f64 = 6.0;
/// Largest such distance, in radii of the wheel, thicknesses of its rim, lengths and heights of the rail: the heat
/// model has room for it.
const SHARES: [f64; 4] = [0.19, 1.5, 0.22, 1.5];

impl BodyParameters {
    /// Finite elements per half-width: full bodies take the forces of contact nodes as nodal loads, and thus have one for
    /// each.
    fn elements(&self) -> usize {
        if self.reduced { self.elements } else { self.elements.max(self.grid_elements) }
    }

    /// Cells of the contact grid in every element of the surface.
    pub fn grid_cells_per_element(&self) -> usize {
        self.grid_elements.div_ceil(self.elements()).max(1)
    }

    /// Distance of the nodes of the contact grid under the nominal load \[m].
    pub fn grid_spacing(&self) -> f64 {
        self.half_width / (self.elements() * self.grid_cells_per_element()) as f64
    }

    /// Fine zone of the meshes for the nominal load, with wings for wider patches where the bodies have room for them.
    pub(super) fn winged_zone(&self) -> ContactZone {
        let (radius, length) = (self.radius, self.rail_length);
        let lengths = [radius, radius - self.hub_radius, length, self.rail_height];
        let most = SHARES.iter().zip(lengths).map(|(share, length)| share * length).fold(f64::INFINITY, f64::min);
        let reach = most.min(REACH * self.half_width);
        let mut zone = ContactZone { half_width: self.half_width, elements: self.elements(), reach };
        while zone.reach < most && zone.end_of_candidates() < self.reach {
            zone.reach = most.min(zone.reach + self.half_width);
        }
        zone
    }

    /// Mass of the wheel `ρ π (r_o² − r_i²)` [kg/m], exact for the circle.
    pub fn wheel_mass(&self) -> f64 {
        let (outer, inner) = (self.radius, self.hub_radius);
        self.material.density * PI * (outer * outer - inner * inner)
    }

    /// Polar moment of inertia of the wheel `½ ρ π (r_o⁴ − r_i⁴)` [kg m²/m], exact for the circle.
    pub fn wheel_inertia(&self) -> f64 {
        0.5 * self.material.density * PI * (self.radius.powi(4) - self.hub_radius.powi(4))
    }

    /// Largest cells of the rail \[m]: as large as those of the wheel, or 1/150 of a very long rail.
    pub(super) fn largest_rail_cell(&self) -> f64 {
        (0.05 * self.radius).max(self.rail_length / 150.0)
    }
}
