//! The exterior surfaces of the walls in a front: eliminated first, each onto the interior surface of its wall.
//!
//! With all laws as straight lines its balance holds for `T = offset + slope T_interior`. This is
//! [`surface_balance`](crate::linear::surface_balance) for many walls at once.

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::{BySide, SideId};
use crate::linear::surface_balance::SurfaceLaws;
use crate::linear::wall::Response;
use crate::number::line::Line;
use crate::number::real::{Chunk, Real};
use crate::physics::longwave::Emission;
use crate::weather::conditions::Conditions;

use super::laws::Laws;
use super::layout::{Elimination, Layout};

/// The exterior surfaces, by the place of the interior surface of their wall.
#[derive(Debug, Clone)]
pub(super) struct Exterior<S> {
    pub(super) laws: Laws<S>,
    /// Areas of the walls [m2].
    pub(super) wall_area: Vec<S>,
    pub(super) emissivity: Vec<S>,
    /// Whether a surface is at an imposed temperature, those of thick walls included.
    pub(super) fixed: Vec<bool>,
    /// Responses of the walls. By the temperature of the interior surface: the heat from it that stays in the wall, and with an
    /// imposed temperature behind it all that leaves it [W/K]; heat into the exterior surface [W/(m2 K)]. By that of the exterior
    /// surface: heat into the interior one [W/K]; all heat that leaves it, infinite where its temperature is imposed, and what of
    /// it stays in the wall [W/(m2 K)].
    pub(super) responses: [Vec<S>; 5],
    /// Heat from sun, sky and ground and from the wall at surfaces of 0 degC [W/m2].
    pub(super) heat: Vec<S>,
    /// Heat into the interior surface of each window [W] and into its exterior one [W/m2], without that from the window.
    beside_windows: [Vec<S>; 2],
    /// Imposed temperature, else zero [degC].
    imposed: Vec<S>,
    /// Rise of the surface with heat, the interior surface held [m2 K/W]; zero where its temperature is imposed.
    inverse: Vec<S>,
    /// The surface's temperature as a line of the interior one's: offset [degC] and slope [-].
    line: [Vec<S>; 2],
}

impl<S: Real> Exterior<S> {
    /// The exterior surfaces of a front, with their constant laws.
    pub(super) fn new(numbers: &Coefficients<S>, laws: &BySide<SurfaceLaws<S>>, layout: &Layout) -> Self {
        let opposite = layout.walls.iter().map(|surface| surface.opposite());
        let surfaces: Vec<SideId> = opposite.take(layout.exterior).collect();
        let of = |surface: SideId| &numbers.surfaces[surface];
        let mut laws = Laws::new(&surfaces, layout.stride, laws);
        laws.sort(
            numbers,
            |surface| !matches!(of(surface).boundary, Boundary::Adiabatic),
            |surface| {
                matches!(&of(surface).boundary, Boundary::Outdoors(outdoors)
                    if matches!(outdoors.emission, Some(Emission::Exact)))
            },
        );
        let mut all = Self::blank(laws, layout.stride);
        all.beside_windows = [(); 2].map(|()| vec![S::zero(); layout.windows]);
        for (i, &surface) in surfaces.iter().enumerate() {
            (all.wall_area[i], all.emissivity[i]) =
                (numbers.walls[surface.wall()].area, of(surface).emissivity);
            let imposed = matches!(of(surface).boundary, Boundary::Imposed(_));
            all.fixed.push(imposed && of(surface).convection.is_none());
        }
        for (area, surface) in all.wall_area.iter_mut().zip(&layout.walls).skip(layout.exterior) {
            *area = numbers.walls[surface.wall()].area;
            all.fixed.push(true);
        }
        all
    }

    /// Surfaces that have nothing but their laws.
    pub(super) fn blank(laws: Laws<S>, stride: usize) -> Self {
        let zeros = || vec![S::zero(); stride];
        Self {
            laws,
            wall_area: zeros(),
            emissivity: zeros(),
            fixed: Vec::new(),
            // Places without a wall are not divided by zero.
            responses: [zeros(), zeros(), zeros(), vec![S::one(); stride], zeros()],
            heat: zeros(),
            beside_windows: [Vec::new(), Vec::new()],
            imposed: zeros(),
            inverse: zeros(),
            line: [zeros(), zeros()],
        }
    }

    /// Sets the responses of the walls.
    pub(super) fn set_responses(&mut self, layout: &Layout, responses: &[Response<S>]) {
        for (i, interior) in layout.walls.iter().enumerate() {
            self.set_response(i, interior.side(), &responses[interior.wall()], self.fixed[i]);
        }
    }

    /// Sets the response of the wall at a place; e is its interior surface.
    #[inline(always)]
    pub(super) fn set_response(&mut self, i: usize, e: usize, response: &Response<S>, fixed: bool) {
        let (o, area) = (1 - e, self.wall_area[i]);
        let (to_exterior, to_interior) = (response.other(o), area * response.other(e));
        let all = if fixed {
            // One over an infinite sum is zero: an imposed temperature does not rise.
            let infinite = S::constant(f64::INFINITY);
            [-(area * response.own(e)), to_exterior, to_interior, infinite, S::zero()]
        } else {
            let (stays, leaves) = (area * response.stored[e], -response.own(o));
            [stays, to_exterior, to_interior, leaves, response.stored[o]]
        };
        for (mine, response) in self.responses.iter_mut().zip(all) {
            mine[i] = response;
        }
    }

