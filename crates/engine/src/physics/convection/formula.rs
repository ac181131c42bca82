//! A coefficient that is written as text, see [`formula_text`](super::formula_text).
//!
//! A flow of heat must rise with the difference, or Newton's method finds no way back from an iterate that is far off. Beyond the
//! differences within which the law does so (at most 200 K) the flow goes on along its tangent. This is part of the law of a
//! surface, so that a run does not depend on other surfaces or members.

use std::sync::Arc;

use super::correlation::Placement;
use super::formula_text::{FormulaText, Number};
use super::natural::{Coefficient, Difference};
use super::wind::{AROUND, Driven, Surroundings, Wind, WindTerms};
use crate::number::real::{Mask, Real};

/// Largest difference at which a formula is used as it is [K].
const FARTHEST: f64 = 200.0;
/// How many differences up to that are tried, with distances that grow.
const TRIED: u32 = 24;
/// Winds at which they are tried [m/s].
const WINDS: [(f64, bool); 3] = [(0.0, true), (30.0, true), (30.0, false)];
/// Least and largest temperature of the air [degC], angle [deg], irradiance [W/m2] and air changes [1/h] at which they are tried.
const SURROUNDINGS: [[f64; 2]; AROUND] =
    [[-20.0, 45.0], [0.0, 180.0], [0.0, 1200.0], [0.0, 30.0], [0.0, 100.0]];
/// Half of the second derivative of natural convection, times the cube root of the square of the difference [W/(m2 K^(4/3))], that
/// `step/remainder.rs` reckons with.
const BEND: f64 = 0.6;

/// A formula with its numbers.
#[derive(Debug, Clone)]
pub(super) struct Formula<S> {
    text: Arc<FormulaText>,
    numbers: Box<[S]>,
    /// Lowest and highest difference at which it is used as it is [K].
    limits: [S; 2],
}

impl<S: Real> Formula<S> {
    /// `given`: values of the numbers of the law, in their order.
    pub(super) fn new(text: &Arc<FormulaText>, given: &[S], surface: &Placement<S>) -> Self {
        let quarter = S::constant(180.0) - surface.inclination;
        let tilt = S::select(surface.upward.lt(S::zero()), quarter, surface.inclination);
        let number = |number: &Number| match *number {
            Number::Constant(value) => S::constant(value),
            Number::WindFactor => surface.wind_factor,
            Number::Tilt => tilt,
            Number::Upward => surface.upward,
            Number::Area => surface.area,
            Number::Density => surface.density,
            Number::Height => surface.height,
            Number::Given(place) => given[place],
        };
        let known: Vec<S> = text.run_numbers.iter().map(number).collect();
        let numbers = text.run.compute_all(&known).into();
        let limits = [-FARTHEST, FARTHEST].map(S::constant);
        let mut law = Self { text: Arc::clone(text), numbers, limits };
        if text.buoyant {
            law.limits = [-1.0, 1.0].map(|sign| law.limit(sign));
        }
        law
    }

    /// The farthest of the differences tried up to which the flow rises and the coefficient is not negative [K].
    fn limit(&self, sign: f64) -> S {
        let mut sound = S::Mask::splat(true);
        let mut limit = S::constant(sign * 1e-3);
        for k in 1..=TRIED {
            let part = f64::from(k) / f64::from(TRIED);
            let difference = S::constant(sign * FARTHEST * part * part);
            for forced in self.extremes() {
                let [value, slope] = self.plain(&|number| number.fixed(), difference, &forced);
                let rise = value + difference * slope;
                let least = S::constant(-1e-9);
                sound = sound & least.lt(value) & least.lt(rise) & rise.lt(S::constant(1e9));
            }
            limit = S::select(sound, difference, limit);
        }
        limit
    }

    /// What drives it in extreme winds and surroundings.
    fn extremes(&self) -> Vec<Driven<S>> {
        let mut surroundings = vec![Surroundings::<S>::calm().list()];
        for (place, ends) in SURROUNDINGS.iter().enumerate() {
            if self.text.surroundings[place] {
                let with = |list: &[S; AROUND]| {
                    let list = *list;
                    ends.map(|end| {
                        let mut changed = list;
                        changed[place] = S::constant(end);
                        changed
                    })
                };
                surroundings = surroundings.iter().flat_map(with).collect();
            }
        }
        let winds =
            WINDS.into_iter().map(|(speed, windward)| (Wind::new(speed, WindTerms::default()), windward));
        let all = winds.flat_map(|wind| surroundings.iter().map(move |list| (wind, *list)));
        all.map(|((wind, windward), list)| {
            self.driven(&wind, S::Mask::splat(windward), &Surroundings::from_list(list)).map(S::fixed)
        })
        .collect()
    }

