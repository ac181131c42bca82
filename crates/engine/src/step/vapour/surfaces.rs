//! Vapour that a surface takes up in a stage, as a straight line of the humidity ratio of the air.

use crate::number::real::Real;
use crate::physics::sorption::VapourLayers;

use super::flows::SurfaceFlows;

/// What a surface takes up in a stage: `offset + slope w` [kg/(m2 s)].
#[derive(Debug, Clone, Copy)]
pub(super) struct Uptake<S> {
    pub(super) offset: S,
    pub(super) slope: S,
    /// Relative humidity of the first layer: `at_zero + rise w` [-].
    at_zero: S,
    rise: S,
    /// Flow into the second layer by the difference of humidities [kg/(m2 s)], and the humidity that it starts from [-].
    second: S,
    second_held: S,
}

impl<S: Real> Uptake<S> {
    pub(super) fn none() -> Self {
        let zero = S::zero();
        Self { offset: zero, slope: zero, at_zero: zero, rise: zero, second: zero, second_held: zero }
    }

    /// Eliminates both layers.
    ///
    /// `contents` of both layers at the start of the step and of the stage [kg/m2]; humidity ratio at the start of the step with the
    /// vapour pressure and its slope there; length of the stage [s].
    ///
    /// With the heat capacities' counterparts `c = d slope / length` and `P = p_sat`, the layers satisfy
    /// `(c_1 + b P + k_2) phi_1 = c_1 phi_1h + b p + k_2 phi_2h` and `k_2 = k P c_2 / (c_2 + k P)`: nothing is subtracted.
    #[inline(always)]
    pub(super) fn new(
        layers: &VapourLayers<S>,
        flows: &SurfaceFlows<S>,
        (contents, held): ([S; 2], [S; 2]),
        (ratio, (pressure, pressure_slope)): (S, (S, S)),
        length: f64,
    ) -> Self {
        let (first, first_held) = humidities(layers, 0, contents[0], held[0], length);
        let (second, second_held) = if layers.two {
            let (capacity, held) = humidities(layers, 1, contents[1], held[1], length);
            let inward = flows.between * flows.saturated;
            (inward * capacity / (capacity + inward), held)
        } else {
            (S::zero(), S::zero())
        };
        let storing = first + second;
        let inverse = S::one() / (storing + flows.to_layer * flows.saturated);
        let kept = first * first_held + second * second_held;
        let at_zero = pressure - pressure_slope * ratio;
        let share = flows.to_layer * inverse;
        Self {
            offset: share * (storing * at_zero - flows.saturated * kept),
            slope: share * storing * pressure_slope,
            at_zero: inverse * kept + share * at_zero,
            rise: share * pressure_slope,
            second,
            second_held,
        }
    }

    /// Flows from the air into the first layer and from there into the second [kg/(m2 s)].
    #[inline(always)]
    pub(super) fn flows(&self, ratio: S) -> [S; 2] {
        let humidity = self.at_zero + self.rise * ratio;
        [self.offset + self.slope * ratio, self.second * (humidity - self.second_held)]
    }
}

/// What a layer stores per humidity and length of the stage [kg/(m2 s)], and the humidity that a stage starts from on the tangent
/// at the start of the step [-].
#[inline(always)]
fn humidities<S: Real>(layers: &VapourLayers<S>, layer: usize, content: S, held: S, length: f64) -> (S, S) {
    let depth = layers.depths[layer];
    let (humidity, slope) = layers.isotherm.humidity(content / depth);
    let capacity = depth * slope;
    (capacity.scale(1.0 / length), humidity + (held - content) / capacity)
}
