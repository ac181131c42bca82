//! Finds the library that goes into an FMU: Cargo builds all crate types of a dependency, the `cdylib` of `mascarin-fmu` beside its
//! `rlib`, and before this crate, whose own library needs the `rlib`. So one build makes both, and the engine is compiled once. This
//! program may run before it is there; `include_bytes!` reads it when this crate is compiled.

use std::env::var;
use std::fs::OpenOptions;
use std::path::PathBuf;

fn main() {
    let (prefix, suffix) = match var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("windows") => ("", ".dll"),
        Ok("macos") => ("lib", ".dylib"),
        _ => ("lib", ".so"),
    };
    // target/release/build/mascarin-python-0123456789abcdef/out
    let out = PathBuf::from(var("OUT_DIR").expect("Cargo sets OUT_DIR"));
    let profile = out.ancestors().nth(3).expect("OUT_DIR is four folders deep");
    let library = profile.join("deps").join(format!("{prefix}mascarin_fmu{suffix}"));
    // `cargo check` and clippy build no libraries, but want the file. A build writes over it.
    let _ = OpenOptions::new().write(true).create_new(true).open(&library);
    println!("cargo::rustc-env=MASCARIN_FMU_LIBRARY={}", library.display());
    println!("cargo::rustc-env=MASCARIN_FMU_SUFFIX={suffix}");
    println!("cargo::rerun-if-changed=build.rs");
}
