//! Loads of the sources beside friction, divided among the elements of the wheel's surface.
//!
//! A place of [`HeatPlace`] is the moments of its heat along the streamlines and a value of each mode across them; both
//! stand here and nowhere else.

use crate::heat::error::HeatError;
use crate::heat::exchange::{HeatPlace, HeatSource};
use crate::heat::tensor::mesh::layout::HeatLayout;
use crate::heat::tensor::mesh::streamline::Streamline;
use crate::heat::tensor::solve::transport::{Transport, bearing};
use std::f64::consts::PI;

/// Moments of the heat of all sources, of each kind of place by itself; linear in the data.
#[derive(Clone, Debug, Default)]
pub struct SourceLoads {
    /// `∫ q (1, ξ) ds` on the elements of the tread [W/m]; empty without heat there.
    tread: Vec<[f64; 2]>,
}

impl SourceLoads {
    /// Replaces the loads by those of the given `sources`.
    pub fn set(&mut self, layout: &HeatLayout, sources: &[HeatSource]) -> Result<(), HeatError> {
        self.tread.clear();
        for &HeatSource { place, heat } in sources {
            finite("heat of a source", heat)?;
            match place {
                HeatPlace::Tread { angle, width } => {
                    add_arc(&layout.wheel.streamline, layout.config.radius, [angle, width], heat, &mut self.tread)?
                }
            }
        }
        Ok(())
    }

    /// True without any heat.
    pub fn is_empty(&self) -> bool {
        self.tread.is_empty()
    }

    /// Heat of all sources [W/m].
    pub fn heat(&self) -> f64 {
        self.tread.iter().map(|q| q[0]).sum()
    }

    /// Adds the loads to the field `out` of the wheel; `along` is memory of the size of a streamline.
    pub fn add(&self, layout: &HeatLayout, transport: &Transport, along: &mut [f64], out: &mut [f64]) {
        let wheel = &layout.wheel;
        let mut add = |moments: &[[f64; 2]], modes: &[f64]| {
            if !moments.is_empty() {
                along.fill(0.0);
                for (e, q) in bearing(moments) {
                    transport.add_load(&wheel.streamline, e, q, along);
                }
                wheel.add_load(0, along, modes, out);
            }
        };
        add(&self.tread, &wheel.modes.block);
    }
}

/// Adds the moments of `heat` [W/m] on an arc around the `angle` \[rad] of the `width` \[rad] along a closed streamline of the
/// given `radius` \[m].
fn add_arc(
    streamline: &Streamline,
    radius: f64,
    [angle, width]: [f64; 2],
    heat: f64,
    out: &mut Vec<[f64; 2]>,
) -> Result<(), HeatError> {
    finite("angle of a heat source", angle)?;
    if !(width > 0.0 && width <= 2.0 * PI) {
        return Err(HeatError::Input { name: "width of a heat source", value: width });
    }
    out.resize(streamline.len(), [0.0; 2]);
    let length = width * radius;
    let middle = angle.rem_euclid(2.0 * PI) * radius;
    for (e, h) in streamline.lengths.iter().enumerate() {
        for turn in -2..=1 {
            let start = streamline.nodes[e] - f64::from(turn) * streamline.closed;
            let low = ((middle - 0.5 * length - start) / h).clamp(0.0, 1.0);
            let high = ((middle + 0.5 * length - start) / h).clamp(0.0, 1.0);
            if high > low {
                let part = heat / length * (high - low) * h;
                out[e][0] += part;
                out[e][1] += part * 0.5 * (low + high);
            }
        }
    }
    Ok(())
}

/// Refuses a value that is infinite or not a number.
fn finite(name: &'static str, value: f64) -> Result<(), HeatError> {
    if value.is_finite() { Ok(()) } else { Err(HeatError::Input { name, value }) }
}
