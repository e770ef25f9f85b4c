//! The model description against the table of variables, the committed file and the rules of the model.

use std::collections::HashSet;
use std::path::Path;
use wheelrail::config::Config;
use wheelrail::config::retired::RETIRED;
use wheelrail::fmi::interface::Interface;
use wheelrail::fmi::presets;
use wheelrail::fmi::reference::{SECTIONS, markdown};
use wheelrail::fmi::settings::start_value;
use wheelrail::fmi::table::table;
use wheelrail::fmi::units::UNITS;
use wheelrail::fmi::v2::description::{Extent, model_description};
use wheelrail::fmi::v2::variables::{find, variables};
use wheelrail::fmi::variable::{Causality, Group, Kind, Value, Variable};
use wheelrail::simulation::{MOST_LINES, Outputs, PROFILE_POINTS};

fn with_causality(causality: Causality) -> impl Iterator<Item = &'static Variable> {
    variables().iter().filter(move |v| v.causality() == causality)
}

#[test]
fn committed_file_is_the_generated_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription.xml");
    let committed = std::fs::read_to_string(path).unwrap();
    assert!(committed == model_description(Extent::Full).unwrap(), "run `make describe`");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("modelDescription3.xml");
    let committed = std::fs::read_to_string(path).unwrap();
    assert!(committed == Interface::Three.description().unwrap(), "run `make describe`");
}

#[test]
fn committed_reference_is_the_generated_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference.md");
    assert!(std::fs::read_to_string(path).unwrap() == markdown(), "run `make describe`");
}

#[test]
fn a_profile_is_one_row_and_its_points_are_scalars() {
    let arrays: Vec<_> = table().iter().filter(|row| row.dimension.is_some()).collect();
    let lines = arrays.iter().filter(|row| row.name.starts_with("line.")).count();
    assert_eq!((arrays.len(), lines), (29, 14));
    assert_eq!(variables().len(), table().len() - 29 + 15 * PROFILE_POINTS + 14 * MOST_LINES);
    let values: Vec<f64> = (0..PROFILE_POINTS).map(|k| k as f64).collect();
    let outputs = Outputs { profile_shear: values.clone(), ..Outputs::default() };
    let shear = arrays.iter().find(|row| row.name == "profile.shear").unwrap();
    assert_eq!(shear.output(&outputs), Some(Value::Reals(values)));
    let point = variables().iter().find(|v| v.name == "profile.shear[61]").unwrap();
    assert_eq!((point.reference, point.output(&outputs)), (shear.reference + 61, Some(Value::Real(60.0))));
}

#[test]
fn names_and_references_are_unique() {
    let names: HashSet<_> = variables().iter().map(|v| &v.name).collect();
    let references: HashSet<_> = variables().iter().map(|v| v.reference).collect();
    assert_eq!((names.len(), references.len()), (variables().len(), variables().len()));
}

#[test]
fn references_and_names_of_retired_parameters_belong_to_no_variable_and_are_listed_with_their_refusals() {
    let xml = model_description(Extent::Full).unwrap();
    for gone in RETIRED {
        assert!(find(gone.number).is_none() && variables().iter().all(|v| v.name != gone.name), "{gone}");
        let note = format!("<Retired name=\"{}\" valueReference=\"{}\" refusal=\"{gone}\"/>", gone.name, gone.number);
        assert!(xml.contains(&note), "{note}");
    }
}

/// Names and causalities of the variables of a description, in its order.
fn listed(description: &str) -> Vec<(String, String)> {
    let attribute =
        |element: &str, name: &str| element.split(&format!(" {name}=\"")).nth(1)?.split('"').next().map(str::to_owned);
    let inside = description.split("<ModelVariables>").nth(1).unwrap().split("</ModelVariables>").next().unwrap();
    let elements = inside.split('<').filter(|element| element.contains(" valueReference="));
    elements.map(|element| (attribute(element, "name").unwrap(), attribute(element, "causality").unwrap())).collect()
}

