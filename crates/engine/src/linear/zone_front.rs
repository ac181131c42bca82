//! The surfaces of walls of constant properties that lie in one zone, eliminated together with those of their zone.
//!
//! The other surface of such a wall is in no zone: it is eliminated first, by itself. What is then left of a zone is a dense
//! front: its own surfaces, the surfaces that it shares with the rest of the building (of walls that change, or that lie
//! between zones), its air, and the right-hand side as one more column. The own surfaces are eliminated, and what is left
//! goes to the [`CoupledSystem`].
//!
//! The unknowns of a front are what its surfaces emit, along the tangent of their law, `E = offset + slope T`, and the
//! temperature of its air. Between surfaces stand the exchange areas then, which never change and are symmetric: nothing is
//! assembled but the diagonal, and half of the elimination is spared. A zone without exchange has `E = T`.
//!
//! Numbers stand by their place in the front, so that neighbours are computed together: [`Abreast`].

use crate::building::coefficients::{Boundary, Coefficients};
use crate::building::ids::{BySurface, SurfaceId};
use crate::building::plan::{Plan, SurfaceRole};
use crate::linear::coupled::CoupledSystem;
use crate::linear::surface_balance::{ExteriorSurfaces, SurfaceLaws};
use crate::number::line::Line;
use crate::number::real::{Abreast, Real, Task};
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;
use crate::step::state::Unknowns;
use crate::weather::conditions::Conditions;

