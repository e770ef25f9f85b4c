//! A sample of random parameter sets inside the declared ranges; `make endurance NAME=parameters` runs a thousand, each in a
//! process of its own.

#[path = "../../examples/ex04_random_parameters/case.rs"]
mod case;

use crate::common::random;

use case::{Case, Verdict};

#[test]
fn random_parameters_are_simulated_within_declared_ranges_or_refused_by_name() {
    let (mut simulated, mut failures) = (0, Vec::new());
    for case in (5000..5080).map(Case::new) {
        let verdict = case.run();
        simulated += usize::from(verdict == Verdict::Simulated);
        if !verdict.acceptable() {
            failures.push(format!("{verdict:?}\n{case}"));
        }
    }
    println!("{simulated} of 80 sets were simulated");
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
    assert!(simulated >= 5, "{simulated}");
}
