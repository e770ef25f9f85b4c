//! Rows of a patch that is no ellipse, as the text of `contact.rows`.

use crate::files::Unread;
use crate::files::table::{Table, TableError, TableRow};
use crate::patch::rows::{self, EquivalentEllipse, PatchRow};

/// End of a text that names a file.
const FILE: &str = ".csv";
/// Columns that are needed, in metres and as shares.
const COLUMNS: [&str; 3] = ["position", "half_length", "load_share"];
/// Column that may be left out where rows lie at one distance, in metres.
const WIDTH: &str = "width";
/// Columns that say where the rows lie on the wheel, and their units, which a wheel that knows its wheelset needs.
const ON_WHEEL: [(&str, &str); 3] = [("angle", "rad"), ("radius", "m"), ("lateral", "m")];
/// Column by which tables over the shift of a wheelset tell their blocks apart, in metres.
const SHIFT: &str = "shift";
/// Largest angle \[rad].
const STEEPEST: f64 = 1.5;
/// Largest distance from the middle, half-length and width [m].
const LARGEST: [f64; 3] = [0.5, 0.1, 0.2];
/// Largest shift, that of the input \[m].
const FARTHEST_SHIFT: f64 = 0.1;
/// Largest number of rows.
const MOST_ROWS: usize = 1000;
/// Distances of rows without widths, over the smallest one: up to the first one rows touch, from the second one a gap
/// lies between them [1].
const TOUCHING: f64 = 1.6;
const APART: f64 = 1.8;
/// Distance of the sides of rows with widths up to which they touch, over the width of the narrower one [1].
const SLACK: f64 = 0.01;

/// Rows without meaning.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RowsError {
    /// Too few or too many of them.
    #[error(
        "contact.rows has {0} rows, but contact.shape = rows needs 2 to {MOST_ROWS}: the name of a {FILE} file or a text with the \
         columns position,half_length,load_share, rows separated by ; or new lines"
    )]
    Count(usize),
    /// A text that is no table.
    #[error("contact.rows, {0}")]
    Text(#[from] TableError),
    /// A file that nobody has read yet.
    #[error("contact.rows: file {0} has not been read; give its content")]
    Unread(String),
    /// Blocks of a table over the shift that do not belong together.
    #[error(
        "contact.rows: the block of shift = {shift} m has {rows} rows, the first one {first}: every shift has as many rows, as \
         `wheelrail patch` makes them"
    )]
    Blocks {
        /// Shift of the block, as text \[m].
        shift: String,
        /// Number of its rows.
        rows: usize,
        /// Number of rows of the first block.
        first: usize,
    },
    /// A table over the shift on surfaces with profiles.
    #[error(
        "contact.rows has rows for several shifts, but the surfaces are not smooth: leave the rows of one shift, or wheel.profile and \
         rail.profile empty"
    )]
    Uneven,
    /// A table over the shift without a wheelset that shifts.
    #[error(
        "contact.rows has rows for several shifts, but the wheel belongs to no wheelset: set wheelset.side = left or right, or leave \
         the rows of one shift, as `wheelrail patch --shift` makes them"
    )]
    NoWheelset,
    /// A file that cannot be read.
    #[error("contact.rows: {0}")]
    Unreadable(#[from] Unread),
}

/// Place of the centre of load of a patch on the wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OnWheel {
    /// Angle between the plane of contact and the axle, positive where the plane rises to the right \[rad].
    pub angle: f64,
    /// Radius of rolling \[m]; `None`: that of the wheel.
    pub radius: Option<f64>,
    /// Distance to the right of the circle to which `wheelset.half_spacing` leads \[m]; `None`: that of the centre of load.
    pub lateral: Option<f64>,
}

/// Patches that are described by rows side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchRows {
    /// Place of the centre of load on the wheel.
    pub on_wheel: OnWheel,
    /// The rows, at ascending positions.
    pub rows: Vec<PatchRow>,
    /// Ellipse with the second moments of area of each patch, of which there are as many as gaps between rows and one.
    pub shapes: Vec<EquivalentEllipse>,
}

