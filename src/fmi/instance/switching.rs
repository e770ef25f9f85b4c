//! Change of a control during a run: a quantity that becomes prescribed begins with its present value.

use crate::fmi::settings::SetValues;
use crate::fmi::table::named;
use crate::fmi::variable::{Kind, Value, Variable};
use crate::simulation::{Inputs, Lateral, Outputs, Rotation, Translation, Vertical};

/// Notes in `bumpless` the present value of every quantity that is prescribed `next` and is not `now`; a reaction
/// beyond its range as far as that goes.
pub(super) fn take_over(outputs: &Outputs, now: &Inputs, next: &Inputs, bumpless: &mut SetValues) {
    let rotation = match next.rotation {
        Rotation::Velocity => ("drive.omega", outputs.wheel_omega),
        Rotation::Moment => ("drive.moment", outputs.hub_moment),
    };
    let translation = match next.translation {
        Translation::Velocity => ("drive.velocity", outputs.wheel_velocity),
        Translation::Force => ("drive.force", outputs.hub_force_x),
    };
    let vertical = match next.vertical {
        Vertical::Force => ("drive.load", -outputs.hub_force_y - now.drive.load_change),
        Vertical::Displacement => ("drive.displacement", outputs.hub_height),
    };
    let lateral = match next.lateral {
        Lateral::Velocity => ("drive.lateral_velocity", outputs.wheel_lateral_velocity),
        Lateral::Force => ("drive.lateral_force", outputs.hub_force_z),
    };
    for (switched, (name, present)) in [
        (now.rotation != next.rotation, rotation),
        (now.translation != next.translation, translation),
        (now.vertical != next.vertical, vertical),
        (now.lateral != next.lateral, lateral),
    ] {
        if let (true, Some(Variable { reference, kind: Kind::Real { min, max, .. }, .. })) = (switched, named(name)) {
            bumpless.insert(*reference, Value::Real(present.clamp(*min, *max)));
        }
    }
}
