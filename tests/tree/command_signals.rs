//! The built binary is told to end by a signal: what it has computed is in its place and whole, it says where, and its exit code is
//! that of shells.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const SMALL: [&str; 6] =
    ["--preset", "paper_d", "--set", "mesh.elements_per_half_width=8", "--set", "mesh.grid_elements_per_half_width=8"];
const SIGNALS: [(&str, i32); 3] = [("INT", 130), ("TERM", 143), ("HUP", 129)];

/// An empty directory of a test.
fn directory(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command_signals").join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Starts the binary, or a shell that becomes it, as from a terminal: signals that whoever runs the tests ignores, such as a shell that
/// runs them in its background, are heard.
fn start(shell: &str, arguments: &[&str]) -> Child {
    let mut command = Command::new("env");
    command.arg("--default-signal=INT,TERM,HUP");
    if !shell.is_empty() {
        command.args(["sh", "-c", &format!("{shell}; exec \"$0\" \"$@\"")]);
    }
    command.arg(env!("CARGO_BIN_EXE_wheelrail"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).args(SMALL);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn send(signal: &str, child: &Child) {
    assert!(Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap().success());
}

/// Waits until a directory has a file whose name ends so.
fn wait_for(folder: &Path, ending: &str) {
    let began = Instant::now();
    while !names(folder).iter().any(|name| name.ends_with(ending)) {
        assert!(began.elapsed() < Duration::from_secs(120), "no file {ending} in {folder:?}");
        sleep(Duration::from_millis(20));
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Rows of a CSV, all of one width and of numbers.
fn rows(path: &Path) -> usize {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let width = lines.next().unwrap().split(',').count();
    assert!(text.ends_with('\n'));
    lines
        .inspect(|line| assert_eq!(line.split(',').filter(|cell| cell.parse::<f64>().is_ok()).count(), width, "{line}"))
        .count()
}

#[test]
fn a_simulation_that_is_told_to_end_leaves_its_rows_in_place_and_says_where() {
    for (signal, code) in SIGNALS {
        let folder = directory(&format!("simulate_{signal}"));
        let [out, wheel] = ["x.csv", "wheel.csv"].map(|name| folder.join(name).display().to_string());
        fs::write(&out, "an earlier run\n").unwrap();
        let child = start("", &["simulate", "--stop", "100000", "--out", &out, "--wheel-profile", &wheel]);
        wait_for(&folder, ".unfinished");
        sleep(Duration::from_millis(200));
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        let said = text(&output);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert_eq!(names(&folder), ["wheel.csv", "x.csv"], "{said}");
        let (count, samples) = (rows(Path::new(&out)), rows(Path::new(&wheel)));
        let end = format!("holds what was computed up to {} s", (count - 1) as f64 / 1e3);
        assert!(said.contains(&format!("{out} {end}")) && said.contains(&format!("{wheel} {end}")), "{said}");
        assert!(
            said.ends_with('\n') && said.lines().last().unwrap().starts_with(&format!("error: stopped by SIG{signal}")),
            "{said}"
        );
        println!("SIG{signal}: exit code {code}, {count} rows, {samples} samples of the wheel");
        assert!(count > 0 && samples >= 2);
    }
}

#[test]
fn rows_on_standard_output_are_whole_when_a_signal_ends_the_run() {
    let child = start("", &["simulate", "--stop", "100000", "--outputs", "wheel.velocity"]);
    sleep(Duration::from_secs(3));
    send("INT", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output));
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.is_empty() || printed.ends_with('\n'));
    assert!(printed.lines().skip(1).all(|line| line.split(',').count() == 2));
    println!("{} rows", printed.lines().count().saturating_sub(1));
}

#[test]
fn a_curve_and_a_series_of_fields_keep_what_was_computed() {
    for (signal, code) in SIGNALS {
        let folder = directory(&format!("steady_{signal}"));
        let out = folder.join("curve.csv");
        // Points are written when all are there: the wait is longer where none was in time.
        for wait in [1, 2, 4, 8, 16, 32] {
            let child = start("", &["steady", "--creepage", "-1e-3:1e-3:1000000", "--out", out.to_str().unwrap()]);
            sleep(Duration::from_secs(wait));
            send(signal, &child);
            let output = child.wait_with_output().unwrap();
            assert_eq!(output.status.code(), Some(code), "{}", text(&output));
            if out.is_file() {
                let first = format!("{} holds the first {} of 1000000 creepages", out.display(), rows(&out));
                assert!(text(&output).contains(&first), "{}", text(&output));
                println!("SIG{signal}: exit code {code}, {first}");
                break;
            }
        }
        assert_eq!(names(&folder), ["curve.csv"]);

        let folder = directory(&format!("export_{signal}"));
        let child = start("", &["export", "--every", "1e-3", "--stop", "1000", "--out", folder.to_str().unwrap()]);
        wait_for(&folder, "fields.pvd");
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", text(&output));
        let index = fs::read_to_string(folder.join("fields.pvd")).unwrap();
        let listed: Vec<_> = index.split("file=\"").skip(1).map(|part| part.split('"').next().unwrap()).collect();
        assert!(!listed.is_empty() && listed.iter().all(|file| folder.join(file).is_file()));
        assert_eq!(names(&folder).len(), listed.len() + 1, "nothing unfinished is left");
        assert!(text(&output).contains("fields.pvd with"), "{}", text(&output));
    }
}

#[test]
fn a_signal_that_the_process_was_started_to_ignore_is_ignored() {
    let folder = directory("nohup");
    let out = folder.join("x.csv");
    let child = start("trap '' HUP", &["simulate", "--stop", "0.5", "--out", out.to_str().unwrap()]);
    wait_for(&folder, ".unfinished");
    send("HUP", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), rows(&out)), (Some(0), 501), "{}", text(&output));
}

#[test]
fn a_second_signal_ends_the_process_at_once() {
    use std::os::unix::process::ExitStatusExt;
    let folder = directory("twice");
    let out = folder.join("x.csv");
    // One step that takes long.
    let child = start(
        "",
        &["simulate", "--stop", "30", "--step", "30", "--set", "solver.max_step=1e-3", "--out", out.to_str().unwrap()],
    );
    wait_for(&folder, ".unfinished");
    send("INT", &child);
    sleep(Duration::from_millis(300));
    send("INT", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.signal(), Some(2), "{}", text(&output));
}
