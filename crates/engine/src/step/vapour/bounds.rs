//! What the humidity of a step may not leave: the humidities that it starts from and that drive it.

use crate::balance::vapour::VapourLedger;
use crate::building::coefficients::HumidityCoefficients;
use crate::building::coefficients::humidity::VapourSurface;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::psychrometrics::{humidity_ratio, vapour_pressure};

/// Part of a bound by which it may be left: its rounding [-].
const ROUNDING: ByPrecision = ByPrecision { double: 1e-12, single: 1e-5 };
/// A humidity ratio that is corrected by more is pointed out [kg/kg]: 0.7 % of saturated air at 20 degC.
const LARGE: f64 = 1e-4;
/// Vapour pressure where there is none yet [Pa].
const NONE: f64 = 1e30;

/// Bounds of a step. Zones that exchange vapour share theirs: what is by zone stands at the first zone of each group.
#[derive(Debug, Clone)]
pub(super) struct Bounds<S> {
    /// Lowest and highest humidity ratio [kg/kg].
    ratios: Vec<[S; 2]>,
    /// Lowest and highest vapour pressure of layers behind surfaces [Pa].
    layers: Vec<[S; 2]>,
    /// Of each zone: share of the end of the step that may leave the bounds, the rest is that of the end that does not.
    pub(super) shares: Vec<S>,
    /// Of each zone: the same by its own bounds alone.
    own: Vec<S>,
}

impl<S: Real> Bounds<S> {
    pub(super) fn new(zones: usize) -> Self {
        let both = vec![[S::zero(); 2]; zones];
        Self { ratios: both.clone(), layers: both, shares: vec![S::one(); zones], own: vec![S::one(); zones] }
    }

    /// Begins with the start and the end of the first stage, and with the outdoor air in both stages.
    #[inline(always)]
    pub(super) fn begin(&mut self, groups: &[usize], [start, first]: [&[S]; 2], outdoor: [S; 2]) {
        let air = [outdoor[0].min(outdoor[1]), outdoor[0].max(outdoor[1])];
        self.ratios.fill(air);
        for (z, &group) in groups.iter().enumerate() {
            include(&mut self.ratios[group], start[z]);
            include(&mut self.ratios[group], first[z]);
        }
    }

    /// Adds the humidity ratio that a zone with sources or plants would go to, if plants and saturation did nothing, in a stage that leads from one
    /// state to another; what they have taken away and the diagonal of the balances [kg/s], and the length of the stage [s].
    #[inline(always)]
    pub(super) fn add_targets(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        groups: &[usize],
        [from, to]: [&[S]; 2],
        (removed, diagonal, length): (&[S], &[S], f64),
    ) {
        for (z, zone) in humidity.zones.iter().enumerate().filter(|(_, zone)| zone.has_sources()) {
            let storage = zone.air.scale(1.0 / length);
            let exchange = (diagonal[z] - storage).max(storage.scale(1e-9));
            let target = to[z] + ((to[z] - from[z]) * storage + removed[z]) / exchange;
            include(&mut self.ratios[groups[z]], target.max(S::zero()));
        }
    }

    /// Adds the layers behind surfaces at the start and at the end of the first stage, at the saturation pressures of both stages at the
    /// surfaces and the pressure of the air in the last one [Pa].
    #[inline(always)]
    pub(super) fn add_layers(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        groups: &[usize],
        (start, first): (&[S], &[S]),
        saturated: [&[S]; 2],
        pressure: S,
    ) {
        let zones = humidity.zones.len();
        self.layers.fill([S::constant(NONE), S::zero()]);
        for (k, surface) in humidity.surfaces.iter().enumerate() {
            let bounds = &mut self.layers[groups[surface.zone]];
            let used = if surface.layers.two { 2 } else { 1 };
            for (layer, &depth) in surface.layers.depths.iter().enumerate().take(used) {
                let place = zones + 2 * k + layer;
                let before = surface.layers.isotherm.humidity(start[place] / depth).0;
                let after = surface.layers.isotherm.humidity(first[place] / depth).0;
                include(bounds, before * saturated[0][k]);
                include(bounds, before * saturated[1][k]);
                include(bounds, after * saturated[1][k]);
            }
        }
        for surface in &humidity.surfaces {
            let group = groups[surface.zone];
            for bound in self.layers[group] {
                include(&mut self.ratios[group], humidity_ratio(bound, pressure));
            }
        }
    }