/// Who opens a description in a window reads from above.
#[test]
fn what_every_run_sets_comes_first_then_inputs_outputs_expert_parameters_and_rates() {
    let rates = with_causality(Causality::Input).filter(|v| v.name.ends_with("_rate")).count();
    for interface in [Interface::Two(Extent::Full), Interface::Two(Extent::WithoutProfiles), Interface::Three] {
        let mut all = listed(&interface.description().unwrap());
        all.retain(|(_, causality)| causality != "independent");
        let first: Vec<_> = all[..5].iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(first, ["preset", "initial.velocity", "model.nominal_load", "friction.coefficient", "wheel.radius"]);
        let mut runs: Vec<(&str, usize)> = Vec::new();
        for (_, causality) in &all {
            match runs.last_mut() {
                Some((last, count)) if *last == *causality => *count += 1,
                _ => runs.push((causality.as_str(), 1)),
            }
        }
        let order: Vec<_> = runs.iter().map(|(causality, _)| *causality).collect();
        let expected = ["parameter", "input", "output", "parameter", "local", "input"];
        let has_points = interface == Interface::Two(Extent::Full);
        assert_eq!(order, expected.into_iter().filter(|c| has_points || *c != "local").collect::<Vec<_>>());
        assert_eq!((rates, runs.last().unwrap().1), (16, 16));
        println!("{interface:?}: {runs:?}");
    }
    let basic = SECTIONS[0].rows().count();
    assert!(table()[..basic].iter().all(|row| row.group() == Group::Basic) && table()[basic].group() == Group::Input);
}

/// Points are read by name and reference, and no output: windows that show all outputs would show a thousand of them.
#[test]
fn points_of_profiles_are_local_in_fmi_2_and_arrays_are_outputs_in_fmi_3() {
    let two = listed(&model_description(Extent::Full).unwrap());
    for (name, causality) in &two {
        assert_eq!(causality == "local", name.contains('['), "{name} is {causality}");
    }
    let three = listed(&Interface::Three.description().unwrap());
    assert!(three.iter().all(|(_, causality)| causality != "local"));
    let count = |all: &[(String, String)], causality: &str| all.iter().filter(|(_, c)| c == causality).count();
    let arrays = table().iter().filter(|row| row.dimension.is_some()).count();
    println!(
        "FMI 2.0: {} outputs, {} local; FMI 3.0: {} outputs",
        count(&two, "output"),
        count(&two, "local"),
        count(&three, "output")
    );
    assert_eq!(count(&two, "output") + arrays, count(&three, "output"));
    let indices = |text: &str, section: &str| -> Vec<usize> {
        let inside =
            text.split(&format!("<{section}>")).nth(1).unwrap().split(&format!("</{section}>")).next().unwrap();
        inside.split("index=\"").skip(1).map(|part| part.split('"').next().unwrap().parse().unwrap()).collect()
    };
    let expected: Vec<_> =
        (1..).zip(&two).filter(|(_, (_, c))| c == "output").map(|(index, _): (usize, _)| index).collect();
    for section in ["Outputs", "InitialUnknowns"] {
        assert_eq!(indices(&model_description(Extent::Full).unwrap(), section), expected);
    }
}

/// Programs of other people read descriptions by classes that refuse attributes they do not know.
#[test]
fn types_of_fmi_3_have_no_descriptions_at_which_old_versions_of_fmpy_fail() {
    let text = Interface::Three.description().unwrap();
    let types: Vec<_> = text.split("<EnumerationType").skip(1).map(|part| part.split('>').next().unwrap()).collect();
    let choices: HashSet<_> = variables()
        .iter()
        .filter_map(|variable| match variable.kind {
            Kind::Enumeration(choice) => Some(choice.name),
            _ => None,
        })
        .collect();
    assert_eq!(types.len(), choices.len());
    assert!(types.iter().all(|attributes| !attributes.contains("description=")), "{types:?}");
    assert!(!text.split("<Float64Type").skip(1).any(|part| part.split('>').next().unwrap().contains("description=")));
}

