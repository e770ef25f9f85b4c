//! Sharp holes under a rolling wheel: Paper A figures 13 and 14, Paper B figures 18 and 19.

use super::mesh_heat::{self, ANNULUS, PLATE, half_width};
use super::{Figure, corrugation::standard, curve, must};
use crate::ours::{Product, Run};
use crate::paper_a::{self as a, LOAD, SPEED, STEP, case};
use crate::plot::{Curve, Plot, Source};
use crate::quoted::Status;
use crate::transient::{Case, Rolling};
use wheelrail::config::RailEnds;

/// Smallest and largest force over a load.
pub(super) fn extremes(points: &[[f64; 2]], load: f64) -> [f64; 2] {
    let fold = |pick: fn(f64, f64) -> f64, from: f64| points.iter().fold(from, |found, point| pick(found, point[1]));
    [fold(f64::min, f64::MAX) / load, fold(f64::max, f64::MIN) / load]
}

pub(super) fn hole(position: f64, length: f64, depth: f64) -> String {
    format!("hole(position = {position:?}, length = {length:?}, depth = {depth:?})")
}

/// Place of Paper A's hole, its length and its depth \[m]; the depth is assumed.
const DISCONTINUITY: [f64; 3] = [0.03, 5e-3, 1e-4];

/// The product over that hole: force over the way. Elements and contact nodes are counted in half a contact.
fn over(velocity: f64, [elements, nodes]: [usize; 2], step: f64) -> Result<Vec<[f64; 2]>, String> {
    let [at, length, depth] = DISCONTINUITY;
    let product = a::product(&hole(at, length, depth), |config| {
        config.vehicle.damping = 0.0;
        config.mesh.elements_per_half_width = elements;
        config.mesh.grid_elements_per_half_width = nodes;
    })?;
    a::follow(&mut product.rolling(velocity, 0.0, |_| ())?, step, (0.12 / velocity / step) as usize)
}

/// Pressure on the nodes of the tread when the middle of the hole is at three places \[m] ahead of the contact, by the
/// thesis's method.
fn instants(places: [f64; 3]) -> Result<Vec<Vec<[f64; 2]>>, String> {
    let mesh = standard();
    let profile = a::profile(&hole(DISCONTINUITY[0], DISCONTINUITY[1], DISCONTINUITY[2]))?;
    let height = |x: f64| profile.height(x);
    let said = |error: crate::Error| error.to_string();
    let mut rolling = Rolling::new(case(), &mesh.wheel, &mesh.rail, &height).map_err(said)?;
    let mut found = Vec::new();
    for place in places {
        while rolling.way < DISCONTINUITY[0] - place {
            rolling.advance(&height).map_err(said)?;
        }
        found.push(rolling.pressure());
    }
    Ok(found)
}

/// Number of separate parts of the contact.
fn patches(pressure: &[[f64; 2]]) -> usize {
    let touches: Vec<bool> = pressure.iter().map(|point| point[1] > 0.0).collect();
    touches.iter().zip(std::iter::once(&false).chain(&touches)).filter(|(now, before)| **now && !**before).count()
}

/// Figures A 13 and 14: a hole of 5 mm at three velocities, and the nodal forces on it.
pub fn discontinuity() -> Result<Figure, String> {
    let kmh = [50.0, 100.0, 150.0];
    let [at, length, depth] = DISCONTINUITY;
    let text = hole(at, length, depth);
    let steps = |velocity: f64, step: f64| (0.12 / velocity / step) as usize;
    let (mut curves, mut theirs) = (Vec::new(), Vec::new());
    for v in kmh.map(|kmh| kmh / 3.6) {
        let shown = |points: &[[f64; 2]]| points.iter().map(|[way, f]| [1e3 * (way - at), f / LOAD]).collect();
        let ours = over(v, [10, 20], 5e-6)?;
        let method = a::history(Case { velocity: v, ..case() }, &standard(), &text, steps(v, STEP))?;
        theirs.push(extremes(&method, LOAD));
        curves.push(curve(Source::Ours, format!("ours, {:.0} km/h", 3.6 * v), shown(&ours)));
        curves.push(curve(Source::Method, format!("thesis's method, {:.0} km/h", 3.6 * v), shown(&method)));
    }
    let smooth = [([10, 20], 5e-6), ([10, 20], 2.5e-6), ([20, 40], 5e-6)]
        .map(|(grid, step)| over(SPEED, grid, step).map(|p| extremes(&p, LOAD)));
    let smooth = smooth.into_iter().collect::<Result<Vec<_>, _>>()?;
    let change = |b: [f64; 2], c: [f64; 2]| (b[0] - c[0]).abs().max((b[1] - c[1]).abs());
    let settles = change(smooth[0], smooth[1]);
    let forces = instants([2e-3, -1e-3, -5e-3])?;
    let names = ["2 mm ahead", "1 mm behind", "5 mm behind"];
    let nodal = forces.iter().zip(names).map(|(points, name)| {
        let points = points.iter().map(|[x, p]| [1e3 * x, 1e-6 * p]).collect();
        curve(Source::Method, format!("middle of the hole {name}"), points)
    });
    let most = forces.iter().map(|points| patches(points)).max().unwrap_or_default();
    Ok(Figure {
        item: "A 13–14",
        title: "Force and nodal forces over a sharp hole of 5 mm",
        status: Status::NotStated,
        parameters: "Hole of 5 mm; its depth, 0.1 mm, 50 and 150 km/h and the instants are assumed. The thesis's method with 5e-5 s and α₁ = 1e-4 s, ours without damping in steps of 5 µs.",
        finding: format!(
            "At 100 km/h the hole passes in 0.54 ms, 11 steps of the thesis. Without damping the force goes from \
             {:.3} to {:.3} of the load, of which {settles:.4} change with half the step. The thesis's method on a mesh of its size finds {:.3} to {:.3}.",
            smooth[1][0], smooth[1][1], theirs[1][0], theirs[1][1]
        ),
        plots: vec![
            Plot { axes: ["way from the middle of the hole in mm".into(), "force over load".into()], curves },
            Plot { axes: ["place in mm".into(), "nodal force over length in MPa".into()], curves: nodal.collect() },
        ],
        values: [
            ("a13.least", smooth[1][0]),
            ("a13.largest", smooth[1][1]),
            ("a13.method.least", theirs[1][0]),
            ("a13.method.largest", theirs[1][1]),
        ]
        .map(|(name, value)| (name.into(), value))
        .into(),
        predicates: vec![
            must(format!("undamped, half the step changes less than 0.01 of the load: {settles:.4}"), settles < 0.01),
            must(
                format!(
                    "undamped, twice as fine elements and contact nodes change less than 0.03 of it: {:.4}",
                    change(smooth[0], smooth[2])
                ),
                change(smooth[0], smooth[2]) < 0.03,
            ),
            must(format!("local loss of contact: {most} parts by the thesis's method"), most == 2),
        ],
    })
}

