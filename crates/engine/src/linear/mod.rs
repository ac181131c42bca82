//! Linear systems: the temperatures of all cells, surfaces and airs of a building in one implicit stage.
//!
//! | module | what it holds |
//! |---|---|
//! | `unknowns`, `laws` | temperatures, and all laws as straight lines |
//! | `tridiagonal` | a chain of cells eliminated onto its two ends |
//! | `wall_linearisation`, `wall` | tangents of phase change, and a wall eliminated onto its two surfaces |
//! | `transition_matrices` | a whole step of a wall of constant properties as one linear map |
//! | `surface_balance` | balances of surfaces, exterior surfaces eliminated |
//! | `zone_elimination` | the surfaces of one zone eliminated together, a small dense system |
//! | `coupled` | what is left: airs and shared surfaces, a sparse system of known pattern |
//! | `building_system`, `building_solution`, `stage_matrix` | all of them together: assembly and solution, other right-hand sides and the transpose |
//! | `product` | right-hand sides of any kind of number |

pub(crate) mod building_solution;
pub(crate) mod building_system;
pub(crate) mod coupled;
pub(crate) mod laws;
pub(crate) mod product;
pub(crate) mod stage_matrix;
pub(crate) mod surface_balance;
pub(crate) mod thick_walls;
pub(crate) mod transition_matrices;
pub(crate) mod tridiagonal;
pub(crate) mod unknowns;
pub(crate) mod vent_network;
pub(crate) mod wall;
pub(crate) mod wall_factors;
pub(crate) mod wall_linearisation;
pub(crate) mod zone_elimination;

#[cfg(test)]
mod testing;
