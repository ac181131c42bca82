//! Moist air: saturation pressure, humidity ratio, relative humidity, dew point, wet-bulb temperature. The only place of these
//! formulas; Python calls them.
//!
//! Relative humidity and dew point are those over water, also below 0 degC, as meteorology measures them (WMO-No. 8, Guide to
//! Instruments and Methods of Observation, vol. I, ch. 4). The formula over ice is used where ice forms: frost on surfaces and on a coil
//! ([`condensing_pressure`]), and the ice of a wet bulb.
//!
//! Sources: ASHRAE Handbook of Fundamentals 2017, ch. 1: eqs. 5 and 6 (saturation pressure over ice and water, after Hyland &
//! Wexler 1983, ASHRAE Trans. 89(2A), 500-519), 20 (humidity ratio), 33 and 35 (wet-bulb temperature). Air is an ideal gas. Below 0 degC
//! eq. 6 is continued: over supercooled water it is within 0.04 % of Sonntag (1990, Z. Meteorol. 70(5), 340-344) at -20 degC, 0.09 % at
//! -40 degC and 0.2 % at -60 degC.

use crate::number::real::{Chunk, ChunkTask, Real};
use crate::physics::constants::KELVIN;

/// Ratio of the molar masses of water and dry air [-] (ASHRAE 2017, ch. 1, eq. 20).
pub const MASS_RATIO: f64 = 0.621_945;
/// Gas constant of vapour [J/(kg K)] (ASHRAE 2017, ch. 1: 8314.472/18.015268).
pub const VAPOUR_GAS_CONSTANT: f64 = 461.524;
/// Latent heat of vapour in the air of rooms [J/kg]: the heat of vapour at 24 degC less that of the water that leaves a coil at
/// 10 degC (ASHRAE Handbook of Fundamentals 2017, ch. 18, eq. 11: 3010 W for 1 m3/s of 1.204 kg/m3 and 1 kg/kg per thousand).
pub const LATENT_HEAT: f64 = 2.5e6;

/// Specific heat of water vapour [J/(kg K)] (ASHRAE 2017, ch. 1, eq. 30).
pub const VAPOUR_SPECIFIC_HEAT: f64 = 1860.0;

/// Triple point of water [K]: ice below it.
const TRIPLE_POINT: f64 = 273.16;
/// Pressures of vapour below this have no dew point of use [Pa]: -116 degC.
const LEAST_PRESSURE: f64 = 1e-4;
/// Newton's iterations from the first guess of a dew point, which is right within 0.5 K above -60 degC and within 3 K above
/// -116 degC, and from the air temperature for a wet-bulb temperature.
const DEW_POINT_ITERATIONS: usize = 4;
const WET_BULB_ITERATIONS: usize = 10;

/// `c0/T + c1 + c2 T + c3 T^2 + c4 T^3 + c5 T^4 + c6 ln T` over ice and over water (eqs. 5 and 6).
const ICE: [f64; 7] = [
    -5.674_535_9e3,
    6.392_524_7,
    -9.677_843_0e-3,
    6.221_570_1e-7,
    2.074_782_5e-9,
    -9.484_024_0e-13,
    4.163_501_9,
];
const WATER: [f64; 7] =
    [-5.800_220_6e3, 1.391_499_3, -4.864_023_9e-2, 4.176_476_8e-5, -1.445_209_3e-8, 0.0, 6.545_967_3];

/// Logarithm of the saturation pressure [ln Pa] and its slope [1/K] at a temperature [K], by coefficients.
#[inline(always)]
fn log_pressure<S: Real>(kelvin: S, c: [S; 7]) -> (S, S) {
    let inverse = S::one() / kelvin;
    let value = c[0] * inverse
        + c[1]
        + kelvin * (c[2] + kelvin * (c[3] + kelvin * (c[4] + kelvin * c[5])))
        + c[6] * kelvin.ln();
    let slope = inverse * (c[6] - c[0] * inverse)
        + c[2]
        + kelvin * (c[3].scale(2.0) + kelvin * (c[4].scale(3.0) + kelvin * c[5].scale(4.0)));
    (value, slope)
}