/// All parameters are listed once, the basic ones first, whatever the order of their references.
#[test]
fn reference_pages_show_some_thirty_basic_parameters_before_the_expert_ones() {
    let titles = SECTIONS.each_ref().map(|section| section.title);
    assert_eq!(titles, ["Basic parameters", "Inputs", "Outputs", "Expert parameters"]);
    let [basic, .., expert] = SECTIONS.each_ref().map(|section| section.rows().map(|row| row.name).collect::<Vec<_>>());
    assert!((25..=41).contains(&basic.len()), "{} basic parameters", basic.len());
    assert_eq!(basic.len() + expert.len(), with_causality(Causality::Parameter).count());
    for name in ["preset", "wheel.radius", "model.nominal_load", "friction.coefficient", "material.density"] {
        assert!(basic.contains(&name), "{name}");
    }
    assert!(expert.contains(&"rail.restraint_stiffness"));
    let page = markdown();
    let [first, second, retired] = ["Basic parameters", "Expert parameters", "Retired parameters"]
        .map(|text| page.find(text).unwrap_or_else(|| panic!("{text} is missing")));
    assert!(first < second && second < retired);
    let row = |name: &&str| page.find(&format!("`{name}`")).unwrap();
    assert!(basic.iter().all(|name| (first..second).contains(&row(name))));
    assert!(expert.iter().all(|name| (second..retired).contains(&row(name))));
}

#[test]
fn inputs_and_parameters_start_inside_their_ranges_and_outputs_have_no_start() {
    for variable in variables() {
        let start = start_value(variable);
        assert_eq!(start.is_some(), variable.causality() != Causality::Output, "{}", variable.name);
        if let Some(start) = start {
            assert_eq!(variable.check(&start), Ok(()));
        }
    }
}

#[test]
fn units_and_display_units_are_defined() {
    for variable in variables() {
        if let Kind::Real { measure, .. } = variable.kind {
            let unit = UNITS.iter().find(|unit| unit.name == measure.unit).expect(measure.unit);
            let known = |display| unit.displays.iter().any(|known| known.name == display);
            assert!(measure.display.is_none_or(known), "{}: {measure:?}", variable.name);
        }
    }
}

/// Masters scale tolerances and pictures by them.
#[test]
fn every_real_input_and_output_has_a_nominal_value_in_both_descriptions() {
    for (interface, element) in [(Interface::Two(Extent::Full), "<ScalarVariable "), (Interface::Three, "<Float64 ")] {
        let text = interface.description().unwrap();
        let others = ["causality=\"parameter\"", "causality=\"independent\""];
        let variables = text.split(element).skip(1).filter(|v| !others.iter().any(|other| v.contains(other)));
        let reals: Vec<_> = variables.filter(|v| v.split("Variable>").next().unwrap().contains(" unit=")).collect();
        let missing: Vec<_> = reals.iter().filter(|v| !v.split("/>").next().unwrap().contains(" nominal=")).collect();
        assert!(reals.len() > 140 && missing.is_empty(), "{missing:?}");
        println!("{interface:?}: {} real inputs and outputs with nominal values", reals.len());
    }
}

#[test]
fn descriptions_are_there_and_plain() {
    for variable in variables() {
        let text = &variable.description;
        assert!(text.len() > 10 && !text.ends_with('.') && !text.contains('\n'), "{}: {text}", variable.name);
    }
}

