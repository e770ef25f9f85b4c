//! A body on its tensor mesh.
//!
//! Fields are stored as `field[node · modes + mode]`; all recurrences run over the nodes and are vectors in the modes.

use super::depth_modes::DepthModes;
use super::kernels;
use super::nodal::Nodal;
use super::streamline::Streamline;
use crate::heat::error::HeatError;
use std::ops::Range;

/// Tensor mesh of a body with its material.
#[derive(Clone, Debug)]
pub struct HeatBody {
    /// Mesh along the surface.
    pub streamline: Streamline,
    /// Modes across the streamlines.
    pub modes: DepthModes,
    /// Nodes across the streamlines.
    pub nodal: Nodal,
    /// Heat capacity `ρc` [J/(m³ K)].
    pub heat_capacity: f64,
    /// Conductivity [W/(m K)].
    pub conductivity: f64,
    /// Coefficient of convection from the surface to the air [W/(m² K)].
    pub convection: f64,
    /// A field without any temperature; also what lies beyond the ends of an open streamline.
    pub nothing: Vec<f64>,
}

impl HeatBody {
    /// Body with the heat capacity `ρc` [J/(m³ K)], the conductivity [W/(m K)] and the coefficient of convection
    /// [W/(m² K)].
    pub fn new(
        streamline: Streamline,
        modes: DepthModes,
        heat_capacity: f64,
        conductivity: f64,
        convection: f64,
    ) -> Result<Self, HeatError> {
        let (nodal, nothing) = (Nodal::new(&modes)?, vec![0.0; streamline.len() * modes.len()]);
        Ok(Self { streamline, modes, nodal, heat_capacity, conductivity, convection, nothing })
    }

    /// Number of values of a field.
    pub fn size(&self) -> usize {
        self.streamline.len() * self.modes.len()
    }

    /// Adds a surface load given at the nodes `first..` to a right-hand side.
    pub fn add_surface_load(&self, first: usize, load: &[f64], out: &mut [f64]) {
        self.add_load(first, load, &self.modes.surface, out);
    }

    /// Adds a load given at the nodes `first..` to a right-hand side; `across` are the values of the modes where it
    /// enters.
    pub fn add_load(&self, first: usize, load: &[f64], across: &[f64], out: &mut [f64]) {
        kernels::add_rows(load, across, &mut out[first * self.modes.len()..]);
    }

    /// Surface values at a range of nodes.
    pub fn trace(&self, nodes: Range<usize>, x: &[f64], out: &mut Vec<f64>) {
        let nm = self.modes.len();
        out.resize(nodes.len(), 0.0);
        kernels::products(&x[nodes.start * nm..nodes.end * nm], &self.modes.surface, out);
    }

    /// `∫ x ds` of every mode.
    pub fn integrate(&self, x: &[f64], sums: &mut Vec<f64>) {
        let nm = self.modes.len();
        sums.clear();
        sums.resize(nm, 0.0);
        kernels::add_weighted(&self.streamline.weights, x, sums);
    }
}
