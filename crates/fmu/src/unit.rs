//! A unit without C: variables, modes, steps and states.
//!
//! Inputs hold over a communication step, in all stages of its internal steps. Everything else is that of a run of the same building.

use std::sync::Arc;

use mascarin_engine::error::EngineError;
use mascarin_engine::run::physical_limits::Outlier;

use crate::running::Running;
use crate::saved::Saved;
use mascarin_contents::{Contents, Role};

/// Part of a step that a time may be off by, from rounding in the importing program.
const TIME: f64 = 1e-6;

/// What a unit is being used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Made, or reset.
    Instantiated = 0,
    /// Its start is being set.
    Initialization = 1,
    /// Steps are made.
    Step = 2,
    /// The run has ended.
    Terminated = 3,
}

impl Mode {
    /// By its number.
    pub(crate) fn of(number: u64) -> Option<Self> {
        [Self::Instantiated, Self::Initialization, Self::Step, Self::Terminated]
            .into_iter()
            .find(|mode| *mode as u64 == number)
    }

    fn words(self) -> &'static str {
        match self {
            Self::Instantiated => "before the initialization",
            Self::Initialization => "in the initialization",
            Self::Step => "while steps are made",
            Self::Terminated => "after the end",
        }
    }
}

/// Why a call was not carried out.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// Nothing has changed: the call may be repeated with another value.
    Discard(String),
    /// The unit cannot go on.
    Error(String),
}

/// Result of a call.
pub type Outcome<T = ()> = Result<T, Refusal>;

fn error<T>(text: String) -> Outcome<T> {
    Err(Refusal::Error(text))
}

/// A unit.
pub struct Unit {
    contents: Arc<Contents>,
    mode: Mode,
    /// Step of the weather that the run starts at.
    first: usize,
    running: Option<Running>,
    parameters: Vec<f64>,
    /// Value of each input, in the order of the variables.
    inputs: Vec<f64>,
    /// Value of each output, in the order of the variables.
    outputs: Vec<f64>,
    /// Place of each variable among the inputs or the outputs.
    places: Vec<usize>,
    /// Channels and values of the inputs.
    driven: Vec<(usize, f64)>,
    /// Columns of the records that each output is the mean of.
    columns: Vec<usize>,
    rows: Vec<f64>,
    records: Vec<f64>,
}

impl Unit {
    /// A unit with the start values of its variables.
    #[must_use]
    pub fn new(contents: Contents) -> Self {
        let (mut inputs, mut outputs) = (0, 0);
        let place = |count: &mut usize| {
            *count += 1;
            *count - 1
        };
        let places = contents.variables.iter().map(|variable| match variable.role {
            Role::Input(_) => place(&mut inputs),
            Role::Output(_) => place(&mut outputs),
            Role::Parameter(parameter) => parameter,
        });
        let places = places.collect();
        let driven = contents.variables.iter().filter_map(|variable| match variable.role {
            Role::Input(channel) => Some((channel, variable.start)),
            _ => None,
        });
        let columns = contents.variables.iter().filter_map(|variable| match &variable.role {
            Role::Output(column) => Some(*column),
            _ => None,
        });
        let mut unit = Self {
            driven: driven.collect(),
            columns: columns.collect(),
            contents: Arc::new(contents),
            mode: Mode::Instantiated,
            first: 0,
            running: None,
            parameters: Vec::new(),
            inputs: Vec::new(),
            outputs: vec![0.0; outputs],
            places,
            rows: Vec::new(),
            records: Vec::new(),
        };
        unit.reset();
        unit
    }

    /// What is in it.
    #[must_use]
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// Back to the start values.
    pub fn reset(&mut self) {
        let Self { contents, parameters, inputs, .. } = self;
        parameters.clone_from(&contents.parameters);
        inputs.clear();
        for variable in &contents.variables {
            match variable.role {
                Role::Input(_) => inputs.push(variable.start),
                Role::Parameter(parameter) => parameters[parameter] = variable.start,
                Role::Output(_) => {}
            }
        }
        (self.mode, self.first, self.running) = (Mode::Instantiated, 0, None);
    }