/// Does something for every number below 16, each known to the compiler.
macro_rules! each {
    ($k:ident, $label:lifetime: $body:block) => {
        each!(@ $k, $label: $body; 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    (@ $k:ident, $label:lifetime: $body:block; $($number:literal)*) => {
        $label: { $({ const $k: usize = $number; $body })* }
    };
}

/// The part of a line that begins at a place and fills a register.
macro_rules! part {
    ($line:expr, $start:expr) => {
        V::load(&$line[$start..$start + S::SIDE])
    };
}

/// Surfaces side by side that follow the same correlation.
#[derive(Debug, Clone)]
struct Group<S> {
    /// Place of the first.
    start: usize,
    convection: SurfaceConvection<Box<[S]>>,
    /// Convective area over plane area.
    factor: Box<[S]>,
    /// One for those that belong to it, else zero.
    members: Box<[S]>,
}

/// The laws of surfaces.
#[derive(Debug, Clone)]
struct Laws<S> {
    /// Indices of the surfaces, and as many more as fill the last register.
    places: Vec<usize>,
    count: usize,
    /// Convection off each surface, of its difference to the air, and black emission, of its temperature: offset and slope.
    convection: [Vec<S>; 2],
    emission: [Vec<S>; 2],
    forced: [Vec<S>; 2],
    /// The air that they meet.
    air: Vec<S>,
    /// Films that follow the wind alone: place, convective area over plane area.
    windy: Vec<(usize, S)>,
    bent: Vec<Group<S>>,
    /// Surfaces that radiate with the fourth power of their temperature: place of the first of a register, one for those that
    /// do, else zero.
    radiant: Vec<(usize, Box<[S]>)>,
}

/// A zone.
#[derive(Debug, Clone)]
struct ZoneFront<S> {
    /// Surfaces, the own ones first, and how many these are; the air is behind them, then the right-hand side.
    inner: Laws<S>,
    own: usize,
    /// Numbers in a row.
    stride: usize,
    /// Row of the first own surface in the room block, and those of the shared surfaces and the air.
    first_row: usize,
    shared: Vec<usize>,
    /// Areas and shares of radiant gains.
    area: Vec<S>,
    share: Vec<S>,
    /// What surfaces lose by their own emission and gain by that of others [m2]; symmetric.
    exchange: Vec<S>,
    /// One for own surfaces, else zero; then over the slope of their emission.
    mine: Vec<S>,
    unslope: Vec<S>,
    /// Walls of the own surfaces: the other surface, which side is in the zone, area.
    outer: Laws<S>,
    walls: Vec<(usize, usize)>,
    wall_area: Vec<S>,
    /// Of the other surface.
    emissivity: Vec<S>,
    /// Whether it is held at its temperature.
    fixed: Vec<bool>,
    /// How the wall answers: heat into the own surface by its temperature and that of the other one [W/K], heat into the
    /// other one likewise [W/(m2 K)].
    responses: [Vec<S>; 4],
    /// What acts on the own surface [W] and on the other one [W/m2], and the temperature that this one is held at.
    base: Vec<S>,
    enters: Vec<S>,
    held: Vec<S>,
    /// What a watt does to the other surface; its temperature is a line of the own one's.
    inverse: Vec<S>,
    outside: [Vec<S>; 2],
    /// Convection to the air by temperature and by emission, what it has beside that, diagonal, right-hand side.
    to_air: Vec<S>,
    by_emission: Vec<S>,
    from_convection: Vec<S>,
    diagonal: Vec<S>,
    right: Vec<S>,
    /// The front, eliminated: what is right of each pivot, then the rows of shared surfaces and air.
    rows: Vec<S>,
    /// Inverses of the pivots, and what stood below them in the row of the air.
    pivots: Vec<S>,
    below: Vec<S>,
    /// Where the matrix stays: by own surface, the own surfaces' answer to its right-hand side, and what it leaves to the
    /// shared unknowns; by shared unknown, the own surfaces' answer.
    answers: Vec<S>,
    shares: Vec<S>,
    /// Answers to the right-hand sides in hand; scratch.
    answer: Vec<S>,
}

/// All zones.
// What it does is not inlined where it is asked for, for the compiler's sake: it is large.
#[derive(Debug, Clone)]
pub(crate) struct ZoneFronts<S> {
    zone_fronts: Vec<ZoneFront<S>>,
}

/// What is to be done with all zones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Front {
    /// Assembled, and eliminated with its right-hand side.
    Whole,
    /// The right-hand side alone: the matrix stays as it was when answers were found.
    Right,
}

impl<S: Real> Laws<S> {
    fn new(surfaces: &[SurfaceId], stride: usize, laws: &BySurface<SurfaceLaws<S>>) -> Self {
        let zeros = || vec![S::zero(); stride];
        let count = surfaces.len();
        let mut all = Self {
            places: surfaces.iter().map(|surface| surface.index()).collect(),
            count,
            convection: [zeros(), zeros()],
            emission: [zeros(), zeros()],
            forced: [zeros(), zeros()],
            air: zeros(),
            windy: Vec::new(),
            bent: Vec::new(),
            radiant: Vec::new(),
        };
        for (i, &surface) in surfaces.iter().enumerate() {
            [all.convection[0][i], all.convection[1][i]] =
                [laws[surface].convection.offset, laws[surface].convection.slope];
            [all.emission[0][i], all.emission[1][i]] =
                [laws[surface].emission.offset, laws[surface].emission.slope];
        }
        all.places.resize(count.next_multiple_of(S::SIDE), all.places.first().copied().unwrap_or(0));
        all
    }

    /// The surfaces, without those that fill the last register.
    #[inline(always)]
    fn surfaces(&self) -> impl Iterator<Item = SurfaceId> + '_ {
        self.places[..self.count].iter().map(
            #[inline(always)]
            |&place| SurfaceId::from_index(place),
        )
    }

    /// Sorts the films that change, and the surfaces that radiate with the fourth power. A surface has no law where none acts.
    fn sort(
        &mut self,
        numbers: &Coefficients<S>,
        acts: impl Fn(SurfaceId) -> bool,
        radiates: impl Fn(SurfaceId) -> bool,
    ) {
        let convection =
            |surface: SurfaceId| numbers.surfaces[surface].convection.as_ref().filter(|_| acts(surface));
        for i in 0..self.count {
            let surface = SurfaceId::from_index(self.places[i]);
            if convection(surface)
                .is_some_and(|convection| convection.constant().is_none() && convection.straight())
            {
                self.windy.push((i, numbers.surfaces[surface].area_factor));
            }
            if !acts(surface) {
                (self.convection[0][i], self.convection[1][i]) = (S::zero(), S::zero());
            }
        }
        let bent = |surface: SurfaceId| convection(surface).filter(|convection| !convection.straight());
        let flags = |surfaces: &[SurfaceId], start: usize, member: &dyn Fn(SurfaceId) -> bool| -> Box<[S]> {
            let flag = |member: bool| if member { S::one() } else { S::zero() };
            let places = surfaces.iter().enumerate();
            places.map(|(i, &surface)| flag(start + i < self.count && member(surface))).collect()
        };
        let (mut groups, mut radiant) = (Vec::new(), Vec::new());
        let padded: Vec<_> = self.places.iter().map(|&place| SurfaceId::from_index(place)).collect();
        for (chunk, surfaces) in padded.chunks(S::SIDE).enumerate() {
            let start = chunk * S::SIDE;
            let mut kinds: Vec<&SurfaceConvection<S>> = Vec::new();
            for &surface in surfaces {
                if let Some(convection) =
                    bent(surface).filter(|convection| !kinds.iter().any(|kind| kind.alike(convection)))
                {
                    kinds.push(convection);
                }
            }
            let group = |kind: &&SurfaceConvection<S>| {
                let member =
                    |surface: SurfaceId| bent(surface).is_some_and(|convection| kind.alike(convection));
                // Another place computes what the first of the kind would, and it is thrown away.
                let convection = |&surface: &SurfaceId| {
                    bent(surface).filter(|convection| kind.alike(convection)).unwrap_or(kind)
                };
                let convections: Vec<_> = surfaces.iter().map(convection).collect();
                Group {
                    start,
                    convection: SurfaceConvection::together(&convections),
                    factor: surfaces.iter().map(|&surface| numbers.surfaces[surface].area_factor).collect(),
                    members: flags(surfaces, start, &member),
                }
            };
            groups.extend(kinds.iter().map(group));
            if surfaces.iter().any(|&surface| radiates(surface)) {
                radiant.push((start, flags(surfaces, start, &|surface| radiates(surface))));
            }
        }
        (self.bent, self.radiant) = (groups, radiant);
    }

    /// Takes over what the wind makes of films.
    #[inline(always)]
    fn blow(&mut self, conditions: &Conditions<S>) {
        let [first, second] = &mut self.forced;
        for ((&place, first), second) in self.places[..self.count].iter().zip(first).zip(second) {
            [*first, *second] = conditions.surfaces[SurfaceId::from_index(place)].forced;
        }
        for &(i, factor) in &self.windy {
            self.convection[1][i] = self.forced[0][i] * factor;
        }
    }

    /// Tangents at the temperatures of an iterate.
    #[inline(always)]
    fn bend<V: Abreast<S>>(&mut self, temperatures: &[S]) {
        let half = V::constant(0.5);
        for group in &self.bent {
            let start = group.start;
            let temperature = V::pick(temperatures, &self.places[start..start + S::SIDE]);
            let difference = temperature - part!(self.air, start);
            let forced = [part!(self.forced[0], start), part!(self.forced[1], start)];
            let flux = group.convection.flux_of(
                #[inline(always)]
                |numbers| V::load(numbers),
                difference,
                &forced,
            );
            let factor = V::load(&group.factor);
            let line = Line::tangent(flux.flux * factor, flux.slope * factor, difference);
            let members = half.lt(V::load(&group.members));
            line.store(members, &mut self.convection, start);
        }
        for (start, members) in &self.radiant {
            let temperature = V::pick(temperatures, &self.places[*start..*start + S::SIDE]);
            let (value, slope) = Emission::Exact.at(temperature);
            let line = Line::tangent(value, slope, temperature);
            line.store(half.lt(V::load(members)), &mut self.emission, *start);
        }
    }
}

