//! Where the text at hand and a recomputation differ, with the reason, in three kinds that are kept apart.

/// Whose a deviation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The thesis says so, in numbers or more than once, and a recomputation shows otherwise.
    Thesis,
    /// A slip of a letter, sign or dot, of the thesis or of its conversion into the text at hand; other places of the
    /// thesis show what is meant.
    Text,
    /// The thesis is measured by something that we chose.
    Ours,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Thesis, Self::Text, Self::Ours];

    /// Name of its table in the report.
    pub fn title(self) -> &'static str {
        match self {
            Self::Thesis => "Errors of the thesis",
            Self::Text => "Misprints of the text at hand",
            Self::Ours => "Judgements of ours",
        }
    }

    /// Meaning, in a sentence.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Thesis => "The thesis says so, in numbers or more than once; a recomputation shows otherwise.",
            Self::Text => {
                "A letter, sign or dot, in the thesis or lost when it became the text at hand; other places show what is meant."
            }
            Self::Ours => "The thesis contradicts nothing that it says; what differs is a measure that we chose.",
        }
    }
}

/// A deviation of the text at hand.
pub struct Mistake {
    /// Whose it is.
    pub kind: Kind,
    /// Where it stands.
    pub place: &'static str,
    /// Statement of the thesis.
    pub says: &'static str,
    /// Correct statement.
    pub right: &'static str,
    /// Why.
    pub proof: &'static str,
}

