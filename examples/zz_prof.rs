use std::time::Instant;
use wheelrail::config::{Config, ContactMethod};
use wheelrail::simulation::{BasisStore, Inputs, Model, Simulation};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let contact = match args[1].as_str() {
        "grid" => ContactMethod::Grid,
        "auto" => ContactMethod::Auto,
        _ => ContactMethod::Patch,
    };
    let heat = args[2] == "heat";
    let batches: usize = args[3].parse().unwrap();
    let store = BasisStore::within(&std::env::temp_dir().join("wheelrail-patchprof"));
    let mut config = Config::default();
    config.thermal.enabled = heat;
    config.solver.contact = contact;
    let model = Model::prepare(config, &store, &mut |_, _| {}).expect("model");
    if let Some((_, bytes)) = model.basis_file() {
        store.keep(model.config(), &bytes).ok();
    }
    let mut inputs = Inputs::rolling(model.config());
    let mut simulation = Simulation::new(model, &inputs).expect("start");
    inputs.drive.moment = -7000.0;
    for _ in 0..20 {
        simulation.advance(&inputs, 1e-3).expect("step");
    }
    let mut best = f64::INFINITY;
    for b in 0..batches {
        if args.len() > 4 {
            inputs.drive.moment = -7000.0 - 10.0 * ((b % 20) as f64);
        }
        let start = Instant::now();
        for _ in 0..50 {
            simulation.advance(&inputs, 1e-3).expect("step");
        }
        best = best.min(start.elapsed().as_secs_f64() / 50.0);
    }
    let patch = format!("{:?}", simulation.state().contact.solver).starts_with("Patch");
    println!(
        "{:?} {} {:.2} us, on patch {}, F {:.9e}",
        args[1],
        args[2],
        best * 1e6,
        patch,
        simulation.outputs().contact_force_x
    );
}