impl<V: Real> Line<V> {
    /// To offsets and slopes from a place on, where a flag is set.
    #[inline(always)]
    fn store<S: Real>(self, flag: V::Mask, lines: &mut [Vec<S>; 2], start: usize)
    where
        V: Abreast<S>,
    {
        let [offset, slope] = lines;
        for (line, new) in [(offset, self.offset), (slope, self.slope)] {
            let numbers = &mut line[start..start + S::SIDE];
            let new = if S::SIDE == 1 { new } else { V::select(flag, new, V::load(numbers)) };
            new.store(numbers);
        }
    }
}

impl<S: Real> ZoneFront<S> {
    fn new(plan: &Plan, numbers: &Coefficients<S>, laws: &BySurface<SurfaceLaws<S>>, zone: usize) -> Self {
        let (of_plan, of_zone) = (&plan.zones[zone], &numbers.zones[zone]);
        let mut order: Vec<usize> = (0..of_plan.surfaces.len()).collect();
        order.sort_by_key(|&i| of_plan.surface_rows[i]);
        let own = order.iter().filter(|&&i| of_plan.surface_rows[i] < plan.own_rows).count();
        let surfaces: Vec<SurfaceId> = order.iter().map(|&i| of_plan.surfaces[i]).collect();
        let stride = (surfaces.len() + 2).next_multiple_of(S::SIDE);
        let mut inner = Laws::new(&surfaces, stride, laws);
        let exact = matches!(of_zone.emission, Emission::Exact) && !of_zone.exchange.is_empty();
        inner.sort(numbers, |_| true, |_| exact);
        // In straight lines all surfaces emit alike: their offset does nothing.
        inner.emission[0].fill(S::zero());
        if of_zone.exchange.is_empty() {
            inner.emission[1].fill(S::one());
        }
        inner.emission[1][surfaces.len()..].fill(S::one());
        let outside: Vec<SurfaceId> = surfaces[..own].iter().map(|surface| surface.opposite()).collect();
        let mut outer = Laws::new(&outside, stride, laws);
        let of = |surface: SurfaceId| &numbers.surfaces[surface];
        outer.sort(
            numbers,
            |surface| !matches!(of(surface).boundary, Boundary::Adiabatic),
            |surface| {
                matches!(&of(surface).boundary, Boundary::Outdoors(outdoors)
                    if matches!(outdoors.emission, Some(Emission::Exact)))
            },
        );
        let fixed = |&surface: &SurfaceId| {
            matches!(of(surface).boundary, Boundary::Imposed(_)) && of(surface).convection.is_none()
        };
        let mut room = Self::blank(inner, outer, stride);
        room.first_row = order.first().map_or(0, |&i| of_plan.surface_rows[i]);
        room.shared =
            order[own..].iter().map(|&i| of_plan.surface_rows[i]).chain([of_plan.air_row]).collect();
        room.walls = surfaces[..own].iter().map(|&surface| (surface.wall(), surface.side())).collect();
        room.fixed = outside.iter().map(fixed).collect();
        for (i, &k) in order.iter().enumerate() {
            (room.area[i], room.share[i]) = (of_zone.areas[k], of_zone.radiant_shares[k]);
        }
        for (i, &surface) in outside.iter().enumerate() {
            (room.wall_area[i], room.emissivity[i]) =
                (numbers.walls[surface.wall()].area, of(surface).emissivity);
        }
        if exact {
            // What bends has no slope yet.
            room.unslope.fill(S::zero());
        }
        if !of_zone.exchange.is_empty() {
            let n = surfaces.len();
            for (i, &a) in order.iter().enumerate() {
                for (j, &b) in order.iter().enumerate() {
                    let area = if a == b { of_zone.exchange_sums[a] } else { -of_zone.exchange[a * n + b] };
                    room.exchange[i * stride + j] = area;
                }
            }
        }
        room
    }

    /// A zone of which nothing is known but its laws.
    fn blank(inner: Laws<S>, outer: Laws<S>, stride: usize) -> Self {
        let zeros = || vec![S::zero(); stride];
        let square = || vec![S::zero(); stride * stride];
        let own = outer.count;
        let mut mine = zeros();
        mine[..own].fill(S::one());
        Self {
            own,
            stride,
            first_row: 0,
            shared: Vec::new(),
            area: zeros(),
            share: zeros(),
            exchange: square(),
            unslope: mine.iter().zip(&inner.emission[1]).map(|(&mine, &slope)| mine / slope).collect(),
            mine,
            walls: Vec::new(),
            wall_area: zeros(),
            emissivity: zeros(),
            fixed: Vec::new(),
            inner,
            outer,
            // Where there is no wall nothing is divided by zero.
            responses: [zeros(), zeros(), zeros(), vec![-S::one(); stride]],
            base: zeros(),
            enters: zeros(),
            held: zeros(),
            inverse: zeros(),
            outside: [zeros(), zeros()],
            to_air: zeros(),
            by_emission: zeros(),
            from_convection: zeros(),
            diagonal: zeros(),
            right: zeros(),
            rows: square(),
            pivots: zeros(),
            below: zeros(),
            answers: square(),
            shares: square(),
            answer: zeros(),
        }
    }