/// Paper B's load [N/m] and velocity [m/s].
const B: [f64; 2] = [10e3, 50.0 / 3.6];

/// Way \[m] and force [N/m].
type Points = Vec<[f64; 2]>;

/// Place of Paper B's hole, its length and depth \[m]; the depth is assumed. Time that is looked at \[s].
const SMALL: [f64; 3] = [1e-3, 0.2e-3, 20e-6];
const DURATION: f64 = 2.5e-4;

/// The product over that hole: force over the way, largest number of patches, pressure at four instants.
fn over_small(step: f64, length: f64, depth: f64) -> Result<(Points, u64, Vec<Curve>), String> {
    let product = Product::with("paper_b", |config| {
        config.thermal.enabled = false;
        config.tuning.tolerance = 0.0;
        config.rail.profile = hole(SMALL[0], length, depth);
    })?;
    let mut run = product.rolling(B[1], 0.0, |_| ())?;
    let (mut points, mut patches, mut shots) = (Vec::new(), 0, Vec::new());
    for k in 0..(DURATION / step).round() as usize {
        run.advance(step)?;
        points.push([run.outputs().wheel_distance, run.outputs().contact_force_y]);
        patches = patches.max(run.outputs().contact_patches);
        let time = (k as f64 + 1.0) * step;
        for instant in [50e-6, 66e-6, 78e-6, 100e-6] {
            if (time - instant).abs() < 0.4 * step {
                shots.push(curve(Source::Ours, format!("{:.0} µs", 1e6 * instant), pressure(&run)));
            }
        }
    }
    Ok((points, patches, shots))
}

/// Smallest and largest force over the load on another hole.
struct Other {
    length: f64,
    depth: f64,
    force: [f64; 2],
}

/// Shallower, deeper and shorter holes in steps of 1 µs, and how far the force on those deeper than the wheel reaches
/// into the hole, from 50 nm on, differs from the one given.
fn assumed(force: [f64; 2]) -> Result<(Vec<Other>, f64), String> {
    let shallow = [10e-9, 12e-9, 15e-9, 20e-9, 30e-9, 50e-9, 1e-6, 0.2e-3].map(|depth| [SMALL[1], depth]);
    let short = [0.1e-3, 0.12e-3, 0.15e-3].map(|length| [length, SMALL[2]]);
    let other = |[length, depth]: &[f64; 2]| {
        let force = extremes(&over_small(1e-6, *length, *depth)?.0, B[0]);
        Ok(Other { length: *length, depth: *depth, force })
    };
    let all = shallow.iter().chain(&short).map(other).collect::<Result<Vec<_>, String>>()?;
    let change = |other: &Other| (0..2).fold(0.0_f64, |most, i| most.max((other.force[i] - force[i]).abs()));
    let deep = all.iter().filter(|other| other.length == SMALL[1] && other.depth > 4e-8);
    let worst = deep.map(change).fold(0.0, f64::max);
    Ok((all, worst))
}

