//! The condensed contact problem of one time step: gaps, slips and momentum balances as affine functions of contact
//! forces and rigid motions.

use super::streamline::Upwind;
use super::{ContactGrid, Status};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Linear answer of one body at the contact surface.
#[derive(Clone, Copy)]
pub struct SurfaceResponse<'a> {
    /// Displacement per unit nodal force on this body.
    pub compliance: &'a DMatrix<f64>,
    /// Displacement without contact forces and rigid accelerations.
    pub free: &'a DVector<f64>,
}

/// One rigid motion of the wheel and its balance `m a + ṗ = f + Σ contact`.
#[derive(Clone, Copy, Debug, Default)]
pub struct RigidMotion {
    /// Prescribed, or the start guess of an unknown: V [m/s], U [m], Ω [rad/s].
    pub value: f64,
    pub prescribed: bool,
    /// Acceleration `= gain · value + offset`.
    pub gain: f64,
    pub offset: f64,
    /// Mass or moment of inertia per metre.
    pub inertia: f64,
    /// External force or moment per metre; ignored if the motion is prescribed.
    pub load: f64,
    /// Rate of deformation momentum without contact forces and rigid accelerations.
    pub momentum: f64,
}

impl RigidMotion {
    /// Acceleration for a value.
    pub fn acceleration(&self, value: f64) -> f64 {
        self.gain * value + self.offset
    }
}

/// Gap and slip as affine functions of contact forces and rigid motions, for one time step.
pub struct ContactProblem<'a> {
    pub grid: &'a ContactGrid,
    /// Rolling radius of the wheel [m], thermal growth included.
    pub radius: f64,
    pub wheel: SurfaceResponse<'a>,
    pub rail: SurfaceResponse<'a>,
    /// Displacement of the wheel surface per unit rigid acceleration, three columns (x, y, rotation).
    pub wheel_loads: &'a DMatrix<f64>,
    /// Rate of deformation momentum per unit nodal force, three rows.
    pub momentum: &'a DMatrix<f64>,
    /// Rate of deformation momentum per unit rigid acceleration, 3 × 3.
    pub momentum_loads: &'a DMatrix<f64>,
    /// Translation V, hub height U, rotation Ω.
    pub rigid: [RigidMotion; 3],
    /// `d_t` of the tangential displacement difference is `slip_gain · (u_c − u_p) + slip_offset`.
    pub slip_gain: f64,
    pub slip_offset: &'a [f64],
    /// Gap of the undeformed bodies with the surface profile [m].
    pub gap: &'a [f64],
    /// Friction coefficient.
    pub friction: f64,
    /// Line load that scales tolerances [N/m].
    pub nominal_load: f64,
    /// Largest change of the edge weight β that counts as converged.
    pub edge_tolerance: f64,
}

/// Converged (or starting) state of the contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactSolution {
    pub status: Vec<Status>,
    /// Nodal forces on the wheel on all surface displacement components [N/m].
    pub forces: DVector<f64>,
    /// Slip velocity of the wheel relative to the rail at closed nodes as the friction law sees it, with upwind
    /// differences; zero elsewhere [m/s].
    pub slip: Vec<f64>,
    /// The same with centred differences: what dissipates. The upwind ones count their own numerical dissipation.
    pub centred_slip: Vec<f64>,
    /// Gap at open nodes, zero elsewhere [m].
    pub gap: Vec<f64>,
    /// Values of the rigid motions (V, U, Ω).
    pub rigid: [f64; 3],
    /// Rolling radius of the wheel [m].
    pub radius: f64,
    /// Surface displacements of wheel and rail [m].
    pub wheel_surface: DVector<f64>,
    pub rail_surface: DVector<f64>,
    pub iterations: usize,
}

impl ContactSolution {
    /// An open contact without forces.
    pub fn open(grid: &ContactGrid) -> Self {
        let n = grid.surface_dofs();
        Self {
            status: vec![Status::Open; grid.len()],
            forces: DVector::zeros(n),
            slip: vec![0.0; grid.len()],
            centred_slip: vec![0.0; grid.len()],
            gap: vec![0.0; grid.len()],
            rigid: [0.0; 3],
            radius: grid.radius,
            wheel_surface: DVector::zeros(n),
            rail_surface: DVector::zeros(n),
            iterations: 0,
        }
    }

    /// Normal nodal force at candidate `i` [N/m].
    pub fn normal(&self, grid: &ContactGrid, i: usize) -> f64 {
        self.forces[grid.dof(i) + 1]
    }

    /// Tangential nodal force on the wheel at candidate `i` [N/m].
    pub fn tangential(&self, grid: &ContactGrid, i: usize) -> f64 {
        self.forces[grid.dof(i)]
    }