    /// Number of surfaces; the air's place.
    #[inline(always)]
    fn surfaces(&self) -> usize {
        self.inner.count
    }

    /// Takes over how the walls answer.
    fn respond(&mut self, responses: &[[[S; 2]; 2]]) {
        for (i, &(w, e)) in self.walls.iter().enumerate() {
            let (response, area, o) = (responses[w], self.wall_area[i], 1 - e);
            let other = if self.fixed[i] { S::constant(f64::NEG_INFINITY) } else { response[o][o] };
            let all = [area * response[e][e], area * response[e][o], response[o][e], other];
            for (mine, response) in self.responses.iter_mut().zip(all) {
                mine[i] = response;
            }
        }
    }

    /// Takes over what drives a stage.
    #[inline(always)]
    fn begin(&mut self, conditions: &Conditions<S>, radiant: S, sources: &[[S; 2]]) {
        self.inner.blow(conditions);
        self.outer.blow(conditions);
        let surfaces = self.inner.surfaces().zip(&self.area).zip(&self.share);
        for (base, ((surface, &area), &share)) in self.base.iter_mut().zip(surfaces) {
            *base = area * conditions.surfaces[surface].solar + radiant * share;
        }
        for (i, (&(w, e), &place)) in self.walls.iter().zip(&self.outer.places).enumerate() {
            let at = &conditions.surfaces[SurfaceId::from_index(place)];
            self.base[i] += self.wall_area[i] * sources[w][e];
            self.enters[i] = sources[w][1 - e] + (at.solar + at.longwave);
            self.outer.air[i] = at.temperature;
            if self.fixed[i] {
                self.held[i] = at.temperature;
            }
        }
    }

    /// Eliminates the other surfaces of the walls, and sums up what acts on the surfaces in the zone.
    #[inline(always)]
    fn gather<V: Abreast<S>>(&mut self, front: Front) {
        let surfaces = self.surfaces();
        for start in (0..surfaces).step_by(S::SIDE) {
            let places = start..start + S::SIDE;
            let (mut gain, mut right) = (V::zero(), part!(self.base, start));
            if start < self.own {
                let there = part!(self.outer.air, start);
                let convection = Line {
                    offset: part!(self.outer.convection[0], start),
                    slope: part!(self.outer.convection[1], start),
                };
                let [emission, slope] = &self.outer.emission;
                let emission: Line<V> = Line { offset: part!(emission, start), slope: part!(slope, start) };
                let to_own = part!(self.responses[1], start);
                let emissivity = part!(self.emissivity, start);
                if front == Front::Whole {
                    let slope = convection.slope + emissivity * emission.slope;
                    let inverse = V::one() / (slope - part!(self.responses[3], start));
                    let give = part!(self.responses[2], start) * inverse;
                    gain = part!(self.responses[0], start) + to_own * give;
                    inverse.store(&mut self.inverse[places.clone()]);
                    give.store(&mut self.outside[1][places.clone()]);
                }
                let enters = part!(self.enters, start) + convection.slope * there
                    - convection.offset
                    - emissivity * emission.offset;
                let offset = part!(self.held, start) + enters * part!(self.inverse, start);
                offset.store(&mut self.outside[0][places.clone()]);
                right += to_own * offset;
            }
            let convection: Line<V> = Line {
                offset: part!(self.inner.convection[0], start),
                slope: part!(self.inner.convection[1], start),
            };
            let area = part!(self.area, start);
            let mut from_convection = area * convection.offset;
            right = right - from_convection;
            if front == Front::Whole {
                let to_air = area * convection.slope;
                let bends = !self.inner.radiant.is_empty();
                if bends {
                    let slope: V = part!(self.inner.emission[1], start);
                    (part!(self.mine, start) / slope).store(&mut self.unslope[places.clone()]);
                }
                let unslope = part!(self.unslope, start);
                let diagonal = (to_air - gain) * unslope;
                let by_emission = to_air * unslope;
                if bends {
                    let offset: V = part!(self.inner.emission[0], start);
                    right += diagonal * offset;
                    from_convection = from_convection - by_emission * offset;
                }
                to_air.store(&mut self.to_air[places.clone()]);
                by_emission.store(&mut self.by_emission[places.clone()]);
                diagonal.store(&mut self.diagonal[places.clone()]);
            }
            from_convection.store(&mut self.from_convection[places.clone()]);
            right.store(&mut self.right[places]);
        }
        self.right[surfaces] = total(&self.from_convection[..surfaces]);
        if front == Front::Whole {
            self.diagonal[surfaces] = total(&self.to_air[..self.own]);
        }
    }

