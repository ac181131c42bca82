//! The engine inside of a page: a module for WebAssembly, which a page that `mascarin page` has made runs in its browser.
//!
//! [`model`] is a building with its weather, which is run with other values as often as a slider moves. `border` has the functions that the
//! page calls; it is compiled for browsers alone.

#[cfg(target_arch = "wasm32")]
mod border;
pub mod model;
