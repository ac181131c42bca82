//! TARP: natural convection by inclination, and outdoors a forced part by wind, roughness, perimeter and area.
//!
//! Source: Walton (1983), Thermal Analysis Research Program reference manual, NBSSIR 83-2655,
//! doi:10.6028/NBS.IR.83-2655.
//!
//! - Vertical: `1.31 d^1/3`.
//! - Heat flows up: `9.482 d^1/3/(7.238 - |cos S|)`, S the tilt: 1.310 at the vertical, 1.520 at a ceiling or roof. (Copies of the
//!   manual with 7.283 have a misprint: the branches would not meet at the vertical.)
//! - Heat flows down: `1.810 d^1/3/(1.382 + |cos S|)`.
//! - Forced part, added to it: `2.537 Wf Rf (P V/A)^1/2`, Wf 1 windward and 1/2 leeward, Rf the roughness (2.17 very rough to
//!   1.0 very smooth), P and A perimeter and area, V the wind at the surface.
//!
//! Range: turbulent natural convection at surfaces of building size; forced part from a flat plate in parallel flow (Sparrow, Ramsey
//! & Mass 1979, J. Heat Transfer 101(2), 199-204).

use super::correlation::{Correlation, Placement, WindPart};
use super::natural::{Coefficient, Difference, cube_root};
use super::wind::{Forced, Wind};
use crate::number::real::Real;

/// A surface is vertical where the cosine of its tilt is below this. At the border the coefficient jumps by 0.003 % (heat flows
/// up) and 0.023 % (down), the rounding of the constants of the source.
const VERTICAL: f64 = 1e-6;

/// `natural |d|^1/3` where heat flows up and where it flows down; forced part per root of the wind at the mast.
#[derive(Debug, Clone)]
pub(super) struct Tarp<S> {
    natural: [S; 2],
    forced: S,
}

impl<S: Real> Tarp<S> {
    /// `rough`: roughness [-] and perimeter [m] of a surface outdoors.
    pub(super) fn new(factor: S, rough: Option<[S; 2]>, surface: &Placement<S>) -> Self {
        let forced = match rough {
            Some([roughness, perimeter]) => {
                roughness.scale(2.537) * (perimeter / surface.area * surface.wind_factor).sqrt()
            }
            None => S::zero(),
        };
        Self { natural: natural(factor, surface.upward), forced: factor * forced }
    }
}

/// Gains of `|d|^1/3` where heat flows up and where it flows down.
pub(super) fn natural<S: Real>(factor: S, upward: S) -> [S; 2] {
    let tilt = upward.abs();
    let vertical = tilt.lt(S::constant(VERTICAL));
    let up = S::constant(9.482) / (S::constant(7.238) - tilt);
    let down = S::constant(1.810) / (S::constant(1.382) + tilt);
    [up, down].map(|gain| factor * S::select(vertical, S::constant(1.31), gain))
}

impl<S> Correlation<S> for Tarp<S> {
    type Of<T> = Tarp<T>;

    #[inline(always)]
    fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Tarp<T> {
        let Self { natural: [up, down], forced } = self;
        Tarp { natural: [change(up), change(down)], forced: change(forced) }
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
        let natural = cube_root(gain, at);
        Coefficient { value: natural.value + forced[0], rise: natural.rise }
    }
}

impl<S: Real> WindPart<S> for Tarp<S> {
    const DEPENDS_ON_WIND: bool = true;

    #[inline(always)]
    fn forced(&self, wind: &Wind, windward: S::Mask) -> Forced<S> {
        let forced = self.forced.scale(wind.root);
        [S::select(windward, forced, forced.scale(0.5)); 2]
    }
}

#[cfg(test)]
mod tests {
    use crate::input::description::Convection;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = Convection::Tarp { factor: id(0), roughness: None, perimeter: None };
        // 8 K: the cube root is 2.
        assert_close(coefficient(&surface(&law, &[1.0], 0.0), 8.0, 0.0, false), 2.62);
        assert_close(coefficient(&surface(&law, &[1.0], 1.0), 8.0, 0.0, false), 2.0 * 9.482 / 6.238);
        assert_close(coefficient(&surface(&law, &[1.0], 1.0), -8.0, 0.0, false), 2.0 * 1.81 / 2.382);
        // Rough (2.17) surface of 1 m2 with 4 m perimeter at 4 m/s: 2.537 2.17 (4 4)^1/2 = 22.0212
        let law = Convection::Tarp { factor: id(0), roughness: Some(id(1)), perimeter: Some(id(2)) };
        let rough = surface(&law, &[1.0, 2.17, 4.0], 0.0);
        assert_close(coefficient(&rough, 8.0, 4.0, true), 2.62 + 22.021_2);
        assert_close(coefficient(&rough, 8.0, 4.0, false), 2.62 + 11.010_6);
    }
}