    /// Eliminates the own surfaces, rows in registers.
    #[allow(clippy::absurd_extreme_comparisons, reason = "only the first number is the smallest")]
    #[inline(always)]
    fn eliminate<V: Abreast<S>, const C: usize>(&mut self) {
        let (surfaces, own, stride) = (self.surfaces(), self.own, C * S::SIDE);
        let (exchange, rows) = (&self.exchange[..stride * stride], &mut self.rows[..stride * stride]);
        let (diagonal, right) = (&self.diagonal[..stride], &self.right[..stride]);
        let (by_air, pivots, below) =
            (&self.to_air[..stride], &mut self.pivots[..stride], &mut self.below[..stride]);
        let mut air: [V; C] = load_row(&self.by_emission, 0);
        for entry in &mut air {
            *entry = -*entry;
        }
        enter(&mut air, surfaces, diagonal[surfaces]);
        enter(&mut air, surfaces + 1, right[surfaces]);
        each!(I, 'rows: {
            if const { I + 1 >= C * S::SIDE } {
                break 'rows;
            }
            if I >= surfaces {
                break 'rows;
            }
            let first = I / S::SIDE;
            let mut row: [V; C] = load_row(&exchange[I * stride..], first);
            if I < own {
                row[first] += V::alone(diagonal[I], I % S::SIDE);
                enter(&mut row, surfaces, -by_air[I]);
                enter(&mut row, surfaces + 1, right[I]);
            }
            let last = if I < own { I } else { own };
            for (above, &inverse) in rows.chunks_exact(stride).zip(&*pivots).take(last) {
                let factor = V::everywhere(above[I] * inverse);
                for c in first..C {
                    row[c] = row[c] - factor * V::load(&above[c * S::SIDE..(c + 1) * S::SIDE]);
                }
            }
            for c in first..C {
                row[c].store(&mut rows[I * stride + c * S::SIDE..][..S::SIDE]);
            }
            if I < own {
                let inverse = S::one() / row[first].spread(I % S::SIDE).first();
                pivots[I] = inverse;
                let entry = air[first].spread(I % S::SIDE);
                below[I] = entry.first();
                let factor = entry * V::everywhere(inverse);
                for c in first..C {
                    air[c] = air[c] - factor * row[c];
                }
            }
        });
        for (&entry, numbers) in air.iter().zip(rows[surfaces * stride..].chunks_exact_mut(S::SIDE)) {
            entry.store(numbers);
        }
    }

    /// The same for a front of any size.
    #[inline(always)]
    fn eliminate_long(&mut self) {
        let (surfaces, own, stride) = (self.surfaces(), self.own, self.stride);
        let (rows, air) = self.rows.split_at_mut(surfaces * stride);
        for (entry, &by_emission) in air.iter_mut().zip(&self.by_emission) {
            *entry = -by_emission;
        }
        air[surfaces] = self.diagonal[surfaces];
        air[surfaces + 1] = self.right[surfaces];
        for i in 0..surfaces {
            let (above, row) = rows.split_at_mut(i * stride);
            let row = &mut row[..stride];
            row.copy_from_slice(&self.exchange[i * stride..(i + 1) * stride]);
            if i < own {
                row[i] += self.diagonal[i];
                row[surfaces] = -self.to_air[i];
                row[surfaces + 1] = self.right[i];
            }
            for (above, &inverse) in above.chunks_exact(stride).zip(&self.pivots).take(own) {
                let factor = above[i] * inverse;
                for (entry, &above) in row[i..surfaces + 2].iter_mut().zip(&above[i..]) {
                    *entry = *entry - factor * above;
                }
            }
            if i < own {
                self.pivots[i] = S::one() / row[i];
                self.below[i] = air[i];
                let factor = air[i] * self.pivots[i];
                for (entry, &row) in air[i + 1..surfaces + 2].iter_mut().zip(&row[i + 1..]) {
                    *entry = *entry - factor * row;
                }
            }
        }
    }

    /// Assembles the front and eliminates the own surfaces.
    #[inline(always)]
    fn factor<V: Abreast<S>>(&mut self) {
        // A constant: the compiler is spared the fixed sizes.
        if const { !S::REGISTERS } {
            return self.eliminate_long();
        }
        let chunks = self.stride / S::SIDE;
        if const { S::SIDE > 1 } {
            return match chunks {
                1 => self.eliminate::<V, 1>(),
                2 => self.eliminate::<V, 2>(),
                _ => self.eliminate_long(),
            };
        }
        match chunks {
            2 => self.eliminate::<V, 2>(),
            3 => self.eliminate::<V, 3>(),
            4 => self.eliminate::<V, 4>(),
            5 => self.eliminate::<V, 5>(),
            6 => self.eliminate::<V, 6>(),
            7 => self.eliminate::<V, 7>(),
            8 => self.eliminate::<V, 8>(),
            9 => self.eliminate::<V, 9>(),
            10 => self.eliminate::<V, 10>(),
            11 => self.eliminate::<V, 11>(),
            12 => self.eliminate::<V, 12>(),
            _ => self.eliminate_long(),
        }
    }

    /// Finds the answers of a front whose matrix stays.
    #[cold]
    #[inline(never)]
    fn find_answers(&mut self) {
        let (surfaces, own, stride) = (self.surfaces(), self.own, self.stride);
        for j in 0..own {
            let mut line = vec![S::zero(); surfaces + 1];
            line[j] = S::one();
            self.forward(&mut line, |i| i);
            for (i, shared) in line.iter_mut().enumerate().skip(own) {
                // What a right-hand side leaves to the shared unknowns; their own answers are none.
                self.answers[j * stride + i] = *shared;
                *shared = S::zero();
            }
            self.back(&mut line, |i| i);
            self.answers[j * stride..j * stride + own].copy_from_slice(&line[..own]);
        }
        for shared in own..=surfaces {
            let mut line = vec![S::zero(); surfaces + 1];
            line[shared] = S::one();
            self.back(&mut line, |i| i);
            self.shares[shared * stride..shared * stride + own].copy_from_slice(&line[..own]);
        }
    }

    /// Values, whose places are given, through the elimination of the own surfaces.
    #[inline(always)]
    fn forward(&self, values: &mut [S], place: impl Fn(usize) -> usize) {
        let surfaces = self.surfaces();
        let rows = self.rows.chunks_exact(self.stride).zip(self.pivots.iter().zip(&self.below));
        for (k, (row, (&inverse, &below))) in rows.enumerate().take(self.own) {
            let known = values[place(k)] * inverse;
            for (i, &entry) in row.iter().enumerate().take(surfaces).skip(k + 1) {
                let at = place(i);
                values[at] = values[at] - entry * known;
            }
            let at = place(surfaces);
            values[at] = values[at] - below * known;
        }
    }

    /// Temperatures of the own surfaces, from the last to the first, once the shared unknowns are known.
    #[inline(always)]
    fn back(&self, values: &mut [S], place: impl Fn(usize) -> usize) {
        let surfaces = self.surfaces();
        let rows = self.rows.chunks_exact(self.stride).zip(&self.pivots);
        for (k, (row, &inverse)) in rows.enumerate().take(self.own).rev() {
            let mut sum = values[place(k)] - row[surfaces] * values[place(surfaces)];
            let entries = row.iter().zip(&self.inner.emission[1]).enumerate();
            for (j, (&entry, &slope)) in entries.take(surfaces).skip(k + 1) {
                sum = sum - entry * (slope * values[place(j)]);
            }
            values[place(k)] = sum * inverse * self.unslope[k];
        }
    }

    /// Adds what the own surfaces leave to the room block.
    #[inline(always)]
    fn leave(&self, front: Front, stays: bool, block: &mut CoupledSystem<'_, S>) {
        let (surfaces, own) = (self.surfaces(), self.own);
        if stays {
            for (i, &row) in (own..).zip(&self.shared) {
                block.right[row] += self.right[i] + self.answer[i];
            }
        }
        if front == Front::Right {
            return;
        }
        let air_row = self.shared[surfaces - own];
        for (i, &row) in (own..).zip(&self.shared) {
            let mut right = self.entry(i, surfaces + 1);
            for (j, &column) in (own..surfaces).zip(&self.shared) {
                let entry = if i <= j || i == surfaces { self.entry(i, j) } else { self.entry(j, i) };
                block.add(row, column, entry * self.inner.emission[1][j]);
                right = right - entry * self.inner.emission[0][j];
            }
            block.add(row, air_row, self.entry(i, surfaces));
            if i < surfaces {
                block.couple(row, air_row, self.to_air[i]);
                right += self.right[i];
            }
            if !stays {
                block.right[row] += right;
            }
        }
    }

    #[inline(always)]
    fn entry(&self, i: usize, j: usize) -> S {
        self.rows[i * self.stride + j]
    }

    /// Place of an unknown of the front among all rows.
    #[inline(always)]
    fn row(&self, i: usize) -> usize {
        if i < self.own { self.first_row + i } else { self.shared[i - self.own] }
    }

    /// Answers to the right-hand side in hand, where the matrix stays.
    #[inline(always)]
    fn answer<V: Abreast<S>>(&mut self) {
        let (end, stride) = (self.surfaces() + 1, self.stride);
        for start in (0..end).step_by(S::SIDE) {
            let mut sum = V::zero();
            let lines = self.answers.chunks_exact(stride);
            for (line, &right) in lines.zip(&self.right).take(self.own) {
                sum += V::load(&line[start..start + S::SIDE]) * V::everywhere(right);
            }
            sum.store(&mut self.answer[start..start + S::SIDE]);
        }
    }

    /// Temperatures of the own surfaces and of the other surfaces of their walls, once the shared unknowns are known.
    #[inline(always)]
    fn resolve<V: Abreast<S>>(&mut self, stays: bool, block: &mut [S], solved: &mut [S]) {
        let (surfaces, own, stride) = (self.surfaces(), self.own, self.stride);
        if stays {
            for start in (0..own).step_by(S::SIDE) {
                let mut sum = V::load(&self.answer[start..start + S::SIDE]);
                for (line, &row) in self.shares[own * stride..].chunks_exact(stride).zip(&self.shared) {
                    sum += V::load(&line[start..start + S::SIDE]) * V::everywhere(block[row]);
                }
                sum.store(&mut self.right[start..start + S::SIDE]);
            }
        } else {
            let Self { answer, rows, pivots, shared, inner, .. } = self;
            for (i, (value, &row)) in answer[own..=surfaces].iter_mut().zip(&*shared).enumerate() {
                let (offset, slope) = (inner.emission[0][own + i], inner.emission[1][own + i]);
                *value = if own + i == surfaces { block[row] } else { offset + slope * block[row] };
            }
            for (k, (row, &inverse)) in rows.chunks_exact(stride).zip(&*pivots).enumerate().take(own).rev() {
                // The one that is known last comes last.
                let mut sum = row[surfaces + 1];
                for (&entry, &value) in row[k + 1..=surfaces].iter().zip(&answer[k + 1..=surfaces]).rev() {
                    sum = sum - entry * value;
                }
                answer[k] = sum * inverse;
            }
            for start in (0..own).step_by(S::SIDE) {
                let places = start..start + S::SIDE;
                let temperature =
                    (part!(answer, start) - part!(inner.emission[0], start)) * part!(self.unslope, start);
                temperature.store(&mut self.right[places]);
            }
        }
        block[self.first_row..self.first_row + own].copy_from_slice(&self.right[..own]);
        self.spread::<V>(solved);
    }

    /// The own surfaces in hand, and the other surfaces of their walls, to where all surfaces are.
    #[inline(always)]
    fn spread<V: Abreast<S>>(&mut self, solved: &mut [S]) {
        for start in (0..self.own).step_by(S::SIDE) {
            let places = start..start + S::SIDE;
            let other =
                part!(self.outside[0], start) + part!(self.outside[1], start) * part!(self.right, start);
            other.store(&mut self.answer[places]);
        }
        for ((&(w, e), &own), &other) in self.walls.iter().zip(&self.right).zip(&self.answer) {
            let surface = SurfaceId::new(w, e);
            (solved[surface.index()], solved[surface.opposite().index()]) = (own, other);
        }
    }
}

