//! Air of a site: pressure of the standard atmosphere, density and specific heat of dry and moist air. Python calls these functions.
//!
//! Sources: ICAO Doc 7488, Manual of the ICAO Standard Atmosphere (pressure at an altitude); ASHRAE Handbook of Fundamentals 2017, ch. 1
//! (ideal gases, eqs. 3, 20 and 28).

use crate::number::real::Real;
use crate::physics::constants::{AIR_GAS_CONSTANT, AIR_SPECIFIC_HEAT, KELVIN};
use crate::physics::psychrometrics::{VAPOUR_SPECIFIC_HEAT, humidity_ratio, saturation_pressure};

/// Pressure of the standard atmosphere at sea level [Pa] (ICAO Doc 7488).
pub const SEA_LEVEL_PRESSURE: f64 = 101_325.0;
/// Its temperature there [K] (ICAO Doc 7488).
const SEA_LEVEL_TEMPERATURE: f64 = 288.15;

/// Pressure of the standard atmosphere at an altitude [m]: [Pa].
#[must_use]
pub fn pressure_at(altitude: f64) -> f64 {
    SEA_LEVEL_PRESSURE * Real::powf(1.0 - 2.25577e-5 * altitude, 5.25588)
}

/// Density of dry air of 15 degC at an altitude [m]: [kg/m3].
#[must_use]
pub fn density_at(altitude: f64) -> f64 {
    pressure_at(altitude) / (AIR_GAS_CONSTANT * SEA_LEVEL_TEMPERATURE)
}

/// Density [kg/m3] and specific heat of a kilogram of the mixture [J/(kg K)] of moist air at a temperature [degC], a relative humidity over
/// water [-] and a pressure [Pa].
#[must_use]
pub fn moist_air(temperature: f64, humidity: f64, pressure: f64) -> [f64; 2] {
    let vapour = humidity * saturation_pressure(temperature);
    let ratio = humidity_ratio(vapour, pressure);
    let density = (pressure - vapour) / (AIR_GAS_CONSTANT * (temperature + KELVIN)) * (1.0 + ratio);
    [density, (AIR_SPECIFIC_HEAT + ratio * VAPOUR_SPECIFIC_HEAT) / (1.0 + ratio)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The standard atmosphere has 89 874.6 Pa at 1000 m and 1.225 kg/m3 at sea level; air of 20 degC and 50 % has 1.1988 kg/m3 (ASHRAE
    /// 2017, ch. 1, table 2: 0.8421 m3 and 7.26 g of vapour for a kilogram of dry air).
    #[test]
    fn air_of_tables() {
        assert!((pressure_at(1000.0) / 89_874.6 - 1.0).abs() < 1e-4);
        assert!((density_at(0.0) - 1.225).abs() < 5e-4);
        let [density, heat] = moist_air(20.0, 0.5, SEA_LEVEL_PRESSURE);
        assert!((density - 1.007_26 / 0.8402).abs() < 2e-3, "{density}");
        assert!((heat - 1012.2).abs() < 0.2, "{heat}");
    }
}
