//! Whether laws that are written as text are used where they say that they hold.
//!
//! The end of each step of a run of one member is compared with the `valid` of each law. A law goes on outside of it; the caller warns.

use crate::building::ids::SurfaceId;
use crate::building::model::Model;
use crate::building::plan::SurfaceRole;
use crate::number::real::Real;
use crate::physics::convection::SurfaceConvection;
use crate::step::state::State;
use crate::step::stepper::Stepper;

/// A law that was used where it does not hold.
#[derive(Debug, Clone, PartialEq)]
pub struct OutOfRange {
    /// Name of the surface.
    pub place: String,
    /// Steps at whose end it did not hold.
    pub steps: usize,
    /// The first of them.
    pub first: usize,
    /// Difference of surface and air in the one with the largest magnitude [K].
    pub difference: f64,
    /// Wind at the mast in that one [m/s].
    pub wind: f64,
}

/// The laws of a run that say where they hold.
#[derive(Debug, Clone)]
pub(crate) struct Validity {
    surfaces: Vec<SurfaceId>,
    /// In the order of the surfaces.
    found: Vec<Option<OutOfRange>>,
}

impl Validity {
    /// Nothing is watched in runs of several members, or with derivatives.
    pub(crate) fn new<S: Real>(model: &Model<'_, S>) -> Self {
        let single = S::LANES == 1 && !S::DERIVATIVES;
        let limited =
            |surface: &SurfaceId| model.convection(*surface).is_some_and(SurfaceConvection::limited);
        let surfaces: Vec<_> =
            model.plan.surfaces.ids().filter(|surface| single && limited(surface)).collect();
        Self { found: vec![None; surfaces.len()], surfaces }
    }

    /// Looks at the state after a step.
    #[inline(always)]
    pub(crate) fn judge<S: Real>(&mut self, stepper: &Stepper<'_, S>, state: &State<S>, step: usize) {
        if !self.surfaces.is_empty() {
            self.look(stepper, state, step);
        }
    }

    // One copy only: it is seldom used.
    #[inline(never)]
    fn look<S: Real>(&mut self, stepper: &Stepper<'_, S>, state: &State<S>, step: usize) {
        let (model, conditions) = (&stepper.model, &stepper.weather.conditions);
        for (&surface, found) in self.surfaces.iter().zip(&mut self.found) {
            let air = match model.plan.surfaces[surface].role {
                SurfaceRole::Zone { zone, .. } => state.air[zone],
                SurfaceRole::Exterior => conditions.surfaces[surface].temperature,
            };
            let difference = state.surfaces[surface] - air;
            let Some(law) = model.convection(surface) else { continue };
            let holds = law.valid(difference, conditions.wind, air);
            if holds.lane(0) > 0.5 {
                continue;
            }
            let (difference, wind) = (difference.lane(0), conditions.wind.lane(0));
            let place = || model.plan.surface_name(surface);
            let found = found.get_or_insert_with(|| OutOfRange {
                place: place(),
                steps: 0,
                first: step,
                difference,
                wind,
            });
            found.steps += 1;
            if difference.abs() > found.difference.abs() {
                (found.difference, found.wind) = (difference, wind);
            }
        }
    }

    /// The laws that were used where they do not hold.
    pub(crate) fn found(&self) -> impl Iterator<Item = &OutOfRange> {
        self.found.iter().flatten()
    }
}
