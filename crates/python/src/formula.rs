//! Laws that are written as text: their faults and their values.

use mascarin_engine::formula::{CurveText, FormulaFault, LawNumber, LawText};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{EngineInputError, caught};

/// Name, value, range and unit, where they are stated.
type Number = (String, f64, Option<(f64, f64)>, Option<String>);
/// Key, line, column, what was found, what was expected, and what to do.
type Found = (String, u32, u32, String, String, String);

fn numbers(given: Vec<Number>) -> Vec<LawNumber> {
    let number = |(name, value, range, unit): Number| LawNumber {
        name,
        value,
        range: range.map(|(low, high)| [low, high]),
        unit,
    };
    given.into_iter().map(number).collect()
}

fn found(FormulaFault { key, fault }: FormulaFault) -> Found {
    (key, fault.at.line, fault.at.column, fault.found, fault.expected, fault.remedy)
}

/// The first fault of a coefficient that is written as text, at a side of a surface: `wind` reaches it or not, `side`: the
/// tilt [deg] of its normal into the air, its area [m2] and the density of the air [kg/m3]; none: it is a law.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn check_formula(
    formula: &str,
    valid: Option<&str>,
    given: Vec<Number>,
    wind: bool,
    side: (f64, f64, f64),
) -> PyResult<Option<Found>> {
    caught(|| {
        let (numbers, (tilt, area, density)) = (numbers(given), side);
        let law = LawText { formula, valid, numbers: &numbers, wind, tilt, area, density };
        Ok(law.check().err().map(found))
    })
}

/// Coefficients of such a law at differences [K] and winds [m/s], windward, as written: [W/(m2 K)].
#[pyfunction]
#[allow(
    clippy::needless_pass_by_value,
    clippy::too_many_arguments,
    reason = "the binding hands lists over by value"
)]
pub fn formula_values<'py>(
    py: Python<'py>,
    formula: &str,
    given: Vec<Number>,
    side: (f64, f64, f64),
    differences: PyReadonlyArray1<'py, f64>,
    winds: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    caught(|| {
        let (numbers, (tilt, area, density)) = (numbers(given), side);
        let law = LawText { formula, valid: None, numbers: &numbers, wind: true, tilt, area, density };
        let points: Vec<[f64; 2]> =
            differences.as_slice()?.iter().zip(winds.as_slice()?).map(|(&d, &wind)| [d, wind]).collect();
        let values = law.values(&points);
        let values = values.map_err(|fault| EngineInputError::new_err(fault.fault.to_string()))?;
        Ok(PyArray1::from_vec(py, values))
    })
}

/// The first fault of a curve of the liquid fraction that is written as text: names and values of its numbers, the melting temperature
/// [degC] and the range about it in which it melts [K]; none: it is a curve.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn check_fraction(
    formula: &str,
    given: Vec<Number>,
    melting_temperature: f64,
    range: [f64; 2],
) -> PyResult<Option<Found>> {
    caught(|| {
        let numbers = numbers(given);
        Ok(CurveText { formula, numbers: &numbers, melting_temperature, range }.check().err().map(found))
    })
}

/// Liquid fractions of such a curve at temperatures [degC]: [-].
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn fraction_values<'py>(
    py: Python<'py>,
    formula: &str,
    given: Vec<Number>,
    melting_temperature: f64,
    range: [f64; 2],
    temperatures: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    caught(|| {
        let numbers = numbers(given);
        let curve = CurveText { formula, numbers: &numbers, melting_temperature, range };
        let values = curve.fractions(temperatures.as_slice()?);
        let values = values.map_err(|fault| EngineInputError::new_err(fault.fault.to_string()))?;
        Ok(PyArray1::from_vec(py, values))
    })
}
