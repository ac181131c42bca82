//! Evaluates correlations for the tests of all files here.

use super::correlation::Placement;
use super::law::SurfaceConvection;
use super::wind::{Wind, WindTerms};
use crate::input::description::{Convection, ParamId};
use crate::input::values::Values;

pub(super) fn id(index: u32) -> ParamId {
    ParamId(index)
}

/// Power laws with five numbers each from these on.
pub(super) fn power(first: [u32; 2]) -> Convection {
    let ids = ["upward", "downward"].into_iter().zip(first).flat_map(|(direction, first)| {
        (first..).zip(["a", "b", "n", "c", "m"]).map(move |(k, name)| (format!("{direction}.{name}"), id(k)))
    });
    let ids: Vec<(String, ParamId)> = ids.collect();
    let numbers: Vec<(&str, ParamId)> = ids.iter().map(|(name, id)| (name.as_str(), *id)).collect();
    Convection::law("power", &numbers)
}

/// A surface of 1 m2 in air of 1.2 kg/m3 with the mast's wind.
pub(super) fn surface(law: &Convection, numbers: &[f64], upward: f64) -> SurfaceConvection<f64> {
    let inclination = crate::number::elementary::acos(upward.abs()).to_degrees();
    let surface = Placement { area: 1.0, upward, wind_factor: 1.0, inclination, density: 1.2, height: 0.0 };
    SurfaceConvection::new(&Values::new(numbers), law, None, &surface)
}

/// The coefficient [W/(m2 K)] at a difference [K] and a wind [m/s]; its slope is checked against a difference.
#[track_caller]
pub(super) fn coefficient(surface: &SurfaceConvection<f64>, d: f64, wind: f64, windward: bool) -> f64 {
    let forced = surface.forced(&Wind::new(wind, WindTerms::all()), windward);
    let flux = surface.flux(d, &forced);
    let step = 1e-5;
    let slope = (surface.flux(d + step, &forced).flux - surface.flux(d - step, &forced).flux) / (2.0 * step);
    assert!((flux.slope - slope).abs() < 1e-6 * slope.abs(), "slope {} is not {slope}", flux.slope);
    flux.flux / d
}

#[track_caller]
pub(super) fn assert_close(value: f64, expected: f64) {
    assert!((value / expected - 1.0).abs() < 2e-4, "{value} is not {expected}");
}
