//! Curves, meshes and maps as drawings (SVG) that need nothing from elsewhere.

use std::fmt::Write;

/// Whose result a curve is; it decides how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The thesis's own method: dashed.
    Method,
    /// The product: solid.
    Ours,
    /// Closed form: circles.
    Exact,
    /// A number in the text: a thin line.
    Quoted,
    /// Edges of a mesh, thin and without a name in the legend: lines, parted by a point without numbers ([`GAP`]).
    Mesh,
    /// Where a field has values of this level, 0 to [`LEVELS`] − 1: filled outlines, parted alike.
    Level(usize),
}

/// A point without numbers, which ends a line or an outline.
pub const GAP: [f64; 2] = [f64::NAN; 2];
/// Number of levels of a map.
pub const LEVELS: usize = 10;

impl Source {
    /// True if places are drawn, so that both axes have one scale.
    fn is_picture(self) -> bool {
        matches!(self, Self::Mesh | Self::Level(_))
    }
}

/// A curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Whose it is.
    pub source: Source,
    /// Title.
    pub name: String,
    /// Its points in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// A drawing with its axes.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Quantity and unit along x and y.
    pub axes: [String; 2],
    /// Curves.
    pub curves: Vec<Curve>,
}

const WIDTH: f64 = 640.0;
/// Height of a drawing of curves, and largest height of one of places.
const HEIGHT: f64 = 360.0;
const TALLEST: f64 = 620.0;
/// Left, right, top and bottom margin.
const MARGIN: [f64; 4] = [70.0, 15.0, 15.0, 48.0];
/// Smallest distance of the circles of a closed form.
const APART: f64 = 11.0;
/// Colours of curves: a drawing that needs more than these is refused ([`Plot::flaw`]).
const COLOURS: [&str; 12] = [
    "#1b5e9e", "#b3401a", "#2e7d32", "#6a3d9a", "#8a6d00", "#00838f", "#c2185b", "#4e342e", "#7cb342", "#5c6bc0",
    "#ef6c00", "#455a64",
];

/// Colour of a level, from pale yellow to dark red.
fn shade(level: usize) -> String {
    let share = level as f64 / (LEVELS - 1) as f64;
    let mix = |from: f64, to: f64| (from + (to - from) * share).round();
    format!("rgb({},{},{})", mix(255.0, 110.0), mix(243.0, 0.0), mix(190.0, 40.0))
}

impl Source {
    /// How a line of it is drawn.
    fn style(self) -> &'static str {
        match self {
            Self::Method => "stroke-width=\"1.8\" stroke-dasharray=\"7 4\"",
            Self::Ours => "stroke-width=\"1.8\"",
            Self::Exact => "stroke-width=\"1.2\"",
            Self::Quoted => "stroke-width=\"1\"",
            Self::Mesh => "stroke-width=\"0.35\"",
            Self::Level(_) => "stroke-width=\"0.4\"",
        }
    }
}

impl Curve {
    /// Subject of the curve: the words after the comma of its name.
    fn about(&self) -> Option<&str> {
        self.name.split_once(", ").map(|(_, about)| about)
    }
}

impl Plot {
    /// Flaws of the plot: curves that look alike.
    pub fn flaw(&self) -> Option<String> {
        let needed = self.colours().into_iter().flatten().max().map_or(0, |last| last + 1);
        (needed > COLOURS.len()).then(|| format!("curves over \"{}\" need {needed} colours", self.axes[0]))
    }

    /// Number of the colour of each curve, none for places. Curves about the same, but from different sources, share one.
    fn colours(&self) -> Vec<Option<usize>> {
        let (mut found, mut next): (Vec<Option<usize>>, usize) = (Vec::new(), 0);
        for (i, curve) in self.curves.iter().enumerate() {
            let earlier = || self.curves[..i].iter().zip(&found).filter(|(other, _)| curve.about() == other.about());
            let of_another =
                |(other, colour): (&Curve, &Option<usize>)| colour.filter(|_| other.source != curve.source);
            let shared = earlier().find_map(of_another);
            let alike = curve.about().is_none() || earlier().any(|(other, _)| other.source == curve.source);
            let colour = match shared {
                _ if curve.source.is_picture() => None,
                Some(_) if !alike => shared,
                _ => {
                    next += 1;
                    Some(next - 1)
                }
            };
            found.push(colour);
        }
        found
    }

