//! Drives of the wheels: parameters, and inputs as functions of time.

/// Speed at the start \[m/s].
const SPEED: &str = "27";
/// Braking moment of about half the adhesion limit \[N m].
const MOMENT: f64 = -7000.0;
/// Moment of traction, and torque of a brake that locks a wheel on a dry rail \[N m].
const TRACTION: f64 = 3000.0;
const LOCKING: f64 = 40_000.0;
/// Period of a moment that varies \[s].
const PERIOD: f64 = 0.04;
/// Growth of a brake \[N m/s], and speed from which it locks a wheel after 1.1 s \[m/s].
const GROWTH: f64 = 16_000.0;
const SLOWER: &[(&str, &str)] = &[("initial.velocity", "16.7")];
/// Amplitude \[m] and angular frequency \[rad/s] of an uneven track.
const WAVE: f64 = 2.5e-3;
const WAVING: f64 = 17.0;
/// Angular velocity of free rolling \[rad/s], and the time in which a wheel is stopped \[s].
const ROLLING: f64 = 27.0 / 0.46;
const STOP: f64 = 0.02;
/// Locked and driven part of a cycle \[s].
pub const CYCLE: f64 = 1.0;
const LOCKED: f64 = 0.25;

/// Values of the inputs at a time \[s] after the start.
type Course = fn(f64) -> Vec<(&'static str, f64)>;

/// A run whose steps are measured.
#[derive(Clone, Copy)]
pub struct Drive {
    pub name: &'static str,
    pub about: &'static str,
    pub heat: bool,
    /// Parameters besides the defaults and those of the command line.
    pub settings: &'static [(&'static str, &'static str)],
    /// Communication step \[s].
    pub step: f64,
    /// Time before the first measured step, and from there to the end \[s].
    pub settling: f64,
    pub measured: f64,
    pub course: Course,
    /// At the end the wheel must stand still while its centre moves.
    pub ends_locked: bool,
}

impl Drive {
    /// Numbers of steps before and while it is measured.
    pub fn steps(&self) -> [u32; 2] {
        [self.settling, self.measured].map(|time| (time / self.step).round() as u32)
    }

    /// All parameters of the case, by name.
    pub fn parameters(&self) -> Vec<(String, String)> {
        let own = [("initial.velocity", SPEED), ("thermal.enabled", if self.heat { "true" } else { "false" })];
        own.iter().chain(self.settings).map(|&(name, value)| (name.to_owned(), value.to_owned())).collect()
    }
}

/// A row of the table, or some.
#[derive(Clone, Copy)]
pub enum Case {
    Drive(Drive),
    Start,
}

impl Case {
    pub fn name(&self) -> &'static str {
        match self {
            Case::Drive(drive) => drive.name,
            Case::Start => "start",
        }
    }
}

fn constant(_: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT)]
}

/// From -1 to 1 and back within a period.
fn triangle(time: f64) -> f64 {
    1.0 - 4.0 * ((time / PERIOD).rem_euclid(1.0) - 0.5).abs()
}

fn varying_little(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT * (1.0 + 0.03 * triangle(time)))]
}

fn varying(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT * (1.0 + 0.3 * triangle(time)))]
}

fn stopped(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.omega", ROLLING * (1.0 - time / STOP).max(0.0))]
}

fn locking(time: f64) -> Vec<(&'static str, f64)> {
    vec![("brake.torque", if time < 0.15 { -MOMENT } else { LOCKING })]
}

fn growing(time: f64) -> Vec<(&'static str, f64)> {
    vec![("brake.torque", GROWTH * time)]
}

/// A track without rates of its height.
fn waving(time: f64) -> Vec<(&'static str, f64)> {
    vec![("drive.moment", MOMENT), ("rail.elevation", WAVE * (1.0 - (WAVING * time).cos()))]
}

fn cycling(time: f64) -> Vec<(&'static str, f64)> {
    let locked = time.rem_euclid(CYCLE) < LOCKED;
    vec![("brake.torque", if locked { LOCKING } else { 0.0 }), ("drive.moment", if locked { 0.0 } else { TRACTION })]
}

