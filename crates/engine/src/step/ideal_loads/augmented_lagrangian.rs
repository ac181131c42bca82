//! Ideal loads of many zones: the last stage holds the airs at their set points, and the loads follow from what holds them.
//!
//! A load is the same in all stages of a step. The first stage is solved with a guess of it. In the last stage the air of a
//! zone whose load is to be found is held: a large conductance connects it to its set point, on top of the guess. The heat
//! through this conductance is what the guess lacks in the last stage. (This is the method of multipliers; Hestenes 1969,
//! J. Optim. Theory Appl. 4, doi:10.1007/BF00927673.)
//!
//! With a larger load in the first stage it would lack less: the air of the last stage starts from that of the first
//! one. For changes `x` of all loads and heat `r` that they lack in the last stage this is `(1 + C) x = r`. After the
//! first sweeps `C` is taken as diagonal. Its numbers are learned for each zone from one sweep to the next: what zones
//! do to each other within a stage is small as long as the airs are held, unless they exchange much air. Where loads
//! still lack heat after these sweeps, `C = s G` is taken, with the response `G` of the airs of the first stage, and
//! `s`, which is `(1 - g)/g` times the storage of the air over the length of the stage, for the diagonal coefficient
//! `g` of the scheme. (What walls store is left out: the next sweep shows it as lacking.) The eigenvalues of
//! `1 + C` lie between 1 and `1/g`, however many zones there are and however much air they exchange, so that a few iterations
//! solve it. They take place in the next sweep, in its first stage, whose factors give `G`. Airs that are not held are not in
//! `C`. Where much air connects them with those that are, each change is corrected by what the one before it did.
//!
//! Each takes one solution with these factors, for all zones together. The responses to each load
//! ([`super::responses`]) take two for each zone.

use crate::building::model::Model;
use crate::linear::building_system::BuildingSystem;
use crate::number::line::Line;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::step::ideal_loads::limits::{Limits, TOLERANCE};
use crate::step::ideal_loads::load_sensitivities::Change;

/// Conductance that holds an air, over the largest of those that act on it [-]. The rounding of the air times this is heat that is not
/// known.
const STIFFNESS: ByPrecision = ByPrecision { double: 1e3, single: 1e2 };
/// What acts on the air of a zone beside its storage, for each m2 of its surfaces [W/(m2 K)]: only its magnitude matters.
const SURFACE_CONDUCTANCE: f64 = 10.0;
/// Part of the heat that loads lack which the iteration may leave to the next sweep [-], and its largest number of
/// iterations.
const LEFT: f64 = 1e-3;
const MAX_ITERATIONS: usize = 8;
/// Least and largest share of the last change that is taken back [-]: a factor of convergence of 0.9, and of any negative one.
const LEAST_SHARE: f64 = -10.0;
const MOST_SHARE: f64 = 1.0;
/// Sweeps after which `C` is taken as diagonal.
const DIAGONAL_SWEEPS: usize = 2;
/// Changes of a load from which the diagonal is learned: those that move the air by more [K].
const TELLING: ByPrecision = ByPrecision { double: 1e-3, single: 1e-2 };
/// Allowance for what walls store in the largest number of the diagonal [-].
const WALLS: f64 = 1.05;

/// What a load does: its zone is held at the set point of heating or of cooling, or the load is fixed (zero, or its
/// capacity).
#[derive(Debug, Clone, Copy)]
struct Mode<S: Real> {
    heats: S::Mask,
    cools: S::Mask,
}

/// One zone and its load.
#[derive(Debug, Clone, Copy)]
struct ZoneLoad<S: Real> {
    mode: Mode<S>,
    /// Set points of heating and cooling [degC].
    set_points: [S; 2],
    /// Conductances that act on the air, by their magnitude, without air from other zones and outdoors [W/K].
    conductance: S,
    /// Conductance that holds the air [W/K].
    holding: S,
    /// `s` of the air [W/K].
    carried: S,
    /// `1 + c` with the diagonal `c` of `C` [-], 0 where it is not known yet, and the most that it can be.
    slope: S,
    most_slope: f64,
    /// Heat that the load lacks in the last stage [W].
    missing: S,
    /// How the load was changed after the last sweep [W].
    change: S,
    /// `1 + c` of the air alone, airs that are eliminated later held [-], and the heat that is left of what the load lacks [W].
    air_slope: S,
    left: S,
    /// Change of the load by the last iteration [W].
    supplied: S,
    /// The same before it, with what the load lacked then, and the change that was made [W].
    before: Supply<S>,
}

