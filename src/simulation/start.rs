//! Obstacles to a start that was not found, in the words of the user.

use super::{Drive, Inputs, STANDSTILL, Translation};
use crate::config::Config;
use crate::display::display_number;
use crate::rolling::creepages::creepage;

/// Loads over the nominal one between which a start is usual \[1].
const LOADS: [f64; 2] = [0.5, 1.5];
/// Creepage, temperature difference \[K], friction and share of the largest speed from which on a start is unusual.
const CREEPAGE: f64 = 0.05;
const HOT: f64 = 100.0;
const STICKY: f64 = 1.0;
const FAST: f64 = 1.0;

/// Advice for a start that was not found: what is unusual about it, by name and value.
pub(super) fn gentler(config: &Config, inputs: &Inputs) -> String {
    let found = unusual(config, inputs);
    let way = "and bring the inputs to their values in the first steps";
    if found.is_empty() {
        return config.told(&format!("start with another {{initial.velocity now}} {way}"));
    }
    format!("what is unusual about this start: {}; start with more usual values {way}", found.join("; "))
}

/// Everything that is unusual about a start.
fn unusual(config: &Config, inputs: &Inputs) -> Vec<String> {
    let (drive, initial, thermal) = (&inputs.drive, &config.initial, &config.thermal);
    let number = display_number;
    let mut found = Vec::new();
    if thermal.enabled && initial.temperature.is_stationary() {
        let mut heat = Vec::new();
        for (row, value) in Drive::ROWS.iter().zip(drive.values()).filter(|(row, value)| row.is_heat() && *value > 0.0)
        {
            heat.push(format!("{} = {} W", row.name, number(value)));
        }
        if drive.torque > 0.0 && config.brake.tread_share > 0.0 {
            heat.push(format!(
                "brake.torque = {} N.m with {}",
                number(drive.torque),
                config.given("brake.tread_share")
            ));
        }
        let heat = if heat.is_empty() { "the friction of this start".to_owned() } else { heat.join(" and ") };
        found.push(format!(
            "initial.temperature = stationary asks for the temperatures that {heat} would reach for ever; set it to uniform"
        ));
    }
    if inputs.vertical.prescribes_motion() {
        found.push(format!("drive.displacement = {} m", number(drive.displacement)));
    } else {
        let (pressing, nominal) = (drive.pressing(), config.model.nominal_load);
        if !(LOADS[0] * nominal..=LOADS[1] * nominal).contains(&pressing) {
            found.push(format!("drive.load = {} N where {}", number(pressing), config.given("model.nominal_load")));
        }
    }
    found.extend(slide(config, inputs));
    let aside = drive.lateral_velocity / config.initial.velocity.abs().max(STANDSTILL);
    if aside.abs() > CREEPAGE {
        let (value, percent) = (number(drive.lateral_velocity), number(100.0 * aside));
        found.push(format!("drive.lateral_velocity = {value} m/s, {percent} % of the speed"));
    }
    for (name, excess) in
        [("thermal.wheel_excess", thermal.wheel_excess), ("rail.temperature", drive.temperature - thermal.reference)]
    {
        if thermal.enabled && excess.abs() > HOT {
            let value = if name == "rail.temperature" { drive.temperature } else { excess };
            found.push(format!("{name} = {} K", number(value)));
        }
    }
    if drive.friction > STICKY {
        found.push(format!("rail.friction = {}", number(drive.friction)));
    }
    let velocity = if inputs.translation.prescribes_motion() { drive.velocity } else { initial.velocity };
    if velocity.abs() > FAST * thermal.max_speed {
        found.push(format!("a speed of {} m/s", number(velocity)));
    }
    found
}

/// A creepage that is not small, by what makes it.
fn slide(config: &Config, inputs: &Inputs) -> Option<String> {
    let (initial, drive) = (&config.initial, &inputs.drive);
    let (velocity, travel) = match inputs.translation {
        Translation::Velocity => (drive.velocity, "drive.velocity"),
        Translation::Force => (initial.velocity, "initial.velocity"),
    };
    if inputs.rotation.prescribes_motion() {
        let slides = creepage(velocity, config.wheel.radius * drive.omega);
        return (slides.abs() > CREEPAGE).then(|| {
            let (v, omega) = (display_number(velocity), display_number(drive.omega));
            format!("drive.omega = {omega} rad/s at {travel} = {v} m/s, a creepage of {}", display_number(slides))
        });
    }
    let slides = initial.creepage.filter(|creepage| creepage.abs() > CREEPAGE)?;
    let (value, percent) = (display_number(slides), display_number(100.0 * slides));
    Some(format!("initial.creepage = {value}, which is a ratio and means {percent} %"))
}

#[cfg(test)]
mod tests {
    use super::super::Rotation;
    use super::*;
    use crate::config::StartTemperature;

    fn advised(change: impl Fn(&mut Config, &mut Inputs)) -> String {
        let mut config = Config::default();
        let mut inputs = Inputs::rolling(&config);
        change(&mut config, &mut inputs);
        gentler(&config, &inputs)
    }

    #[test]
    fn a_refused_start_names_what_is_unusual_about_it_and_nothing_else() {
        let plain = advised(|_, _| {});
        assert!(plain.contains("initial.velocity = 27.7778") || plain.contains("initial.velocity (now 27.7778 m/s)"));
        type Change = fn(&mut Config, &mut Inputs);
        let cases: [(&str, Change); 6] = [
            ("initial.temperature = stationary", |c, i| {
                (c.initial.temperature, i.drive.tread_heat) = (StartTemperature::Stationary, 45e3);
            }),
            ("drive.load = 300000 N", |_, i| i.drive.load = 300e3),
            ("initial.creepage = 1, which is a ratio and means 100 %", |c, _| c.initial.creepage = Some(1.0)),
            ("drive.omega = 0 rad/s", |_, i| (i.rotation, i.drive.omega) = (Rotation::Velocity, 0.0)),
            ("thermal.wheel_excess = 500 K", |c, _| c.thermal.wheel_excess = 500.0),
            ("rail.temperature = 20 K", |_, i| i.drive.temperature = 20.0),
        ];
        for (words, change) in cases {
            let text = advised(change);
            assert!(text.contains(words) && !text.contains("initial.velocity ("), "{text}");
            for (others, _) in cases.iter().filter(|(others, _)| *others != words) {
                assert!(!text.contains(others), "{text}");
            }
        }
        let hot = advised(cases[0].1);
        assert!(hot.contains("drive.tread_heat = 45000 W") && hot.contains("set it to uniform"), "{hot}");
    }
}
