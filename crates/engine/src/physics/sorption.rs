//! Moisture content of materials by relative humidity, and its exchange with the air: effective moisture penetration depth.
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
use crate::number::real::{Mask, Real};
use crate::physics::constants::KELVIN;
use crate::physics::psychrometrics::saturation_pressure;

/// Temperature [degC] and relative humidity [-] at which penetration depths are taken (EN ISO 12572: 23 degC, 50 %).
const REFERENCE: (f64, f64) = (23.0, 0.5);
/// Exponent of the temperature in the permeability of air [-].
const EXPONENT: f64 = 0.81;
/// [s].
const HOUR: f64 = 3600.0;
/// A layer is not thinner than this [m].
const LEAST_DEPTH: f64 = 1e-6;

/// Moisture content by relative humidity: straight lines, the first and the last without end.
#[derive(Debug, Clone)]
pub struct Isotherm<S> {
    lines: Vec<Segment<S>>,
}

/// A straight line from a point.
#[derive(Debug, Clone, Copy)]
struct Segment<S> {
    humidity: f64,
    content: S,
    /// [kg/m3].
    slope: S,
}

impl<S: Real> Isotherm<S> {
    /// Evaluates an isotherm at a parameter vector.
    #[must_use]
    pub fn new(sorption: &description::Sorption, values: &Values<'_, S>) -> Self {
        let lines = match sorption {
            description::Sorption::Linear { capacity } => {
                vec![Segment { humidity: 0.0, content: S::zero(), slope: values.get(*capacity) }]
            }
            description::Sorption::Table { humidities, contents, factor } => {
                let factor = values.get(*factor);
                let pairs = humidities.windows(2).zip(contents.windows(2));
                let line = |(humidity, content): (&[f64], &[f64])| Segment {
                    humidity: humidity[0],
                    content: factor.scale(content[0]),
                    slope: factor.scale((content[1] - content[0]) / (humidity[1] - humidity[0])),
                };
                pairs.map(line).collect()
            }
        };
        Self { lines }
    }

    /// Whether it is one straight line.
    #[inline(always)]
    pub(crate) fn is_straight(&self) -> bool {
        self.lines.len() == 1
    }

    /// Content at a relative humidity [kg/m3].
    #[inline(always)]
    pub fn content(&self, humidity: S) -> S {
        let of = |line: &Segment<S>| line.content + line.slope * (humidity - S::constant(line.humidity));
        let mut content = of(&self.lines[0]);
        for line in &self.lines[1..] {
            content = S::select(humidity.lt(S::constant(line.humidity)), content, of(line));
        }
        content
    }

    /// Relative humidity at a content [kg/m3], and the slope of the content there [kg/m3].
    #[inline(always)]
    pub fn humidity(&self, content: S) -> (S, S) {
        let (humidity, start, slope) = self.line_at(content);
        (humidity + (content - start) / slope, slope)
    }

    /// The line at a content: humidity and content at its start, and its slope.
    #[inline(always)]
    fn line_at(&self, content: S) -> (S, S, S) {
        let of = |line: &Segment<S>| (S::constant(line.humidity), line.content, line.slope);
        let (first, others) = (&self.lines[0], &self.lines[1..]);
        if S::LANES == 1 {
            // One number is looked up, with the result of the selections below.
            let begins = |line: &&Segment<S>| !content.lt(line.content).any();
            return of(others.iter().rfind(begins).unwrap_or(first));
        }
        let mut at = of(first);
        for line in others {
            let (below, next) = (content.lt(line.content), of(line));
            at.0 = S::select(below, at.0, next.0);
            at.1 = S::select(below, at.1, next.1);
            at.2 = S::select(below, at.2, next.2);
        }
        at
    }
}

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
    use crate::input::description::{Buffer, Depth, ParamId, Sorption};

    /// Content and humidity are inverse to each other, on all lines and beyond the last point.
    #[test]
    fn isotherms_are_inverted() {
        let table = Sorption::Table {
            humidities: vec![0.0, 0.5, 0.9],
            contents: vec![0.0, 4.0, 10.0],
            factor: ParamId(0),
        };
        let isotherm = Isotherm::new(&table, &Values::new(&[2.0]));
        assert!((isotherm.content(0.5) - 8.0).abs() < 1e-15);
        assert!((isotherm.content(0.7) - 14.0).abs() < 1e-14);
        for humidity in [0.1, 0.5, 0.6, 1.1] {
            let (found, slope) = isotherm.humidity(isotherm.content(humidity));
            let expected = if humidity < 0.5 { 16.0 } else { 30.0 };
            assert!((found - humidity).abs() < 1e-15 && (slope - expected).abs() < 1e-13, "{humidity}");
        }
    }

    /// A board of 12 kg/m3 and resistance factor 8, a day: `delta = 2e-7 296.15^0.81/101325/8 = 2.478e-11 kg/(m s Pa)`,
    /// `D = delta 2810.4/12 = 5.804e-9 m2/s`, `depth = sqrt(D 86400/pi) = 12.63 mm`; a layer of 10 mm is not exceeded.
    #[test]
    fn penetration_depth_of_a_day() {
        let buffer = |thickness: usize| Buffer {
            surface: 0,
            side: 1,
            sorption: Sorption::Linear { capacity: ParamId(0) },
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
