//! The surfaces that belong to one zone alone, eliminated together: one dense front for each zone.
//!
//! Most walls have constant properties, one surface in a zone and the other in none. The exterior surface is eliminated first
//! ([`exterior`]): it is a straight line of the interior one. The interior surfaces of these walls are the *eliminated*
//! unknowns of the zone's front. Its *retained* unknowns are the zone's other surfaces (of nonlinear walls, or of walls
//! between zones) and its air. With the right-hand side as one more column the front is assembled ([`assemble`]) and
//! eliminated ([`eliminate`]); the Schur complement of the retained unknowns goes to the [`CoupledSystem`](crate::linear::coupled::CoupledSystem) ([`solve`]).
//!
//! The unknowns of a front are the emissions of its surfaces along the tangent of their law, `E = offset + slope T` [W/m2],
//! and the temperature of its air. Surfaces are then coupled by exchange areas, which never change and are symmetric: only
//! the diagonal is assembled, and half of the elimination is saved. A zone without long-wave exchange has `E = T`.
//!
//! A front of many surfaces is not eliminated, but solved by iteration ([`large`]).
//!
//! Zones of one shape are computed side by side in one front ([`side_by_side`]), and with them their windows ([`windows`]).
//!
//! All arrays are in the order of the front, so that neighbours are computed together ([`Chunk`](crate::number::real::Chunk)).

/// The numbers from a place on that fill a register.
macro_rules! part {
    ($line:expr, $start:expr) => {
        V::load(&$line[$start..$start + S::CHUNK])
    };
}

mod assemble;
mod conjugate;
mod eliminate;
mod equations;
mod exterior;
mod front;
mod fronts;
mod large;
mod laws;
mod layout;
mod shape;
mod side_by_side;
mod solve;
mod windows;

pub(crate) use fronts::ZoneFronts;
pub(crate) use layout::Elimination;

#[cfg(test)]
mod tests;
