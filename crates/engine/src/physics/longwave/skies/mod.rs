//! The published models of the sky. Each file is one, and its name is the kind of the model in a description: `build.rs` lists the
//! files of this folder, so that a new one is all that a new model needs.
//!
//! A file has a struct of its numbers, which is named as the file; [`SkyModel`](super::sky_model::SkyModel) says what it is, reads its
//! numbers and computes it. A test compares it with a number worked out by hand.

include!(concat!(env!("OUT_DIR"), "/sky_laws.rs"));
