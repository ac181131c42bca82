//! Ideal heating and cooling: the load that keeps the air of each zone between its set points.
//!
//! A load is the mean over a step and is the same in all stages of the step. (With one load for each stage the air would
//! overshoot.) It brings the air to the set point at the end of the step, as far as the capacity allows, and is zero where
//! the air stays between the set points without it.
//!
//! A step is solved by sweeps ([`sweeps`]). Each sweep solves every stage once, linearised about a guess and with guessed
//! loads. New loads follow, and with them the temperatures about which the next sweep linearises: of one load
//! from the response of the air at the end to it, found with the same factors ([`responses`],
//! [`search`]; so are derivatives of loads along a known solution, [`known`]); of several loads from what holds their airs at the set points ([`augmented_lagrangian`]). The sweeps end when nothing
//! changes: together they are one Newton iteration on the temperatures of all stages and the loads. In each sweep a load is
//! heating, cooling, off or at its capacity according to the temperature that the air would have without it: Newton's method for
//! the complementarity of load and set point
//! (an active set method: Hintermueller, Ito & Kunisch 2002, SIAM J. Optim. 13(3), doi:10.1137/S1052623401383558).
//!
//! After the last sweep the air differs from its set point by some 1e-5 K at most. A correction of the load in the last stage
//! removes this difference to round-off; the load reported is the mean over the step, with the correction.

mod augmented_lagrangian;
pub(crate) mod known;
mod limits;
mod load_iteration;
mod load_sensitivities;
pub(crate) mod loads;
pub(crate) mod responses;
mod search;