/// How a load was changed, and what it lacked before.
#[derive(Debug, Clone, Copy)]
struct Supply<S> {
    missing: S,
    supplied: S,
    change: S,
}

/// Airs that the last stage of a step holds at their set points.
#[derive(Debug, Clone)]
pub(crate) struct ZoneLoadSolver<S: Real> {
    airs: Vec<ZoneLoad<S>>,
    /// Loads are found when what they lack moves no air by more than this [K].
    close: f64,
    /// Heat that air carries into each zone, per degree [W/K].
    flows: Vec<S>,
    /// Rises of all unknowns of the coupled system.
    rise: Vec<S>,
    /// Lanes in which loads were changed after the last sweep but one, and no load has begun or ended since then.
    comparable: S::Mask,
}

impl<S: Real> ZoneLoadSolver<S> {
    /// For a number of loads in a building with a number of rows; loads that are missing move an air by less than `close` [K].
    pub(super) fn new(loads: usize, rows: usize, close: f64) -> Self {
        let zero = S::zero();
        let nothing = ZoneLoad {
            mode: Mode { heats: S::Mask::splat(false), cools: S::Mask::splat(false) },
            set_points: [zero; 2],
            conductance: S::one(),
            holding: S::one(),
            carried: zero,
            slope: zero,
            most_slope: 1.0,
            missing: zero,
            change: zero,
            air_slope: S::one(),
            left: zero,
            supplied: zero,
            before: Supply { missing: zero, supplied: zero, change: zero },
        };
        Self {
            airs: vec![nothing; loads],
            close,
            flows: Vec::new(),
            rise: vec![zero; rows],
            comparable: S::Mask::splat(false),
        }
    }

    /// The diagonal, from which the next step goes on.
    pub(super) fn slopes(&self) -> Vec<S> {
        self.airs.iter().map(|air| air.slope).collect()
    }

    /// Sets the diagonal.
    pub(super) fn set_slopes(&mut self, slopes: &[S]) {
        for (air, &slope) in self.airs.iter_mut().zip(slopes) {
            air.slope = slope;
        }
    }

