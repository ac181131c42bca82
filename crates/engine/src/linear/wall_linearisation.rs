//! A wall linearised about an iterate: the tangents of enthalpy and of the fluxes between cells.
//!
//! Newton's method works on the enthalpy in flux form. Each phase-change cell holds the tangent enthalpy
//! `H(T_k) + C(T_k) (T - T_k)` at the iterate `T_k`, so that heat is conserved in every iteration. A flux within one
//! phase-change layer is the difference of the integrals of the conductivity (Kirchhoff's transformation) over the
//! distance: exact in a steady state, however much the conductivity changes in between. A flux between two layers passes
//! two half cells in series. All derivatives keep the sign of the conductivity, so that Newton's matrix stays an M-matrix.
//!
//! Cells and links of constant properties are linear already and are written once.

use core::ops::Range;

use crate::building::coefficients::{Matter, WallCoefficients};
use crate::linear::tridiagonal::Link;
use crate::number::real::{ByPrecision, Real};
use crate::physics::pcm::{PcmCoefficients, PcmHistory, PcmPoint};

/// Enthalpy of a cell near the current iterate, `offset + capacity (T - reference)` [J/m3].
///
/// The unknown of a phase-change cell is the change from its iterate, not the temperature: with a sharp melting range the
/// capacity is so large that rounding of the temperature would show in the enthalpy.
#[derive(Debug, Clone, Copy)]
pub struct Storage<S> {
    /// Temperature that the tangent touches at; 0 where the capacity is constant [degC].
    pub reference: S,

    /// Enthalpy there [J/m3].
    pub offset: S,

    /// Slope [J/(m3 K)].
    pub capacity: S,

    /// Change from there to the solution [K].
    pub(super) change: S,
}

impl<S: Real> Storage<S> {
    /// Constant properties.
    #[inline(always)]
    pub(super) fn constant(capacity: S) -> Self {
        Self { reference: S::zero(), offset: S::zero(), capacity, change: S::zero() }
    }

    /// A tangent; its slope is a constant for derivatives, because it counts only away from the solution.
    #[inline(always)]
    fn tangent(reference: S, offset: S, capacity: S) -> Self {
        Self { reference, offset, capacity: capacity.fixed(), change: S::zero() }
    }

    /// Enthalpy at the solution.
    #[inline(always)]
    pub fn at_solution(&self) -> S {
        self.offset + self.capacity * self.change
    }
}

/// How storage is linearised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageRule {
    /// Enthalpy and its slope at the iterate: conserves heat.
    Enthalpy,
    /// The apparent capacity at the old temperature, as in the paper: does not.
    ApparentCapacity,
}

/// Temperatures about which a wall is linearised [degC].
#[derive(Debug, Clone, Copy)]
pub struct Iterate<'a, S> {
    /// Its cells, outside to inside.
    pub cells: &'a [S],

    /// Its outside and inside surface.
    pub surfaces: [S; 2],

    /// Cells about which the concave part of the enthalpy is linearised; none: the iterate itself.
    pub outer: Option<&'a [S]>,
}

/// A wall at the start of the step: temperatures [degC], enthalpies [J/m3], memory.
#[derive(Debug, Clone, Copy)]
pub struct Start<'a, S> {
    /// Temperatures [degC].
    pub cells: &'a [S],

    /// Enthalpies [J/m3].
    pub enthalpy: &'a [S],

    /// Memory of the hysteresis of each cell.
    pub memory: &'a [PcmHistory<S>],
}

/// The parts of a wall that depend on temperature, and their properties at the iterate.
#[derive(Debug, Clone)]
pub(super) struct PhaseChange<S> {
    /// Properties of the phase-change cells at the iterate; of other cells nothing.
    points: Vec<PcmPoint<S>>,
    layers: Vec<PcmLayer>,
    /// Of each layer: the slope of its enthalpy per slope of its liquid fraction, over the width of its melting curve
    /// [J/(m3 K)]; zero where its curve has to be evaluated.
    curvatures: Vec<S>,
    /// Links between two cells of one law, and those between such a cell and a surface.
    inner_links: Vec<PcmLink<S>>,
    surface_links: Vec<PcmLink<S>>,
    series_links: Vec<SeriesLink<S>>,
}

/// Neighbouring cells of one law.
#[derive(Debug, Clone)]
struct PcmLayer {
    law: usize,
    cells: Range<usize>,
}

