//! The functions of the Functional Mock-up Interface: pointers in, pointers out.
//!
//! The one place of this crate where code is `unsafe`: the standard is a set of C functions, which are given pointers. What each pointer
//! must be is stated in the standard; here it is only read as that, and null is refused where that can be. No panic leaves
//! a function: the unit then answers `fatal`.

#![allow(unsafe_code, reason = "C functions are given pointers")]
#![allow(non_snake_case, reason = "the names of the standard")]

mod alike;
mod calls;
mod fmi2;
mod fmi3;