    /// Reads what drives a stage; adds the heat of the walls to that into the interior surfaces [W], except that of windows.
    #[inline(always)]
    pub(super) fn begin(
        &mut self,
        layout: &Layout,
        conditions: &Conditions<S>,
        sources: &[[S; 2]],
        interior_heat: &mut [S],
    ) {
        self.laws.set_wind(conditions);
        let windows = layout.window_places();
        if !windows.is_empty() {
            self.beside_windows[0].copy_from_slice(&interior_heat[windows.clone()]);
        }
        // In the order of the surfaces.
        let sources = sources.as_flattened();
        for ((heat, &area), interior) in interior_heat.iter_mut().zip(&self.wall_area).zip(&layout.walls) {
            *heat += area * sources[interior.index()];
        }
        let numbers =
            self.heat.iter_mut().zip(&mut self.laws.air).zip(self.imposed.iter_mut().zip(&self.fixed));
        for (interior, ((heat, air), (imposed, &fixed))) in layout.walls[..windows.end].iter().zip(numbers) {
            let exterior = interior.opposite();
            let at = &conditions.surfaces[exterior];
            *heat = sources[exterior.index()] + (at.solar + at.longwave);
            *air = at.temperature;
            if fixed {
                *imposed = at.temperature;
            }
        }
        for (beside, window) in self.beside_windows[1].iter_mut().zip(&layout.walls[windows]) {
            let at = &conditions.surfaces[window.opposite()];
            *beside = at.solar + at.longwave;
        }
    }

    /// Takes over how windows at some places respond to their surfaces, and their heat into them, in an iteration.
    #[inline(always)]
    pub(super) fn set_windows(
        &mut self,
        (layout, places): (&Layout, &[usize]),
        (sources, responses): (&[[S; 2]], &[Response<S>]),
        interior_heat: &mut [S],
    ) {
        for &i in places {
            let (interior, k) = (layout.walls[i], i - layout.window_places().start);
            let (window, e) = (interior.wall(), interior.side());
            self.set_response(i, e, &responses[window], self.fixed[i]);
            interior_heat[i] = self.beside_windows[0][k] + self.wall_area[i] * sources[window][e];
            self.heat[i] = sources[window][1 - e] + self.beside_windows[1][k];
        }
    }

    /// The same for the windows of one register, which store nothing: heat into the other surface by the outside and by the inside
    /// surface [W/(m2 K)], and into both of 0 degC [W/m2].
    #[inline(always)]
    pub(super) fn set_window_register<V: Chunk<S>>(
        &mut self,
        layout: &Layout,
        start: usize,
        ([by_outside, by_inside], sources): ([V; 2], [V; 2]),
        interior_heat: &mut [S],
    ) {
        let (k, area): (_, V) = (start - layout.window_places().start, part!(self.wall_area, start));
        let responses = [V::zero(), by_inside, area * by_outside, by_outside, V::zero()];
        for (mine, response) in self.responses.iter_mut().zip(responses) {
            response.store(&mut mine[start..start + S::CHUNK]);
        }
        let inside = part!(self.beside_windows[0], k) + area * sources[1];
        inside.store(&mut interior_heat[start..start + S::CHUNK]);
        let outside = sources[0] + part!(self.beside_windows[1], k);
        outside.store(&mut self.heat[start..start + S::CHUNK]);
    }

    /// Holds the other surfaces of thick walls at the temperatures of an iterate.
    #[inline(always)]
    pub(super) fn hold_thick(&mut self, layout: &Layout, temperatures: &[S]) {
        for (imposed, surface) in self.imposed.iter_mut().zip(&layout.walls).skip(layout.exterior) {
            *imposed = temperatures[surface.opposite().index()];
        }
    }

    /// Eliminates the surfaces of one register: heat into the interior surfaces by their own temperature [W/K] and at 0 degC
    /// [W], the former only with a matrix.
    #[inline(always)]
    pub(super) fn eliminate<V: Chunk<S>>(&mut self, elimination: Elimination, start: usize) -> (V, V) {
        let places = start..start + S::CHUNK;
        let (convection, emission): (Line<V>, Line<V>) =
            (self.laws.convection_at(start), self.laws.emission_at(start));
        let air: V = part!(self.laws.air, start);
        let to_interior: V = part!(self.responses[2], start);
        let emissivity: V = part!(self.emissivity, start);
        let mut gain = V::zero();
        if elimination == Elimination::Full {
            let slope = convection.slope + emissivity * emission.slope;
            let inverse = V::one() / (slope + part!(self.responses[3], start));
            let rise = part!(self.responses[1], start) * inverse;
            // Heat that leaves the interior surface and does not come back: stored, or lost by the exterior one. A sum, as in
            // `tridiagonal`; the difference of the conductances would lose digits behind a good conductor.
            let lost: V = part!(self.wall_area, start) * rise * (slope + part!(self.responses[4], start));
            gain = -(part!(self.responses[0], start) + lost);
            inverse.store(&mut self.inverse[places.clone()]);
            rise.store(&mut self.line[1][places.clone()]);
        }
        let heat = part!(self.heat, start) + convection.slope * air
            - convection.offset
            - emissivity * emission.offset;
        let offset = part!(self.imposed, start) + heat * part!(self.inverse, start);
        offset.store(&mut self.line[0][places]);
        (gain, to_interior * offset)
    }

    /// Temperatures of the surfaces of one register from those of the interior surfaces.
    #[inline(always)]
    pub(super) fn temperatures<V: Chunk<S>>(&self, interior: V, start: usize) -> V {
        part!(self.line[0], start) + part!(self.line[1], start) * interior
    }

    /// A surface as a line of the interior one [degC], and its rise with heat [m2 K/W].
    pub(super) fn line_at(&self, i: usize) -> (Line<S>, S) {
        (Line { offset: self.line[0][i], slope: self.line[1][i] }, self.inverse[i])
    }
}
