//! A four-axle coach in the plane as linear equations, those of `vehicle.py`: body, two bogies, four wheelsets.
//!
//! Positions are counted from the static state: x along the track, y up, pitch counter-clockwise. Wheelsets move in x
//! only. With b, the row that maps all coordinates to the elongation of a spring and damper,
//!
//! ```text
//! M q'' + C q' + K q = f,     K = sum k bᵀb,     C = sum c bᵀb                              [N], [N m]
//! ```
//!
//! integrated implicitly (Newmark: the trapezoidal rule for bodies, linear acceleration for wheelsets).

use crate::AXLES;
use crate::parameters::Parameters;

/// Acceleration of gravity \[m/s2].
pub const GRAVITY: f64 = 9.81;
const BODY: usize = 0;
const BOGIES: [usize; 2] = [3, 6];
const WHEELSETS: usize = 9;
const SIZE: usize = WHEELSETS + AXLES;

/// One value per coordinate.
type Row = [f64; SIZE];

/// A spring and a damper along one direction between two points.
#[derive(Clone, Debug)]
struct Link {
    row: Row,
    stiffness: f64,
    damping: f64,
}

/// Row of the x displacement of a point of a pitching body, `height` \[m] above its centre of gravity.
fn along(body: usize, height: f64) -> Row {
    let mut row = [0.0; SIZE];
    (row[body], row[body + 2]) = (1.0, -height);
    row
}

/// Row of the y displacement of a point of a pitching body, `ahead` \[m] of its centre of gravity.
fn upward(body: usize, ahead: f64) -> Row {
    let mut row = [0.0; SIZE];
    (row[body + 1], row[body + 2]) = (1.0, ahead);
    row
}

