//! Stored bases that were damaged.

use crate::common::{Random, preset};
use std::fs;
use std::path::Path;
use wheelrail::simulation::{BasisStore, Model, basis_file_name};

/// Single bits anywhere in the file, header and checksum among them, several bits, and cuts.
#[test]
fn a_damaged_basis_is_computed_again_where_it_may_be_and_refused_where_it_was_packed() {
    let config = preset("paper_d", 4);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("target").join(format!("damaged {}", std::process::id()));
    let (kept, packed) = (BasisStore::within(&root), BasisStore::none().with_packed(Some(&root)));
    let file = root.join("basis").join(basis_file_name(&config));
    drop(Model::shared(config.clone(), &kept, &mut |_, _| {}).unwrap());
    let whole = fs::read(&file).unwrap();
    assert!(kept.find(&config).unwrap().is_some() && packed.find(&config).unwrap().is_some());
    let mut random = Random(9);
    let mut last = Vec::new();
    for round in 0..600 {
        let mut bytes = whole.clone();
        let end = if round % 4 == 0 { 32 } else { bytes.len() };
        match round % 6 {
            5 => bytes.truncate(random.below(end)),
            several => (0..=several / 4).for_each(|_| bytes[random.below(end)] ^= 1 << random.below(8)),
        }
        if bytes != whole {
            fs::write(&file, &bytes).unwrap();
            assert!(kept.find(&config).unwrap().is_none(), "round {round}");
            assert!(packed.find(&config).is_err(), "round {round}");
            last = bytes;
        }
    }
    // Another basis under this name.
    let mut other = config.clone();
    other.material.density *= 1.01;
    drop(Model::shared(other.clone(), &kept, &mut |_, _| {}).unwrap());
    fs::copy(root.join("basis").join(basis_file_name(&other)), &file).unwrap();
    assert!(kept.find(&config).unwrap().is_none() && packed.find(&config).unwrap().is_none());
    fs::write(&file, &last).unwrap();
    drop(Model::shared(config.clone(), &kept, &mut |_, _| {}).unwrap());
    let again = fs::read(&file).unwrap();
    fs::remove_dir_all(&root).unwrap();
    assert_eq!(again, whole);
}
