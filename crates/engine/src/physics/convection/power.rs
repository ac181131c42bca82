//! `h = a + b |d|^n + c V^m`, with one set of numbers where heat flows up (or the surface is vertical) and one where it flows
//! down; V the wind at the surface.
//!
//! The form of many published correlations; all numbers are parameters, and their source is given with them in the description.

use super::correlation::{Correlation, Placement, WindPart};
use super::natural::{Coefficient, Difference, any_power};
use super::wind::{Forced, Wind};
use crate::input::description::PowerLaw;
use crate::input::values::Values;
use crate::number::real::Real;

/// A surface counts as vertical when the upward component of its normal is below this.
const VERTICAL: f64 = 1e-6;

/// Where heat flows up (or the surface is vertical) and where it flows down.
#[derive(Debug, Clone)]
pub(super) struct Power<S>([Branch<S>; 2]);

/// `constant + gain |d|^exponent + wind V^wind_exponent`, V at the mast.
#[derive(Debug, Clone, Copy)]
struct Branch<S> {
    constant: S,
    gain: S,
    exponent: S,
    wind: S,
    wind_exponent: S,
}

impl<S> Branch<S> {
    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Branch<T> {
        let Self { constant, gain, exponent, wind, wind_exponent } = self;
        Branch {
            constant: change(constant),
            gain: change(gain),
            exponent: change(exponent),
            wind: change(wind),
            wind_exponent: change(wind_exponent),
        }
    }
}

impl<S: Real> Branch<S> {
    fn new(values: &Values<'_, S>, law: &PowerLaw, wind_factor: S) -> Self {
        let [constant, gain, exponent, wind, wind_exponent] =
            [law.a, law.b, law.n, law.c, law.m].map(|id| values.get(id));
        Self { constant, gain, exponent, wind: wind * wind_factor.powf(wind_exponent), wind_exponent }
    }

    /// The part without temperature.
    #[inline(always)]
    fn forced(&self, wind: &Wind) -> S {
        self.constant + self.wind * self.wind_exponent.scale(wind.logarithm).exp()
    }
}

impl<S: Real> Power<S> {
    /// `laws`: where heat flows up, and where it flows down.
    pub(super) fn new(values: &Values<'_, S>, laws: [&PowerLaw; 2], surface: &Placement<S>) -> Self {
        Self(laws.map(|law| Branch::new(values, law, surface.wind_factor)))
    }
}

impl<S> Correlation<S> for Power<S> {
    type Of<T> = Power<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Power<T> {
        let [up, down] = &self.0;
        Power([up.map(&mut change), down.map(&mut change)])
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        upward: &S,
        at: &Difference<V>,
        forced: &Forced<V>,
    ) -> Coefficient<V> {
        let [up, down] = &self.0;
        let upward = at.unstable(number(upward)) | number(upward).abs().lt(V::constant(VERTICAL));
        let gain = V::select(upward, number(&up.gain), number(&down.gain));
        let exponent = V::select(upward, number(&up.exponent), number(&down.exponent));
        let natural = any_power(gain, exponent, at);
        let forced = V::select(upward, forced[0], forced[1]);
        Coefficient { value: natural.value + forced, rise: natural.rise }
    }
}

impl<S: Real> WindPart<S> for Power<S> {
    const DEPENDS_ON_WIND: bool = true;

    #[inline(always)]
    fn forced(&self, wind: &Wind, _windward: S::Mask) -> Forced<S> {
        let [up, down] = &self.0;
        [up.forced(wind), down.forced(wind)]
    }

    fn calm(&self) -> Forced<S> {
        let [up, down] = &self.0;
        [up.constant, down.constant]
    }
}

#[cfg(test)]
mod tests {
    use crate::input::description::{Convection, PowerLaw};
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = |first| {
            let [a, b, n, c, m] = core::array::from_fn(|k| id(first + u32::try_from(k).unwrap()));
            PowerLaw { a, b, n, c, m }
        };
        let law = Convection::Power { upward: law(0), downward: law(5) };
        let numbers = [1.0, 2.0, 0.25, 0.5, 1.0, 0.3, 0.0, 1.0, 0.0, 1.0];
        let plate = surface(&law, &numbers, 1.0);
        // Up, 16 K and 3 m/s: 1 + 2 16^1/4 + 0.5 3 = 6.5; down: 0.3.
        assert_close(coefficient(&plate, 16.0, 3.0, true), 6.5);
        assert_close(coefficient(&plate, -16.0, 3.0, true), 0.3);
        // A vertical surface takes the upward numbers in both directions.
        assert_close(coefficient(&surface(&law, &numbers, 0.0), -16.0, 3.0, true), 6.5);
        assert_eq!(plate.calm(), [1.0, 0.3]);
    }
}
