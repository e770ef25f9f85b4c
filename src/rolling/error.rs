//! Why the rolling model has no answer.

use super::control::InputError;
use crate::config::RowsError;
use crate::contact::ContactError;
use crate::heat::HeatError;
use crate::mechanics::MechanicsError;
use crate::surface::SurfaceError;

/// Why a step or a stationary state could not be computed; the state before it is kept.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// The contact iteration failed.
    #[error("no contact state found at t = {time:.6} s with an internal step of {step:.1e} s: {source}")]
    Contact {
        /// Time at which the step began \[s].
        time: f64,
        /// Its length \[s].
        step: f64,
        /// Error of the contact solver.
        source: ContactError,
    },
    /// The contact patch outgrew the mesh.
    #[error("the contact patch needs more than the candidate zone of ±{zone:.3e} m at a wheel load of {load:.6e} N")]
    ZoneExceeded {
        /// Half-length of the zone \[m].
        zone: f64,
        /// Contact force of the wheel \[N].
        load: f64,
    },
    /// Values that are infinite or not a number.
    #[error("the motion grew beyond all numbers at t = {time:.6} s with an internal step of {step:.1e} s")]
    NotFinite {
        /// Time at which the step began \[s].
        time: f64,
        /// Its length \[s].
        step: f64,
    },
    /// A motion outside the range of the model.
    #[error("the motion leaves the range of the model: {0}")]
    Motion(InputError),
    /// A wheel that nothing presses onto the rail.
    #[error(
        "no equilibrium: drive.load and drive.load_change press the wheel down with {pressing} N, not with more than 0 N"
    )]
    Unpressed {
        /// Force that presses \[N].
        pressing: f64,
    },
    /// Contact and temperatures that do not come to rest at each other.
    #[error("no equilibrium: contact and temperatures do not settle")]
    Unsettled,
    /// Steel so hot that no contact was found in which it yields.
    #[error(
        "no equilibrium: the steel of the contact is so hot that it bears {:.0} MPa, and no contact was found in which it yields: \
         the softest one has {:.0} MPa",
        1e-6 * bears, 1e-6 * pressure
    )]
    Softened {
        /// Pressure that the steel bears \[Pa].
        bears: f64,
        /// Largest pressure of the contact of the softest steel for which one was found \[Pa].
        pressure: f64,
    },
    /// No steady rolling: force and moment ask for more than friction carries.
    #[error(
        "no steady rolling: {demand} {verb} a tangential force of {asked:.6e} N in the contact, where adhesion carries \
         {carried:.6e} N (friction coefficient {friction:.4} at a wheel load of {load:.6e} N)",
        verb = if demand.contains(" and ") { "ask for" } else { "asks for" }
    )]
    BeyondAdhesion {
        /// The inputs that ask for it, with their values.
        demand: String,
        /// Tangential force on the wheel that they need \[N].
        asked: f64,
        /// Largest one \[N].
        carried: f64,
        /// Friction coefficient \[1].
        friction: f64,
        /// Wheel load \[N].
        load: f64,
    },
    /// An input outside its range.
    #[error(transparent)]
    Input(#[from] InputError),
    /// Inputs across the direction of travel of a contact that has none.
    #[error(
        "{input}, but the contact has no lateral direction: set contact.lateral = true, or leave it at its start value"
    )]
    Longitudinal {
        /// The input with its value.
        input: String,
    },
    /// An input of a host that knows the wheel alone, where it has told of the wheelset.
    #[error(
        "{input} says what the wheel does, but wheelset.side says that the wheelset is known: leave it at its start value and give \
         wheelset.lateral, wheelset.yaw and wheelset.roll with their rates, or set wheelset.side = none"
    )]
    OfTheWheel {
        /// The input with its value.
        input: String,
    },
    /// A shift for which there is no patch.
    #[error(
        "wheelset.lateral = {shift} m is outside the shifts of contact.rows: {low} to {high} m; make the table over all shifts that the \
         wheelset reaches"
    )]
    Shifted {
        /// The shift \[m].
        shift: f64,
        /// Smallest shift of the table \[m].
        low: f64,
        /// Largest shift of the table \[m].
        high: f64,
    },
    /// A pose of a wheelset that the wheel does not belong to.
    #[error(
        "{input}, but the wheel belongs to no wheelset: set wheelset.side = left or right, or leave it at its start value"
    )]
    OfTheWheelset {
        /// The input with its value.
        input: String,
    },
    /// A communication step outside its range.
    #[error("communication step = {step} s is outside its range: above 0 to {longest} s")]
    StepSize {
        /// Length of the step that was asked for \[s].
        step: f64,
        /// Longest step \[s].
        longest: f64,
    },
    /// A communication step that would take hours.
    #[error(
        "a communication step of {step:.6} s makes {pieces} internal steps with solver.max_step = {max_step:e} s, more \
         than the {most} allowed: raise solver.max_step or take shorter communication steps"
    )]
    TooManySteps {
        /// Length of the communication step \[s].
        step: f64,
        /// Largest internal step \[s].
        max_step: f64,
        /// Internal steps needed at least.
        pieces: u64,
        /// Most internal steps of a communication step.
        most: u64,
    },
    /// A contact that gets hotter than friction on molten steel can make it.
    #[error(
        "the contact heats to {temperature:.0} K, above the {highest:.0} K that molten steel under friction reaches"
    )]
    Overheated {
        /// Highest absolute temperature of the contact \[K].
        temperature: f64,
        /// Highest one that can be \[K].
        highest: f64,
    },
    /// A kink of the solution: no derivative to either side.
    #[error("no derivative at t = {time:.6} s: contact states change at once to both sides")]
    NoDerivative {
        /// Time of the state \[s].
        time: f64,
    },
    /// The temperatures have no answer.
    #[error("heat: {0}")]
    Heat(#[from] HeatError),
    /// A temperature that matter cannot have: linear laws were taken beyond their range, or the tread was cooled too
    /// much.
    #[error("the coldest point would have {temperature:.1} K, which is not above absolute zero")]
    BelowAbsoluteZero {
        /// Lowest temperature \[K].
        temperature: f64,
    },
    /// The bodies have no answer.
    #[error("body response: {0}")]
    Body(#[from] MechanicsError),
    /// A state of another model.
    #[error("the state belongs to a model with other dimensions")]
    ForeignState,
}

/// Why a model could not be built.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// Meshes, matrices or modes.
    #[error("finite-element model: {0}")]
    Mechanics(#[from] MechanicsError),
    /// The heat model.
    #[error("heat model: {0}")]
    Heat(#[from] HeatError),
    /// A profile without meaning.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Rows of a patch without meaning.
    #[error(transparent)]
    Rows(#[from] RowsError),
    /// Contact lines that no model can have.
    #[error(
        "contact lines with the shares {shares:?} of the width and a reach of {length:?} m: shares must be positive and add up \
         to 1, and the reach must be positive"
    )]
    Lines {
        /// Shares of the width \[1].
        shares: Vec<f64>,
        /// Distance at which the displacement by a force of a line alone ends \[m].
        length: f64,
    },
}
