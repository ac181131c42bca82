//! Eight numbers at once in the vector registers of the machine, or sixteen in single precision.
//!
//! The only module of the engine with `unsafe` code. Each type `Eight` or `Sixteen` below holds that many numbers and computes with one set of
//! vector instructions; a token ([`Avx512`]) proves that the machine has them. No operation is contracted or reordered: every
//! level gives the bits of a plain `f64`, or of a plain `f32`.
//!
//! Two kinds of work use them: a [`LaneTask`] computes eight or sixteen members of an ensemble, a [`ChunkTask`] eight neighbouring
//! numbers of one member.

#![allow(unsafe_code, reason = "vector instructions are unsafe to call where the machine may not have them")]

mod array;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(all(target_arch = "x86_64", feature = "all-lanes"))]
mod avx2_single;
#[cfg(target_arch = "x86_64")]
#[cfg_attr(not(feature = "all-lanes"), allow(dead_code, reason = "ensembles do not use it"))]
mod avx512;
#[cfg(all(target_arch = "x86_64", feature = "all-lanes"))]
mod avx512_single;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(all(target_arch = "aarch64", feature = "all-lanes"))]
mod neon_single;
mod registers;
mod token;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;

#[cfg(test)]
mod tests;

pub use token::{Avx2, Avx512, Level, Neon, Simd128};

use crate::number::lanes::Lanes;
use crate::number::real::{ChunkTask, Real};

/// Members in one pack.
pub const WIDTH: usize = 8;
/// Members in one pack in single precision.
pub const SINGLE_WIDTH: usize = 16;

/// Work on members of an ensemble, with lanes of any kind.
pub trait LaneTask {
    /// Its result.
    type Output;
    /// Does the work with one kind of lanes, which `pack` makes of [`Real::LANES`] numbers.
    fn run<S: Real>(self, pack: impl Fn(&[f64]) -> S + Copy) -> Self::Output;
    /// What is given where the machine has no registers for lanes, so that each member must be computed by itself.
    fn without_lanes(self) -> Self::Output;
}

/// Does a task on eight members with the registers of a level.
pub fn run<T: LaneTask>(level: Level, task: T) -> T::Output {
    match level {
        #[cfg(all(target_arch = "x86_64", feature = "all-lanes"))]
        Level::Avx512(token) => task.run(move |numbers| avx512::Eight::new(token, numbers)),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(token) => task.run(move |numbers| avx2::Eight::new(token, numbers)),
        #[cfg(target_arch = "aarch64")]
        Level::Neon(token) => task.run(move |numbers| neon::Eight::new(token, numbers)),
        // Compiled for arrays, all laws and solvers once more would be a seventh of the library, for machines without AVX2.
        _ => task.without_lanes(),
    }
}

/// Does a task on sixteen members in single precision with the registers of a level.
pub fn run_single<T: LaneTask>(level: Level, task: T) -> T::Output {
    match level {
        #[cfg(all(target_arch = "x86_64", feature = "all-lanes"))]
        Level::Avx512(token) => task.run(move |numbers| avx512_single::Sixteen::new(token, numbers)),
        #[cfg(all(target_arch = "x86_64", feature = "all-lanes"))]
        Level::Avx2(token) => task.run(move |numbers| avx2_single::Sixteen::new(token, numbers)),
        #[cfg(all(target_arch = "aarch64", feature = "all-lanes"))]
        Level::Neon(token) => task.run(move |numbers| neon_single::Sixteen::new(token, numbers)),
        _ => task.without_lanes(),
    }
}

/// Does a task on neighbouring plain numbers with the registers of the level in use.
#[inline(always)]
pub(super) fn in_chunks<T: ChunkTask<f64>>(task: T) -> T::Output {
    in_chunks_at(Level::in_use(), task)
}

#[inline(always)]
fn in_chunks_at<T: ChunkTask<f64>>(level: Level, task: T) -> T::Output {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(_) => avx512::Eight::vectorised(
            #[inline(always)]
            || task.run::<avx512::Eight>(),
        ),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) => avx2::Eight::vectorised(
            #[inline(always)]
            || task.run::<avx2::Eight>(),
        ),
        #[cfg(target_arch = "aarch64")]
        Level::Neon(_) => neon::Eight::vectorised(
            #[inline(always)]
            || task.run::<neon::Eight>(),
        ),
        // A module that is compiled with these vectors is loaded by machines that have them, and by no others.
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        _ => wasm::Eight::vectorised(
            #[inline(always)]
            || task.run::<wasm::Eight>(),
        ),
        #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
        _ => task.run::<Lanes<WIDTH>>(),
    }
}

/// Does work on arrays of plain numbers, such as slopes. The compiler vectorises it, with AVX2 where that may be used.
#[inline(always)]
pub(crate) fn widened<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        /// # Safety
        /// The machine must have AVX2.
        #[target_feature(enable = "avx2")]
        unsafe fn with_avx2<R>(_token: Avx2, work: impl FnOnce() -> R) -> R {
            work()
        }
        let token = match Level::in_use() {
            Level::Avx512(token) => Some(token.into()),
            Level::Avx2(token) => Some(token),
            _ => None,
        };
        if let Some(token) = token {
            // SAFETY: the token proves that the machine has AVX2.
            return unsafe { with_avx2(token, work) };
        }
    }
    work()
}
