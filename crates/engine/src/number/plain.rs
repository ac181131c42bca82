//! The plain numbers `f64` and `f32`. Runs of one member use the first; the second is what lanes of single precision are held to.

use crate::number::elementary::{Bits, cos, double, sin, single};
use crate::number::macros::elementary_functions;
use crate::number::real::{ChunkTask, Logistic, Real};

impl Real for f64 {
    type Mask = bool;
    type Equations = ();
    const LANES: usize = 1;
    const DERIVATIVES: bool = false;
    const CHUNK: usize = crate::number::simd::WIDTH;
    const IN_REGISTERS: bool = true;

    #[inline(always)]
    fn in_chunks<T: ChunkTask<Self>>(task: T) -> T::Output {
        crate::number::simd::in_chunks(task)
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    elementary_functions!(always double: exp, ln, inverse_cbrt);
    #[inline(always)]
    fn sin(self) -> Self {
        sin(self)
    }
    #[inline(always)]
    fn cos(self) -> Self {
        cos(self)
    }
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        double::logistic(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

impl Bits for f64 {
    #[inline(always)]
    fn power_of_two(shifted: Self) -> Self {
        Self::from_bits(shifted.to_bits().wrapping_add(double::EXPONENT_BIAS) << 52)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = bits.wrapping_add(double::SPLIT) >> 52;
        let m = Self::from_bits(bits.wrapping_add(double::EXPONENT_BIAS << 52).wrapping_sub(exponent << 52));
        let e = Self::from_bits(exponent | double::TWO_52)
            - (4_503_599_627_370_496.0 + double::EXPONENT_BIAS as f64);
        (m, e)
    }
    #[inline(always)]
    fn inverse_cbrt_guess(self) -> Self {
        let third = ((self.to_bits() >> 32) * double::THIRD) >> 32;
        Self::from_bits(double::INVERSE_CBRT.wrapping_sub(third) << 32)
    }
}

/// A number in single precision. What is too small for it becomes the least normal number: limits that keep a divisor from zero do so
/// in both precisions.
#[inline(always)]
fn single_of(value: f64) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "it rounds")]
    let rounded = value as f32;
    if value != 0.0 && rounded.abs() < f32::MIN_POSITIVE {
        f32::MIN_POSITIVE.copysign(rounded)
    } else {
        rounded
    }
}

impl Real for f32 {
    type Mask = bool;
    type Equations = ();
    const LANES: usize = 1;
    const DERIVATIVES: bool = false;
    const SINGLE: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        single_of(value)
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
    elementary_functions!(always single: exp, ln, inverse_cbrt);
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        single::logistic(self)
    }
    #[inline(always)]
    fn sin(self) -> Self {
        single_of(sin(f64::from(self)))
    }
    #[inline(always)]
    fn cos(self) -> Self {
        single_of(cos(f64::from(self)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

impl Bits for f32 {
    #[inline(always)]
    fn power_of_two(shifted: Self) -> Self {
        Self::from_bits(shifted.to_bits().wrapping_add(single::EXPONENT_BIAS) << 23)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = bits.wrapping_add(single::SPLIT) >> 23;
        let m = Self::from_bits(bits.wrapping_add(single::EXPONENT_BIAS << 23).wrapping_sub(exponent << 23));
        let e = Self::from_bits(exponent | single::TWO_23) - (8_388_608.0 + single::EXPONENT_BIAS as Self);
        (m, e)
    }
    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the bits of a positive number"
    )]
    fn inverse_cbrt_guess(self) -> Self {
        let third = (self.to_bits() as Self * (1.0 / 3.0)) as u32;
        Self::from_bits(single::INVERSE_CBRT.wrapping_sub(third))
    }
}
