//! Elementary functions, written once for plain numbers and lanes of a precision.
//!
//! They are branch-free and built from `+ - * /` and bit operations, each correctly rounded by IEEE 754: the result has
//! the same bits alone, in a lane and on every processor. Those of angles are rare; they come from the crate `libm` (the
//! functions of musl and FreeBSD in Rust), number by number, with the same bits on every processor too. Those of the
//! standard library are the system's, which chooses among several by processor.

pub(crate) mod double;
pub(crate) mod single;

use crate::number::real::Real;

pub(crate) use libm::{acos, cos, sin, sincos};

/// A degree [rad].
const RADIANS: f64 = core::f64::consts::PI / 180.0;

/// Sine of an angle in degrees: in double precision also where numbers have single precision, so that it is zero at 180 deg.
#[inline(always)]
pub(crate) fn sin_of_degrees<S: Real>(degrees: S) -> S {
    if const { S::SINGLE } {
        return S::of_lanes(|lane| sin(degrees.lane(lane) * RADIANS));
    }
    degrees.scale(RADIANS).sin()
}

/// Cosine of an angle in degrees, as the sine: zero at 90 deg, with the sign that it has in double precision.
#[inline(always)]
pub(crate) fn cos_of_degrees<S: Real>(degrees: S) -> S {
    if const { S::SINGLE } {
        return S::of_lanes(|lane| cos(degrees.lane(lane) * RADIANS));
    }
    degrees.scale(RADIANS).cos()
}

/// Operations on the bits of a number that elementary functions need, in each lane.
pub(crate) trait Bits: Real {
    /// `2^k` of the integer k that stands in the low bits of `ROUND + k`, see there.
    fn power_of_two(shifted: Self) -> Self;
    /// (m, e) with x = m 2^e and m in \[sqrt(1/2), sqrt 2).
    fn split(self) -> (Self, Self);
    /// `x^(-1/3)` within 4 %, from a third of the exponent.
    fn inverse_cbrt_guess(self) -> Self;
}

/// Value of a polynomial whose highest coefficient comes first.
#[inline(always)]
fn polynomial<S: Real, const N: usize>(x: S, coefficients: [f64; N]) -> S {
    let mut sum = S::constant(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        sum = sum * x + S::constant(coefficient);
    }
    sum
}

/// x^(-1/3) of a positive normal number: two steps of `y (1 + r/3 + 2 r^2/9 + 14 r^3/81)`,
/// r = 1 - x y^3, each of which takes the error to its fourth power; no division.
#[inline(always)]
pub(crate) fn inverse_cbrt<S: Bits>(x: S) -> S {
    let mut y = x.inverse_cbrt_guess();
    for _ in 0..2 {
        let r = S::one() - x * (y * y * y);
        y = y + y * (r * polynomial(r, [14.0 / 81.0, 2.0 / 9.0, 1.0 / 3.0]));
    }
    y
}
