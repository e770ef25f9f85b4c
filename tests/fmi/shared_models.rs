//! Models are prepared once and shared; computed bases are kept.

use crate::common::*;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use wheelrail::config::Config;
use wheelrail::simulation::{BasisStore, Drive, Inputs, Model, Simulation, basis_file_name};

/// A wheel that is quick to prepare and that no other test uses.
fn coarse(radius: f64) -> Config {
    let mut config = preset("railway", 4);
    config.wheel.radius = radius;
    config
}

/// True if the basis was computed to prepare the model.
fn computed(config: &Config, store: &BasisStore) -> (Arc<Model>, bool) {
    let mut heard = false;
    let model = Model::prepare(config.clone(), store, &mut |what, _| heard |= what.contains("modes")).unwrap();
    (model, heard)
}

struct Directory(PathBuf);

impl Directory {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("wheelrail {name} {}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).unwrap();
    }
}

#[test]
fn equal_parameters_share_one_model_as_long_as_somebody_uses_it() {
    let prepare = |config: Config| {
        let mut heard = 0;
        (Model::shared(config, &BasisStore::none(), &mut |_, _| heard += 1).unwrap(), heard)
    };
    let (first, work) = prepare(coarse(0.43));
    assert!(work > 0);
    let (second, work) = prepare(coarse(0.43));
    assert!(Arc::ptr_eq(&first, &second) && work == 0);
    let (other, work) = prepare(coarse(0.44));
    assert!(!Arc::ptr_eq(&first, &other) && work > 0);
    let gone = Arc::downgrade(&first);
    drop((first, second));
    assert!(gone.upgrade().is_none(), "the registry keeps nothing alive");
    assert!(prepare(coarse(0.43)).1 > 0);
}

/// Two profiles of one name: the file has been changed between two wheels, or names begin in different folders.
#[test]
fn profiles_of_one_name_and_other_content_do_not_share_a_model() {
    let folders = ["one", "other"].map(Directory::new);
    let write = |folder: &Directory, depth: f64| {
        let text = format!("position,height\n1.0,0.0\n1.01,{}\n1.02,0.0\n", -depth);
        fs::write(folder.0.join("shared_models_dip.csv"), text).unwrap();
    };
    folders.iter().zip([1e-4, 2e-4]).for_each(|(folder, depth)| write(folder, depth));
    let [one, other] = folders.each_ref().map(|folder| BasisStore::none().with_packed(Some(&folder.0)));
    let share = |store: &BasisStore| {
        let mut config = coarse(0.425);
        config.wheel.profile = "shared_models_dip.csv".to_owned();
        Model::shared(config, store, &mut |_, _| {}).unwrap()
    };
    let depth = |model: &Arc<Model>| {
        Simulation::new(model.clone(), &Inputs::rolling(model.config())).unwrap().outputs().flat_depth
    };
    let (first, second) = (share(&one), share(&other));
    assert!(Arc::ptr_eq(&first, &share(&one)) && !Arc::ptr_eq(&first, &second));
    assert!(first.is_up_to_date(&one) && !first.is_up_to_date(&other));
    write(&folders[0], 3e-4);
    let third = share(&one);
    assert!(!first.is_up_to_date(&one) && !Arc::ptr_eq(&first, &third));
    let depths = [&first, &second, &third].map(depth);
    println!("depths of flats: {depths:?} m");
    assert!(depths.iter().zip([1e-4, 2e-4, 3e-4]).all(|(found, given)| (found / given - 1.0).abs() < 0.02));
}

#[test]
fn who_asks_for_a_model_in_preparation_waits_for_it() {
    let (preparations, store) = (AtomicUsize::new(0), BasisStore::none());
    let models: Vec<_> = std::thread::scope(|scope| {
        let prepare = || {
            let mut begun = false;
            let mut progress = |_: &str, _: f64| begun = true;
            let model = Model::shared(coarse(0.42), &store, &mut progress).unwrap();
            preparations.fetch_add(usize::from(begun), Ordering::Relaxed);
            model
        };
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(prepare)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(preparations.into_inner(), 1);
    assert!(models.iter().all(|model| Arc::ptr_eq(model, &models[0])));
}

#[test]
fn a_computed_basis_is_kept_and_found_again() {
    let directory = Directory::new("kept");
    let store = BasisStore::within(&directory.0);
    let (config, inputs) = (coarse(0.45), Inputs::rolling(&coarse(0.45)));
    let (model, work) = computed(&config, &store);
    assert!(work && model.not_kept().is_none());
    let first = Simulation::new(model, &inputs).unwrap();
    let (model, work) = computed(&config, &store);
    assert!(!work);
    assert_eq!(Simulation::new(model, &inputs).unwrap().outputs(), first.outputs());
    let packed = BasisStore::none().with_packed(Some(&directory.0));
    assert!(!computed(&config, &packed).1, "the same layout as in an FMU");

    let path = directory.0.join("basis").join(basis_file_name(&config));
    let mut bytes = fs::read(&path).unwrap();
    let at = bytes.len() / 2;
    bytes[at] ^= 1;
    fs::write(&path, &bytes).unwrap();
    let damaged = Model::prepare(config.clone(), &packed, &mut |_, _| {}).err().unwrap().to_string();
    assert!(damaged.contains("corrupt") && damaged.contains(&basis_file_name(&config)), "{damaged}");
    assert!(computed(&config, &store).1, "a damaged file in the cache counts as none");
    assert!(!computed(&config, &store).1, "and is replaced");
    let files: Vec<_> = fs::read_dir(directory.0.join("basis")).unwrap().collect();
    assert_eq!(files.len(), 1, "nothing unfinished is left: {files:?}");
}

#[test]
fn a_place_that_cannot_be_written_is_only_a_remark() {
    let directory = Directory::new("unwritable");
    let file = directory.0.join("file");
    fs::write(&file, "").unwrap();
    let (model, work) = computed(&coarse(0.41), &BasisStore::within(&file));
    let remark = model.not_kept().expect("a remark");
    assert!(work && remark.contains("cannot be kept") && remark.contains("file"), "{remark}");
    let (model, _) = computed(&coarse(0.41), &BasisStore::none());
    assert_eq!(model.not_kept(), None);
}

#[test]
fn a_second_instance_of_the_default_wheel_prepares_nothing() {
    let config = preset("railway", 20);
    let first = Model::shared(config.clone(), &store(), &mut |_, _| {}).unwrap();
    let inputs = Inputs::rolling(&config);
    let one = Simulation::new(first, &inputs).unwrap();
    let second = Model::shared(config, &store(), &mut |what, _| panic!("{what}")).unwrap();
    let two = Simulation::new(second, &inputs).unwrap();
    assert_eq!(one.outputs(), two.outputs());
    assert_eq!(one.state(), two.state());
    let other = Inputs { drive: Drive { load: 9e4, ..inputs.drive }, ..inputs };
    let three = Simulation::new(two.model().clone(), &other).unwrap();
    assert!((three.outputs().contact_force_y / 9e4 - 1.0).abs() < 1e-6);
}