#[inline(always)]
fn total<S: Real>(numbers: &[S]) -> S {
    let mut sum = S::zero();
    for &number in numbers {
        sum += number;
    }
    sum
}

/// A row from some register on, zeros before.
#[inline(always)]
fn load_row<S: Real, V: Abreast<S>, const C: usize>(numbers: &[S], first: usize) -> [V; C] {
    let numbers = &numbers[..C * S::SIDE];
    let mut row = [V::zero(); C];
    for c in first..C {
        row[c] = V::load(&numbers[c * S::SIDE..(c + 1) * S::SIDE]);
    }
    row
}

/// Adds a number to a row at a column.
#[inline(always)]
fn enter<S: Real, V: Abreast<S>, const C: usize>(row: &mut [V; C], column: usize, value: S) {
    let value = V::alone(value, column % S::SIDE);
    for (c, entry) in row.iter_mut().enumerate() {
        if c == column / S::SIDE {
            *entry += value;
        }
    }
}

/// Elimination of all own surfaces.
struct Eliminate<'r, S: Real> {
    zone_fronts: &'r mut [ZoneFront<S>],
    iterate: Option<&'r Unknowns<S>>,
    front: Front,
    stays: bool,
}

impl<S: Real> Task<S> for Eliminate<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Abreast<S>>(self) {
        for (zone, room) in self.zone_fronts.iter_mut().enumerate() {
            if let Some(iterate) = self.iterate {
                if !room.inner.bent.is_empty() {
                    room.inner.air.fill(iterate.air[zone]);
                }
                // A loop: the correlations are compiled once.
                for laws in [&mut room.inner, &mut room.outer] {
                    laws.bend::<V>(&iterate.surfaces);
                }
            }
            room.gather::<V>(self.front);
        }
        for room in self.zone_fronts {
            if self.front == Front::Whole {
                room.factor::<V>();
                if self.stays {
                    room.find_answers();
                }
            }
            if self.stays {
                room.answer::<V>();
            }
        }
    }
}

