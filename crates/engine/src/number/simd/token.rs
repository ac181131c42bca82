//! Which vector instructions may be used: tokens that only detection can make.
//!
//! A token is the proof that the machine has a set of instructions. Its field is private to this module, so no other code
//! can make one: what asks for a token by value needs no further check.

use core::sync::atomic::{AtomicU8, Ordering};

use crate::error::EngineError;

/// A token: its documentation, name, architecture and the features to detect on it.
macro_rules! token {
    ($(#[$doc:meta])* $name:ident, $architecture:literal, $detected:ident, [$($feature:tt),*]) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub struct $name(());

        impl $name {
            /// The token, where the machine has these instructions.
            pub fn detect() -> Option<Self> {
                #[cfg(target_arch = $architecture)]
                {
                    ($(std::arch::$detected!($feature))&&*).then_some(Self(()))
                }
                #[cfg(not(target_arch = $architecture))]
                {
                    None
                }
            }
        }
    };
}

token!(
    /// Proof that the machine has NEON.
    ///
    /// ```compile_fail,E0423
    /// let forged = mascarin_engine::number::simd::Neon(());
    /// ```
    Neon, "aarch64", is_aarch64_feature_detected, ["neon"]
);
token!(
    /// Proof that the machine has AVX2.
    ///
    /// ```compile_fail,E0423
    /// let forged = mascarin_engine::number::simd::Avx2(());
    /// ```
    Avx2, "x86_64", is_x86_feature_detected, ["avx2"]
);
token!(
    /// Proof that the machine has AVX-512 (and with it AVX2).
    ///
    /// ```compile_fail,E0423
    /// let forged = mascarin_engine::number::simd::Avx512(());
    /// ```
    Avx512, "x86_64", is_x86_feature_detected, ["avx512f", "avx2"]
);

/// Proof that the module was compiled with the vectors of WebAssembly, so that a machine that runs it has them.
///
/// ```compile_fail,E0423
/// let forged = mascarin_engine::number::simd::Simd128(());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Simd128(());

impl Simd128 {
    /// The token, where the module was compiled with them.
    #[must_use]
    pub fn detect() -> Option<Self> {
        cfg!(all(target_arch = "wasm32", target_feature = "simd128")).then_some(Self(()))
    }
}

impl From<Avx512> for Avx2 {
    fn from(_: Avx512) -> Self {
        Self(())
    }
}

/// The registers that eight numbers are computed in.
///
/// A level above the array holds the token of its instructions, so that it exists only where the machine has them:
///
/// ```compile_fail
/// let level: mascarin_engine::number::simd::Level = mascarin_engine::number::simd::Level::Avx512;
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Arrays, on every machine.
    Array,
    /// Four registers of two.
    Neon(Neon),
    /// Two registers of four.
    Avx2(Avx2),
    /// One register of eight.
    Avx512(Avx512),
}

const ARRAY: u8 = 1;
const NEON: u8 = 2;
const AVX2: u8 = 3;
const AVX512: u8 = 4;

/// Rank of the level in use; zero before the first use. Only [`Level::set`] writes it.
static IN_USE: AtomicU8 = AtomicU8::new(0);

impl Level {
    /// Environment variable that asks for narrower registers than the machine has: to measure them, or to check that they
    /// give the same bits.
    pub const VARIABLE: &str = "MASCARIN_LANES";

    /// All levels of this machine, the narrowest first.
    pub fn available() -> impl Iterator<Item = Self> {
        let wider = [
            Neon::detect().map(Self::Neon),
            Avx2::detect().map(Self::Avx2),
            Avx512::detect().map(Self::Avx512).filter(|_| cfg!(feature = "all-lanes")),
        ];
        core::iter::once(Self::Array).chain(wider.into_iter().flatten())
    }

    /// The widest level that this machine has and the environment allows. From now on single runs use it too.
    ///
    /// # Errors
    /// [`EngineError::Input`] when the environment names no level.
    pub fn widest() -> Result<Self, EngineError> {
        let asked = std::env::var(Self::VARIABLE).unwrap_or_default();
        let allowed = match asked.as_str() {
            "" | "avx512" => AVX512,
            "avx2" => AVX2,
            "neon" => NEON,
            "array" => ARRAY,
            other => {
                return Err(EngineError::Input(format!(
                    "environment variable {}: found '{other}', expected avx512, avx2, neon or array",
                    Self::VARIABLE
                )));
            }
        };
        let found = Self::available().filter(|level| level.rank() <= allowed).last();
        let level = found.unwrap_or(Self::Array);
        level.set();
        Ok(level)
    }

    /// The level that [`Self::widest`] has found last.
    #[inline(always)]
    pub fn in_use() -> Self {
        // A rank stands there only where `set` was given its token.
        match IN_USE.load(Ordering::Relaxed) {
            AVX512 => Self::Avx512(Avx512(())),
            AVX2 => Self::Avx2(Avx2(())),
            NEON => Self::Neon(Neon(())),
            ARRAY => Self::Array,
            _ => Self::on_first_use(),
        }
    }

    /// Finds the level where no run has asked for it yet. A name that is not known is reported when a run starts.
    #[cold]
    fn on_first_use() -> Self {
        Self::widest().unwrap_or(Self::Array)
    }

    /// Takes this level into use.
    fn set(self) {
        IN_USE.store(self.rank(), Ordering::Relaxed);
    }

    fn rank(self) -> u8 {
        match self {
            Self::Array => ARRAY,
            Self::Neon(_) => NEON,
            Self::Avx2(_) => AVX2,
            Self::Avx512(_) => AVX512,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_made_by_detection_alone() {
        let levels: Vec<_> = Level::available().collect();
        assert_eq!(levels[0], Level::Array);
        assert_eq!(levels.iter().any(|level| matches!(level, Level::Avx512(_))), Avx512::detect().is_some());
        assert!(levels.is_sorted_by_key(|level| level.rank()));
        assert!(levels.contains(&Level::widest().unwrap()));
        #[cfg(target_arch = "aarch64")]
        assert!(Neon::detect().is_some(), "all machines of this architecture have it");
    }

    #[test]
    fn instructions_of_other_architectures_are_never_found() {
        assert!(!cfg!(target_arch = "x86_64") || Neon::detect().is_none());
        assert!(cfg!(target_arch = "wasm32") || Simd128::detect().is_none());
        assert!(!cfg!(target_arch = "aarch64") || (Avx2::detect().is_none() && Avx512::detect().is_none()));
    }
}
