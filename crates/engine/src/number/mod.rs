//! Numbers that the physics is computed with: plain, in lanes, with derivatives.

pub mod equations;
pub mod real;
pub mod simd;
pub mod tape;
