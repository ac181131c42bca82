//! The thin border between Python and the engine: conversion, GIL release, progress, Ctrl-C, errors.

use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

use mascarin_engine::batch;
use mascarin_engine::derivatives::jacobian::jacobian;
use mascarin_engine::derivatives::trajectory;
use mascarin_engine::description::Description;
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::{CLIMATE_CHANNELS, Forcing};
use mascarin_engine::ledger::Flow;
use mascarin_engine::march::{Options, Run, Warmup, Watch, march};
use mascarin_engine::plan::Plan as EnginePlan;
use mascarin_engine::probe::Probe;
use mascarin_engine::state::Initial;
use mascarin_engine::state_space;
use mascarin_engine::step::Scheme;
use numpy::{
    PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

create_exception!(
    _engine,
    EngineInputError,
    PyException,
    "Arrays, options or descriptions the engine refuses."
);
create_exception!(_engine, EngineSolverError, PyException, "A step or a warm-up that did not converge.");

/// How often a waiting call looks for Ctrl-C and reports progress.
const PULSE: Duration = Duration::from_millis(50);

fn to_python(error: &EngineError) -> PyErr {
    let text = error.to_string();
    match error {
        EngineError::Description(_) | EngineError::Input(_) => EngineInputError::new_err(text),
        EngineError::NotConverged { .. } | EngineError::NotSettled { .. } => EngineSolverError::new_err(text),
        EngineError::Interrupted => PyKeyboardInterrupt::new_err(text),
    }
}

/// Runs `work` on another thread with the GIL released, passing Ctrl-C on to it and progress to `report`.
fn attended<T: Send>(
    py: Python<'_>,
    report: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, EngineError> + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    let (sender, receiver) = sync_channel(1);
    let receiver = Mutex::new(receiver);
    let wait = || receiver.lock().map_or(Err(RecvTimeoutError::Disconnected), |end| end.recv_timeout(PULSE));
    let mut interruption = None;
    let result = std::thread::scope(|scope| {
        let watch = &watch;
        let worker = scope.spawn(move || {
            let result = work(watch);
            // The receiver lives until the worker is joined.
            let _ = sender.send(());
            result
        });
        let mut told = 0;
        while let Err(RecvTimeoutError::Timeout) = py.detach(wait) {
            let done = watch.done.load(Ordering::Relaxed);
            let mut attend = py.check_signals();
            if let (Ok(()), Some(report), true) = (&attend, report, done != told) {
                told = done;
                attend = report.call1((done,)).map(drop);
            }
            if let Err(error) = attend {
                watch.stop.store(true, Ordering::Relaxed);
                interruption = Some(error);
                break;
            }
        }
        py.detach(|| worker.join())
    });
    match (result, interruption) {
        (_, Some(interruption)) => Err(interruption),
        (Ok(Ok(value)), None) => Ok(value),
        (Ok(Err(error)), None) => Err(to_python(&error)),
        (Err(_), None) => Err(EngineSolverError::new_err(
            "the engine stopped on an internal fault; please report it with the building file",
        )),
    }
}

fn scheme_named(name: &str) -> PyResult<Scheme> {
    match name {
        "sdirk2" => Ok(Scheme::Sdirk2),
        "backward-euler" => Ok(Scheme::BackwardEuler),
        "apparent-capacity" => Ok(Scheme::ApparentCapacity),
        _ => Err(EngineInputError::new_err(format!(
            "unknown scheme '{name}'; expected sdirk2, backward-euler or apparent-capacity"
        ))),
    }
}

/// A building compiled for the engine.
#[pyclass(frozen, module = "mascarin._engine")]
struct Plan {
    plan: EnginePlan,
}

/// Temperatures at the start as they come from Python: one, or a dictionary with those of cells, faces and airs.
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
struct RunOptions {
    dt: f64,
    scheme: String,
    initial: GivenInitial,
    warmup_steps: usize,
    warmup_tolerance: f64,
    warmup_max_cycles: usize,
    probes: String,
    record_from: usize,
    record_every: usize,
}

impl RunOptions {
    fn read(self) -> PyResult<Options> {
        let probes: Vec<Probe> = serde_json::from_str(&self.probes)
            .map_err(|error| EngineInputError::new_err(format!("unreadable probes: {error}")))?;
        let warmup = (self.warmup_steps > 0).then_some(Warmup {
            steps: self.warmup_steps,
            tolerance: self.warmup_tolerance,
            max_cycles: self.warmup_max_cycles,
        });
        Ok(Options {
            dt: self.dt,
            scheme: scheme_named(&self.scheme)?,
            initial: self.initial.into(),
            warmup,
            probes,
            record_from: self.record_from,
            record_every: self.record_every,
        })
    }
}

/// Records, closures and failures of an ensemble.
type EnsembleArrays<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyList>);

