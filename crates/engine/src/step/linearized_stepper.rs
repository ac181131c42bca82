//! Steps along solutions that are known from a run of plain numbers: what derivatives need of a stepper.
//!
//! Nothing is searched for. The laws are linearised at the solution; its slopes follow from those of the equations
//! (`derivatives`). Numbers with derivatives therefore have no linear system of their own, and no iteration.

use crate::balance::energy_balance::EnergyBalance;
use crate::balance::flow_index::FlowIndex;
use crate::balance::terms::{Balances, Contents, Stage as StageContents};
use crate::building::coefficients::Coefficients;
use crate::building::ids::SideId;
use crate::building::model::Model;
use crate::building::plan::Plan;
use crate::input::forcing::Forcing;
use crate::linear::stage_matrix::StageMatrix;
use crate::linear::unknowns::{Unknowns, copy_ranges};
use crate::linear::vent_network::VentNetwork;
use crate::linear::wall::WallSystem;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::step::accept::{Reached, accept_nonlinear};
use crate::step::halving::Part;
use crate::step::ideal_loads::known::StoredLoads;
use crate::step::linearisation::Linearisation;
use crate::step::readings::Readings;
use crate::step::scheme::{Scheme, Tableau};
use crate::step::stage::{Stage, StageStart};
use crate::step::stage_histories::StageHistories;
use crate::step::stage_solutions::KnownPart;
use crate::step::stage_weather::StageWeather;
use crate::step::state::{Initial, State};
use crate::step::stepper::INSTANT;
use crate::step::vapour::balances::VapourBalances;
use crate::step::vapour::of_step::advance_vapour;
use crate::step::vents::{control_vents, drive_vents};
use crate::weather::conditions::{Instant, Weather};

/// Position of a stage in its step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StagePlace {
    pub(crate) stage: usize,
    /// Effective length [s].
    pub(crate) length: f64,
    /// A stage starts from `T_n + ratio (T_1 - T_n)`: the start of the step and the solution of its first stage.
    pub(crate) ratio: f64,
}

impl StagePlace {
    /// The stage that brings surfaces into balance: too short for anything to be stored.
    pub(crate) fn instant() -> Self {
        Self { stage: 0, length: INSTANT.double, ratio: 0.0 }
    }
}

/// Takes steps along known solutions.
#[derive(Debug, Clone)]
pub(crate) struct TangentStepper<'a, S: Real> {
    pub(crate) model: Model<'a, S>,
    scheme: Scheme,
    weather: StageWeather<S>,
    flows: FlowIndex<S>,
    linearisation: Linearisation<S>,
    walls: Vec<WallSystem<S>>,
    start: StageStart<S>,
    /// About which the laws are linearised: the solution, as constants.
    iterate: Unknowns<S>,
    /// The solution, with its derivatives.
    solution: Unknowns<S>,
    loads: StoredLoads<S>,
    /// Ideal load of each zone, summed over the parts of the step so far, each by its share [W].
    mean_load: Vec<S>,
    vapour: Option<Box<VapourBalances<'a, S>>>,
    vents: Option<Box<VentNetwork<'a, S>>>,
    histories: StageHistories<S>,
}

impl<'a, S: Real> TangentStepper<'a, S> {
    /// Prepares a plan with a parameter vector.
    pub(crate) fn new(plan: &'a Plan, parameters: &'a [S], scheme: Scheme) -> Self {
        let (model, tableau) = (Model::new(plan, Coefficients::new(plan, parameters)), scheme.tableau());
        let stages = tableau.weights.len();
        let weather = StageWeather::new(&model);
        let unknowns = Unknowns::zero(plan.n_cells, plan.surfaces.len(), plan.zones.len());
        Self {
            scheme,
            flows: FlowIndex::new(plan, &model.coefficients, &weather.index),
            weather,
            linearisation: Linearisation::new(&model, stages),
            walls: model.coefficients.walls.iter().map(WallSystem::new).collect(),
            start: StageStart::new(&model),
            iterate: unknowns.clone(),
            solution: unknowns,
            loads: StoredLoads::new(&model),
            mean_load: vec![S::zero(); plan.zones.len()],
            vapour: VapourBalances::new(&model, stages).map(Box::new),
            vents: plan.vents.as_ref().map(|network| Box::new(VentNetwork::new(network))),
            histories: StageHistories::new(&model),
            model,
        }
    }

