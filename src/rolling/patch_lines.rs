//! Lines of the patch in which wheel and rail touch.

use super::line::Line;
use crate::config::{Config, OnWheel, PatchRows, RowsError};
use crate::contact::{
    HalfSpace, LineKernel, LineLayout, Logarithm, NodeSize, PatchFlexibility, PatchLayout, PatchMaterial,
};
use crate::material::Isotropic;
use crate::piecewise;
use crate::surface;
use std::borrow::Cow;
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
    /// Nodes of lines whose layout does not depend on the load.
    nodes: LineNodes,
    /// Number of lines.
    pub count: usize,
    /// True if lines beside the middle stand for a symmetric pair.
    pub symmetric: bool,
    /// Lateral position of the centre of load, about which the patch grows and shrinks, of a patch that stays \[m].
    centre: f64,
    /// Place of the centre of load on the wheel, of a patch that stays.
    on_wheel: OnWheel,
    /// Free widths between every line and the one before it under the nominal load, of a patch that stays \[m]; none where all touch.
    gaps: Vec<f64>,
    /// Shifts of the wheelset for which there are patches, ascending \[m], and these; empty: the patch stays.
    shifts: Vec<f64>,
    shifted: Vec<Shifted>,
}

/// Patch under a shift of the wheelset.
#[derive(Clone, Debug)]
struct Shifted {
    patch: PatchLayout,
    on_wheel: OnWheel,
}

/// Layouts of lines and the load.
#[derive(Clone, Debug)]
enum Layouts {
    /// One under any load, with the flexibility of lines under each other's tangential forces; `None`: they are alone but
    /// for the bodies.
    Constant(Vec<LineLayout>, Option<Arc<PatchFlexibility>>),
    /// Those of a patch whose size follows from its load.
    Sized(Box<PatchLayout>),
}

/// Size of the nodes of lines whose layout does not depend on the load.
#[derive(Clone, Copy, Debug)]
enum LineNodes {
    /// Always the same one.
    Fixed,
    /// In proportion to the length of a plane patch, with the root of its load.
    Following {
        /// Load under which they have the size of the grid \[N].
        load: f64,
    },
}

impl LineNodes {
    fn size(self, load: f64) -> Option<NodeSize> {
        let Self::Following { load: nominal } = self else { return None };
        let under_load = if load > 0.0 { (load / nominal).sqrt().max(LEAST_SIZE) } else { 1.0 };
        Some(NodeSize { under_load, nominal: 1.0 })
    }
}

