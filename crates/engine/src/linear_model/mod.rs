//! A linear building as matrices: `dx/dt = A x + B u`, `y = C x + D u`.
//!
//! States are cell and air temperatures; surfaces store no heat and are eliminated. The matrices come from the heat
//! balances of `balance::terms`. Only buildings whose laws are all linear and constant have such a form; for the
//! others the error names the first law that is not.

mod matrices;
mod network;
mod requirements;
mod state_space;

pub use matrices::StateSpace;
pub use state_space::state_space;

#[cfg(test)]
mod tests;
