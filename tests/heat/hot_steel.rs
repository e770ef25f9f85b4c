//! Hot steel in closed form: what a layer of known heat under the contact does to a standing wheel, what the mean
//! temperature of the wheel does to its radius, what strength and what friction are left, and how deep heat has to reach to
//! weaken the steel. Where heat has to be known, a heat model that is told it stands in the place of the fields.

use crate::common::{self, model, preset};
use wheelrail::config::{Config, Material, StartTemperature};
use wheelrail::heat::{
    Exchange, HeatError, HeatFlows, HeatLine, HeatModel, HeatScratch, HeatState, Observation, TemperatureField,
};
use wheelrail::material::{MeltingFilm, melted_share, yield_share};
use wheelrail::mechanics::{Basis, bodies};
use wheelrail::rolling::outputs::observe;
use wheelrail::rolling::{Inputs, RollingModel, Rotation, State, Translation, Workspace, stationary};
use wheelrail::simulation::{Outputs, Simulation};
use wheelrail::surface::Surfaces;

/// Heat that is told: temperature integrated over the depth of the layers of wheel and rail [K m], the same everywhere,
/// mean temperature of the wheel \[K], and temperature per depth over which its mean is taken [K/m].
#[derive(Clone, Default)]
struct Told {
    zone: Vec<f64>,
    layers: [f64; 2],
    wheel: f64,
    per_depth: f64,
}

impl HeatModel for Told {
    fn initial(&self, _wheel: f64, _rail: f64) -> HeatState {
        HeatState::new(vec![0.0])
    }

    fn after_long_rolling(
        &self,
        _velocity: f64,
        _omega: f64,
        _exchange: &Exchange,
        _wheel: f64,
    ) -> Result<(HeatState, HeatFlows), HeatError> {
        Ok((self.initial(0.0, 0.0), HeatFlows::default()))
    }

    fn step(
        &self,
        lines: &mut [HeatLine],
        _dt: f64,
        _velocity: f64,
        _omega: f64,
        _scratch: &mut HeatScratch,
    ) -> Result<(), HeatError> {
        lines.iter_mut().for_each(|line| *line.next = line.state.clone());
        Ok(())
    }

    fn fits(&self, state: &HeatState) -> bool {
        state.values.len() == 1
    }

    fn zone_x(&self) -> &[f64] {
        &self.zone
    }

    fn observe(&self, _state: &HeatState, seen: &mut Observation) -> Result<(), HeatError> {
        for body in [0, 1] {
            seen.surface[body] = vec![if self.per_depth > 0.0 { 1000.0 } else { 0.0 }; self.zone.len()];
            seen.layer[body] = vec![self.layers[body]; self.zone.len()];
        }
        seen.temperatures.wheel_mean = self.wheel;
        seen.temperatures.wheel_max = seen.surface[0][0];
        Ok(())
    }

    fn mean_over_depth(&self, _state: &HeatState, depth: f64, out: &mut [Vec<f64>; 2]) -> Result<(), HeatError> {
        let ahead = |rise: f64| self.zone.iter().map(|x| if *x > 0.0 { rise * depth } else { 0.0 }).collect();
        *out = [self.per_depth, 0.0].map(ahead);
        Ok(())
    }

    fn depth_weights(&self, _body: usize, depths: &[f64]) -> Vec<f64> {
        depths.to_vec()
    }

    fn column(&self, _body: usize, _state: &HeatState, _s: f64, _weights: &[f64], column: &mut [f64]) {
        column.fill(0.0);
    }

    fn fields(&self, _state: &HeatState) -> Result<[TemperatureField; 2], HeatError> {
        Ok([0, 1].map(|_| TemperatureField { mesh: Default::default(), temperature: vec![0.0] }))
    }
}