/// All that are known, in the words of the page: names of values stand for numbers (see [`crate::page`]). Those with a
/// figure of their own are checked by its predicates and by `quoted.toml`.
pub const ALL: &[Mistake] = &[
    Mistake {
        kind: Kind::Thesis,
        place: "[A] § 3.1",
        says: "4.7 MN/m give 1 GPa over 7 mm",
        right: "{closed.a.pressure*1e-6 .0} MPa over {closed.a.width*1e3 .1} mm; 1 GPa needs {closed.a.load_for_1GPa*1e-6 .1} MN/m",
        proof: "Hertz (Johnson 4.43, 4.44); {closed.a.rigid_width*1e3 .2} mm is the width on a rigid plate. Recomputed under A text.",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[A] § 3.2",
        says: "a plate five times as large raises the pressure from 96.8 to 99.7 % of Hertz', as it is nearer to a half-plane",
        right: "it changes it by less than 0.1 %",
        proof: "The plate is twenty half-widths high. The product has {a.pressure.small .4} and {a.pressure.large .4} of Hertz; readings and meshes of the \
                thesis's method differ by 15 %. Recomputed under A text.",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[A] Fig. 12",
        says: "excitation `V/λ` in rad/s",
        right: "`2πV/λ`",
        proof: "The peak lies at the contact resonance, 2922 rad/s undamped; `V/λ` is {a12.peak_without_2pi .0} 1/s there.",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[C] Fig. 12",
        says: "mean of the wheel 2.26e-6 K",
        right: "{c14.wheel .1e} K, 33 times as much",
        proof: "The annulus conducts `Q ln(r/r_i)/2πk` to its hub: 2.26e-6 K would be 0.6 % of the heat of friction. Product and scheme of the thesis on \
                ever shorter edges agree. Recomputed under C 12: linear triangles lose as much, quadratic ones do not.",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[C] Fig. 12",
        says: "mean of the rail 4.45e-9 K",
        right: "{c14.rail .2e} K, 2.5 times as much",
        proof: "What the rail takes, 0.114 W/m, leaves with its stream: its mean is that over twice `ρc V H`.",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[D] § 6.2.2",
        says: "creepage 1.9e-4 means 48 % of the limit",
        right: "{closed.d18.share*100 .1} % after Carter and in stationary rolling of the product, {d16.share*100 .1} % under the moment that brakes to \
                {d16.creepage .2e}",
        proof: "`F/μP = 1 − (1 − ξ/ξ_fs)²` with `ξ_fs = μa/r`. Recomputed under D 18. 0.48 needs a tenfold `ε_r` or an uneven mesh; the thesis's own \
                step in time needs {d16.method.share*100 .1} % (D 16–17).",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[D] (38)",
        says: "deformation heats by `αE θ_ref`",
        right: "`3Kα θ_ref = αE θ_ref/(1 − 2ν)`, as [B] (33) and [D] (10)",
        proof: "A body held in all directions has the strain `−αθ` in each, whose stress is 3K times that; reciprocity gives the heat the same factor. \
                `αE` stands in all six places of Appendix A.",
    },
    Mistake {
        kind: Kind::Thesis,
        place: "[D] Fig. 14",
        says: "`M^c ≈ r_o F_x^ext`",
        right: "`M^c ≈ r_o F_x^c`",
        proof: "The contact's moment about the hub is that of its own force. It stands so twice; in Fig. 13 `F_x^ext` is zero at the plateau of `M^c`.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[A] § 3.2, Fig. 6",
        says: "\"for case 3\", \"between cases 1 and 2\"",
        right: "cases (a) to (c)",
        proof: "The list before has letters; (b) is the reference that the text calls 2.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[C] § 6.3.1",
        says: "deviations near the edge of the slip zone: \"see Figures 11–14\"",
        right: "Figures 8–11",
        proof: "Figures 8 to 11 show stresses and slip, 12 to 14 temperatures.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[C] Fig. 14",
        says: "caption: mean temperatures in cylinder and plate",
        right: "in the cylinder, as the text says, or the text means both",
        proof: "Of Figure 15 the text says \"in cylinder and plate\". Recomputed for both under C 14.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[D] App. A",
        says: "load of the accelerated frame `D_t v̄ − Ẍ`",
        right: "`D_t v̄ + Ẍ`, as [B] (26)",
        proof: "An undeformed rail rests: `D_t v̄ = −V̇ e_x`, `Ẍ = V̇ e_x`, and only their sum vanishes, as in [D] (34).",
    },
    Mistake {
        kind: Kind::Text,
        place: "[D] (28)",
        says: "`v = û`",
        right: "`v = d_t û`",
        proof: "The matrix C of (28) multiplies a velocity: a dot is lost.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[D] § 5.3.1",
        says: "vertical force `F_x`",
        right: "horizontal force",
        proof: "§ 5.2.2 calls it the external horizontal force.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[D] § 6.2.2",
        says: "braking to 10 km/h starts with `V̄ = 0`",
        right: "50 km/h",
        proof: "What rests cannot be slowed; the next paragraph takes the start values at 50 km/h.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[D] Fig. 8",
        says: "quasi-static for `|ξ|` < 4e-3 1/s",
        right: "for `|dξ/dt|` < 4e-3 1/s",
        proof: "The unit is that of a rate.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[D] Fig. 6",
        says: "`0 < ξ < ξ_fs` with `ξ_fs` ≈ −6e-4, and `ξ₀` = −8e-4 `> ξ_fs`",
        right: "`ξ_fs < ξ < 0` and `ξ₀ < ξ_fs`, or magnitudes",
        proof: "No number lies between 0 and −6e-4 in this order.",
    },
    Mistake {
        kind: Kind::Text,
        place: "[C] (15)",
        says: "second line with the master's velocity less the slave's",
        right: "the slave's less the master's, as the first line and [D] (16)",
        proof: "(14) and (18) need a force against the slip, `t_m ṡ < 0`.",
    },
    Mistake {
        kind: Kind::Ours,
        place: "[C] § 6.3.1, [D] § 6.2.1",
        says: "local deformations in the contact, which Carter's theory does not have, make the force deviate from Carter's and nonzero without creepage",
        right: "by a hundredth of the limit at most: without creepage {d6.free.still +.4} without centrifugal load ([D], 50 km/h), {d6.free .4} with it, \
                {d6.free.fast +.4} at 100 km/h, {c7.free +.4} under the load of [C]",
        proof: "The product has these deformations and neither a regularised law nor an uneven mesh; its curve is within {d6.carter.off .1e} of Carter. The \
                thesis's method has {d6.tanh_bias +.3} without creepage on the mesh of D 6 and up to 0.3 on coarser ones. How large the deviation is in \
                the thesis's figures cannot be read from the text. Recomputed under D 6, C 7 and D 18.",
    },
    Mistake {
        kind: Kind::Ours,
        place: "[B] Fig. 15",
        says: "thermal contact is perfect above 1e7 W/(m² K)",
        right: "{b15.left*100 .0} % of the wheel's temperature are left to the resistance there, 5 % at {b15.threshold .0e}",
        proof: "The thesis reads a saturation off its figure and names no measure, so this is no error.",
    },
];