/// A row as a table has it.
struct GivenRow {
    /// Line of the text, from 1.
    line: usize,
    position: f64,
    half_length: f64,
    load_share: f64,
    width: Option<f64>,
    /// Values of [`ON_WHEEL`] and [`SHIFT`].
    on_wheel: [Option<f64>; 3],
    shift: Option<f64>,
}

/// Columns that a table may have.
struct Others {
    width: Option<usize>,
    on_wheel: [Option<usize>; 3],
    shift: Option<usize>,
}

/// True if a text names a file.
pub fn is_file(text: &str) -> bool {
    text.trim().ends_with(FILE)
}

impl PatchRows {
    fn new(given: &[GivenRow], load: f64) -> Result<Self, RowsError> {
        let widths: Option<Vec<f64>> = given.iter().map(|row| row.width).collect();
        let sides = widths.map_or_else(|| sides_by_distance(given), |widths| sides_by_width(given, &widths))?;
        let sum: f64 = given.iter().map(|row| row.load_share).sum();
        let row = |(row, [width, gap]): (&GivenRow, [f64; 2])| PatchRow {
            position: row.position,
            width,
            half_length: row.half_length,
            line_load: load * row.load_share / (sum * width),
            gap,
        };
        let rows: Vec<_> = given.iter().zip(sides).map(row).collect();
        let shapes: Option<Vec<_>> = rows::patches(&rows).map(rows::equivalent_ellipse).collect();
        let under_load = |k: usize| {
            let of_row = |row: &GivenRow| row.on_wheel[k].map(|value| value * row.load_share / sum);
            given.iter().map(of_row).sum::<Option<f64>>()
        };
        let on_wheel = OnWheel { angle: under_load(0).unwrap_or(0.0), radius: under_load(1), lateral: under_load(2) };
        shapes.map(|shapes| Self { on_wheel, rows, shapes }).ok_or(RowsError::Count(given.len()))
    }

    /// Those of a left wheel, of which these are the mirror image.
    pub fn mirrored(&self) -> Self {
        let OnWheel { angle, radius, lateral } = self.on_wheel;
        let gaps = self.rows.iter().skip(1).map(|row| row.gap).rev();
        let gaps: Vec<f64> = std::iter::once(0.0).chain(gaps).collect();
        let row = |(row, gap): (&PatchRow, f64)| PatchRow { position: -row.position, gap, ..*row };
        let shape = |shape: &EquivalentEllipse| EquivalentEllipse { centre: -shape.centre, ..*shape };
        Self {
            on_wheel: OnWheel { angle: -angle, radius, lateral: lateral.map(|lateral| -lateral) },
            rows: self.rows.iter().rev().zip(gaps).map(row).collect(),
            shapes: self.shapes.iter().rev().map(shape).collect(),
        }
    }

    /// The patches with `scale` times their lengths, about their common centre of load.
    pub fn grown(&self, scale: f64) -> Self {
        let centre = rows::centre_of_load(&self.rows);
        let shift = (1.0 - scale) * centre;
        let rows = rows::scaled(&self.rows, scale);
        let shape = |shape: &EquivalentEllipse| EquivalentEllipse {
            a: scale * shape.a,
            b: scale * shape.b,
            centre: scale * shape.centre + shift,
        };
        Self {
            on_wheel: self.on_wheel,
            rows: rows.map(|row| PatchRow { position: row.position + shift, ..row }).collect(),
            shapes: self.shapes.iter().map(shape).collect(),
        }
    }

    /// Width of all rows, without the gaps between them \[m].
    pub fn width(&self) -> f64 {
        self.rows.iter().map(|row| row.width).sum()
    }

    /// Largest half-length of a row \[m].
    pub fn half_length(&self) -> f64 {
        self.rows.iter().fold(0.0, |longest: f64, row| longest.max(row.half_length))
    }
}

/// Rows of a patch over the shift of the wheelset.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchTable {
    /// Shifts, ascending \[m]; one without meaning for a patch that stays.
    pub shifts: Vec<f64>,
    /// The patches under these, with as many rows each.
    pub patches: Vec<PatchRows>,
    /// Number of the one of the wheelset in the middle of the track, or of the nearest one.
    middle: usize,
}

