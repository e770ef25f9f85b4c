//! Streamline-aligned graded meshes: polar in the wheel, rectangular in the rail, fine at the contact.
//!
//! Surface nodes of both bodies lie at `x_i = i h` in and around the contact zone and are paired one to one. Beyond, in
//! the wings of the zone, they are still paired, at distances that grow slowly: there is room for patches much wider
//! than those for which the mesh is laid out. Away from both the cell size grows by a constant factor per cell.

use super::grading::Grading;
use super::{Face, FemError, Mesh};
use std::f64::consts::PI;

/// Half of the candidate zone in half-widths.
const ZONE: f64 = 1.5;
/// Surface nodes on each side beyond the candidates.
pub const GUARDS: usize = 3;
/// Growth of the cell size per cell along the surface and into the depth.
const GROWTH: f64 = 1.2;
/// Growth of the cells in the wings by this many uniform ones per half-width, `h(s) = h (1 + 2 s/a)`, so that finer
/// meshes are finer everywhere; but no more than by [`GROWTH`] per cell, nor less than by 7 %: very fine meshes stay
/// affordable.
const WING_SLOPE: f64 = 2.0;
const LEAST_WING_GROWTH: f64 = 1.07;
const DEPTH_GROWTH: f64 = 1.15;
/// Largest cell of the wheel along the circumference [rad]; its chords stiffen the torsion by about `0.4 angle²`.
const LARGEST_ANGLE: f64 = 0.05;
/// Largest cell in wheel radii, across the wheel's streamlines and in the rail.
const LARGEST: f64 = 0.05;
/// Cell size at the hub in hub radii, and its growth per cell outwards.
const HUB: f64 = 0.05;
const HUB_GROWTH: f64 = 1.1;
/// Depth of the uniform layers below the contact in half-widths.
const UNIFORM_DEPTH: f64 = 0.5;

/// Where the mesh is fine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactZone {
    /// Half-width of the contact for which the mesh is laid out \[m].
    pub half_width: f64,
    /// Elements per half-width.
    pub elements: usize,
    /// Distance from the contact point up to which surface nodes are paired \[m]. No further than the uniform zone: no
    /// wings.
    pub reach: f64,
}

impl ContactZone {
    /// Distance of surface nodes `h` \[m].
    pub fn spacing(&self) -> f64 {
        self.half_width / self.elements.max(1) as f64
    }

    /// Number of candidate nodes in the uniform zone, odd.
    pub fn candidates(&self) -> usize {
        2 * (ZONE * self.elements as f64).ceil() as usize + 1
    }

    /// Number of surface nodes of each body: candidates, guards and those of the wings.
    pub fn surface_nodes(&self) -> usize {
        self.candidates() + 2 * (GUARDS + self.wing_nodes())
    }

    /// x of candidates, guards and wings, ascending, symmetric about zero \[m].
    pub fn surface_x(&self) -> Vec<f64> {
        let (half, core) = ((self.candidates() / 2 + GUARDS) as isize, self.core());
        let wing: Vec<f64> = match self.wings() {
            Some((length, grading)) => grading.positions(length).iter().skip(1).map(|s| core + s).collect(),
            None => Vec::new(),
        };
        let uniform = (-half..=half).map(|i| i as f64 * self.spacing());
        wing.iter().rev().map(|x| -x).chain(uniform).chain(wing.iter().copied()).collect()
    }

    /// Number of surface nodes in each wing: none, or more than there are guards.
    pub fn wing_nodes(&self) -> usize {
        self.wings().map_or(0, |(length, grading)| grading.cells(length) as usize)
    }

    /// Length of each wing [m] and its grading.
    fn wings(&self) -> Option<(f64, Grading)> {
        let (first, length) = (self.spacing(), self.reach - self.core());
        let slope = (WING_SLOPE * first / self.half_width).clamp(libm::log(LEAST_WING_GROWTH), libm::log(GROWTH));
        let grading = Grading::one_sided(first, libm::exp(slope), first + slope * length);
        (length > 0.0 && grading.cells(length) > GUARDS as f64).then_some((length, grading))
    }

    /// Distance of the outermost uniformly spaced surface node from the contact point [m].
    fn core(&self) -> f64 {
        (self.candidates() / 2 + GUARDS) as f64 * self.spacing()
    }

    /// Distance of the outermost surface node from the contact point, and length of the cell before it [m].
    fn end(&self) -> [f64; 2] {
        let x = self.surface_x();
        let last = x.len() - 1;
        [x[last], x[last] - x[last - 1]]
    }

