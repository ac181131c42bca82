//! Stopping a run from outside, and its progress.

use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::error::EngineError;

/// Shared between a run and its caller.
#[derive(Debug, Default)]
pub struct RunControl {
    /// Set to stop the run.
    pub stop: AtomicBool,
    /// Members finished so far.
    pub done: AtomicUsize,
}

impl RunControl {
    /// An error where the caller has stopped the run.
    ///
    /// # Errors
    /// [`EngineError::Interrupted`].
    #[inline(always)]
    pub(crate) fn check(&self) -> Result<(), EngineError> {
        if self.stop.load(Ordering::Relaxed) { Err(EngineError::Interrupted) } else { Ok(()) }
    }

    /// Counts finished members.
    pub(crate) fn count(&self, members: usize) {
        self.done.fetch_add(members, Ordering::Relaxed);
    }
}
