//! Ideal heating and cooling: the load that keeps the air of each zone between its set points.
//!
//! A load is the mean over a step and acts in all of its stages alike. (A load of its own for each stage would let the
//! air overshoot.) It is the one that brings the air onto the set point at the end of the step, as far as the capacity
//! goes, and nothing where the air stays between the set points without it.
//!
//! Step by step ([`sweeps`]): each stage is solved once, about a guess and with guessed loads; the response of the air at
//! the end to each load follows from the factors at hand ([`responses`]); new loads follow from both ([`search`]), and with
//! them the temperatures about which the stages are solved next; and so on until nothing changes. This is one Newton
//! iteration on the temperatures of all stages and the loads together. In each of these sweeps a load is heating, cooling,
//! off or at its capacity by what the air would do without it: Newton's method for the complementarity of load and set point
//! (an active set method: Hintermueller, Ito & Kunisch 2002, SIAM J. Optim. 13(3), doi:10.1137/S1052623401383558).
//!
//! The loads of the last sweep miss the set points by hundred-thousandths of a kelvin at most. The last stage supplies what
//! is missing, so that the air ends on its set point to round-off; the load reported is the mean of both.

pub(crate) mod loads;
pub(crate) mod responses;
mod search;
mod sweeps;
