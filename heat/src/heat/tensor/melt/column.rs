//! Temperatures below one surface node, where steel melts.
//!
//! The heat content over `ρc` is a field of the mesh, but its latent part is not: it rises within less than a layer. So
//! it is put on the mesh by the weight of the heat content, with the parabolas of the temperature between the nodes,
//!
//! ```text
//! M h = M T + Λ(T),   Λᵢ = ∫ G Nᵢ ℓ(T) dz ,
//! ```
//!
//! and a melting front moves steadily through a layer. With `h = T + ℓ` at the nodes alone it would rest at every node
//! until the whole share of that node is molten. The map from `h` to `T` is the gradient of a convex function, turned
//! round: it is found by Newton's method, and the latent part of two heat contents differs by less than these.

use super::parabola::{add_products, parabola, points, polynomial, sections};
use crate::heat::melting::Melting;
use crate::heat::tensor::mesh::depth_modes::{DepthModes, quadratic};

/// Residual at which a temperature counts as found \[K].
const TOLERANCE: f64 = 1e-6;
/// Residual over the heat content, where that is more than any steel has \[1].
const ROUND_OFF: f64 = 1e-11;
const ITERATIONS: usize = 30;
/// Distance by which a temperature may lie below the reference, or below all contents \[K].
const MARGIN: f64 = 0.005;

/// Elements of a body across its streamlines.
#[derive(Clone, Debug)]
pub struct DepthColumn {
    /// Half the thickness of the layers times their weight `G`, a polynomial of the place in the layer from −1 to 1
    /// \[m].
    layers: Vec<[f64; 3]>,
    /// Half the thickness of the layers \[m].
    halves: Vec<f64>,
    /// Diagonal of `M` and the two beside it \[m].
    mass: Vec<[f64; 3]>,
    /// `∫ G N dz` of the nodes of each layer \[m].
    shares: Vec<[f64; 3]>,
    /// Nodes that are not held.
    size: usize,
}

/// Temperatures and latent heat below a surface node, with the memory of their search.
#[derive(Clone, Debug, Default)]
pub struct ColumnMelting {
    /// Excess temperatures at the nodes \[K].
    pub temperature: Vec<f64>,
    /// Latent part of the heat content at the nodes, over `ρc` \[K].
    pub latent: Vec<f64>,
    /// Molten thickness \[m].
    pub molten: f64,
    /// `Λ`, then the residual \[K m].
    residual: Vec<f64>,
    /// Matrix of Newton's method: diagonal and the two beside it.
    matrix: Vec<[f64; 3]>,
    /// Change of the last iteration \[K].
    change: Vec<f64>,
}

impl DepthColumn {
    /// Elements of a body with the given modes.
    pub fn new(modes: &DepthModes) -> Self {
        let layers = modes.weights.clone();
        let halves: Vec<f64> = modes.depths.windows(3).step_by(2).map(|z| 0.5 * (z[2] - z[0])).collect();
        let size = modes.shapes.nrows();
        let mut mass = vec![[0.0; 3]; 2 * layers.len() + 1];
        let mut shares = Vec::with_capacity(layers.len());
        for (e, weight) in layers.iter().enumerate() {
            let mut share = [0.0; 3];
            for point in points(-1.0, 1.0) {
                let shape = quadratic(point.place);
                let volume = point.weight * polynomial(weight, point.place);
                share.iter_mut().zip(shape).for_each(|(share, n)| *share += volume * n);
                add_products(&mut mass[2 * e..], volume, shape);
            }
            shares.push(share);
        }
        Self { layers, halves, mass, shares, size }
    }

    /// Fills `found` for the heat content over `ρc` at the nodes.
    ///
    /// For latent heats a thousand times that of steel the search may not end, and where a layer is much thicker than
    /// its hot part, a node may come to lie below all contents; then the contents of the nodes decide alone.
    pub fn find(&self, melting: &Melting, content: &[f64], found: &mut ColumnMelting) {
        let lowest = |values: &[f64]| values.iter().copied().fold(0.0, f64::min);
        if !self.search(melting, content, found) || lowest(&found.temperature) < lowest(content) - MARGIN {
            self.find_by_nodes(melting, content, found);
        }
    }

