//! `h = a + b V`, V the wind at the surface.
//!
//! Source: `McAdams` (1954), Heat Transmission, 3rd ed., McGraw-Hill, with a = 5.7 W/(m2 K) and b = 3.8 W s/(m3 K) for wind speeds
//! below 5 m/s (Juerges' measurements on a vertical plate). Coefficients of this form include natural convection, and often
//! long-wave radiation. The numbers are parameters.

use crate::physics::convection::prelude::*;

/// The rise of a coefficient with the wind.
const SLOPE: LawParameter = LawParameter::new(
    "wind",
    "W/(m2 K)/(m/s)",
    "Increase of the surface heat transfer coefficient with wind speed",
    LawRange::Percent(50.0, "published slopes are 2 to 6"),
    5.7,
)
.at_most(1e3)
.of_wind();

/// `constant + wind V`, V at the mast.
#[derive(Debug, Clone)]
pub(crate) struct LinearWind<S> {
    /// [W/(m2 K)].
    constant: S,
    /// [W/(m2 K) per m/s].
    wind: S,
}

impl<S: Real> NamedLaw<S> for LinearWind<S> {
    const ROW: LawRow = LawRow::new(
        "linear in wind",
        "``constant + wind V``, with the wind speed V at the surface.",
        "wind speeds below 5 m/s",
    )
    .numbers(&[coefficient("constant", 11.4), SLOPE])
    // McAdams W.H. (1954), Heat Transmission, 3rd ed.: rough surfaces.
    .alternatives(&[Alternative { outdoors: true, numbers: &[("constant", 5.7), ("wind", 3.8)] }]);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        Self { constant: number.of("constant"), wind: number.of("wind") * surface.wind_factor }
    }
}

impl<S> Correlation<S> for LinearWind<S> {
    type Of<T> = LinearWind<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> LinearWind<T> {
        LinearWind { constant: change(&self.constant), wind: change(&self.wind) }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        _number: &impl Fn(&S) -> V,
        _upward: &S,
        _at: &Difference<V>,
        forced: &Forced<V>,
    ) -> Coefficient<V> {
        Coefficient::fixed(forced[0])
    }
}

impl<S: Real> WindPart<S> for LinearWind<S> {
    const WIND: Option<WindTerms> = Some(WindTerms::SPEED);
    const LINEAR: bool = true;

    #[inline(always)]
    fn forced(&self, wind: &Wind, _windward: S::Mask) -> Forced<S> {
        [self.constant + self.wind.scale(wind.speed); 2]
    }

    fn calm(&self) -> Forced<S> {
        [self.constant; 2]
    }
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    /// `McAdams` at 4 m/s: 5.7 + 3.8 4 = 20.9.
    #[test]
    fn by_hand() {
        let law = surface(
            &Convection::law("linear_wind", &[("constant", id(0)), ("wind", id(1))]),
            &[5.7, 3.8],
            0.0,
        );
        assert_close(coefficient(&law, 5.0, 4.0, false), 20.9);
        assert_eq!(law.calm()[..2], [5.7; 2]);
    }
}
