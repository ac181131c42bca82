//! Linear systems of walls, zones and the building.

pub mod coupled;
pub(crate) mod product;
pub mod step_maps;
pub mod surface_balance;
pub(crate) mod tridiagonal;
pub mod wall;
pub(crate) mod wall_linearisation;
pub mod zone_front;

#[cfg(test)]
mod testing;
