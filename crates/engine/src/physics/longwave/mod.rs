//! Long-wave radiation: emission of surfaces, exchange inside a zone, sky and ground outdoors.
//!
//! Equations and sources are given in `emission.rs`, `exchange.rs` and `sky.rs`. Outdoors the sky is split by `sqrt(F_sky)` between sky and
//! air: Walton (1983), NBSSIR 83-2655, doi:10.6028/NBS.IR.83-2655.

mod absorption;
mod emission;
mod exchange;
mod sky;

pub(crate) use emission::COLDEST;
pub use emission::{Emission, black_temperature};
pub(crate) use exchange::direct_exchange_areas;
pub use exchange::{exchange_areas, self_weight};
pub(crate) use sky::sky_law;
pub use sky::{CloudEffect, SkyState, sky_emission};
