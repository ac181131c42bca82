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
    /// Steps made so far, without those of the warm-up.
    pub steps: AtomicUsize,
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

    /// Counts a step.
    #[inline(always)]
    pub(crate) fn count_step(&self) {
        self.steps.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts finished members.
    pub(crate) fn count(&self, members: usize) {
        self.done.fetch_add(members, Ordering::Relaxed);
    }
}