    /// Power dissipated by friction [W/m].
    pub fn friction_power(&self, grid: &ContactGrid) -> f64 {
        -self.centred_slip.iter().enumerate().map(|(i, slip)| self.tangential(grid, i) * slip).sum::<f64>()
    }

    /// Contact forces on the wheel, x and y [N/m].
    pub fn force(&self) -> [f64; 2] {
        [0, 1].map(|k| self.forces.iter().skip(k).step_by(2).sum())
    }

    /// Generalised contact forces on the wheel: force x, force y, forward moment about the hub centre.
    pub fn resultant(&self, grid: &ContactGrid) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for i in 0..grid.len() {
            let (t, n) = (self.tangential(grid, i), self.normal(grid, i));
            let [arm_t, arm_n] = self.lever_arms(grid, i);
            sum[0] += t;
            sum[1] += n;
            sum[2] -= arm_t * t + arm_n * n;
        }
        sum
    }

    /// Lever arms about the hub centre of the tangential and the normal force at candidate `i` [m].
    ///
    /// They are those of the *deformed* wheel: by Betti's theorem for a rotated load only these balance the power of
    /// hub, contact and friction. The slope of the gap, zero inside the patch, takes away the power that the nodal
    /// forces of the outermost nodes would spend on closing the neighbouring cells (a rolling resistance of order h²).
    fn lever_arms(&self, grid: &ContactGrid, i: usize) -> [f64; 2] {
        let d = grid.dof(i);
        let gap = |k: Option<usize>| k.and_then(|k| self.gap.get(k)).copied().unwrap_or(0.0);
        let slope = (gap(Some(i + 1)) - gap(i.checked_sub(1))) / (2.0 * grid.spacing);
        [self.radius - self.wheel_surface[d + 1], grid.x[i] + self.wheel_surface[d] - self.radius * slope]
    }
}

/// A row of the linear system: coefficients of all contact forces, of the rigid values, and the constant.
pub(super) struct AffineRow {
    pub(super) forces: DVector<f64>,
    pub(super) rigid: [f64; 3],
    pub(super) constant: f64,
}

