//! Convective heat flow between a face and its air.
//!
//! Every correlation gives a film coefficient h as a function of the temperature
//! difference; heat flow is `q = h(|d|) d`, `d = T_face - T_air`. Its derivative, which Newton
//! needs, comes from running the same source on [`Dual`].
//!
//! Sources:
//! - Alamdari & Hammond (1983), Build. Serv. Eng. Res. Technol. 4(3), doi:10.1177/014362448300400304.
//! - Walton (1983), Thermal Analysis Research Program (TARP), NBSSIR 83-2655.
//! - Yazdanian & Klems (1994), `MoWiTT`, ASHRAE Trans. 100(1), 1087-1096.
//! - Guichard et al., the paper's eq. 5 as printed (a misprint of Alamdari & Hammond's; kept under its own name).

use crate::description::{Convection, PowerLaw};
use crate::parameters::Values;
use crate::real::{Dual, Mask, Real};

/// Temperature differences below this [K] are rounded off: `|d|^(1/3)` has an infinite slope at zero.
const ROUND_OFF: f64 = 0.01;
/// Wind speeds below this [m/s] count as this: `V^b` has an infinite slope at zero.
const CALM: f64 = 1e-3;
/// A face is treated as horizontal when its normal lies within 45 deg of the vertical.
const HORIZONTAL: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// A number with its derivative by the temperature difference.
type D<S> = Dual<S, 1>;

/// The air at a face.
#[derive(Debug, Clone, Copy)]
pub struct FilmAir<S: Real> {
    /// Upward component of the normal that points from the face into the air.
    pub upward: S,
    /// Wind at the face [m/s]; zero indoors.
    pub wind: S,
    /// True where the wind blows onto the face.
    pub windward: S::Mask,
}

impl<S: Real> FilmAir<S> {
    /// Still air indoors.
    pub fn still(upward: S) -> Self {
        Self { upward, wind: S::zero(), windward: S::Mask::splat(false) }
    }
}

/// Heat flow from face to air and its slope by `T_face - T_air`.
#[derive(Debug, Clone, Copy)]
pub struct FilmFlux<S> {
    /// [W/m2].
    pub flux: S,
    /// [W/(m2 K)].
    pub slope: S,
}

/// A correlation with its numbers.
#[derive(Debug, Clone)]
pub enum Film<S> {
    /// See [`Convection::Constant`].
    Constant(S),
    /// See [`Convection::LinearWind`].
    LinearWind {
        /// Coefficient in still air [W/(m2 K)].
        constant: S,
        /// Its rise with wind [W/(m2 K) per m/s].
        wind: S,
    },
    /// See [`Convection::AlamdariHammond`].
    AlamdariHammond {
        /// Characteristic length [m].
        length: S,
        /// Multiplies the correlation [-].
        factor: S,
    },
    /// See [`Convection::PaperEq5`].
    PaperEq5 {
        /// Height [m].
        length: S,
        /// Multiplies the correlation [-].
        factor: S,
    },
    /// See [`Convection::Tarp`]. `forced`: `2.537 R sqrt(P/A)`, zero indoors.
    Tarp {
        /// Multiplies the correlation [-].
        factor: S,
        /// Forced part per square root of wind speed [W/(m2 K) per (m/s)^1/2].
        forced: S,
    },
    /// See [`Convection::Mowitt`].
    Mowitt {
        /// Multiplies the correlation [-].
        factor: S,
    },
    /// See [`Convection::Power`].
    Power {
        /// a, b, n, c, m where heat flows up or the face is vertical.
        upward: [S; 5],
        /// a, b, n, c, m where heat flows down.
        downward: [S; 5],
    },
}

impl<S: Real> Film<S> {
    /// Reads the numbers of a correlation; `area` is the face's plane area [m2].
    pub fn new(values: &Values<'_, S>, law: &Convection, area: S) -> Self {
        let power = |p: &PowerLaw| [p.a, p.b, p.n, p.c, p.m].map(|id| values.get(id));
        match law {
            Convection::Constant { coefficient } => Self::Constant(values.get(*coefficient)),
            Convection::LinearWind { constant, wind } => {
                Self::LinearWind { constant: values.get(*constant), wind: values.get(*wind) }
            }
            Convection::AlamdariHammond { length, factor } => {
                Self::AlamdariHammond { length: values.get(*length), factor: values.get(*factor) }
            }
            Convection::PaperEq5 { length, factor } => {
                Self::PaperEq5 { length: values.get(*length), factor: values.get(*factor) }
            }
            Convection::Tarp { factor, roughness, perimeter } => {
                let forced = match (roughness, perimeter) {
                    (Some(roughness), Some(perimeter)) => {
                        values.get(*roughness).scale(2.537) * (values.get(*perimeter) / area).sqrt()
                    }
                    _ => S::zero(),
                };
                Self::Tarp { factor: values.get(*factor), forced }
            }
            Convection::Mowitt { factor } => Self::Mowitt { factor: values.get(*factor) },
            Convection::Power { upward, downward } => {
                Self::Power { upward: power(upward), downward: power(downward) }
            }
        }
    }

