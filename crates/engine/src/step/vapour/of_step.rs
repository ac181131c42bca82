//! The vapour balances beside the heat balances of a step.

use crate::balance::energy_balance::EnergyBalance;
use crate::building::model::Model;
use crate::number::real::Real;
use crate::step::scheme::Tableau;
use crate::step::state::State;
use crate::step::stepper::Stepper;

use super::balances::VapourBalances;

impl<S: Real> Stepper<'_, S> {
    /// A step begins.
    #[inline(always)]
    pub(crate) fn begin_vapour(&mut self) {
        if let Some(vapour) = &mut self.vapour {
            vapour.begin();
        }
    }

    /// Notes the flows of the stage just solved.
    #[inline(always)]
    pub(crate) fn note_vapour(&mut self, stage: usize) {
        if let Some(vapour) = &mut self.vapour {
            vapour.note(&self.model, &self.weather.conditions, self.solver.solution.view(), stage);
        }
    }

    /// Notes the flows of all stages of a step with ideal loads, once these are found.
    #[inline(always)]
    pub(crate) fn note_vapour_of_loads(&mut self) {
        let last = self.scheme.weights().len() - 1;
        if self.vapour.is_none() {
            return;
        }
        if let Some(vapour) = self.vapour.as_mut().filter(|_| last > 0) {
            self.weather.swap_stages();
            vapour.note(&self.model, &self.weather.conditions, self.ideal_loads.first_stage(), 0);
            self.weather.swap_stages();
        }
        self.note_vapour(last);
    }

    /// Solves the vapour balances of a step of a length [s], or of a part of one, that has been accepted.
    #[inline(always)]
    pub(crate) fn advance_vapour(
        &mut self,
        state: &mut State<S>,
        length: f64,
        energy_balance: &mut EnergyBalance<S>,
    ) {
        if let Some(vapour) = &mut self.vapour {
            advance_vapour(vapour, &self.model, state, (self.scheme.tableau(), length), energy_balance);
        }
    }
}

/// Solves the vapour balances of a step of a length [s], or of a part of one, that has been accepted.
// One copy only: inlining multiplies compile time, and most buildings have none.
#[inline(never)]
pub(in crate::step) fn advance_vapour<S: Real>(
    vapour: &mut VapourBalances<'_, S>,
    model: &Model<'_, S>,
    state: &mut State<S>,
    (tableau, length): (&Tableau, f64),
    energy_balance: &mut EnergyBalance<S>,
) {
    if let Some(humidity) = &model.coefficients.humidity {
        S::vectorised(
            #[inline(always)]
            || vapour.advance(humidity, state, (tableau, length), &mut energy_balance.vapour),
        );
    }
}
