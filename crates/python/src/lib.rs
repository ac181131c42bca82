//! The module `mascarin._engine`: conversion, release of the GIL, progress, Ctrl-C and errors. No physics.

mod errors;
mod formula;
mod options;
mod physics;
mod plan;
mod trajectory;

use mascarin_engine::forcing::CLIMATE_CHANNELS;
use mascarin_engine::laws;
use mascarin_engine::run::outputs::Output;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Panics on purpose, in the engine or at the border, so that tests can see what becomes of a defect.
#[pyfunction]
#[pyo3(signature = (message, border=false))]
fn _panic(py: Python<'_>, message: &str, border: bool) -> PyResult<()> {
    errors::caught(|| {
        if border { panic!("{message}") } else { errors::attended(py, None, |_| panic!("{message}")) }
    })
}

/// The library that goes into an FMU: its bytes, its ending, and the architecture and system that it is for.
#[pyfunction]
fn fmu_library(py: Python<'_>) -> (Bound<'_, PyBytes>, &'static str, &'static str, &'static str) {
    static LIBRARY: &[u8] = include_bytes!(env!("MASCARIN_FMU_LIBRARY"));
    (PyBytes::new(py, LIBRARY), env!("MASCARIN_FMU_SUFFIX"), std::env::consts::ARCH, std::env::consts::OS)
}

/// The table of outputs as JSON: a list of rows.
#[pyfunction]
fn output_table() -> PyResult<String> {
    serde_json::to_string(&Output::table()).map_err(|error| errors::EngineDefect::new_err(error.to_string()))
}

/// The table of published laws as JSON: lists of rows by what they are laws of.
#[pyfunction]
fn law_table() -> String {
    serde_json::json!({
        "convection": laws::convection(),
        "sky": laws::sky(),
        "diffuse": laws::diffuse(),
        "leakage": laws::leakage(),
        "sorption": laws::sorption(),
        "imposed": laws::imposed(),
    })
    .to_string()
}

/// Compiled part of mascarin.
#[pymodule]
fn _engine(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<plan::Plan>()?;
    module.add_class::<trajectory::Trajectory>()?;
    module.add_function(wrap_pyfunction!(errors::interrupt, module)?)?;
    module.add_function(wrap_pyfunction!(fmu_library, module)?)?;
    module.add_function(wrap_pyfunction!(_panic, module)?)?;
    module.add_function(wrap_pyfunction!(formula::check_formula, module)?)?;
    module.add_function(wrap_pyfunction!(formula::formula_values, module)?)?;
    module.add_function(wrap_pyfunction!(formula::check_function, module)?)?;
    module.add_function(wrap_pyfunction!(formula::check_derived, module)?)?;
    module.add_function(wrap_pyfunction!(formula::function_values, module)?)?;
    module.add_function(wrap_pyfunction!(formula::check_fraction, module)?)?;
    module.add_function(wrap_pyfunction!(formula::fraction_values, module)?)?;
    module.add_function(wrap_pyfunction!(output_table, module)?)?;
    module.add_function(wrap_pyfunction!(law_table, module)?)?;
    physics::add(module)?;
    module.add("EngineInputError", module.py().get_type::<errors::EngineInputError>())?;
    module.add("EngineSolverError", module.py().get_type::<errors::EngineSolverError>())?;
    module.add("EngineDefect", module.py().get_type::<errors::EngineDefect>())?;
    module.add("CLIMATE_CHANNELS", CLIMATE_CHANNELS)
}
