//! The repository: the plan of its source, its documents, its program and what it packs.

#[path = "../common/mod.rs"]
mod common;
#[path = "../source_map/mod.rs"]
mod source_map;

mod architecture;
mod basis_code;
mod command_line;
mod command_signals;
mod documentation;
mod documents;
mod files;
mod package;
