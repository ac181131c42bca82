//! Options of a run as they come from Python.

use std::sync::Arc;

use mascarin_engine::Scheme;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, StepLengths, Warmup};
use mascarin_engine::state::Initial;
use pyo3::prelude::*;

use crate::errors::{EngineInputError, to_python};

fn scheme_named(name: &str) -> PyResult<Scheme> {
    match name {
        "sdirk2" => Ok(Scheme::Sdirk2),
        "linearly-implicit" => Ok(Scheme::LinearlyImplicit),
        "backward-euler" => Ok(Scheme::BackwardEuler),
        "apparent-capacity" => Ok(Scheme::ApparentCapacity),
        _ => Err(EngineInputError::new_err(format!(
            "unknown scheme '{name}'; expected sdirk2, linearly-implicit, backward-euler or apparent-capacity"
        ))),
    }
}

/// Initial temperatures as they come from Python: one, or a dictionary with those of cells, faces and airs.
#[derive(FromPyObject)]
enum GivenInitial {
    Everywhere(f64),
    #[pyo3(from_item_all)]
    Given {
        cells: Vec<f64>,
        faces: Vec<f64>,
        air: Vec<f64>,
    },
}

impl From<GivenInitial> for Initial {
    fn from(given: GivenInitial) -> Self {
        match given {
            GivenInitial::Everywhere(temperature) => Self::Everywhere(temperature),
            GivenInitial::Given { cells, faces, air } => Self::Given { cells, surfaces: faces, air },
        }
    }
}

/// Options as they come from Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct RunOptions {
    dt: f64,
    scheme: String,
    initial: GivenInitial,
    warmup_steps: usize,
    warmup_tolerance: f64,
    warmup_max_cycles: usize,
    outputs: String,
    record_from: usize,
    record_every: usize,
    /// How often the record interval `dt` is halved for each step; all steps are `dt` where it is left out.
    #[pyo3(default)]
    halvings: Option<Vec<u8>>,
    /// Whether residuals are evaluated; not where it is left out.
    #[pyo3(default)]
    residuals: bool,
}

impl RunOptions {
    /// The options as the engine takes them.
    pub fn read(self) -> PyResult<Options> {
        let outputs: Vec<Output> = serde_json::from_str(&self.outputs)
            .map_err(|error| EngineInputError::new_err(format!("unreadable outputs: {error}")))?;
        let warmup = (self.warmup_steps > 0).then_some(Warmup {
            steps: self.warmup_steps,
            tolerance: self.warmup_tolerance,
            max_cycles: self.warmup_max_cycles,
        });
        let lengths = self.halvings.map(StepLengths::new).transpose().map_err(|e| to_python(&e))?;
        Ok(Options {
            dt: self.dt,
            lengths: lengths.map(Arc::new),
            scheme: scheme_named(&self.scheme)?,
            initial: self.initial.into(),
            warmup,
            outputs,
            record_from: self.record_from,
            record_every: self.record_every,
            residuals: self.residuals,
        })
    }
}
