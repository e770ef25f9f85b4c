//! Messages of the compiled library to its master, and how long texts live.
#![allow(unsafe_code)]

use crate::slave::*;
use std::ffi::CStr;
use std::ptr;
use wheelrail::config::Config;
use wheelrail::simulation::{CACHE_VARIABLE, basis_file_name};

/// Removes the stored basis of a coarse wheel with a change, so that it is computed with progress.
fn forget_basis(change: impl Fn(&mut Config)) {
    let mut config = Config::default();
    config.mesh.elements_per_half_width = 4;
    change(&mut config);
    let cache = std::path::PathBuf::from(std::env::var(CACHE_VARIABLE).expect("cargo sets the cache of tests"));
    let _ = std::fs::remove_file(cache.join("basis").join(basis_file_name(&config)));
}

#[test]
fn messages_are_formats_without_arguments_and_come_only_when_wanted() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    let text = "100%s%n%d";
    assert_eq!(slave.set_string("preset", text), fmi2Error);
    let messages = slave.messages();
    // A master that prints the format as it is sees every percent sign twice, one that uses `printf` sees the message.
    assert_eq!(messages.len(), 1);
    assert!(messages[0].format.contains("preset = \"100%%s%%n%%d\" is not"), "{messages:?}");
    assert!(messages[0].text.contains("preset = \"100%s%n%d\" is not"), "{messages:?}");
    assert_eq!((messages[0].instance.as_str(), messages[0].category.as_str()), ("wheel", "logStatusError"));
    slave.initialize();
    assert_eq!(slave.reset(), fmi2OK);
    assert_eq!(slave.messages(), [], "quiet unless asked");

    slave.refused(slave.set_logging(true, &["nonsense"]), &["nonsense", "logEvents"]);
    assert_eq!(slave.set_logging(true, &["logEvents"]), fmi2OK);
    slave.refused(slave.set_string("preset", text), &[text]);
    assert_eq!(slave.reset(), fmi2OK);
    let messages = slave.messages();
    assert_eq!((messages[0].status, messages[0].category.as_str()), (fmi2OK, "logEvents"));
    assert_eq!(slave.set_logging(false, &[]), fmi2OK);
    assert_eq!(slave.reset(), fmi2OK);
    assert_eq!(slave.messages(), []);

    forget_basis(|config| config.wheel.radius = 0.47);
    let slave = Slave::try_new(&dll, &Arguments { logging: 1, ..Default::default() }).ok().unwrap();
    slave.coarsen();
    assert_eq!(slave.set_real("wheel.radius", 0.47), fmi2OK);
    slave.initialize();
    let messages = slave.messages();
    assert!(messages.iter().any(|m| m.category == "logProgress"), "{messages:?}");
}

#[test]
fn strings_stay_readable_until_the_next_call() {
    let dll = load();
    let slave = Slave::coarse(&dll);
    assert_eq!(slave.set_string("preset", "paper_c"), fmi2OK);
    assert_eq!(slave.enter(), fmi2OK);
    let (reference, mut value) = (variable("preset").reference, ptr::null());
    assert_eq!(unsafe { dll.fmi2GetString(slave.component, &reference, 1, &mut value) }, fmi2OK);
    assert_eq!(slave.real("drive.load"), 10e3);
    assert_eq!(unsafe { CStr::from_ptr(value) }, c"paper_c");
}

#[test]
fn every_message_carries_a_declared_category() {
    let dll = load();
    let declared = wheelrail::fmi::log::CATEGORIES.map(|(name, _)| name);
    let description = wheelrail::fmi::v2::description::model_description(Default::default()).unwrap();
    for name in declared {
        assert!(description.contains(&format!("<Category name=\"{name}\"")), "{name}");
    }
    let slave = Slave::try_new(&dll, &Arguments { logging: 1, ..Default::default() }).ok().unwrap();
    forget_basis(|config| config.wheel.radius = 0.48);
    slave.coarsen();
    assert_eq!(slave.set_real("wheel.radius", 0.48), fmi2OK);
    assert_eq!(slave.set_real("thermal.max_speed", 20.0), fmi2OK);
    slave.initialize();
    assert_eq!(slave.set_real("drive.load", 1e9), fmi2OK);
    assert_eq!(slave.step(0.0, 1e-3), fmi2Discard);
    assert_eq!(slave.set_real("drive.load", -1.0), fmi2Error);
    assert_eq!((slave.terminate(), slave.reset()), (fmi2OK, fmi2OK));
    let messages = slave.messages();
    for message in &messages {
        assert!(declared.contains(&message.category.as_str()), "{message:?}");
    }
    for category in ["logEvents", "logProgress", "logStatusWarning", "logStatusDiscard", "logStatusError"] {
        assert!(messages.iter().any(|message| message.category == category), "{category}: {messages:?}");
    }
    for category in declared {
        assert_eq!(slave.set_logging(true, &[category]), fmi2OK);
    }
}
