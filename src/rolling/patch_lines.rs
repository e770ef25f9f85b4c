//! Lines of the patch in which wheel and rail touch.

use super::line::Line;
use crate::config::{Config, ContactShape, PatchRows, RowsError};
use crate::contact::{
    HalfSpace, LineKernel, LineLayout, Logarithm, PatchFlexibility, PatchLayout, PatchMaterial, Ports,
};
use crate::material::Isotropic;
use crate::surface;
use std::sync::Arc;

/// Distances at which forces displace plane bodies as they displace those of wheel and rail \[m]: tangential, normal on
/// a rigid base, and normal on a track that yields (`docs/theory/structural-width.md`).
const REACHES: [f64; 3] = [0.025, 1.2e-3, 7.4e-3];

/// Flexibility of plane bodies of the structural width in whose place lines have one of their own.
pub fn apart(config: &Config) -> LineKernel {
    let half_plane = Isotropic::from(&config.material).half_plane();
    let [tangential, rigid, yielding] = REACHES;
    let normal = if config.rail.support_stiffness > 0.0 { yielding } else { rigid };
    let along = |reach: f64| Logarithm { factor: half_plane.kernel, reach: libm::log(reach) };
    LineKernel {
        tangential: along(tangential),
        normal: along(normal),
        lateral: Logarithm::default(),
        coupling: half_plane.coupling,
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
        /// Lateral position of the centre of load \[m].
        centre: f64,
        /// Free widths before the lines \[m].
        gaps: Vec<f64>,
        /// Flexibility under each other's tangential forces; `None`: they are alone but for the bodies.
        flexibility: Option<Arc<PatchFlexibility>>,
    },
    /// Lines of a patch whose size follows from its load.
    Sized {
        /// The patch.
        patch: Box<PatchLayout>,
        /// Patch on fixed nodes, where soft steel makes it longer than that of the layout; `None`: it does not.
        roomy: Option<Box<PatchLayout>>,
    },
}

/// Half-length that patches of soft steel reach, over that under the nominal load \[1].
const SOFT: f64 = 3.5;

/// Half of the length of the longest patch that is to be expected on surfaces with profiles \[m]: on the longest flat of
/// the wheel, or on soft steel.
fn longest_patch(config: &Config) -> f64 {
    let half_length = config.nominal_patch().half_length;
    (0.5 * surface::longest_flat(&config.wheel.profile) + half_length).max(SOFT * half_length)
}

impl PatchLines {
    /// Those of a configuration. On surfaces that are not `smooth`, whose patch is as long as their profile makes it, lines
    /// keep the layout of the nominal load: what the contact stores is then a function of its state.
    ///
    /// # Errors
    /// Rows without meaning, and a file of rows that has not been read.
    pub fn new(config: &Config, smooth: bool) -> Result<Self, RowsError> {
        let steel = Isotropic::from(&config.material);
        let half_space =
            HalfSpace { shear_modulus: steel.shear_modulus(), poissons_ratio: config.material.poissons_ratio };
        let material = PatchMaterial { half_plane: steel.half_plane(), half_space };
        let (lines, radius, width, load) =
            (config.contact.lines, config.wheel.radius, config.width(), config.model.nominal_load);
        let patch = match (config.contact.shape, config.patch_rows()?) {
            (ContactShape::Line, _) => {
                return Ok(Self::constant(&[1.0], LineKernel::of_half_plane(steel.half_plane(), 1.0)));
            }
            (_, Some(PatchRows { rows, shapes })) => PatchLayout::rows(rows, &shapes, material, lines, radius, width),
            (_, None) => PatchLayout::ellipse(&config.hertz(), radius, material, lines, width, load),
        };
        let lateral = |patch: PatchLayout| if config.contact.lateral { patch.sideways() } else { patch };
        if smooth {
            let roomy = config.contact.lateral && config.physics.yielding;
            let roomy = roomy.then(|| Box::new(lateral(patch.clone().with_room())));
            return Ok(Self::Sized { patch: Box::new(lateral(patch)), roomy });
        }
        let patch = lateral(patch.with_room());
        Ok(Self::Constant {
            lines: patch.staying(load, longest_patch(config)),
            symmetric: patch.is_symmetric(),
            centre: patch.centre(),
            gaps: patch.gaps().to_vec(),
            flexibility: Some(patch.flexibility().clone()),
        })
    }

