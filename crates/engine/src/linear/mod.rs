//! Linear systems of walls, zones and the building.

pub mod building_system;
pub mod coupled;
pub mod laws;
pub(crate) mod product;
pub mod stage_matrix;
pub mod step_maps;
pub mod surface_balance;
pub(crate) mod tridiagonal;
pub mod unknowns;
pub mod wall;
pub(crate) mod wall_linearisation;
pub mod zone_front;

#[cfg(test)]
mod testing;
