//! TARP: natural convection by inclination, and outdoors a forced part by wind, roughness, perimeter and area.
//!
//! Source: Walton (1983), Thermal Analysis Research Program reference manual, NBSSIR 83-2655,
//! doi:10.6028/NBS.IR.83-2655.
//!
//! - Vertical: `1.31 d^1/3`.
//! - Heat flows up: `9.482 d^1/3/(7.238 - |cos S|)`, S the tilt: 1.310 at the vertical, 1.520 at a ceiling or roof. (Copies of the
//!   manual with 7.283 have a misprint: the branches would not meet at the vertical.)
//! - Heat flows down: `1.810 d^1/3/(1.382 + |cos S|)`.
//! - Within 1 deg of the vertical the three meet in cubics ([`NEAR`]): at 90 deg those branches are 1.31003 and 1.30970, so that the
//!   coefficient would jump there by the rounding of the constants, and its slope by the tilt would be 0.181 on one side and 0.948 on the
//!   other. The cubics have 1.31 at the vertical, the mean of both slopes there, and values and slopes of the branches at 89 and 91 deg;
//!   they are within 0.1 % of the branches. Outside of this degree, and at the vertical, nothing differs from the source.
//! - Forced part, added to it: `2.537 Wf Rf (P V/A)^1/2`, Wf 1 windward and 1/2 leeward, Rf the roughness (2.17 very rough to
//!   1.0 very smooth), P and A perimeter and area, V the wind at the surface.
//!
//! Range: turbulent natural convection at surfaces of building size; forced part from a flat plate in parallel flow (Sparrow, Ramsey
//! & Mass 1979, J. Heat Transfer 101(2), 199-204).

use crate::physics::convection::prelude::*;

/// Largest cosine of the tilt near the vertical [-]: sin 1 deg.
const NEAR: f64 = 0.017_452_406_437_283_51;
/// Gain of `|d|^1/3` at the vertical.
const VERTICAL: f64 = 1.31;

/// A gain of `|d|^1/3`, and its slope by the cosine of the tilt.
type Branch = (f64, f64);

/// Where heat flows up, and where it flows down, at the cosine of a tilt.
const fn branches(cosine: f64) -> [Branch; 2] {
    let (up, down) = (9.482 / (7.238 - cosine), 1.810 / (1.382 + cosine));
    [(up, up / (7.238 - cosine)), (down, -down / (1.382 + cosine))]
}

/// Coefficients of the cubics from the vertical to [`NEAR`]: of the first, second and third power of the cosine.
const CUBICS: [[f64; 3]; 2] = {
    let ([(_, up), (_, down)], [up_there, down_there]) = (branches(0.0), branches(NEAR));
    let slope = 0.5 * (up - down);
    [cubic(slope, up_there), cubic(-slope, down_there)]
};

/// The cubic with a slope at the vertical that becomes a branch at [`NEAR`] (Hermite).
const fn cubic(slope: f64, (gain, slope_there): Branch) -> [f64; 3] {
    let mean = (gain - VERTICAL) / NEAR;
    let second = (3.0 * mean - 2.0 * slope - slope_there) / NEAR;
    let third = (slope + slope_there - 2.0 * mean) / (NEAR * NEAR);
    [slope, second, third]
}

/// `natural |d|^1/3` where heat flows up and where it flows down; forced part per root of the wind at the mast.
#[derive(Debug, Clone)]
pub(crate) struct Tarp<S> {
    natural: [S; 2],
    forced: S,
}

impl<S: Real> NamedLaw<S> for Tarp<S> {
    const ROW: LawRow = LawRow::new(
        "TARP",
        "TARP (Walton 1983): buoyant part, and outdoors a forced part by roughness and perimeter.",
        "turbulent flow at surfaces of building size",
    )
    .source("Walton 1983, Thermal Analysis Research Program Reference Manual, NBSIR 83-2655")
    .numbers(&[FACTOR, ROUGHNESS.outdoors(), PERIMETER.outdoors()])
    .sides(Sides::Air)
    .tilt(Tilt::Steady)
    .alternatives(&[Alternative::OUTDOORS, Alternative::INDOORS]);

    fn new(number: &Numbers<'_, S>, surface: &Placement<S>) -> Self {
        let factor = number.of("factor");
        let rough = number.optional("roughness").zip(number.optional("perimeter"));
        let forced = match rough {
            Some((roughness, perimeter)) => {
                roughness.scale(2.537) * (perimeter / surface.area * surface.wind_factor).sqrt()
            }
            None => S::zero(),
        };
        Self { natural: natural(factor, surface.upward), forced: factor * forced }
    }
}

