//! Phase change: volumetric enthalpy, capacity, liquid fraction and conductivity at a temperature.
//!
//! A law gives the enthalpy itself and its exact derivative, so that the step can
//! conserve heat; the "apparent capacity" of the paper is that derivative.
//!
//! Mass is conserved: a cell is a fixed mass, its volume that of the solid as built. Heat is counted per volume as
//! built, `H(T, xi) = rho_s c_s (T - Tr) + xi [rho_s L + rho_s (c_l - c_s)(T - Tr)]`; the liquid layer is thicker by
//! `rho_s/rho_l` and conducts `k_l rho_l/rho_s` over the thickness as built. With one density this is the paper's eq. 2.

mod curve;
mod evaluate;
pub(crate) mod history;
mod normal;
mod segments;
mod table;
#[cfg(test)]
mod tests;
pub(crate) mod text;

use crate::input::description::{ParamId, PcmLaw};
use crate::input::values::Values;
use crate::number::real::{Mask, Real};
use crate::physics::formula::function::Function;
use curve::{Curve, CurvePoint, limit_at};
use history::two_curves::FAR;
use history::{AnyHistoryLaw, Ingredients};
use table::{Table, TablePoint};

/// Half-width of a melting range that does not exist [K].
const NO_MELTING: f64 = 1e3;

pub use curve::CUT;
pub use evaluate::LiquidFraction;
pub(crate) use history::HISTORY_NUMBERS;
pub use history::{MODEL_STATE, PcmHistory, StageStart, reversed};

/// State of a phase-change material at one temperature, per unit volume of layer.
#[derive(Debug, Clone, Copy)]
pub struct PcmPoint<S> {
    /// Enthalpy above the law's reference [J/m3].
    pub enthalpy: S,
    /// Slope of the enthalpy [J/(m3 K)]; the paper's apparent capacity.
    pub capacity: S,
    /// Liquid fraction [-].
    pub liquid_fraction: S,
    /// Its slope [1/K].
    pub fraction_slope: S,
    /// Conductivity [W/(m K)].
    pub conductivity: S,
    /// Slope of the conductivity [W/(m K2)].
    pub conductivity_slope: S,
    /// Integral of the conductivity over temperature [W/m], from a temperature of the law's own; zero where the law
    /// has none, see [`PcmCoefficients::integrable`].
    pub potential: S,
}

impl<S: Real> PcmPoint<S> {
    /// Zeros, before it is evaluated.
    pub fn zero() -> Self {
        let zero = S::zero();
        Self {
            enthalpy: zero,
            capacity: zero,
            liquid_fraction: zero,
            fraction_slope: zero,
            conductivity: zero,
            conductivity_slope: zero,
            potential: zero,
        }
    }
}

/// A phase-change law with its numbers.
#[derive(Debug, Clone)]
pub struct PcmCoefficients<S> {
    /// Of solid and liquid over the thickness as built [W/(m K)].
    conductivity: [S; 2],
    /// Sensible, of solid and liquid per volume as built [J/(m3 K)].
    volumetric_heat: [S; 2],
    /// What they are larger by in the liquid.
    conductivity_rise: S,
    heat_rise: S,
    law: Law<S>,
    /// Temperature of the steepest part of the enthalpy curve [degC] and half-width of the melting range [K]; none where the history has
    /// them, or nothing melts.
    steep: Option<[S; 2]>,
}

#[derive(Debug, Clone)]
enum Law<S> {
    Melting(Latent<S>, Curve<S>),
    History(Latent<S>, AnyHistoryLaw<S>),
    Table(Table<S>),
    /// Nothing melts: the conductivity of the temperature.
    Sensible(Function<S>),
}

/// Heat of melting per volume as built, at a temperature.
#[derive(Debug, Clone, Copy)]
struct Latent<S> {
    heat: S,
    reference: S,
}

