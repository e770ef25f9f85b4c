//! Lines side by side that stand for a patch under a load.

mod blend;

use super::flexibility::{HalfSpace, InPatch, PatchFlexibility};
use super::kernel::{LineKernel, Logarithm};
use crate::analytic::HalfPlane;
use crate::patch::gauss::{self, GaussLine};
use crate::patch::rows::{self, EquivalentEllipse, PatchRow};
use crate::patch::{Ellipse, Hertz, Tile, hertz, reach};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// Smallest load for which lines are laid out, over that of the description \[1]. Under a smaller one they keep that
/// layout, with which they are too soft.
const LEAST: f64 = 1e-3;

/// Length of lines that stay over that under their load on which they feel each other's tangential forces \[1].
const ROOM: f64 = 1.5;

/// Least distance at which a line's own tangential displacement ends, over that of the outermost node from the middle \[1]:
/// a logarithm is positive on patches shorter than four times that, by the kernel of nodes 4.48 times.
const REACH: f64 = 0.5;

/// Part of a change of the approach under a load on which a wheel stands that moves sideways \[1].
const STANDING: f64 = 0.6;

/// Size of the nodes of a line over those of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeSize {
    /// Under the load of the layout \[1].
    pub under_load: f64,
    /// Under the load of the description of the patch \[1].
    pub nominal: f64,
}

/// A line as part of a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineLayout {
    /// Lateral position, about the centre of load, over half the width of the patch \[1].
    pub ordinate: f64,
    /// Lateral position about the centre of load \[m].
    pub position: f64,
    /// Width of the line over that of the bodies \[1].
    pub share: f64,
    /// Half-length of which it is laid out \[m].
    pub half_length: f64,
    /// Distance by which its surfaces are farther apart than the hub says \[m].
    pub gap: f64,
    /// Size of its nodes; `None`: that of the grid.
    pub size: Option<NodeSize>,
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
    /// Its half-space.
    pub half_space: HalfSpace,
}

/// A patch of contact lines, or several ones side by side, whose size follows from its load as that of an ellipse does:
/// lengths with its third root.
///
/// Every line is a plane contact of the radius R of the wheel with a flexibility of its own. Of the normal one the
/// factor κ is that with which the half-length belongs to the load of the line, `a² = 4κRP`. Its reach L is that with
/// which a line answers to a small change of the approach δ as it has to, `dP/dδ = 3P/2δ`, and the height of the wheel
/// over it that at which it carries P. So an ellipse has the pressures, the approach and the stiffness of Hertz's, and
/// any other patch its own pressures, and approach and stiffness of the ellipse with its second moments of area.
/// Several patches go down together, each keeps its share of the load, and all are as stiff as they are together.
/// Derivation: `docs/theory/lines.md`.
#[derive(Clone, Debug)]
pub struct PatchLayout {
    /// Lines under the load `load`, at positions about the centre of load; on a symmetric patch, both of a pair stand
    /// for one of twice the width.
    rows: Vec<PatchRow>,
    /// Free widths before them \[m].
    gaps: Vec<f64>,
    symmetric: bool,
    /// Lateral position of the centre of load \[m].
    centre: f64,
    /// Load of the description \[N], and the approach that belongs to it \[m].
    load: f64,
    approach: f64,
    /// Height by which the hub stands higher over the rail than the approach says \[m], see [`Self::moved_from`].
    lifted: f64,
    /// Half of the width under it \[m].
    lateral: f64,
    /// Radius of the wheel \[m].
    radius: f64,
    /// Width of the bodies \[m].
    width: f64,
    /// True if forces have a lateral part.
    sideways: bool,
    /// Tangential flexibility under the forces of all lines, from when it is first asked for: tables over the shift of a wheelset have
    /// patches on which a wheel never rolls.
    flexibility: OnceLock<Arc<PatchFlexibility>>,
    /// Least distance \[m] at which a line's own tangential displacement ends, from which on it is the same for all lines;
    /// `None`: that which the flexibility of all leaves to each.
    least_reach: Option<f64>,
    /// Lengths of the lines on which they do, over those under the load of the description \[1].
    room: f64,
    /// Half-length of lines whose nodes have the size of the grid \[m], and the smallest size over that under the load of the
    /// description \[1].
    unit: f64,
    least: f64,
    half_space: HalfSpace,
    /// Strain of the surface under the pressure of every line [1/Pa].
    couplings: Vec<f64>,
}

