//! The communication step that a master with an explicit exchange may take.

use super::model::RollingModel;
use super::state::State;

/// Share of the limit that is suggested: Jacobi exchange was measured to be stable below 0.19 to 0.33 of `2m/c`
/// (braking from 10 to 1 m/s), Gauss–Seidel below 0.5 to 0.9.
const SAFETY: f64 = 0.15;
/// Suggestion where nothing sets a limit [s].
const LARGEST: f64 = 1.0;
/// Smallest suggestion [s]: near standstill no explicit step is stable.
const SMALLEST: f64 = 1e-6;

/// Largest communication step \[s] for explicit coupling in this state.
///
/// Who prescribes velocities integrates an inertia against the contact, which on the initial slope of Carter's
/// theory is a damper between V and rΩ: `c = 2 F_n r/(a V)`. With the effective mass m of the prescribed motions
/// (the inertias that the parameters give to the wheel; vehicle included in x; sideways, where the damper is about the same, with
/// what moves with the hub) explicit exchange needs `h < 2m/c`
/// and less. Who prescribes the hub height integrates against the contact stiffness, `h < 2√(m/k)`. Forces and
/// moments as inputs leave the stiff motion to this model and set no limit (1 s).
pub fn suggested_step(model: &RollingModel, state: &State) -> f64 {
    let (prescribed, inertia) = (state.hub.prescribed, model.wheel.inertia);
    let radius = model.rolling_radius(state);
    let (load, approach) = (state.resultant().height, state.elevation - state.motion.height.now);
    let compliance = |prescribed: bool, inverse: f64| if prescribed { inverse } else { 0.0 };
    let inverse_mass = compliance(prescribed.travel, 1.0 / inertia.travel)
        + compliance(prescribed.rotation, radius * radius / inertia.rotation);
    let aside = model.wheel.sideways.enabled && prescribed.lateral;
    let inverse_mass = inverse_mass.max(compliance(aside, 1.0 / inertia.lateral));
    let mut suggestion = LARGEST;
    if inverse_mass > 0.0 && load > 0.0 {
        let speed = 0.5 * (state.motion.velocity.now + radius * state.motion.omega.now).abs();
        let inverse_damping = state.half_width() * speed / (2.0 * load * radius);
        suggestion = suggestion.min(SAFETY * 2.0 * inverse_damping / inverse_mass);
    }
    if prescribed.height && load > 0.0 && approach > 0.0 {
        suggestion = suggestion.min(SAFETY * 2.0 * (inertia.height * approach / load).sqrt());
    }
    suggestion.max(SMALLEST)
}
