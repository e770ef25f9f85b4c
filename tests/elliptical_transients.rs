//! Shift, rolling under a held force and falling friction of the elliptical patch on lines side by side between two
//! half-spaces, against CONTACT.

mod half_spaces;

use half_spaces::{FRICTION, HalfSpaces, LOAD, Lines, SPEED, formula, number, numbers, reference, run_of_reference};
use wheelrail::contact::{AxisDrive, Friction, FrictionLaw, Heating, RigidMotion, SlipDependence};
use wheelrail::multistep::TimeDerivative;

fn shifted(spaces: &HalfSpaces, until: f64, steps: usize) -> (Lines, Vec<[f64; 2]>) {
    let mut state = spaces.solve((LOAD, LOAD), spaces.held(0.0).map(|_| RigidMotion::held(0.0, 0.0)), (formula(1.0, true), Friction::constant(FRICTION)), &spaces.start_at_rest()).unwrap();
    let mut shift = 0.0;
    let mut all = Vec::new();
    for k in 1..=steps {
        let share = until * k as f64 / steps as f64;
        let [mut v, _] = spaces.driven(share, 0.0);
        v.guess = -1e-6;
        state = spaces.solve((LOAD, LOAD), [v, RigidMotion::held(0.0, 0.0)], (formula(1.0, true), Friction::constant(FRICTION)), &state).unwrap();
        shift += state[0].traction.rigid[0];
        all.push([spaces.utilisation(LOAD, &state), 1e3 * shift]);
    }
    (state, all)
}

#[test]
fn cattaneo() {
    for (name, aspect) in [("cattaneo_r1", 1.0), ("cattaneo_r2", 2.0)] {
        let run = run_of_reference(name);
        let expected = numbers(&run["shift_mm"]);
        for (lines, nodes, steps) in [(7, 20, 9), (7, 20, 90), (7, 40, 9), (5, 20, 9), (9, 20, 9), (13, 40, 9)] {
            let spaces = HalfSpaces::with_grid(aspect, lines, nodes);
            let (_, all) = shifted(&spaces, 0.9, steps);
            let each = steps / 9;
            let errors: Vec<String> = (0..9).map(|k| { let [f, s] = all[(k + 1) * each - 1]; assert!((f - 0.1 * (k as f64 + 1.0)).abs() < 1e-6); format!("{:+.4}", s / expected[k] - 1.0) }).collect();
            println!("{name} lines {lines} nodes {nodes} steps {steps}: {errors:?}");
        }
    }
}

#[test]
fn held() {
    let run = run_of_reference("held50");
    let xi = numbers(&run["xi"]);
    let s = numbers(&run["s_over_a"]);
    for (lines, nodes, per, series) in [(5, 20, 1, false), (7, 20, 1, false), (9, 20, 1, false), (13, 20, 1, false), (7, 40, 1, false), (7,20,2,false), (7, 20, 1, true), (13, 20, 1, true)] {
        let spaces = HalfSpaces::with_grid(1.0, lines, nodes);
        let (mut state, _) = shifted(&spaces, 0.5, 10);
        let dt = 1e-3 * number(&run["ds_mm"]) / SPEED / per as f64;
        let (mut worst, mut at, mut square, mut handed) = (0.0_f64, 0.0, 0.0, None);
        let mut rel = Vec::new();
        for k in 1..xi.len() {
            let mut creep = 0.0;
            for sub in 0..per {
                if series && handed.is_none() && let Some(other) = spaces.as_series(&state) { state = other; handed = Some(s[k]); }
                state = spaces.solve((LOAD, LOAD), spaces.driven(0.5, SPEED), (formula(dt, k == 1 && sub == 0), Friction::constant(FRICTION)), &state).unwrap();
                let v = state[0].traction.rigid[0];
                creep += (v - SPEED) / (0.5 * (v + SPEED)) / per as f64;
            }
            let error = creep / xi[k] - 1.0;
            rel.push(error);
            square += error * error;
            if error.abs() > worst { worst = error.abs(); at = s[k]; }
        }
        println!("held lines {lines} nodes {nodes} per {per} series {handed:?}: worst {worst:.4} at {at:.2}, rms {:.4}", (square / (xi.len() - 1) as f64).sqrt());
        if std::env::var("SHOW").is_ok() { println!("{:?}", rel.iter().map(|e| (e * 1e3).round()).collect::<Vec<_>>()); }
    }
}

#[test]
fn falling() {
    let reference = reference();
    let case = &reference["falling"];
    let (cold, kinetic) = (number(&case["mu_kin"]) + number(&case["mu_1"]), number(&case["mu_kin"]));
    let law = FrictionLaw { slip: SlipDependence::Exponential { remaining: kinetic / cold, decay: 2f64.ln() / number(&case["s_half"]) }, memory_length: 0.0, ..FrictionLaw::CONSTANT };
    for lines in [5, 7, 9, 13] {
        let spaces = HalfSpaces::new(1.0, lines);
        let mut errors = Vec::new();
        for (xi, force) in numbers(&case["xi"]).into_iter().zip(numbers(&case["Fx"])) {
            let found = spaces.solve((LOAD, LOAD), spaces.held(xi), (TimeDerivative::default(), Friction::local(law, cold, Heating::default(), 0.0)), &spaces.start()).unwrap();
            errors.push(spaces.utilisation(LOAD, &found) - force);
        }
        println!("falling {lines}: {errors:.4?}");
    }
}
