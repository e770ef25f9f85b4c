"""What the files of a stop may say: names, ranges, units, defaults, and usual sizes."""

from .files import Flag, Named, Real, Setting, Several, Text

VEHICLE = {
    "name": Text("what it is"),
    "body": {
        "mass": Real(100, 1e6, "kg", "car body, empty", usual=3e4, others=("t",)),
        "payload": Real(0, 1e6, "kg", "load, spread like the body", 0.0, usual=1e4, others=("t",)),
        "pitch_inertia": Real(10, 1e9, "kg m2", "of the empty body about its centre of gravity"),
        "height": Real(0.1, 10, "m", "centre of gravity above the rail"),
    },
    "bogie": {
        "mass": Real(10, 1e5, "kg", "frame of one bogie", usual=3e3, others=("t",)),
        "pitch_inertia": Real(1, 1e6, "kg m2", "about its centre of gravity"),
        "height": Real(0.1, 5, "m", "centre of gravity above the rail"),
    },
    "wheelset": {
        "mass": Real(50, 2e4, "kg", "one wheelset", usual=1.5e3, others=("t",)),
        "inertia": Real(1, 1e4, "kg m2", "about its axle"),
        "radius": Real(0.1, 2, "m", "of the wheels", others=("mm",)),
    },
    "bogie_half_distance": Real(0.5, 50, "m", "between bogie centre and middle of the body"),
    "axle_half_distance": Real(0.1, 5, "m", "between axle and bogie centre"),
    "primary": {
        "longitudinal_stiffness": Real(1e4, 1e10, "N/m", "of one wheelset, both boxes", usual=1e7, others=("kN/m", "MN/m")),
        "longitudinal_damping": Real(0, 1e8, "N s/m", "of one wheelset, both boxes", others=("kN s/m",)),
        "vertical_stiffness": Real(1e4, 1e10, "N/m", "of one wheelset, both boxes", usual=1e7, others=("kN/m", "MN/m")),
        "vertical_damping": Real(0, 1e8, "N s/m", "of one wheelset, both boxes", others=("kN s/m",)),
    },
    "secondary": {
        "longitudinal_stiffness": Real(0, 1e9, "N/m", "of one bogie, both sides", others=("kN/m", "MN/m")),
        "longitudinal_damping": Real(0, 1e8, "N s/m", "of one bogie, both sides", others=("kN s/m",)),
        "vertical_stiffness": Real(1e3, 1e9, "N/m", "of one bogie, both sides", others=("kN/m", "MN/m")),
        "vertical_damping": Real(0, 1e8, "N s/m", "of one bogie, both sides", others=("kN s/m",)),
        "height": Real(0, 5, "m", "of its shear above the rail"),
    },
    "traction_rod": {
        "stiffness": Real(1e3, 1e10, "N/m", "between one bogie and the body", others=("kN/m", "MN/m")),
        "damping": Real(0, 1e8, "N s/m", "of its bushes", others=("kN s/m",)),
        "height": Real(0, 5, "m", "above the rail"),
    },
    "length": Real(1, 100, "m", "over couplers", 26.0),
    "coupler": {
        "stiffness": Real(1e3, 1e10, "N/m", "of the draft gears between two bodies", 10e6, others=("kN/m", "MN/m")),
        "damping": Real(0, 1e8, "N s/m", "of the draft gears between two bodies", 250e3, others=("kN s/m",)),
        "height": Real(0, 5, "m", "above the rail", 1.05),
    },
    "resistance": {
        "constant": Real(0, 0.1, "1", "running resistance over weight", 0.0),
        "quadratic": Real(0, 0.01, "s2/m2", "running resistance over weight and speed squared", 0.0),
    },
}

BRAKE = {
    "name": Text("what it is"),
    "torque": Real(0, 1e6, "N m", "of one axle at full pressure", usual=1e4, others=("kN m",)),
    "pressure": Real(1e4, 2e6, "Pa", "full cylinder pressure over ambient", usual=4e5, others=("bar", "kPa")),
    "delay": Real(0, 60, "s", "between demand and first pressure", 0.0, others=("ms",)),
    "fill_time": Real(0.01, 120, "s", "in which 95 % of the full pressure builds up", others=("ms",)),
    "release_time": Real(0.01, 240, "s", "in which it falls to 5 %", others=("ms",)),
    "cylinder_volume": Real(0, 1, "m3", "cylinders and pipes of one axle", 0.0),
    "wsp": {
        "active": Flag("whether wheels are protected", True),
        "period": Real(1e-3, 1, "s", "between decisions", 0.02, others=("ms",)),
        "slide_low": Real(0, 1, "1", "slide from which an axle is held", 0.05, others=("%",)),
        "slide_high": Real(0, 1, "1", "slide from which an axle is vented", 0.15, others=("%",)),
        "least_slide": Real(0, 5, "m/s", "no slide below this counts", 0.3),
        "deceleration": Real(0, 100, "m/s2", "of a sliding axle, from which it is vented", 3.0),
        "recovery": Real(0, 100, "m/s2", "acceleration of an axle that comes back", 1.0),
        "reference_deceleration": Real(0.01, 10, "m/s2", "largest fall of the reference speed", 1.5),
        "sounding": Real(0.1, 1e6, "s", "after which an axle is released to find the train's speed", 2.0),
        "longest_sounding": Real(0.1, 60, "s", "that it is released", 2.0),
        "off_speed": Real(0, 20, "m/s", "below which nothing is controlled", 1.0),
        "vent_time": Real(0.01, 10, "s", "time constant of venting", 0.25),
        "fill_time": Real(0.01, 10, "s", "time constant of filling through the valve", 0.3),
    },
    "sander": {
        "active": Flag("whether sand is laid while an axle is vented", False),
        "axles": Several(Real(1, 4, "", "axle from the front", whole=True), "axles behind a sander", (1,)),
        "rate": Real(0, 1, "kg/s", "on each rail", 0.008),
        "off_speed": Real(0, 100, "m/s", "below which none is laid", 2.0),
        "delay": Real(0, 60, "s", "between an axle that is vented and sand on the rail", 0.3),
        "minimum_time": Real(0, 60, "s", "that sand is laid at least", 1.0),
        "run_on": Real(0, 60, "s", "that sand is laid on after the last axle was vented", 2.0),
    },
    "protection": Text("slide protection of one's own, module:Class; the built-in one if empty", ""),
    "protection_parameters": Named(Real(-1e12, 1e12, "", "value"), "numbers that its class is made with, by name", {}),
    "sanding": Text("sanding of one's own, module:Class; the built-in one if empty", ""),
    "sanding_parameters": Named(Real(-1e12, 1e12, "", "value"), "numbers that its class is made with, by name", {}),
}

