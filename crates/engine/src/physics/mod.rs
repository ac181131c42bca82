//! Laws of materials, surfaces, radiation, windows and air flow: functions of plain numbers, without a plan.

pub mod air_flow;
pub mod blinds;
#[cfg(test)]
mod borders;
pub mod constants;
pub mod convection;
pub mod diffuse;
pub mod doors;
pub mod flow_density;
pub(crate) mod formula;
pub mod gains;
pub mod globe;
pub(crate) mod heat_sources;
pub mod horizon;
pub mod imposed;
pub mod law_row;
pub mod leakage;
pub mod longwave;
pub mod mechanical_air;
pub(crate) mod occupants;
pub mod optics;
pub mod pcm;
pub mod psychrometrics;
pub mod solar;
pub mod sorption;
pub mod standard_air;
pub mod vapour_layers;
pub mod vents;
pub mod window_gaps;
