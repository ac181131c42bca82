//! Long-wave radiation: emission of surfaces, exchange inside a zone, sky and ground outdoors.
//!
//! Equations and sources are given in `emission.rs`, `exchange.rs`, `sky.rs` and the files of `skies`, one for each model. Outdoors the sky is split by `sqrt(F_sky)` between sky and
//! air: Walton (1983), NBSSIR 83-2655, doi:10.6028/NBS.IR.83-2655.

mod absorption;
mod emission;
mod exchange;
pub(crate) mod prelude;
pub(crate) mod skies;
pub(crate) mod sky;
pub(crate) mod sky_model;
#[cfg(test)]
pub(crate) mod testing;

pub(crate) use emission::COLDEST;
pub use emission::{Emission, black_temperature};
pub(crate) use exchange::direct_exchange_areas;
pub use exchange::{exchange_areas, self_weight};
pub use sky::SkyEmission;
pub use sky_model::SkyWeather;