/// Gains of `|d|^1/3` where heat flows up and where it flows down.
pub(crate) fn natural<S: Real>(factor: S, upward: S) -> [S; 2] {
    let tilt = upward.abs();
    let near = tilt.lt(S::constant(NEAR));
    let up = S::constant(9.482) / (S::constant(7.238) - tilt);
    let down = S::constant(1.810) / (S::constant(1.382) + tilt);
    let [up_near, down_near] = CUBICS.map(|[first, second, third]| {
        let slope = S::constant(first) + tilt * (S::constant(second) + tilt.scale(third));
        S::constant(VERTICAL) + tilt * slope
    });
    [(up, up_near), (down, down_near)].map(|(far, cubic)| factor * S::select(near, cubic, far))
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
    const WIND: Option<WindTerms> = Some(WindTerms::DIRECTION);

    #[inline(always)]
    fn forced(&self, wind: &Wind, windward: S::Mask) -> Forced<S> {
        let forced = self.forced.scale(wind.root);
        [S::select(windward, forced, forced.scale(0.5)); 2]
    }
}

#[cfg(test)]
mod tests {
    use super::{NEAR, branches, natural};
    use crate::input::description::Convection;
    use crate::number::dual::Dual;
    use crate::number::real::Real;
    use crate::physics::convection::testing::{assert_close, coefficient, id, surface};

    #[test]
    fn by_hand() {
        let law = Convection::law("tarp", &[("factor", id(0))]);
        // 8 K: the cube root is 2.
        assert_close(coefficient(&surface(&law, &[1.0], 0.0), 8.0, 0.0, false), 2.62);
        assert_close(coefficient(&surface(&law, &[1.0], 1.0), 8.0, 0.0, false), 2.0 * 9.482 / 6.238);
        assert_close(coefficient(&surface(&law, &[1.0], 1.0), -8.0, 0.0, false), 2.0 * 1.81 / 2.382);
        // Rough (2.17) surface of 1 m2 with 4 m perimeter at 4 m/s: 2.537 2.17 (4 4)^1/2 = 22.0212
        let law = Convection::law("tarp", &[("factor", id(0)), ("roughness", id(1)), ("perimeter", id(2))]);
        let rough = surface(&law, &[1.0, 2.17, 4.0], 0.0);
        assert_close(coefficient(&rough, 8.0, 4.0, true), 2.62 + 22.021_2);
        assert_close(coefficient(&rough, 8.0, 4.0, false), 2.62 + 11.010_6);
    }

    /// Gain of `|d|^1/3` of a surface that is warmer or colder than the air, and its slope, by the upward component of its normal.
    fn gain(warmer: bool, upward: f64) -> (f64, f64) {
        let [up, down] = natural(Dual::<1>::constant(1.0), Dual::variable(upward, 0));
        let gain = if warmer == (0.0 < upward) { up } else { down };
        (gain.value, gain.slope[0])
    }

    /// From one branch to the other neither the gain nor its slope jumps: at the vertical both ways give 1.31 and the mean slope, at 89 and
    /// 91 deg what the source has. In between a difference quotient of the gain is its slope, and the source is within 0.1 %.
    #[test]
    fn smooth_through_the_vertical() {
        for warmer in [true, false] {
            let sign = if warmer { 1.0 } else { -1.0 };
            // (0.180997 + 0.947677)/2.
            for upward in [1e-12, -1e-12] {
                let (value, slope) = gain(warmer, upward);
                assert!(
                    (value - 1.31).abs() < 1e-11 && (slope - sign * 0.564_337).abs() < 1e-5,
                    "{value} {slope}"
                );
            }
            for border in [NEAR, -NEAR] {
                let [inside, outside] = [1.0 - 1e-9, 1.0 + 1e-9].map(|part| gain(warmer, part * border));
                assert!((inside.0 - outside.0).abs() < 1e-9 && (inside.1 - outside.1).abs() < 1e-6);
            }
            for k in -150_i32..=150 {
                let upward = 1.0 / 149.3 * NEAR * f64::from(k);
                let (value, slope) = gain(warmer, upward + 1e-12);
                let quotient = (gain(warmer, upward + 1e-7).0 - gain(warmer, upward - 1e-7).0) / 2e-7;
                assert!((quotient - slope).abs() < 1e-5, "{quotient} is not {slope} at {upward}");
                let [(up, _), (down, _)] = branches(upward.abs());
                let source = if warmer == (0.0 < upward) { up } else { down };
                assert!((value / source - 1.0).abs() < 1e-3, "{value} for {source} at {upward}");
                // Heat flows the better the more the surface is turned upwards.
                assert!(sign * slope > 0.0, "{slope} at {upward}");
            }
        }
        // The vertical keeps its bits, and so does what lies beyond a degree.
        let exact = |upward: f64| natural(1.0, upward);
        assert_eq!(exact(6.123e-17), [1.31, 1.31]);
        assert_eq!(exact(-0.5), [9.482 / 6.738, 1.810 / 1.882]);
    }
}