CONDITION = {
    "friction": Real(1e-3, 1, "1", "before any wheel", others=("%",)),
    "recovered": Real(1e-3, 1, "1", "after cleaning", others=("%",)),
}

TRACK = {
    "name": Text("what it is"),
    "sections": Text("CSV file with position, condition, slope, temperature"),
    "profile": Text("CSV file with position, elevation: height profile of the rail for irregularities; none if empty", ""),
    "length": Real(10, 1e6, "m", "of the map ahead of the first axle", others=("km",)),
    "begin": Real(
        -1e7, 1e7, "m", "position in sections and profile at which the first axle starts: its chainage, where they are of a line", 0.0
    ),
    "slope": Real(
        -0.2, 0.2, "1", "rise over length, rising positive, in addition to that of the sections: 0.012 is 12 per mille", 0.0,
        usual=0.01, others=("‰", "%"),
    ),
    "cell": Real(0.01, 100, "m", "of the map", 0.25),
    "conditions": Named(CONDITION, "conditions by name"),
    "cleaning_energy": Real(1e-3, 1e12, "J/m", "friction energy per metre of one rail that cleans it to 1/e"),
    "sand": {
        "friction": Real(1e-3, 1, "1", "with plenty of sand", 0.2, others=("%",)),
        "mass": Real(1e-9, 100, "kg/m", "sand that gains 63 %", 0.0005),
    },
    "contact_width": Real(1e-4, 0.2, "m", "of the patch, on which a wheel leaves its heat", 0.014, usual=0.012, others=("mm",)),
    "effusivity": Real(10, 1e6, "J/(m2 K sqrt(s))", "of the rail", 13580.0),
}

SECTIONS = {
    "position": Real(-1e7, 1e7, "m", "where the section begins"),
    "condition": Text("a name of the track's conditions"),
    "slope": Real(
        -0.2, 0.2, "1", "rise over length, rising positive: 0.012 is 12 per mille", 0.0, usual=0.01, others=("‰", "%")
    ),
    "temperature": Real(
        -100, 500, "K", "of the rail over the reference, 20 degC unless thermal.reference is set: 0 is a rail of 20 degC", 0.0,
        usual=25.0, relative=True,
    ),
}

PROFILE = {
    "position": Real(-1e7, 1e7, "m", "along the track"),
    "elevation": Real(
        -0.1, 0.1, "m", "of the rail: a cubic spline between positions, level at both ends and beyond", usual=5e-3, others=("mm",)
    ),
}

SCENARIO = {
    "name": Text("what it shows"),
    "vehicle": Text("file"),
    "coaches": Real(1, 20, "", "coupled to a set", 1, whole=True),
    "fmu_coaches": Several(
        Real(1, 20, "", "coach from the front", whole=True),
        "coaches whose wheelsets are in the FMU, those of the others are rigid; unless given, all", (),
    ),
    "brake": Text("file"),
    "track": Text("file"),
    "speed": Real(0.5, 60, "m/s", "at the start", others=("km/h",)),
    "demand": Real(0, 1, "1", "share of the full brake pressure", 1.0, others=("%",)),
    "payload": Real(0, 1e6, "kg", "in place of the vehicle's", optional=True, usual=1e4, others=("t",)),
    "adhesion": Real(1e-3, 1, "1", "of contaminated rail, in place of the track's", optional=True, others=("%",)),
    "step": Real(1e-5, 0.01, "s", "communication step; longer ones do not resolve the primary suspension", 0.005, others=("ms",)),
    "hold": Real(0, 60, "s", "watched after standstill", 2.0),
    "longest": Real(0.01, 3600, "s", "a stop may take", 240.0),
    "dry": Real(1e-3, 1, "1", "friction of the dry stop that the others are compared with", 0.3, others=("%",)),
    "wheel": Named(
        Setting("value: a number, the name of a choice, preset or profile, true or false"),
        "parameters of the FMU, of one wheel: preset, contact.shape and the like among them", {},
    ),
    "right_wheel": Named(
        Setting("value, as of wheel"),
        "parameters in which the right wheel of every wheelset differs from wheel, which is then the left one; none if empty", {},
    ),
    "right_friction": Real(1e-3, 1e3, "1", "friction of the right rail over that of the left one, which the track has", 1.0),
    "temperatures": Named(
        Setting("value, as of wheel"),
        "parameters of one more wheel beside every wheelset, which moves as that one does and gives its temperatures and damage: "
        "a patch beside a line; none if empty", {},
    ),
    "driver": Text("driver of one's own, module:Class; a constant demand if empty", ""),
    "driver_parameters": Named(Real(-1e12, 1e12, "", "value"), "numbers that its class is made with, by name", {}),
}
