//! The engine's physics for Python: constants, moist air, globe temperature and melting curves, element by element.

use mascarin_engine::description::MeltingCurve;
use mascarin_engine::pcm::LiquidFraction;
use mascarin_engine::{constants, globe, psychrometrics as air, standard_air};
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
fn saturation_pressure<'py>(py: Python<'py>, temperature: Given<'py>) -> Found<'py> {
    each(py, [temperature], |[temperature]| air::saturation_pressure(temperature))
}

/// Pressure from which vapour condenses on surfaces at temperatures [degC]: over ice below 0.01 degC [Pa].
#[pyfunction]
fn condensing_pressure<'py>(py: Python<'py>, temperature: Given<'py>) -> Found<'py> {
    each(py, [temperature], |[temperature]| air::condensing_pressure(temperature))
}

/// Humidity ratios at pressures of vapour and of the air [Pa]: [kg/kg].
#[pyfunction]
fn humidity_ratio<'py>(py: Python<'py>, vapour: Given<'py>, pressure: Given<'py>) -> Found<'py> {
    each(py, [vapour, pressure], |[vapour, pressure]| air::humidity_ratio(vapour, pressure))
}

/// Vapour pressures at humidity ratios [kg/kg] and pressures of the air [Pa]: [Pa].
#[pyfunction]
fn vapour_pressure<'py>(py: Python<'py>, ratio: Given<'py>, pressure: Given<'py>) -> Found<'py> {
    each(py, [ratio, pressure], |[ratio, pressure]| air::vapour_pressure(ratio, pressure).0)
}

/// Dew points of vapour pressures [Pa]: over water, also below 0 degC [degC].
#[pyfunction]
fn dew_point<'py>(py: Python<'py>, vapour: Given<'py>) -> Found<'py> {
    each(py, [vapour], |[vapour]| air::dew_point_of(vapour))
}

/// Wet-bulb temperatures at temperatures [degC], humidity ratios [kg/kg] and pressures of the air [Pa]: [degC].
#[pyfunction]
fn wet_bulb<'py>(
    py: Python<'py>,
    temperature: Given<'py>,
    ratio: Given<'py>,
    pressure: Given<'py>,
) -> Found<'py> {
    each(py, [temperature, ratio, pressure], |[temperature, ratio, pressure]| {
        air::wet_bulb(temperature, ratio, pressure)
    })
}

/// Temperatures of globes [degC] at temperatures of the air and the surroundings [degC], by diameters [m] and emissivities [-].
#[pyfunction]
fn globe_temperature<'py>(
    py: Python<'py>,
    air: Given<'py>,
    radiant: Given<'py>,
    diameter: Given<'py>,
    emissivity: Given<'py>,
) -> Found<'py> {
    each(py, [air, radiant, diameter, emissivity], |[air, radiant, diameter, emissivity]| {
        globe::globe_temperature(air, radiant, diameter, emissivity)
    })
}

/// Pressures of the standard atmosphere at altitudes [m]: [Pa].
#[pyfunction]
fn standard_pressure<'py>(py: Python<'py>, altitude: Given<'py>) -> Found<'py> {
    each(py, [altitude], |[altitude]| standard_air::pressure_at(altitude))
}

/// Density of dry air of 15 degC at an altitude [m]: [kg/m3].
#[pyfunction]
fn standard_density(altitude: f64) -> f64 {
    standard_air::density_at(altitude)
}

/// Density [kg/m3] and specific heat [J/(kg K)] of moist air at a temperature [degC], a relative humidity [-] and a pressure [Pa].
#[pyfunction]
fn moist_air(temperature: f64, humidity: f64, pressure: f64) -> (f64, f64) {
    let [density, heat] = standard_air::moist_air(temperature, humidity, pressure);
    (density, heat)
}

