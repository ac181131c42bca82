//! Cases that `bench/engine_cases.py` wrote: a building, its parameters, its weather and how it is run.

use std::fs;
use std::path::{Path, PathBuf};

use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::description::Description;
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::simd;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, simulate};
use mascarin_engine::state::Initial;
use serde::Deserialize;

/// Stages of a step of the scheme that all cases use.
pub const STAGES: usize = 2;

/// Parameters that [`Case::jacobian`] takes slopes by.
pub const SLOPES: usize = 7;

/// What [`Case::gradient`] may keep, as through Python [B].
const MEMORY: usize = 256 << 20;

/// What stands in the JSON file of a case; nothing is repeated before it. The weather is beside it, in plain numbers.
#[derive(Deserialize)]
struct Written {
    description: Description,
    values: Vec<f64>,
    /// Members x parameters: one pack.
    members: Vec<f64>,
    outputs: Vec<Output>,
    dt: f64,
    initial: f64,
}

/// A case, ready to run.
pub struct Case {
    /// Its name.
    pub name: String,
    plan: Plan,
    values: Vec<f64>,
    members: Vec<f64>,
    weather: Vec<f64>,
    options: Options,
}

impl Case {
    /// Reads a case from its JSON file and the `.f64` file beside it.
    ///
    /// # Panics
    /// When a file is missing or damaged.
    pub fn read(path: &Path) -> Self {
        let text = fs::read(path).expect("the case's JSON file");
        let written: Written = serde_json::from_slice(&text).expect("a case as engine_cases.py writes it");
        let bytes = fs::read(path.with_extension("f64")).expect("the case's weather");
        let (numbers, rest) = bytes.as_chunks::<8>();
        assert!(rest.is_empty(), "weather in numbers of eight bytes");
        Self {
            name: path.file_stem().expect("a name").to_string_lossy().into_owned(),
            plan: Plan::new(written.description).expect("a sound description"),
            values: written.values,
            members: written.members,
            weather: numbers.iter().map(|number| f64::from_le_bytes(*number)).collect(),
            options: Options {
                dt: written.dt,
                scheme: Scheme::Sdirk2,
                initial: Initial::Everywhere(written.initial),
                warmup: None,
                outputs: written.outputs,
                record_from: 0,
                record_every: 1,
                residuals: false,
                lengths: None,
            },
        }
    }

    /// All cases of a folder, by name.
    ///
    /// # Panics
    /// When there are none.
    pub fn read_all(folder: &Path) -> Vec<Self> {
        let files =
            fs::read_dir(folder).expect("the folder with the cases").map(|file| file.expect("a file").path());
        let mut paths: Vec<PathBuf> =
            files.filter(|path| path.extension().is_some_and(|end| end == "json")).collect();
        paths.sort();
        assert!(!paths.is_empty(), "no cases in {}", folder.display());
        paths.iter().map(|path| Self::read(path)).collect()
    }

    fn forcing(&self, steps: Option<usize>) -> Forcing<'_> {
        let row = STAGES * self.plan.n_channels();
        let end = steps.map_or(self.weather.len(), |steps| (steps * row).min(self.weather.len()));
        Forcing::new(&self.weather[..end], STAGES, self.plan.n_channels()).expect("weather of two stages")
    }

    /// One run over some steps, or all.
    ///
    /// # Errors
    /// As the engine's.
    ///
    /// # Panics
    /// When its energy does not close.
    pub fn run(&self, steps: Option<usize>) -> Result<(), EngineError> {
        let run =
            simulate(&self.plan, &self.values, &self.forcing(steps), &self.options, &RunControl::default())?;
        assert!(run.energy_balance.closure() < 1e-10, "energy closes");
        Ok(())
    }

    /// One pack of members, daily values kept.
    ///
    /// # Errors
    /// As the engine's.
    ///
    /// # Panics
    /// When a member failed.
    pub fn pack(&self, steps: Option<usize>) -> Result<(), EngineError> {
        let options = Options { record_every: 96, ..self.options.clone() };
        let done = ensemble::ensemble(
            &self.plan,
            &self.members,
            &self.forcing(steps),
            &options,
            &RunControl::default(),
        )?;
        assert!(done.failures.is_empty(), "{:?}", done.failures);
        assert_eq!(done.closure.len(), simd::WIDTH);
        Ok(())
    }

    /// A run with the slopes of its records by seven parameters, spread evenly over the list.
    ///
    /// # Errors
    /// As the engine's.
    ///
    /// # Panics
    /// When a slope is not finite.
    pub fn jacobian(&self, steps: Option<usize>) -> Result<(), EngineError> {
        let count = self.values.len();
        let which: Vec<usize> = (0..SLOPES).map(|k| k * count / SLOPES).collect();
        let forcing = self.forcing(steps);
        let done =
            jacobian(&self.plan, &self.values, &which, &forcing, &self.options, &RunControl::default())?;
        assert_eq!(done.slopes.len(), SLOPES * done.records.len());
        assert!(done.slopes.iter().all(|slope| slope.is_finite()), "slopes are finite");
        Ok(())
    }

    /// A run, and the slopes of the sum of all its records by all parameters.
    ///
    /// # Errors
    /// As the engine's.
    ///
    /// # Panics
    /// When a slope is not finite.
    pub fn gradient(&self, steps: Option<usize>) -> Result<(), EngineError> {
        let (forcing, watch) = (self.forcing(steps), RunControl::default());
        let trajectory = Trajectory::new(&self.plan, &self.values, &forcing, &self.options, &watch, MEMORY)?;
        let weights = vec![1.0; trajectory.run.records.len()];
        let slopes = trajectory.pull(&self.plan, &self.values, &forcing, &self.options, &watch, &weights)?;
        assert!(slopes.iter().all(|slope| slope.is_finite()), "slopes are finite");
        Ok(())
    }
}
