//! Choices among named items, and the questions that code asks about them.
//!
//! Code outside this file matches on every item or asks one of the questions here, each of which answers for every
//! item. A new item therefore does not compile until all of them are answered; `tests/tree/architecture.rs` refuses
//! comparisons.

use super::value::{choice, questions};

choice! {
    /// Rule by which a value that was written counts as given at the start.
    pub enum Given named "Given", "What counts as given at the start" {
        Changed = "changed", "what has another value than its declared start, so that writing back start values changes nothing";
        Written = "written", "all that is written, start values too";
    }
}

choice! {
    /// Temperatures at the start.
    pub enum StartTemperature named "StartTemperature", "Temperatures from which a run starts" {
        Uniform = "uniform", "wheel at thermal.reference + thermal.wheel_excess, rail at rail.temperature";
        Stationary = "stationary", "those that friction, brake and rail have brought about for ever, on top of these";
    }
}

choice! {
    /// Ends of the modelled rail.
    pub enum RailEnds named "RailEnds", "What the ends of the modelled rail do to waves" {
        Free = "free", "reflect them as free surfaces";
        Fixed = "fixed", "reflect them as surfaces that cannot move";
        Nonreflecting = "nonreflecting", "let them pass: dashpots swallow plane waves";
    }
}

choice! {
    /// Wear of the surfaces.
    pub enum Wear named "Wear", "Whether wear changes the profiles" {
        Off = "off", "it does not";
        TGamma = "t_gamma", "by the energy that friction dissipates per distance and area";
    }
}

choice! {
    /// Shape of the patch in which wheel and rail touch.
    pub enum ContactShape named "ContactShape", "Shape of the contact patch" {
        Line = "line", "a line of constant width: model.contact_width";
        Ellipse = "ellipse", "an ellipse from the radii of curvature, on contact.lines lines side by side";
        Rows = "rows", "any patch: contact.rows, on at most contact.lines lines side by side";
    }
}

choice! {
    /// Place of the wheel in its wheelset.
    pub enum WheelsetSide named "WheelsetSide", "Which wheel of a wheelset it is" {
        None = "none", "the host knows the wheel alone: drive.lateral_velocity, drive.spin and drive.contact_angle";
        Left = "left", "the left wheel in the direction of travel, the mirror image of the right one";
        Right = "right", "the right wheel in the direction of travel";
    }
}

choice! {
    /// Width over which wheel and rail conduct heat.
    pub enum CrossSection named "CrossSection", "How wide the bodies conduct heat" {
        Bodies = "bodies", "spreading from the contact into rim, web, boss and rail head; a free wheel";
        Contact = "contact", "as wide as the contact everywhere, in plane strain";
    }
}

choice! {
    /// Thermal boundary condition of the hub.
    pub enum Hub named "Hub", "Thermal boundary condition of the hub" {
        Fixed = "fixed", "held at thermal.reference";
        Insulated = "insulated", "no heat passes";
    }
}

questions! {
    /// Values count that only repeat a declared start value.
    Given: counts_start_values { Written => true, Changed => false }
    /// Temperatures at the start are those that friction and brake would reach for ever.
    StartTemperature: is_stationary { Stationary => true, Uniform => false }
    /// Wear changes the profiles.
    Wear: is_on { TGamma => true, Off => false }
    /// The hub has the reference temperature.
    Hub: is_held { Fixed => true, Insulated => false }
    /// The patch is as wide as the bodies, and has one line.
    ContactShape: is_line { Line => true, Ellipse => false, Rows => false }
    /// The host knows the wheelset.
    WheelsetSide: is_known { Left => true, Right => true, None => false }
    /// The wheel is the mirror image of the one that rows describe.
    WheelsetSide: is_mirrored { Left => true, Right => false, None => false }
    /// The patch is that of `contact.rows`.
    ContactShape: has_rows { Rows => true, Line => false, Ellipse => false }
}
