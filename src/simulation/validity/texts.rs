//! Messages of the limits, with value, bound and what to change.

use super::{FEWEST_PER_WAVE, Limit, NEAR_END, ZONE_LOAD};
use crate::contact::FrictionLaw;
use crate::simulation::Simulation;

/// Smallest `thermal.smallest_load_ratio` that its range allows \[1].
const LEAST_RATIO: f64 = 0.05;

/// Errors of pressure or length, and of the friction force over friction times load, of patches of a half-width of `n` cells,
/// times `n²` \[1]. Measured on lines and ellipses.
const ERRORS_OF_SHORT_PATCHES: [f64; 2] = [0.08, 0.15];
/// Half-width that is read off patches of less than one cell \[cells]: up to here they may be of any size.
const LEAST_CELLS: f64 = 1.1;

impl Simulation {
    /// Message of a limit for the present state, with both numbers and what to change.
    pub fn describe_limit(&self, limit: Limit) -> String {
        let (value, bound) = self.against(limit);
        let bound = bound.number();
        match limit {
            Limit::Speed => speed(value, bound),
            Limit::ThermalLoad => thermal_load(self, value, bound),
            Limit::Patch => patch(value, bound),
            Limit::Zone => zone(value, bound),
            Limit::Reach => reach(self, value, bound),
            Limit::Yield => yielding(value, bound),
            Limit::Softening => softening(value, bound),
            Limit::Melting => melting(self, value, bound),
            Limit::Boiling => boiling(self, value, bound),
            Limit::StickSlip => stick_slip(self, value, bound),
            Limit::Chatter => chatter(self, value, bound),
            Limit::Waves => waves(self, value, bound),
            Limit::Sampling => sampling(self, value),
            Limit::Track => track(value, bound),
            Limit::Energy => energy(self, value),
            Limit::Effort => effort(self, value),
            Limit::Limited => limited(self, value),
            Limit::End => end(self, bound),
        }
    }
}

fn speed(value: f64, bound: f64) -> String {
    format!(
        "speed {value:.1} m/s ({:.0} km/h) is above thermal.max_speed = {bound:.1} m/s: the thermal boundary layer is \
         thinner than the mesh, and temperatures are inexact; raise thermal.max_speed, or check the unit of the speed",
        3.6 * value
    )
}

fn thermal_load(simulation: &Simulation, value: f64, bound: f64) -> String {
    let share = value / simulation.model().config().model.nominal_load;
    // A little less than the load, which the contact carries to round-off.
    let enough = (99.0 * share).floor() / 100.0;
    let advice = if share >= LEAST_RATIO {
        format!("lower thermal.smallest_load_ratio to {:.2} or less", enough.max(LEAST_RATIO))
    } else {
        format!(
            "lower model.nominal_load to the mean load of the run and set drive.load, which follows it unless set; \
             thermal.smallest_load_ratio cannot be below {LEAST_RATIO}"
        )
    };
    format!(
        "contact load {value:.0} N is below thermal.smallest_load_ratio x model.nominal_load = {bound:.0} N: the \
         patch is shorter than the thermal mesh resolves, and temperatures are inexact; {advice}"
    )
}

fn patch(value: f64, bound: f64) -> String {
    let [size, force] = ERRORS_OF_SHORT_PATCHES.map(|error| 1e2 * error / (value * value));
    let errors = if value > LEAST_CELLS {
        format!(
            "pressure and length are inexact by up to {size:.0} %, friction forces by up to {force:.0} % of friction times load"
        )
    } else {
        "pressure, length and friction forces are no more than a hint".into()
    };
    format!(
        "half-width of the patch is {value:.2} cells between contact nodes, fewer than {bound:.0}: {errors}; raise \
         mesh.grid_elements_per_half_width, or lower model.nominal_load and set drive.load"
    )
}

fn zone(value: f64, bound: f64) -> String {
    format!(
        "contact load {value:.0} N is above {ZONE_LOAD:.0} x model.nominal_load = {bound:.0} N, for which the \
         contact zone is laid out: the patch may reach the end of the zone; raise model.nominal_load and set \
         drive.load, which follows it unless set"
    )
}