impl PatchTable {
    /// Reads rows that together carry `load` \[N]: a table with the columns `position` and `half_length` \[m] and
    /// `load_share`, any measure of the load of a row; only its ratios count. With a column `width` \[m] rows are as wide as
    /// it says; without one, those at about the same distance touch, each reaches halfway to its neighbours, and where the
    /// distance is larger a gap is left. `angle` \[rad], `radius` and `lateral` \[m] say where rows lie on the wheel. With a column
    /// `shift` \[m] the rows of every shift are one patch.
    ///
    /// # Errors
    /// Tables without meaning: the error names line, column, value, allowed range and what to do.
    pub fn parse(text: &str, load: f64) -> Result<Self, RowsError> {
        if text.trim().is_empty() {
            return Err(RowsError::Count(0));
        }
        let text = text.replace(';', "\n");
        let table = Table::read(&text)?;
        let columns = table.columns(COLUMNS, &[WIDTH])?;
        let others = Others {
            width: table.column(WIDTH),
            on_wheel: ON_WHEEL.map(|(name, _)| table.column(name)),
            shift: table.column(SHIFT),
        };
        let mut blocks: Vec<Vec<GivenRow>> = Vec::new();
        for row in table.rows() {
            let row = GivenRow::read(&row?, columns, &others)?;
            let present = blocks.last().and_then(|block| block.last());
            let [before, shift] = [present.and_then(|row| row.shift), row.shift];
            if present.is_none() || before != shift {
                if let (Some(before), Some(shift)) = (before, shift)
                    && before > shift
                {
                    let problem =
                        format!("shift = {shift} m lies before {before} m above; sort the blocks by their shift");
                    return Err(wrong(row.line, problem));
                }
                blocks.push(Vec::new());
            }
            let Some(block) = blocks.last_mut() else { continue };
            row.check(block.last().map(|row| row.position)).map_err(|problem| wrong(row.line, problem))?;
            block.push(row);
        }
        let count = blocks.first().map_or(0, Vec::len);
        if !(2..=MOST_ROWS).contains(&count) {
            return Err(RowsError::Count(count));
        }
        if let Some(other) = blocks.iter().find(|block| block.len() != count) {
            let shift = format!("{:?}", other[0].shift.unwrap_or(0.0));
            return Err(RowsError::Blocks { shift, rows: other.len(), first: count });
        }
        let shifts: Vec<f64> = blocks.iter().map(|block| block[0].shift.unwrap_or(0.0)).collect();
        let nearest = (0..shifts.len()).min_by(|a, b| shifts[*a].abs().total_cmp(&shifts[*b].abs()));
        Ok(Self {
            middle: nearest.unwrap_or(0),
            shifts,
            patches: blocks.iter().map(|block| PatchRows::new(block, load)).collect::<Result<_, _>>()?,
        })
    }

    /// The patch of the wheelset in the middle of the track, or the nearest one.
    pub fn middle(&self) -> &PatchRows {
        &self.patches[self.middle]
    }

    /// Patches with `scale` times their lengths, see [`PatchRows::grown`].
    pub fn grown(&self, scale: f64) -> Self {
        Self { patches: self.patches.iter().map(|patch| patch.grown(scale)).collect(), ..self.clone() }
    }

    /// Those of a left wheel, of which these are the mirror image.
    pub fn mirrored(&self) -> Self {
        Self {
            shifts: self.shifts.iter().rev().map(|shift| -shift).collect(),
            patches: self.patches.iter().rev().map(PatchRows::mirrored).collect(),
            middle: self.patches.len() - 1 - self.middle,
        }
    }
}

fn wrong(line: usize, problem: String) -> RowsError {
    TableError::new(line, problem).into()
}

/// Width of every row and the free one before it \[m] where the table has widths.
fn sides_by_width(given: &[GivenRow], widths: &[f64]) -> Result<Vec<[f64; 2]>, RowsError> {
    let mut sides = vec![[widths[0], 0.0]];
    for (rows, width) in given.windows(2).zip(widths.windows(2)) {
        let gap = rows[1].position - rows[0].position - 0.5 * (width[0] + width[1]);
        let slack = SLACK * width[0].min(width[1]);
        if gap < -slack {
            let problem = format!(
                "rows at position = {} m and {} m with width = {} m and {} m overlap by {:.1e} m; each is its width about its \
                 position: correct them",
                rows[0].position, rows[1].position, width[0], width[1], -gap
            );
            return Err(wrong(rows[1].line, problem));
        }
        sides.push([width[1], if gap > slack { gap } else { 0.0 }]);
    }
    Ok(sides)
}