    /// Fills `found` as if the latent part were a field of the mesh, given by the content of its nodes.
    pub fn find_by_nodes(&self, melting: &Melting, content: &[f64], found: &mut ColumnMelting) {
        found.temperature.clear();
        found.temperature.extend(content.iter().map(|&h| melting.temperature(h)));
        found.latent.clear();
        found.latent.extend(content.iter().map(|&h| melting.latent_part(h)));
        let share = |node: usize| content.get(node).map_or(0.0, |&h| melting.fraction(h));
        let simpson = |e: usize| (share(2 * e) + 4.0 * share(2 * e + 1) + share(2 * e + 2)) / 3.0;
        found.molten = self.halves.iter().enumerate().map(|(e, half)| half * simpson(e)).sum();
    }

    /// Newton's method; whether it has found the temperatures.
    fn search(&self, melting: &Melting, content: &[f64], found: &mut ColumnMelting) -> bool {
        let ColumnMelting { temperature, latent, change, .. } = found;
        temperature.clear();
        temperature.extend(content.iter().map(|&h| melting.temperature(h)));
        for values in [latent, change] {
            values.clear();
            values.resize(self.size, 0.0);
        }
        let tolerance = content.iter().fold(TOLERANCE, |largest, h| largest.max(ROUND_OFF * h.abs()));
        let mut least = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let error = self.linearise(melting, content, found);
            let ColumnMelting { temperature, residual, matrix, change, latent, .. } = found;
            if error <= tolerance {
                latent.iter_mut().zip(content).zip(&*temperature).for_each(|((latent, h), t)| *latent = h - t);
                return true;
            }
            if error < least {
                least = error;
                change.copy_from_slice(residual);
                solve(matrix, change);
                temperature.iter_mut().zip(&*change).for_each(|(t, change)| *t += change);
            } else {
                // Half of a change that was too large.
                change.iter_mut().for_each(|change| *change *= 0.5);
                temperature.iter_mut().zip(&*change).for_each(|(t, change)| *t -= change);
            }
        }
        false
    }

    /// Fills residual and matrix at the temperatures of `found`, and its molten thickness; the largest residual \[K].
    fn linearise(&self, melting: &Melting, content: &[f64], found: &mut ColumnMelting) -> f64 {
        let ColumnMelting { temperature, molten, residual, matrix, .. } = found;
        let nodes = self.mass.len();
        residual.clear();
        residual.resize(nodes, 0.0);
        matrix.clone_from(&self.mass);
        *molten = 0.0;
        for (e, half) in self.halves.iter().enumerate() {
            let at = |i: usize| temperature.get(2 * e + i).copied().unwrap_or(0.0);
            let values = [at(0), at(1), at(2)];
            let thickness = self.add_layer(melting, e, values, &mut residual[2 * e..], &mut matrix[2 * e..]);
            *molten += half * thickness;
        }
        let mut largest = 0.0_f64;
        for (i, residual) in residual.iter_mut().enumerate().take(self.size) {
            // Residual `M (h − T) − Λ`; a node that is held has none.
            let mut missing = -*residual;
            for j in i.saturating_sub(2)..(i + 3).min(self.size) {
                missing += self.mass[i.min(j)][i.abs_diff(j)] * (content[j] - temperature[j]);
            }
            *residual = missing;
            largest = largest.max(missing.abs() / self.mass[i][0]);
        }
        residual.truncate(self.size);
        matrix.truncate(self.size);
        largest
    }

    /// Adds the part of a layer with the temperatures `values` to `Λ` and its derivative; its molten share times two.
    fn add_layer(
        &self,
        melting: &Melting,
        layer: usize,
        values: [f64; 3],
        load: &mut [f64],
        matrix: &mut [[f64; 3]],
    ) -> f64 {
        let [a, b, c] = values;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // A parabola exceeds its nodes by at most this.
        let beyond = 0.125 * (a - 2.0 * b + c).abs();
        if high + beyond <= melting.solidus {
            return 0.0;
        }
        if low - beyond >= melting.liquidus {
            load.iter_mut().zip(self.shares[layer]).for_each(|(load, share)| *load += melting.latent * share);
            return 2.0;
        }
        let (ends, count) = sections(melting, values);
        let slope = melting.latent / (melting.liquidus - melting.solidus);
        let mut thickness = 0.0;
        for pair in ends[..count].windows(2) {
            let middle = parabola(values, 0.5 * (pair[0] + pair[1]));
            if middle <= melting.solidus {
                continue;
            }
            let mushy = middle < melting.liquidus;
            for point in points(pair[0], pair[1]) {
                let shape = quadratic(point.place);
                let molten = melting.molten_fraction(parabola(values, point.place));
                let volume = point.weight * polynomial(&self.layers[layer], point.place);
                thickness += point.weight * molten;
                for (load, n) in load.iter_mut().zip(shape) {
                    *load += melting.latent * molten * volume * n;
                }
                if mushy {
                    add_products(matrix, slope * volume, shape);
                }
            }
        }
        thickness
    }
}

