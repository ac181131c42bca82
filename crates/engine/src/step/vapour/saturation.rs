//! Saturation pressures of a step: at the airs and the surfaces in all its stages, computed together.
//!
//! The exponential and the logarithm of one temperature are a long sequence of operations that wait for each other. That of eight
//! temperatures is as long, so those of all stages wait until the step is solved.

use crate::number::real::Real;
use crate::physics::psychrometrics::saturation_pressures;

/// Temperatures of a step, and the saturation pressures there.
#[derive(Debug, Clone)]
pub(super) struct Saturation<S> {
    /// Airs of zones and surfaces that take up vapour.
    places: usize,
    /// In each stage at each place [degC], and some more at the end.
    temperatures: Vec<S>,
    /// [Pa].
    pressures: Vec<S>,
}

impl<S: Real> Saturation<S> {
    /// Zeros.
    pub(super) fn new(places: usize, stages: usize) -> Self {
        let zeros = vec![S::zero(); (stages * places).next_multiple_of(S::CHUNK)];
        Self { places, temperatures: zeros.clone(), pressures: zeros }
    }

    /// Temperatures of a stage: of the airs, then of the surfaces [degC].
    #[inline(always)]
    pub(super) fn temperatures(&mut self, stage: usize) -> &mut [S] {
        &mut self.temperatures[stage * self.places..][..self.places]
    }

    /// Computes the pressures of all stages.
    #[inline(always)]
    pub(super) fn update(&mut self) {
        saturation_pressures(&self.temperatures, &mut self.pressures);
    }

    /// Saturation pressures of a stage: at the airs, then at the surfaces [Pa].
    #[inline(always)]
    pub(super) fn pressures(&self, stage: usize) -> &[S] {
        &self.pressures[stage * self.places..][..self.places]
    }
}
