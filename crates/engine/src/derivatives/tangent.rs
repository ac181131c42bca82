//! A number that carries its slope by a parameter.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use crate::real::Real;

/// A value and its slope by a parameter.
#[derive(Debug, Clone, Copy)]
pub struct Tangent {
    /// Value.
    pub value: f64,
    /// Slope.
    pub slope: f64,
}

impl Tangent {
    /// A number that depends on nothing.
    #[inline(always)]
    pub fn fixed(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }
    /// f(self) from the value and slope of f.
    #[inline]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, slope: self.slope * slope }
    }
}

impl Add for Tangent {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}
impl Sub for Tangent {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}
impl Mul for Tangent {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule is a sum")]
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + other.slope * self.value }
    }
}
impl Div for Tangent {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the quotient rule has a product and a difference")]
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - other.slope * value) / other.value }
    }
}
impl Neg for Tangent {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}
impl AddAssign for Tangent {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Real for Tangent {
    type Mask = bool;
    const LANES: usize = 1;
    const DERIVATIVES: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::fixed(value)
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self.value
    }
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline]
    fn exp(self) -> Self {
        let value = Real::exp(self.value);
        self.chain(value, value)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(Real::ln(self.value), 1.0 / self.value)
    }
    #[inline]
    fn inverse_cbrt(self) -> Self {
        // d x^(-1/3)/dx = -1/3 x^(-4/3)
        let y = self.value.inverse_cbrt();
        let square = y * y;
        self.chain(y, square * square * (-1.0 / 3.0))
    }
    #[inline]
    fn sin(self) -> Self {
        self.chain(Real::sin(self.value), Real::cos(self.value))
    }
    #[inline]
    fn cos(self) -> Self {
        self.chain(Real::cos(self.value), -Real::sin(self.value))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}