fn reach(simulation: &Simulation, value: f64, bound: f64) -> String {
    format!(
        "the surfaces touch {:.1} mm from the contact point, and steps in which they touch beyond {:.1} mm are refused: there \
         is no room for a wider flat, patch or hole; set mesh.reach (now {:?} m) to {:.3} m or more",
        1e3 * value,
        1e3 * bound / NEAR_END,
        simulation.model().config().mesh.reach,
        2.0 * value
    )
}

fn yielding(value: f64, bound: f64) -> String {
    format!(
        "peak pressure {:.0} MPa is above {:.0} MPa, the most that steel of material.yield_strength carries: the \
         bodies stay elastic, and patch, forces and temperatures are not those of steel that yields; set physics.yielding, \
         or check drive.load and the size of the patch (model.contact_width, contact.rail_lateral_radius, or \
         contact.rows and contact.rows_load)",
        value * 1e-6,
        bound * 1e-6
    )
}

fn softening(value: f64, bound: f64) -> String {
    format!(
        "steel under the contact is so hot that it would yield at {:.0} MPa, and the patch would outgrow the contact \
         zone; its yield pressure is therefore kept at {:.0} MPa: half-width, pressure and flattening are only rough \
         estimates from here on; end the slide earlier",
        value * 1e-6,
        bound * 1e-6
    )
}

fn melting(simulation: &Simulation, value: f64, bound: f64) -> String {
    let config = simulation.model().config();
    let why = if config.material.latent_heat > 0.0 {
        config.told(
            "{thermal.reference now} is above it, too, so that nothing melts, and temperatures are too high; lower it",
        )
    } else {
        "nothing melts without material.latent_heat, and temperatures are too high from here on; set it".into()
    };
    format!(
        "contact temperature {value:.0} K is above material.solidus = {bound:.0} K: {why}, end the slide earlier, or let the \
         friction fall with friction.softening or friction.falling_ratio"
    )
}

fn boiling(simulation: &Simulation, value: f64, bound: f64) -> String {
    simulation.model().config().told(&format!(
        "wheel or rail has been at {value:.0} K, above {bound:.0} K, where iron boils: there is no such steel, and temperatures, \
         friction and what follows from them are meaningless from here on; check {{material.film_friction now}} (1: molten steel \
         rubs as solid steel does) and {{material.latent_heat now}} (0: nothing melts), rail.friction, drive.tread_heat and \
         {{thermal.wheel_excess now}}, or end the slide earlier"
    ))
}

fn stick_slip(simulation: &Simulation, value: f64, bound: f64) -> String {
    format!(
        "friction falls with the slip of a sliding wheel, and the phase of its torsional vibration of {:.0} rad/s \
         advances by {value:.2} rad in an internal step, more than {bound:.1}: the time formula damps stick-slip that \
         may arise; lower solver.max_step to {:.1e} s to see it",
        simulation.model().rolling.torsion.frequency,
        0.9 * bound / simulation.model().rolling.torsion.frequency
    )
}

fn chatter(simulation: &Simulation, value: f64, bound: f64) -> String {
    format!(
        "friction falls with the slip so steeply that in internal steps below about {:.1} us, now {:.1} us, several \
         coefficients are possible and friction may jump from step to step; set friction.memory_length (now {:?} m) to {:?} m",
        1e6 * bound,
        1e6 * value,
        simulation.tuning().memory_length,
        FrictionLaw::MEMORY
    )
}

fn waves(simulation: &Simulation, value: f64, bound: f64) -> String {
    format!(
        "wheel.profile or rail.profile has waves of {:.2} mm here, shorter than {FEWEST_PER_WAVE:.0} elements of the \
         contact, {:.2} mm: forces are inexact, over a hole of half that length by up to {:.2} % of the load; raise \
         mesh.grid_elements_per_half_width, or leave out such waves: the patch evens them out",
        1e3 * value,
        1e3 * bound,
        1e2 * simulation.error_over_a_hole(0.5 * value)
    )
}