/// Records and their slopes.
type JacobianArrays<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>);

/// A run, and what is needed to go back along it.
#[pyclass(frozen, module = "mascarin._engine")]
struct Trajectory {
    plan: Py<Plan>,
    values: Vec<f64>,
    forcing: Vec<f64>,
    stages: usize,
    channels: usize,
    options: Options,
    way: trajectory::Trajectory,
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
        let options = options.read()?;
        let (_, stages, channels) = forcing.as_array().dim();
        let (values, forcing) =
            (contiguous(values.as_slice())?.to_vec(), contiguous(forcing.as_slice())?.to_vec());
        let drive = Forcing::new(&forcing, stages, channels).map_err(|e| to_python(&e))?;
        let model = &plan.get().plan;
        let way = attended(py, None, |watch| {
            trajectory::Trajectory::new(model, &values, &drive, &options, watch, memory)
        })?;
        Ok(Self { plan, values, forcing, stages, channels, options, way })
    }

    /// What `Plan.simulate` gives.
    fn run<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let steps = self.forcing.len() / (self.stages * self.channels);
        describe_run(py, &self.way.run, [self.options.rows(steps), self.options.probes.len()])
    }

    /// Slopes by all parameters of the sum of weights (rows x probes) times records.
    fn pull<'py>(
        &self,
        py: Python<'py>,
        weights: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let weights = contiguous(weights.as_slice())?;
        let drive = Forcing::new(&self.forcing, self.stages, self.channels).map_err(|e| to_python(&e))?;
        let plan = &self.plan.get().plan;
        let slopes = attended(py, None, |watch| {
            self.way.pull(plan, &self.values, &drive, &self.options, watch, weights)
        })?;
        Ok(PyArray1::from_vec(py, slopes))
    }
}

#[pymethods]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands arrays over by value")]
impl Plan {
    #[new]
    fn new(description: &str) -> PyResult<Self> {
        let description: Description = serde_json::from_str(description)
            .map_err(|error| EngineInputError::new_err(format!("unreadable description: {error}")))?;
        let plan = EnginePlan::new(description).map_err(|error| to_python(&error))?;
        Ok(Self { plan })
    }

    #[getter]
    fn n_parameters(&self) -> usize {
        self.plan.description.parameters.len()
    }

    #[getter]
    fn n_channels(&self) -> usize {
        self.plan.n_channels()
    }

    #[getter]
    fn n_cells(&self) -> usize {
        self.plan.n_cells
    }

