//! A building as a unit for co-simulation: the library inside of an FMU (Functional Mock-up Interface 3.0 and 2.0,
//! <https://fmi-standard.org>).
//!
//! [`resources`] reads what `mascarin fmu` has written into the unit: the building as the engine reads it, the weather, and the variables.
//! [`unit`] is the unit without C: variables, modes, steps, states. `border` has the functions of the standard, and is the only place of
//! this crate where code is `unsafe`: it reads the pointers that it is given.

mod border;
pub mod resources;
mod running;
pub mod saved;
pub mod unit;