/// Over water.
#[inline(always)]
fn log_saturation<S: Real>(kelvin: S) -> (S, S) {
    let c = |k: usize| S::constant(WATER[k]);
    log_pressure(kelvin, [c(0), c(1), c(2), c(3), c(4), c(5), c(6)])
}

/// Over ice below the triple point, over water above it.
#[inline(always)]
fn log_condensing<S: Real>(kelvin: S) -> (S, S) {
    let frozen = kelvin.lt(S::constant(TRIPLE_POINT));
    let c = |k: usize| S::select(frozen, S::constant(ICE[k]), S::constant(WATER[k]));
    log_pressure(kelvin, [c(0), c(1), c(2), c(3), c(4), c(5), c(6)])
}

/// Saturation pressure of vapour at a temperature [degC]: over water, also below 0 degC [Pa].
#[inline(always)]
pub fn saturation_pressure<S: Real>(temperature: S) -> S {
    log_saturation(temperature + S::constant(KELVIN)).0.exp()
}

/// Pressure of vapour from which it condenses on a surface at a temperature [degC]: over water, and below the triple point over ice, where
/// it forms frost [Pa].
#[inline(always)]
pub fn condensing_pressure<S: Real>(temperature: S) -> S {
    log_condensing(temperature + S::constant(KELVIN)).0.exp()
}

/// Saturation pressures at temperatures [degC], each with the bits that it has alone; the number of both is a multiple of
/// [`Real::CHUNK`] [Pa].
#[inline(always)]
pub fn saturation_pressures<S: Real>(temperatures: &[S], pressures: &mut [S]) {
    S::in_chunks(SaturationPressures { temperatures, pressures });
}

struct SaturationPressures<'r, S> {
    temperatures: &'r [S],
    pressures: &'r mut [S],
}

impl<S: Real> ChunkTask<S> for SaturationPressures<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Chunk<S>>(self) {
        let chunks = self.pressures.chunks_exact_mut(S::CHUNK).zip(self.temperatures.chunks_exact(S::CHUNK));
        for (pressures, temperatures) in chunks {
            saturation_pressure(V::load(temperatures)).store(pressures);
        }
    }
}

/// Humidity ratio at a vapour pressure and a pressure of the air [Pa]: [kg/kg]. Vapour is at most half of the air.
#[inline(always)]
pub fn humidity_ratio<S: Real>(vapour: S, pressure: S) -> S {
    let dry = (pressure - vapour).max(pressure.scale(0.5));
    vapour.scale(MASS_RATIO) / dry
}

/// Vapour pressure at a humidity ratio [kg/kg], and its slope [Pa].
#[inline(always)]
pub fn vapour_pressure<S: Real>(ratio: S, pressure: S) -> (S, S) {
    let inverse = S::one() / (ratio + S::constant(MASS_RATIO));
    (pressure * ratio * inverse, pressure.scale(MASS_RATIO) * inverse * inverse)
}

/// Relative humidity at a temperature [degC], a humidity ratio [kg/kg] and a pressure [Pa]: [-].
#[inline(always)]
pub fn relative_humidity<S: Real>(temperature: S, ratio: S, pressure: S) -> S {
    vapour_pressure(ratio, pressure).0 / saturation_pressure(temperature)
}

/// Whether vapour condenses on a surface at a temperature [degC], or forms frost there, from air of a humidity ratio [kg/kg] and a
/// pressure [Pa].
#[inline(always)]
pub fn condenses<S: Real>(temperature: S, ratio: S, pressure: S) -> S::Mask {
    condensing_pressure(temperature).lt(vapour_pressure(ratio, pressure).0)
}

/// Dew point at a humidity ratio [kg/kg] and a pressure [Pa]: over water, also below 0 degC [degC].
pub fn dew_point<S: Real>(ratio: S, pressure: S) -> S {
    dew_point_of(vapour_pressure(ratio, pressure).0)
}

