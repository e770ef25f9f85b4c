//! Curves as drawings (SVG) that need nothing from elsewhere.

use std::fmt::Write;

/// Whose result a curve is; it decides how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The thesis's own method: dashed.
    Method,
    /// The product: solid.
    Ours,
    /// Closed form: dots.
    Exact,
    /// A number in the text: a thin line.
    Quoted,
}

/// A curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Whose it is.
    pub source: Source,
    /// What it shows.
    pub name: String,
    /// Its points in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// A drawing with its axes.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Quantity and unit along x and y.
    pub axes: [String; 2],
    /// What is drawn.
    pub curves: Vec<Curve>,
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 360.0;
/// Left, right, top and bottom margin.
const MARGIN: [f64; 4] = [70.0, 15.0, 15.0, 48.0];
const COLOURS: [&str; 6] = ["#1b5e9e", "#b3401a", "#2e7d32", "#6a3d9a", "#8a6d00", "#00707a"];

impl Plot {
    /// The drawing as SVG.
    pub fn svg(&self) -> String {
        let [left, right, top, bottom] = MARGIN;
        let ranges = [0, 1].map(|axis| self.range(axis));
        let x = |value: f64| left + (value - ranges[0][0]) / (ranges[0][1] - ranges[0][0]) * (WIDTH - left - right);
        let y = |value: f64| {
            HEIGHT - bottom - (value - ranges[1][0]) / (ranges[1][1] - ranges[1][0]) * (HEIGHT - top - bottom)
        };
        let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\">");
        let (end, floor) = (WIDTH - right, HEIGHT - bottom);
        for tick in ticks(ranges[0]) {
            let at = x(tick);
            let _ = write!(svg, "<path class=\"grid\" d=\"M{at:.1} {top}V{floor}\"/>");
            let _ =
                write!(svg, "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>", floor + 16.0, label(tick));
        }
        for tick in ticks(ranges[1]) {
            let at = y(tick);
            let _ = write!(svg, "<path class=\"grid\" d=\"M{left} {at:.1}H{end}\"/>");
            let _ = write!(
                svg,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                left - 6.0,
                at + 4.0,
                label(tick)
            );
        }
        let (middle, centre) = (0.5 * (left + end), 0.5 * (top + floor));
        let _ =
            write!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>", HEIGHT - 10.0, self.axes[0]);
        let turned = format!("transform=\"rotate(-90 16 {centre})\"");
        let _ = write!(svg, "<text x=\"16\" y=\"{centre}\" {turned} text-anchor=\"middle\">{}</text>", self.axes[1]);
        for (i, curve) in self.curves.iter().enumerate() {
            let colour = COLOURS[i % COLOURS.len()];
            if curve.source == Source::Exact {
                for [a, b] in &curve.points {
                    let _ =
                        write!(svg, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.2\" fill=\"{colour}\"/>", x(*a), y(*b));
                }
                continue;
            }
            let style = match curve.source {
                Source::Method => "stroke-width=\"1.8\" stroke-dasharray=\"7 4\"",
                Source::Quoted => "stroke-width=\"1\"",
                _ => "stroke-width=\"1.8\"",
            };
            let points: Vec<String> = curve.points.iter().map(|[a, b]| format!("{:.1},{:.1}", x(*a), y(*b))).collect();
            let _ =
                write!(svg, "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" {style}/>", points.join(" "));
        }
        svg + "</svg>" + &self.legend()
    }

    /// Names of the curves in their colours.
    fn legend(&self) -> String {
        let line = |(i, curve): (usize, &Curve)| {
            let mark = match curve.source {
                Source::Method => "– –",
                Source::Ours => "——",
                Source::Exact => "• •",
                Source::Quoted => "──",
            };
            format!("<span style=\"color:{}\">{mark} {}</span>", COLOURS[i % COLOURS.len()], curve.name)
        };
        let lines: Vec<String> = self.curves.iter().enumerate().map(line).collect();
        format!("<p class=\"legend\">{}</p>", lines.join(" &nbsp; "))
    }

    /// Smallest and largest value along an axis, a little apart if they are equal.
    fn range(&self, axis: usize) -> [f64; 2] {
        let values = || self.curves.iter().flat_map(|curve| &curve.points).map(|point| point[axis]);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let room = if axis == 1 { 0.05 * (high - low) } else { 0.0 };
        if high > low { [low - room, high + room] } else { [low - 1.0, high + 1.0] }
    }
}

/// Round numbers within a range, about six.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / 6.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= rough).unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    (first..=(high / step).floor() as i64).map(|i| i as f64 * step).collect()
}

/// A number as short as it can be.
fn label(value: f64) -> String {
    if value == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&value.abs()) {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        assert_eq!(ticks([0.0, 6.0]), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let found = ticks([-0.83, 1.1]);
        assert!(found.len() >= 3 && found.iter().all(|tick| (-0.83..=1.1).contains(tick)), "{found:?}");
        assert_eq!([0.0, 0.25, 3e-7, 1200.0].map(label), ["0", "0.25", "3.0e-7", "1200"]);
    }

    #[test]
    fn every_curve_lies_within_its_drawing() {
        let points = (0..50).map(|i| [f64::from(i) * 0.1, (f64::from(i) * 0.3).sin() * 1e6]).collect();
        let curve = Curve { source: Source::Ours, name: "sine".into(), points };
        let svg = Plot { axes: ["x".into(), "y".into()], curves: vec![curve] }.svg();
        let drawn = svg.split("points=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        for point in drawn.split(' ') {
            let (x, y) = point.split_once(',').unwrap();
            assert!((MARGIN[0]..=WIDTH).contains(&x.parse().unwrap()));
            assert!((0.0..=HEIGHT - MARGIN[3]).contains(&y.parse().unwrap()));
        }
    }
}