/// Smallest size of nodes over those under the nominal load \[1].
const LEAST_SIZE: f64 = 0.1;

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
    /// keep the layout of the nominal load: what the contact stores is then a function of its state. The outermost node
    /// lies at the distance `end` \[m] from the middle.
    ///
    /// # Errors
    /// Rows without meaning, and a file of rows that has not been read.
    pub fn new(config: &Config, smooth: bool, end: f64) -> Result<Self, RowsError> {
        let steel = Isotropic::from(&config.material);
        let half_space =
            HalfSpace { shear_modulus: steel.shear_modulus(), poissons_ratio: config.material.poissons_ratio };
        let (half_plane, width, load) = (steel.half_plane(), config.width(), config.model.nominal_load);
        if config.contact.shape.is_line() {
            let patch = Self::constant(&[1.0], LineKernel::of_half_plane(half_plane, 1.0));
            let following = LineNodes::Following { load };
            return Ok(Self { nodes: if smooth { following } else { LineNodes::Fixed }, ..patch });
        }
        let material = PatchMaterial { half_plane, half_space };
        let suited = |patch: PatchLayout| {
            let patch = patch.scaling(config.nominal_patch().half_length, LEAST_SIZE);
            let patch = if smooth { patch } else { patch.with_room() };
            if config.contact.lateral { patch.sideways() } else { patch }.reaching(end)
        };
        let (lines, radius) = (config.contact.lines, config.wheel.radius);
        let of_rows = |PatchRows { rows, shapes, .. }: &PatchRows| {
            suited(PatchLayout::rows(rows.clone(), shapes, material, lines, radius, width))
        };
        let Some(table) = config.patch_table()? else {
            let ellipse = PatchLayout::ellipse(&config.hertz(), radius, material, lines, width, load);
            return Ok(Self::of(config, suited(ellipse), smooth, OnWheel::default()));
        };
        if table.shifts.len() > 1 && !smooth {
            return Err(RowsError::Uneven);
        }
        let middle = table.middle();
        let first = of_rows(middle);
        let lines = Self::of(config, first.clone(), smooth, middle.on_wheel);
        if table.shifts.len() == 1 {
            return Ok(lines);
        }
        let beside = |rows: &PatchRows| Shifted { patch: of_rows(rows).moved_from(&first), on_wheel: rows.on_wheel };
        Ok(Self { shifted: table.patches.iter().map(beside).collect(), shifts: table.shifts, ..lines })
    }

    /// Lines of a `patch`; on surfaces that are not `smooth` they stay.
    fn of(config: &Config, patch: PatchLayout, smooth: bool, on_wheel: OnWheel) -> Self {
        let (count, symmetric, centre, gaps) =
            (patch.len(), patch.is_symmetric(), patch.centre(), patch.gaps().to_vec());
        let layouts = match smooth {
            true => Layouts::Sized(Box::new(patch)),
            false => {
                let flexibility = Some(patch.flexibility().clone());
                Layouts::Constant(patch.staying(config.model.nominal_load, longest_patch(config)), flexibility)
            }
        };
        Self {
            layouts,
            nodes: LineNodes::Fixed,
            count,
            symmetric,
            centre,
            on_wheel,
            gaps,
            shifts: Vec::new(),
            shifted: Vec::new(),
        }
    }

    /// Places of the centre of load over the shift of the wheelset \[m]: the shift, its lateral position \[m] and its place on the
    /// wheel; one alone holds for all shifts.
    pub fn places(&self) -> Vec<(f64, f64, OnWheel)> {
        let of = |(&shift, shifted): (&f64, &Shifted)| (shift, shifted.patch.centre(), shifted.on_wheel);
        match self.shifted.is_empty() {
            true => vec![(0.0, self.centre, self.on_wheel)],
            false => self.shifts.iter().zip(&self.shifted).map(of).collect(),
        }
    }

    /// Lines under a shift of the wheelset \[m].
    pub fn at(&self, shift: f64) -> Cow<'_, Self> {
        if self.shifted.is_empty() {
            return Cow::Borrowed(self);
        }
        let weights = piecewise::cubic(&self.shifts, shift);
        let parts: Vec<_> = weights.into_iter().map(|(k, weight)| (&self.shifted[k].patch, weight)).collect();
        Cow::Owned(Self {
            layouts: Layouts::Sized(Box::new(PatchLayout::blend(&parts))),
            nodes: self.nodes,
            count: self.count,
            symmetric: self.symmetric,
            centre: self.centre(shift),
            on_wheel: self.on_wheel,
            gaps: self.gaps(shift),
            shifts: Vec::new(),
            shifted: Vec::new(),
        })
    }

    /// Lateral position of the centre of load under a shift of the wheelset \[m].
    pub fn centre(&self, shift: f64) -> f64 {
        match self.shifted.is_empty() {
            true => self.centre,
            false => self.sum(shift, |patch| patch.centre()),
        }
    }

    /// Free widths between every line and the one before it under the nominal load and a shift of the wheelset \[m]; none where all
    /// touch.
    pub fn gaps(&self, shift: f64) -> Vec<f64> {
        match self.shifted.is_empty() {
            true => self.gaps.clone(),
            false => (0..self.count).map(|k| self.sum(shift, |patch| patch.gaps()[k]).max(0.0)).collect(),
        }
    }

    /// Value of the patch under a shift of the wheelset \[m], given that of every patch of the table.
    fn sum(&self, shift: f64, of: impl Fn(&PatchLayout) -> f64) -> f64 {
        piecewise::cubic(&self.shifts, shift).iter().map(|(k, weight)| weight * of(&self.shifted[*k].patch)).sum()
    }

    /// Lines with given shares of the width and one flexibility.
    pub fn constant(shares: &[f64], kernel: LineKernel) -> Self {
        let layout = |share: &f64| LineLayout { share: *share, kernel, ..LineLayout::default() };
        let layouts = Layouts::Constant(shares.iter().map(layout).collect(), None);
        let nodes = LineNodes::Fixed;
        Self {
            layouts,
            nodes,
            count: shares.len(),
            symmetric: false,
            centre: 0.0,
            on_wheel: OnWheel::default(),
            gaps: Vec::new(),
            shifts: Vec::new(),
            shifted: Vec::new(),
        }
    }

    /// Lines with given shares of the width and one flexibility in the place of these; their nodes go with the load as these do.
    pub fn in_shares(&self, shares: &[f64], kernel: LineKernel) -> Self {
        Self { nodes: self.nodes, ..Self::constant(shares, kernel) }
    }

    /// Ratio of the length of a patch under a load to that under another one.
    pub fn stretch(&self, ratio: f64) -> f64 {
        match (&self.layouts, self.nodes) {
            (Layouts::Sized(_), _) => libm::cbrt(ratio),
            (Layouts::Constant(..), LineNodes::Following { .. }) => ratio.sqrt(),
            (Layouts::Constant(..), LineNodes::Fixed) => 1.0,
        }
    }

    /// Flexibility of the lines under each other's tangential forces, if they feel them.
    pub fn flexibility(&self) -> Option<&PatchFlexibility> {
        match &self.layouts {
            Layouts::Constant(_, flexibility) => flexibility.as_deref(),
            Layouts::Sized(patch) => Some(patch.flexibility()),
        }
    }

    /// Load of which lines are laid out while they carry `load` \[N]; zero where that does not matter.
    pub fn load_of(&self, load: f64) -> f64 {
        match (&self.layouts, self.nodes) {
            (Layouts::Constant(..), LineNodes::Fixed) => 0.0,
            (Layouts::Constant(..), LineNodes::Following { .. }) => load,
            (Layouts::Sized(patch), _) => patch.load_of(load),
        }
    }

    /// True if the flexibility of lines depends on the load.
    pub fn is_sized(&self) -> bool {
        matches!(self.layouts, Layouts::Sized(_))
    }

    /// Load \[N] under which the bodies approach each other by `approach` \[m]; zero where that does not matter.
    pub fn load_under(&self, approach: f64) -> f64 {
        match &self.layouts {
            Layouts::Constant(..) => 0.0,
            Layouts::Sized(patch) => patch.load_under(approach),
        }
    }

    /// Load for which lines are laid out \[N]; zero where that does not matter.
    pub fn load_laid_out(&self, lines: &[Line]) -> f64 {
        match (&self.layouts, lines) {
            (Layouts::Constant(..), _) | (_, []) => 0.0,
            (Layouts::Sized(patch), [first, ..]) => first.layout.size.map_or(0.0, |size| patch.load_of_size(size)),
        }
    }

    /// Gives lines the layout of a load \[N].
    pub fn lay_out(&self, load: f64, lines: &mut [Line]) {
        match &self.layouts {
            Layouts::Constant(layouts, _) => {
                let laid_out = |layout: &LineLayout| LineLayout { size: self.nodes.size(load), ..*layout };
                lines.iter_mut().zip(layouts).for_each(|(line, layout)| line.layout = laid_out(layout));
            }
            Layouts::Sized(patch) => {
                lines.iter_mut().zip(patch.moving(load)).for_each(|(line, layout)| line.layout = layout);
            }
        }
    }

    /// True if the lines of a state are as many, and have finite layouts.
    pub fn fits(&self, lines: &[Line]) -> bool {
        let sound = |line: &Line| {
            let LineLayout { ordinate, position, share, half_length, gap, size, kernel, energy } = line.layout;
            let nodes = size.map_or([1.0; 2], |size| [size.under_load, size.nominal]);
            let mut sizes = [share, half_length].into_iter().chain(nodes);
            let sizes = sizes.all(|size| size > 0.0 && size.is_finite());
            sizes && kernel.is_sound() && [ordinate, position, gap, energy].iter().all(|value| value.is_finite())
        };
        match &self.layouts {
            Layouts::Constant(layouts, _) => {
                let same =
                    |(line, layout): (&Line, &LineLayout)| LineLayout { size: layout.size, ..line.layout } == *layout;
                lines.len() == layouts.len() && lines.iter().zip(layouts).all(same)
            }
            Layouts::Sized(_) => lines.len() == self.count && lines.iter().all(sound),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{ContactShape, presets};
    use crate::contact::line::kernel::logarithms;
    use nalgebra::{Cholesky, DMatrix};

    /// Place of the outermost node \[m].
    const END: f64 = 0.04;

    /// The ellipse of a railway wheel, or rows from a file.
    fn patch(rows: Option<&str>) -> Config {
        let mut config = presets::parse(include_str!("../../resources/railway_ellipse.json")).unwrap();
        if let Some(rows) = rows {
            (config.contact.shape, config.contact.rows) = (ContactShape::Rows, rows.to_owned());
        }
        config
    }

    /// True if the flexibility of all lines along, and across if they are sideways, is positive under a `load` \[N] with
    /// contact all over a `chord` \[m].
    fn is_positive(patch: &PatchLines, load: f64, chord: f64) -> bool {
        let spacing = if chord > END { 1e-3 } else { 0.7e-3 };
        let places: Vec<_> = (0..=(chord / spacing) as usize).map(|i| i as f64 * spacing - 0.5 * chord).collect();
        let mut lines = vec![Line::default(); patch.count];
        patch.lay_out(load, &mut lines);
        let (alone, flexibility) = (logarithms(&places, spacing), patch.flexibility().unwrap());
        let in_patch: Vec<_> = lines.iter().enumerate().map(|(k, line)| line.layout.in_patch(flexibility, k)).collect();
        let powers: Vec<_> = in_patch.iter().flat_map(|line| line.powers(&places)).collect();
        let (nodes, directions) = (powers.len(), if flexibility.is_sideways() { 2 } else { 1 });
        let entry = |a: usize, b: usize| {
            let ([to, of], [a, b]) = ([a / nodes, b / nodes], [a % nodes, b % nodes]);
            let ([at, by], [i, j]) = ([a / places.len(), b / places.len()], [a % places.len(), b % places.len()]);
            let kernel = lines[at].layout.kernel.along(2 * to);
            let own = if (at, to) == (by, of) { 2.0 * kernel.displacement(alone[(i, j)]) } else { 0.0 };
            let mut between = *in_patch[at].between(by, [to, of]).unwrap();
            if (at, to) == (by, of) {
                between.displacement[0][0] += in_patch[at].by_reach(to);
            }
            let product =
                |polynomial: &[f64; 5]| polynomial.iter().zip(&powers[a]).map(|(c, power)| c * power).sum::<f64>();
            let by_moments = between.displacement.iter().zip(&powers[b]).map(|(by, moment)| moment * product(by));
            lines[at].layout.share * (own + by_moments.sum::<f64>())
        };
        let matrix = DMatrix::from_fn(directions * nodes, directions * nodes, entry);
        assert!((&matrix - matrix.transpose()).amax() < 1e-9 * matrix.amax(), "Betti");
        Cholesky::new(matrix).is_some()
    }

    #[test]
    fn lines_give_way_to_every_tangential_force_on_every_chord_that_nodes_have_room_for() {
        let rows = [
            None,
            Some(include_str!("../../resources/s1002_uic60_0mm.csv")),
            Some(include_str!("../../resources/s1002_uic60_3mm.csv")),
        ];
        for (shape, rows) in ["ellipse", "0 mm", "3 mm"].into_iter().zip(rows) {
            for (count, lateral) in [(3, false), (7, false), (13, false), (5, true)] {
                let mut config = patch(rows);
                (config.contact.lines, config.contact.lateral) = (count, lateral);
                let chords = if count == 7 { vec![0.02, 0.04, 0.078] } else { vec![0.04] };
                let loads = [(true, 1.0), (true, 0.1), (false, 1.0)];
                for ((smooth, share), chord) in
                    loads.into_iter().flat_map(|load| chords.iter().map(move |chord| (load, *chord)))
                {
                    let patch = PatchLines::new(&config, smooth, END).unwrap();
                    let positive = is_positive(&patch, share * config.model.nominal_load, chord);
                    println!("{shape}, {count} lines, smooth {smooth}, {share} of the load, {chord} m: {positive}");
                    assert!(positive);
                }
            }
        }
    }
}