/// Temperature [degC], heat [W/m2] and coefficient [W/(m2 K)] of a law of `physics/imposed` on a day of the year, with outdoor air [degC].
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
fn imposed(
    kind: &str,
    numbers: Vec<(String, f64)>,
    day: f64,
    outdoor_air: f64,
) -> PyResult<(f64, Option<f64>, Option<f64>)> {
    let numbers: Vec<_> = numbers.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    mascarin_engine::laws::imposed_on(kind, &numbers, day, outdoor_air).map_err(EngineInputError::new_err)
}

/// Air changes [1/h] of a law of `physics/leakage` at a wind [m/s] and a difference between outdoors and the zone [K].
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands lists over by value")]
fn leakage_air_changes(kind: &str, numbers: Vec<(String, f64)>, wind: f64, difference: f64) -> PyResult<f64> {
    let numbers: Vec<_> = numbers.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    mascarin_engine::laws::leakage_air_changes(kind, &numbers, wind, difference)
        .map_err(EngineInputError::new_err)
}

/// A curve (JSON, as in descriptions) whose parameters are positions in `values`.
fn melting_curve(curve: &str, values: &[f64]) -> PyResult<LiquidFraction> {
    let curve: MeltingCurve = serde_json::from_str(curve)
        .map_err(|error| EngineInputError::new_err(format!("unreadable melting curve: {error}")))?;
    LiquidFraction::new(&curve, values).map_err(|error| EngineInputError::new_err(error.to_string()))
}

/// Liquid fractions of a melting curve at temperatures [degC]: [-].
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands arrays over by value")]
fn liquid_fraction<'py>(
    py: Python<'py>,
    curve: &str,
    values: Given<'py>,
    temperature: Given<'py>,
) -> Found<'py> {
    let curve = caught(|| melting_curve(curve, values.as_slice()?))?;
    each(py, [temperature], |[temperature]| curve.at(temperature))
}

/// Temperatures where melting starts and is complete, without tails [degC].
#[pyfunction]
#[allow(clippy::needless_pass_by_value, reason = "the binding hands arrays over by value")]
fn melting_reach(curve: &str, values: Given<'_>) -> PyResult<(f64, f64)> {
    let [low, high] = caught(|| Ok(melting_curve(curve, values.as_slice()?)?.reach()))?;
    Ok((low, high))
}

/// Constants by name.
const CONSTANTS: [(&str, f64); 9] = [
    ("STEFAN_BOLTZMANN", constants::SIGMA),
    ("KELVIN", constants::KELVIN),
    ("GRAVITY", constants::GRAVITY),
    ("AIR_GAS_CONSTANT", constants::AIR_GAS_CONSTANT),
    ("AIR_SPECIFIC_HEAT", constants::AIR_SPECIFIC_HEAT),
    ("VAPOUR_SPECIFIC_HEAT", air::VAPOUR_SPECIFIC_HEAT),
    ("VAPOUR_GAS_CONSTANT", air::VAPOUR_GAS_CONSTANT),
    ("LATENT_HEAT", air::LATENT_HEAT),
    ("SEA_LEVEL_PRESSURE", standard_air::SEA_LEVEL_PRESSURE),
];

/// Adds the functions and constants to the module.
pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(saturation_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(condensing_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(humidity_ratio, module)?)?;
    module.add_function(wrap_pyfunction!(vapour_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(dew_point, module)?)?;
    module.add_function(wrap_pyfunction!(wet_bulb, module)?)?;
    module.add_function(wrap_pyfunction!(globe_temperature, module)?)?;
    module.add_function(wrap_pyfunction!(standard_pressure, module)?)?;
    module.add_function(wrap_pyfunction!(standard_density, module)?)?;
    module.add_function(wrap_pyfunction!(moist_air, module)?)?;
    module.add_function(wrap_pyfunction!(imposed, module)?)?;
    module.add_function(wrap_pyfunction!(leakage_air_changes, module)?)?;
    module.add_function(wrap_pyfunction!(liquid_fraction, module)?)?;
    module.add_function(wrap_pyfunction!(melting_reach, module)?)?;
    CONSTANTS.iter().try_for_each(|&(name, value)| module.add(name, value))
}