    /// Begins a step that ends with a forcing row and whose stages have a length [s], with `(1 - g)/g` of its scheme: which
    /// airs are held follows from the guessed loads and from the airs expected without them.
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        model: &Model<'_, S>,
        row: &[f64],
        (length, ratio): (f64, f64),
        (limits, zones): (&[Limits<S>], &[usize]),
        (loads, expected): (&[S], impl Fn(usize) -> S),
    ) {
        self.find_flows(model, row);
        self.comparable = S::Mask::splat(false);
        for ((air, limits), &zone) in self.airs.iter_mut().zip(limits).zip(zones) {
            let numbers = &model.coefficients.zones[zone];
            let area = numbers.areas.iter().fold(S::zero(), |sum, &area| sum + area);
            let storage = numbers.capacity.scale(1.0 / length);
            air.conductance = storage + area.scale(SURFACE_CONDUCTANCE);
            air.holding = air.conductance.max(self.flows[zone]).scale(STIFFNESS.of::<S>());
            air.carried = storage.scale(ratio);
            air.most_slope = 1.0 + WALLS * ratio;
            let first = S::one() + air.carried / air.conductance;
            let known = air.slope.min(S::constant(air.most_slope));
            air.slope = S::select(S::zero().lt(air.slope), known, first);
            (air.missing, air.change) = (S::zero(), S::zero());
            air.set_points = limits.set_points;
            air.begin(limits, loads[zone], expected(zone));
        }
    }

    /// Finds the heat that air from other zones and ventilation carry into each zone in a forcing row. An air that is not
    /// held much more strongly than this would follow the other airs, and the loads would be found slowly.
    #[inline(always)]
    fn find_flows(&mut self, model: &Model<'_, S>, row: &[f64]) {
        let coefficients = &model.coefficients;
        self.flows.clear();
        self.flows.extend(
            coefficients
                .zones
                .iter()
                .map(|zone| zone.ventilation.iter().fold(S::zero(), |sum, flow| sum + flow.about(row))),
        );
        for path in &coefficients.paths {
            let conductance = path.about(row);
            for zone in path.between {
                self.flows[zone] += conductance;
            }
        }
    }

    /// What holds the airs in the last stage: heat `offset - slope T` into the air of each zone [W].
    #[inline(always)]
    pub(super) fn write(&self, zones: &[usize], holding: &mut [Line<S>]) {
        for (air, &zone) in self.airs.iter().zip(zones) {
            let slope = S::select(air.mode.holds(), air.holding, S::zero());
            holding[zone] = Line { offset: slope * air.set_point(), slope };
        }
    }

    /// Whether the air of some zone is held in an active lane.
    #[inline(always)]
    pub(super) fn any(&self, active: S::Mask) -> bool {
        self.airs.iter().any(|air| (air.mode.holds() & active).any())
    }

    /// How far the air of a load that is not found is from the one with the load found [K].
    #[inline(always)]
    pub(super) fn distance(&self, load: usize) -> S {
        let air = &self.airs[load];
        air.missing / (air.slope * air.conductance)
    }

    /// Change of the air of the first stage with the change of a load after the last sweep [K].
    #[inline(always)]
    pub(super) fn first_rise(&self, load: usize) -> S {
        let air = &self.airs[load];
        S::select(S::zero().lt(air.carried), air.change * (air.slope - S::one()) / air.carried, S::zero())
    }

    /// How the loads were changed after the last sweep.
    #[inline(always)]
    pub(super) fn write_changes(&self, active: S::Mask, changes: &mut [Change<S>]) {
        for (air, change) in self.airs.iter().zip(changes) {
            let is_informative = air.conductance.scale(TELLING.of::<S>()).lt(air.change.abs()) & active;
            *change = Change { load: air.change, is_informative, conductance: air.conductance };
        }
    }

    /// Compares the airs at the end of a sweep with the set points. True in the lanes whose loads are right. In other
    /// active lanes (with `all`, in every active one) loads end, begin, or reach their capacity, and after the first
    /// sweeps they get the heat that they lack; later [`Self::supply`] gives it.
    #[inline(always)]
    pub(super) fn correct(
        &mut self,
        (limits, zones): (&[Limits<S>], &[usize]),
        (air, loads): (&[S], &mut [S]),
        (number, active, all): (usize, S::Mask, bool),
    ) -> S::Mask {
        let mut found = S::Mask::splat(true);
        for ((held, limits), &zone) in self.airs.iter_mut().zip(limits).zip(zones) {
            held.learn(held.missing_at(air[zone]), active);
            let (mode, _) = held.next(limits, loads[zone], air[zone]);
            let small = (held.missing / held.slope).abs().lt(held.conductance.scale(self.close));
            found = found & small & held.mode.is(mode);
            self.comparable = self.comparable & held.mode.is(mode);
        }
        let moving = active & (!found | S::Mask::splat(all));
        for ((held, limits), &zone) in self.airs.iter_mut().zip(limits).zip(zones) {
            let (mode, load) = held.next(limits, loads[zone], air[zone]);
            let goes_on = moving & held.mode.is(mode);
            let load_residual = S::select(goes_on, held.missing, S::zero());
            loads[zone] = S::select(moving, load, loads[zone]);
            held.change = S::zero();
            held.missing = load_residual;
            if number < DIAGONAL_SWEEPS {
                held.change = load_residual / held.slope;
                loads[zone] += held.change;
            }
            held.mode = Mode {
                heats: (moving & mode.heats) | (!moving & held.mode.heats),
                cools: (moving & mode.cools) | (!moving & held.mode.cools),
            };
        }
        found
    }

    /// Gives loads the heat that they lacked after sweep `number`, with the factors of the first stage in the sweep
    /// after it. True where loads change: the stage is then solved again, so that a lane that is found repeats the bits
    /// of its solution.
    #[inline(always)]
    pub(super) fn supply(
        &mut self,
        model: &Model<'_, S>,
        system: &BuildingSystem<'_, S>,
        (number, zones): (usize, &[usize]),
        loads: &mut [S],
    ) -> bool {
        if number < DIAGONAL_SWEEPS {
            return false;
        }
        let row = |zone: usize| model.plan.zones[zone].air_row;
        for (air, &zone) in self.airs.iter_mut().zip(zones) {
            air.air_slope = S::one() + air.carried * system.coupled.inverse_pivot(row(zone));
            (air.left, air.supplied) = (air.missing, S::zero());
        }
        let begin = self.largest_left();
        let enough = begin.scale(LEFT).max(S::constant(0.1 * self.close));
        let lacking = enough.lt(begin);
        let mut open = lacking;
        for _ in 0..MAX_ITERATIONS {
            if !open.any() {
                break;
            }
            self.rise.fill(S::zero());
            for (air, &zone) in self.airs.iter().zip(zones) {
                self.rise[row(zone)] = air.left / air.air_slope;
            }
            system.solve_airs_alone(&mut self.rise);
            // The step along this direction that leaves the least heat.
            let (mut along, mut square) = (S::zero(), S::constant(f64::MIN_POSITIVE));
            for (air, &zone) in self.airs.iter().zip(zones) {
                let supplied = air.gain(self.rise[row(zone)]);
                along += supplied * air.left;
                square += supplied * supplied;
            }
            let factor = S::select(open, along / square, S::zero());
            for (air, &zone) in self.airs.iter_mut().zip(zones) {
                air.supplied += factor * (air.left / air.air_slope);
                air.left = air.left - factor * air.gain(self.rise[row(zone)]);
            }
            open = open & enough.lt(self.largest_left());
        }
        self.change_loads(lacking, zones, loads);
        lacking.any()
    }

    /// Changes loads in some lanes by what the iteration found, and by what the change before it shows: airs that are not held
    /// store heat, too, and give it to those that are. (Anderson's acceleration with one step of history: Walker & Ni 2011, SIAM J.
    /// Numer. Anal. 49(4), doi:10.1137/10078356X.)
    #[inline(always)]
    fn change_loads(&mut self, lacking: S::Mask, zones: &[usize], loads: &mut [S]) {
        let (mut along, mut square) = (S::zero(), S::constant(f64::MIN_POSITIVE));
        for air in &self.airs {
            let fell = (air.missing - air.before.missing) / air.conductance;
            along += fell * (air.missing / air.conductance);
            square += fell * fell;
        }
        let share = (along / square).max(S::constant(LEAST_SHARE)).min(S::constant(MOST_SHARE));
        let share = S::select(lacking & self.comparable, share, S::zero());
        for (air, &zone) in self.airs.iter_mut().zip(zones) {
            let moved = air.before.change + air.supplied - air.before.supplied;
            let change = S::select(lacking, air.supplied - share * moved, S::zero());
            loads[zone] += change;
            air.before = Supply { missing: air.missing, supplied: air.supplied, change };
        }
        self.comparable = lacking;
    }

    /// Heat that is left, over the conductances of its air: the largest [K].
    #[inline(always)]
    fn largest_left(&self) -> S {
        self.airs.iter().fold(S::zero(), |most, air| most.max((air.left / air.conductance).abs()))
    }

    /// Supplies the heat that the loads lack in the last stage to its solution, and notes it.
    #[inline(always)]
    pub(super) fn complete(
        &mut self,
        model: &Model<'_, S>,
        system: &mut BuildingSystem<'_, S>,
        (zones, air): (&[usize], &[S]),
        supplied: &mut [S],
    ) {
        self.rise.fill(S::zero());
        for ((held, supplied), &zone) in self.airs.iter().zip(supplied).zip(zones) {
            *supplied = held.missing_at(air[zone]);
            self.rise[model.plan.zones[zone].air_row] = *supplied;
        }
        system.solve_for_airs(&mut self.rise);
        for (value, &rise) in system.coupled.right.iter_mut().zip(&self.rise) {
            *value += rise;
        }
    }

    /// Heat that a load lacks in the last stage, where the air of its zone has a temperature [W].
    #[inline(always)]
    pub(super) fn missing(&self, load: usize, air: S) -> S {
        self.airs[load].missing_at(air)
    }
}