/// A link within one phase-change layer: between two of its cells, or between a cell and a surface.
#[derive(Debug, Clone, Copy)]
struct PcmLink<S> {
    link: usize,
    law: usize,
    /// One over the distance between its ends [1/m].
    inverse_length: S,
}

/// A link through half cells of two layers, or through a massless layer, with phase change at one end or both.
#[derive(Debug, Clone, Copy)]
struct SeriesLink<S> {
    link: usize,
    /// Resistance of all that has constant properties [m2 K/W].
    resistance: S,
    /// Thickness of the half cell at either end where it changes phase [m].
    halves: [Option<S>; 2],
}

/// The half cell at one end of a [`SeriesLink`]; of no thickness where nothing changes phase.
struct HalfCell<S> {
    /// Thickness [m], conductivity [W/(m K)] and its slope [W/(m K2)].
    thickness: S,
    conductivity: S,
    slope: S,
    /// Temperature of the cell or surface [degC], and what of it the link counts from zero, see [`Link`] [K].
    temperature: S,
    above: S,
}

impl<S: Real> SeriesLink<S> {
    fn new(wall: &WallCoefficients<S>, link: usize) -> Self {
        let mut series = Self { link, resistance: wall.extra[link], halves: [None; 2] };
        for (side, half) in series.halves.iter_mut().enumerate() {
            let Some(cell) = link.checked_sub(1 - side).and_then(|cell| wall.cells.get(cell)) else {
                continue;
            };
            let thickness = cell.thickness.scale(0.5);
            match cell.matter {
                Matter::Pcm(_) => *half = Some(thickness),
                Matter::Solid { conductivity, .. } => series.resistance += thickness / conductivity,
            }
        }
        series
    }

    /// Newton form of `K (T_left - T_right)` with K from the half cells at their own temperatures. Its derivatives are
    /// limited where the conductivity changes so steeply that they would change sign; the flux itself is not changed.
    #[inline(always)]
    fn tangent(&self, points: &[PcmPoint<S>], at: &Iterate<'_, S>) -> Link<S> {
        /// Largest part of the conductance that the slope of the conductivity may take away [-].
        const LEAST: f64 = 0.9;
        let (left, right) = (self.half_cell(0, points, at), self.half_cell(1, points, at));
        // K = 1/(R + a_left/k_left + a_right/k_right), with one division.
        let both = left.conductivity * right.conductivity;
        let thickness = left.thickness * right.conductivity + right.thickness * left.conductivity;
        let inverse = S::one() / (self.resistance * both + thickness);
        let conductance = both * inverse;
        let difference = left.temperature - right.temperature;
        let (steady, inverse, apart) = (conductance.fixed(), inverse.fixed(), difference.fixed());
        let (by_left, by_right) = (right.conductivity.fixed() * inverse, left.conductivity.fixed() * inverse);
        let most = steady.scale(LEAST);
        let gain = (apart * left.thickness.fixed() * left.slope.fixed() * (by_left * by_left)).max(-most);
        let loss = (apart * right.thickness.fixed() * right.slope.fixed() * (by_right * by_right)).min(most);
        let (by_left, by_right) = (steady + gain, steady - loss);
        Link {
            left: by_left,
            right: by_right,
            offset: conductance * difference - by_left * left.above + by_right * right.above,
        }
    }

    #[inline(always)]
    fn half_cell(&self, side: usize, points: &[PcmPoint<S>], at: &Iterate<'_, S>) -> HalfCell<S> {
        // Before the first cell and behind the last lie the surfaces.
        let cell = (self.link + side).checked_sub(1).filter(|&cell| cell < at.cells.len());
        let temperature = cell.map_or(at.surfaces[side], |cell| at.cells[cell]);
        let (Some(thickness), Some(cell)) = (self.halves[side], cell) else {
            let (thickness, conductivity, slope) = (S::zero(), S::one(), S::zero());
            return HalfCell { thickness, conductivity, slope, temperature, above: temperature };
        };
        let PcmPoint { conductivity, conductivity_slope: slope, .. } = points[cell];
        HalfCell { thickness, conductivity, slope, temperature, above: S::zero() }
    }
}