    /// Distance of the outermost node that may come into contact from the contact point \[m].
    pub fn end_of_candidates(&self) -> f64 {
        let x = self.surface_x();
        x[x.len() - 1 - GUARDS]
    }

    /// Number of uniform layers below the surface.
    fn layers(&self) -> usize {
        (UNIFORM_DEPTH * self.elements as f64).ceil() as usize
    }

    /// Depth of the uniform layers [m].
    fn uniform_depth(&self) -> f64 {
        self.layers() as f64 * self.spacing()
    }

    /// Depths of the uniform layers and the graded ones below them, 0 to `thickness` [m].
    fn depths(&self, thickness: f64, grading: Grading) -> Vec<f64> {
        let uniform = self.uniform_depth();
        let mut depths: Vec<f64> = (0..self.layers()).map(|i| i as f64 * self.spacing()).collect();
        depths.extend(grading.positions(thickness - uniform).iter().map(|s| uniform + s));
        depths
    }

    /// Number of layers of cells that [`Self::depths`] separates.
    fn rows(&self, thickness: f64, grading: Grading) -> f64 {
        self.layers() as f64 + grading.cells(thickness - self.uniform_depth())
    }

    fn check(&self, limit: f64, what: &'static str) -> Result<(), FemError> {
        positive(self.half_width, "contact half-width")?;
        let [zone, _] = self.end();
        if zone > limit {
            Err(FemError::ZoneTooLarge { zone, half_width: self.half_width, limit, what })
        } else {
            Ok(())
        }
    }
}

fn positive(value: f64, what: &'static str) -> Result<(), FemError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(FemError::BadLength { what, value }) }
}

/// Gradings of a mesh, before any node is placed.
struct Layout {
    /// Along the surface, from the contact zone on.
    side: Grading,
    /// Length that it fills on each side [rad] or [m].
    side_length: f64,
    /// Into the depth, below the uniform layers.
    depth: Grading,
}

/// Checks the dimensions of a wheel and lays out its mesh.
fn wheel_layout(radius: f64, hub_radius: f64, zone: ContactZone) -> Result<Layout, FemError> {
    positive(hub_radius, "hub radius")?;
    positive(radius - hub_radius, "radius − hub radius")?;
    zone.check(0.25 * radius, "a quarter of the wheel radius")?;
    let thickness = radius - hub_radius;
    zone.check(2.0 * thickness, "twice the depth of the wheel's rim")?;
    let largest = (LARGEST * radius).min(0.25 * thickness);
    let last = (HUB * hub_radius).min(thickness / 12.0);
    let [reach, cell] = zone.end();
    Ok(Layout {
        side: Grading::one_sided(cell / radius, GROWTH, LARGEST_ANGLE),
        side_length: PI - libm::asin(reach / radius),
        depth: Grading { first: zone.spacing(), growth: DEPTH_GROWTH, largest, last, growth_last: HUB_GROWTH },
    })
}

/// Checks the dimensions of a rail and lays out its mesh.
fn rail_layout(length: f64, height: f64, largest: f64, zone: ContactZone) -> Result<Layout, FemError> {
    positive(length, "rail length")?;
    positive(height, "rail height")?;
    positive(largest, "largest cell")?;
    zone.check(0.45 * length, "0.45 rail lengths")?;
    zone.check(2.0 * height, "twice the rail height")?;
    let depth = Grading::one_sided(zone.spacing(), GROWTH, largest.min(0.25 * height));
    let [reach, cell] = zone.end();
    Ok(Layout {
        side: Grading::one_sided(cell, GROWTH, largest.min(0.25 * length)),
        side_length: 0.5 * length - reach,
        depth: Grading { growth: DEPTH_GROWTH, ..depth },
    })
}

/// Number of unknown displacements on the mesh that [`wheel`] makes, without making it.
pub fn wheel_unknowns(radius: f64, hub_radius: f64, zone: ContactZone) -> Result<f64, FemError> {
    let layout = wheel_layout(radius, hub_radius, zone)?;
    let around = zone.surface_nodes() as f64 + 2.0 * layout.side.cells(layout.side_length) - 1.0;
    Ok(2.0 * around * zone.rows(radius - hub_radius, layout.depth))
}

