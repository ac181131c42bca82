//! Laws of materials, surfaces, radiation, windows and air flow, without a plan.

pub mod air_flow;
pub mod convection;
pub mod glazing;
pub mod longwave;
pub mod optics;
pub mod pcm;
pub mod solar;