impl<S: Real> Mode<S> {
    /// Lanes in which the air is held.
    #[inline(always)]
    fn holds(self) -> S::Mask {
        self.heats | self.cools
    }

    /// Lanes in which another mode is the same.
    #[inline(always)]
    fn is(self, other: Self) -> S::Mask {
        let differs = |a: S::Mask, b: S::Mask| (a & !b) | (b & !a);
        !(differs(self.heats, other.heats) | differs(self.cools, other.cools))
    }
}

impl<S: Real> ZoneLoad<S> {
    #[inline(always)]
    fn set_point(&self) -> S {
        S::select(self.mode.heats, self.set_points[0], self.set_points[1])
    }

    /// Heat that the load lacks in the last stage, whose air is known [W].
    #[inline(always)]
    fn missing_at(&self, air: S) -> S {
        let heat = self.holding * (self.set_point() - air);
        S::select(self.mode.holds(), heat, S::zero())
    }

    /// Heat that the last stage lacks less when the load rises by what is left over the slope, and with it the air of
    /// the first stage [W].
    #[inline(always)]
    fn gain(&self, rise: S) -> S {
        let heat = self.left / self.air_slope + self.carried * rise;
        S::select(self.mode.holds(), heat, S::zero())
    }

    /// Notes the heat that the load lacks at the end of a sweep, and learns the diagonal from what it lacked before its
    /// change, in active lanes.
    #[inline(always)]
    fn learn(&mut self, missing: S, active: S::Mask) {
        let is_informative =
            self.conductance.scale(TELLING.of::<S>()).lt(self.change.abs()) & self.mode.holds() & active;
        let change = S::select(is_informative, self.change, S::one());
        let slope = ((self.missing - missing) / change).max(S::one()).min(S::constant(self.most_slope));
        self.slope = S::select(is_informative, slope, self.slope);
        self.missing = missing;
    }

