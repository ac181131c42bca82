//! Laws that are written as text: their faults and their values.

use mascarin_engine::formula::{
    CurveText, DerivedText, FormulaFault, FunctionLaw, LawNumber, LawPoint, LawSide, LawText, Surroundings,
};
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

/// Whether wind reaches a side, whether its irradiance is known and whether it faces a zone; tilt of its normal into the air [deg],
/// area [m2], density of the air [kg/m3], height above ground [m].
type Side = ((bool, bool, bool), (f64, f64, f64, Option<f64>));

fn law_side(((wind, sun, zone), (tilt, area, density, height)): Side) -> LawSide {
    LawSide { wind, sun, zone, tilt, area, density, height }
}

/// The first fault of a coefficient that is written as text, at a side of a surface; none: it is a law.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn check_formula(
    formula: &str,
    valid: Option<&str>,
    given: Vec<Number>,
    side: Side,
) -> PyResult<Option<Found>> {
    caught(|| {
        let law = LawText { formula, valid, numbers: &numbers(given), side: law_side(side) };
        Ok(law.check().err().map(found))
    })
}

/// Coefficients of such a law, windward, as written [W/(m2 K)]. `points`: differences [K], winds [m/s], temperatures of the air [degC],
/// angles of the wind [deg], irradiances [W/m2], air changes and all air changes [1/h].
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn formula_values<'py>(
    py: Python<'py>,
    formula: &str,
    given: Vec<Number>,
    side: (f64, f64, f64, Option<f64>),
    points: [PyReadonlyArray1<'py, f64>; 7],
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    caught(|| {
        let side = law_side(((true, true, true), side));
        let law = LawText { formula, valid: None, numbers: &numbers(given), side };
        let columns = points.iter().map(|column| column.as_slice()).collect::<Result<Vec<_>, _>>()?;
        let count = columns.iter().map(|column| column.len()).min().unwrap_or(0);
        let point = |k: usize| LawPoint {
            difference: columns[0][k],
            wind: columns[1][k],
            around: Surroundings {
                air: columns[2][k],
                angle: columns[3][k],
                sun: columns[4][k],
                air_change: columns[5][k],
                total_air_change: columns[6][k],
            },
        };
        let values = law.values(&(0..count).map(point).collect::<Vec<_>>());
        let values = values.map_err(|fault| EngineInputError::new_err(fault.fault.to_string()))?;
        Ok(PyArray1::from_vec(py, values))
    })
}

/// The first fault of a law of another kind that is written as text; none: it is a law.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn check_function(
    kind: &str,
    formula: &str,
    valid: Option<&str>,
    given: Vec<Number>,
) -> PyResult<Option<Found>> {
    caught(|| {
        let law = FunctionLaw { kind, formula, valid, numbers: &numbers(given) };
        Ok(law.check().err().map(found))
    })
}

/// The first fault of a derived output; none: it is one. `outputs`: names and units that it may use; `absent`: names that are no outputs, and
/// what to do.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn check_derived(
    formula: &str,
    outputs: Vec<(String, String)>,
    given: Vec<Number>,
    unit: Option<&str>,
    absent: Vec<(String, String)>,
) -> PyResult<Option<Found>> {
    caught(|| {
        let text =
            DerivedText { formula, outputs: &outputs, numbers: &numbers(given), unit, absent: &absent };
        Ok(text.check().err().map(found))
    })
}

/// Values of such a law, as written; `points`: the values of each name that changes.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
pub fn function_values<'py>(
    py: Python<'py>,
    kind: &str,
    formula: &str,
    given: Vec<Number>,
    points: Vec<PyReadonlyArray1<'py, f64>>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    caught(|| {
        let law = FunctionLaw { kind, formula, valid: None, numbers: &numbers(given) };
        let columns = points.iter().map(|column| column.as_slice()).collect::<Result<Vec<_>, _>>()?;
        let count = columns.iter().map(|column| column.len()).min().unwrap_or(0);
        let point = |k: usize| columns.iter().map(|column| column[k]).collect::<Vec<f64>>();
        let values = law.values(&(0..count).map(point).collect::<Vec<_>>());
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
