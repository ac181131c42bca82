//! Numbers that the physics is computed with: plain, several members at once in lanes, with derivatives.

pub(crate) mod dense;
pub mod dual;
pub(crate) mod elementary;
pub mod lanes;
pub(crate) mod line;
mod macros;
pub(crate) mod newton;
mod plain;
pub mod real;
pub mod simd;
pub mod tape;

pub use dual::Dual;
pub use lanes::Lanes;
pub use real::{Logistic, Mask, Real};