/// Temperatures of all own surfaces.
struct Resolve<'r, S: Real> {
    zone_fronts: &'r mut [ZoneFront<S>],
    stays: bool,
    block: &'r mut [S],
    solved: &'r mut [S],
}

impl<S: Real> Task<S> for Resolve<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Abreast<S>>(self) {
        for room in self.zone_fronts {
            room.resolve::<V>(self.stays, self.block, self.solved);
        }
    }
}

impl<S: Real> ZoneFronts<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>, laws: &BySurface<SurfaceLaws<S>>) -> Self {
        Self {
            zone_fronts: (0..plan.zones.len())
                .map(|zone| ZoneFront::new(plan, numbers, laws, zone))
                .collect(),
        }
    }

    /// Takes over how walls answer.
    pub(crate) fn respond(&mut self, responses: &[[[S; 2]; 2]]) {
        for room in &mut self.zone_fronts {
            room.respond(responses);
        }
    }

    /// Takes over what drives a stage.
    #[inline(never)]
    pub(crate) fn begin(&mut self, conditions: &Conditions<S>, sources: &[[S; 2]]) {
        S::vectorised(
            #[inline(always)]
            || {
                for (room, zone) in self.zone_fronts.iter_mut().zip(&conditions.zones) {
                    room.begin(conditions, zone.radiant, sources);
                }
            },
        );
    }

    /// Eliminates the own surfaces of all zones, along the tangents at an iterate or as laws stand, and adds what they leave to
    /// the room block; `stays`: the matrix is the same until it is entered anew.
    #[inline(never)]
    pub(crate) fn eliminate(
        &mut self,
        iterate: Option<&Unknowns<S>>,
        front: Front,
        stays: bool,
        block: &mut CoupledSystem<'_, S>,
    ) {
        S::vectorised(
            #[inline(always)]
            || {
                S::abreast(Eliminate { zone_fronts: &mut self.zone_fronts, iterate, front, stays });
                for room in &self.zone_fronts {
                    room.leave(front, stays, block);
                }
            },
        );
    }

    /// Solves for the own surfaces, once the others are known.
    #[inline(never)]
    pub(crate) fn resolve(&mut self, stays: bool, block: &mut [S], solved: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || S::abreast(Resolve { zone_fronts: &mut self.zone_fronts, stays, block, solved }),
        );
    }

    /// Another right-hand side through the elimination of the own surfaces.
    #[inline(never)]
    pub(crate) fn forward(&self, block: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || {
                for room in &self.zone_fronts {
                    room.forward(
                        block,
                        #[inline(always)]
                        |i| room.row(i),
                    );
                }
            },
        );
    }

    /// The own surfaces of another solution.
    #[inline(never)]
    pub(crate) fn back(&self, block: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || {
                for room in &self.zone_fronts {
                    room.back(
                        block,
                        #[inline(always)]
                        |i| room.row(i),
                    );
                }
            },
        );
    }

    /// Takes over laws as they stand.
    pub(crate) fn adopt(&mut self, laws: &BySurface<SurfaceLaws<S>>) {
        for room in &mut self.zone_fronts {
            for side in [&mut room.inner, &mut room.outer] {
                for i in 0..side.count {
                    let surface = SurfaceId::from_index(side.places[i]);
                    (side.convection[0][i], side.convection[1][i]) =
                        (laws[surface].convection.offset, laws[surface].convection.slope);
                    if !side.radiant.is_empty() {
                        let emission = laws[surface].emission;
                        (side.emission[0][i], side.emission[1][i]) = (emission.offset, emission.slope);
                    }
                }
            }
        }
    }

    /// The laws of the other surfaces, which are booked.
    #[inline(never)]
    pub(crate) fn tell_laws(&self, laws: &mut BySurface<SurfaceLaws<S>>) {
        for outer in self.zone_fronts.iter().map(|room| &room.outer) {
            let convections = outer.convection[0].iter().zip(&outer.convection[1]);
            let emissions = outer.emission[0].iter().zip(&outer.emission[1]);
            for ((surface, convection), emission) in outer.surfaces().zip(convections).zip(emissions) {
                laws[surface] = SurfaceLaws {
                    convection: Line { offset: *convection.0, slope: *convection.1 },
                    emission: Line { offset: *emission.0, slope: *emission.1 },
                };
            }
        }
    }

    /// The other surfaces as lines of the own ones, and what a watt does to them.
    #[inline(never)]
    pub(crate) fn tell_locals(&self, locals: &mut [ExteriorSurfaces<S>], inverses: &mut [S]) {
        for room in &self.zone_fronts {
            for (i, &(w, e)) in room.walls.iter().enumerate() {
                let line = Line { offset: room.outside[0][i], slope: room.outside[1][i] };
                locals[w] = ExteriorSurfaces::One { side: 1 - e, line };
                inverses[w] = room.inverse[i];
            }
        }
    }
}

