//! Neighbouring plain numbers of an array, eight at once: in registers, or in an array where the machine has none that
//! this module knows.

use super::WIDTH;
use crate::number::lanes::Lanes;
use crate::number::real::{Abreast, Real};

/// One in one place, zero in all others.
static ALONE: [[f64; WIDTH]; WIDTH] = {
    let mut rows = [[0.0; WIDTH]; WIDTH];
    let mut place = 0;
    while place < WIDTH {
        rows[place][place] = 1.0;
        place += 1;
    }
    rows
};

/// Plain numbers side by side in lanes of some kind.
macro_rules! side_by_side {
    ($kind:ty, |$numbers:ident| $make:expr, |$value:ident| $take:expr) => {
        impl Abreast<f64> for $kind {
            #[inline(always)]
            fn load(numbers: &[f64]) -> Self {
                let mut $numbers = [0.0; WIDTH];
                $numbers.copy_from_slice(&numbers[..WIDTH]);
                $make
            }
            #[inline(always)]
            fn store(self, numbers: &mut [f64]) {
                let $value = self;
                numbers[..WIDTH].copy_from_slice(&$take);
            }
            #[inline(always)]
            fn everywhere(number: f64) -> Self {
                Self::constant(number)
            }
            #[inline(always)]
            fn alone(number: f64, place: usize) -> Self {
                Self::load(&ALONE[place]) * Self::constant(number)
            }
            #[inline(always)]
            fn spread(self, place: usize) -> Self {
                Self::constant(self.lane(place))
            }
            #[inline(always)]
            fn first(self) -> f64 {
                self.lane(0)
            }
            #[inline(always)]
            fn pick(numbers: &[f64], places: &[usize]) -> Self {
                let places = &places[..WIDTH];
                let $numbers = core::array::from_fn(
                    #[inline(always)]
                    |i| numbers[places[i]],
                );
                $make
            }
        }
    };
}

side_by_side!(Lanes<WIDTH>, |numbers| Self(numbers), |value| value.0);
#[cfg(target_arch = "x86_64")]
side_by_side!(super::avx512::Eight, |numbers| Self::of(numbers), |value| value.numbers());
#[cfg(target_arch = "x86_64")]
side_by_side!(super::avx2::Eight, |numbers| Self::of(numbers), |value| value.numbers());
#[cfg(target_arch = "aarch64")]
side_by_side!(super::neon::Eight, |numbers| Self::of(numbers), |value| value.numbers());
