//! Functions in single precision, within some units in the last place.

use super::{Bits, polynomial};
use crate::number::real::Logistic;

pub(crate) use super::inverse_cbrt;

// ln 2 in two parts (Cody & Waite): the first has nine digits, so that k * LN2_HIGH is exact.
const LN2_HIGH: f64 = 0.693_359_375;
const LN2_LOW: f64 = core::f64::consts::LN_2 - LN2_HIGH;

/// 1.5 * 2^23: adding it rounds to an integer that can be read from the low bits.
const ROUND: f64 = 12_582_912.0;

/// e^x by reduction to |r| <= ln2/2 and its Taylor series to r^7 (truncation below 6e-9). x is clamped to \[-87, 88\].
#[inline(always)]
pub(crate) fn exp<S: Bits>(x: S) -> S {
    let x = x.max(S::constant(-87.0)).min(S::constant(88.0));
    let shifted = x.scale(core::f64::consts::LOG2_E) + S::constant(ROUND);
    let k = shifted - S::constant(ROUND);
    let r = (x - k.scale(LN2_HIGH)) - k.scale(LN2_LOW);
    let coefficients = [1.0 / 5_040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
    polynomial(r, coefficients) * S::power_of_two(shifted)
}

/// ln x of a positive normal number: x = m 2^e, ln m = 2 atanh((m-1)/(m+1)) (truncation below 4e-9).
#[inline(always)]
pub(crate) fn ln<S: Bits>(x: S) -> S {
    let (m, e) = x.split();
    let s = (m - S::one()) / (m + S::one());
    let z = s * s;
    let series = polynomial(z, [1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0]);
    let twice = s.scale(2.0);
    e.scale(LN2_HIGH) + (twice + (twice * (series * z) + e.scale(LN2_LOW)))
}

/// As in double precision, with shorter polynomials: Taylor's of `r coth(r ln2/2)` (truncation below 5e-8 of the value) and of
/// `2 atanh s - 2 s` (below 2e-8).
#[inline(always)]
pub(crate) fn logistic<S: Bits>(x: S) -> Logistic<S> {
    use core::f64::consts::{LN_2, SQRT_2};
    // Below this `2^t` is zero in the sum.
    const LEAST: f64 = -120.0;
    let t = (-x.abs()).max(S::constant(LEAST));
    let shifted = t + S::constant(ROUND);
    let r = t - (shifted - S::constant(ROUND));
    let coefficients = [-9.250_684_777_172_66e-4, 1.155_245_300_933_235_9e-1, 2.885_390_081_777_926_8];
    let even = polynomial(r * r, coefficients);
    let (p, n) = (even - r, (even + r) * S::power_of_two(shifted));
    let (sum, root) = (p + n, p.scale(SQRT_2));
    let larger = sum + root;
    let inverse = S::one() / (sum * larger);
    let small = n * larger * inverse;
    let s = (sum - root) * sum * inverse;
    let z = s * s;
    let tail =
        S::constant(0.5 * LN_2) + (s.scale(2.0) + s * (z * polynomial(z, [2.0 / 7.0, 2.0 / 5.0, 2.0 / 3.0])));
    let (falls, large) = (x.lt(S::zero()), S::one() - small);
    Logistic { rise: S::select(falls, small, large), rest: S::select(falls, large, small), tail }
}

// Bit patterns shared by all implementations of `Bits`.
pub(crate) const EXPONENT_BIAS: u32 = 127;
/// Brings the exponent of a number above sqrt(1/2) of its binade to its own: `127 * 2^23 - bits(sqrt(1/2))`.
pub(crate) const SPLIT: u32 = (EXPONENT_BIAS << 23) - 0x3F35_04F3;
/// Bits of 2^23: a small integer added to them reads as 2^23 + integer.
pub(crate) const TWO_23: u32 = 0x4B00_0000;
/// The guess of `x^(-1/3)` before a third of the bits of x is subtracted: as in double precision.
pub(crate) const INVERSE_CBRT: u32 = 0x54A2_AAAB;

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "compared with the functions of the standard library")]
mod tests {
    use super::*;
    use crate::number::real::Real;

    fn close(a: f32, b: f64, tolerance: f64) {
        assert!((f64::from(a) - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
    }

    /// Within a few roundings of 6e-8 of the functions in double precision, at the same number.
    #[test]
    fn functions_agree_with_the_standard_library() {
        let mut x = -80.0_f32;
        while x < 85.0 {
            close(exp(x), f64::from(x).exp(), 1.8e-7);
            x += 0.0377;
        }
        let mut x = 1e-35_f32;
        while x < 1e35 {
            let exact = f64::from(x).ln();
            assert!((f64::from(ln(x)) - exact).abs() <= 2.4e-7 * exact.abs().max(0.5), "{x}");
            close(inverse_cbrt(x), f64::from(x).cbrt().recip(), 3e-7);
            x *= 1.0137;
        }
        let mut x = -110.0_f32;
        while x < 110.0 {
            let Logistic { rise, rest, tail } = logistic(x);
            let power = (f64::from(x).abs() * -core::f64::consts::LN_2).exp();
            let parts = [1.0 / (1.0 + power), power / (1.0 + power)];
            let (large, small) = if x < 0.0 { (rest, rise) } else { (rise, rest) };
            close(large, parts[0], 1.8e-7);
            close(small, parts[1], 5e-7);
            assert!((f64::from(tail) - power.ln_1p()).abs() < 1.8e-7, "{tail} at {x}");
            x += 0.00137 + 0.001 * x.abs();
        }
        assert_eq!(exp(0.0_f32), 1.0);
        assert_eq!(ln(1.0_f32), 0.0);
        assert!(exp(-1e30_f32) > 0.0 && exp(1e30_f32).is_finite());
    }

    /// Bits on any processor: a change here is a numerical change.
    #[test]
    fn functions_have_the_same_bits_on_all_processors() {
        let mut all = 0_u32;
        let mut add = |value: f32| all = all.rotate_left(7) ^ value.to_bits();
        for k in 1..2000_u16 {
            let x = f32::from(k) * 0.007_31;
            [exp(x), ln(x), inverse_cbrt(x)].into_iter().for_each(&mut add);
            let Logistic { rise, rest, tail } = logistic(x - 7.0);
            [rise, rest, tail, Real::powf(x, 1.3)].into_iter().for_each(&mut add);
        }
        assert_eq!(all, 0x71a5_ec02, "{all:#x}");
    }
}