    /// The colour of each curve as text.
    fn inks(&self) -> Vec<String> {
        let ink = |(curve, number): (&Curve, Option<usize>)| match (curve.source, number) {
            // Of the fill, so that neighbouring cells leave no seam.
            (Source::Level(level), _) => shade(level),
            (_, Some(number)) => COLOURS[number % COLOURS.len()].into(),
            _ => "#5a5a5a".into(),
        };
        self.curves.iter().zip(self.colours()).map(ink).collect()
    }

    /// The drawing as SVG, with its legend.
    pub fn svg(&self) -> String {
        let [left, right, top, bottom] = MARGIN;
        let ranges = [0, 1].map(|axis| self.range(axis));
        let [across, up] = ranges.map(|[low, high]| high - low);
        let picture = self.curves.iter().any(|curve| curve.source.is_picture());
        // Places have one scale in both directions.
        let tall = (WIDTH - left - right) * up / across;
        let height = if picture { tall.min(TALLEST) + top + bottom } else { HEIGHT };
        let wide = if picture { (height - top - bottom) * across / up } else { WIDTH - left - right };
        let x = |value: f64| left + (value - ranges[0][0]) / across * wide;
        let y = |value: f64| height - bottom - (value - ranges[1][0]) / up * (height - top - bottom);
        let mut svg = format!("<figure><svg viewBox=\"0 0 {WIDTH} {height:.0}\" role=\"img\">");
        let (end, floor) = (left + wide, height - bottom);
        svg += &self.frame([left, end, top, floor], &x, &y);
        for (curve, ink) in self.curves.iter().zip(self.inks()) {
            if curve.source == Source::Exact {
                svg += &circles(curve.points.iter().map(|[a, b]| [x(*a), y(*b)]), &ink);
                continue;
            }
            let fill = if matches!(curve.source, Source::Level(_)) { ink.as_str() } else { "none" };
            // One path for all lines and outlines of a curve, each from its first point on.
            let mut path = String::new();
            let mut starts = true;
            for [a, b] in &curve.points {
                if !a.is_nan() {
                    let _ = write!(path, "{}{:.1} {:.1}", if starts { 'M' } else { 'L' }, x(*a), y(*b));
                }
                starts = a.is_nan();
            }
            let style = curve.source.style();
            let _ = write!(svg, "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{ink}\" {style}/>");
        }
        svg + "</svg>" + &self.legend() + "</figure>"
    }

    /// Grid, numbers and names of the axes; `x` and `y` give the place of a value.
    fn frame(&self, [left, end, top, floor]: [f64; 4], x: &dyn Fn(f64) -> f64, y: &dyn Fn(f64) -> f64) -> String {
        let mut svg = String::new();
        for (at, text) in ticks(self.range(0)) {
            let at = x(at);
            let _ = write!(svg, "<path class=\"grid\" d=\"M{at:.1} {top}V{floor:.1}\"/>");
            let _ = write!(svg, "<text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{text}</text>", floor + 16.0);
        }
        for (at, text) in ticks(self.range(1)) {
            let at = y(at);
            let _ = write!(svg, "<path class=\"grid\" d=\"M{left} {at:.1}H{end:.1}\"/>");
            let _ = write!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>", left - 6.0, at + 4.0);
        }
        let (middle, centre) = (0.5 * (left + end), 0.5 * (top + floor));
        let under = floor + 38.0;
        let _ = write!(svg, "<text x=\"{middle:.1}\" y=\"{under:.1}\" text-anchor=\"middle\">{}</text>", self.axes[0]);
        let turned = format!("transform=\"rotate(-90 16 {centre:.1})\"");
        let _ = write!(svg, "<text x=\"16\" y=\"{centre:.1}\" {turned} text-anchor=\"middle\">{}</text>", self.axes[1]);
        svg
    }

