//! A compiled building and its runs.

use mascarin_engine::RunControl;
use mascarin_engine::derivatives::{Direction, slopes_along};
use mascarin_engine::description::Description;
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::forcing::{Forcing, ForcingBlocks};
use mascarin_engine::linear_model;
use mascarin_engine::plan::Plan as EnginePlan;
use mascarin_engine::run::ensemble;
use mascarin_engine::run::physical_limits::Outlier;
use mascarin_engine::run::ratings::window_ratings;
use mascarin_engine::run::step_choice::{Criterion, choose_steps};
use mascarin_engine::run::validity::OutOfRange;
use mascarin_engine::run::{Run, simulate_in_blocks};
use mascarin_engine::vapour::VapourFlow;
use numpy::{
    PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::errors::{
    EngineInputError, Exchange, abandonable, attended, attended_blocks, caught, done_members, done_steps,
    to_python,
};
use crate::options::RunOptions;

/// A building compiled for the engine.
#[pyclass(frozen, module = "mascarin._engine")]
pub struct Plan {
    pub plan: EnginePlan,
}

/// Records of an ensemble, by what members are judged, and failures.
type EnsembleArrays<'py> = (Bound<'py, PyArray3<f64>>, [Bound<'py, PyArray1<f64>>; 3], Bound<'py, PyList>);

/// Records and their slopes.
type JacobianArrays<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>);

/// Halvings of each step, and estimated errors.
type ChosenSteps<'py> = (Bound<'py, PyArray1<u8>>, Bound<'py, PyArray1<f64>>);

#[pymethods]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands arrays over by value")]
impl Plan {
    #[new]
    fn new(py: Python<'_>, description: &str) -> PyResult<Self> {
        caught(|| {
            let description: Description = serde_json::from_str(description)
                .map_err(|error| EngineInputError::new_err(format!("unreadable description: {error}")))?;
            Ok(Self { plan: abandonable(py, move || EnginePlan::new(description))? })
        })
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

    /// Memory of the weather of one stage that an ensemble keeps [B].
    #[getter]
    fn stage_bytes(&self) -> usize {
        ensemble::stage_bytes(&self.plan)
    }

    /// Ratings of the windows (windows x 4): U value, solar heat gain, normal and hemispherical solar transmittance.
    fn window_ratings<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        caught(|| {
            let values = contiguous(values.as_slice())?;
            if values.len() != self.plan.description.parameters.len() {
                return Err(EngineInputError::new_err("as many values as parameters are needed"));
            }
            let found = window_ratings(&self.plan, values);
            let rows: Vec<f64> = found
                .iter()
                .flat_map(|one| {
                    [one.u_value, one.solar_heat_gain, one.transmittance, one.diffuse_transmittance]
                })
                .collect();
            PyArray1::from_vec(py, rows).reshape([found.len(), 4])
        })
    }

