//! The plain number `f64`.

use crate::number::elementary::{Bits, EXPONENT_BIAS, INVERSE_CBRT, SPLIT, THIRD, TWO_52, logistic};
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
    elementary_functions!(always: exp, ln, inverse_cbrt, sin, cos);
    #[inline(always)]
    fn logistic(self) -> Logistic<Self> {
        logistic(self)
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
        Self::from_bits(shifted.to_bits().wrapping_add(EXPONENT_BIAS) << 52)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = bits.wrapping_add(SPLIT) >> 52;
        let m = Self::from_bits(bits.wrapping_add(EXPONENT_BIAS << 52).wrapping_sub(exponent << 52));
        let e = Self::from_bits(exponent | TWO_52) - (4_503_599_627_370_496.0 + EXPONENT_BIAS as f64);
        (m, e)
    }
    #[inline(always)]
    fn inverse_cbrt_guess(self) -> Self {
        let third = ((self.to_bits() >> 32) * THIRD) >> 32;
        Self::from_bits(INVERSE_CBRT.wrapping_sub(third) << 32)
    }
}
