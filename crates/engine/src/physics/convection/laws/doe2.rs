//! DOE-2: natural convection of TARP and the wind of `MoWiTT` on rough surfaces.
//!
//! Source: LBL (1994), DOE2.1E-053 source code, as described in the `EnergyPlus` Engineering Reference, outside convection,
//! "DOE-2 model": `h = n + Rf (hs - n)`, n the natural part of `tarp.rs`, `hs = {n^2 + [a V^b]^2}^1/2` the
//! coefficient of a smooth surface with a and b of `mowitt.rs`, Rf the roughness (2.17 very rough to 1.0 very
//! smooth).
//!
//! Range: that of `MoWiTT`, extended to rough surfaces and to any inclination.

use super::{mowitt, tarp};
use crate::physics::convection::prelude::*;

/// `n + roughness (sqrt(n^2 + (wind V^b)^2) - n)`, n TARP's natural part, windward and leeward, V at the mast.
#[derive(Debug, Clone)]
pub(crate) struct Doe2<S> {
    natural: [S; 2],
    roughness: S,
    wind: [S; 2],
}

impl<S: Real> NamedLaw<S> for Doe2<S> {
    const ROW: LawRow = LawRow::new(
        "DOE-2",
        "DOE-2: the buoyant part of TARP and the wind of MoWiTT on surfaces of any roughness, outdoors.",
        "surfaces of buildings in the wind",
    )
    .source("LBL 1994, DOE2.1E-053 source code; EnergyPlus Engineering Reference, outside convection")
    .numbers(&[FACTOR, ROUGHNESS])
    .sides(Sides::Outdoors)
    .tilt(Tilt::Steady)
    .alternatives(&[Alternative::OUTDOORS]);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        let (factor, roughness) = (number.of("factor"), number.of("roughness"));
        let wind = mowitt::wind_gains(surface.wind_factor);
        Self {
            natural: tarp::natural(factor, surface.upward),
            roughness,
            wind: wind.map(|part| factor * part),
        }
    }
}

impl<S> Correlation<S> for Doe2<S> {
    type Of<T> = Doe2<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Doe2<T> {
        let Self { natural: [up, down], roughness, wind: [windward, leeward] } = self;
        Doe2 {
            natural: [change(up), change(down)],
            roughness: change(roughness),
            wind: [change(windward), change(leeward)],
        }
    }

    #[inline(always)]
    fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        upward: &S,
        at: &Difference<V>,
        forced: &Forced<V>,
    ) -> Coefficient<V> {
        let [up, down] = &self.natural;
        let gain = V::select(at.unstable(number(upward)), number(up), number(down));
        let Coefficient { value: n, rise } = cube_root(gain, at);
        let (roughness, forced) = (number(&self.roughness), forced[0]);
        let smooth = (n * n + forced * forced).sqrt();
        Coefficient {
            value: n + roughness * (smooth - n),
            rise: rise + roughness * (n * rise / smooth - rise),
        }
    }
}

impl<S: Real> WindPart<S> for Doe2<S> {
    const WIND: Option<WindTerms> = Some(WindTerms::MOWITT);

    #[inline(always)]
    fn forced(&self, wind: &Wind, windward: S::Mask) -> Forced<S> {
        mowitt::forced(&self.wind, wind, windward)
    }
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = Convection::law("doe2", &[("factor", id(0)), ("roughness", id(1))]);
        // Rough wall (1.67), 8 K, 4 m/s: natural 2.62, smooth (2.62^2 + 11.1957^2)^1/2 = 11.49815 and 8.75157
        let wall = surface(&law, &[1.0, 1.67], 0.0);
        assert_close(coefficient(&wall, 8.0, 4.0, true), 17.446_5);
        assert_close(coefficient(&wall, 8.0, 4.0, false), 12.859_7);
        // Cold roof: natural 2 1.81 / 2.382 = 1.51973, smooth 11.29838
        assert_close(coefficient(&surface(&law, &[1.0, 1.0], 1.0), -8.0, 4.0, true), 11.298_4);
    }
}
