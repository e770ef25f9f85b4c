//! Temperatures: closed forms, bounds, what heat does to steel and to the contact.

#[path = "../common/mod.rs"]
mod common;
#[path = "../heat_common/mod.rs"]
mod heat_common;

mod depth_temperatures;
mod heat_closed_forms;
mod heat_lateral;
mod heat_lines;
mod heat_steady;
mod heat_steps;
mod heat_transient;
mod hot_steel;
mod material_history;
mod melting;
mod molten_film;
mod reversible_heating;
mod second_heat_model;
mod temperature_bounds;
mod temperature_sources;
mod thermal_coupling;
mod thermoelastic_growth;
mod uniform_start;
mod width_of_conduction;
