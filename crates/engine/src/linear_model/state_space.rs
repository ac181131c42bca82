//! The linear model of a plan at a parameter vector.

use super::matrices::StateSpace;
use super::network::Network;
use super::requirements::require_linear;
use crate::balance::terms::{Contents, Stage};
use crate::building::coefficients::Coefficients;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::step::Scheme;
use crate::step::control::RunControl;
use crate::step::linearized_stepper::TangentStepper;

/// Writes a plan at a parameter vector as matrices.
///
/// # Errors
/// [`EngineError::Input`] naming the first law that is not linear and constant, [`EngineError::Interrupted`].
pub fn state_space(plan: &Plan, numbers: &[f64], control: &RunControl) -> Result<StateSpace, EngineError> {
    let coefficients = Coefficients::new(plan, numbers);
    require_linear(plan, numbers, &coefficients)?;
    // Laws are linear: their tangents at 0 degC and in calm air are the laws themselves.
    let mut linearized_stepper = TangentStepper::new(plan, numbers, Scheme::BackwardEuler);
    linearized_stepper.linearise_at_rest();
    let mut network = Network::new(plan, &coefficients);
    let nothing = vec![0.0; plan.n_cells.max(plan.zones.len())];
    let contents = Contents { cells: &nothing, enthalpy: &nothing, air: &nothing };
    let stage = Stage { length: f64::INFINITY, ratio: 0.0, start: contents, first: contents };
    linearized_stepper.balances().visit(&stage, &mut network);
    network.eliminate_surfaces(control)
}
