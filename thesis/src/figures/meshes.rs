//! The meshes that the thesis shows: Paper A figure 4, Paper B figures 4 and 10, Paper C figure 4, Paper D figure 4.

use super::annulus;
use super::corrugation::standard;
use super::mesh_heat::{self, ANNULUS, BASE, PLATE, half_width};
use super::{Figure, must};
use crate::annulus::{INNER, OUTER};
use crate::mesh::Mesh;
use crate::paper_a;
use crate::plot::{Curve, GAP, Plot, Source};
use crate::quoted::Status;
use crate::wheel::{self, Annulus};
use std::f64::consts::PI;

/// A rectangle \[m]: from its left lower corner to its right upper one.
type Window = [[f64; 2]; 2];

/// Edges of a mesh that is shifted upward by `up` \[m], within a window, in millimetres; those shorter than `shortest`
/// \[m] would not be seen.
fn edges(mesh: &Mesh, up: f64, [low, high]: Window, shortest: f64) -> Vec<[f64; 2]> {
    let place = |node: usize| [mesh.nodes[node][0], mesh.nodes[node][1] + up];
    let within = |[x, y]: [f64; 2]| (low[0]..=high[0]).contains(&x) && (low[1]..=high[1]).contains(&y);
    let seen = |(a, b): &(usize, usize)| {
        let (a, b) = (place(*a), place(*b));
        within(a) && within(b) && (a[0] - b[0]).hypot(a[1] - b[1]) > shortest
    };
    let line = |(a, b): (usize, usize)| [place(a).map(|x| 1e3 * x), place(b).map(|x| 1e3 * x), GAP];
    mesh.edge_counts().into_keys().filter(seen).flat_map(line).collect()
}

/// A view of bodies, each with its shift upward \[m].
fn view(bodies: &[(&Mesh, f64)], window: Window) -> Plot {
    let shortest = 1e-3 * (window[1][0] - window[0][0]);
    let points = bodies.iter().flat_map(|(mesh, up)| edges(mesh, *up, window, shortest)).collect();
    Plot {
        axes: ["place in mm".into(), "height in mm".into()],
        curves: vec![Curve { source: Source::Mesh, name: String::new(), points }],
    }
}

/// Edges of the tread within a width \[m] about the contact.
fn across(mesh: &Mesh, annulus: Annulus, width: f64) -> usize {
    let (tread, _) = wheel::rims(mesh, annulus);
    let below = |n: &&usize| mesh.nodes[**n][1] < 0.0 && mesh.nodes[**n][0].abs() <= 0.5 * width;
    tread.iter().filter(below).count().saturating_sub(1)
}

/// Wheel and rail, and what is to be shown of them.
struct Pair {
    item: &'static str,
    title: &'static str,
    parameters: &'static str,
    /// Beginning of the names of values.
    name: &'static str,
    annulus: Annulus,
    meshes: [Mesh; 2],
    /// Half of the contact after Hertz \[m].
    contact: f64,
    /// Stated numbers of triangles and nodes, and how far they may be off \[1].
    stated: Option<([usize; 2], f64)>,
    /// True if the wheel's middles of edges are nodes, too.
    quadratic: bool,
    /// True if its centre of gravity was corrected.
    centred: bool,
}

impl Pair {
    /// Triangles and nodes of both bodies.
    fn counts(&self) -> [usize; 2] {
        let [wheel, rail] = &self.meshes;
        let middles = if self.quadratic { wheel.edge_counts().len() } else { 0 };
        [wheel.triangles.len() + rail.triangles.len(), wheel.nodes.len() + middles + rail.nodes.len()]
    }

    fn figure(self) -> Figure {
        let [triangles, nodes] = self.counts();
        let [wheel, rail] = &self.meshes;
        let (outer, reach) = (self.annulus.outer, 8.0 * self.contact);
        let bodies = [(wheel, outer), (rail, 0.0)];
        let count = across(wheel, self.annulus, 2.0 * self.contact);
        let centre = wheel.centroid();
        let angle = wheel.smallest_angle().min(rail.smallest_angle()).to_degrees();
        let (tread, _) = wheel::rims(wheel, self.annulus);
        let radius = |n: &usize| (wheel.nodes[*n][0].hypot(wheel.nodes[*n][1]) / outer - 1.0).abs();
        let round = tread.iter().map(radius).fold(0.0, f64::max);
        let mut predicates = vec![
            must(
                "no node hangs on an edge and no triangle is turned over",
                wheel.is_conforming() && rail.is_conforming(),
            ),
            must(format!("all nodes of the tread lie on its circle: {round:.1e}"), round < 1e-12),
            must(
                format!("the rail keeps its area: {:.1e}", rail.area() / (PLATE.length * PLATE.height) - 1.0),
                (rail.area() / (PLATE.length * PLATE.height) - 1.0).abs() < 1e-12,
            ),
        ];
        if self.centred {
            let off = centre[0].hypot(centre[1]);
            predicates.push(must(format!("the wheel's centre of gravity is in its axis: {off:.1e} m"), off < 1e-10));
        }
        if let Some(([all, places], off)) = self.stated {
            let near = |found: usize, stated: usize| (found as f64 / stated as f64 - 1.0).abs() < off;
            predicates.push(must(
                format!(
                    "{triangles} triangles and {nodes} nodes, within {:.0} % of the stated {all} and {places}",
                    100.0 * off
                ),
                near(triangles, all) && near(nodes, places),
            ));
        }
        let named = |what: &str, value: usize| (format!("{}.{what}", self.name), value as f64);
        let box_of = |[x, y]: [f64; 2], up: f64| [[-x, y], [x, up]];
        Figure {
            item: self.item,
            title: self.title,
            status: if self.stated.is_some() { Status::Fitted } else { Status::NotStated },
            parameters: self.parameters,
            finding: format!(
                "{triangles} triangles and {nodes} nodes; {count} edges of the tread across the contact; smallest angle {angle:.1}°."
            ),
            plots: vec![
                view(&bodies, box_of([outer.max(0.5 * PLATE.length), -PLATE.height], 2.0 * outer)),
                view(&bodies, box_of([reach, -0.6 * reach], 0.6 * reach)),
            ],
            values: vec![named("triangles", triangles), named("nodes", nodes), named("across", count)],
            predicates,
        }
    }
}