    /// Time since the start of the weather [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.at() as f64 * self.contents.options.dt
    }

    /// The step of the weather that comes next.
    fn at(&self) -> usize {
        self.first + self.running.as_ref().map_or(0, Running::steps)
    }

    fn variable(&self, reference: u32) -> Outcome<usize> {
        let count = self.contents.variables.len();
        let position = (reference as usize).checked_sub(1).filter(|&position| position < count);
        position.map_or_else(
            || error(format!("found the value reference {reference}, expected one from 0 to {count}")),
            Ok,
        )
    }

    /// Values of variables.
    ///
    /// # Errors
    /// An unknown variable, or an output before the initialization.
    pub fn get(&mut self, references: &[u32], values: &mut [f64]) -> Outcome {
        for (&reference, value) in references.iter().zip(values) {
            *value = if reference == 0 { self.time() } else { self.value(reference)? };
        }
        Ok(())
    }

    fn value(&mut self, reference: u32) -> Outcome<f64> {
        let position = self.variable(reference)?;
        let place = self.places[position];
        match self.contents.variables[position].role {
            Role::Input(_) => Ok(self.inputs[place]),
            Role::Parameter(_) => Ok(self.parameters[place]),
            Role::Output(_) => {
                match self.mode {
                    Mode::Instantiated => {
                        let name = &self.contents.variables[position].name;
                        return error(format!(
                            "'{name}' has no value before the initialization; enter the initialization first"
                        ));
                    }
                    Mode::Initialization => self.bring_to_start()?,
                    Mode::Step | Mode::Terminated => {}
                }
                Ok(self.outputs[place])
            }
        }
    }

    /// Sets inputs and parameters: all of them, or none.
    ///
    /// # Errors
    /// [`Refusal::Discard`] for a value outside the limits of its variable; [`Refusal::Error`] for an output, an unknown variable or one
    /// that is fixed.
    pub fn set(&mut self, references: &[u32], values: &[f64]) -> Outcome {
        for (&reference, &value) in references.iter().zip(values) {
            self.require_settable(reference, value)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            let position = self.variable(reference)?;
            let place = self.places[position];
            match self.contents.variables[position].role {
                Role::Input(_) => self.inputs[place] = value,
                Role::Parameter(_) => self.parameters[place] = value,
                Role::Output(_) => {}
            }
        }
        if self.mode == Mode::Initialization {
            // The start depends on them.
            self.running = None;
        }
        Ok(())
    }

    fn require_settable(&self, reference: u32, value: f64) -> Outcome {
        let variable = &self.contents.variables[self.variable(reference)?];
        let (name, unit) = (&variable.name, &variable.unit);
        match (&variable.role, self.mode) {
            (Role::Output(_), _) => return error(format!("'{name}' is an output and cannot be set")),
            (Role::Parameter(_), Mode::Step | Mode::Terminated) => {
                return error(format!(
                    "'{name}' is a parameter and cannot be set {}; set it before the initialization ends",
                    self.mode.words()
                ));
            }
            (Role::Input(_), Mode::Terminated) => {
                return error(format!("'{name}' cannot be set after the end; reset the unit first"));
            }
            _ => {}
        }
        let (low, high) = (variable.low.unwrap_or(f64::NEG_INFINITY), variable.high.unwrap_or(f64::INFINITY));
        if value.is_finite() && low <= value && value <= high {
            return Ok(());
        }
        Err(Refusal::Discard(format!(
            "'{name}': found {value} {unit}, expected a value from {low} to {high} {unit}; the value {} is kept",
            match variable.role {
                Role::Input(_) => self.inputs[self.places[reference as usize - 1]],
                _ => self.parameters[self.places[reference as usize - 1]],
            }
        )))
    }

    fn require_mode(&self, mode: Mode, call: &str) -> Outcome {
        if self.mode == mode {
            return Ok(());
        }
        error(format!("{call} was called {}, expected {}", self.mode.words(), mode.words()))
    }

    /// The start is being set from now on; it is at a time [s].
    ///
    /// # Errors
    /// The start or the stop is outside the weather, or the start is within a step.
    pub fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Outcome {
        self.require_mode(Mode::Instantiated, "the initialization")?;
        let end = self.contents.steps() as f64 * self.contents.options.dt;
        let Some(first) = self.steps_in(start).filter(|&first| first < self.contents.steps()) else {
            return error(format!(
                "the start is at {start} s, expected a multiple of the internal step of {} s, from 0 to before \
                 {end} s, where the weather of the unit ends",
                self.contents.options.dt
            ));
        };
        if stop.is_some_and(|stop| stop > end * (1.0 + TIME)) {
            return error(format!(
                "the stop is at {} s, after {end} s, where the weather of the unit ends; stop earlier, or export \
                 the unit with a longer period",
                stop.unwrap_or(f64::NAN)
            ));
        }
        (self.first, self.mode, self.running) = (first, Mode::Initialization, None);
        Ok(())
    }

    /// Whole steps in a time [s]; none where it is no multiple of the step.
    fn steps_in(&self, seconds: f64) -> Option<usize> {
        let steps = seconds / self.contents.options.dt;
        let whole = steps.round();
        if !((0.0..=4_503_599_627_370_496.0).contains(&whole) && (steps - whole).abs() <= TIME) {
            return None;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and not negative")]
        Some(whole as usize)
    }

    /// The start is set.
    ///
    /// # Errors
    /// The start cannot be reached: the reason of the engine.
    pub fn exit_initialization(&mut self) -> Outcome {
        self.require_mode(Mode::Initialization, "the end of the initialization")?;
        self.bring_to_start()?;
        self.mode = Mode::Step;
        Ok(())
    }

    fn bring_to_start(&mut self) -> Outcome {
        if self.running.is_some() {
            return Ok(());
        }
        self.note_inputs();
        self.write_rows(self.first)?;
        let started = Running::start(&self.contents, &self.parameters, self.first, &self.rows);
        self.running = Some(started.or_else(|reason| error(self.dated(&reason)))?);
        self.read_outputs();
        Ok(())
    }

    /// Notes the inputs, which hold until they are set again.
    fn note_inputs(&mut self) {
        for ((_, driven), &input) in self.driven.iter_mut().zip(&self.inputs) {
            *driven = input;
        }
    }

    /// Weather of a step with the inputs.
    fn write_rows(&mut self, step: usize) -> Outcome {
        let Self { contents, rows, driven, .. } = self;
        rows.clear();
        rows.extend_from_slice(contents.rows(step, 1));
        contents.put(driven, rows);
        contents.require_apart_in(rows, &self.parameters, step).map_err(Refusal::Discard)
    }

    fn read_outputs(&mut self) {
        let Self { running, records, outputs, columns, .. } = self;
        let Some(running) = running else { return };
        running.read(records);
        for (output, &mut column) in outputs.iter_mut().zip(columns) {
            *output = records[column];
        }
    }

    /// Makes the internal steps of a communication step, from a time, of a length [s].
    ///
    /// # Errors
    /// A length that is no multiple of the internal step, another time than that of the unit, the end of the weather, set points that
    /// cross, a step that does not converge. The unit is then at the time that [`Self::time`] gives.
    pub fn step(&mut self, from: f64, length: f64) -> Outcome {
        self.require_mode(Mode::Step, "a step")?;
        let dt = self.contents.options.dt;
        let Some(steps) = self.steps_in(length).filter(|&steps| steps > 0) else {
            return error(format!(
                "found a communication step of {length} s, expected a multiple of the internal step of {dt} s; \
                 change the communication step, or export the unit with another --step"
            ));
        };
        let at = self.at();
        if self.steps_in(from) != Some(at) {
            return error(format!("found a step from {from} s, but the unit is at {} s", self.time()));
        }
        if at + steps > self.contents.steps() {
            return error(format!(
                "found a step to {} s, after {} s, where the weather of the unit ends; stop earlier, or export \
                 the unit with a longer period",
                (at + steps) as f64 * dt,
                self.contents.steps() as f64 * dt
            ));
        }
        self.note_inputs();
        let made = (at..at + steps).try_for_each(|step| self.step_once(step));
        self.read_outputs();
        made
    }

    fn step_once(&mut self, step: usize) -> Outcome {
        self.write_rows(step)?;
        let Self { running, rows, .. } = self;
        let Some(running) = running else { return error("the unit has not been started".to_owned()) };
        running.step(rows).or_else(|reason| error(self.dated(&reason)))
    }

    /// A message of the engine with the time in the unit.
    fn dated(&self, reason: &EngineError) -> String {
        format!("in the step from {} s: {reason}", self.time())
    }

    /// Ends the run; gives a remark on its energy balance, on a temperature without a cause, and on laws used where they do not hold.
    pub fn terminate(&mut self) -> String {
        let laws = self.running.as_ref().map(Running::out_of_range).unwrap_or_default();
        let beyond = laws.iter().map(|law| {
            let values = law.values.iter();
            let values =
                values.map(|at| format!("{} from {:.1} to {:.1} {}", at.name, at.least, at.most, at.unit));
            format!(
                "; warning: {}: its law of {} does not hold in {} steps, from step {} on ({})",
                law.place,
                law.law,
                law.steps,
                law.first,
                values.collect::<Vec<_>>().join(", ")
            )
        });
        let beyond: String = beyond.collect();
        self.judged() + &beyond
    }

    /// Ends the run; a remark on its energy balance, and on a temperature without a cause.
    fn judged(&mut self) -> String {
        self.mode = Mode::Terminated;
        let closure = self.running.as_ref().map_or(0.0, Running::closure);
        let balance =
            format!("{} s simulated; relative residual of the energy balance: {closure:.1e}", self.time());
        match self.running.as_ref().and_then(Running::outlier) {
            None => balance,
            Some(Outlier { step, place, temperature, bound }) => format!(
                "{balance}; warning: {place} had {temperature:.1} degC in step {step}, beyond everything that acted on it \
                 ({bound:.1} degC) and the overshoot of the scheme: export the unit with a shorter --step"
            ),
        }
    }

    /// The present state.
    #[must_use]
    pub fn save(&self) -> Saved {
        Saved {
            mode: self.mode,
            first: self.first,
            parameters: self.parameters.clone(),
            inputs: self.inputs.clone(),
            outputs: self.outputs.clone(),
            run: self.running.as_ref().map(Running::save).unwrap_or_default(),
        }
    }

    /// Back to a saved state.
    ///
    /// # Errors
    /// It is not a state of this unit; nothing is changed then.
    pub fn restore(&mut self, saved: &Saved) -> Outcome {
        let wrong = || error("the saved state is not one of this unit".to_owned());
        let sizes = [
            (saved.parameters.len(), self.parameters.len()),
            (saved.inputs.len(), self.inputs.len()),
            (saved.outputs.len(), self.outputs.len()),
        ];
        if sizes.iter().any(|(theirs, own)| theirs != own) || saved.first >= self.contents.steps() {
            return wrong();
        }
        if saved.run.is_empty() {
            self.running = None;
        } else {
            let same = self.running.as_ref().is_some_and(|running| running.has(&saved.parameters));
            if !same {
                let now = self.contents.rows(saved.first, 1);
                let running = Running::start(&self.contents, &saved.parameters, saved.first, now);
                self.running = Some(running.or_else(|reason| error(reason.to_string()))?);
            }
            if self.running.as_mut().is_none_or(|running| running.restore(&saved.run).is_err()) {
                return wrong();
            }
        }
        (self.mode, self.first) = (saved.mode, saved.first);
        self.parameters.clone_from(&saved.parameters);
        self.inputs.clone_from(&saved.inputs);
        self.outputs.clone_from(&saved.outputs);
        Ok(())
    }
}