fn sampling(simulation: &Simulation, value: f64) -> String {
    let [mean, last] = simulation.strides();
    let share = value / simulation.nominal_approach();
    let off =
        if share < 1.0 { format!("by up to {:.0} % of the load", 1e2 * share) } else { "by the load and more".into() };
    format!(
        "the wheel travels {:.2} mm in an internal step, more than a quarter, {:.2} mm, of the shortest wave of \
         wheel.profile and rail.profile here, and passes over their height: forces are inexact {off}; lower solver.max_step, \
         or set it to 0, so that the profile determines it",
        1e3 * mean.max(last),
        1e3 * simulation.shortest_wave() / FEWEST_PER_WAVE
    )
}

fn track(value: f64, bound: f64) -> String {
    format!(
        "rail.elevation changes between communication points as no smooth track does: its corners hit the wheel with some \
         {value:.0} N (more than {bound:.0} N), and these blows add up if they come at a natural frequency of the wheel; give \
         rail.elevation_rate, or take communication steps of a thirtieth of the shortest wave of the track"
    )
}

fn energy(simulation: &Simulation, value: f64) -> String {
    let (missing, force) = simulation.missing_energy();
    let load = simulation.model().config().model.nominal_load;
    let stays = match simulation.model().config().damping.is_none() {
        true => {
            ": the error of the force becomes smaller, but without damping of the modes (damping.rail and the like) waves of \
             high frequency lose their energy in steps of any length"
        }
        false => "",
    };
    let off = if force < load { format!("at most {force:.3e} N") } else { "as much as the nominal load".into() };
    format!(
        "{:.1} % of the energy that has been dissipated or is stored is missing (solver.energy_residual), {missing:.3} J: the \
         contact is made, lost or loaded faster than internal steps of {:.1e} s can follow, or the model is not made for \
         this load and these parameters; the contact force is inexact, too, by {off} while the wheel stays on the \
         rail, and impacts after a flight come at inexact times; lower solver.tolerance (now {:?}) or \
         solver.max_step (now {:?} s){stays}",
        1e2 * value,
        simulation.state().clock.last_step,
        simulation.tuning().tolerance,
        simulation.tuning().max_step
    )
}

fn effort(simulation: &Simulation, value: f64) -> String {
    format!(
        "the last communication step took {value:.0} internal steps, the last one of {:.1e} s, and such steps take long to \
         compute: the contact changes fast, or solver.tolerance (now {:?}) or solver.max_step (now {:?} s) requires them",
        simulation.state().clock.last_step,
        simulation.tuning().tolerance,
        simulation.tuning().max_step
    )
}

fn limited(simulation: &Simulation, value: f64) -> String {
    format!(
        "the errors of {value:.0} of {} internal steps of the last communication step exceed solver.tolerance = {:?}, because \
         solver.max_internal_steps = {} allows no shorter ones (solver.limited_steps): what happens here, as when wheels \
         lock or lift off, is less exact; raise solver.max_internal_steps",
        simulation.outputs().internal_steps,
        simulation.tuning().tolerance,
        simulation.tuning().max_internal_steps
    )
}

fn end(simulation: &Simulation, bound: f64) -> String {
    let rail = &simulation.model().rolling.contact.surfaces.rail;
    let at = if simulation.outputs().wheel_velocity >= 0.0 { bound } else { -bound };
    let mut samples = rail.sample_ends().filter(|ends| ends.contains(&at));
    let [first, last] = samples.next().unwrap_or([at; 2]);
    format!(
        "the contact, at {:.3} m, has passed the last sample of rail.profile at {at:.3} m, behind which the rail keeps its last \
         height; samples lie from {first:.3} to {last:.3} m, and the run begins at 0: move them by file(\"...\", position = metres), \
         repeat them with file(\"...\", every = length), or give a longer file",
        simulation.outputs().wheel_distance
    )
}