impl<S: Real> PcmCoefficients<S> {
    /// Reads the numbers of a law.
    ///
    /// # Panics
    /// Where a law with a state is not in the list, or lacks curves or numbers: a plan refuses such a description.
    pub fn new(
        values: &Values<'_, S>,
        conductivity: [ParamId; 2],
        density: [ParamId; 2],
        specific_heat: [ParamId; 2],
        law: &PcmLaw,
    ) -> Self {
        let [solid, liquid] = density.map(|id| values.get(id));
        let conductivity = conductivity.map(|id| values.get(id));
        let latent = |heat: ParamId, curve: &Curve<S>| Latent {
            heat: solid * values.get(heat),
            reference: curve.reference(),
        };
        let law = match law {
            PcmLaw::Melting { latent_heat, curve } => {
                let curve = Curve::new(values, curve);
                Law::Melting(latent(*latent_heat, &curve), curve)
            }
            PcmLaw::History { latent_heat, model, curves, numbers } => {
                let curves: Vec<_> = curves.iter().map(|curve| Curve::new(values, curve)).collect();
                let latent = latent(*latent_heat, &curves[0]);
                let law = AnyHistoryLaw::new(model, Ingredients { values, curves, numbers });
                Law::History(latent, law.expect("the check of a description knows the name of its law"))
            }
            PcmLaw::Tabulated { temperatures, points, melting_range, temperature_shift, enthalpy_scale } => {
                let factor = solid * values.get(*enthalpy_scale);
                let shift = values.get(*temperature_shift);
                Law::Table(Table::new(temperatures, points, *melting_range, shift, factor))
            }
        };
        let conductivity = [conductivity[0], conductivity[1] * (liquid / solid)];
        let volumetric_heat = specific_heat.map(|id| solid * values.get(id));
        let steep = match &law {
            Law::Melting(_, curve) => Some([curve.peak(), curve.width()]),
            Law::Table(table) => Some([table.peak(), table.width()]),
            Law::History(..) | Law::Sensible(_) => None,
        };
        Self {
            steep,
            conductivity_rise: conductivity[1] - conductivity[0],
            heat_rise: volumetric_heat[1] - volumetric_heat[0],
            conductivity,
            volumetric_heat,
            law,
        }
    }

    /// A material that does not melt, whose conductivity changes with temperature; `heat` per volume [J/(m3 K)].
    pub(crate) fn without_melting(conductivity: Function<S>, heat: S) -> Self {
        let zero = S::zero();
        Self {
            conductivity: [zero; 2],
            volumetric_heat: [heat; 2],
            conductivity_rise: zero,
            heat_rise: zero,
            law: Law::Sensible(conductivity),
            steep: None,
        }
    }

    /// The conductivity, where it is written as text and says where it holds.
    pub(crate) fn limited_conductivity(&self) -> Option<&Function<S>> {
        match &self.law {
            Law::Sensible(law) if law.limited() => Some(law),
            _ => None,
        }
    }

    /// Properties at a temperature [degC].
    pub fn at(&self, temperature: S, history: &PcmHistory<S>) -> PcmPoint<S> {
        let mut point = PcmPoint::zero();
        self.at_all(&[temperature], &[*history], core::slice::from_mut(&mut point), true);
        point
    }

    /// Properties at several temperatures [degC]; a law with a history takes one for each. Unless `curved`, slopes by temperature
    /// may be constants for derivatives: a tangent needs no more of them.
    // One copy only: inlining all laws at every call would multiply compile time.
    #[inline(never)]
    pub fn at_all(
        &self,
        temperatures: &[S],
        history: &[PcmHistory<S>],
        points: &mut [PcmPoint<S>],
        curved: bool,
    ) {
        S::vectorised(
            #[inline(always)]
            || {
                let places = points.iter_mut().zip(temperatures);
                match &self.law {
                    Law::Melting(latent, curve) => {
                        // The usual curve has a loop of its own without the other curves, which is faster.
                        if let Some(tanh) = curve.tanh() {
                            for (point, &temperature) in places {
                                *point =
                                    self.without_history(*latent, temperature, curved, tanh.at(temperature));
                            }
                        } else {
                            for (point, &temperature) in places {
                                *point =
                                    self.without_history(*latent, temperature, curved, curve.at(temperature));
                            }
                        }
                    }
                    Law::History(latent, law) => {
                        for ((point, &temperature), history) in places.zip(history) {
                            *point = self.with_history(*latent, law, (temperature, curved), history);
                        }
                    }
                    Law::Table(table) => {
                        for (point, &temperature) in places {
                            *point = self.tabulated(table, (temperature, curved));
                        }
                    }
                    Law::Sensible(conductivity) => places.for_each(|(point, &temperature)| {
                        *point = self.sensible(conductivity, (temperature, curved));
                    }),
                }
            },
        );
    }

    #[inline(always)]
    fn without_history(
        &self,
        latent: Latent<S>,
        temperature: S,
        curved: bool,
        point: CurvePoint<S>,
    ) -> PcmPoint<S> {
        let CurvePoint { fraction, slope, molten } = point;
        let slope = if curved { slope } else { slope.fixed() };
        let (enthalpy, capacity) = self.heat(latent, (temperature, curved), fraction, slope);
        self.point((temperature, curved), [enthalpy, capacity], [fraction, slope], molten)
    }

    #[inline(always)]
    fn with_history(
        &self,
        latent: Latent<S>,
        law: &AnyHistoryLaw<S>,
        (temperature, curved): (S, bool),
        history: &PcmHistory<S>,
    ) -> PcmPoint<S> {
        let (fraction, slope) = law.at(temperature, history);
        let slope = if curved { slope } else { slope.fixed() };
        let (enthalpy, capacity) = self.heat(latent, (temperature, curved), fraction, slope);
        self.point((temperature, curved), [enthalpy, capacity], [fraction, slope], S::zero())
    }

