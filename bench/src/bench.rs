//! The bench: at most one run, the bases of runs to come, and what goes in.

use crate::frame::{self, Window};
use crate::run::Run;
use crate::settings::Settings;
use wheelrail::simulation::{BasisStore, basis_file_name};

/// Answer to a call.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// A text.
    Text(String),
    /// Numbers.
    Numbers(Vec<f64>),
}

/// Said where a call needs a run.
const NO_RUN: &str = "no run has been started";

/// One bench.
#[derive(Default)]
pub struct Bench {
    /// Bytes that go in with the next call.
    pub input: Vec<u8>,
    store: BasisStore,
    run: Option<Run>,
    window: Window,
}

impl Bench {
    /// Bench with the bases of a store.
    pub fn with_store(store: BasisStore) -> Self {
        Self { store, ..Self::default() }
    }

    /// A call with a text as input.
    pub fn with<R>(&mut self, input: &str, call: impl FnOnce(&mut Self) -> R) -> R {
        self.input = input.as_bytes().to_vec();
        call(self)
    }

    fn text_in(&self) -> Result<&str, String> {
        std::str::from_utf8(&self.input).map_err(|error| format!("the input is no text: {error}"))
    }

    /// Takes the input for the file of a reduced basis.
    ///
    /// # Errors
    /// Bytes that are none.
    pub fn hold_basis(&mut self) -> Result<Reply, String> {
        let bytes = std::mem::take(&mut self.input);
        let name = self.store.hold(bytes).map_err(|error| error.to_string())?;
        Ok(Reply::Text(name))
    }

    /// Name of the file with the basis of the run of a link.
    ///
    /// # Errors
    /// A link that is none.
    pub fn basis_name(&self) -> Result<Reply, String> {
        let settings = Settings::from_link(self.text_in()?).map_err(|error| error.to_string())?;
        Ok(Reply::Text(basis_file_name(&settings.config()?)))
    }

    /// Starts the run of a link, in the place of the one before.
    ///
    /// # Errors
    /// A link that is none, a start that was not found; the run before stays.
    pub fn start(&mut self) -> Result<Reply, String> {
        let settings = Settings::from_link(self.text_in()?).map_err(|error| error.to_string())?;
        let patch = settings.patch;
        self.run = Some(Run::start(settings, &self.store)?);
        self.window = Window::default();
        Ok(Reply::Text(frame::description(patch).to_string()))
    }

    fn run(&mut self) -> Result<&mut Run, String> {
        self.run.as_mut().ok_or_else(|| NO_RUN.to_owned())
    }

    /// Does up to `count` steps.
    ///
    /// # Errors
    /// A step that was not found; those before it are done.
    pub fn step(&mut self, count: u32) -> Result<Reply, String> {
        let run = self.run()?;
        (0..count).try_for_each(|_| run.step())?;
        Ok(Reply::Text(String::new()))
    }

    /// Takes a change.
    ///
    /// # Errors
    /// A text that is none.
    pub fn change(&mut self) -> Result<Reply, String> {
        let change = self.text_in()?.to_owned();
        self.run()?.change(&change)?;
        Ok(Reply::Text(String::new()))
    }

    /// The frame.
    ///
    /// # Errors
    /// There is no run.
    pub fn frame(&mut self) -> Result<Reply, String> {
        let Self { run, window, .. } = self;
        let run = run.as_mut().ok_or_else(|| NO_RUN.to_owned())?;
        let mut numbers = Vec::new();
        frame::fill(run, window, &mut numbers);
        Ok(Reply::Numbers(numbers))
    }

    /// A text about the run.
    ///
    /// # Errors
    /// There is no run, or no text.
    pub fn text(&mut self, of: impl FnOnce(&Run) -> Result<String, String>) -> Result<Reply, String> {
        of(self.run()?).map(Reply::Text)
    }
}