    /// One run: a dictionary of ledger and counters, whose records are empty. `take` is called with the records (rows x outputs) in blocks of
    /// `rows` rows while the run goes on, `report` with the number of steps done. Where the forcing has fewer than `steps` steps, `further` is
    /// called for each next block of it, and is ahead of the run by one; after the last block it gives none.
    #[pyo3(signature = (values, forcing, options, rows, take, report=None, steps=None, further=None))]
    #[allow(clippy::too_many_arguments, reason = "what a run needs, and where the records go")]
    fn simulate_into<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        forcing: PyReadonlyArray3<'py, f64>,
        options: RunOptions,
        rows: usize,
        take: &Bound<'py, PyAny>,
        report: Option<&Bound<'py, PyAny>>,
        steps: Option<usize>,
        further: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        caught(|| {
            let options = options.read()?;
            let (values, shape) = (contiguous(values.as_slice())?, forcing.as_array().dim());
            let drive =
                Forcing::new(contiguous(forcing.as_slice())?, shape.1, shape.2).map_err(|e| to_python(&e))?;
            let (plan, outputs) = (&self.plan, options.outputs.len());
            let report = report.map(|report| (report, done_steps as fn(&RunControl) -> usize));
            let hand_over = |block: Vec<f64>| {
                let shape = [block.len() / outputs.max(1), outputs];
                take.call1((PyArray1::from_vec(py, block).reshape(shape)?,)).map(drop)
            };
            let exchange = Exchange { take: hand_over, give: || further.map_or(Ok(None), block_of) };
            let run = attended_blocks(py, report, exchange, |watch, give, ask| {
                let mut forcing = ForcingBlocks::new(drive, steps.unwrap_or(drive.steps()), ask);
                simulate_in_blocks(plan, values, &mut forcing, &options, watch, rows, give)
            })?;
            describe_run(py, &run, PyArray2::zeros(py, [0, outputs], false))
        })
    }

    /// Members (rows of `values`), in single precision to screen many: records (members x rows x outputs); closures, how far
    /// temperatures are outside of their causes [K], and steps in which a law as text did not hold; failures.
    #[pyo3(signature = (values, forcing, options, report=None, single=false))]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray2<'py, f64>,
        forcing: PyReadonlyArray3<'py, f64>,
        options: RunOptions,
        report: Option<&Bound<'py, PyAny>>,
        single: bool,
    ) -> PyResult<EnsembleArrays<'py>> {
        caught(|| {
            let options = options.read()?;
            let members = values.as_array().dim().0;
            let (numbers, shape) = (contiguous(values.as_slice())?, forcing.as_array().dim());
            let drive =
                Forcing::new(contiguous(forcing.as_slice())?, shape.1, shape.2).map_err(|e| to_python(&e))?;
            let plan = &self.plan;
            let report = report.map(|report| (report, done_members as fn(&RunControl) -> usize));
            let run = if single { ensemble::screening } else { ensemble::ensemble };
            let result = attended(py, report, |watch| run(plan, numbers, &drive, &options, watch))?;
            let rows = options.rows(drive.steps());
            let records =
                PyArray1::from_vec(py, result.records).reshape([members, rows, options.outputs.len()])?;
            let failures = result.failures.iter().map(|(member, error)| (*member, error.to_string()));
            let judged = [result.closure, result.outside, result.beyond_validity];
            let judged = judged.map(|numbers| PyArray1::from_vec(py, numbers));
            Ok((records, judged, PyList::new(py, failures)?))
        })
    }

    /// Records (rows x outputs) and their slopes (directions x rows x outputs) along parameters that change together.
    #[pyo3(signature = (values, directions, forcing, options, report=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        directions: Vec<Direction>,
        forcing: PyReadonlyArray3<'py, f64>,
        options: RunOptions,
        report: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<JacobianArrays<'py>> {
        caught(|| {
            let options = options.read()?;
            let (numbers, shape) = (contiguous(values.as_slice())?, forcing.as_array().dim());
            let drive =
                Forcing::new(contiguous(forcing.as_slice())?, shape.1, shape.2).map_err(|e| to_python(&e))?;
            let plan = &self.plan;
            let report = report.map(|report| (report, done_members as fn(&RunControl) -> usize));
            let result = attended(py, report, |watch| {
                slopes_along(plan, numbers, &directions, &drive, &options, watch)
            })?;
            let (rows, outputs) = (options.rows(drive.steps()), options.outputs.len());
            let records = PyArray1::from_vec(py, result.records).reshape([rows, outputs])?;
            Ok((records, PyArray1::from_vec(py, result.slopes).reshape([directions.len(), rows, outputs])?))
        })
    }

    /// How often the record interval is halved for each step, and the estimated error of each [K]. `forcings` has the weather in steps of the
    /// record interval, of half of it, and so on; warm-up steps are record intervals.
    fn choose_steps<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
        forcings: Vec<PyReadonlyArray3<'py, f64>>,
        options: RunOptions,
        tolerance: f64,
        most_halvings: u8,
    ) -> PyResult<ChosenSteps<'py>> {
        caught(|| {
            let options = options.read()?;
            let numbers = contiguous(values.as_slice())?;
            let drives: Vec<_> = forcings
                .iter()
                .map(|forcing| {
                    let (_, stages, channels) = forcing.as_array().dim();
                    Forcing::new(contiguous(forcing.as_slice())?, stages, channels).map_err(|e| to_python(&e))
                })
                .collect::<PyResult<_>>()?;
            let plan = &self.plan;
            let criterion = Criterion { tolerance, most_halvings };
            let choice =
                attended(py, None, |watch| choose_steps(plan, numbers, &drives, &options, criterion, watch))?;
            Ok((PyArray1::from_vec(py, choice.halvings), PyArray1::from_vec(py, choice.errors)))
        })
    }

    /// A, B, C, D and the names of states, inputs and outputs of a linear building.
    fn state_space<'py>(
        &self,
        py: Python<'py>,
        values: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        caught(|| {
            let values = contiguous(values.as_slice())?;
            let plan = &self.plan;
            let system = attended(py, None, |watch| linear_model::state_space(plan, values, watch))?;
            let (n, m, p) = (system.states.len(), system.inputs.len(), system.outputs.len());
            let result = PyDict::new(py);
            let matrix = |values: Vec<f64>, shape: [usize; 2]| -> PyResult<Bound<'py, PyArray2<f64>>> {
                PyArray1::from_vec(py, values).reshape(shape)
            };
            result.set_item("a", matrix(system.a, [n, n])?)?;
            result.set_item("b", matrix(system.b, [n, m])?)?;
            result.set_item("c", matrix(system.c, [p, n])?)?;
            result.set_item("d", matrix(system.d, [p, m])?)?;
            result.set_item("states", system.states)?;
            result.set_item("inputs", system.inputs)?;
            result.set_item("outputs", system.outputs)?;
            Ok(result)
        })
    }
}

