//! The sky of tests: air at 20 degC, dew point 10 degC, 5 tenths of cloud, 333 W/m2 measured.

use super::sky::{CloudEffect, SkyEmission};
use super::sky_model::SkyWeather;
use crate::input::description::{Clouds, ParamId, PublishedLaw, Sky};
use crate::input::values::Values;

/// A model with these numbers, in their order.
pub(crate) fn law(kind: &str, names: &[&str]) -> Sky {
    let numbers: Vec<_> = (0..).zip(names).map(|(k, &name)| (name, ParamId(k))).collect();
    Sky::Law(PublishedLaw::new(kind, &numbers))
}

/// Emission of a sky with an effect of clouds [W/m2].
pub(crate) fn emission(sky: &Sky, numbers: &[f64], clouds: CloudEffect<f64>) -> f64 {
    let weather = SkyWeather { air: 293.15, dew_point: 10.0, cloud_cover: 5.0, infrared: 333.0, sun_up: 0.0 };
    let none = Clouds::Factor([ParamId(0); 3]);
    SkyEmission::of_model(sky, &none, &Values::new(numbers)).with_clouds(clouds).at(&weather)
}

#[track_caller]
pub(crate) fn assert_close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
}

/// Emission of a model without an effect of clouds [W/m2].
#[track_caller]
pub(crate) fn assert_emission(kind: &str, numbers: &[(&str, f64)], expected: f64) {
    let names: Vec<&str> = numbers.iter().map(|(name, _)| *name).collect();
    let values: Vec<f64> = numbers.iter().map(|(_, value)| *value).collect();
    assert_close(emission(&law(kind, &names), &values, CloudEffect::Factor([0.0; 3])), expected);
}