/// State of a standing wheel on heat that is told, and its outputs.
fn standing(config: &Config, told: &Told) -> (State, Outputs) {
    let basis = common::store().find(config).unwrap();
    let basis = basis.map_or_else(|| Basis::compute(&config.into(), &mut |_, _| {}).unwrap(), |(basis, _)| basis);
    let pair = bodies(&config.into(), Some(basis), &mut |_, _| {}).unwrap();
    let model = RollingModel::new(config.clone(), pair, Surfaces::smooth(config.wheel.radius)).unwrap();
    let model = model
        .with_heat(|config| {
            let zone = (0..=2000).map(|i| config.reach * (f64::from(i) / 1000.0 - 1.0)).collect();
            Ok(Box::new(Told { zone, ..told.clone() }))
        })
        .unwrap();
    let mut inputs = Inputs::rolling(config);
    (inputs.rotation, inputs.translation) = (Rotation::Velocity, Translation::Velocity);
    (inputs.drive.omega, inputs.drive.velocity) = (0.0, 0.0);
    let state = stationary::start(&model, &config.tuning, &inputs, &mut Workspace::default()).unwrap();
    let seen = observe(&model, &state);
    (state, seen)
}

fn steel() -> Config {
    let mut config = preset("railway", 10);
    (config.initial.velocity, config.initial.temperature) = (0.0, StartTemperature::Uniform);
    config
}

/// Half-spaces of the material that are heated evenly down to some depth: cold steel below holds the layer in its plane, so that
/// `σ_x = σ_y` make `ε_x = 0`, and `σ_z = 0`. Then `ε_z = (1 + ν)/(1 − ν) α T`, and `σ_x = −E α T/(1 − ν)`.
#[test]
fn heated_half_spaces_lift_the_wheel_by_their_swelling_and_are_held_by_their_membrane_force() {
    let (alpha, nu, modulus) = (1.2e-5, 0.3, 210e9);
    let config = steel();
    let (_, cold) = standing(&config, &Told::default());
    for layers in [[0.2, 0.0], [0.0, 0.2], [0.15, 0.05]] {
        let (state, hot) = standing(&config, &Told { layers, ..Told::default() });
        let swelling = layers.map(|heat| (1.0 + nu) / (1.0 - nu) * alpha * heat);
        let membrane = layers.map(|heat| modulus * alpha / (1.0 - nu) * heat);
        let (lift, expected) = (hot.hub_height - cold.hub_height, swelling[0] + swelling[1]);
        println!("{layers:?} K m: lift {lift:.6e} of {expected:.6e} m");
        let deformation = state.lines[0].deformation();
        for body in [0, 1] {
            let [swollen, held] = [&deformation.swelling, &deformation.membrane_force].map(|of| of[body].at(0.0));
            println!("body {body}: {swollen:.5e} m, {held:.5e} N/m");
            assert!((swollen - swelling[body]).abs() <= 1e-12 * expected);
            assert!((held - membrane[body]).abs() <= 1e-12 * (membrane[0] + membrane[1]));
        }
        assert!((lift / expected - 1.0).abs() < 1e-6, "{lift:e} for {expected:e}");
    }
}

/// `α T̄ r` of the mean temperature of a free wheel; the hub rises by it.
#[test]
fn a_warm_wheel_grows_by_expansion_times_temperature_times_radius_and_stands_higher_by_that() {
    let config = steel();
    let [cold, warm] = [0.0, 40.0].map(|wheel| standing(&config, &Told { wheel, ..Told::default() }).1);
    let (expected, lift) = (1.2e-5 * 40.0 * 0.46, warm.hub_height - cold.hub_height);
    println!("growth {:.6e}, lift {lift:.6e} of {expected:.6e} m", warm.thermal_growth);
    assert!((warm.thermal_growth / expected - 1.0).abs() < 1e-12);
    assert!((lift / expected - 1.0).abs() < 1e-6);
}

/// The strength is that of the mean temperature over half the half-width, and its mean over that depth to both sides
/// (`docs/theory/limits-of-steel.md`, section 2): the wheel is hot in front of the contact point, by 200 K per millimetre of this
/// depth, and cold behind it, so that the strength falls evenly over twice the depth.
#[test]
fn steel_weakens_by_the_mean_temperature_over_half_the_half_width_and_as_far_to_both_sides() {
    let config = steel();
    let (state, seen) = standing(&config, &Told { per_depth: 2e5, ..Told::default() });
    let depth = 0.5 * seen.contact_half_width;
    let hot = yield_share(config.thermal.reference + 2e5 * depth);
    for place in [-1.2, -0.5, 0.0, 0.5, 1.2_f64] {
        let expected = 1.0 - (1.0 - hot) * (0.5 + 0.5 * place).clamp(0.0, 1.0);
        let found = state.lines[0].weakening().strength.at(place * depth);
        println!("{place} of {:.4} mm: {found:.5} for {expected:.5}", 1e3 * depth);
        assert!((0.1..0.7).contains(&hot) && (found / expected - 1.0).abs() < 0.01, "{found} for {expected}");
    }
}