impl ZoneFront<f64> {
    /// [`ZoneFront::forward`] of values of another kind of number.
    #[inline(always)]
    fn forward_beside<R: Real>(&self, values: &mut [R]) {
        let surfaces = self.surfaces();
        let air = self.row(surfaces);
        for k in 0..self.own {
            let known = values[self.row(k)].scale(self.pivots[k]);
            for i in k + 1..surfaces {
                let at = self.row(i);
                values[at] = values[at] - known.scale(self.entry(k, i));
            }
            values[air] = values[air] - known.scale(self.below[k]);
        }
    }

    /// [`ZoneFront::back`] of values of another kind of number.
    #[inline(always)]
    fn back_beside<R: Real>(&self, values: &mut [R]) {
        let surfaces = self.surfaces();
        for k in (0..self.own).rev() {
            let mut sum = values[self.row(k)] - values[self.row(surfaces)].scale(self.entry(k, surfaces));
            for j in k + 1..surfaces {
                sum = sum - values[self.row(j)].scale(self.entry(k, j) * self.inner.emission[1][j]);
            }
            values[self.row(k)] = sum.scale(self.pivots[k] * self.unslope[k]);
        }
    }

    /// The transpose of [`ZoneFront::back`].
    fn back_transposed(&self, values: &mut [f64]) {
        let surfaces = self.surfaces();
        for k in 0..self.own {
            let weight = values[self.row(k)] * (self.pivots[k] * self.unslope[k]);
            values[self.row(k)] = weight;
            values[self.row(surfaces)] -= self.entry(k, surfaces) * weight;
            for j in k + 1..surfaces {
                values[self.row(j)] -= self.entry(k, j) * self.inner.emission[1][j] * weight;
            }
        }
    }

    /// The transpose of [`ZoneFront::forward`].
    fn forward_transposed(&self, values: &mut [f64]) {
        let surfaces = self.surfaces();
        for k in (0..self.own).rev() {
            let mut sum = self.below[k] * values[self.row(surfaces)];
            for i in k + 1..surfaces {
                sum += self.entry(k, i) * values[self.row(i)];
            }
            values[self.row(k)] -= self.pivots[k] * sum;
        }
    }
}

impl ZoneFronts<f64> {
    /// Right-hand sides of another kind of number through the elimination of the own surfaces.
    #[inline(always)]
    pub(crate) fn forward_beside<R: Real>(&self, values: &mut [R]) {
        self.zone_fronts.iter().for_each(|room| room.forward_beside(values));
    }

    /// The own surfaces of their solution.
    #[inline(always)]
    pub(crate) fn back_beside<R: Real>(&self, values: &mut [R]) {
        self.zone_fronts.iter().for_each(|room| room.back_beside(values));
    }

    /// The transpose of [`Self::back_beside`].
    pub(crate) fn back_transposed(&self, values: &mut [f64]) {
        self.zone_fronts.iter().for_each(|room| room.back_transposed(values));
    }

    /// The transpose of [`Self::forward_beside`].
    pub(crate) fn forward_transposed(&self, values: &mut [f64]) {
        self.zone_fronts.iter().for_each(|room| room.forward_transposed(values));
    }
}

/// Whether a wall of constant properties has one surface in a zone and the other in none.
pub(crate) fn of_one_room(plan: &Plan, wall: usize) -> bool {
    let roles = SurfaceId::pair(wall).map(|surface| plan.surfaces[surface].role);
    let inside = roles.iter().filter(|role| matches!(role, SurfaceRole::Zone { .. })).count();
    !plan.walls[wall].nonlinear && inside == 1
}

#[cfg(test)]
mod tests;