/// Width of every row and the free one before it \[m] where the distances of the rows tell them: rows at about the
/// smallest distance touch, and most are such; others are at least nearly twice as far apart, as if a row were missing.
fn sides_by_distance(given: &[GivenRow]) -> Result<Vec<[f64; 2]>, RowsError> {
    let positions: Vec<f64> = given.iter().map(|row| row.position).collect();
    let distances: Vec<f64> = positions.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let common = distances.iter().copied().fold(f64::INFINITY, f64::min);
    let touches = |distance: f64| distance <= TOUCHING * common;
    let touching = distances.iter().filter(|distance| touches(**distance)).count();
    let unclear = |distance: f64| !touches(distance) && (distance < APART * common || 2 * touching <= distances.len());
    if let Some((distance, row)) = distances.iter().zip(&given[1..]).find(|(distance, _)| unclear(**distance)) {
        let problem = format!(
            "position = {} m is {distance:.4e} m behind the row before it, where the smallest distance of two rows is \
             {common:.4e} m: whether they touch is unclear; add the column {WIDTH} with the width of every row in m",
            row.position
        );
        return Err(wrong(row.line, problem));
    }
    let mut sides = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for patch in positions.chunk_by(|low, high| touches(high - low)) {
        let mut widths = rows::widths(patch);
        if let [alone] = widths.as_mut_slice() {
            *alone = common;
        }
        let (first, last) = ((patch[0], widths[0]), (patch[patch.len() - 1], widths[widths.len() - 1]));
        let gap = before.map_or(0.0, |(position, width)| first.0 - position - 0.5 * (width + first.1));
        sides.extend(widths.iter().enumerate().map(|(i, width)| [*width, if i == 0 { gap } else { 0.0 }]));
        before = Some(last);
    }
    Ok(sides)
}

impl GivenRow {
    fn read(
        row: &TableRow,
        [position, half_length, load_share]: [usize; 3],
        others: &Others,
    ) -> Result<Self, TableError> {
        let number = |column: Option<usize>, name: &str, unit: &str| {
            column.map(|column| row.number(column, name, unit)).transpose()
        };
        let mut on_wheel = [None; 3];
        for (value, (column, (name, unit))) in on_wheel.iter_mut().zip(others.on_wheel.iter().zip(ON_WHEEL)) {
            *value = number(*column, name, unit)?;
        }
        Ok(Self {
            line: row.line,
            position: row.number(position, COLUMNS[0], "m")?,
            half_length: row.number(half_length, COLUMNS[1], "m")?,
            load_share: row.number(load_share, COLUMNS[2], "1")?,
            width: number(others.width, WIDTH, "m")?,
            on_wheel,
            shift: number(others.shift, SHIFT, "m")?,
        })
    }