/// Replaces `x` by the solution of a symmetric, positive definite system with two diagonals beside the main one.
fn solve(band: &mut [[f64; 3]], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        let [diagonal, beside, far] = band[i];
        let factors = [beside / diagonal, far / diagonal];
        if i + 1 < n {
            band[i + 1][0] -= factors[0] * beside;
            band[i + 1][1] -= factors[0] * far;
            x[i + 1] -= factors[0] * x[i];
        }
        if i + 2 < n {
            band[i + 2][0] -= factors[1] * far;
            x[i + 2] -= factors[1] * x[i];
        }
        x[i] /= diagonal;
        band[i] = [diagonal, factors[0], factors[1]];
    }
    for i in (0..n).rev() {
        let after = |k: usize| x.get(i + k).copied().unwrap_or(0.0);
        x[i] -= band[i][1] * after(1) + band[i][2] * after(2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::grading::graded;
    use crate::heat::tensor::mesh::section::Section;

    const STEEL: Melting = Melting { solidus: 1430.0, liquidus: 1510.0, latent: 574.0 };

    fn column() -> DepthColumn {
        let layers = graded(8e-6, 1.8, 0.06, 0.4);
        DepthColumn::new(&DepthModes::new(&Section::even(layers), 2.0, true, 0.0).unwrap())
    }

    /// Even the wildest contents have a temperature, and its latent part is theirs.
    #[test]
    fn any_heat_content_has_a_temperature_and_both_differ_by_the_latent_part() {
        let (column, mut found) = (column(), ColumnMelting::default());
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for k in 0..4000 {
            // Every other material is one that no steel comes near.
            let wild = if k % 2 == 0 { 1.0 } else { 10.0_f64.powf(4.0 * random() - 2.0) };
            let melting = Melting { liquidus: 1430.0 + 80.0 / wild, latent: 574.0 * wild * wild, ..STEEL };
            let (low, high) = (3000.0 * random() - 500.0, 4000.0 * wild * random());
            let content: Vec<f64> = (0..column.size).map(|_| low + (high - low) * random()).collect();
            column.find(&melting, &content, &mut found);
            let differs = |((h, t), l): ((&f64, &f64), &f64)| (h - t - l).abs() > 1e-9 * h.abs().max(1.0);
            assert!(!content.iter().zip(&found.temperature).zip(&found.latent).any(differs));
            assert!(found.molten >= 0.0 && found.molten <= 0.4 * (1.0 + 1e-9), "{}", found.molten);
            if wild == 1.0 {
                assert!(column.search(&melting, &content, &mut found));
            }
        }
    }

    /// Straight profiles whose solidus lies at any depth of a layer melt to the depth of the middle between both
    /// temperatures, and the content goes up and down the profile without a rest at a node.
    #[test]
    fn the_molten_thickness_of_a_straight_profile_is_exact_wherever_the_front_lies() {
        let (column, mut found) = (column(), ColumnMelting::default());
        let depths: Vec<f64> = {
            let layers = graded(8e-6, 1.8, 0.06, 0.4);
            layers.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]).collect()
        };
        for k in 1..40 {
            let front = 1e-5 * f64::from(k);
            let straight: Vec<f64> = depths.iter().map(|z| (1470.0 + 4e6 * (front - z)).max(0.0)).collect();
            // The content that belongs to it: temperature and projected latent part.
            found.temperature.clone_from(&straight);
            column.linearise(&STEEL, &straight, &mut found);
            let (mut mass, mut latent) = (column.mass.clone(), found.residual.clone());
            mass.truncate(column.size);
            solve(&mut mass, &mut latent);
            let content: Vec<f64> = straight.iter().zip(&latent).map(|(t, missing)| t - missing).collect();
            column.find(&STEEL, &content, &mut found);
            let worst = straight.iter().zip(&found.temperature).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
            assert!(worst < 1e-4, "{worst} K");
            assert!((found.molten / front - 1.0).abs() < 1e-7, "{} of {front}", found.molten);
        }
    }
}
