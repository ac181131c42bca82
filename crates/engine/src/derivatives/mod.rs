//! Exact derivatives of the discrete solution: the same physics, computed with numbers that have derivatives.
//!
//! - Forward (`forward`): each number carries its slopes by a few parameters. Result: all records by few parameters.
//! - Reverse (`reverse`): the operations of each step are recorded on a tape. Result: one quantity by all parameters.
//!
//! Both start from the known solutions of a run of plain numbers (`stored_steps`): only the slopes of the equations are
//! differentiated (`equation_slopes`, `constant_terms`), and the slopes of the solution follow by the implicit function theorem. A step that
//! was made in parts is followed part by part. At a switch (the ends of a melting range, a curve of hysteresis, windward and leeward, the
//! start of a load) the slope is the one-sided one of the branch taken.
//!
//! Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., doi:10.1137/1.9780898717761.

mod constant_terms;
mod equation_slopes;
mod forward;
mod kept_steps;
mod periodic_slopes;
mod reverse;
mod stored_steps;

pub use forward::{Direction, Jacobian, jacobian, slopes_along};
pub use reverse::Trajectory;

#[cfg(test)]
mod thick_wall_tests;
