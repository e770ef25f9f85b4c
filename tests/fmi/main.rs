//! The interface: its table of variables, and the compiled library as masters use it.

#[path = "../common/mod.rs"]
mod common;
#[path = "../slave/mod.rs"]
mod slave;
#[path = "../slave3/mod.rs"]
mod slave3;

mod abuse;
mod default_values;
mod derivatives_everything_varying;
mod fmi3_intermediate;
mod fmi3_lifecycle;
mod fmi_brake;
mod fmi_derivatives;
mod fmi_initialization;
mod fmi_library;
mod fmi_lifecycle;
mod fmi_logging;
mod fmi_notices;
mod fmi_shell;
mod fmi_start_values;
mod fmi_state;
mod fmi_threads;
mod limited_steps;
mod model_description;
mod output_texts;
mod sensitivity;
mod shared_models;
