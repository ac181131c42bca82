//! What drives a building: channels over steps and stages.
//!
//! The climate side interpolates; the engine only reads. Channel order is part of the border.

use crate::error::EngineError;
use crate::number::real::Real;

/// Number of climate channels; the description's own channels follow them.
pub const CLIMATE_CHANNELS: usize = 15;

/// Index of each climate channel.
pub mod channel {
    /// Outdoor air temperature [degC].
    pub const AIR_TEMPERATURE: usize = 0;
    /// Dew point [degC].
    pub const DEW_POINT: usize = 1;
    /// Cloud cover [tenths].
    pub const CLOUD_COVER: usize = 2;
    /// Downward horizontal infrared [W/m2]; NaN when the climate has none.
    pub const INFRARED: usize = 3;
    /// Wind speed at the mast [m/s].
    pub const WIND_SPEED: usize = 4;
    /// Direction the wind blows from [deg, clockwise from north].
    pub const WIND_DIRECTION: usize = 5;
    /// Station pressure [Pa]; NaN when unknown.
    pub const PRESSURE: usize = 6;
    /// Direct normal irradiance [W/m2].
    pub const DIRECT_NORMAL: usize = 7;
    /// Diffuse horizontal irradiance [W/m2].
    pub const DIFFUSE_HORIZONTAL: usize = 8;
    /// Global horizontal irradiance [W/m2].
    pub const GLOBAL_HORIZONTAL: usize = 9;
    /// Extraterrestrial normal irradiance [W/m2].
    pub const DIRECT_NORMAL_EXTRA: usize = 10;
    /// East component of the unit vector to the sun.
    pub const SUN_EAST: usize = 11;
    /// North component of the unit vector to the sun.
    pub const SUN_NORTH: usize = 12;
    /// Upward component of the unit vector to the sun.
    pub const SUN_UP: usize = 13;
    /// Day of the year, 0 on 1 January 00:00 [d].
    pub const DAY_OF_YEAR: usize = 14;
}

/// A fraction that a channel of the description gives, or always one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Schedule(Option<usize>);

impl Schedule {
    /// From an index into [`Description::channels`](crate::input::description::Description::channels).
    pub(crate) fn new(channel: Option<usize>) -> Self {
        Self(channel.map(|channel| CLIMATE_CHANNELS + channel))
    }

    /// Whether it is always one.
    pub(crate) fn is_constant(self) -> bool {
        self.0.is_none()
    }
}

/// A number times the fraction that its schedule gives in a forcing row.
#[inline(always)]
pub(crate) fn scheduled<S: Real>(whole: S, schedule: Schedule, row: &[f64]) -> S {
    match schedule.0 {
        Some(channel) => whole.scale(row[channel]),
        None => whole,
    }
}

/// Read-only view of the forcing array (steps x stages x channels).
#[derive(Debug, Clone, Copy)]
pub struct Forcing<'a> {
    values: &'a [f64],
    stages: usize,
    channels: usize,
}

impl<'a> Forcing<'a> {
    /// Wraps an array in row-major order.
    ///
    /// # Errors
    /// [`EngineError::Input`] when the length is not a multiple of `stages * channels`.
    pub fn new(values: &'a [f64], stages: usize, channels: usize) -> Result<Self, EngineError> {
        let row = stages * channels;
        if row == 0 || !values.len().is_multiple_of(row) {
            return Err(EngineError::Input(format!(
                "forcing has {} values, expected a multiple of {stages} stages x {channels} channels",
                values.len()
            )));
        }
        Ok(Self { values, stages, channels })
    }

    /// No steps.
    pub(crate) fn none() -> Self {
        Self { values: &[], stages: 1, channels: 1 }
    }

    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.values.len() / (self.stages * self.channels)
    }

    /// Number of stages in a step.
    #[must_use]
    pub fn stages(&self) -> usize {
        self.stages
    }

    /// Number of channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// All channels at a stage of a step.
    #[must_use]
    pub fn at(&self, step: usize, stage: usize) -> &'a [f64] {
        let start = (step * self.stages + stage) * self.channels;
        &self.values[start..start + self.channels]
    }
}

/// Gives the next block of steps of a forcing, in row-major order.
type Next<'a> = dyn FnMut() -> Result<Vec<f64>, EngineError> + 'a;

/// The forcing of a run in blocks of steps, of which one is needed at a time.
pub struct ForcingBlocks<'a> {
    first: Forcing<'a>,
    steps: usize,
    next: Box<Next<'a>>,
}

impl<'a> ForcingBlocks<'a> {
    /// All steps in one block.
    #[must_use]
    pub fn single(forcing: Forcing<'a>) -> Self {
        Self::new(forcing, forcing.steps(), || Ok(Vec::new()))
    }

    /// From the first block, the number of steps of all blocks, and what gives the others one after the other.
    #[must_use]
    pub fn new(
        first: Forcing<'a>,
        steps: usize,
        next: impl FnMut() -> Result<Vec<f64>, EngineError> + 'a,
    ) -> Self {
        Self { first, steps, next: Box::new(next) }
    }

    /// The first block.
    #[must_use]
    pub fn first(&self) -> Forcing<'a> {
        self.first
    }

    /// Number of steps of all blocks.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The block after some steps.
    ///
    /// # Errors
    /// [`EngineError::Input`]: it has no whole steps, or more than are left; and those of what gives it.
    pub(crate) fn after(&mut self, done: usize) -> Result<Vec<f64>, EngineError> {
        let (stages, channels) = (self.first.stages, self.first.channels);
        let values = (self.next)()?;
        let steps = Forcing::new(&values, stages, channels)?.steps();
        if steps == 0 || steps > self.steps - done {
            let remaining = self.steps - done;
            return Err(EngineError::Input(format!(
                "a block of the forcing has {steps} steps, expected 1 to {remaining}"
            )));
        }
        Ok(values)
    }
}
