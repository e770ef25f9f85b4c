//! Lines of the patch in which wheel and rail touch.

use super::line::Line;
use crate::config::{Config, ContactShape};
use crate::contact::{LineKernel, LineLayout, Logarithm, PatchLayout, PatchMaterial};
use crate::material::Isotropic;

/// Distances at which forces displace plane bodies as they displace those of wheel and rail \[m]: tangential, normal on
/// a rigid base, and normal on a track that yields (`docs/theory/structural-width.md`).
const REACHES: [f64; 3] = [0.025, 1.2e-3, 7.4e-3];

/// Flexibility of plane bodies of the structural width in whose place lines have one of their own.
pub fn apart(config: &Config) -> LineKernel {
    let half_plane = Isotropic::from(&config.material).half_plane();
    let [tangential, rigid, yielding] = REACHES;
    let normal = if config.rail.support_stiffness > 0.0 { yielding } else { rigid };
    let along = |reach: f64| Logarithm { factor: half_plane.kernel, reach: reach.ln() };
    LineKernel {
        tangential: along(tangential),
        normal: along(normal),
        coupling: half_plane.coupling,
        end: f64::INFINITY,
    }
}

/// Lines of the patch.
#[derive(Clone, Debug)]
pub enum PatchLines {
    /// Lines of one layout under any load; those beside the middle may stand for symmetric pairs.
    Constant {
        /// The lines.
        lines: Vec<LineLayout>,
        /// True if lines beside the middle stand for a pair.
        symmetric: bool,
    },
    /// Lines of a patch whose size follows from its load.
    Sized(PatchLayout),
}

impl PatchLines {
    /// Those of a configuration. On surfaces that are not `smooth`, whose patch is as long as their profile makes it, lines
    /// keep the layout of the nominal load: what the contact stores is then a function of its state.
    pub fn new(config: &Config, smooth: bool) -> Self {
        let steel = Isotropic::from(&config.material);
        match config.contact.shape {
            ContactShape::Line => Self::constant(&[1.0], LineKernel::of_half_plane(steel.half_plane(), 1.0)),
            ContactShape::Ellipse => {
                let material = PatchMaterial {
                    half_plane: steel.half_plane(),
                    shear_modulus: steel.shear_modulus(),
                    poissons_ratio: config.material.poissons_ratio,
                };
                let size = (config.contact.lines, config.width(), config.model.nominal_load);
                let patch = PatchLayout::ellipse((&config.hertz(), config.wheel.radius), material, size);
                match smooth {
                    true => Self::Sized(patch),
                    false => {
                        Self::Constant { lines: patch.lay_out(config.model.nominal_load).collect(), symmetric: true }
                    }
                }
            }
        }
    }

    /// Lines with given shares of the width and one flexibility.
    pub fn constant(shares: &[f64], kernel: LineKernel) -> Self {
        let layout = |share: &f64| LineLayout { share: *share, kernel, ..LineLayout::default() };
        Self::Constant { lines: shares.iter().map(layout).collect(), symmetric: false }
    }

    /// Number of lines.
    pub fn count(&self) -> usize {
        match self {
            Self::Constant { lines, .. } => lines.len(),
            Self::Sized(patch) => patch.len(),
        }
    }

    /// True if lines beside the middle stand for a symmetric pair.
    pub fn is_symmetric(&self) -> bool {
        match self {
            Self::Constant { symmetric, .. } => *symmetric,
            Self::Sized(_) => true,
        }
    }

    /// Load of which lines are laid out while they carry `load` \[N]; zero where that does not matter.
    pub fn load_of(&self, load: f64) -> f64 {
        match self {
            Self::Constant { .. } => 0.0,
            Self::Sized(patch) => patch.load_of(load),
        }
    }

    /// Load for which lines are laid out \[N]; zero where that does not matter.
    pub fn load_laid_out(&self, lines: &[Line]) -> f64 {
        match (self, lines) {
            (Self::Constant { .. }, _) | (_, []) => 0.0,
            (Self::Sized(patch), [first, ..]) => patch.load_of_share(first.layout.share),
        }
    }

    /// Gives lines the layout of a load \[N].
    pub fn lay_out(&self, load: f64, lines: &mut [Line]) {
        match self {
            Self::Constant { lines: layouts, .. } => {
                lines.iter_mut().zip(layouts).for_each(|(line, layout)| line.layout = *layout);
            }
            Self::Sized(patch) => {
                lines.iter_mut().zip(patch.lay_out(load)).for_each(|(line, layout)| line.layout = layout);
            }
        }
    }

    /// True if the lines of a state are as many, and have finite layouts.
    pub fn fits(&self, lines: &[Line]) -> bool {
        let sound = |line: &Line| {
            let LineLayout { ordinate, share, gap, kernel, energy } = line.layout;
            share > 0.0 && kernel.is_sound() && [ordinate, share, gap, energy].iter().all(|value| value.is_finite())
        };
        match self {
            Self::Constant { lines: layouts, .. } => lines.iter().map(|line| line.layout).eq(layouts.iter().copied()),
            Self::Sized(_) => lines.len() == self.count() && lines.iter().all(sound),
        }
    }
}
