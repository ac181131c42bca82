//! What a stepper needs to go along a plain run with derivatives.

use crate::building::coefficients::Matter;
use crate::building::model::Model;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::wall::Chain;
use crate::number::real::Real;
use crate::step::scheme::Tableau;

/// What a stepper needs to follow a plain run.
#[derive(Debug, Clone)]
pub(crate) struct Following<'a, S: Real> {
    /// One for each stage, with its linearisation at the solution.
    pub(super) matrices: Vec<StageMatrix<'a>>,
    pub(super) equations: S::Equations,
    pub(super) carries: Carries,
    /// Of the cells of constant walls [J/(m2 K)].
    pub(super) capacity: Vec<S>,
    /// The solution of the stage in hand: cells, surfaces, airs [degC].
    pub(super) at: Vec<f64>,
    /// How air and walls answer to a watt of a plant.
    pub(super) answers: Vec<Vec<f64>>,
    pub(super) block: Vec<f64>,
}

/// Which numbers that stay have derivatives: of the others nothing need be gathered.
#[derive(Debug, Clone)]
pub(super) struct Carries {
    /// By wall: conductances, heat capacities.
    pub(super) links: Vec<bool>,
    pub(super) capacity: Vec<bool>,
    /// By zone: exchange between its surfaces.
    pub(super) exchange: Vec<bool>,
}

/// Whether one of some numbers has derivatives.
fn any<S: Real>(numbers: impl IntoIterator<Item = S>) -> bool {
    numbers.into_iter().any(S::carries)
}

impl<'a, S: Real> Following<'a, S> {
    pub(super) fn new(model: &Model<'a, S>, parameters: &[S], tableau: &Tableau, walls: &[Chain<S>]) -> Self {
        let plan = model.plan;
        let plain: Vec<f64> = parameters.iter().map(|number| number.lane(0)).collect();
        let matrix = StageMatrix::new(plan, &plain, tableau.diagonal);
        let mut capacity = vec![S::zero(); plan.n_cells];
        for (wall, numbers) in plan.walls.iter().zip(&model.coefficients.walls) {
            for (capacity, cell) in capacity[wall.first_cell..].iter_mut().zip(&numbers.cells) {
                if let Matter::Solid { capacity: heat, .. } = cell.matter {
                    *capacity = heat * cell.thickness;
                }
            }
        }
        let zones = &model.coefficients.zones;
        let unknowns = plan.n_cells + plan.surfaces.len() + plan.zones.len();
        Self {
            matrices: vec![matrix; tableau.weights.len()],
            equations: S::Equations::default(),
            carries: Carries {
                links: walls.iter().map(|chain| any(chain.links.iter().map(|link| link.left))).collect(),
                capacity: plan
                    .walls
                    .iter()
                    .map(|wall| any(capacity[wall.first_cell..wall.first_cell + wall.len()].iter().copied()))
                    .collect(),
                exchange: zones.iter().map(|zone| any(zone.exchange.iter().copied())).collect(),
            },
            capacity,
            at: vec![0.0; unknowns],
            answers: vec![vec![0.0; unknowns]; plan.ideal_loads.len()],
            block: Vec::new(),
        }
    }
}
