//! Laws of materials, surfaces, radiation, windows and air flow: functions of plain numbers, without a plan.

pub mod air_flow;
pub mod constants;
pub mod convection;
pub mod gains;
pub mod longwave;
pub mod optics;
pub mod pcm;
pub mod solar;
pub mod window_gaps;
