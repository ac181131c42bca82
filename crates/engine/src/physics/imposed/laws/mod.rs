//! The laws of temperatures that surroundings impose on a side. Each file is one, and its name is the kind of the law in a description:
//! `build.rs` lists the files of this folder, so that a new one is all that a new law needs.

include!(concat!(env!("OUT_DIR"), "/imposed_laws.rs"));