impl<S: Real> PcmLink<S> {
    /// Newton form of the flux between two cells of one layer.
    #[inline(always)]
    fn between_cells(&self, points: &[PcmPoint<S>]) -> Link<S> {
        let (left, right) = (&points[self.link - 1], &points[self.link]);
        let inverse = self.inverse_length.fixed();
        Link {
            left: left.conductivity.fixed() * inverse,
            right: right.conductivity.fixed() * inverse,
            offset: (left.potential - right.potential) * self.inverse_length,
        }
    }

    /// Newton form of the flux between a cell and the surface of its layer.
    #[inline(always)]
    fn at_surface(
        &self,
        wall: &WallCoefficients<S>,
        points: &[PcmPoint<S>],
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
    ) -> Link<S> {
        let outside = self.link == 0;
        let (cell, surface) = if outside { (0, at.surfaces[0]) } else { (self.link - 1, at.surfaces[1]) };
        let (surface_point, point) = (wall.pcm[self.law].at(surface, &start.memory[cell]), &points[cell]);
        let inverse = self.inverse_length;
        let steady = inverse.fixed();
        let (by_surface, by_cell) =
            (surface_point.conductivity.fixed() * steady, point.conductivity.fixed() * steady);
        // The unknown of a cell is the change from its iterate, that of a surface its temperature.
        let inwards = (surface_point.potential - point.potential) * inverse - by_surface * surface;
        if outside {
            Link { left: by_surface, right: by_cell, offset: inwards }
        } else {
            Link { left: by_cell, right: by_surface, offset: -inwards }
        }
    }
}

impl<S: Real> PhaseChange<S> {
    /// Sorts the cells and links of a wall that depend on temperature.
    pub(super) fn new(wall: &WallCoefficients<S>) -> Self {
        let n = wall.cells.len();
        let mut all = Self {
            points: vec![PcmPoint::zero(); n],
            layers: Vec::new(),
            curvatures: Vec::new(),
            inner_links: Vec::new(),
            surface_links: Vec::new(),
            series_links: Vec::new(),
        };
        let law = |cell: usize| match wall.cells[cell].matter {
            Matter::Pcm(law) => Some(law),
            Matter::Solid { .. } => None,
        };
        for (cell, of_cell) in (0..n).filter_map(|cell| Some((cell, law(cell)?))) {
            match all.layers.last_mut() {
                Some(layer) if layer.law == of_cell && layer.cells.end == cell => layer.cells.end += 1,
                _ => all.layers.push(PcmLayer { law: of_cell, cells: cell..cell + 1 }),
            }
        }
        let curvature = |layer: &PcmLayer| wall.pcm[layer.law].curvature().unwrap_or(S::zero());
        all.curvatures = all.layers.iter().map(curvature).collect();
        if n == 0 {
            return all;
        }
        for link in 0..=n {
            // The surface belongs to the layer behind it.
            let ends = [law(link.saturating_sub(1)), law(link.min(n - 1))];
            let surface = link == 0 || link == n;
            match ends {
                [None, None] => {}
                [Some(left), Some(right)]
                    if left == right && !wall.massless[link] && wall.pcm[left].integrable() =>
                {
                    let share = if surface { 0.5 } else { 1.0 };
                    let inverse_length = S::one() / wall.cells[link.min(n - 1)].thickness.scale(share);
                    let links = if surface { &mut all.surface_links } else { &mut all.inner_links };
                    links.push(PcmLink { link, law: left, inverse_length });
                }
                _ => all.series_links.push(SeriesLink::new(wall, link)),
            }
        }
        all
    }

    /// Writes the tangents at an iterate of the cells and the two surfaces.
    #[inline(always)]
    pub(super) fn linearise(
        &mut self,
        wall: &WallCoefficients<S>,
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
        rule: StorageRule,
        (links, storage): (&mut [Link<S>], &mut [Storage<S>]),
    ) {
        for PcmLayer { law, cells } in &self.layers {
            let temperatures = &at.cells[cells.clone()];
            let (points, storage) = (&mut self.points[cells.clone()], &mut storage[cells.clone()]);
            wall.pcm[*law].at_all(temperatures, &start.memory[cells.clone()], points, false);
            for ((storage, point), &temperature) in storage.iter_mut().zip(points).zip(temperatures) {
                *storage = Storage::tangent(temperature, point.enthalpy, point.capacity);
            }
        }
        if at.outer.is_some() || rule == StorageRule::ApparentCapacity {
            self.store_otherwise(wall, at, start, storage);
        }
        for pcm in &self.inner_links {
            links[pcm.link] = pcm.between_cells(&self.points);
        }
        for pcm in &self.surface_links {
            links[pcm.link] = pcm.at_surface(wall, &self.points, at, start);
        }
        for series in &self.series_links {
            links[series.link] = series.tangent(&self.points, at);
        }
    }