const AS_PRESET: &[(&str, &str)] = &[];
const FIFTY: &[(&str, &str)] = &[("mesh.elements_per_half_width", "50")];
const BY_SPEEDS: &[(&str, &str)] = &[("control.rotation", "velocity"), ("control.translation", "velocity")];
const AT_SPEED: &[(&str, &str)] = &[("control.translation", "velocity")];
const ROUGH: &[(&str, &str)] =
    &[("rail.profile", "roughness(spectrum = EN_ISO_3095, shortest = 0.02, from = 0.1, blend = 0.2)")];

const BRAKING: Drive = Drive {
    name: "constant",
    about: "constant moment, half of the adhesion limit",
    heat: true,
    settings: AS_PRESET,
    step: 1e-3,
    settling: 0.1,
    measured: 0.4,
    course: constant,
    ends_locked: false,
};

const DRIVES: &[Drive] = &[
    BRAKING,
    Drive { name: "varying-3", about: "moment ±3 % in 40 ms", course: varying_little, ..BRAKING },
    Drive { name: "varying-30", about: "moment ±30 % in 40 ms", course: varying, ..BRAKING },
    Drive { name: "fifty", about: "moment ±30 %, 50 elements", settings: FIFTY, course: varying, ..BRAKING },
    Drive {
        name: "locked",
        about: "wheel locked since 0.28 s",
        settings: BY_SPEEDS,
        settling: 0.3,
        course: stopped,
        ends_locked: true,
        ..BRAKING
    },
    Drive {
        name: "lock-up",
        about: "jump of the brake that locks the wheel",
        measured: 1.0,
        course: locking,
        ends_locked: true,
        ..BRAKING
    },
    Drive {
        name: "growing",
        about: "brake that grows and locks the wheel after 1.1 s",
        settings: SLOWER,
        settling: 0.1,
        measured: 2.5,
        course: growing,
        ends_locked: true,
        ..BRAKING
    },
    Drive { name: "level", about: "constant moment, steps of 10 ms", step: 1e-2, measured: 4.0, ..BRAKING },
    Drive {
        name: "track",
        about: "the same on an uneven track without rates",
        step: 1e-2,
        measured: 4.0,
        course: waving,
        ..BRAKING
    },
    Drive { name: "rough", about: "rough rail (EN ISO 3095), steps of 0.1 ms", settings: ROUGH, step: 1e-4, ..BRAKING },
    Drive {
        name: "cycles",
        about: "twelve times 0.25 s locked, 0.75 s driven",
        settings: AT_SPEED,
        settling: 0.0,
        measured: 12.0,
        course: cycling,
        ..BRAKING
    },
];

const WITHOUT_HEAT: &[&str] = &[
    "constant-cold",
    "varying-3-cold",
    "varying-30-cold",
    "fifty-cold",
    "locked-cold",
    "lock-up-cold",
    "growing-cold",
    "level-cold",
    "track-cold",
    "rough-cold",
    "cycles-cold",
];

/// Every case.
pub fn all() -> Vec<Case> {
    let cold = DRIVES.iter().zip(WITHOUT_HEAT).map(|(drive, &name)| Drive { name, heat: false, ..*drive });
    let mut drives: Vec<_> = DRIVES.iter().copied().zip(cold).flat_map(|(warm, cold)| [warm, cold]).collect();
    drives.sort_by_key(|drive| !drive.heat);
    drives.into_iter().map(Case::Drive).chain([Case::Start]).collect()
}

/// The drive of a name.
pub fn drive(name: &str) -> Option<Drive> {
    all().into_iter().find_map(|case| match case {
        Case::Drive(drive) if drive.name == name => Some(drive),
        _ => None,
    })
}

/// Prints names and what they stand for.
pub fn list() {
    for case in all() {
        match case {
            Case::Drive(drive) => {
                println!(
                    "{:16} {}, {}",
                    drive.name,
                    drive.about,
                    if drive.heat { "with heat" } else { "without heat" }
                );
            }
            Case::Start => println!("{:16} instantiated until ready: nothing stored, stored", case.name()),
        }
    }
}