impl PatchLayout {
    /// The ellipse of a wheel with the rolling `radius` \[m], on a number of `lines` by the rule of Gauss and Legendre.
    /// The bodies are `width` \[m] wide; `load` \[N] is any positive one.
    pub fn ellipse(hertz: &Hertz, radius: f64, material: PatchMaterial, lines: usize, width: f64, load: f64) -> Self {
        let Ellipse { a, b, peak, .. } = hertz.under(load);
        let row = |line: &GaussLine| {
            let share = (1.0 - line.ordinate.powi(2)).sqrt();
            let half_length = a * share;
            let line_load = 0.5 * PI * half_length * peak * share;
            PatchRow { position: b * line.ordinate, width: b * line.weight, half_length, line_load, gap: 0.0 }
        };
        let rows: Vec<_> = gauss::half(lines).iter().map(row).collect();
        // A single line, which is no rule for this pressure, carries the load on a smaller width.
        let scale = load / rows::load(&rows);
        let rows = rows.into_iter().map(|row| PatchRow { width: scale * row.width, ..row }).collect();
        let layout = Self::of(rows, true, &[EquivalentEllipse { a, b, centre: 0.0 }], material, [radius, width]);
        Self { lateral: b, ..layout }
    }

    /// Patches of rows, of which neighbours that touch and differ least share a line where there are more than `lines`.
    /// `shapes` are the ellipses with the second moments of area of each patch; `radius` and `width` \[m] are those of
    /// wheel and bodies.
    pub fn rows(
        rows: Vec<PatchRow>,
        shapes: &[EquivalentEllipse],
        material: PatchMaterial,
        lines: usize,
        radius: f64,
        width: f64,
    ) -> Self {
        let rows = rows::merged(rows, lines);
        let centre = rows::centre_of_load(&rows);
        let about = |row: PatchRow| PatchRow { position: row.position - centre, ..row };
        let rows = rows.into_iter().map(about).collect();
        let layout = Self::of(rows, false, shapes, material, [radius, width]);
        Self { centre, ..layout }
    }

    /// Lines at positions about the centre of load, in patches as large as the ellipses `shapes`; on a symmetric patch
    /// those beside the middle stand for a pair.
    fn of(
        rows: Vec<PatchRow>,
        symmetric: bool,
        shapes: &[EquivalentEllipse],
        material: PatchMaterial,
        [radius, width]: [f64; 2],
    ) -> Self {
        let (load, modulus) = (rows::load(&rows), 1.0 / (PI * material.half_plane.kernel));
        // Patches side by side are springs in parallel, `dP/dδ = 3P/2δ` each.
        let softness = |(rows, shape): (&[PatchRow], &EquivalentEllipse)| {
            let load = rows::load(rows);
            load / hertz::approach([shape.a, shape.b], load, modulus)
        };
        let patches = || rows::patches(&rows).zip(shapes);
        let coupling = |shape: &EquivalentEllipse| material.half_plane.coupling * shape.b / (shape.a + shape.b);
        let half_space = material.half_space;
        Self {
            gaps: rows.iter().map(|row| row.gap).collect(),
            symmetric,
            centre: 0.0,
            load,
            approach: load / patches().map(softness).sum::<f64>(),
            lifted: 0.0,
            lateral: 0.5 * rows.iter().map(|row| row.width).sum::<f64>(),
            radius,
            width,
            sideways: false,
            flexibility: OnceLock::new(),
            least_reach: None,
            room: 1.0,
            unit: f64::INFINITY,
            least: 0.0,
            half_space,
            couplings: patches().flat_map(|(rows, shape)| std::iter::repeat_n(coupling(shape), rows.len())).collect(),
            rows,
        }
    }

    /// With room on its lines for patches that are longer than under the load of the description, as those on surfaces
    /// with profiles are.
    pub fn with_room(self) -> Self {
        Self { room: ROOM, flexibility: OnceLock::new(), ..self }
    }

    /// On nodes that end at the distance `end` \[m] from the middle: contact may be that long, whatever the layout. Lines
    /// reach so far that none is pushed by its own tangential forces.
    pub fn reaching(self, end: f64) -> Self {
        Self { least_reach: Some(REACH * end), ..self }
    }