#[test]
fn every_preset_is_valid() {
    let resources = Path::new(env!("CARGO_MANIFEST_DIR")).join("resources");
    let names = presets::available(Some(&resources));
    let papers = ["paper_a", "paper_b", "paper_c", "paper_d"];
    assert_eq!(names[..4], papers);
    assert_eq!(
        names[4..],
        [
            "railway",
            "railway_damage",
            "railway_dry",
            "railway_ellipse",
            "railway_low_adhesion",
            "railway_s1002_0mm",
            "railway_s1002_3mm",
            "railway_wet"
        ]
    );
    for name in names {
        let config = presets::load(Some(&resources), &name).unwrap_or_else(|error| panic!("{error}"));
        wheelrail::simulation::Inputs::rolling(&config).validate().unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    assert_eq!(presets::load(Some(&resources), presets::DEFAULT), Ok(Config::default()));
}

/// Every field of the configuration is a parameter of the interface and has its name there; tunable ones are together
/// in `tuning`, or in `files` if no result depends on them, and keep the group of their name.
#[test]
fn parameters_are_the_fields_of_the_configuration() {
    let json = serde_json::to_value(Config::default()).unwrap();
    let mut fields: Vec<String> = Vec::new();
    for (group, content) in json.as_object().unwrap() {
        fields.extend(content.as_object().unwrap().keys().map(|name| format!("{group}.{name}")));
    }
    // Only code sets these.
    fields.retain(|field| !Config::INSIDE.contains(&field.as_str()));
    fields.push("preset".to_owned());
    let group = |v: &'static Variable| match v.name.split_once('.') {
        Some(_) if v.name == "wheel.profile_save" => "files",
        Some(_) if v.tunable => "tuning",
        Some((group, _)) => group,
        None => "",
    };
    let field = |v: &'static Variable| match v.name.split_once('.') {
        Some((_, name)) => format!("{}.{name}", group(v)),
        None => v.name.to_owned(),
    };
    let mut names: Vec<_> = with_causality(Causality::Parameter).map(field).collect();
    fields.sort();
    names.sort();
    assert_eq!(names, fields);
    for variable in with_causality(Causality::Parameter).filter(|v| v.name != "preset") {
        let (group, name) = (group(variable), variable.name.split_once('.').unwrap().1);
        let field = |config: &Config| serde_json::to_value(config).unwrap()[group][name].clone();
        let mut config = Config::default();
        let value = match variable.parameter("", &config).unwrap() {
            Value::Real(v) => Value::Real(v + 1e-3),
            Value::Integer(v) => Value::Integer(v + 1),
            Value::Boolean(v) => Value::Boolean(!v),
            Value::String(text) => Value::String(text + "another"),
            other => other,
        };
        variable.set_parameter(&mut config, &value);
        assert_ne!(field(&config), field(&Config::default()), "{} reaches its field", variable.name);
        assert_eq!(variable.parameter("", &config), Some(value));
    }
}

/// The smallest numbers outside a range, and the bounds themselves.
fn around(min: f64, max: f64) -> ([f64; 2], [f64; 2]) {
    ([min.next_down(), max.next_up()], [min, max])
}

#[test]
fn declared_ranges_of_inputs_are_those_of_the_model() {
    let inputs = wheelrail::simulation::Inputs::rolling(&Config::default());
    for variable in with_causality(Causality::Input) {
        let Kind::Real { min, max, .. } = variable.kind else {
            continue;
        };
        let (outside, inside) = around(min, max);
        let validated = |value| {
            let mut inputs = inputs;
            variable.set_input(&mut inputs, &Value::Real(value));
            inputs.validate()
        };
        for value in outside.into_iter().chain([f64::NAN]) {
            let error = validated(value).expect_err(variable.name);
            assert!(error.to_string().contains(variable.name), "{error}");
        }
        for value in inside {
            assert_eq!(validated(value).map_err(|error| error.to_string()), Ok(()));
        }
    }
}

/// Ranges of the interface are at least as wide as those of the model, which may depend on other parameters.
#[test]
fn values_outside_declared_ranges_of_parameters_are_refused_by_the_model() {
    for variable in with_causality(Causality::Parameter) {
        let values = match variable.kind {
            Kind::Real { min, max, .. } => around(min, max).0.map(Value::Real),
            Kind::Integer { min, max } => [min - 1, max + 1].map(Value::Integer),
            _ => continue,
        };
        for value in values {
            let mut config = Config::default();
            variable.set_parameter(&mut config, &value);
            let error = config.validate().expect_err(variable.name);
            assert_eq!(error.name(), variable.name);
            assert!(variable.check(&value).is_err());
        }
    }
}