impl ContactProblem<'_> {
    pub(super) fn diagonal(&self, compliance: &DMatrix<f64>, i: usize) -> f64 {
        let d = self.grid.dof(i) + 1;
        compliance[(d, d)]
    }

    /// Whether the material arrives from `+x`.
    pub(super) fn upstream_right(&self, rigid: &[f64; 3]) -> bool {
        rigid[0] + self.radius * rigid[2] >= 0.0
    }

    /// Surface displacements of wheel and rail with zero contact forces and zero unknown rigid values.
    pub(super) fn constant_displacements(&self) -> DVector<f64> {
        let mut wheel = self.wheel.free.clone();
        for (k, motion) in self.rigid.iter().enumerate() {
            let known = if motion.prescribed { motion.acceleration(motion.value) } else { motion.offset };
            wheel.axpy(known, &self.wheel_loads.column(k), 1.0);
        }
        wheel
    }

    /// Displacements, exact (bilinear) slips and gaps of the present forces and rigid values.
    pub(super) fn evaluate(
        &self,
        solution: &mut ContactSolution,
        wheel_constant: &DVector<f64>,
        rows: &[Upwind],
        to_right: bool,
    ) {
        let grid = self.grid;
        let mut wheel = wheel_constant.clone();
        for (k, motion) in self.rigid.iter().enumerate() {
            if !motion.prescribed {
                wheel.axpy(motion.gain * solution.rigid[k], &self.wheel_loads.column(k), 1.0);
            }
        }
        wheel.gemv(1.0, self.wheel.compliance, &solution.forces, 1.0);
        let mut rail = self.rail.free.clone();
        rail.gemv(-1.0, self.rail.compliance, &solution.forces, 1.0);
        solution.wheel_surface = wheel;
        solution.rail_surface = rail;
        let (v, v_c) = (solution.rigid[0], self.radius * solution.rigid[2]);
        for (i, &row) in rows.iter().enumerate() {
            let d = grid.dof(i);
            let (u_c, u_p) = (&solution.wheel_surface, &solution.rail_surface);
            if solution.status[i].is_active() {
                let dynamic = self.slip_gain * (u_c[d] - u_p[d]) + self.slip_offset[i];
                let slip = |d_p: f64, d_c: f64| v * (1.0 + d_p) - v_c * (1.0 + d_c) + dynamic;
                let upwind = |u| self.stretch(u, i, row, to_right);
                let centred = |u: &DVector<f64>| (u[d + 2] - u[d - 2]) / (2.0 * grid.spacing);
                solution.slip[i] = slip(upwind(u_p), upwind(u_c));
                solution.centred_slip[i] = slip(centred(u_p), centred(u_c));
                solution.gap[i] = 0.0;
            } else {
                (solution.slip[i], solution.centred_slip[i]) = (0.0, 0.0);
                solution.gap[i] = self.gap[i] + u_c[d + 1] - u_p[d + 1] + solution.rigid[1];
            }
        }
    }

    /// Upwind derivative `∂u_x/∂x` at candidate `i`.
    fn stretch(&self, u: &DVector<f64>, i: usize, row: Upwind, to_right: bool) -> f64 {
        let d = self.grid.dof(i);
        let step = if to_right { 2isize } else { -2 };
        let stencil = row.stencil(to_right);
        let sum: f64 = stencil.iter().enumerate().map(|(k, c)| c * u[(d as isize + k as isize * step) as usize]).sum();
        sum / self.grid.spacing
    }

    /// `g = 0` at a closed node.
    pub(super) fn gap_row(&self, i: usize, relative: &DMatrix<f64>, wheel_constant: &DVector<f64>) -> AffineRow {
        let d = self.grid.dof(i) + 1;
        let mut rigid = [0.0, 1.0, 0.0];
        for (k, motion) in self.rigid.iter().enumerate() {
            if !motion.prescribed {
                rigid[k] += motion.gain * self.wheel_loads[(d, k)];
            }
        }
        AffineRow {
            forces: relative.column(d).into_owned(),
            rigid,
            constant: self.gap[i] + wheel_constant[d] - self.rail.free[d],
        }
    }

    /// `s = 0` at a stuck node, linearised in V and Ω about the present iterate.
    pub(super) fn slip_row(
        &self,
        i: usize,
        solution: &ContactSolution,
        relative: &DMatrix<f64>,
        wheel_constant: &DVector<f64>,
        row: Upwind,
        to_right: bool,
    ) -> AffineRow {
        let grid = self.grid;
        let d = grid.dof(i);
        let step = if to_right { 2isize } else { -2 };
        let (v, v_c) = (solution.rigid[0], self.radius * solution.rigid[2]);
        let mut forces = self.slip_gain * relative.column(d);
        let mut loads = [0.0; 3];
        for (k, load) in loads.iter_mut().enumerate() {
            *load = self.slip_gain * self.wheel_loads[(d, k)];
        }
        let mut constant = self.slip_gain * (wheel_constant[d] - self.rail.free[d]) + self.slip_offset[i];
        for (k, c) in row.stencil(to_right).iter().enumerate() {
            let at = (d as isize + k as isize * step) as usize;
            let c = c / grid.spacing;
            forces.axpy(-v * c, &self.rail.compliance.column(at), 1.0);
            forces.axpy(-v_c * c, &self.wheel.compliance.column(at), 1.0);
            for (j, load) in loads.iter_mut().enumerate() {
                *load -= v_c * c * self.wheel_loads[(at, j)];
            }
            constant += c * (v * self.rail.free[at] - v_c * wheel_constant[at]);
        }
        let stretch_rail = self.stretch(&solution.rail_surface, i, row, to_right);
        let stretch_wheel = self.stretch(&solution.wheel_surface, i, row, to_right);
        let mut rigid = [1.0 + stretch_rail, 0.0, -self.radius * (1.0 + stretch_wheel)];
        constant += -v * stretch_rail + v_c * stretch_wheel;
        for (k, motion) in self.rigid.iter().enumerate() {
            if !motion.prescribed {
                rigid[k] += motion.gain * loads[k];
            }
        }
        AffineRow { forces, rigid, constant }
    }

    /// Balance of momentum of an unknown rigid motion; lever arms are those of the present iterate.
    pub(super) fn balance_row(&self, k: usize, solution: &ContactSolution) -> AffineRow {
        let grid = self.grid;
        let own = &self.rigid[k];
        let mut forces = self.momentum.row(k).transpose();
        for i in 0..grid.len() {
            let d = grid.dof(i);
            match k {
                0 => forces[d] -= 1.0,
                1 => forces[d + 1] -= 1.0,
                _ => {
                    let [arm_t, arm_n] = solution.lever_arms(grid, i);
                    forces[d] += arm_t;
                    forces[d + 1] += arm_n;
                }
            }
        }
        let mut rigid = [0.0; 3];
        let mut constant = own.momentum - own.load;
        for (l, motion) in self.rigid.iter().enumerate() {
            let inertia = self.momentum_loads[(k, l)] + if l == k { own.inertia } else { 0.0 };
            if motion.prescribed {
                constant += inertia * motion.acceleration(motion.value);
            } else {
                rigid[l] = inertia * motion.gain;
                constant += inertia * motion.offset;
            }
        }
        AffineRow { forces, rigid, constant }
    }
}
