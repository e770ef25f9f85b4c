//! Where the thesis is wrong, with the reason.

/// An error of the thesis.
pub struct Mistake {
    /// Where it stands.
    pub place: &'static str,
    /// What it says.
    pub says: &'static str,
    /// What is right.
    pub right: &'static str,
    /// Why.
    pub proof: &'static str,
}

/// All that are known. Those with a figure of their own are checked by its predicates and by `quoted.toml`.
pub const ALL: &[Mistake] = &[
    Mistake {
        place: "A 3.1",
        says: "4.7 MN/m give 1 GPa over 7 mm",
        right: "598 MPa over 10.0 mm; 1 GPa needs 13.2 MN/m",
        proof: "Hertz (Johnson 4.43, 4.44); 7.08 mm is the width on a rigid plate. Recomputed under A text.",
    },
    Mistake {
        place: "A 3.2",
        says: "a plate five times as large raises the pressure from 96.8 to 99.7 % of Hertz', as it is nearer to a half-plane",
        right: "it changes it by less than 0.1 %",
        proof: "The plate is twenty half-widths high. The product has 1.0002 and 0.9999 of Hertz, and each way to read the pressure off the thesis's own method \
                is the same on both plates, while meshes differ by 15 %. Recomputed under A text.",
    },
    Mistake {
        place: "A Fig. 12",
        says: "excitation V/λ in rad/s",
        right: "2πV/λ",
        proof: "The peak lies at the contact resonance, 2922 rad/s undamped; V/λ is 476 1/s there. Recomputed under A 12.",
    },
    Mistake {
        place: "C, text to Fig. 12",
        says: "mean wheel temperature 2.26e-6 K",
        right: "7.52e-5 K, 33 times as much",
        proof: "The annulus conducts Q ln(r/r_i)/2πk to its hub, so that 2.26e-6 K would be 0.6 % of the heat that friction puts \
                into the wheel; the product and the scheme of the thesis on ever shorter edges have 7.5e-5 K, two independent ways. Recomputed under C 12: linear \
                triangles lose as much (figures B 5 to B 7), the quadratic ones described do not.",
    },
    Mistake {
        place: "C, text to Fig. 12",
        says: "mean rail temperature 4.45e-9 K",
        right: "1.11e-8 K, 2.5 times as much",
        proof: "What the rail takes, 0.114 W/m, leaves with its stream: its mean is that over twice ρc V H. Recomputed under C 14.",
    },
    Mistake {
        place: "D 6.2.2",
        says: "creepage 1.9e-4 means 48 % of the limit",
        right: "52.7 % after Carter on half-planes and in stationary rolling of the product, 53.1 % with the moment that brakes to 1.905e-4",
        proof: "F/μP = 1 − (1 − ξ/ξ_fs)² with ξ_fs = μa/r = 6.09e-4. Recomputed under D 18. The regularised law with ε_r = 1e-4 m/s takes 0.006 at most \
                of that on one mesh; 0.48 in braking needs a tenfold ε_r or an uneven mesh. The thesis's own \
                step in time needs 53.0 % under the moment that makes the wheel creep by 1.9e-4 (D 16–17).",
    },
    Mistake {
        place: "D App. A",
        says: "load of the accelerated frame D_t v̄ − Ẍ",
        right: "D_t v̄ + Ẍ, as B (26)",
        proof: "An undeformed rail rests: its v̄ = −V e_x has D_t v̄ = −V̇ e_x, the frame Ẍ = V̇ e_x, and only their sum vanishes.",
    },
    Mistake {
        place: "D (38)",
        says: "deformation heats by αE θ_ref",
        right: "3Kα θ_ref = αE θ_ref/(1 − 2ν), as B (33)",
        proof: "A body held in all directions has the strain −αθ in each, whose stress is 3K times that: 2.5 times αE for ν = 0.3; \
                reciprocity gives the heat the same factor.",
    },
    Mistake {
        place: "D (28)",
        says: "v = û, as the text at hand reads",
        right: "v = d_t û",
        proof: "The matrix C of (28) multiplies a velocity.",
    },
    Mistake {
        place: "D (27), text before it",
        says: "vertical force F_x",
        right: "horizontal force",
        proof: "F_x is conjugate to the velocity of travel.",
    },
    Mistake {
        place: "D 6.2.2",
        says: "braking to 10 km/h starts with V̄ = 0",
        right: "50 km/h",
        proof: "What rests cannot be slowed to 10 km/h; the motion is to be that of the example before, from 50 km/h.",
    },
    Mistake {
        place: "D, text to Fig. 14",
        says: "M^c ≈ r_o F_x^ext",
        right: "M^c ≈ r_o F_x^c",
        proof: "The contact's moment about the hub is that of the contact's own force.",
    },
    Mistake {
        place: "B, text to Fig. 15",
        says: "thermal contact is perfect above k_c = 1e7",
        right: "9 % of the wheel's temperature are left there, 5 % at 2e7",
        proof: "The wheel's mean temperature is a sum of the contact's resistance and the chill by the rail; the first is 9 % of it \
                there. Recomputed under B 15.",
    },
];