fn difference(a: Row, b: Row) -> Row {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Equations of motion.
#[derive(Clone, Debug)]
pub struct Coach {
    masses: Row,
    mass: f64,
    pulls: Vec<Link>,
    lifts: Vec<Link>,
    stiffness: [Row; SIZE],
    damping: [Row; SIZE],
    resistance: [f64; 2],
}

/// Where everything is and how fast it moves.
///
/// Positions along the track count from where the first wheelset was last found: millimetres in place of kilometres,
/// whose last digit times 63 MN/m would be felt.
#[derive(Clone, Debug)]
pub struct Motion {
    origin: f64,
    position: Row,
    velocity: Row,
}

impl Motion {
    /// All bodies move at a speed \[m/s], springs as under their own weight.
    pub fn start(speed: f64) -> Self {
        let mut velocity = [0.0; SIZE];
        Self::along().for_each(|k| velocity[k] = speed);
        Self { origin: 0.0, position: [0.0; SIZE], velocity }
    }

    /// Coordinates along the track.
    fn along() -> impl Iterator<Item = usize> {
        [BODY, BOGIES[0], BOGIES[1]].into_iter().chain(WHEELSETS..SIZE)
    }

    /// Speed \[m/s] and way \[m] of the car body.
    pub fn body(&self) -> [f64; 2] {
        [self.velocity[BODY], self.origin + self.position[BODY]]
    }

    /// Wheelsets are where they are found \[m, m/s].
    pub fn correct(&mut self, positions: [f64; AXLES], velocities: [f64; AXLES]) {
        let moved = positions[0] - self.origin;
        Self::along().for_each(|k| self.position[k] -= moved);
        self.origin = positions[0];
        self.position[WHEELSETS..].copy_from_slice(&positions.map(|position| position - self.origin));
        self.velocity[WHEELSETS..].copy_from_slice(&velocities);
    }
}

/// Of each wheelset in a step of the vehicle: its mass \[kg] and the constant force on it \[N].
#[derive(Clone, Copy, Debug)]
pub struct Wheelsets {
    /// Mass \[kg].
    pub masses: [f64; AXLES],
    /// Force beside that of the suspension \[N].
    pub forces: [f64; AXLES],
}

impl Coach {
    /// From the parameters.
    pub fn new(p: &Parameters) -> Self {
        let body_mass = p.body_mass + p.payload;
        let bogie = [p.bogie_mass, p.bogie_mass, p.bogie_inertia];
        let mut masses = [p.wheelset_mass; SIZE];
        masses[..3].copy_from_slice(&[body_mass, body_mass, p.body_inertia * body_mass / p.body_mass]);
        BOGIES.iter().for_each(|&at| masses[at..at + 3].copy_from_slice(&bogie));
        let mass = body_mass + 2.0 * p.bogie_mass + AXLES as f64 * p.wheelset_mass;
        let (stiffness, damping) = ([[0.0; SIZE]; SIZE], [[0.0; SIZE]; SIZE]);
        let (pulls, lifts) = (Self::pulls(p), Self::lifts(p));
        let resistance = [p.constant, p.quadratic];
        let mut coach = Self { masses, mass, pulls, lifts, stiffness, damping, resistance };
        for link in Self::secondary(p).iter().chain(&coach.pulls).chain(&coach.lifts) {
            for (i, a) in link.row.into_iter().enumerate() {
                for (j, b) in link.row.into_iter().enumerate() {
                    coach.stiffness[i][j] += link.stiffness * a * b;
                    coach.damping[i][j] += link.damping * a * b;
                }
            }
        }
        coach
    }

    /// Secondary suspension and traction rods.
    fn secondary(p: &Parameters) -> Vec<Link> {
        let of = |bogie: usize, ahead: f64| {
            let between =
                |height: f64| difference(along(bogie, height - p.bogie_height), along(BODY, height - p.body_height));
            let lift = difference(upward(bogie, 0.0), upward(BODY, ahead));
            [
                Link { row: lift, stiffness: p.bounce_stiffness, damping: p.bounce_damping },
                Link { row: between(p.shear_height), stiffness: p.shear_stiffness, damping: p.shear_damping },
                Link { row: between(p.rod_height), stiffness: p.rod_stiffness, damping: p.rod_damping },
            ]
        };
        of(BOGIES[0], p.front).into_iter().chain(of(BOGIES[1], -p.front)).collect()
    }

    /// Primary suspension along the track, per axle.
    fn pulls(p: &Parameters) -> Vec<Link> {
        let link = |axle: usize| {
            let mut row = difference([0.0; SIZE], along(BOGIES[axle / 2], p.radius - p.bogie_height));
            row[WHEELSETS + axle] = 1.0;
            Link { row, stiffness: p.pull_stiffness, damping: p.pull_damping }
        };
        (0..AXLES).map(link).collect()
    }

    /// Primary suspension upward, per axle.
    fn lifts(p: &Parameters) -> Vec<Link> {
        let link = |axle: usize| {
            let ahead = if axle.is_multiple_of(2) { p.wheel } else { -p.wheel };
            let row = difference([0.0; SIZE], upward(BOGIES[axle / 2], ahead));
            Link { row, stiffness: p.lift_stiffness, damping: p.lift_damping }
        };
        (0..AXLES).map(link).collect()
    }

    /// Forces of the primary suspension on each wheelset: along the track \[N], and the load on the rail beside the
    /// static one \[N].
    pub fn forces(&self, motion: &Motion) -> [[f64; AXLES]; 2] {
        let force = |link: &Link| {
            -link.stiffness * dot(&link.row, &motion.position) - link.damping * dot(&link.row, &motion.velocity)
        };
        [std::array::from_fn(|axle| force(&self.pulls[axle])), std::array::from_fn(|axle| -force(&self.lifts[axle]))]
    }

    /// Moves on by `h` \[s] with wheelsets as masses under the suspension and constant forces. `torques` \[N m] are
    /// those of the brakes on the wheels, forward positive; the frames carry their reaction.
    pub fn advance(&self, motion: &mut Motion, h: f64, torques: &[f64; AXLES], wheels: &Wheelsets) {
        let mut masses = self.masses;
        masses[WHEELSETS..].copy_from_slice(&wheels.masses);
        let mut f = [0.0; SIZE];
        let speed = motion.velocity[BODY];
        let share = self.resistance[0] * (speed / 0.01).tanh() + self.resistance[1] * speed * speed.abs();
        f[BODY] -= share * self.mass * GRAVITY;
        (f[BOGIES[0] + 2], f[BOGIES[1] + 2]) = (torques[0] + torques[1], torques[2] + torques[3]);
        f[WHEELSETS..].copy_from_slice(&wheels.forces);
        let after_share = |k: usize| if k < WHEELSETS { 0.25 } else { 1.0 / 6.0 };
        let residual = |q: &Row, v: &Row, i: usize| f[i] - dot(&self.damping[i], v) - dot(&self.stiffness[i], q);
        let before: Row = std::array::from_fn(|i| residual(&motion.position, &motion.velocity, i) / masses[i]);
        let half: Row = std::array::from_fn(|k| motion.velocity[k] + 0.5 * h * before[k]);
        let there: Row = std::array::from_fn(|k| {
            motion.position[k] + h * motion.velocity[k] + h * h * (0.5 - after_share(k)) * before[k]
        });
        let matrix: [Row; SIZE] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let inertia = if i == j { masses[i] } else { 0.0 };
                inertia + 0.5 * h * self.damping[i][j] + h * h * self.stiffness[i][j] * after_share(j)
            })
        });
        let after = solve(matrix, std::array::from_fn(|i| residual(&there, &half, i)));
        for k in 0..SIZE {
            motion.position[k] = there[k] + h * h * after_share(k) * after[k];
            motion.velocity[k] = half[k] + 0.5 * h * after[k];
        }
    }
}

/// Solves a linear system by elimination with row exchanges.
fn solve(mut a: [Row; SIZE], mut b: Row) -> Row {
    for column in 0..SIZE {
        let size = |row: &usize| a[*row][column].abs();
        let pivot = (column..SIZE).max_by(|x, y| size(x).total_cmp(&size(y))).unwrap_or(column);
        a.swap(column, pivot);
        b.swap(column, pivot);
        let (leading, value) = (a[column], b[column]);
        for row in column + 1..SIZE {
            let factor = a[row][column] / leading[column];
            (column..SIZE).for_each(|k| a[row][k] -= factor * leading[k]);
            b[row] -= factor * value;
        }
    }
    for row in (0..SIZE).rev() {
        let known: f64 = (row + 1..SIZE).map(|k| a[row][k] * b[k]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    b
}
