//! A run with the derivatives of its records, in reverse.

use mascarin_engine::derivatives;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::run::Options;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{attended, caught, to_python};
use crate::options::RunOptions;
use crate::plan::{Plan, contiguous, describe_run};

/// A run that keeps what its derivatives in reverse need.
#[pyclass(frozen, module = "mascarin._engine")]
pub struct Trajectory {
    plan: Py<Plan>,
    values: Vec<f64>,
    forcing: Vec<f64>,
    stages: usize,
    channels: usize,
    options: Options,
    kept: derivatives::Trajectory,
}

#[pymethods]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands arrays over by value")]
impl Trajectory {
    /// A run that keeps about `memory` bytes.
    #[new]
    fn new(
        py: Python<'_>,
        plan: Py<Plan>,
        values: PyReadonlyArray1<'_, f64>,
        forcing: PyReadonlyArray3<'_, f64>,
        options: RunOptions,
        memory: usize,
    ) -> PyResult<Self> {
        caught(|| {
            let options = options.read()?;
            let (_, stages, channels) = forcing.as_array().dim();
            let (values, forcing) =
                (contiguous(values.as_slice())?.to_vec(), contiguous(forcing.as_slice())?.to_vec());
            let drive = Forcing::new(&forcing, stages, channels).map_err(|e| to_python(&e))?;
            let model = &plan.get().plan;
            let kept = attended(py, None, |watch| {
                derivatives::Trajectory::new(model, &values, &drive, &options, watch, memory)
            })?;
            Ok(Self { plan, values, forcing, stages, channels, options, kept })
        })
    }

    /// What `Plan.simulate_into` gives, with the records.
    fn run<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        caught(|| {
            let steps = self.forcing.len() / (self.stages * self.channels);
            let run = &self.kept.run;
            let shape = [self.options.rows(steps), self.options.outputs.len()];
            describe_run(py, run, PyArray1::from_slice(py, &run.records).reshape(shape)?)
        })
    }

    /// Slopes by all parameters of the sum of weights (rows x outputs) times records.
    fn pull<'py>(
        &self,
        py: Python<'py>,
        weights: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        caught(|| {
            let weights = contiguous(weights.as_slice())?;
            let drive = Forcing::new(&self.forcing, self.stages, self.channels).map_err(|e| to_python(&e))?;
            let plan = &self.plan.get().plan;
            let slopes = attended(py, None, |watch| {
                self.kept.pull(plan, &self.values, &drive, &self.options, watch, weights)
            })?;
            Ok(PyArray1::from_vec(py, slopes))
        })
    }
}