    /// Where an end of the step leaves the bounds, with the saturation pressures at the surfaces and the pressure of the air [Pa].
    #[inline(always)]
    pub(super) fn left(
        &self,
        humidity: &HumidityCoefficients<S>,
        groups: &[usize],
        end: &[S],
        (saturated, pressure): (&[S], S),
    ) -> S::Mask {
        let mut outside = S::Mask::splat(false);
        for (&group, &ratio) in groups.iter().zip(end) {
            outside = outside | is_outside(ratio, widened(self.ratios[group]));
        }
        let contents = end[groups.len()..].as_chunks::<2>().0;
        for ((surface, contents), &saturated) in humidity.surfaces.iter().zip(contents).zip(saturated) {
            let pressures = self.ratios[groups[surface.zone]].map(|bound| vapour_pressure(bound, pressure).0);
            for (bounds, &content) in contents_at(surface, pressures, saturated).zip(contents) {
                outside = outside | is_outside(content, widened(bounds));
            }
        }
        outside
    }

    /// The share of each zone, from the end of the step that may leave the bounds and the one that does not.
    #[inline(always)]
    pub(super) fn share(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        groups: &[usize],
        [beyond, within]: [&[S]; 2],
        (saturated, pressure): (&[S], S),
    ) {
        let zones = groups.len();
        for (z, &group) in groups.iter().enumerate() {
            self.own[z] = share(beyond[z], within[z], self.ratios[group]);
        }
        for (k, (surface, &saturated)) in humidity.surfaces.iter().zip(saturated).enumerate() {
            let pressures = self.ratios[groups[surface.zone]].map(|bound| vapour_pressure(bound, pressure).0);
            for (place, bounds) in (zones + 2 * k..).zip(contents_at(surface, pressures, saturated)) {
                let own = &mut self.own[surface.zone];
                *own = own.min(share(beyond[place], within[place], bounds));
            }
        }
        self.shares.fill(S::one());
        for (&group, &own) in groups.iter().zip(&self.own) {
            self.shares[group] = self.shares[group].min(own);
        }
        // The first zone of a group stands before the others.
        for (z, &group) in groups.iter().enumerate() {
            self.shares[z] = self.shares[group];
        }
    }

    /// Counts a step whose end was much beyond its bounds, and how fast vapour is exchanged there, with the diagonal of the balances [kg/s]
    /// and the length of the stage [s].
    #[inline(always)]
    pub(super) fn judge(
        &self,
        humidity: &HumidityCoefficients<S>,
        [beyond, within]: [&[S]; 2],
        (diagonal, length): (&[S], f64),
        step: &mut VapourLedger<S>,
    ) {
        let mut any = S::zero();
        for (z, zone) in humidity.zones.iter().enumerate() {
            let correction = (S::one() - self.own[z]) * (within[z] - beyond[z]).abs();
            let large = S::constant(LARGE).lt(correction);
            let rate = diagonal[z] / zone.air - S::constant(1.0 / length);
            any = S::select(large, S::one(), any);
            step.fastest = step.fastest.max(S::select(large, rate, S::zero()));
        }
        step.corrected += any;
    }
}

/// Widens bounds so that they include a number.
#[inline(always)]
fn include<S: Real>(bounds: &mut [S; 2], number: S) {
    bounds[0] = bounds[0].min(number);
    bounds[1] = bounds[1].max(number);
}

/// Contents of the layers behind a surface that are in balance with two vapour pressures, at the saturation pressure of the surface [kg/m2].
#[inline(always)]
fn contents_at<S: Real>(
    surface: &VapourSurface<S>,
    pressures: [S; 2],
    saturated: S,
) -> impl Iterator<Item = [S; 2]> {
    let layers = &surface.layers;
    let contents = pressures.map(|pressure| layers.isotherm.content(pressure / saturated));
    let used = if layers.two { 2 } else { 1 };
    layers.depths.into_iter().take(used).map(move |depth| contents.map(|content| content * depth))
}

/// Bounds and their rounding.
#[inline(always)]
fn widened<S: Real>([low, high]: [S; 2]) -> [S; 2] {
    let rounding = ROUNDING.of::<S>();
    [low.scale(1.0 - rounding), high.scale(1.0 + rounding)]
}

#[inline(always)]
fn is_outside<S: Real>(number: S, [low, high]: [S; 2]) -> S::Mask {
    number.lt(low) | high.lt(number)
}

/// The largest share of a number on the line to another one, which does not leave the bounds, with which the line does not.
#[inline(always)]
fn share<S: Real>(beyond: S, within: S, mut bounds: [S; 2]) -> S {
    include(&mut bounds, within);
    let bounds = widened(bounds);
    let outside = is_outside(beyond, bounds);
    let bound = S::select(beyond.lt(bounds[0]), bounds[0], bounds[1]);
    let whole = S::select(outside, within - beyond, S::one());
    S::select(outside, ((within - bound) / whole).max(S::zero()).min(S::one()), S::one())
}
