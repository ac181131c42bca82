//! Neighbouring plain numbers, eight at once: in vector registers, or in an array on machines without registers that this
//! module knows.

use super::WIDTH;
use crate::number::lanes::Lanes;
use crate::number::real::{Chunk, Real};

/// Rows of the unit matrix.
static UNIT: [[f64; WIDTH]; WIDTH] = {
    let mut rows = [[0.0; WIDTH]; WIDTH];
    let mut place = 0;
    while place < WIDTH {
        rows[place][place] = 1.0;
        place += 1;
    }
    rows
};

/// Makes a kind of lanes a chunk of plain numbers.
macro_rules! chunk {
    ($kind:ty, |$numbers:ident| $make:expr, |$value:ident| $take:expr) => {
        impl Chunk<f64> for $kind {
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
            fn filled(number: f64) -> Self {
                Self::constant(number)
            }
            #[inline(always)]
            fn single(number: f64, place: usize) -> Self {
                Self::load(&UNIT[place]) * Self::constant(number)
            }
            #[inline(always)]
            fn broadcast(self, place: usize) -> Self {
                Self::constant(self.lane(place))
            }
            #[inline(always)]
            fn first(self) -> f64 {
                self.lane(0)
            }
            #[inline(always)]
            fn gather(numbers: &[f64], places: &[usize]) -> Self {
                let places = &places[..WIDTH];
                let $numbers = core::array::from_fn(
                    #[inline(always)]
                    |i| numbers[places[i]],
                );
                $make
            }
            #[inline(always)]
            fn scatter(self, numbers: &mut [f64], places: &[usize]) {
                let $value = self;
                let values = $take;
                for (value, &place) in values.into_iter().zip(&places[..WIDTH]) {
                    numbers[place] = value;
                }
            }
        }
    };
}

chunk!(Lanes<WIDTH>, |numbers| Self(numbers), |value| value.0);
#[cfg(target_arch = "x86_64")]
chunk!(super::avx512::Eight, |numbers| Self::of(numbers), |value| value.numbers());
#[cfg(target_arch = "x86_64")]
chunk!(super::avx2::Eight, |numbers| Self::of(numbers), |value| value.numbers());
#[cfg(target_arch = "aarch64")]
chunk!(super::neon::Eight, |numbers| Self::of(numbers), |value| value.numbers());
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
chunk!(super::wasm::Eight, |numbers| Self::of(numbers), |value| value.numbers());
