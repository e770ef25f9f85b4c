//! Parabolas over the place in a layer, from −1 at its upper end to 1 at its lower one.

use crate::heat::melting::Melting;
use crate::heat::tensor::mesh::depth_modes::quadratic;

/// Ends of the sections of a layer in which the steel is solid, mushy or molten, and their number.
pub fn sections(melting: &Melting, [a, b, c]: [f64; 3]) -> ([f64; 6], usize) {
    let (mut ends, mut count) = ([-1.0; 6], 1);
    let (square, slope) = (0.5 * (a + c) - b, 0.5 * (c - a));
    for limit in [melting.solidus, melting.liquidus] {
        let constant = b - limit;
        let root = slope * slope - 4.0 * square * constant;
        if root <= 0.0 {
            continue;
        }
        // Both roots without cancellation; one that is no number is not within the layer.
        let sum = -0.5 * (slope + root.sqrt().copysign(slope));
        for place in [sum / square, constant / sum] {
            if place > -1.0 && place < 1.0 {
                ends[count] = place;
                count += 1;
            }
        }
    }
    ends[1..count].sort_unstable_by(f64::total_cmp);
    ends[count] = 1.0;
    (ends, count + 1)
}

/// A point of a quadrature.
pub struct QuadraturePoint {
    /// Place in the layer from −1 to 1.
    pub place: f64,
    /// Weight of the point.
    pub weight: f64,
}

/// Gauss's four points on an interval: exact up to the seventh power.
pub fn points(from: f64, to: f64) -> impl Iterator<Item = QuadraturePoint> {
    const INNER: (f64, f64) = (0.339_981_043_584_856_26, 0.652_145_154_862_546_1);
    const OUTER: (f64, f64) = (0.861_136_311_594_052_6, 0.347_854_845_137_453_85);
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    [(-OUTER.0, OUTER.1), (-INNER.0, INNER.1), INNER, OUTER]
        .into_iter()
        .map(move |(x, weight)| QuadraturePoint { place: middle + half * x, weight: half * weight })
}

/// Value at the place `x` of the parabola through the values of the three nodes.
pub fn parabola(values: [f64; 3], x: f64) -> f64 {
    quadratic(x).iter().zip(values).map(|(n, value)| n * value).sum()
}

/// Value of the polynomial `a + b x + c x²`.
pub fn polynomial([a, b, c]: &[f64; 3], x: f64) -> f64 {
    a + x * (b + x * c)
}

/// Adds `volume` times the products of the shapes of an element to a symmetric band.
pub fn add_products(band: &mut [[f64; 3]], volume: f64, shape: [f64; 3]) {
    for i in 0..3 {
        for j in i..3 {
            band[i][j - i] += volume * shape[i] * shape[j];
        }
    }
}