    /// Refuses a row outside the ranges, or not behind the position `before`; the error is problem and remedy.
    fn check(&self, before: Option<f64>) -> Result<(), String> {
        let Self { position, half_length, load_share, .. } = *self;
        let [farthest, longest, widest] = LARGEST;
        let places = [("position", Some(position), farthest), ("lateral", self.on_wheel[2], farthest)];
        for (name, value, most) in places.into_iter().chain([(SHIFT, self.shift, FARTHEST_SHIFT)]) {
            if let Some(value) = value.filter(|value| value.abs() > most) {
                return Err(format!("{name} = {value} m is outside -{most} to {most} m; columns are in metres"));
            }
        }
        if !(half_length > 0.0 && half_length <= longest) {
            return Err(format!(
                "half_length = {half_length} m is outside 0 (excluded) to {longest} m; columns are in metres, and rows \
                 without contact are left out"
            ));
        }
        if load_share <= 0.0 {
            return Err(format!(
                "load_share = {load_share} must be positive; leave out rows without load, where a gap is then left"
            ));
        }
        if let Some(width) = self.width.filter(|width| !(*width > 0.0 && *width <= widest)) {
            return Err(format!("width = {width} m is outside 0 (excluded) to {widest} m; columns are in metres"));
        }
        if let Some(angle) = self.on_wheel[0].filter(|angle| angle.abs() > STEEPEST) {
            return Err(format!(
                "angle = {angle} rad is outside -{STEEPEST} to {STEEPEST} rad; columns are in radians"
            ));
        }
        if let Some(radius) = self.on_wheel[1].filter(|radius| !(*radius > 0.0 && *radius <= 10.0)) {
            return Err(format!(
                "radius = {radius} m is outside 0 (excluded) to 10 m; it is that of rolling, in metres"
            ));
        }
        match before.filter(|before| *before >= position) {
            Some(before) => {
                Err(format!("position = {position} m must be larger than {before} m before it; sort the lines"))
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The only patch of a table.
    fn parsed(text: &str, load: f64) -> PatchRows {
        let table = PatchTable::parse(text, load).unwrap();
        assert_eq!(table.shifts, [0.0]);
        table.middle().clone()
    }

    #[test]
    fn rows_on_lines_or_between_semicolons_share_the_load_by_their_ratios() {
        let found = parsed("position, half_length, load_share; -1e-3, 4e-3, 3; 1e-3, 5e-3, 1", 8e4);
        let expected = [
            PatchRow { position: -1e-3, width: 2e-3, half_length: 4e-3, line_load: 3e7, gap: 0.0 },
            PatchRow { position: 1e-3, width: 2e-3, half_length: 5e-3, line_load: 1e7, gap: 0.0 },
        ];
        assert_eq!(found.rows, expected);
        assert_eq!((found.width(), found.half_length()), (4e-3, 5e-3));
        let lines = "\u{feff}load_share,unused,position,half_length\n3,,-1e-3,4e-3\n1,,1e-3,5e-3\n";
        assert_eq!(parsed(lines, 8e4), found);
    }

    #[test]
    fn refusals_name_line_column_value_and_remedy() {
        let head = "position,half_length,load_share\n";
        for (text, words) in [
            (String::new(), &["0 rows", "needs 2 to 1000", "position,half_length,load_share"][..]),
            (format!("{head}0,5e-3,1"), &["1 rows", "needs 2"]),
            ("position,length,load_share\n0,1,1".to_owned(), &["line 1", "half_length is missing"]),
            (format!("{head}0,5e-3,1\n1e-3,long,1"), &["line 3", "half_length = \"long\"", "finite"]),
            (format!("{head}0,5e-3,1\n1e-3,5e-3"), &["line 3", "2 cells", "3 columns"]),
            (format!("{head}0,5e-3,1\n0,5e-3,1"), &["line 3", "position = 0 m", "sort"]),
            (format!("{head}0,5,1"), &["line 2", "half_length = 5 m", "in metres"]),
            (format!("{head}-10,5e-3,1"), &["line 2", "position = -10 m", "in metres"]),
            (format!("{head}0,0,1"), &["line 2", "half_length = 0 m", "left out"]),
            (format!("shift,{head}-7,0,5e-3,1"), &["line 2", "shift = -7 m", "in metres"]),
            (format!("{head}0,5e-3,-1"), &["line 2", "load_share = -1", "positive"]),
        ] {
            let message = PatchTable::parse(&text, 1e5).unwrap_err().to_string();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
        let with_widths = "position,half_length,load_share,width\n";
        for (text, words) in [
            (format!("{head}0,5e-3,1\n1e-3,5e-3,1\n3e-3,5e-3,1"), &["line 4", "unclear", "column width"][..]),
            (format!("{head}0,5e-3,1\n1e-3,5e-3,1\n2e-3,5e-3,1\n3.7e-3,5e-3,1"), &["line 5", "unclear", "width"]),
            (format!("{with_widths}0,5e-3,1,1e-3\n0.9e-3,5e-3,1,1e-3"), &["line 3", "overlap by 1.0e-4 m"]),
            (format!("{with_widths}0,5e-3,1,1e-3\n1e-3,5e-3,1"), &["line 3", "3 cells", "4 columns"]),
            (format!("{with_widths}0,5e-3,1,1\n1e-3,5e-3,1,1"), &["line 2", "width = 1 m", "in metres"]),
            (format!("{head}0,0,5e-3,1\n1,5,5e-3,1"), &["line 2", "4 cells", "3 columns", "decimal point"]),
            (format!("position,{head}0,0,5e-3,1\n1,1,5e-3,1"), &["line 1", "two columns position"]),
        ] {
            let message = PatchTable::parse(&text, 1e5).unwrap_err().to_string();
            assert!(words.iter().all(|word| message.contains(word)), "{message}");
        }
        let many: String = (0..1001).map(|i| format!("{:e},1e-3,1\n", 1e-5 * f64::from(i))).collect();
        assert_eq!(PatchTable::parse(&format!("{head}{many}"), 1e5), Err(RowsError::Count(1001)));
    }

    /// Table of rows at positions \[mm] with loads.
    fn table(rows: &[(f64, f64)]) -> String {
        let rows: String = rows.iter().map(|(z, load)| format!("{z}e-3,5e-3,{load}\n")).collect();
        format!("position,half_length,load_share\n{rows}")
    }

    /// Widths and gaps \[mm].
    fn sides(found: &PatchRows) -> Vec<[f64; 2]> {
        let tenth = |length: f64| (1e7 * length).round() / 1e4;
        found.rows.iter().map(|row| [tenth(row.width), tenth(row.gap)]).collect()
    }

    #[test]
    fn a_missing_row_is_a_gap_and_rows_about_it_keep_load_and_width() {
        let found = parsed(&table(&[(-2.0, 1.0), (-1.0, 2.0), (1.0, 3.0), (2.0, 4.0)]), 1e5);
        assert_eq!(sides(&found), [[1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0]]);
        assert_eq!(found.shapes.len(), 2);
        let loads: Vec<f64> = found.rows.iter().map(|row| (row.width * row.line_load).round()).collect();
        assert_eq!(loads, [1e4, 2e4, 3e4, 4e4]);
        // A row alone is as wide as the others, and distances that nearly agree are not gaps.
        let alone = parsed(&table(&[(-2.0, 1.0), (-1.0, 1.0), (0.0, 1.0), (30.0, 1.0)]), 1e5);
        assert_eq!(sides(&alone)[3], [1.0, 29.0]);
        let uneven = parsed(&table(&[(0.0, 1.0), (0.4, 1.0), (1.0, 1.0)]), 1e5);
        assert_eq!(sides(&uneven), [[0.4, 0.0], [0.5, 0.0], [0.6, 0.0]]);
    }

    #[test]
    fn rows_with_widths_are_as_wide_as_they_say_and_loads_are_those_of_rows() {
        let text = "position,width,half_length,load_share; 0,1e-3,5e-3,1; 2e-3,3e-3,5e-3,1; 4e-3,1e-3,5e-3,2";
        let found = parsed(text, 8e4);
        assert_eq!(sides(&found), [[1.0, 0.0], [3.0, 0.0], [1.0, 0.0]]);
        let line_loads: Vec<f64> = found.rows.iter().map(|row| (1e-3 * row.line_load).round()).collect();
        assert_eq!(line_loads, [20e3, 6667.0, 40e3]);
        let groove = parsed(&text.replace("4e-3", "4.3e-3"), 8e4);
        assert_eq!((sides(&groove)[2], groove.shapes.len()), ([1.0, 0.3], 2));
    }

    #[test]
    fn patches_grow_about_their_common_centre_of_load() {
        let given = parsed(&table(&[(-2.0, 1.0), (-1.0, 2.0), (1.0, 3.0), (2.0, 4.0)]), 1e5);
        assert_eq!(given.grown(1.0), given);
        let grown = given.grown(0.5_f64.cbrt());
        assert!((rows::load(&grown.rows) / 5e4 - 1.0).abs() < 1e-14);
        assert!((rows::centre_of_load(&grown.rows) / rows::centre_of_load(&given.rows) - 1.0).abs() < 1e-13);
        let sides: Vec<f64> = [&given, &grown].map(|rows| rows.rows[2].position - rows.rows[2].gap).to_vec();
        assert!((sides[1] - 0.7e-3 - 0.5_f64.cbrt() * (sides[0] - 0.7e-3)).abs() < 1e-15);
        assert_eq!(grown.shapes.len(), 2);
    }
}