/// Motion by the thesis's scheme: backward Euler, steps of 1 µs, no damping.
fn small_by_the_thesis() -> Result<Vec<[f64; 2]>, String> {
    let [load, velocity] = B;
    let [wheel, rail] = mesh_heat::meshes(load, mesh_heat::BASE, 2)?;
    let (step, reach) = (1e-6, 2.5 * half_width(load));
    let bodies = Case { annulus: ANNULUS, plate: PLATE, ends: RailEnds::Free, reach, ..case() };
    let theirs = Case { load, velocity, damping: 0.0, step, theta: 1.0, ..bodies };
    let text = hole(SMALL[0], SMALL[1], SMALL[2]);
    a::history(theirs, &a::Meshes { wheel, rail }, &text, (DURATION / step).round() as usize)
}

/// Figures B 18 and 19: a hole of 0.2 mm under a rolling wheel without friction.
pub fn small() -> Result<Figure, String> {
    let [load, velocity] = B;
    let (length, a) = (SMALL[1], half_width(load));
    let [_, stated, depth] = SMALL;
    let ((coarse, ..), (points, patches, shots)) = (over_small(1e-6, stated, depth)?, over_small(5e-7, stated, depth)?);
    let (others, deep) = assumed(extremes(&coarse, load))?;
    let both = others.iter().any(|other| other.force[0] > 0.985 && other.force[1] > 1.005);
    let method = small_by_the_thesis()?;
    let (ours, first, own) = (extremes(&points, load), extremes(&coarse, load), extremes(&method, load));
    let settles = (ours[0] - first[0]).abs().max((ours[1] - first[1]).abs());
    let passage = (length + 2.0 * a) / velocity;
    let shown = |points: &[[f64; 2]]| points.iter().map(|[way, f]| [1e6 * way / velocity, 1e-3 * f]).collect();
    let kilo = |force: [f64; 2]| force.map(|share| format!("{:.3}", 1e-3 * load * share)).join(" to ");
    let row = |o: &Other| format!("{:.2} mm by {} nm {}", 1e3 * o.length, (1e9 * o.depth).round(), kilo(o.force));
    let list: Vec<String> = others.iter().map(row).collect();
    Ok(Figure {
        item: "B 18–19",
        title: "Pressure and force over a sharp hole of 0.2 mm",
        status: Status::Qualitative,
        parameters: "Base of Paper B, 50 km/h, no friction, no damping, hole of 0.2 mm; depth, 20 µm, and instants are assumed; steps of 0.5 µs (thesis \
                     1 µs, as its own method here, backward Euler). No heat.",
        finding: format!(
            "{:.3} to {:.3} kN/m in ours, {:.3} to {:.3} by the thesis's method with linear triangles; the lowest tick at hand of the figure's axis is 9.85, \
             the highest 10.1 kN. No depth or length of the hole gives both: {}. Depths from 50 nm on are without bottom for so small a contact. An axis that ends with its \
             curve would end at 10.05 where the force stays above 9.85; so lower ticks are missing from the text at hand, or the two ticks belong to no one curve. \
             The hole passes in {:.0} µs and splits the contact in {patches}.",
            1e-3 * load * ours[0],
            1e-3 * load * ours[1],
            1e-3 * load * own[0],
            1e-3 * load * own[1],
            list.join(", "),
            1e6 * passage
        ),
        plots: vec![
            Plot { axes: ["place in mm".into(), "pressure in MPa".into()], curves: shots },
            Plot {
                axes: ["time in µs".into(), "force in kN/m".into()],
                curves: vec![
                    curve(Source::Ours, "ours", shown(&points)),
                    curve(Source::Method, "thesis's method", shown(&method)),
                    curve(
                        Source::Quoted,
                        "ends of the axis",
                        vec![[0.0, 9.85], [250.0, 9.85], [250.0, 10.1], [0.0, 10.1]],
                    ),
                ],
            },
        ],
        values: vec![
            ("b19.least".into(), load * ours[0]),
            ("b19.largest".into(), load * ours[1]),
            ("b19.method.least".into(), load * own[0]),
            ("b19.method.largest".into(), load * own[1]),
            ("b19.passage".into(), passage),
        ],
        predicates: vec![
            must(format!("largest force within the axis of the figure: {:.4}", ours[1]), ours[1] < 1.01),
            must(format!("half the step changes less than 0.002 of the load: {settles:.5}"), settles < 2e-3),
            must("the contact is split in two", patches == 2),
            must(format!("depths from 50 nm on change less than 2e-4 of the load: {deep:.1e}"), deep < 2e-4),
            must("no other depth or length keeps the force above 9.85 and takes it beyond 10.05 kN/m", !both),
            must("the force falls over the hole and rises behind it", ours[0] < 0.998 && ours[1] > 1.0005),
            must(
                format!("the thesis's method falls as far within 30 %: {:.3}", (1.0 - own[0]) / (1.0 - ours[0])),
                ((1.0 - own[0]) / (1.0 - ours[0]) - 1.0).abs() < 0.3,
            ),
        ],
    })
}

/// Pressure in MPa over the place in mm.
fn pressure(run: &Run) -> Vec<[f64; 2]> {
    let pressure = &run.traction().pressure;
    pressure.x.iter().zip(&pressure.value).map(|(x, p)| [1e3 * x, 1e-6 * p]).collect()
}