/// Dew point of a vapour pressure [Pa]: the inverse of [`saturation_pressure`] [degC].
pub fn dew_point_of<S: Real>(vapour: S) -> S {
    let log = vapour.max(S::constant(LEAST_PRESSURE)).ln();
    // Magnus' formula as the first guess (Sonntag 1990).
    let above = log - S::constant(611.2_f64).ln();
    let mut kelvin = above.scale(243.12) / (S::constant(17.62) - above) + S::constant(KELVIN);
    for _ in 0..DEW_POINT_ITERATIONS {
        let (at, slope) = log_saturation(kelvin);
        kelvin = kelvin - (at - log) / slope;
    }
    kelvin - S::constant(KELVIN)
}

/// Wet-bulb temperature at a temperature [degC], a humidity ratio [kg/kg] and a pressure [Pa]: below 0.01 degC that of a bulb covered
/// with ice [degC].
pub fn wet_bulb<S: Real>(temperature: S, ratio: S, pressure: S) -> S {
    let mut wet = temperature;
    for _ in 0..WET_BULB_ITERATIONS {
        let (log, slope) = log_condensing(wet + S::constant(KELVIN));
        let saturated = log.exp();
        let ratio_at = humidity_ratio(saturated, pressure);
        // w_s = m p/(P - p), so dw_s/dt = w_s P/(P - p) (ln p)'.
        let rise = ratio_at * pressure / (pressure - saturated).max(pressure.scale(0.5)) * slope;
        // Heats of water and ice [kJ/kg] (eqs. 33, 35): evaporation at 0 degC, its slope, and the heat of what evaporates.
        let frozen = wet.lt(S::zero());
        let of = |ice: f64, water: f64| S::select(frozen, S::constant(ice), S::constant(water));
        let (heat, fall, liquid) = (of(2830.0, 2501.0), of(0.24, 2.326), of(2.1, 4.186));
        let missing = ratio_at * (heat - fall * wet)
            - (temperature - wet).scale(1.006)
            - ratio * (heat + temperature.scale(1.86) - liquid * wet);
        let by_wet = rise * (heat - fall * wet) - ratio_at * fall + S::constant(1.006) + ratio * liquid;
        wet = wet - missing / by_wet;
    }
    wet
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As psychrolib 2.5.0 gives them, which has the same equations: over ice below the triple point.
    #[test]
    fn saturation_pressures_of_psychrolib() {
        for (temperature, expected) in [
            (-20.0, 103.260_378_580_5),
            (0.01, 611.657_024_4),
            (10.0, 1_227.995_275_4),
            (25.0, 3_169.216_470_1),
            (40.0, 7_383.460_009_0),
        ] {
            let found = condensing_pressure(temperature);
            assert!((found / expected - 1.0).abs() < 1e-9, "{temperature}: {found}, expected {expected}");
        }
    }

    /// Over water below the triple point, against Sonntag (1990), and over water and ice there.
    #[test]
    fn over_water_below_the_triple_point() {
        for (temperature, within) in [(-60.0, 2e-3), (-40.0, 1e-3), (-20.0, 4e-4), (-5.0, 1e-4), (20.0, 2e-4)]
        {
            let kelvin: f64 = temperature + KELVIN;
            let log = -6_096.938_5 / kelvin + 21.240_964_2 - 2.711_193e-2 * kelvin
                + 1.673_952e-5 * kelvin * kelvin
                + 2.433_502 * Real::ln(kelvin);
            let found = saturation_pressure(temperature) / Real::exp(log);
            assert!((found - 1.0).abs() < within, "{temperature}: {found}");
        }
        assert!((condensing_pressure(0.0099_f64) / saturation_pressure(0.0099) - 1.0).abs() < 1e-5);
        assert!((condensing_pressure(-15.0_f64) / saturation_pressure(-15.0) - 0.8635).abs() < 1e-3);
        for temperature in [-60.0, -0.1, 5.0] {
            let at = |over: fn(f64) -> f64, beyond: f64| humidity_ratio(over(temperature) * beyond, 1e5);
            assert!(condenses(temperature, at(condensing_pressure, 1.001), 1e5));
            assert!(!condenses(temperature, at(condensing_pressure, 0.999), 1e5));
        }
    }

    /// From a relative humidity to a dew point, the vapour that it stands for, and back.
    #[test]
    fn relative_humidity_comes_back_from_the_dew_point() {
        for temperature in (-60..=60).map(f64::from) {
            for humidity in [0.001, 0.01, 0.3, 0.7, 1.0] {
                let vapour = humidity * saturation_pressure(temperature);
                let ratio = humidity_ratio(saturation_pressure(dew_point_of(vapour)), 101_325.0);
                let found = relative_humidity(temperature, ratio, 101_325.0);
                assert!((found / humidity - 1.0).abs() < 1e-11, "{temperature}, {humidity}: {found}");
                let dew = dew_point(ratio, 101_325.0);
                assert!((dew - dew_point_of(vapour)).abs() < 1e-9, "{temperature}, {humidity}: {dew}");
            }
        }
    }

    /// Below and above 0 degC, alone and together.
    #[test]
    fn saturation_pressures_together_have_the_bits_of_each() {
        let temperatures: Vec<f64> = (0..4 * f64::CHUNK).map(|k| 2.7 * k as f64 - 31.3).collect();
        let mut together = vec![0.0; temperatures.len()];
        saturation_pressures(&temperatures, &mut together);
        for (&temperature, pressure) in temperatures.iter().zip(together) {
            assert_eq!(pressure.to_bits(), saturation_pressure(temperature).to_bits(), "{temperature}");
        }
    }

    /// 25 degC and 50 %, 35 degC and 90 % at 101 325 Pa by psychrolib 2.5.0, whose wet-bulb temperatures are within 1 mK; so is that of
    /// air at -5 degC with 60 % of the vapour of saturation over ice.
    #[test]
    fn states_of_moist_air() {
        let pressure = 101_325.0;
        for (temperature, humidity, [ratio, dew, wet]) in [
            (25.0, 0.5, [0.009_881_043_7, 13.863_973_3, 17.889_43]),
            (35.0, 0.9, [0.032_725_701_0, 33.108_332_9, 33.457_02]),
        ] {
            let found = humidity_ratio(humidity * saturation_pressure(temperature), pressure);
            assert!((found / ratio - 1.0).abs() < 1e-8, "{found}");
            assert!((relative_humidity(temperature, found, pressure) - humidity).abs() < 1e-14);
            assert!((dew_point(found, pressure) - dew).abs() < 1e-6, "{}", dew_point(found, pressure));
            let at = wet_bulb(temperature, found, pressure);
            assert!((at - wet).abs() < 1e-3, "{at}");
        }
    }

    /// The dew point of saturated air is its temperature, and so is its wet-bulb temperature, below 0 degC that of air saturated over ice.
    #[test]
    fn saturated_air() {
        let frosty = humidity_ratio(0.6 * condensing_pressure(-5.0), 101_325.0);
        assert!((wet_bulb(-5.0, frosty, 101_325.0) + 6.790_56_f64).abs() < 1e-3);
        for temperature in [-30.0, -5.0, 3.0, 20.0, 45.0] {
            let ratio = humidity_ratio(saturation_pressure(temperature), 95_000.0);
            assert!((dew_point(ratio, 95_000.0) - temperature).abs() < 1e-9, "{temperature}");
            let ratio = humidity_ratio(condensing_pressure(temperature), 95_000.0);
            assert!((wet_bulb(temperature, ratio, 95_000.0) - temperature).abs() < 1e-9, "{temperature}");
        }
    }

    /// Slope of the vapour pressure against a difference.
    #[test]
    fn slope_of_the_vapour_pressure() {
        let at = |ratio: f64| vapour_pressure(ratio, 101_325.0);
        let difference = (at(0.0121).0 - at(0.0119).0) / 0.0002;
        assert!((at(0.012).1 / difference - 1.0).abs() < 1e-6);
    }
}
