//! Linear systems of walls, zones and the building.

pub mod coupled;
pub mod step_maps;
pub mod surface_balance;
pub mod wall;
pub mod zone_front;
