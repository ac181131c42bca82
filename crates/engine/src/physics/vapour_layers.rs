//! Exchange of moisture between materials and the air: effective moisture penetration depth.
//!
//! Sources:
//! - Cunningham (1992), Effective penetration depth and effective resistance in moisture transfer, Building and Environment
//!   27(3), 379-386, doi:10.1016/0360-1323(92)90037-P: `depth = sqrt(D period/pi)`, `D = delta p_sat/(d content/d humidity)`.
//! - Woods, Winkler & Christensen (2013), Moisture modeling: effective moisture penetration depth versus effective capacitance,
//!   NREL/CP-5500-57441: two layers.
//! - Vapour permeability of still air `2e-7 T^0.81/P` [kg/(m s Pa)]: Kuenzel (1995), Simultaneous heat and moisture transport in
//!   building components, IRB Verlag, eq. 18.

use crate::input::description;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::constants::KELVIN;
use crate::physics::psychrometrics::saturation_pressure;
use crate::physics::sorption::Isotherm;

/// Temperature [degC] and relative humidity [-] at which penetration depths are taken (EN ISO 12572: 23 degC, 50 %).
const REFERENCE: (f64, f64) = (23.0, 0.5);
/// Exponent of the temperature in the permeability of air [-].
const EXPONENT: f64 = 0.81;
/// [s].
const HOUR: f64 = 3600.0;
/// A layer is not thinner than this [m].
const LEAST_DEPTH: f64 = 1e-6;

/// Layers behind a surface that take up vapour.
#[derive(Debug, Clone)]
pub struct VapourLayers<S> {
    /// Moisture content.
    pub isotherm: Isotherm<S>,
    /// Depth of the layer at the surface, and of the one behind it [m].
    pub depths: [S; 2],
    /// Whether there is one behind it.
    pub two: bool,
    /// Resistance from the surface to the middle of the first layer at the reference temperature, paint included
    /// [m2 s Pa/kg].
    pub to_surface: S,
    /// Resistance between the middles of both layers there [m2 s Pa/kg].
    pub between: S,
}

impl<S: Real> VapourLayers<S> {
    /// Evaluates the layers behind a surface, at a pressure [Pa].
    #[must_use]
    pub fn new(buffer: &description::Buffer, values: &Values<'_, S>, pressure: S) -> Self {
        let isotherm = Isotherm::new(&buffer.sorption, values);
        let still_air = S::constant(2e-7 * Real::powf(REFERENCE.0 + KELVIN, EXPONENT)) / pressure;
        let permeability = still_air / values.get(buffer.resistance_factor);
        let at_reference = isotherm.humidity(isotherm.content(S::constant(REFERENCE.1))).1;
        let diffusivity = permeability.scale(saturation_pressure(REFERENCE.0)) / at_reference;
        let depth = |depth: &description::Depth| match depth {
            description::Depth::Given { depth } => values.get(*depth),
            description::Depth::Period { period } => {
                (diffusivity * values.get(*period)).scale(HOUR * core::f64::consts::FRAC_1_PI).sqrt()
            }
        };
        let thickness = values.get(buffer.thickness);
        let least = S::constant(LEAST_DEPTH);
        let first = depth(&buffer.depth).min(thickness).max(least);
        let second = buffer.deep.as_ref().map_or(least, |deep| depth(deep).min(thickness - first).max(least));
        let coating = values.get_or(buffer.coating, 0.0) / still_air;
        Self {
            isotherm,
            depths: [first, second],
            two: buffer.deep.is_some(),
            to_surface: coating + first.scale(0.5) / permeability,
            between: (first + second).scale(0.5) / permeability,
        }
    }

    /// Permeability of air at a temperature [degC] over that at the reference temperature: the tangent of `T^0.81`, within
    /// 0.1 % from 0 to 46 degC [-].
    #[inline(always)]
    pub fn relative_permeability(temperature: S) -> S {
        S::one() + (temperature - S::constant(REFERENCE.0)).scale(EXPONENT / (REFERENCE.0 + KELVIN))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::description::{Buffer, Depth, ParamId, PublishedLaw, Sorption};

    /// A board of 12 kg/m3 and resistance factor 8, a day: `delta = 2e-7 296.15^0.81/101325/8 = 2.478e-11 kg/(m s Pa)`,
    /// `D = delta 2810.4/12 = 5.804e-9 m2/s`, `depth = sqrt(D 86400/pi) = 12.63 mm`; a layer of 10 mm is not exceeded.
    #[test]
    fn penetration_depth_of_a_day() {
        let buffer = |thickness: usize| Buffer {
            surface: 0,
            side: 1,
            sorption: Sorption::Law(PublishedLaw::new("linear", &[("capacity", ParamId(0))])),
            resistance_factor: ParamId(1),
            thickness: ParamId(u32::try_from(thickness).unwrap()),
            coating: None,
            depth: Depth::Period { period: ParamId(2) },
            deep: None,
        };
        let numbers = [12.0, 8.0, 24.0, 0.1, 0.01];
        let layers = |thickness| VapourLayers::new(&buffer(thickness), &Values::new(&numbers), 101_325.0);
        let thick = layers(3);
        let permeability = 2e-7 * Real::powf(296.15, 0.81) / 101_325.0 / 8.0;
        let depth =
            (permeability * saturation_pressure(23.0) / 12.0 * 86_400.0 / core::f64::consts::PI).sqrt();
        assert!((thick.depths[0] / depth - 1.0).abs() < 1e-12 && (depth - 0.0126).abs() < 3e-4, "{depth}");
        assert!((thick.to_surface * permeability / (0.5 * depth) - 1.0).abs() < 1e-12);
        assert!((layers(4).depths[0] - 0.01).abs() < 1e-15);
    }
}