/// 0 °C \[K].
const ICE: f64 = 273.15;

/// Temperature \[°C] and share of the cold yield strength: EN 1993-1-2:2005, table 3.1, up to 1100 °C; the last one is chosen
/// (`docs/theory/limits-of-steel.md`, section 2).
const TABLE: [(f64, f64); 9] = [
    (400.0, 1.0),
    (500.0, 0.78),
    (600.0, 0.47),
    (700.0, 0.23),
    (800.0, 0.11),
    (900.0, 0.06),
    (1000.0, 0.04),
    (1100.0, 0.02),
    (1180.0, 0.004),
];

#[test]
fn steel_keeps_the_shares_of_its_strength_that_en_1993_1_2_gives_and_linear_ones_between() {
    for (celsius, share) in TABLE {
        let found = yield_share(celsius + ICE);
        println!("{celsius} degC: {found}");
        assert!((found / share - 1.0).abs() < 1e-9, "{celsius} degC: {found} for {share}");
    }
    for pair in TABLE.windows(2) {
        let middle = yield_share(0.5 * (pair[0].0 + pair[1].0) + ICE);
        assert!((middle / (0.5 * (pair[0].1 + pair[1].1)) - 1.0).abs() < 1e-9, "{pair:?}: {middle}");
    }
    assert_eq!([20.0, 399.0, 1600.0].map(|celsius| yield_share(celsius + ICE)), [1.0, 1.0, 0.004]);
}

/// Prandtl's `(2 + π)/√3` times the strength of the table: an overloaded contact that rolls, all of which is as hot as the rail
/// and the air. At the limit of the load steel gives way by some micrometres, which adds 0.1 MPa.
#[test]
fn rolling_steel_of_any_temperature_bears_prandtls_pressure_of_its_strength_in_the_table() {
    for (celsius, share) in [(300.0, 1.0), (450.0, 0.89), (600.0, 0.47), (700.0, 0.23)] {
        let mut config = preset("railway", 10);
        config.thermal.reference = celsius + ICE;
        // The load fits the strength, so that a third of the contact yields.
        config.model.nominal_load = 1e5 * share;
        config.material.yield_strength = 230e6 * share.recip().sqrt();
        let expected = (2.0 + std::f64::consts::PI) / 3.0_f64.sqrt() * share * config.material.yield_strength;
        let model = model(config.clone());
        let mut inputs = Inputs::rolling(&config);
        inputs.drive.load = config.model.nominal_load;
        let mut simulation = Simulation::new(model, &inputs).unwrap();
        for _ in 0..20 {
            simulation.advance(&inputs, 1e-3).unwrap();
        }
        let outputs = simulation.outputs();
        println!(
            "{celsius} degC: {:.3} of {:.3} MPa, {:.2} yields",
            1e-6 * outputs.contact_pressure_max,
            1e-6 * expected,
            outputs.yielded
        );
        assert!(outputs.yielded > 0.1, "{}", outputs.yielded);
        assert!((outputs.contact_pressure_max / expected - 1.0).abs() < 2e-3, "{}", outputs.contact_pressure_max);
    }
}

/// `docs/theory/limits-of-steel.md`, section 7: 1 at the solidus, that of a film at the liquidus, none 40 K above.
#[test]
fn friction_of_molten_steel_falls_to_that_of_its_film_and_to_none_40_kelvin_above_the_liquidus() {
    let material = Material::default();
    let film = MeltingFilm { solidus: material.solidus, liquidus: material.liquidus, friction: 0.1 };
    let middle = 0.5 * (material.solidus + material.liquidus);
    for (temperature, share) in [
        (material.solidus - 50.0, 1.0),
        (material.solidus, 1.0),
        (middle, 0.55),
        (material.liquidus, 0.1),
        (material.liquidus + 20.0, 0.05),
        (material.liquidus + 40.0, 0.0),
    ] {
        let found = melted_share(0.0, temperature, &film);
        println!("{temperature} K: {found}");
        assert!((found - share).abs() < 1e-12, "{temperature} K: {found} for {share}");
    }
}