/// Number of unknown displacements on the mesh that [`rail`] makes, without making it.
pub fn rail_unknowns(length: f64, height: f64, largest: f64, zone: ContactZone) -> Result<f64, FemError> {
    let layout = rail_layout(length, height, largest, zone)?;
    let along = zone.surface_nodes() as f64 + 2.0 * layout.side.cells(layout.side_length);
    Ok(2.0 * along * zone.rows(height, layout.depth))
}

/// Annulus about the origin, contact point at the bottom `(0, −radius)`, inner circle fixed; lengths in \[m].
pub fn wheel(radius: f64, hub_radius: f64, zone: ContactZone) -> Result<Mesh, FemError> {
    let layout = wheel_layout(radius, hub_radius, zone)?;
    let surface_x = zone.surface_x();
    let mut angles: Vec<f64> = surface_x.iter().map(|x| libm::asin(x / radius)).collect();
    let edge = libm::asin(zone.end()[0] / radius);
    let side = layout.side.positions(layout.side_length);
    angles.extend(side.iter().skip(1).map(|s| edge + s));
    angles.extend(side.iter().rev().skip(1).take(side.len() - 2).map(|s| -edge - s));
    let depths = zone.depths(radius - hub_radius, layout.depth);
    let (rows, around) = (depths.len(), angles.len());
    let mut mesh = Mesh::default();
    for depth in &depths {
        let r = radius - depth;
        // The rim's surface nodes get their x exactly.
        mesh.nodes.extend(angles.iter().enumerate().map(|(j, angle)| match surface_x.get(j) {
            Some(&x) if *depth == 0.0 => [x, -(radius * radius - x * x).sqrt()],
            _ => [r * libm::sin(*angle), -r * libm::cos(*angle)],
        }));
    }
    for i in 0..rows - 1 {
        for j in 0..around {
            let next = (j + 1) % around;
            mesh.cells.push([i * around + j, i * around + next, (i + 1) * around + next, (i + 1) * around + j]);
        }
    }
    mesh.surface = (0..surface_x.len()).collect();
    mesh.fixed = ((rows - 1) * around..rows * around).collect();
    // The surface nodes come first, then those of one side up to the top, and those of the other side back down.
    let opposite = |j: usize| (around + surface_x.len() - 1 - j) % around;
    mesh.mirror = (0..rows * around).map(|node| node - node % around + opposite(node % around)).collect();
    Ok(mesh)
}

