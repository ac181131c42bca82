//! The laws of a building as straight lines: what the linear system of a stage is made of beside the walls.

use crate::building::ids::BySide;
use crate::building::model::Model;
use crate::linear::surface_balance::SurfaceLaws;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;
use crate::weather::conditions::Conditions;

/// Straight lines for all laws at surfaces and in zones.
#[derive(Debug, Clone)]
pub(crate) struct LinearisedLaws<S> {
    /// Convection and emission of each surface.
    pub(crate) surfaces: BySide<SurfaceLaws<S>>,
    /// Heat that infiltration brings into each zone, of `T_outdoor - T_air` [W].
    pub(crate) infiltration: Vec<Line<S>>,
    /// Heat that ventilation and openings bring into each zone, of `T_outdoor - T_air` [W].
    pub(crate) ventilation: Vec<Line<S>>,
    /// Heat through each door, of the difference of its zones [W].
    pub(crate) doors: Vec<Line<S>>,
}

impl<S: Real> LinearisedLaws<S> {
    /// The laws that never change; zero for the others.
    pub(crate) fn new(model: &Model<'_, S>) -> Self {
        let constant = |surface| {
            let mut laws = SurfaceLaws { convection: Line::zero(), emission: Line::zero() };
            if let Some(coefficient) = model.convection(surface).and_then(SurfaceConvection::constant) {
                laws.convection.slope = coefficient * model.coefficients.surfaces[surface].area_factor;
            }
            if let Some(emission @ Emission::Linearised(_)) = model.emission(surface) {
                let (offset, slope) = emission.at(S::zero());
                laws.emission = Line { offset, slope };
            }
            laws
        };
        let zones = model.plan.zones.len();
        Self {
            surfaces: model.plan.surfaces.ids().map(constant).collect(),
            infiltration: vec![Line::zero(); zones],
            ventilation: vec![Line::zero(); zones],
            doors: vec![Line::zero(); model.coefficients.doors.len()],
        }
    }
}

impl LinearisedLaws<f64> {
    /// Copies the values of other lines.
    #[inline(always)]
    pub(crate) fn copy_values<S: Real>(&mut self, other: &LinearisedLaws<S>) {
        for (mine, theirs) in self.surfaces.iter_mut().zip(&other.surfaces) {
            *mine = SurfaceLaws {
                convection: Line::of(&theirs.convection),
                emission: Line::of(&theirs.emission),
            };
        }
        let pairs = [
            (&mut self.infiltration, &other.infiltration),
            (&mut self.ventilation, &other.ventilation),
            (&mut self.doors, &other.doors),
        ];
        for (mine, theirs) in pairs {
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                *mine = Line::of(theirs);
            }
        }
    }
}

/// What the linear system of a stage is made of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StageInputs<'s, S: Real> {
    pub(crate) model: &'s Model<'s, S>,
    pub(crate) conditions: &'s Conditions<S>,
    pub(crate) laws: &'s LinearisedLaws<S>,
    /// Temperatures that the airs of zones start from [degC].
    pub(crate) air: &'s [S],
    /// Ideal load of each zone [W].
    pub(crate) load: &'s [S],
    /// Heat `offset - slope T` that holds the air of each zone at a set point [W]; empty where nothing is held.
    pub(crate) holding: &'s [Line<S>],
    /// Effective length of the stage [s].
    pub(crate) length: f64,
}