    /// With nodes of a grid that suits the half-length `unit` \[m], as much larger or smaller as lines are longer or shorter, but
    /// no smaller than by the factor `least` under the load of the description.
    pub fn scaling(self, unit: f64, least: f64) -> Self {
        Self { unit, least, ..self }
    }

    /// With lateral forces: every line stands for itself.
    pub fn sideways(self) -> Self {
        let (middle, symmetric) = (self.rows.first().is_some_and(|row| row.position == 0.0), self.symmetric);
        let halved = |row: &PatchRow| match symmetric && row.position > 0.0 {
            true => PatchRow { width: 0.5 * row.width, ..*row },
            false => *row,
        };
        let upper: Vec<_> = self.rows.iter().map(halved).collect();
        let mirrored = |row: &PatchRow| PatchRow { position: -row.position, ..*row };
        let lower = upper.iter().skip(usize::from(middle)).rev().filter(|_| symmetric).map(mirrored);
        let rows: Vec<_> = lower.chain(upper.iter().copied()).collect();
        let images = self.couplings.iter().skip(usize::from(middle)).rev().filter(|_| symmetric);
        Self {
            gaps: rows.iter().map(|row| row.gap).collect(),
            couplings: images.chain(&self.couplings).copied().collect(),
            symmetric: false,
            sideways: true,
            flexibility: OnceLock::new(),
            rows,
            ..self
        }
    }

    /// The patch to which a wheel comes from another one by moving sideways. Its elastic energy has become larger by what load and
    /// lateral force have put in (`docs/theory/sideways.md`, section 6).
    pub fn moved_from(self, other: &Self) -> Self {
        Self { lifted: STANDING * (self.approach - other.approach), ..self }
    }

    /// True if lines beside the middle stand for a symmetric pair.
    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// Lateral position of the centre of load, which is the same under all loads \[m].
    pub fn centre(&self) -> f64 {
        self.centre
    }

    /// Flexibility of lines under each other's tangential forces, the same under all loads.
    pub fn flexibility(&self) -> &Arc<PatchFlexibility> {
        self.flexibility.get_or_init(|| {
            let tiles = tiles(&self.rows, self.symmetric, self.room);
            Arc::new(match self.sideways {
                true => PatchFlexibility::sideways(&tiles, self.half_space),
                false => PatchFlexibility::new(&tiles, self.symmetric, self.half_space),
            })
        })
    }

    /// Free widths between every line and the one before it under the load of the description \[m]; zero where they
    /// touch.
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
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

    /// Load \[N] under which the bodies approach each other by `approach` \[m]; zero where they are apart.
    pub fn load_under(&self, approach: f64) -> f64 {
        let ratio = (approach + self.lifted).max(0.0) / self.approach;
        self.load * ratio * ratio.sqrt()
    }

    /// Load for which a line with nodes of a `size` is laid out \[N], wherever the patch was.
    pub fn load_of_size(&self, size: NodeSize) -> f64 {
        self.load * (size.under_load / size.nominal).powi(3)
    }

    /// Lines under a load \[N] that move with the patch: under a small change of the load they keep their places in it.
    pub fn moving(&self, load: f64) -> impl Iterator<Item = LineLayout> {
        let scale = libm::cbrt(self.load_of(load) / self.load);
        let approach = scale * scale * self.approach;
        let lines = rows::scaled(&self.rows, scale).enumerate();
        lines.map(move |(i, row)| {
            let line = self.line(i, &row, scale, 1.5 * row.line_load / approach);
            let nominal = row.half_length / (scale * self.unit);
            let size = NodeSize { under_load: nominal * scale.max(self.least), nominal };
            LineLayout { size: (nominal > 0.0).then_some(size), ..line }
        })
    }

