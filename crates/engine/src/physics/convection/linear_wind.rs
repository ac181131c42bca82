//! `h = a + b V`, V the wind at the surface.
//!
//! Source: `McAdams` (1954), Heat Transmission, 3rd ed., McGraw-Hill, with a = 5.7 W/(m2 K) and b = 3.8 W s/(m3 K) for wind speeds
//! below 5 m/s (Juerges' measurements on a vertical plate). Coefficients of this form include natural convection, and often
//! long-wave radiation. The numbers are parameters.

use super::correlation::{Correlation, Placement, WindPart};
use super::natural::{Coefficient, Difference};
use super::wind::{Forced, Wind};
use crate::number::real::Real;

/// `constant + wind V`, V at the mast.
#[derive(Debug, Clone)]
pub(super) struct LinearWind<S> {
    /// [W/(m2 K)].
    constant: S,
    /// [W/(m2 K) per m/s].
    wind: S,
}

impl<S: Real> LinearWind<S> {
    pub(super) fn new(constant: S, wind: S, surface: &Placement<S>) -> Self {
        Self { constant, wind: wind * surface.wind_factor }
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
    const DEPENDS_ON_WIND: bool = true;
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
        let law = surface(&Convection::LinearWind { constant: id(0), wind: id(1) }, &[5.7, 3.8], 0.0);
        assert_close(coefficient(&law, 5.0, 4.0, false), 20.9);
        assert_eq!(law.calm(), [5.7; 2]);
    }
}
