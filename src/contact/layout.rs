//! Lines side by side that stand for a patch under a load.

use super::kernel::{LineKernel, Logarithm};
use crate::analytic::HalfPlane;
use crate::patch::gauss::{self, GaussLine};
use crate::patch::k11::k11;
use crate::patch::rows::{self, PatchRow};
use crate::patch::{Ellipse, Hertz, mindlin};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Smallest load for which lines are laid out, over that of the description \[1]. The reaches of lines under a smaller
/// one are shorter than the patch on a flat may be, for which their flexibility then is none.
const LEAST: f64 = 0.1;

/// Distance up to which the flexibility of a line is a logarithm, over the half-length under the load for which it is
/// laid out \[1]: more than a patch is long by half of its load more.
const END: f64 = 2.5;

/// A line as part of a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineLayout {
    /// Lateral position in the patch over its lateral half axis \[1].
    pub ordinate: f64,
    /// Width of the line over that of the bodies \[1].
    pub share: f64,
    /// Distance by which its surfaces are farther apart than the hub says \[m].
    pub gap: f64,
    /// Flexibility that it has for itself.
    pub kernel: LineKernel,
    /// Elastic energy beside that of its flexibility, per metre of its width [J/m].
    pub energy: f64,
}

/// Linear answer of the material of both bodies.
#[derive(Clone, Copy, Debug)]
pub struct PatchMaterial {
    /// Its half-plane.
    pub half_plane: HalfPlane,
    /// Shear modulus \[Pa].
    pub shear_modulus: f64,
    /// Poisson's ratio \[1].
    pub poissons_ratio: f64,
}

/// A patch of contact lines, whose size follows from its load as that of an ellipse does: lengths with its third root.
///
/// Every line is a plane contact of the radius R of the wheel with a flexibility of its own. Of the normal one the
/// factor κ is that with which the half-length belongs to the load of the line, `a² = 4κRP`. Its reach L is that with
/// which a line answers to a small change of the approach δ as it has to, `dP/dδ = 3P/2δ`, and the height of the wheel
/// over it that at which it carries P. So the patch has the pressures, the approach and the stiffness of Hertz's
/// ellipse. Derivation: `docs/theory/lines.md`.
#[derive(Clone, Debug)]
pub struct PatchLayout {
    /// Lines under the load `load`: both of a symmetric pair stand for one of twice the width.
    rows: Vec<PatchRow>,
    /// Load of the description \[N], and the approach that belongs to it \[m].
    load: f64,
    approach: f64,
    /// Lateral half axis under it \[m].
    lateral: f64,
    /// Radius of the wheel \[m].
    radius: f64,
    /// Width of the bodies \[m].
    width: f64,
    /// Tangential flexibility under it.
    tangential: Logarithm,
    coupling: f64,
}

impl PatchLayout {
    /// The ellipse of a wheel with the rolling `radius` \[m], on a number of `lines` by the rule of Gauss and Legendre.
    /// The bodies are `width` \[m] wide; `load` \[N] is any positive one.
    pub fn ellipse(
        (hertz, radius): (&Hertz, f64),
        material: PatchMaterial,
        (lines, width, load): (usize, f64, f64),
    ) -> Self {
        let PatchMaterial { half_plane, shear_modulus, poissons_ratio } = material;
        let Ellipse { a, b, peak, approach } = hertz.under(load);
        let gauss = gauss::half(lines);
        let row = |line: &GaussLine| {
            let share = (1.0 - line.ordinate.powi(2)).sqrt();
            let half_length = a * share;
            let line_load = 0.5 * PI * half_length * peak * share;
            PatchRow { position: b * line.ordinate, width: b * line.weight, half_length, line_load }
        };
        let rows: Vec<_> = gauss.iter().map(row).collect();
        // A single line, which is no rule for this pressure, carries the load on a smaller width.
        let scale = load / rows::load(&rows);
        let reach = mindlin::kernel_length(hertz.aspect(), poissons_ratio, &gauss) * (a * b).sqrt();
        let factor = (1.0 - poissons_ratio) / (PI * shear_modulus) / k11(hertz.aspect());
        Self {
            rows: rows.into_iter().map(|row| PatchRow { width: scale * row.width, ..row }).collect(),
            load,
            approach,
            lateral: b,
            radius,
            width,
            tangential: Logarithm { factor, reach: reach.ln() },
            coupling: half_plane.coupling * b / (a + b),
        }
    }

    /// Number of lines.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True without lines.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Load of which lines are laid out while the patch carries `load` \[N].
    pub fn load_of(&self, load: f64) -> f64 {
        load.max(LEAST * self.load)
    }

    /// Load for which a line with this `share` of the width, the first one, is laid out \[N].
    pub fn load_of_share(&self, share: f64) -> f64 {
        self.rows.first().map_or(0.0, |row| self.load * (share * self.width / row.width).powi(3))
    }

    /// Lines under a load \[N].
    pub fn lay_out(&self, load: f64) -> impl Iterator<Item = LineLayout> {
        let scale = (self.load_of(load) / self.load).cbrt();
        let approach = scale * scale * self.approach;
        rows::scaled(&self.rows, scale).map(move |row| {
            let PatchRow { position, width, half_length, line_load } = row;
            let factor = half_length * half_length / (4.0 * self.radius * line_load);
            let pressing = factor * line_load;
            LineLayout {
                ordinate: position / (scale * self.lateral),
                share: width / self.width,
                gap: approach / 3.0 - pressing,
                kernel: LineKernel {
                    tangential: Logarithm { reach: self.tangential.reach + scale.ln(), ..self.tangential },
                    normal: Logarithm { factor, reach: (0.5 * half_length).ln() + approach / (3.0 * pressing) },
                    coupling: self.coupling,
                    end: END * half_length,
                },
                energy: line_load * (approach / 15.0 - 0.25 * pressing),
            }
        })
    }
}