    /// How much more the flow bends than [`BEND`]; one at least.
    pub(super) fn bend(&self) -> S {
        let mut most = S::one();
        if !self.text.buoyant {
            return most;
        }
        for forced in self.extremes() {
            for sign in [-1.0, 1.0] {
                let mut before: Option<(S, S)> = None;
                for k in 0..=TRIED {
                    let part = f64::from(k) / f64::from(TRIED);
                    let distance = FARTHEST * part * part;
                    let at = Difference::new(S::constant(sign * distance));
                    let Coefficient { value, rise } = self.coefficient(&|n: &S| n.fixed(), &at, &forced);
                    let slope = value + rise;
                    if let Some((last, other)) = before {
                        let middle = S::constant(distance).scale(0.5) + other.scale(0.5);
                        let bend = (slope - last).abs() / (S::constant(distance) - other);
                        let root = middle.cbrt();
                        most = most.max((bend * root * root).scale(0.5 / BEND));
                    }
                    before = Some((slope, S::constant(distance)));
                }
            }
        }
        most
    }

    /// Whether the law holds at a difference [K], a wind at the mast [m/s] and a temperature of the air [degC]; one or zero.
    pub(super) fn valid(&self, d: S, speed: S, air: S) -> S {
        let Some(program) = &self.text.validity else { return S::one() };
        let at = Difference::new(d);
        let [holds] = program.compute(&[d, at.rounded, speed, air], |place| self.numbers[place]);
        holds
    }

    /// What drives it.
    #[inline(always)]
    pub(super) fn driven(&self, wind: &Wind, windward: S::Mask, surroundings: &Surroundings<S>) -> Driven<S> {
        if self.text.stage.results() == 0 {
            return [S::zero(); 4];
        }
        let windward = S::select(windward, S::one(), S::zero());
        let [air, angle, sun, air_change, total] = surroundings.list();
        self.text.stage.compute(
            &[S::constant(wind.speed), windward, air, angle, sun, air_change, total],
            #[inline(always)]
            |place| self.numbers[place],
        )
    }

    /// What drives it in calm air.
    pub(super) fn calm(&self) -> Driven<S> {
        let wind = Wind::new(0.0, WindTerms::default());
        self.driven(&wind, S::Mask::splat(true), &Surroundings::calm())
    }

    /// Whether it says where it is valid.
    pub(super) fn limited(&self) -> bool {
        self.text.validity.is_some()
    }
}

impl<S> Formula<S> {
    /// Whether another surface has the same law.
    pub(super) fn alike(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.text, &other.text) || self.text == other.text
    }

    /// Whether it depends on the wind or on its surroundings, which change from stage to stage.
    pub(super) fn depends_on_wind(&self) -> bool {
        self.text.windy
    }

    /// Whether it depends on its surroundings.
    pub(super) fn surrounded(&self) -> bool {
        self.text.surroundings.iter().any(|used| *used)
    }

    /// Whether it depends on the air change of a zone.
    pub(super) fn needs_air_change(&self) -> bool {
        self.text.surroundings[3] || self.text.surroundings[4]
    }

    /// Whether the temperature difference contributes nothing.
    pub(super) fn linear(&self) -> bool {
        !self.text.buoyant
    }

    /// The coefficient and its derivative as written.
    #[inline(always)]
    fn plain<V: Real>(&self, number: &impl Fn(&S) -> V, d: V, forced: &Driven<V>) -> [V; 2] {
        let at = Difference::new(d);
        let [a, b, c, e] = *forced;
        let inputs = [d, at.rounded, a, b, c, e];
        self.text.iteration.compute(
            if self.text.many { &inputs } else { &inputs[..4] },
            #[inline(always)]
            |place| number(&self.numbers[place]),
        )
    }

    /// The same law with other numbers.
    #[inline(always)]
    pub(super) fn map<T>(&self, mut change: impl FnMut(&S) -> T) -> Formula<T> {
        let numbers = self.numbers.iter().map(&mut change).collect();
        let [low, high] = &self.limits;
        Formula { text: Arc::clone(&self.text), numbers, limits: [change(low), change(high)] }
    }

    /// The coefficient at a temperature difference; `number` turns its numbers into those to compute with.
    #[inline(always)]
    pub(super) fn coefficient<V: Real>(
        &self,
        number: &impl Fn(&S) -> V,
        at: &Difference<V>,
        forced: &Driven<V>,
    ) -> Coefficient<V> {
        if !self.text.buoyant {
            return Coefficient::fixed(forced[0]);
        }
        let [low, high] = [number(&self.limits[0]), number(&self.limits[1])];
        let beyond = at.d.lt(low) | high.lt(at.d);
        let d = if beyond.any() { at.d.max(low).min(high) } else { at.d };
        let [value, slope] = self.plain(number, d, forced);
        let inside = Coefficient { value, rise: d * slope };
        if !beyond.any() {
            return inside;
        }
        // Along the tangent: q = h d + (h + d h') (at.d - d).
        let steepness = value + inside.rise;
        let mean = (value * d + steepness * (at.d - d)) / V::select(beyond, at.d, V::one());
        inside.or(beyond, Coefficient { value: mean, rise: steepness - mean })
    }
}
