//! `h = a + b |d|^n + c V^m`, with one set of numbers where heat flows up (or the surface is vertical) and one where it flows
//! down; V the wind at the surface.
//!
//! The form of many published correlations; all numbers are parameters, and their source is given with them in the description.

use crate::physics::convection::prelude::*;

/// A surface counts as vertical when the upward component of its normal is below this.
const VERTICAL: f64 = 1e-6;

const A: LawParameter = LawParameter::new(
    "a",
    "W/(m2 K)",
    "Constant part a of a + b abs(dT)^n + c V^m",
    LawRange::Span(0.0, 5.0, "still air between plates"),
    1.0,
)
.default(Default::Value(0.0, "not given: no constant part"));
const B: LawParameter = LawParameter::new(
    "b",
    "W/(m2 K^(n+1))",
    "Coefficient b of a + b abs(dT)^n + c V^m",
    LawRange::Span(0.0, 3.0, "stable air to an upward plume; published values are 0.5 to 2.3"),
    1.5,
)
.default(Default::Value(0.0, "not given: no buoyant part"));
const N: LawParameter = LawParameter::new(
    "n",
    "-",
    "Exponent n of a + b abs(dT)^n + c V^m",
    LawRange::Span(0.2, 0.4, "stable layers 1/5, laminar 1/4, turbulent 1/3"),
    0.33,
)
.at_most(2.0)
.default(Default::Value(1.0 / 3.0, "turbulent free convection"))
.of("b");
const C: LawParameter = LawParameter::new(
    "c",
    "W/(m2 K (m/s)^m)",
    "Coefficient c of a + b abs(dT)^n + c V^m",
    LawRange::Span(0.0, 6.0, "sheltered to exposed"),
    2.0,
)
.default(Default::Value(0.0, "not given: no forced part"))
.of_wind();
const M: LawParameter = LawParameter::new(
    "m",
    "-",
    "Exponent m of a + b abs(dT)^n + c V^m",
    LawRange::Span(0.5, 1.0, "laminar 1/2, turbulent 0.8, linear fits 1"),
    0.9,
)
.at_most(2.0)
.default(Default::Value(0.8, "turbulent flow along a plate"))
.of_wind()
.of("c");

/// Where heat flows up (or the surface is vertical) and where it flows down.
#[derive(Debug, Clone)]
pub(crate) struct Power<S>([Branch<S>; 2]);

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
    fn new(number: &Numbers<'_, S>, direction: &str, wind_factor: S) -> Self {
        let [constant, gain, exponent, wind, wind_exponent] =
            ["a", "b", "n", "c", "m"].map(|name| number.of(&format!("{direction}.{name}")));
        Self { constant, gain, exponent, wind: wind * wind_factor.powf(wind_exponent), wind_exponent }
    }

    /// The part without temperature.
    #[inline(always)]
    fn forced(&self, wind: &Wind) -> S {
        self.constant + self.wind * self.wind_exponent.scale(wind.logarithm).exp()
    }
}

impl<S: Real> NamedLaw<S> for Power<S> {
    const ROW: LawRow = LawRow::new(
        "power law by direction",
        "``a + b |dT|^n + c V^m`` for each direction of heat flow.",
        "where it was found",
    )
    .numbers_by_direction(&[A, B, N, C, M])
    .tilt(Tilt::Cases);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        Self(["upward", "downward"].map(|direction| Branch::new(number, direction, surface.wind_factor)))
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
    const WIND: Option<WindTerms> = Some(WindTerms::LOGARITHM);

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
    use crate::physics::convection::testing::{assert_close, coefficient, power, surface};

    #[test]
    fn by_hand() {
        let law = power([0, 5]);
        let numbers = [1.0, 2.0, 0.25, 0.5, 1.0, 0.3, 0.0, 1.0, 0.0, 1.0];
        let plate = surface(&law, &numbers, 1.0);
        // Up, 16 K and 3 m/s: 1 + 2 16^1/4 + 0.5 3 = 6.5; down: 0.3.
        assert_close(coefficient(&plate, 16.0, 3.0, true), 6.5);
        assert_close(coefficient(&plate, -16.0, 3.0, true), 0.3);
        // A vertical surface takes the upward numbers in both directions.
        assert_close(coefficient(&surface(&law, &numbers, 0.0), -16.0, 3.0, true), 6.5);
        assert_eq!(plate.calm()[..2], [1.0, 0.3]);
    }
}