    /// Lines with given shares of the width and one flexibility.
    pub fn constant(shares: &[f64], kernel: LineKernel) -> Self {
        let layout = |share: &f64| LineLayout { share: *share, kernel, ..LineLayout::default() };
        Self::Constant {
            lines: shares.iter().map(layout).collect(),
            symmetric: false,
            centre: 0.0,
            gaps: Vec::new(),
            flexibility: None,
        }
    }

    /// Number of lines.
    pub fn count(&self) -> usize {
        match self {
            Self::Constant { lines, .. } => lines.len(),
            Self::Sized { patch, .. } => patch.len(),
        }
    }

    /// True if lines beside the middle stand for a symmetric pair.
    pub fn is_symmetric(&self) -> bool {
        match self {
            Self::Constant { symmetric, .. } => *symmetric,
            Self::Sized { patch, .. } => patch.is_symmetric(),
        }
    }

    /// Lateral position of the centre of load, about which the patch grows and shrinks \[m].
    pub fn centre(&self) -> f64 {
        match self {
            Self::Constant { centre, .. } => *centre,
            Self::Sized { patch, .. } => patch.centre(),
        }
    }

    /// Free widths between every line and the one before it under the nominal load \[m]; none where all touch.
    pub fn gaps(&self) -> &[f64] {
        match self {
            Self::Constant { gaps, .. } => gaps,
            Self::Sized { patch, .. } => patch.gaps(),
        }
    }

    /// Flexibility of the lines on given ports under each other's tangential forces, if they feel them.
    pub fn flexibility(&self, ports: Ports) -> Option<&PatchFlexibility> {
        match self {
            Self::Constant { flexibility, .. } => flexibility.as_deref(),
            Self::Sized { .. } => self.sized(ports).map(|patch| &**patch.flexibility()),
        }
    }

    /// Patch on given ports whose size follows from its load.
    fn sized(&self, ports: Ports) -> Option<&PatchLayout> {
        let Self::Sized { patch, roomy } = self else { return None };
        match ports {
            Ports::Smooth => Some(patch),
            Ports::Narrow | Ports::Wide => Some(roomy.as_ref().unwrap_or(patch)),
        }
    }

    /// Load of which lines are laid out while they carry `load` \[N]; zero where that does not matter.
    pub fn load_of(&self, load: f64) -> f64 {
        match self {
            Self::Constant { .. } => 0.0,
            Self::Sized { patch, .. } => patch.load_of(load),
        }
    }

    /// Load for which lines are laid out \[N]; zero where that does not matter.
    pub fn load_laid_out(&self, lines: &[Line]) -> f64 {
        match (self, lines) {
            (Self::Constant { .. }, _) | (_, []) => 0.0,
            (Self::Sized { patch, .. }, [first, ..]) => patch.load_of_share(first.layout.share),
        }
    }

    /// Lines on given ports under a load \[N], if that matters.
    pub fn layouts(&self, load: f64, ports: Ports) -> Option<Vec<LineLayout>> {
        self.sized(ports).map(|patch| patch.moving(load).collect())
    }

    /// Gives lines on given ports the layout of a load \[N].
    pub fn lay_out(&self, load: f64, ports: Ports, lines: &mut [Line]) {
        match self {
            Self::Constant { lines: layouts, .. } => {
                lines.iter_mut().zip(layouts).for_each(|(line, layout)| line.layout = *layout);
            }
            Self::Sized { .. } => {
                let layouts = self.layouts(load, ports).unwrap_or_default();
                lines.iter_mut().zip(layouts).for_each(|(line, layout)| line.layout = layout);
            }
        }
    }

    /// True if the lines of a state are as many, and have finite layouts.
    pub fn fits(&self, lines: &[Line]) -> bool {
        let sound = |line: &Line| {
            let LineLayout { ordinate, position, share, half_length, gap, kernel, energy } = line.layout;
            let sizes = [share, half_length].iter().all(|size| *size > 0.0 && size.is_finite());
            sizes && kernel.is_sound() && [ordinate, position, gap, energy].iter().all(|value| value.is_finite())
        };
        match self {
            Self::Constant { lines: layouts, .. } => lines.iter().map(|line| line.layout).eq(layouts.iter().copied()),
            Self::Sized { .. } => lines.len() == self.count() && lines.iter().all(sound),
        }
    }
}