    /// Heat flow at `difference = T_face - T_air` [K].
    pub fn flux(&self, difference: S, air: &FilmAir<S>) -> FilmFlux<S> {
        if let Self::Constant(h) = self {
            return FilmFlux { flux: *h * difference, slope: *h };
        }
        let d = D::variable(difference, 0);
        let q = self.coefficient(d, air) * d;
        FilmFlux { flux: q.value, slope: q.slope[0] }
    }

    /// Film coefficient [W/(m2 K)].
    fn coefficient(&self, difference: D<S>, air: &FilmAir<S>) -> D<S> {
        let d = difference.smooth_abs(ROUND_OFF);
        let wind = air.wind.max(S::constant(CALM));
        // Buoyancy drives the air off the face: warm and facing up, or cold and facing down.
        let unstable = S::zero().lt(difference.value * air.upward);
        match self {
            Self::Constant(h) => D::fixed(*h),
            Self::LinearWind { constant, wind: slope } => D::fixed(*constant + *slope * air.wind),
            Self::AlamdariHammond { length, factor } => {
                D::fixed(*factor) * alamdari_hammond(d, *length, unstable, air.upward)
            }
            Self::PaperEq5 { length, factor } => D::fixed(*factor) * paper_eq5(d, *length),
            Self::Tarp { factor, forced } => {
                let side = S::select(air.windward, S::one(), S::constant(0.5));
                let forced = *forced * side * wind.sqrt();
                D::fixed(*factor) * (tarp_natural(d, unstable, air.upward) + D::fixed(forced))
            }
            Self::Mowitt { factor } => D::fixed(*factor) * mowitt(d, wind, air.windward),
            Self::Power { upward, downward } => {
                // Heat flows up into the air above a warm face, or up into a cold face above its air; a vertical
                // face uses the upward set.
                let vertical = air.upward.abs().lt(S::constant(1e-6));
                let up = unstable | vertical;
                let [a, b, n, c, m] = core::array::from_fn(|i| S::select(up, upward[i], downward[i]));
                let wind = wind.powf(m);
                D::fixed(a) + D::fixed(b) * d.powf(D::fixed(n)) + D::fixed(c * wind)
            }
        }
    }

    /// True when the coefficient does not depend on temperature or wind.
    #[must_use]
    pub fn is_constant(law: &Convection) -> bool {
        matches!(law, Convection::Constant { .. })
    }
}

/// Sixth power by products: the compiler may round `powi` of a constant otherwise in lanes than in scalars.
fn sixth(x: f64) -> f64 {
    let cube = x * x * x;
    cube * cube
}

/// Vertical `{[1.5 (d/H)^1/4]^6 + [1.23 d^1/3]^6}^1/6`; horizontal, unstable the same with 1.4 and 1.63 on D = 4A/P;
/// stable `0.6 (d/D^2)^1/5`.
fn alamdari_hammond<S: Real>(d: D<S>, length: S, unstable: S::Mask, upward: S) -> D<S> {
    let ratio = d / D::fixed(length);
    // x^(6/4) = x sqrt(x) and x^(6/3) = x^2 spare two powers.
    let laminar = ratio * ratio.sqrt();
    let turbulent = d * d;
    let blend = |a: f64, b: f64| {
        let sum = laminar.scale(sixth(a)) + turbulent.scale(sixth(b));
        sum.cbrt().sqrt()
    };
    let horizontal = S::constant(HORIZONTAL).lt(upward.abs());
    let stable = (d / D::fixed(length * length)).powf(D::constant(0.2)).scale(0.6);
    let on_plate = D::select(unstable, blend(1.4, 1.63), stable);
    D::select(horizontal, on_plate, blend(1.5, 1.23))
}

/// `{[1.51 d^1/4 / H]^6 + [1.33 d^1/3]^6}^1/6`, as printed.
fn paper_eq5<S: Real>(d: D<S>, length: S) -> D<S> {
    let over = D::fixed(S::one() / length);
    let first = over * over * over * over * over * over * d * d.sqrt();
    (first.scale(sixth(1.51)) + (d * d).scale(sixth(1.33))).cbrt().sqrt()
}

