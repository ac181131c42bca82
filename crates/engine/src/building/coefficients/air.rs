//! Density and heat capacity of the air in the zones.

use crate::building::plan::Plan;
use crate::input::description::FlowDensity;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::{AIR_GAS_CONSTANT, AIR_SPECIFIC_HEAT};
use crate::physics::flow_density::SiteAir;

/// Density of the air in the zones [kg/m3]: given, or by the altitude of the site.
pub(crate) fn density<S: Real>(plan: &Plan, values: &Values<'_, S>) -> S {
    let site = &plan.description.site;
    site.air_density.map_or_else(|| density_at(values.get(site.altitude)), |id| values.get(id))
}

/// The air of the site.
pub(crate) fn of_site<S: Real>(plan: &Plan, values: &Values<'_, S>) -> SiteAir<S> {
    let density = density(plan, values);
    let pressure = pressure_at(values.get(plan.description.site.altitude));
    SiteAir { heat: heat_capacity(plan, values, density), density, pressure }
}

/// Whether a flow is a volume of air whose density changes.
pub(crate) fn density_varies(plan: &Plan) -> bool {
    let description = &plan.description;
    let zones = description.zones.iter().flat_map(|zone| {
        let ventilation = zone.ventilation.iter().map(|flow| &flow.density);
        core::iter::once(&zone.infiltration.density).chain(ventilation)
    });
    let units = description.ventilation_units.iter();
    zones
        .chain(units.flat_map(|unit| unit.supply.iter().chain(&unit.exhaust)).map(|flow| &flow.density))
        .chain(description.air_paths.iter().map(|path| &path.density))
        .chain(description.directed_flows.iter().map(|flow| &flow.density))
        .flatten()
        .any(|density| !matches!(density, FlowDensity::Constant { .. }))
}

/// Heat capacity of a cubic metre of air of a density [kg/m3]: [J/(m3 K)].
pub(crate) fn heat_capacity<S: Real>(plan: &Plan, values: &Values<'_, S>, density: S) -> S {
    match plan.description.site.air_specific_heat {
        Some(id) => density * values.get(id),
        None => density.scale(AIR_SPECIFIC_HEAT),
    }
}

/// Density of dry air [kg/m3] at an altitude [m], at 15 degC.
fn density_at<S: Real>(altitude: S) -> S {
    pressure_at(altitude).scale(1.0 / (AIR_GAS_CONSTANT * 288.15))
}

/// Pressure [Pa] of the standard atmosphere (ICAO Doc 7488) at an altitude [m].
pub(crate) fn pressure_at<S: Real>(altitude: S) -> S {
    (S::one() - altitude.scale(2.255_77e-5)).powf(S::constant(5.255_88)).scale(101_325.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ICAO Doc 7488: 1.225 kg/m3 at sea level; 89 874.6 Pa at 1000 m.
    #[test]
    fn standard_atmosphere() {
        assert!((density_at(0.0) - 1.225).abs() < 1e-4);
        assert!((density_at(1000.0) / density_at(0.0) - 89_874.6 / 101_325.0).abs() < 1e-5);
    }
}
