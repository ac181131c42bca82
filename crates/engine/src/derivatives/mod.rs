//! Exact derivatives of the discrete solution: the engine's own physics run with other numbers.
//!
//! Forward ([`jacobian`]), numbers carry their slopes by a few parameters: all series by few parameters. In reverse
//! ([`trajectory`]), numbers remember what they were made of: one quantity by all parameters.
//!
//! Both go along the solutions of a plain run ([`crate::number::real::Equations`]); where one is not known, Newton's iteration adds a last
//! step, so that the slopes of a converged stage are those of its solution. At a switch (the ends of a melting range, a curve of hysteresis, windward and leeward, a load that
//! sets in) the slope is the one-sided one of the branch taken.
//!
//! Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., doi:10.1137/1.9780898717761.

mod along;
mod equations;
pub mod jacobian;
pub mod trajectory;