/// The numbers of the next block of a forcing, or none.
fn block_of(further: &Bound<'_, PyAny>) -> PyResult<Option<Vec<f64>>> {
    let block: Option<PyReadonlyArray3<'_, f64>> = further.call0()?.extract()?;
    block.map(|block| Ok(contiguous(block.as_slice())?.to_vec())).transpose()
}

/// The numbers of an array, if they stand one after the other.
pub fn contiguous<T>(slice: Result<&[T], numpy::AsSliceError>) -> PyResult<&[T]> {
    slice.map_err(|_| EngineInputError::new_err("arrays must be C-contiguous float64"))
}

/// Records (rows x outputs), ledger and counters of a run.
pub fn describe_run<'py>(
    py: Python<'py>,
    run: &Run<f64>,
    records: Bound<'py, PyArray2<f64>>,
) -> PyResult<Bound<'py, PyDict>> {
    let result = PyDict::new(py);
    result.set_item("records", records)?;
    for flow in Flow::ALL {
        result.set_item(flow.name(), run.energy_balance.into[flow as usize])?;
    }
    result.set_item("stored", run.energy_balance.stored)?;
    result.set_item("turnover", run.energy_balance.total_exchanged)?;
    result.set_item("closure", run.energy_balance.closure())?;
    let vapour = PyDict::new(py);
    for flow in VapourFlow::ALL {
        vapour.set_item(flow.name(), run.energy_balance.vapour.into[flow as usize])?;
    }
    vapour.set_item("stored", run.energy_balance.vapour.stored)?;
    vapour.set_item("exchanged", run.energy_balance.vapour.total_exchanged)?;
    vapour.set_item("closure", run.energy_balance.vapour.closure())?;
    vapour.set_item("corrected", run.energy_balance.vapour.corrected)?;
    vapour.set_item("fastest", run.energy_balance.vapour.fastest)?;
    result.set_item("vapour", vapour)?;
    result.set_item("outside", run.outside)?;
    let outlier = run
        .outlier
        .as_ref()
        .map(|Outlier { step, place, temperature, bound }| (*step, place.as_str(), *temperature, *bound));
    result.set_item("outlier", outlier)?;
    let out_of_range: Vec<_> = run.out_of_range.iter().map(law_out_of_range).collect();
    result.set_item("out_of_range", out_of_range)?;
    result.set_item("cycles", run.cycles)?;
    result.set_item("settled", run.warm_up_change)?;
    result.set_item("iterations", run.counters.iterations)?;
    result.set_item("nested", run.counters.nested)?;
    result.set_item("halvings", run.counters.halvings)?;
    result.set_item("reversals", run.counters.reversals)?;
    result.set_item("largest_change", run.counters.largest_change)?;
    result.set_item("largest_residual", run.counters.largest_residual)?;
    Ok(result)
}

/// Place, what it is a law of, steps, first step, and name, unit, least and largest value of what its `valid` depends on.
type LawOutOfRange<'a> = (&'a str, &'a str, usize, usize, Vec<(&'a str, &'a str, f64, f64)>);

/// A law that was used where it does not hold.
fn law_out_of_range(law: &OutOfRange) -> LawOutOfRange<'_> {
    let values = law.values.iter().map(|value| (value.name, value.unit, value.least, value.most));
    (&law.place, law.law, law.steps, law.first, values.collect())
}
