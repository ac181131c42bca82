//! Mascarin's engine: transient physics of buildings with phase-change materials.
//!
//! One way through: a [`description::Description`] is compiled to a [`plan::Plan`], marched with
//! [`march::march`] (or [`batch::ensemble`]) under a [`forcing::Forcing`], and leaves records and an energy ledger. The
//! engine knows no file, no date and no Python.

#![allow(rustdoc::broken_intra_doc_links, reason = "units stand in square brackets: [m] is no link")]

pub(crate) mod balance;
pub mod batch;
mod booking;
pub mod coefficients;
pub mod conduction;
pub mod convection;
pub mod daylight;
pub mod derivatives;
pub mod description;
pub mod dispatch;
pub mod drive;
pub mod error;
mod facade;
pub mod forcing;
pub mod glazing;
pub mod interior;
mod known;
pub mod ledger;
pub mod march;
pub mod optics;
pub mod parameters;
pub mod pcm;
pub mod plan;
pub mod plant;
pub mod probe;
pub mod radiation;
pub mod real;
pub mod residual;
pub(crate) mod room_block;
mod rooms;
mod slabs;
pub mod solar;
pub mod state;
pub mod state_space;
pub mod step;
pub mod zone;