    /// Storage along two tangents, or by the apparent capacity.
    #[cold]
    #[inline(never)]
    fn store_otherwise(
        &self,
        wall: &WallCoefficients<S>,
        at: &Iterate<'_, S>,
        start: &Start<'_, S>,
        storage: &mut [Storage<S>],
    ) {
        for layer in &self.layers {
            let law = &wall.pcm[layer.law];
            for i in layer.cells.clone() {
                let (temperature, memory) = (at.cells[i], &start.memory[i]);
                let (enthalpy, capacity) = if let Some(outer) = at.outer {
                    split_tangent(law, temperature, outer[i], memory)
                } else {
                    let capacity = law.at(start.cells[i], memory).capacity;
                    (start.enthalpy[i] + capacity * (temperature - start.cells[i]), capacity)
                };
                storage[i] = Storage::tangent(temperature, enthalpy, capacity);
            }
        }
    }

    /// See [`WallSystem::estimated_remainder`](super::wall::WallSystem::estimated_remainder).
    #[inline(always)]
    pub(super) fn estimated_remainder(&self, storage: &[Storage<S>], rate: &[S]) -> S {
        let mut largest = S::zero();
        for (layer, curvature) in self.layers.iter().zip(&self.curvatures) {
            for i in layer.cells.clone() {
                let change = storage[i].change;
                largest =
                    largest.max(*curvature * self.points[i].fraction_slope * rate[i] * (change * change));
            }
        }
        largest
    }

    /// See [`WallSystem::remainder`](super::wall::WallSystem::remainder); `flux`: along a link.
    #[inline(always)]
    pub(super) fn linearization_error(
        &self,
        wall: &WallCoefficients<S>,
        memory: &[PcmHistory<S>],
        (storage, rate): (&[Storage<S>], &[S]),
        flux: impl Fn(usize) -> S,
    ) -> S {
        /// Rounding of a temperature, by which enthalpies may differ [K].
        const ROUNDING: ByPrecision = ByPrecision { double: 1e-14, single: 1e-5 };
        let mut largest = S::zero();
        for layer in &self.layers {
            for i in layer.cells.clone() {
                let (held, old) = (&storage[i], &self.points[i]);
                let new = wall.pcm[layer.law].at(held.reference + held.change, &memory[i]);
                let enthalpy = (new.enthalpy - held.at_solution()).abs();
                let rounding = new.capacity.max(held.capacity).scale(ROUNDING.of::<S>());
                let conductivity = new.conductivity - old.conductivity - old.conductivity_slope * held.change;
                let heat = flux(i).abs().max(flux(i + 1).abs());
                let flow = (conductivity * heat / old.conductivity).abs();
                largest = largest.max((enthalpy - rounding).max(S::zero()) * rate[i] + flow);
            }
        }
        largest
    }

    /// Liquid fraction of a phase-change cell at the last linearisation.
    #[inline(always)]
    pub(super) fn liquid_fraction(&self, i: usize) -> S {
        self.points[i].liquid_fraction
    }

    /// Liquid fraction of a phase-change cell along the last tangent, at a change of its temperature [K].
    #[inline(always)]
    pub(super) fn fraction_after(&self, i: usize, change: S) -> S {
        let point = &self.points[i];
        let reached = point.liquid_fraction + point.fraction_slope * change;
        reached.max(S::zero()).min(S::one())
    }
}

/// Enthalpy and slope at a temperature, the concave part of the enthalpy taken along its tangent at another one.
fn split_tangent<S: Real>(
    law: &PcmCoefficients<S>,
    temperature: S,
    outer: S,
    memory: &PcmHistory<S>,
) -> (S, S) {
    let (convex, convex_slope) = law.rising(temperature, memory);
    let (all, (outer_convex, outer_slope)) = (law.at(outer, memory), law.rising(outer, memory));
    let concave_slope = outer_slope - all.capacity;
    let concave = outer_convex - all.enthalpy + concave_slope * (temperature - outer);
    (convex - concave, convex_slope - concave_slope)
}

#[cfg(test)]
mod tests;