    /// Names of the curves, each after a piece of it.
    fn legend(&self) -> String {
        let entry = |(curve, ink): (&Curve, String)| {
            let key = match curve.source {
                Source::Mesh => return None,
                Source::Level(_) => format!("<span class=\"chip\" style=\"background:{ink}\"></span>"),
                Source::Exact => {
                    format!(
                        "<svg class=\"key\" viewBox=\"0 0 28 8\">{}</svg>",
                        circles([7.0, 21.0].map(|x| [x, 4.0]), &ink)
                    )
                }
                source => format!(
                    "<svg class=\"key\" viewBox=\"0 0 28 8\"><line x2=\"28\" y1=\"4\" y2=\"4\" style=\"stroke:{ink}\" {}/></svg>",
                    source.style()
                ),
            };
            Some(format!("<span>{key} {}</span>", curve.name))
        };
        let entries: Vec<String> = self.curves.iter().zip(self.inks()).filter_map(entry).collect();
        format!("<figcaption class=\"legend\">{}</figcaption>", entries.join(" "))
    }

    /// Smallest and largest value along an axis, a little apart if they are equal.
    fn range(&self, axis: usize) -> [f64; 2] {
        let values = || self.curves.iter().flat_map(|curve| &curve.points).map(|point| point[axis]);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let picture = self.curves.iter().any(|curve| curve.source.is_picture());
        let room = if axis == 1 && !picture { 0.05 * (high - low) } else { 0.0 };
        if high > low { [low - room, high + room] } else { [low - 1.0, high + 1.0] }
    }
}

/// Circles at some places, left out where they would lie closer together than [`APART`].
fn circles(places: impl IntoIterator<Item = [f64; 2]>, ink: &str) -> String {
    let (mut text, mut last): (String, Option<[f64; 2]>) = (String::new(), None);
    for place @ [x, y] in places {
        if last.is_none_or(|[a, b]| (x - a).hypot(y - b) >= APART) {
            let _ = write!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"none\" stroke=\"{ink}\"/>");
            last = Some(place);
        }
    }
    text
}

