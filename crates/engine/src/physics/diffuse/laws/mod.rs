//! The published models of the diffuse radiation of the sky. Each file is one, and its name is the kind of the model in a description:
//! `build.rs` lists the files of this folder, so that a new one is all that a new model needs.

include!(concat!(env!("OUT_DIR"), "/diffuse_laws.rs"));
