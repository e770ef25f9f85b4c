//! The FMU as an archive: `documentation` and `pages` (HTML), `references` (what else is in it), `platform` (for which
//! machines), and `package`, which zips it. The library inside an FMU needs none of this.

pub mod documentation;
pub mod error;
pub mod package;
pub mod pages;
pub mod platform;
mod references;