    #[inline(always)]
    fn tabulated(&self, table: &Table<S>, (temperature, curved): (S, bool)) -> PcmPoint<S> {
        let TablePoint { enthalpy, capacity, fraction, fraction_slope, molten } =
            table.at(temperature, self.volumetric_heat);
        self.point((temperature, curved), [enthalpy, capacity], [fraction, fraction_slope], molten)
    }

    #[inline(always)]
    fn sensible(&self, law: &Function<S>, (temperature, curved): (S, bool)) -> PcmPoint<S> {
        let [heat, _] = self.volumetric_heat;
        let [conductivity, slope] = law.at(temperature, &[]);
        PcmPoint {
            enthalpy: heat * temperature,
            capacity: if curved { heat } else { heat.fixed() },
            conductivity,
            conductivity_slope: if curved { slope } else { slope.fixed() },
            ..PcmPoint::zero()
        }
    }

    #[inline(always)]
    fn point(
        &self,
        (temperature, curved): (S, bool),
        [enthalpy, capacity]: [S; 2],
        [fraction, slope]: [S; 2],
        molten: S,
    ) -> PcmPoint<S> {
        let spread = self.conductivity_rise;
        PcmPoint {
            enthalpy,
            capacity,
            liquid_fraction: fraction,
            fraction_slope: slope,
            conductivity: self.conductivity[0] + fraction * spread,
            conductivity_slope: if curved { spread } else { spread.fixed() } * slope,
            potential: self.conductivity[0] * temperature + spread * molten,
        }
    }

    /// Enthalpy [J/m3] of a temperature and a liquid fraction, and its slope when the fraction has that slope: the
    /// enthalpy whose derivative is the apparent capacity of the paper's eq. 2, relative to the melting temperature.
    #[inline(always)]
    fn heat(&self, latent: Latent<S>, (temperature, curved): (S, bool), fraction: S, slope: S) -> (S, S) {
        let excess = temperature - latent.reference;
        let step = self.heat_rise;
        let jump = latent.heat + step * excess;
        let enthalpy = self.volumetric_heat[0] * excess + fraction * jump;
        let of_slope = |number: S| if curved { number } else { number.fixed() };
        let sensible = of_slope(self.volumetric_heat[0]) + of_slope(step) * of_slope(fraction);
        (enthalpy, sensible + slope * of_slope(jump))
    }

    /// Whether a point holds the integral of the conductivity.
    pub fn integrable(&self) -> bool {
        match &self.law {
            Law::Melting(_, curve) => curve.integrable(),
            Law::History(..) | Law::Sensible(_) => false,
            Law::Table(_) => true,
        }
    }

    /// Sensible heat of the solid per volume as built [J/(m3 K)].
    pub(crate) fn sensible_heat(&self) -> S {
        self.volumetric_heat[0]
    }

    /// Whether the enthalpy depends on earlier temperatures.
    pub fn has_history(&self) -> bool {
        matches!(self.law, Law::History(..))
    }

    /// Whether it depends on time, so that stages read the history by way of [`Self::in_stage`].
    pub(crate) fn has_rate(&self) -> bool {
        matches!(&self.law, Law::History(_, law) if law.has_rate())
    }

    /// The history that a stage reads.
    #[inline(always)]
    pub fn in_stage(&self, history: &PcmHistory<S>, start: &StageStart<S>) -> PcmHistory<S> {
        match &self.law {
            Law::History(_, law) => law.in_stage(history, start),
            Law::Melting(..) | Law::Table(_) | Law::Sensible(_) => *history,
        }
    }

    /// The history of a cell that was heated to a temperature.
    pub fn begin(&self, temperature: S) -> PcmHistory<S> {
        if let Law::History(_, law) = &self.law {
            return law.begin(temperature);
        }
        let nothing = PcmHistory::new(S::zero(), temperature);
        PcmHistory::new(self.at(temperature, &nothing).liquid_fraction, temperature)
    }

    /// The history after a step of a length [s] that ended at a temperature with a liquid fraction.
    #[inline(always)]
    pub fn next(&self, history: &PcmHistory<S>, temperature: S, fraction: S, step: f64) -> PcmHistory<S> {
        match &self.law {
            Law::History(_, law) => law.next(history, temperature, fraction, step),
            Law::Melting(..) | Law::Table(_) | Law::Sensible(_) => PcmHistory::new(fraction, temperature),
        }
    }

    /// The same history with all that [`Self::rising`] needs.
    pub fn complete(&self, history: &PcmHistory<S>) -> PcmHistory<S> {
        match &self.law {
            Law::History(_, law) => law.complete(history),
            Law::Melting(..) | Law::Table(_) | Law::Sensible(_) => *history,
        }
    }