    /// The mode that a step begins with, by the guessed load and the air expected without one.
    #[inline(always)]
    fn begin(&mut self, limits: &Limits<S>, load: S, expected: S) {
        let idle = !S::zero().lt(load.abs());
        let [cold, hot] = limits.asks(expected);
        let heats = (S::zero().lt(load) & load.lt(limits.most[0])) | (idle & cold);
        let cools = (load.lt(S::zero()) & (-limits.most[1]).lt(load)) | (idle & hot);
        self.mode = Mode { heats, cools: cools & !heats };
    }

    /// The next mode and load: an active set method, as in [`super::search`].
    #[inline(always)]
    fn next(&self, limits: &Limits<S>, load: S, air: S) -> (Mode<S>, S) {
        let Mode { heats, cools } = self.mode;
        let (held, most_heating, most_cooling) = (self.mode.holds(), limits.most[0], -limits.most[1]);
        // The load of an air that is held goes on, ends, or reaches its capacity. What it lacks changes it at least so far.
        let expected = load + self.missing.scale(1.0 / self.most_slope);
        let goes_on = (heats & S::zero().lt(expected) & expected.lt(most_heating))
            | (cools & expected.lt(S::zero()) & most_cooling.lt(expected));
        let full_heating = heats & !expected.lt(most_heating);
        let full_cooling = cools & !most_cooling.lt(expected);
        // An air that is not held is held from where it passes a set point: without load, or with more than it needs.
        let [cold, hot] = limits.asks(air);
        let idle = !S::zero().lt(load.abs());
        let slack = S::constant(TOLERANCE.of::<S>());
        let enough = S::zero().lt(load) & (limits.set_points[0] + slack).lt(air);
        let enough_cooling = load.lt(S::zero()) & air.lt(limits.set_points[1] - slack);
        let begins: Mode<S> = Mode {
            heats: !held & ((idle & cold) | enough),
            cools: !held & ((idle & hot & !cold) | enough_cooling),
        };
        let mode = Mode { heats: (heats & goes_on) | begins.heats, cools: (cools & goes_on) | begins.cools };
        let next = S::select(held & !goes_on, S::zero(), load);
        let next = S::select(full_heating, most_heating, S::select(full_cooling, most_cooling, next));
        (mode, next)
    }
}
