//! Latent heat below the surface nodes of both bodies.

use super::column::{ColumnMelting, DepthColumn};
use crate::heat::melting::Melting;
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::mesh::nodal::Nodal;

/// Heat content over `ρc` from which on iron boils \[K], and the front below a surface node needs no exact place.
const BOILING: f64 = 3400.0;

/// Relation of heat content and temperature on the meshes of both bodies.
#[derive(Clone, Debug)]
pub struct LatentHeat {
    /// Relation at a point.
    pub melting: Melting,
    /// Columns of wheel and rail below a surface node.
    columns: [DepthColumn; 2],
}

/// Memory of a search below one surface node.
#[derive(Clone, Debug, Default)]
pub struct ColumnSearch {
    /// Heat content at the nodes.
    pub values: Vec<f64>,
    found: ColumnMelting,
    /// True where the nodes alone decide about melting.
    pub by_nodes: bool,
}

impl LatentHeat {
    /// Latent heat for the parameters and meshes of a layout; `None` if melting is left out.
    pub fn new(layout: &HeatLayout) -> Option<Self> {
        let melting = Melting::new(&layout.config)?;
        Some(Self { melting, columns: layout.bodies().map(|body| DepthColumn::new(&body.modes)) })
    }

    /// Replaces `latent` by the coefficients of the latent part below one surface node of a body (0: wheel, 1: rail)
    /// with the nodes `nodal` and the heat content `row`; the molten thickness \[m], `None` if nothing has melted and
    /// `latent` is left alone.
    pub fn below(
        &self,
        body: usize,
        nodal: &Nodal,
        row: &[f64],
        latent: &mut [f64],
        search: &mut ColumnSearch,
    ) -> Option<f64> {
        let (melting, column) = (&self.melting, &self.columns[body]);
        let ColumnSearch { values, found, by_nodes } = search;
        // Most rows are known to be solid without a look at their nodes.
        if nodal.bound(row) <= melting.solidus {
            return None;
        }
        values.resize(nodal.len(), 0.0);
        nodal.values(row, values);
        if values.iter().all(|h| *h <= melting.solidus) {
            return None;
        }
        if *by_nodes || values.iter().any(|h| *h > BOILING) {
            column.find_by_nodes(melting, values, found);
        } else {
            column.find(melting, values, found);
        }
        latent.fill(0.0);
        nodal.add(&found.latent, latent);
        Some(found.molten)
    }

    /// Replaces the heat contents `rows` below surface nodes of a body (0: wheel, 1: rail) by their temperatures.
    pub fn cool(&self, body: usize, nodal: &Nodal, rows: &mut [f64]) {
        let (mut search, mut latent) = (ColumnSearch::default(), vec![0.0; nodal.modes()]);
        for row in rows.chunks_exact_mut(nodal.modes()) {
            if self.below(body, nodal, row, &mut latent, &mut search).is_some() {
                row.iter_mut().zip(&latent).for_each(|(x, latent)| *x -= latent);
            }
        }
    }

    /// Replaces `out` by the coefficients of the latent part of both bodies with the heat content `content`.
    pub fn find(&self, layout: &HeatLayout, content: &[f64], out: &mut Vec<f64>, search: &mut ColumnSearch) {
        out.clear();
        out.resize(content.len(), 0.0);
        let fields = layout.split(content).into_iter().zip(layout.split_mut(out));
        for (i, (body, (content, out))) in layout.bodies().into_iter().zip(fields).enumerate() {
            let nm = body.nodal.modes();
            for (row, out) in content.chunks_exact(nm).zip(out.chunks_exact_mut(nm)) {
                self.below(i, &body.nodal, row, out, search);
            }
        }
    }
}