    /// Limits a Newton step across the steep part of the enthalpy curve: a step that crosses its inflection and is longer
    /// than a half-width ends on the inflection, from where Newton's method converges monotonically.
    #[inline(always)]
    pub fn limit(&self, from: S, to: S, history: &PcmHistory<S>) -> S {
        match (&self.steep, &self.law) {
            (Some([peak, width]), _) => limit_at(from, to, *peak, *width),
            (None, Law::History(_, law)) => law.limit(from, to, history),
            (None, _) => to,
        }
    }

    /// Limits a Newton step along a curve with several bends, such as a measured one, after the first steps. Where the curve rises by much
    /// more than its tangent, the iterate would take up heat that it was not given, and Newton's method goes to and fro between two
    /// temperatures for ever. There the step ends at the temperature that has the heat of the tangent: the unknown is then the
    /// enthalpy instead of the temperature (Swaminathan & Voller 1993, Int. J. Numer. Methods Heat Fluid Flow 3(3), 233-244).
    /// The smaller of both moves converged from all of 400 random states of a wall; each alone did not from 100.
    #[inline(always)]
    pub fn limit_heat(&self, from: S, to: S, history: &PcmHistory<S>) -> S {
        match &self.law {
            Law::Melting(_, curve) if !curve.is_measured() => self.limit(from, to, history),
            Law::Sensible(_) => to,
            Law::Melting(..) | Law::Table(_) | Law::History(..) => self.move_by_heat(from, to, history),
        }
    }

    // One copy only: inlining multiplies compile time.
    #[inline(never)]
    fn move_by_heat(&self, from: S, to: S, history: &PcmHistory<S>) -> S {
        /// Rise of the curve over that of the tangent, from which a step is limited [-].
        const STEEPER: f64 = 1.5;
        /// Halvings of the step: the place need not be exact.
        const BISECTIONS: usize = 8;
        let at = self.at(from, history);
        let along_tangent = at.capacity * (to - from);
        let along_curve = self.at(to, history).enthalpy - at.enthalpy;
        let too_far = along_tangent.abs().scale(STEEPER).lt(along_curve.abs());
        if !too_far.any() {
            return to;
        }
        let (heat, mut low, mut high) = (at.enthalpy + along_tangent, from.min(to), from.max(to));
        for _ in 0..BISECTIONS {
            let middle = (low + high).scale(0.5);
            let beneath = self.at(middle, history).enthalpy.lt(heat);
            low = S::select(beneath, middle, low);
            high = S::select(beneath, high, middle);
        }
        S::select(too_far, (low + high).scale(0.5), to)
    }

    /// Heat of melting over the width of the melting curve [J/(m3 K)]: half of the second derivative of the enthalpy is at most
    /// this times the slope of the liquid fraction. None where the curve has no such bound: all but `tanh`.
    pub(crate) fn curvature(&self) -> Option<S> {
        match &self.law {
            Law::Melting(latent, curve) if curve.tanh().is_some() => Some(latent.heat / curve.width()),
            Law::Melting(..) | Law::Table(_) | Law::History(..) | Law::Sensible(_) => None,
        }
    }

    /// Half-width of the melting range [K].
    pub fn width(&self) -> S {
        match &self.law {
            Law::Melting(_, curve) => curve.width(),
            Law::History(_, law) => law.width(),
            Law::Table(table) => table.width(),
            Law::Sensible(_) => S::constant(NO_MELTING),
        }
    }

    /// The convex part of the enthalpy, `H = H1 - H2` with slopes that never fall, and its slope: the split of Brugnano
    /// & Casulli (2009) and Casulli & Zanolli (2010), SIAM J. Sci. Comput. 32(4), doi:10.1137/100786320. The history
    /// must be complete.
    pub fn rising(&self, temperature: S, history: &PcmHistory<S>) -> (S, S) {
        let (latent, (fraction, slope)) = match &self.law {
            Law::Melting(latent, curve) => {
                if curve.is_measured() {
                    (latent, curve.convex(temperature, [-S::constant(FAR), S::constant(FAR)]))
                } else {
                    let place = temperature.min(curve.peak());
                    let (fraction, slope) = curve.whole(place);
                    (latent, (fraction + slope * (temperature - place), slope))
                }
            }
            Law::History(latent, law) => (latent, law.rising(temperature, history)),
            Law::Table(table) => {
                return table.convex(temperature, self.volumetric_heat);
            }
            Law::Sensible(_) => return (self.volumetric_heat[0] * temperature, self.volumetric_heat[0]),
        };
        self.heat(*latent, (temperature, true), fraction, slope)
    }
}