/// Round numbers within a range, about six, and how they are written: all with as many digits as tell neighbours apart.
fn ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let rough = (high - low) / 6.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= rough).unwrap_or(rough);
    let last = step.log10().floor() as i32;
    let text = |value: f64| {
        let largest = low.abs().max(high.abs());
        if value == 0.0 {
            "0".into()
        } else if largest < 1e5 && last > -5 {
            format!("{value:.*}", usize::try_from(-last).unwrap_or_default())
        } else {
            let first = value.abs().log10().floor() as i32;
            format!("{value:.*e}", usize::try_from(first - last).unwrap_or_default())
        }
    };
    let first = (low / step).ceil() as i64;
    let values = (first..=(high / step).floor() as i64).map(|i| i as f64 * step);
    values.map(|value| (value, text(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_within_the_range_and_no_two_read_alike() {
        let texts = |range: [f64; 2]| ticks(range).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
        assert_eq!(texts([0.0, 6.0]), ["0", "1", "2", "3", "4", "5", "6"]);
        assert_eq!(texts([0.0, 0.3])[1..3], ["0.05", "0.10"]);
        let awkward = [[-0.83, 1.1], [0.499_88, 0.500_02], [0.4999, 0.5], [2e-8, 5e-7], [1e5, 1.004e5], [-3e7, 9e8]];
        for range in awkward {
            let (found, mut read) = (ticks(range), texts(range));
            println!("{read:?}");
            assert!(found.len() >= 3 && found.iter().all(|(at, _)| (range[0]..=range[1]).contains(at)));
            // The number is written, and only that.
            let parsed = |text: &str| text.parse::<f64>().unwrap();
            assert!(found.iter().all(|(at, text)| (parsed(text) - at).abs() <= 1e-9 * at.abs()), "{found:?}");
            read.dedup();
            assert_eq!(read.len(), found.len());
        }
    }

    #[test]
    fn curves_of_one_drawing_differ_in_colour_or_are_refused() {
        let line = || Curve { source: Source::Ours, name: "line".into(), points: vec![[0.0, 0.0], [1.0, 1.0]] };
        let plot = |count: usize| Plot { axes: ["x".into(), "y".into()], curves: (0..count).map(|_| line()).collect() };
        let svg = plot(COLOURS.len()).svg();
        assert!(COLOURS.iter().all(|colour| svg.matches(&format!("stroke=\"{colour}\"")).count() == 1));
        assert!(plot(COLOURS.len()).flaw().is_none() && plot(COLOURS.len() + 1).flaw().is_some());
    }

    #[test]
    fn curves_about_the_same_share_a_colour_and_differ_in_style() {
        let sources = [Source::Ours, Source::Exact, Source::Ours, Source::Method, Source::Ours];
        let names = ["ours, µ 0.4", "Carter, µ 0.4", "ours, µ 0.5", "mesh 2, µ 0.5", "ours, finer, µ 0.5"];
        let curve =
            |(source, name): (Source, &str)| Curve { source, name: name.into(), points: vec![[0.0, 0.0], [1.0, 1.0]] };
        let curves = sources.into_iter().zip(names).map(curve).collect();
        let plot = Plot { axes: ["x".into(), "y".into()], curves };
        assert_eq!(plot.colours(), [Some(0), Some(0), Some(1), Some(1), Some(2)]);
    }

    #[test]
    fn circles_of_a_closed_form_leave_what_lies_below_visible() {
        let dense = circles((0..1000).map(|i| [0.1 * f64::from(i), 0.0]), "red");
        assert!((9..=10).contains(&dense.matches("<circle").count()), "{dense}");
        assert_eq!(circles((0..20).map(|i| [20.0 * f64::from(i), 0.0]), "red").matches("<circle").count(), 20);
    }

    #[test]
    fn places_have_one_scale_and_lines_end_at_gaps() {
        let edges = vec![[0.0, 0.0], [3.0, 0.0], GAP, [3.0, 0.0], [3.0, 1.0]];
        let mesh = Curve { source: Source::Mesh, name: String::new(), points: edges };
        let svg = Plot { axes: ["x".into(), "y".into()], curves: vec![mesh] }.svg();
        let path = drawn(&svg);
        let lines: Vec<Vec<f64>> = path.split('M').skip(1).map(numbers).collect();
        assert_eq!(lines.len(), 2);
        let (across, up) = (lines[0][2] - lines[0][0], lines[1][1] - lines[1][3]);
        assert!((across / up - 3.0).abs() < 1e-2 && !svg.contains("NaN"), "{across} {up}");
    }

    /// The last path, which is that of the last curve.
    fn drawn(svg: &str) -> &str {
        svg.rsplit("<path d=\"").next().and_then(|rest| rest.split('"').next()).unwrap()
    }

    fn numbers(path: &str) -> Vec<f64> {
        path.split([' ', 'L']).map(|number| number.parse().unwrap()).collect()
    }

    #[test]
    fn every_curve_lies_within_its_drawing() {
        let points = (0..50).map(|i| [f64::from(i) * 0.1, (f64::from(i) * 0.3).sin() * 1e6]).collect();
        let curve = Curve { source: Source::Ours, name: "sine".into(), points };
        let svg = Plot { axes: ["x".into(), "y".into()], curves: vec![curve] }.svg();
        for point in drawn(&svg)[1..].split('L') {
            let (x, y) = point.split_once(' ').unwrap();
            assert!((MARGIN[0]..=WIDTH).contains(&x.parse().unwrap()));
            assert!((0.0..=HEIGHT - MARGIN[3]).contains(&y.parse().unwrap()));
        }
    }
}
