//! A steel cylinder that rolls on a steel half-space under creepage, beside Carter's closed form:
//! `cargo run --release --locked -p wheelrail-contact --example strip`.

use wheelrail_contact::numerics::analytic::{carter_force, carter_full_slip, hertz_half_width};
use wheelrail_contact::{ContactError, Creepages, ElasticMaterial, Friction, RollingContact, RollingStep};

fn main() -> Result<(), ContactError> {
    let steel = ElasticMaterial { youngs_modulus: 210e9, poissons_ratio: 0.3 };
    let (radius, load, friction) = (0.46, 1e6, 0.3); // m, N per metre of width, 1
    let half_width = hertz_half_width(load, radius, steel.contact_modulus());
    let full_slip = carter_full_slip(friction, half_width, radius);
    let rolled = |wheel: &mut RollingContact, share: f64, distance: f64| {
        let creepages = Creepages { along: share * full_slip, ..Creepages::default() };
        let friction = Friction::constant(friction);
        wheel.roll(&RollingStep { load, speed: 20.0, creepages, friction, distance })?;
        Ok([wheel.forces().height, wheel.forces().travel, wheel.stick_fraction()])
    };
    let mut wheel = RollingContact::cylinder(steel, radius, load, 0.1);
    println!("creepage over that of full slip; forces [kN/m] up and along, Carter's; share that sticks, Carter's");
    for share in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.1] {
        let [up, along, stick] = rolled(&mut wheel, share, 0.0)?;
        let exact = friction * load * carter_force(share, 1.0);
        let exact = [exact / 1e3, (1.0 - share).max(0.0)];
        println!("{share:.1}: {:8.2} {:8.2} {:8.2} {stick:8.4} {:8.4}", up / 1e3, along / 1e3, exact[0], exact[1]);
    }
    println!("distance rolled over the half-width since half of that creepage set in; force along [kN/m]");
    rolled(&mut wheel, 0.0, 0.0)?;
    for step in 1..=120 {
        let [_, along, _] = rolled(&mut wheel, 0.5, 0.25 * half_width)?;
        if step % 20 == 0 {
            println!("{:4.1}: {:8.2}", 0.25 * f64::from(step), along / 1e3);
        }
    }
    Ok(())
}
