//! The repository: the plan of its source, its documents, its program and what it packs.

#[path = "../common/mod.rs"]
mod common;
#[path = "../source_map/mod.rs"]
mod source_map;

mod architecture;
mod basis_code;
mod documents;
mod files;
