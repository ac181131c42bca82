//! `MoWiTT`: smooth surfaces outdoors.
//!
//! Source: Yazdanian & Klems (1994), Measurement of the exterior convective film coefficient for windows in low-rise buildings,
//! ASHRAE Trans. 100(1), 1087-1096: `{[0.84 d^1/3]^2 + [a V^b]^2}^1/2` with a = 3.26, b = 0.89 windward and
//! a = 3.55, b = 0.617 leeward, V the wind at the surface.
//!
//! Range: very smooth, vertical surfaces (window glass) of low-rise buildings.

use crate::physics::convection::prelude::*;

/// `factor sqrt(0.84^2 |d|^2/3 + (wind V^b)^2)`, windward and leeward, V at the mast.
#[derive(Debug, Clone)]
pub(crate) struct Mowitt<S> {
    factor: S,
    wind: [S; 2],
}

impl<S: Real> NamedLaw<S> for Mowitt<S> {
    const ROW: LawRow = LawRow::new(
        "MoWiTT",
        "MoWiTT (Yazdanian & Klems 1994), for smooth surfaces outdoors.",
        "very smooth, vertical surfaces of low buildings",
    )
    .source("Yazdanian & Klems 1994, ASHRAE Transactions 100(1)")
    .numbers(&[FACTOR])
    .sides(Sides::Air)
    .alternatives(&[Alternative::OUTDOORS]);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        Self { factor: number.of("factor"), wind: wind_gains(surface.wind_factor) }
    }
}

/// Gains of the powers of the speed at the mast, windward and leeward.
pub(crate) fn wind_gains<S: Real>(wind_factor: S) -> [S; 2] {
    let [windward, leeward] = MOWITT_EXPONENTS.map(|exponent| wind_factor.powf(S::constant(exponent)));
    [windward.scale(3.26), leeward.scale(3.55)]
}

/// `a V^b` of the side that the wind makes of the surface.
#[inline(always)]
pub(crate) fn forced<S: Real>([windward, leeward]: &[S; 2], wind: &Wind, is_windward: S::Mask) -> Forced<S> {
    [S::select(is_windward, windward.scale(wind.mowitt[0]), leeward.scale(wind.mowitt[1])); 2]
}

impl<S> Correlation<S> for Mowitt<S> {
    type Of<T> = Mowitt<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Mowitt<T> {
        let Self { factor, wind: [windward, leeward] } = self;
        Mowitt { factor: change(factor), wind: [change(windward), change(leeward)] }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        _upward: &S,
        at: &Difference<V>,
        forced: &Forced<V>,
    ) -> Coefficient<V> {
        let factor = number(&self.factor);
        let inverse = at.rounded.inverse_cbrt();
        let natural = (at.rounded * inverse * inverse).scale(0.84 * 0.84);
        let value = (natural + forced[0] * forced[0]).sqrt();
        let share = at.square * (inverse * inverse * inverse);
        let rise = (natural * share).scale(1.0 / 3.0) / value;
        Coefficient { value: factor * value, rise: factor * rise }
    }
}

impl<S: Real> WindPart<S> for Mowitt<S> {
    const WIND: Option<WindTerms> = Some(WindTerms::MOWITT);

    #[inline(always)]
    fn forced(&self, wind: &Wind, windward: S::Mask) -> Forced<S> {
        forced(&self.wind, wind, windward)
    }
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = surface(&Convection::law("mowitt", &[("factor", id(0))]), &[1.0], 0.0);
        // 8 K: 0.84 2 = 1.68; 4 m/s: 3.26 4^0.89 = 11.1957 and 3.55 4^0.617 = 8.3502.
        let by_hand = |forced: f64| (1.68 * 1.68 + forced * forced).sqrt();
        assert_close(coefficient(&law, 8.0, 4.0, true), by_hand(11.195_7));
        assert_close(coefficient(&law, 8.0, 4.0, false), by_hand(8.350_2));
    }
}