    /// Lines under a load \[N] that stay where they are while the patch changes: all are equally stiff, as under a flat
    /// punch, and the outer ones lift off first. Waves of the surfaces act on them as on the patch. Lines that may
    /// become as long as `longest` \[m], half of that counted, reach so far that none is pushed up by its own forces;
    /// outer ones are then less stiff.
    pub fn staying(&self, load: f64, longest: f64) -> Vec<LineLayout> {
        let scale = libm::cbrt(self.load_of(load) / self.load);
        let rows: Vec<_> = rows::scaled(&self.rows, scale).collect();
        let factor = |row: &PatchRow| row.half_length * row.half_length / (4.0 * self.radius * row.line_load);
        let lines: Vec<_> = rows.iter().map(|row| [0.5 * row.width / factor(row), row.half_length]).collect();
        let stiffness = 1.5 * rows::load(&rows) / (scale * scale * self.approach);
        let lengths = reach::proportional_lengths(stiffness, &lines, 0.5 * longest);
        let line = |(i, (row, length)): (usize, (&PatchRow, f64))| {
            self.line(i, row, scale, 0.5 / (factor(row) * libm::log(2.0 * length / row.half_length)))
        };
        rows.iter().zip(lengths).enumerate().map(line).collect()
    }

    /// A line of a patch that is `scale` times as large as that of the description, with the change `stiffness` of its
    /// load per width with the approach [N/m²].
    fn line(&self, i: usize, row: &PatchRow, scale: f64, stiffness: f64) -> LineLayout {
        let PatchRow { position, width, half_length, line_load, .. } = *row;
        let approach = scale * scale * self.approach;
        let factor = half_length * half_length / (4.0 * self.radius * line_load);
        // `dδ/dP = 2κ ln(2L/a)`, `δ = κP (2 ln(2L/a) + 1)`.
        let [tangential, lateral] = self.own(i, scale);
        let (pressing, logarithm) = (factor * line_load, 0.5 / (factor * stiffness));
        LineLayout {
            ordinate: position / (scale * self.lateral),
            position,
            share: width / self.width,
            half_length: self.room * half_length,
            size: None,
            gap: approach - self.lifted - pressing * (2.0 * logarithm + 1.0),
            kernel: LineKernel {
                tangential,
                normal: Logarithm { factor, reach: libm::log(0.5 * half_length) + logarithm },
                lateral,
                coupling: self.couplings[i],
            },
            energy: line_load * (0.4 * approach - pressing * (logarithm + 0.25)),
        }
    }

    /// Tangential and lateral flexibility that a line has for itself.
    fn own(&self, line: usize, scale: f64) -> [Logarithm; 2] {
        let left = |line: usize| {
            let half_length = scale * self.room * self.rows[line].half_length;
            [0, 1].map(|direction| self.flexibility().own(line, direction, half_length))
        };
        let Some(least) = self.least_reach else { return left(line) };
        let all = (0..self.len()).flat_map(left).filter(|own| own.factor > 0.0);
        let reach = all.map(|own| own.reach).fold(libm::log(least), f64::max);
        left(line).map(|own| Logarithm { reach: if own.factor > 0.0 { reach } else { own.reach }, ..own })
    }
}

impl LineLayout {
    /// The line as that with the number `line` of a patch with this flexibility.
    pub fn in_patch<'a>(&self, flexibility: &'a PatchFlexibility, line: usize) -> InPatch<'a> {
        let LineKernel { tangential, lateral, .. } = self.kernel;
        InPatch { flexibility, line, half_length: self.half_length, reaches: [tangential.reach, lateral.reach] }
    }
}

/// Strips for which rows stand, about the centre of load. Those of a symmetric patch, from the middle on, lie side by
/// side; others keep their gaps, with the mean of their positions.
fn tiles(rows: &[PatchRow], symmetric: bool, room: f64) -> Vec<Tile> {
    let (mut tiles, mut low) = (Vec::with_capacity(rows.len()), 0.0);
    for row in rows {
        let alone = symmetric && row.position == 0.0;
        let width = if symmetric && !alone { 0.5 * row.width } else { row.width };
        low = if alone { -0.5 * width } else { low + row.gap };
        tiles.push(Tile { edges: [low, low + width], half_length: room * row.half_length });
        low += width;
    }
    if !symmetric {
        let moment = |tile: &Tile| 0.5 * (tile.edges[0] + tile.edges[1]) * tile.width();
        let positions = rows.iter().map(|row| row.width * row.position).sum::<f64>();
        let shift = positions - tiles.iter().map(moment).sum::<f64>();
        let shift = shift / rows.iter().map(|row| row.width).sum::<f64>();
        tiles.iter_mut().for_each(|tile| tile.edges = tile.edges.map(|edge| edge + shift));
    }
    tiles
}