/// Rectangle `|x| ≤ length/2`, `−height ≤ y ≤ 0` with the contact point at the origin, base fixed, free ends.
///
/// Lengths in \[m]; `largest` bounds the cell size.
pub fn rail(length: f64, height: f64, largest: f64, zone: ContactZone) -> Result<Mesh, FemError> {
    let layout = rail_layout(length, height, largest, zone)?;
    let surface_x = zone.surface_x();
    let [edge, _] = zone.end();
    let side = layout.side.positions(layout.side_length);
    let mut xs: Vec<f64> = side.iter().rev().take(side.len() - 1).map(|s| -edge - s).collect();
    let first = xs.len();
    xs.extend(&surface_x);
    xs.extend(side.iter().skip(1).map(|s| edge + s));
    let depths = zone.depths(height, layout.depth);
    let (rows, along) = (depths.len(), xs.len());
    let mut mesh = Mesh::default();
    for depth in &depths {
        mesh.nodes.extend(xs.iter().map(|x| [*x, -depth]));
    }
    for i in 0..rows - 1 {
        for j in 0..along - 1 {
            let cell = mesh.cells.len();
            // Counter-clockwise from the lower left corner.
            let (above, below) = (i * along + j, (i + 1) * along + j);
            mesh.cells.push([below, below + 1, above + 1, above]);
            if j == 0 {
                mesh.ends.push(Face { cell, edge: 3 });
            }
            if j == along - 2 {
                mesh.ends.push(Face { cell, edge: 1 });
            }
        }
    }
    mesh.surface = (first..first + surface_x.len()).collect();
    mesh.fixed = ((rows - 1) * along..rows * along).collect();
    mesh.mirror = (0..rows * along).map(|node| node - node % along + (along - 1 - node % along)).collect();
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::element;

    fn area(mesh: &Mesh) -> f64 {
        (0..mesh.cells.len()).flat_map(|c| element::points(&mesh.corners(c)).unwrap()).map(|p| p.dv).sum()
    }

    #[test]
    fn surface_nodes_of_both_bodies_are_paired() {
        let zone = ContactZone { half_width: 7.6e-4, elements: 20, reach: 0.0 };
        let (w, r) = (wheel(0.5, 0.05, zone).unwrap(), rail(1.0, 0.1, 0.025, zone).unwrap());
        assert_eq!((zone.candidates(), w.surface.len()), (61, 67));
        assert_eq!(w.surface_x(), r.surface_x());
        assert!(w.surface_x().windows(2).all(|x| (x[1] - x[0] - zone.spacing()).abs() < 1e-15));
        let on_rim = |&n: &usize| (w.nodes[n][0].hypot(w.nodes[n][1]) - 0.5).abs() < 1e-14 && w.nodes[n][1] < 0.0;
        assert!(w.surface.iter().all(on_rim) && r.surface.iter().all(|&n| r.nodes[n][1] == 0.0));
        assert!((area(&r) - 0.1).abs() < 1e-14);
        let ends: f64 = r
            .ends
            .iter()
            .flat_map(|f| element::edge_points(&r.corners(f.cell), f.edge).unwrap())
            .map(|p| p.normal[0].abs())
            .sum();
        assert!((ends - 0.2).abs() < 1e-14);
    }

    #[test]
    fn wings_are_paired_and_as_fine_as_the_zone_that_they_continue() {
        for (elements, nodes) in [(10, 12), (20, 22), (40, 37)] {
            let zone = ContactZone { half_width: 7.6e-4, elements, reach: 5.5 * 7.6e-4 };
            let (w, r) = (wheel(0.5, 0.05, zone).unwrap(), rail(1.0, 0.1, 0.025, zone).unwrap());
            let x = w.surface_x();
            assert_eq!(zone.wing_nodes(), nodes);
            assert!(x == r.surface_x());
            let cells: Vec<f64> = x.windows(2).map(|x| (x[1] - x[0]) / zone.half_width).collect();
            println!("{elements} elements per half-width: the largest cell has {:.3}", cells[0]);
            assert!(cells.windows(2).all(|pair| (pair[1] / pair[0]).ln().abs() < 1.02 * GROWTH.ln()));
            // On the finest of them the cells grow by no less than 7 %.
            assert!(cells[0] < 12.0 / elements as f64 && (x[0] / zone.half_width + 5.5).abs() < 1e-12);
            assert!(x.iter().zip(x.iter().rev()).all(|(a, b)| a + b == 0.0));
        }
    }

    #[test]
    fn bodies_are_their_own_mirror_images() {
        for (elements, reach) in [(5, 0.0), (8, 5.5 * 7.6e-4)] {
            let zone = ContactZone { half_width: 7.6e-4, elements, reach };
            for mesh in [wheel(0.5, 0.05, zone).unwrap(), rail(1.0, 0.1, 0.025, zone).unwrap()] {
                for (node, &image) in mesh.mirror.iter().enumerate() {
                    let ([x, y], [there_x, there_y]) = (mesh.nodes[node], mesh.nodes[image]);
                    assert!((x + there_x).abs() < 1e-15 && (y - there_y).abs() < 1e-15);
                    assert_eq!(mesh.mirror[image], node);
                }
                assert_eq!(mesh.mirror.len(), mesh.nodes.len());
            }
        }
    }

    #[test]
    fn number_of_unknowns_is_known_before_the_mesh_is_made() {
        for (half_width, elements, wide) in [(7.6e-4, 20, 5.5), (1e-4, 4, 5.5), (1.1e-2, 31, 0.0), (1e-3, 10, 1.8)] {
            let zone = ContactZone { half_width, elements, reach: wide * half_width };
            assert_eq!(zone.surface_nodes(), zone.surface_x().len());
            let count = |mesh: &Mesh| (2 * (mesh.nodes.len() - mesh.fixed.len())) as f64;
            assert_eq!(count(&wheel(0.5, 0.05, zone).unwrap()), wheel_unknowns(0.5, 0.05, zone).unwrap());
            assert_eq!(count(&rail(1.0, 0.1, 0.025, zone).unwrap()), rail_unknowns(1.0, 0.1, 0.025, zone).unwrap());
        }
    }

    #[test]
    fn oversized_contact_zones_are_refused() {
        let zone = ContactZone { half_width: 0.2, elements: 8, reach: 0.0 };
        assert!(matches!(wheel(0.5, 0.05, zone), Err(FemError::ZoneTooLarge { .. })));
        assert!(matches!(rail(0.5, 0.05, 0.1, zone), Err(FemError::ZoneTooLarge { .. })));
        assert!(matches!(wheel(0.5, 0.6, zone), Err(FemError::BadLength { .. })));
    }
}
