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
pub struct PatchLines {
    /// How they are laid out.
    layouts: Layouts,
    /// Number of lines.
    pub count: usize,
    /// True if lines beside the middle stand for a symmetric pair.
    pub symmetric: bool,
    /// Lateral position of the centre of load, about which the patch grows and shrinks \[m].
    pub centre: f64,
    /// Free widths between every line and the one before it under the nominal load \[m]; none where all touch.
    pub gaps: Vec<f64>,
}

/// Layouts of lines and the load.
#[derive(Clone, Debug)]
enum Layouts {
    /// One under any load, with the flexibility of lines under each other's tangential forces; `None`: they are alone but
    /// for the bodies.
    Constant(Vec<LineLayout>, Option<Arc<PatchFlexibility>>),
    /// Those of a patch whose size follows from its load.
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
        let roomy = || lateral(patch.clone().with_room());
        let patch = if smooth { lateral(patch.clone()) } else { roomy() };
        let (count, symmetric, centre, gaps) =
            (patch.len(), patch.is_symmetric(), patch.centre(), patch.gaps().to_vec());
        let layouts = match smooth {
            true => Layouts::Sized {
                roomy: (config.contact.lateral && config.physics.yielding).then(|| Box::new(roomy())),
                patch: Box::new(patch),
            },
            false => Layouts::Constant(patch.staying(load, longest_patch(config)), Some(patch.flexibility().clone())),
        };
        Ok(Self { layouts, count, symmetric, centre, gaps })
    }

    /// Lines with given shares of the width and one flexibility.
    pub fn constant(shares: &[f64], kernel: LineKernel) -> Self {
        let layout = |share: &f64| LineLayout { share: *share, kernel, ..LineLayout::default() };
        let layouts = Layouts::Constant(shares.iter().map(layout).collect(), None);
        Self { layouts, count: shares.len(), symmetric: false, centre: 0.0, gaps: Vec::new() }
    }

    /// Flexibility of the lines on given ports under each other's tangential forces, if they feel them.
    pub fn flexibility(&self, ports: Ports) -> Option<&PatchFlexibility> {
        match &self.layouts {
            Layouts::Constant(_, flexibility) => flexibility.as_deref(),
            Layouts::Sized { .. } => self.sized(ports).map(|patch| &**patch.flexibility()),
        }
    }

    /// Patch on given ports whose size follows from its load.
    fn sized(&self, ports: Ports) -> Option<&PatchLayout> {
        let Layouts::Sized { patch, roomy } = &self.layouts else { return None };
        match ports {
            Ports::Smooth => Some(patch),
            Ports::Narrow | Ports::Wide => Some(roomy.as_ref().unwrap_or(patch)),
        }
    }

    /// Load of which lines are laid out while they carry `load` \[N]; zero where that does not matter.
    pub fn load_of(&self, load: f64) -> f64 {
        match &self.layouts {
            Layouts::Constant(..) => 0.0,
            Layouts::Sized { patch, .. } => patch.load_of(load),
        }
    }

    /// Load for which lines are laid out \[N]; zero where that does not matter.
    pub fn load_laid_out(&self, lines: &[Line]) -> f64 {
        match (&self.layouts, lines) {
            (Layouts::Constant(..), _) | (_, []) => 0.0,
            (Layouts::Sized { patch, .. }, [first, ..]) => patch.load_of_share(first.layout.share),
        }
    }

    /// Lines on given ports under a load \[N], if that matters.
    pub fn layouts(&self, load: f64, ports: Ports) -> Option<Vec<LineLayout>> {
        self.sized(ports).map(|patch| patch.moving(load).collect())
    }

    /// Gives lines on given ports the layout of a load \[N].
    pub fn lay_out(&self, load: f64, ports: Ports, lines: &mut [Line]) {
        match &self.layouts {
            Layouts::Constant(layouts, _) => {
                lines.iter_mut().zip(layouts).for_each(|(line, layout)| line.layout = *layout);
            }
            Layouts::Sized { .. } => {
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
        match &self.layouts {
            Layouts::Constant(layouts, _) => lines.iter().map(|line| line.layout).eq(layouts.iter().copied()),
            Layouts::Sized { .. } => lines.len() == self.count && lines.iter().all(sound),
        }
    }
}
