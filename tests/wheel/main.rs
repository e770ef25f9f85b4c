//! The whole wheel on its rail: driving, braking, sliding, striking; steel that yields and wears.

#[path = "../common/mod.rs"]
mod common;

mod body_fields;
mod bounce;
mod brake;
mod corrugation;
mod damping;
mod damping_rolling;
mod drag_braking;
mod energy;
mod energy_in_the_air;
mod flat;
mod flat_impulse;
mod flat_strike;
mod impulse;
mod lock_up;
mod locked_wheels;
mod many_wheels;
mod onset_of_yielding;
mod profile_texts;
mod profiles;
mod properties;
mod rail_ends;
mod random_parameters;
mod reduced_equals_full;
mod robustness;
mod rough_rail;
mod round_off;
mod sheared_steel;
mod start;
mod step_control;
mod stick_slip;
mod stored_bases;
mod track_inputs;
mod track_support;
mod tread_outputs;
mod validity;
mod wear;
mod yielding;
