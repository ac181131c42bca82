//! Vapour that a surface takes up in a stage, as a straight line of the humidity ratio of the air.

use crate::linear::unknowns::line;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::vapour_layers::VapourLayers;

use super::flows::SurfaceFlows;

/// How far the line of a relative humidity may be from it at the solution [-].
const HUMIDITY: ByPrecision = ByPrecision { double: 1e-10, single: 1e-5 };

/// The tangent of the sorption of a layer, at the start of a step or at the solution of a stage.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tangent<S> {
    /// Moisture content [kg/m2], and the humidity there [-].
    content: S,
    humidity: S,
    /// Slope of the content [kg/m2].
    capacity: S,
}

impl<S: Real> Tangent<S> {
    pub(super) fn none() -> Self {
        Self { content: S::zero(), humidity: S::zero(), capacity: S::zero() }
    }

    /// Of both layers at their contents [kg/m2]; that of the second stays as it is where there is none.
    #[inline(always)]
    pub(super) fn update(both: &mut [Self; 2], layers: &VapourLayers<S>, contents: &[S]) {
        let used = if layers.two { 2 } else { 1 };
        for ((tangent, &content), &depth) in both.iter_mut().zip(contents).zip(&layers.depths).take(used) {
            let (humidity, slope) = layers.isotherm.humidity(content / depth);
            *tangent = Self { content, humidity, capacity: depth * slope };
        }
    }

    /// Draws those of both layers anew that are far from the sorption at the contents reached [kg/m2]; true where they were.
    #[inline(always)]
    pub(super) fn follow(both: &mut [Self; 2], layers: &VapourLayers<S>, contents: &[S]) -> S::Mask {
        let mut any = S::Mask::splat(false);
        if layers.isotherm.is_straight() {
            return any;
        }
        let used = if layers.two { 2 } else { 1 };
        let near = S::constant(HUMIDITY.of::<S>());
        for ((tangent, &content), &depth) in both.iter_mut().zip(contents).zip(&layers.depths).take(used) {
            let (humidity, slope) = layers.isotherm.humidity(content / depth);
            let on_line = tangent.humidity + (content - tangent.content) / tangent.capacity;
            let far = near.lt((humidity - on_line).abs());
            tangent.content = S::select(far, content, tangent.content);
            tangent.humidity = S::select(far, humidity, tangent.humidity);
            tangent.capacity = S::select(far, depth * slope, tangent.capacity);
            any = any | far;
        }
        any
    }

    /// Draws those of both layers anew in some lanes, at a part of the way to the contents reached [kg/m2].
    pub(super) fn redraw(
        both: &mut [Self; 2],
        layers: &VapourLayers<S>,
        contents: &[S],
        (part, lanes): (f64, S::Mask),
    ) {
        let on_the_way = [0, 1].map(|k| line(both[k].content, contents[k], part));
        let mut drawn = *both;
        Self::update(&mut drawn, layers, &on_the_way);
        for (tangent, drawn) in both.iter_mut().zip(drawn) {
            tangent.content = S::select(lanes, drawn.content, tangent.content);
            tangent.humidity = S::select(lanes, drawn.humidity, tangent.humidity);
            tangent.capacity = S::select(lanes, drawn.capacity, tangent.capacity);
        }
    }

    /// What the layer stores per humidity and length of a stage [kg/(m2 s)], and the humidity that the stage starts from [-], with its
    /// content there [kg/m2] and one over the length [1/s].
    #[inline(always)]
    fn stage(&self, held: S, per_second: f64) -> (S, S) {
        (self.capacity.scale(per_second), self.humidity + (held - self.content) / self.capacity)
    }
}

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
    /// Tangents of the layers, none where there is no second one, and contents at the start of the stage [kg/m2]; the vapour pressure at a
    /// humidity ratio of zero on the tangent at the start of the step, and the slope of this tangent; the saturation pressure at the
    /// surface; one over the length of the stage [1/s].
    ///
    /// With the heat capacities' counterparts `c = d slope / length` and `P = p_sat`, the layers satisfy
    /// `(c_1 + b P + k_2) phi_1 = c_1 phi_1h + b p + k_2 phi_2h` and `k_2 = k P c_2 / (c_2 + k P)`: nothing is subtracted.
    #[inline(always)]
    pub(super) fn new(
        (tangents, two): (&[Tangent<S>; 2], bool),
        flows: &SurfaceFlows<S>,
        held: [S; 2],
        (at_zero, pressure_slope): (S, S),
        (saturated, per_second): (S, f64),
    ) -> Self {
        let (first, first_held) = tangents[0].stage(held[0], per_second);
        let (second, second_held) = if two {
            let (capacity, held) = tangents[1].stage(held[1], per_second);
            let inward = flows.between * saturated;
            (inward * capacity / (capacity + inward), held)
        } else {
            (S::zero(), S::zero())
        };
        let storing = first + second;
        let inverse = S::one() / (storing + flows.to_layer * saturated);
        let kept = first * first_held + second * second_held;
        let share = flows.to_layer * inverse;
        Self {
            offset: share * (storing * at_zero - saturated * kept),
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