#[test]
fn tunable_parameters_are_those_that_nothing_computed_in_advance_depends_on() {
    let start = Config::default();
    for variable in variables().iter().filter(|v| v.causality() == Causality::Parameter) {
        let mut changed = start.clone();
        match variable.parameter("", &changed) {
            Some(Value::Real(v)) => variable.set_parameter(&mut changed, &Value::Real(0.9 * v + 0.011)),
            Some(Value::Integer(v)) => {
                let other = if matches!(variable.kind, Kind::Enumeration(_)) { 3 - v.min(2) } else { v + 1 };
                variable.set_parameter(&mut changed, &Value::Integer(other));
            }
            Some(Value::Boolean(v)) => variable.set_parameter(&mut changed, &Value::Boolean(!v)),
            _ => continue,
        }
        assert!(changed != start, "{}", variable.name);
        assert_eq!(start.tuned_like(&changed) == changed, variable.tunable, "{}", variable.name);
    }
}

#[test]
fn a_description_without_profiles_says_less_of_the_same_interface() {
    let [full, slim] = [Extent::Full, Extent::WithoutProfiles].map(|extent| model_description(extent).unwrap());
    let names = |text: &str| {
        let parts: Vec<_> =
            text.split("<ScalarVariable ").skip(1).map(|part| part.split('>').next().unwrap()).collect();
        parts.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let (all, listed) = (names(&full), names(&slim));
    assert!(listed.iter().all(|head| all.contains(head) && !head.contains("profile.")));
    let profiles: usize = table().iter().filter_map(|row| row.dimension).sum();
    assert_eq!(all.len() - listed.len(), profiles);
    assert!(profiles >= 366, "{profiles}");
    // Indices of outputs count the variables that are listed.
    let unknowns: Vec<usize> = slim
        .split("<Outputs>")
        .nth(1)
        .unwrap()
        .split("</Outputs>")
        .next()
        .unwrap()
        .split("index=\"")
        .skip(1)
        .map(|part| part.split('"').next().unwrap().parse().unwrap())
        .collect();
    let outputs: Vec<usize> =
        (1..).zip(&listed).filter(|(_, head)| head.contains("causality=\"output\"")).map(|(index, _)| index).collect();
    assert_eq!(unknowns, outputs);
    let guid = |text: &str| text.split("guid=\"").nth(1).unwrap()[..36].to_owned();
    assert_eq!(guid(&full), guid(&slim));
}

#[test]
fn terminals_name_variables_that_exist_and_only_differences_of_temperature_are_relative() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/terminalsAndIcons.xml");
    let text = std::fs::read_to_string(path).unwrap();
    let members: Vec<_> = text.split("variableName=\"").skip(1).map(|part| part.split('"').next().unwrap()).collect();
    for name in &members {
        assert!(variables().iter().any(|variable| variable.name == *name), "{name}");
    }
    // What a host connects stands in one terminal: sideways motion and time derivatives of inputs, too.
    let real = |v: &&Variable| v.causality() == Causality::Input && matches!(v.kind, Kind::Real { .. });
    let times = |name: &str| members.iter().filter(|member| **member == name).count();
    assert!(table().iter().filter(real).all(|input| times(input.name) == 1));
    assert!(members.iter().all(|name| times(name) == 1));
    println!("{} inputs in {} members of terminals", table().iter().filter(real).count(), members.len());
    let relative: Vec<_> = variables()
        .iter()
        .filter(|v| matches!(v.kind, Kind::Real { measure, .. } if measure.is_relative()))
        .map(|v| v.name)
        .collect();
    assert_eq!(relative, ["thermal.wheel_excess", "solver.temperature_error", "damage.threshold"]);
}
