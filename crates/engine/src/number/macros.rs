//! Repeated parts of the implementations of [`Real`](super::real::Real), written once.

/// `+=` by the sum.
macro_rules! add_assign {
    ([$($parameters:tt)*] $kind:ty) => {
        impl<$($parameters)*> core::ops::AddAssign for $kind {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
    };
}

/// Methods that are functions of one number in [`elementary`](super::elementary), in a precision.
macro_rules! elementary_functions {
    ($inline:ident $precision:ident: $($function:ident),*) => {$(
        #[inline($inline)]
        fn $function(self) -> Self {
            $crate::number::elementary::$precision::$function(self)
        }
    )*};
}

/// The functions of a number with derivatives, from values and slopes of the functions of its value. `$inline` says whether
/// elementary functions are inlined.
macro_rules! chain_rule {
    ($inline:ident) => {
        #[inline($inline)]
        fn sqrt(self) -> Self {
            let root = self.value.sqrt();
            self.chain(root, 0.5 / root)
        }
        #[inline($inline)]
        fn exp(self) -> Self {
            let value = Real::exp(self.value);
            self.chain(value, value)
        }
        #[inline($inline)]
        fn ln(self) -> Self {
            self.chain(Real::ln(self.value), 1.0 / self.value)
        }
        #[inline($inline)]
        fn logistic(self) -> Logistic<Self> {
            let at = self.value.logistic();
            let slopes = at.slopes(self.value);
            Logistic {
                rise: self.chain(at.rise, slopes.rise),
                rest: self.chain(at.rest, slopes.rest),
                tail: self.chain(at.tail, slopes.tail),
            }
        }
        #[inline($inline)]
        fn inverse_cbrt(self) -> Self {
            // d x^(-1/3)/dx = -1/3 x^(-4/3)
            let y = self.value.inverse_cbrt();
            let square = y * y;
            self.chain(y, square * square * (-1.0 / 3.0))
        }
        #[inline($inline)]
        fn sin(self) -> Self {
            self.chain(Real::sin(self.value), Real::cos(self.value))
        }
        #[inline($inline)]
        fn cos(self) -> Self {
            self.chain(Real::cos(self.value), -Real::sin(self.value))
        }
        #[inline(always)]
        fn scale(self, factor: f64) -> Self {
            self.chain(self.value * factor, factor)
        }
        #[inline(always)]
        fn lt(self, other: Self) -> bool {
            self.value < other.value
        }
        #[inline(always)]
        fn select(mask: bool, yes: Self, no: Self) -> Self {
            if mask { yes } else { no }
        }
    };
}

pub(super) use {add_assign, chain_rule, elementary_functions};