/// Figure A 4.
pub fn paper_a() -> Result<Figure, String> {
    let paper_a::Meshes { wheel, rail } = standard();
    Ok(Pair {
        item: "A 4",
        title: "Mesh of wheel and rail, and the contact",
        parameters: "r 0.46/0.046 m, plate 1 × 0.1 m, n_r = 3, n_nx = 31. Base mesh and radii of refinement are not stated; chosen are those with which all meshes of table A 1 have about their sizes.",
        name: "a4",
        annulus: paper_a::ANNULUS,
        meshes: [wheel, rail],
        contact: 0.5 * paper_a::PATCH,
        stated: Some(([3282, 1757], 0.15)),
        quadratic: false,
        centred: false,
    }
    .figure())
}

/// Wheel and rail of Papers B to D for a load.
fn later(load: f64) -> Result<Pair, String> {
    Ok(Pair {
        item: "",
        title: "Mesh of wheel and rail, and the contact",
        parameters: "r 0.5/0.05 m, plate 1 × 0.1 m, P = 10 kN/m, two refinements of the whole wheel. Base mesh and radii of refinement are not stated and chosen for \
                     the number of triangles.",
        name: "",
        annulus: ANNULUS,
        meshes: mesh_heat::meshes(load, BASE, 2)?,
        contact: half_width(load),
        stated: Some(([8017, 12608], 0.05)),
        quadratic: true,
        centred: true,
    })
}

/// Figure B 10.
pub fn paper_b() -> Result<Figure, String> {
    Ok(Pair { item: "B 10", name: "b10", ..later(10e3)? }.figure())
}

/// Figure C 4: the mesh of Paper B, its contact at a smaller scale.
pub fn paper_c() -> Result<Figure, String> {
    let pair = later(10e3)?;
    let (bodies, reach) = ([(pair.meshes[0].clone(), OUTER), (pair.meshes[1].clone(), 0.0)], 2.5 * pair.contact);
    let mut figure =
        Pair { item: "C 4", name: "c4", title: "Mesh of Paper C, that of figure B 10: the contact", ..pair }.figure();
    let bodies: Vec<(&Mesh, f64)> = bodies.iter().map(|(mesh, up)| (mesh, *up)).collect();
    figure.plots = vec![view(&bodies, [[-reach, -0.6 * reach], [reach, 0.6 * reach]])];
    Ok(figure)
}

/// Figure D 4.
pub fn paper_d() -> Result<Figure, String> {
    let parameters =
        "As figure B 10, for P = 100 kN/m, whose contact is wider. Numbers of triangles and nodes are not stated.";
    Ok(Pair { item: "D 4", name: "d4", parameters, stated: None, ..later(100e3)? }.figure())
}

/// Figure B 4: the annulus.
pub fn ring() -> Result<Figure, String> {
    let mesh = annulus::shown();
    let area = mesh.area() / (PI * (OUTER * OUTER - INNER * INNER)) - 1.0;
    let angle = mesh.smallest_angle().to_degrees();
    Ok(Figure {
        item: "B 4",
        title: "Mesh of the annulus",
        status: Status::NotStated,
        parameters: "r 0.5/0.05 m; the thesis's mesh is deliberately unstructured and its number of triangles not stated.",
        finding: format!("{} triangles, {} nodes, smallest angle {angle:.1}°.", mesh.triangles.len(), mesh.nodes.len()),
        plots: vec![view(&[(&mesh, 0.0)], [[-OUTER; 2], [OUTER; 2]].map(|corner| corner.map(|x| 1.001 * x)))],
        values: vec![("b4.triangles".into(), mesh.triangles.len() as f64)],
        predicates: vec![
            must("no node hangs on an edge and no triangle is turned over", mesh.is_conforming()),
            must(format!("its polygons have the area of the annulus within 1 %: {area:+.1e}"), area.abs() < 0.01),
            must(format!("no angle below 20°: {angle:.1}°"), angle > 20.0),
        ],
    })
}