/// `9.482 d^1/3 / (7.283 - |cos S|)` unstable, `1.810 d^1/3 / (1.382 + |cos S|)` stable, `1.31 d^1/3` vertical.
fn tarp_natural<S: Real>(d: D<S>, unstable: S::Mask, upward: S) -> D<S> {
    let tilt = upward.abs();
    let open = S::constant(9.482) / (S::constant(7.283) - tilt);
    let still = S::constant(1.810) / (S::constant(1.382) + tilt);
    let sloped = S::select(unstable, open, still);
    let vertical = tilt.lt(S::constant(1e-3));
    d.cbrt() * D::fixed(S::select(vertical, S::constant(1.31), sloped))
}

/// `sqrt((0.84 d^1/3)^2 + (a V^b)^2)`: windward a 3.26, b 0.89; leeward a 3.55, b 0.617.
fn mowitt<S: Real>(d: D<S>, wind: S, windward: S::Mask) -> D<S> {
    let natural = d.cbrt().scale(0.84);
    let a = S::select(windward, S::constant(3.26), S::constant(3.55));
    let b = S::select(windward, S::constant(0.89), S::constant(0.617));
    let forced = a * wind.powf(b);
    (natural * natural + D::fixed(forced * forced)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coefficient(film: &Film<f64>, difference: f64, upward: f64, wind: f64, windward: bool) -> f64 {
        let air = FilmAir { upward, wind, windward };
        let flux = film.flux(difference, &air);
        let step = 1e-5;
        let slope = (film.flux(difference + step, &air).flux - film.flux(difference - step, &air).flux)
            / (2.0 * step);
        assert!((flux.slope - slope).abs() < 1e-6 * slope.abs(), "slope {} is not {slope}", flux.slope);
        flux.flux / difference
    }

    fn assert_close(value: f64, expected: f64) {
        assert!((value / expected - 1.0).abs() < 2e-4, "{value} is not {expected}");
    }

    /// Values worked out by hand from the printed correlations.
    #[test]
    #[allow(clippy::approx_constant, reason = "6.283 is 7.283 - 1 of the correlation, not a circle")]
    fn correlations_by_hand() {
        let ah = Film::AlamdariHammond { length: 3.0, factor: 1.0 };
        // 5 K, 3 m: laminar 1.5 (5/3)^.25 = 1.70434, turbulent 1.23 5^(1/3) = 2.10327
        assert_close(coefficient(&ah, 5.0, 0.0, 0.0, false), 2.192_50);
        // Stable over a 3 m plate at 5 K: 0.6 (5/9)^0.2 = 0.53345
        assert_close(coefficient(&ah, -5.0, 1.0, 0.0, false), 0.533_45);
        // Unstable: 1.4 (5/3)^.25 = 1.59071, 1.63 5^(1/3) = 2.78726
        assert_close(coefficient(&ah, 5.0, 1.0, 0.0, false), 2.803_09);
        let eq5 = Film::PaperEq5 { length: 0.28, factor: 1.0 };
        // 5 K, 0.28 m: first term 1.51 5^.25 / 0.28 = 8.06419 rules
        assert_close(coefficient(&eq5, 5.0, 1.0, 0.0, false), 8.064_7);
        let tarp = Film::Tarp { factor: 1.0, forced: 0.0 };
        assert_close(coefficient(&tarp, 8.0, 0.0, 0.0, false), 2.62);
        assert_close(coefficient(&tarp, 8.0, 1.0, 0.0, false), 2.0 * 9.482 / 6.283);
        assert_close(coefficient(&tarp, -8.0, 1.0, 0.0, false), 2.0 * 1.81 / 2.382);
        let mowitt = Film::Mowitt { factor: 1.0 };
        assert_close(
            coefficient(&mowitt, 8.0, 0.0, 4.0, true),
            (1.68_f64.powi(2) + 11.196_0_f64.powi(2)).sqrt(),
        );
        assert_close(
            coefficient(&mowitt, 8.0, 0.0, 4.0, false),
            (1.68_f64.powi(2) + 8.350_4_f64.powi(2)).sqrt(),
        );
        let power = Film::Power { upward: [1.0, 2.0, 0.25, 0.5, 1.0], downward: [0.3, 0.0, 1.0, 0.0, 1.0] };
        assert_close(coefficient(&power, 16.0, 1.0, 3.0, true), 6.5);
        assert_close(coefficient(&power, -16.0, 1.0, 3.0, true), 0.3);
    }
}
