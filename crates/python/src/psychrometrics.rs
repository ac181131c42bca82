//! Moist air by the engine's formulas, element by element.

use mascarin_engine::psychrometrics as air;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{EngineInputError, caught};

type Given<'py> = PyReadonlyArray1<'py, f64>;
type Found<'py> = PyResult<Bound<'py, PyArray1<f64>>>;

/// A function of each element of some arrays of one length; NaN where one of them is.
#[allow(clippy::needless_pass_by_value, reason = "the binding hands arrays over by value")]
fn each<'py, const N: usize>(
    py: Python<'py>,
    given: [Given<'py>; N],
    function: impl Fn([f64; N]) -> f64,
) -> Found<'py> {
    caught(|| {
        let length = given[0].len()?;
        let mut slices = [&[][..]; N];
        for (slice, array) in slices.iter_mut().zip(&given) {
            *slice = array.as_slice()?;
            if slice.len() != length {
                return Err(EngineInputError::new_err("arrays of one length are needed"));
            }
        }
        let found = (0..length).map(|k| {
            let numbers = slices.map(|slice| slice[k]);
            if numbers.iter().any(|number| number.is_nan()) { f64::NAN } else { function(numbers) }
        });
        Ok(PyArray1::from_iter(py, found))
    })
}

/// Saturation pressure over water, also below 0 degC, at temperatures [degC]: [Pa].
#[pyfunction]
pub fn saturation_pressure<'py>(py: Python<'py>, temperature: Given<'py>) -> Found<'py> {
    each(py, [temperature], |[temperature]| air::saturation_pressure(temperature))
}

/// Pressure from which vapour condenses on surfaces at temperatures [degC]: over ice below 0.01 degC [Pa].
#[pyfunction]
pub fn condensing_pressure<'py>(py: Python<'py>, temperature: Given<'py>) -> Found<'py> {
    each(py, [temperature], |[temperature]| air::condensing_pressure(temperature))
}

/// Humidity ratios at pressures of vapour and of the air [Pa]: [kg/kg].
#[pyfunction]
pub fn humidity_ratio<'py>(py: Python<'py>, vapour: Given<'py>, pressure: Given<'py>) -> Found<'py> {
    each(py, [vapour, pressure], |[vapour, pressure]| air::humidity_ratio(vapour, pressure))
}

/// Vapour pressures at humidity ratios [kg/kg] and pressures of the air [Pa]: [Pa].
#[pyfunction]
pub fn vapour_pressure<'py>(py: Python<'py>, ratio: Given<'py>, pressure: Given<'py>) -> Found<'py> {
    each(py, [ratio, pressure], |[ratio, pressure]| air::vapour_pressure(ratio, pressure).0)
}

/// Dew points of vapour pressures [Pa]: over water, also below 0 degC [degC].
#[pyfunction]
pub fn dew_point<'py>(py: Python<'py>, vapour: Given<'py>) -> Found<'py> {
    each(py, [vapour], |[vapour]| air::dew_point_of(vapour))
}

/// Wet-bulb temperatures at temperatures [degC], humidity ratios [kg/kg] and pressures of the air [Pa]: [degC].
#[pyfunction]
pub fn wet_bulb<'py>(
    py: Python<'py>,
    temperature: Given<'py>,
    ratio: Given<'py>,
    pressure: Given<'py>,
) -> Found<'py> {
    each(py, [temperature, ratio, pressure], |[temperature, ratio, pressure]| {
        air::wet_bulb(temperature, ratio, pressure)
    })
}
