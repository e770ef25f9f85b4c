//! The functions that the page calls: two benches in one process know nothing of each other, and errors are texts.

use bench::abi::{
    Handle, bench_basis_name, bench_csv, bench_free, bench_input, bench_link, bench_new, bench_output,
    bench_output_length, bench_start, bench_step,
};
use std::slice;

/// Bench of a handle that is freed in the end.
struct Held(*mut Handle);

impl Held {
    fn new() -> Self {
        Self(bench_new())
    }

    /// Calls a function with a text as input.
    fn call(&self, function: unsafe extern "C" fn(*mut Handle) -> u32, input: &str) -> Result<String, String> {
        // SAFETY: the bench lives, and the buffer has the length of the text.
        let failed = unsafe {
            bench_input(self.0, input.len()).copy_from_nonoverlapping(input.as_ptr(), input.len());
            function(self.0)
        };
        if failed == 0 { Ok(self.output()) } else { Err(self.output()) }
    }

    fn output(&self) -> String {
        // SAFETY: the bench lives, and nothing is called until the bytes are copied.
        let bytes = unsafe { slice::from_raw_parts(bench_output(self.0), bench_output_length(self.0)) };
        String::from_utf8(bytes.to_vec()).unwrap()
    }

    fn step(&self, count: u32) {
        // SAFETY: the bench lives.
        assert_eq!(unsafe { bench_step(self.0, count) }, 0, "{}", self.output());
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        // SAFETY: made by `bench_new` and freed once.
        unsafe { bench_free(self.0) }
    }
}

#[test]
fn two_benches_side_by_side_are_two() {
    const LINKS: [&str; 2] =
        ["patch=line&rail=wet&speed=80&load=90&torque=3", "patch=line&rail=dry&speed=40&load=100&torque=2"];
    let alone = LINKS.map(|link| {
        let bench = Held::new();
        bench.call(bench_start, link).unwrap();
        bench.step(20);
        bench.call(bench_csv, "").unwrap()
    });
    let both = LINKS.map(|link| {
        let bench = Held::new();
        bench.call(bench_start, link).unwrap();
        bench
    });
    for _ in 0..20 {
        both.iter().for_each(|bench| bench.step(1));
    }
    for ((bench, link), csv) in both.iter().zip(LINKS).zip(alone) {
        assert_eq!(bench.call(bench_link, "").unwrap(), link);
        assert_eq!(bench.call(bench_csv, "").unwrap(), csv);
    }
}

#[test]
fn an_error_is_a_text_and_the_bench_goes_on() {
    let bench = Held::new();
    assert_eq!(bench.call(bench_csv, ""), Err("no run has been started".to_owned()));
    assert!(bench.call(bench_start, "patch=square").unwrap_err().contains("possible: line, ellipse, s1002"));
    assert!(bench.call(bench_basis_name, "patch=line").unwrap().ends_with(".bin"));
}
