//! Sources of heat beside friction: what the inputs and the brake bring into the wheel, and where.

use crate::config::Config;
use crate::damage::Criteria;
use crate::heat::HeatSource;
use crate::rolling::control::Drive;

/// Givers of the heat in a step.
#[derive(Clone, Copy, Debug)]
pub struct HeatSupply<'a> {
    /// Inputs at its end.
    pub drive: &'a Drive,
    /// Mean power of the brake in it, per metre of the wheel's width [W/m].
    pub brake_power: f64,
    /// Width of the patch at the nominal load over that of the contact \[1].
    pub narrowing: f64,
}

/// All sources of heat beside friction: one field and one line of [`HeatSources::list`] each.
#[derive(Clone, Debug)]
pub struct HeatSources {
    blocks: BrakeBlocks,
    /// Width of the patch at the nominal load, over which the heat of the whole wheel spreads \[m].
    width: f64,
}

/// A heat step beside the mechanical one.
#[derive(Clone, Copy, Debug)]
pub struct HeatStep<'a> {
    /// Length of the step \[s].
    pub dt: f64,
    /// True if another internal step follows before a communication point.
    pub interim: bool,
    /// Givers of heat beside friction.
    pub supply: HeatSupply<'a>,
    /// Limits that decide about the structure of the steel.
    pub criteria: Criteria,
}

impl HeatSources {
    /// Sources for the parameters.
    pub fn new(config: &Config) -> Self {
        Self { blocks: BrakeBlocks::new(config), width: config.nominal_patch().width }
    }

    /// Replaces `out` by all sources that bring heat.
    pub fn list(&self, supply: HeatSupply, out: &mut Vec<HeatSource>) {
        out.clear();
        self.blocks.list(supply, out);
        out.retain(|source| source.heat != 0.0);
        out.iter_mut().for_each(|source| source.heat = supply.narrowing * source.heat / self.width);
    }
}

/// Brake blocks on the tread, heated by `drive.tread_heat` and a share of the power of the brake.
#[derive(Clone, Debug)]
struct BrakeBlocks {
    /// Angle of the leading one from the contact point, arc of each \[rad].
    angle: f64,
    arc: f64,
    /// One, or two mirrored ones that share the heat.
    sides: &'static [f64],
    /// Share of the power of the brake \[1].
    share: f64,
    /// Width of the wheel \[m].
    width: f64,
}

impl BrakeBlocks {
    fn new(config: &Config) -> Self {
        let thermal = &config.thermal;
        Self {
            angle: thermal.tread_angle,
            arc: thermal.tread_width,
            sides: if thermal.tread_blocks == 2 { &[1.0, -1.0] } else { &[1.0] },
            share: config.brake.tread_share,
            width: config.width(),
        }
    }

    /// Appends every block with its heat \[W].
    fn list(&self, supply: HeatSupply, out: &mut Vec<HeatSource>) {
        let heat = supply.drive.tread_heat + self.share * supply.brake_power * self.width;
        let share = heat / self.sides.len() as f64;
        out.extend(self.sides.iter().map(|side| HeatSource::on_tread(side * self.angle, self.arc, share)));
    }
}
