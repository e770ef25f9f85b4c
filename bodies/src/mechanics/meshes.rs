//! Meshes and finite-element matrices of both bodies of the parameters.

use super::ale::Stream;
use super::error::MechanicsError;
use super::parameters::{BodyParameters, Ends};
use super::size::{check_size, contact_zone, unmeshable};
use super::system::BodySystem;
use crate::fem::{Mesh, graded};

/// Mesh of the wheel; an error that names parameters if it were too large, see [`check_size`].
pub fn wheel_mesh(c: &BodyParameters) -> Result<Mesh, MechanicsError> {
    check_size(c)?;
    let mesh = graded::wheel(c.radius, c.hub_radius, contact_zone(c));
    mesh.map_err(|source| unmeshable("wheel", source))
}

/// Mesh of the rail; an error that names parameters if it were too large, see [`check_size`].
pub fn rail_mesh(c: &BodyParameters) -> Result<Mesh, MechanicsError> {
    check_size(c)?;
    let mesh = graded::rail(c.rail_length, c.rail_height, c.largest_rail_cell(), contact_zone(c));
    let mut mesh = mesh.map_err(|source| unmeshable("rail", source))?;
    match c.rail_ends {
        Ends::Fixed => mesh.fix_ends(),
        Ends::Free | Ends::Nonreflecting => {}
    }
    Ok(mesh)
}

/// Finite-element matrices of the wheel.
pub fn wheel_system(c: &BodyParameters) -> Result<BodySystem, MechanicsError> {
    Ok(BodySystem::assemble(&wheel_mesh(c)?, &c.material, Stream::Rotation)?)
}

/// Finite-element matrices of the rail.
pub fn rail_system(c: &BodyParameters) -> Result<BodySystem, MechanicsError> {
    let (mesh, material, stream) = (rail_mesh(c)?, &c.material, Stream::Translation);
    let system = BodySystem::assemble(&mesh, material, stream)?;
    Ok(match c.rail_ends {
        Ends::Fixed => system,
        Ends::Free => system.with_free_ends(&mesh, material, stream)?,
        Ends::Nonreflecting => system.with_quiet_ends(&mesh, material, stream)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{Cholesky, CsrMatrix, lowest_modes};
    use crate::mechanics::testing::paper_d;

    /// Close to the cut-off frequency of a long body on a fixed base, modes crowd. That they are modes shows in the
    /// residual of the pencil, that the lowest is there in the Cholesky factorisation of `K − σM`, which exists below
    /// it only, and that none is left out in the same frequencies from a larger space (a high column is so soft that
    /// its lowest frequency carries the round-off of the stiffest cells).
    #[test]
    fn modes_of_long_low_rails_are_found_although_they_crowd() {
        for (length, height) in [(0.12, 2.0), (5.0, 0.1), (20.0, 0.02), (100.0, 0.02)] {
            let mut bodies = paper_d(4);
            (bodies.rail_length, bodies.rail_height) = (length, height);
            let BodySystem { stiffness, mass, .. } = rail_system(&bodies).unwrap();
            let factor = Cholesky::new(&stiffness).unwrap();
            let [one, twenty, forty] =
                [1, 20, 40].map(|count| lowest_modes(&factor, &mass, count, &mut |_| {}).unwrap());
            let (kx, mx) = (stiffness.multiply_columns(&forty.shapes), mass.multiply_columns(&forty.shapes));
            for (j, square) in forty.squared_frequencies.iter().enumerate() {
                let residual = (kx.column(j) - mx.column(j) * *square).norm() / kx.column(j).norm();
                assert!(residual < 1e-6, "rail of {length} m, mode {j}: {residual:e}");
            }
            for fewer in [one, twenty] {
                for (few, many) in fewer.squared_frequencies.iter().zip(&forty.squared_frequencies) {
                    assert!((few / many - 1.0).abs() < 1e-7, "rail of {length} m: {few} against {many}");
                }
            }
            let shifted =
                |square: f64| Cholesky::new(&CsrMatrix::combination(1.0, &stiffness, -square, &mass).unwrap());
            let lowest = forty.squared_frequencies[0];
            assert!(shifted(lowest * (1.0 - 1e-6)).is_ok() && shifted(lowest * (1.0 + 1e-6)).is_err());
        }
    }

    /// Longest and highest rails and most modes that the parameters allow; prints the time.
    #[test]
    #[ignore = "minutes; run by hand after changes to the iteration"]
    fn any_number_of_modes_is_found_for_rails_of_any_size() {
        for (length, height) in [(0.12, 0.02), (0.12, 2.0), (2.0, 2.0), (20.0, 0.02), (100.0, 0.02), (100.0, 2.0)] {
            for count in [1, 20, 80, 200] {
                let mut bodies = paper_d(4);
                (bodies.rail_length, bodies.rail_height) = (length, height);
                let system = rail_system(&bodies).unwrap();
                let factor = Cholesky::new(&system.stiffness).unwrap();
                let start = std::time::Instant::now();
                let modes = lowest_modes(&factor, &system.mass, count, &mut |_| {});
                println!("rail {length} m x {height} m, {count} modes: {:.1} s", start.elapsed().as_secs_f64());
                assert_eq!(modes.map(|modes| modes.squared_frequencies.len()), Ok(count));
            }
        }
    }
}
