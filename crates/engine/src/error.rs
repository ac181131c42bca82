//! What can stop a run.

use thiserror::Error;

/// Every way in which the engine refuses or stops.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum EngineError {
    /// The description cannot be compiled. The description language should have said so before.
    #[error("the description cannot be compiled: {0}")]
    Description(String),
    /// Arrays of the wrong shape, unknown outputs, unusable options.
    #[error("{0}")]
    Input(String),
    /// Newton's iteration did not converge.
    #[error(
        "step {step} (stage {stage}) did not converge: {place} still moves by {residual:.3e} K after {iterations} \
         iterations. Use a shorter step, a wider melting range or more nodes in the layer."
    )]
    NotConverged {
        /// Index of the step from the start of the forcing.
        step: usize,
        /// Stage of the scheme, from 1.
        stage: usize,
        /// Name of the wall or zone that moves most.
        place: String,
        /// Largest change in the last iteration [K].
        residual: f64,
        /// Iterations spent.
        iterations: usize,
    },
    /// The warm-up did not converge.
    #[error(
        "the first period was repeated {cycles} times and the state still changes by {residual:.3} K (allowed: \
         {tolerance} K). Give a longer first period, an initial temperature or a larger tolerance."
    )]
    WarmUpNotConverged {
        /// Repetitions made.
        cycles: usize,
        /// Largest change between the last two repetitions [K].
        residual: f64,
        /// Largest change accepted [K].
        tolerance: f64,
    },
    /// A step has led to what no building can do.
    #[error(
        "step {step} leads to what is impossible: {place} has {what}. The solver has failed there, or a number of this part is \
         absurd: check its numbers, and use a shorter step."
    )]
    Impossible {
        /// Index of the step from the start of the forcing.
        step: usize,
        /// Name of the part.
        place: String,
        /// Quantity, value and limit.
        what: String,
    },
    /// The caller stopped the run.
    #[error("interrupted")]
    Interrupted,
}