    /// One run: a dictionary of records, ledger and counters.
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        forcing: PyReadonlyArray3<'py, f64>,
        options: RunOptions,
    ) -> PyResult<Bound<'py, PyDict>> {
        let options = options.read()?;
        let (values, shape) = (contiguous(values.as_slice())?, forcing.as_array().dim());
        let drive =
            Forcing::new(contiguous(forcing.as_slice())?, shape.1, shape.2).map_err(|e| to_python(&e))?;
        let plan = &self.plan;
        let run = attended(py, None, |watch| march(plan, values, &drive, &options, watch))?;
        describe_run(py, &run, [options.rows(drive.steps()), options.probes.len()])
    }

    /// Members (rows of `values`): records (members x rows x probes), closures, failures.
    #[pyo3(signature = (values, forcing, options, report=None))]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray2<'py, f64>,
        forcing: PyReadonlyArray3<'py, f64>,
        options: RunOptions,
        report: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<EnsembleArrays<'py>> {
        let options = options.read()?;
        let members = values.as_array().dim().0;
        let (numbers, shape) = (contiguous(values.as_slice())?, forcing.as_array().dim());
        let drive =
            Forcing::new(contiguous(forcing.as_slice())?, shape.1, shape.2).map_err(|e| to_python(&e))?;
        let plan = &self.plan;
        let result = attended(py, report, |watch| batch::ensemble(plan, numbers, &drive, &options, watch))?;
        let rows = options.rows(drive.steps());
        let records =
            PyArray1::from_vec(py, result.records).reshape([members, rows, options.probes.len()])?;
        let failures = result.failures.iter().map(|(member, error)| (*member, error.to_string()));
        Ok((records, PyArray1::from_vec(py, result.closure), PyList::new(py, failures)?))
    }

    /// Records (rows x probes) and their slopes (parameters x rows x probes) by some parameters.
    #[pyo3(signature = (values, which, forcing, options, report=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        which: Vec<usize>,
        forcing: PyReadonlyArray3<'py, f64>,
        options: RunOptions,
        report: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<JacobianArrays<'py>> {
        let options = options.read()?;
        let (numbers, shape) = (contiguous(values.as_slice())?, forcing.as_array().dim());
        let drive =
            Forcing::new(contiguous(forcing.as_slice())?, shape.1, shape.2).map_err(|e| to_python(&e))?;
        let plan = &self.plan;
        let result = attended(py, report, |watch| jacobian(plan, numbers, &which, &drive, &options, watch))?;
        let (rows, probes) = (options.rows(drive.steps()), options.probes.len());
        let records = PyArray1::from_vec(py, result.records).reshape([rows, probes])?;
        Ok((records, PyArray1::from_vec(py, result.slopes).reshape([which.len(), rows, probes])?))
    }

    /// A, B, C, D and the names of states, inputs and outputs of a linear building.
    fn state_space<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let system = state_space::state_space(&self.plan, contiguous(values.as_slice())?)
            .map_err(|error| to_python(&error))?;
        let (n, m, p) = (system.states.len(), system.inputs.len(), system.outputs.len());
        let result = PyDict::new(py);
        let matrix = |values: &[f64], shape: [usize; 2]| -> PyResult<Bound<'py, PyArray2<f64>>> {
            PyArray1::from_slice(py, values).reshape(shape)
        };
        result.set_item("a", matrix(&system.a, [n, n])?)?;
        result.set_item("b", matrix(&system.b, [n, m])?)?;
        result.set_item("c", matrix(&system.c, [p, n])?)?;
        result.set_item("d", matrix(&system.d, [p, m])?)?;
        result.set_item("states", system.states)?;
        result.set_item("inputs", system.inputs)?;
        result.set_item("outputs", system.outputs)?;
        Ok(result)
    }
}

fn contiguous<T>(slice: Result<&[T], numpy::AsSliceError>) -> PyResult<&[T]> {
    slice.map_err(|_| EngineInputError::new_err("arrays must be C-contiguous float64"))
}

/// Records (rows x probes), ledger and counters of a run.
fn describe_run<'py>(py: Python<'py>, run: &Run<f64>, records: [usize; 2]) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    result.set_item("records", PyArray1::from_slice(py, &run.records).reshape(records)?)?;
    for flow in Flow::ALL {
        result.set_item(flow.name(), run.ledger.into[flow as usize])?;
    }
    result.set_item("stored", run.ledger.stored)?;
    result.set_item("turnover", run.ledger.total_exchanged)?;
    result.set_item("closure", run.ledger.closure())?;
    result.set_item("cycles", run.cycles)?;
    result.set_item("settled", run.settled)?;
    result.set_item("iterations", run.counters.iterations)?;
    result.set_item("nested", run.counters.nested)?;
    result.set_item("halvings", run.counters.halvings)?;
    result.set_item("reversals", run.counters.reversals)?;
    Ok(result)
}

/// Compiled part of mascarin.
#[pymodule]
fn _engine(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Plan>()?;
    module.add_class::<Trajectory>()?;
    module.add("EngineInputError", module.py().get_type::<EngineInputError>())?;
    module.add("EngineSolverError", module.py().get_type::<EngineSolverError>())?;
    module.add("CLIMATE_CHANNELS", CLIMATE_CHANNELS)
}
