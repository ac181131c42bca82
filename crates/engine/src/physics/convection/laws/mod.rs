//! The published laws of convection. Each file is one, and its name is the kind of the law in a description: `build.rs` lists the files
//! of this folder, so that a new one is all that a new law needs.
//!
//! A file has a struct of the numbers that remain after geometry, which is named as the file; [`NamedLaw`](super::correlation::NamedLaw)
//! says what it is and reads its numbers, [`Correlation`](super::correlation::Correlation) and
//! [`WindPart`](super::correlation::WindPart) compute it, and a test compares it with a number worked out by hand.

include!(concat!(env!("OUT_DIR"), "/convection_laws.rs"));