    /// The state that a run starts from, in the weather of a forcing row.
    pub(crate) fn begin(&self, initial: &Initial, row: &[f64]) -> State<S> {
        State::new(&self.model, initial, row)
    }

    /// A place for unknowns in plain numbers.
    pub(crate) fn place(&self) -> Unknowns<f64> {
        self.iterate.plain()
    }

    /// Averages what outputs need beside the results of every run.
    pub(crate) fn average_absorbed_sun(&mut self) {
        self.weather.average_absorbed(&self.model);
    }

    /// What outputs read beside the state.
    pub(crate) fn readings(&self) -> Readings<'_, S> {
        Readings {
            model: &self.model,
            weather: &self.weather,
            walls: &self.walls,
            surfaces: &self.solution.surfaces,
            vapour: self.vapour.as_deref(),
        }
    }

    /// The balances of a stage, its laws as they are linearised.
    #[inline(always)]
    pub(crate) fn balances(&self) -> Balances<'_, S> {
        Balances {
            model: &self.model,
            index: &self.flows,
            conditions: &self.weather.conditions,
            walls: &self.walls,
            laws: &self.linearisation.laws,
            load: &self.start.load,
        }
    }

    /// Linearises all laws at 0 degC everywhere, in calm air, with schedules of zero.
    pub(crate) fn linearise_at_rest(&mut self) {
        let row = vec![0.0; self.model.plan.n_channels()];
        if let Ok(forcing) = Forcing::new(&row, 1, row.len()) {
            let weather = Weather::for_single_run(self.model.plan, &forcing, 0);
            let airs = self.iterate.air.clone();
            self.conditions_now(&weather.at(0, 0), &airs);
        }
        let Self { model, weather, linearisation, iterate, .. } = self;
        linearisation.linearise_surfaces(model, &weather.conditions, iterate, true);
    }

    /// The stages of a step of a length [s].
    pub(crate) fn stage_places(&self, dt: f64) -> impl Iterator<Item = StagePlace> + use<S> {
        let Tableau { diagonal, ratio, weights, .. } = *self.scheme.tableau();
        (0..weights.len()).map(move |stage| StagePlace {
            stage,
            length: diagonal * dt,
            ratio: if stage > 0 { ratio } else { 0.0 },
        })
    }

    /// Begins a step of a length [s] in a forcing row.
    #[inline(always)]
    pub(crate) fn begin_step(&mut self, state: &mut State<S>, row: &[f64], length: f64) {
        control_vents(&self.model, state, row, length);
        self.mean_load.fill(S::zero());
        if let Some(vapour) = &mut self.vapour {
            vapour.begin();
        }
    }

    /// Begins a part of a step at a state.
    #[inline(always)]
    pub(crate) fn begin_part(&mut self, state: &State<S>) {
        self.start.load.copy_from_slice(&state.load);
        self.linearisation.extrapolate_gaps(0, &state.cells);
    }

    /// Begins the first stage of a part of a length [s].
    #[inline(always)]
    pub(crate) fn begin_first_stage(&mut self, state: &State<S>, length: f64) {
        self.histories.begin(&self.model, state, self.scheme.tableau(), length);
    }

    /// The weather of a stage.
    #[inline(always)]
    pub(crate) fn conditions_of_stage(
        &mut self,
        state: &State<S>,
        weather: &Weather<'_>,
        part: Part,
        stage: usize,
    ) {
        let tableau = self.scheme.tableau();
        self.weather.set_stage(&self.model, weather, tableau, (part, stage), &state.air);
        self.drive_vents(state);
    }

    /// The weather of an instant.
    #[inline(always)]
    fn conditions_now(&mut self, now: &Instant<'_>, airs: &[S]) {
        self.weather.set_instant(&self.model, now, airs);
    }

    /// Begins to bring the surfaces of a state into balance with the weather of an instant.
    #[inline(always)]
    pub(crate) fn begin_balance(&mut self, state: &mut State<S>, now: &Instant<'_>) {
        self.begin_part(state);
        self.begin_first_stage(state, 0.0);
        self.conditions_now(now, &state.air);
        control_vents(&self.model, state, now.row, 0.0);
        self.drive_vents(state);
    }

    #[inline(always)]
    fn drive_vents(&mut self, state: &State<S>) {
        drive_vents(&self.model, &mut self.weather, self.vents.as_deref_mut(), state);
    }

    /// Heat stored when a stage begins; after [`Self::store_first_stage`] in the second one.
    #[inline(always)]
    pub(crate) fn stage_of<'s>(&'s self, state: &'s State<S>, place: StagePlace) -> StageContents<'s, S> {
        let Self { start, solution, .. } = self;
        StageContents {
            length: place.length,
            ratio: place.ratio,
            start: Contents { cells: &state.cells, enthalpy: &state.enthalpy, air: &state.air },
            first: Contents { cells: &solution.cells, enthalpy: &start.enthalpy, air: &solution.air },
        }
    }

    /// Linearises everything at the solution of a stage.
    #[inline(always)]
    pub(crate) fn linearise_known_stage(
        &mut self,
        state: &State<S>,
        place: StagePlace,
        known: &Unknowns<f64>,
    ) {
        let Self { model, scheme, weather, linearisation, walls, iterate, histories, .. } = self;
        let conditions = &weather.conditions;
        let stage = Stage {
            model,
            conditions,
            state,
            histories: histories.within(state),
            tableau: scheme.tableau(),
            length: place.length,
            place: (0, place.stage + 1),
        };
        iterate.set(&model.parts.nonlinear_cells, known);
        for &w in &model.parts.nonlinear_walls {
            linearisation.linearise_wall(&stage, w, (iterate, None), &mut walls[w]);
        }
        linearisation.set_wind(model, conditions, true);
        linearisation.linearise_surfaces(model, conditions, iterate, true);
    }

    /// The solution of a stage as one list: cells, surfaces, airs [degC]; of cells those of nonlinear walls.
    #[inline(always)]
    pub(crate) fn write_known_solution(&self, known: &Unknowns<f64>, solution: &mut [f64]) {
        let (cells, rest) = solution.split_at_mut(self.model.plan.n_cells);
        let (surfaces, air) = rest.split_at_mut(self.model.plan.surfaces.len());
        surfaces.copy_from_slice(&known.surfaces);
        air.copy_from_slice(&known.air);
        copy_ranges(&self.model.parts.nonlinear_cells, cells, &known.cells);
    }

    /// The temperatures of the cells of some walls of constant properties, which follow from those of their surfaces [degC], and how
    /// fast they have cooled in the stage [K/s]. `matrix` has the factors of the walls.
    #[inline(always)]
    pub(crate) fn write_known_cells(
        &self,
        walls: &[usize],
        (state, place, known): (&State<S>, StagePlace, &Unknowns<f64>),
        matrix: &StageMatrix<'_>,
        [cells, cooling]: [&mut [f64]; 2],
    ) {
        let rate = 1.0 / place.length;
        for &w in walls {
            let (range, chain) = (self.model.cells(w), &matrix.system.walls[w]);
            let (own, cooling) = (&mut cells[range.clone()], &mut cooling[range.clone()]);
            let contents = state.cells[range.clone()].iter().zip(&self.solution.cells[range]);
            let laws = chain.rate.iter().zip(&chain.storage);
            for (((cell, held), (start, first)), (rate, storage)) in
                own.iter_mut().zip(cooling.iter_mut()).zip(contents).zip(laws)
            {
                *held = start.lane(0) + (first.lane(0) - start.lane(0)) * place.ratio;
                *cell = rate * storage.capacity * *held;
            }
            for &(source, cell) in &self.model.plan.walls[w].planes {
                own[cell] += self.weather.conditions.heat_sources[source].heat.lane(0);
            }
            chain.forward(own);
            chain.back(known.surfaces.pair(w), own);
            for (held, &reached) in cooling.iter_mut().zip(&*own) {
                *held = (*held - reached) * rate;
            }
        }
    }

    /// Black emission of some surfaces at a solution [W/m2].
    #[inline(always)]
    pub(crate) fn write_emission(&self, surfaces: &[SideId], known: &Unknowns<f64>, emission: &mut [f64]) {
        let laws = &self.linearisation.laws.surfaces;
        for &surface in surfaces {
            emission[surface.index()] = Line::of(&laws[surface].emission).at(known.surfaces[surface]);
        }
    }

    /// Stores the solution of a stage: `solve` writes it with its derivatives.
    #[inline(always)]
    pub(crate) fn store_solution(&mut self, solve: impl FnOnce([&mut [S]; 3])) {
        let Self { walls, solution: Unknowns { cells, surfaces, air }, .. } = self;
        solve([cells, surfaces, air]);
        for &w in &self.model.parts.nonlinear_walls {
            walls[w].set_solution(&cells[self.model.cells(w)]);
        }
    }

    /// Enthalpies and liquid fractions at the end of the first stage, for the second.
    #[inline(always)]
    pub(crate) fn store_first_stage(&mut self, state: &State<S>) {
        let Self { model, scheme, linearisation, walls, start, iterate, solution, histories, .. } = self;
        histories.begin_second(model, state, scheme.tableau(), &solution.cells);
        for &w in &model.parts.nonlinear_walls {
            let (wall, chain) = (&model.plan.walls[w], &walls[w]);
            for (i, storage) in chain.storage.iter().enumerate() {
                start.enthalpy[wall.first_cell + i] = storage.at_solution();
                start.first_fraction[wall.first_cell + i] = chain.liquid_fraction(i);
            }
        }
        if !model.plan.windows.is_empty() {
            let known = [state.view(), solution.view()];
            iterate.extrapolate(model, &known, 1.0 / scheme.tableau().diagonal, &state.memory);
            linearisation.extrapolate_gaps(1, &iterate.cells);
        }
    }

    /// The last stage becomes the new state at the end of a part of a length [s].
    #[inline(always)]
    pub(crate) fn end_part(&mut self, state: &mut State<S>, part: Part, length: f64) {
        let Self { model, scheme, walls, start, solution, mean_load, vapour, histories, .. } = self;
        let reached = Reached {
            walls,
            cells: &solution.cells,
            first_fraction: &start.first_fraction,
            histories,
            length,
        };
        accept_nonlinear(
            model,
            *scheme,
            &reached,
            state,
            #[inline(always)]
            |_, _| {},
        );
        state.cells.copy_from_slice(&solution.cells);
        state.surfaces.copy_from_slice(&solution.surfaces);
        state.air.copy_from_slice(&solution.air);
        state.load.copy_from_slice(&start.load);
        if let Some(vapour) = vapour {
            advance_vapour(vapour, model, state, (scheme.tableau(), length), &mut EnergyBalance::new());
        }
        if part.halvings > 0 {
            for (sum, &load) in mean_load.iter_mut().zip(&state.load) {
                *sum += load.scale(part.share);
            }
            if part.is_last() {
                state.load.copy_from_slice(mean_load);
            }
        }
    }

    /// The surfaces balanced at an instant become those of a state.
    #[inline(always)]
    pub(crate) fn end_balance(&mut self, state: &mut State<S>) {
        state.surfaces.copy_from_slice(&self.solution.surfaces);
        if let Some(humidity) = &self.weather.conditions.humidity {
            state.condense(humidity.pressure);
        }
        self.weather.average_instant(&self.model);
        if let Some(vapour) = &mut self.vapour {
            vapour.begin();
        }
    }

    /// Notes the flows of vapour of the stage just solved.
    #[inline(always)]
    pub(crate) fn note_vapour(&mut self, stage: usize) {
        if let Some(vapour) = &mut self.vapour {
            vapour.note(&self.model, &self.weather.conditions, self.solution.view(), stage);
        }
    }

    /// Sets the ideal loads to those of the solution of a part. False where none of them responds to the air.
    #[inline(always)]
    pub(crate) fn set_ideal_loads(&mut self, weather: &Weather<'_>, known: &KnownPart<'_>) -> bool {
        let last = self.scheme.weights().len() - 1;
        for (load, &known) in self.start.load.iter_mut().zip(known.load) {
            *load = S::constant(known);
        }
        let row = weather.row(known.part.step, last);
        self.loads.begin(&self.model, row, (known.load, &known.stages[last]))
    }

    /// The ideal load of a zone [W].
    #[inline(always)]
    pub(crate) fn ideal_load(&self, zone: usize) -> S {
        self.start.load[zone]
    }

    /// Sets the response of surfaces and airs at the end of the step to an ideal load [K/W], of which `radiated` is radiated [-].
    #[inline(always)]
    pub(crate) fn set_response(&mut self, ideal_load: usize, response: ([&[f64]; 2], f64)) {
        self.loads.set_response(&self.model, ideal_load, response);
    }

    /// Corrects the ideal loads, and with them their slopes.
    #[inline(always)]
    pub(crate) fn correct_ideal_loads(&mut self) {
        self.loads.correct(&self.model, &self.solution.view(), &mut self.start.load);
    }
}
