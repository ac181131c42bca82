//! The faces of walls of constant properties that lie in one zone, eliminated together with those of their zone.
//!
//! The other face of such a wall is in no zone: it is eliminated first, by itself. What is then left of a zone is a dense
//! front: its own faces, the faces that it shares with the rest of the building (of walls that change, or that lie
//! between zones), its air, and the right-hand side as one more column. The own faces are eliminated, and what is left
//! goes to the [`RoomBlock`].
//!
//! The unknowns of a front are what its faces emit, along the tangent of their law, `E = offset + slope T`, and the
//! temperature of its air. Between faces stand the exchange areas then, which never change and are symmetric: nothing is
//! assembled but the diagonal, and half of the elimination is spared. A zone without exchange has `E = T`.
//!
//! Numbers stand by their place in the front, so that neighbours are computed together: [`Abreast`].

use crate::balance::{FaceLaws, Line, LocalFaces};
use crate::coefficients::{Boundary, Coefficients};
use crate::convection::Film;
use crate::drive::Drive;
use crate::plan::{FaceId, FaceRole, Plan};
use crate::radiation::Emission;
use crate::real::{Abreast, Real, Task};
use crate::room_block::RoomBlock;
use crate::state::Unknowns;

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

/// Faces side by side that follow the same correlation.
#[derive(Debug, Clone)]
struct Group<S> {
    /// Place of the first.
    start: usize,
    film: Film<Box<[S]>>,
    /// Convective area over plane area.
    factor: Box<[S]>,
    /// One for those that belong to it, else zero.
    members: Box<[S]>,
}

/// The laws of faces.
#[derive(Debug, Clone)]
struct Laws<S> {
    /// The faces, and as many more as fill the last register.
    faces: Vec<FaceId>,
    count: usize,
    /// Convection off each face, of its difference to the air, and black emission, of its temperature: offset and slope.
    film: [Vec<S>; 2],
    emission: [Vec<S>; 2],
    forced: [Vec<S>; 2],
    /// The air that they meet.
    air: Vec<S>,
    /// Films that follow the wind alone: place, convective area over plane area.
    windy: Vec<(usize, S)>,
    bent: Vec<Group<S>>,
    /// Faces that radiate with the fourth power of their temperature: place of the first of a register, one for those that
    /// do, else zero.
    radiant: Vec<(usize, Box<[S]>)>,
}

/// A zone.
#[derive(Debug, Clone)]
struct Room<S> {
    /// Faces, the own ones first, and how many these are; the air is behind them, then the right-hand side.
    inner: Laws<S>,
    own: usize,
    /// Numbers in a row.
    stride: usize,
    /// Row of the first own face in the room block, and those of the shared faces and the air.
    first_row: usize,
    shared: Vec<usize>,
    /// Areas and shares of radiant gains.
    area: Vec<S>,
    share: Vec<S>,
    /// What faces lose by their own emission and gain by that of others [m2]; symmetric.
    exchange: Vec<S>,
    /// One for own faces, else zero; then over the slope of their emission.
    mine: Vec<S>,
    unslope: Vec<S>,
    /// Walls of the own faces: the other face, which side is in the zone, area.
    outer: Laws<S>,
    walls: Vec<(usize, usize)>,
    wall_area: Vec<S>,
    /// Of the other face.
    emissivity: Vec<S>,
    /// Whether it is held at its temperature.
    fixed: Vec<bool>,
    /// How the wall answers: heat into the own face by its temperature and that of the other one [W/K], heat into the
    /// other one likewise [W/(m2 K)].
    responses: [Vec<S>; 4],
    /// What acts on the own face [W] and on the other one [W/m2], and the temperature that this one is held at.
    base: Vec<S>,
    enters: Vec<S>,
    held: Vec<S>,
    /// What a watt does to the other face; its temperature is a line of the own one's.
    inverse: Vec<S>,
    outside: [Vec<S>; 2],
    /// Convection to the air by temperature and by emission, what it has beside that, diagonal, right-hand side.
    to_air: Vec<S>,
    by_emission: Vec<S>,
    from_film: Vec<S>,
    diagonal: Vec<S>,
    right: Vec<S>,
    /// The front, eliminated: what is right of each pivot, then the rows of shared faces and air.
    rows: Vec<S>,
    /// Inverses of the pivots, and what stood below them in the row of the air.
    pivots: Vec<S>,
    below: Vec<S>,
    /// Where the matrix stays: by own face, the own faces' answer to its right-hand side, and what it leaves to the
    /// shared unknowns; by shared unknown, the own faces' answer.
    answers: Vec<S>,
    shares: Vec<S>,
    /// Answers to the right-hand sides in hand; scratch.
    answer: Vec<S>,
}

/// All zones.
// What it does is not inlined where it is asked for, for the compiler's sake: it is large.
#[derive(Debug, Clone)]
pub(crate) struct Rooms<S> {
    rooms: Vec<Room<S>>,
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
    fn new(faces: &[FaceId], stride: usize, laws: &[FaceLaws<S>]) -> Self {
        let zeros = || vec![S::zero(); stride];
        let count = faces.len();
        let mut all = Self {
            faces: faces.to_vec(),
            count,
            film: [zeros(), zeros()],
            emission: [zeros(), zeros()],
            forced: [zeros(), zeros()],
            air: zeros(),
            windy: Vec::new(),
            bent: Vec::new(),
            radiant: Vec::new(),
        };
        for (i, &face) in faces.iter().enumerate() {
            [all.film[0][i], all.film[1][i]] = [laws[face].film.offset, laws[face].film.slope];
            [all.emission[0][i], all.emission[1][i]] =
                [laws[face].emission.offset, laws[face].emission.slope];
        }
        all.faces.resize(count.next_multiple_of(S::SIDE), faces.first().copied().unwrap_or(0));
        all
    }

    /// Sorts the films that change, and the faces that radiate with the fourth power. A face has no law where none acts.
    fn sort(
        &mut self,
        numbers: &Coefficients<S>,
        acts: impl Fn(FaceId) -> bool,
        radiates: impl Fn(FaceId) -> bool,
    ) {
        let film = |face: FaceId| numbers.faces[face].film.as_ref().filter(|_| acts(face));
        for (i, &face) in self.faces[..self.count].iter().enumerate() {
            if film(face).is_some_and(|film| film.constant().is_none() && film.straight()) {
                self.windy.push((i, numbers.faces[face].area_factor));
            }
            if !acts(face) {
                (self.film[0][i], self.film[1][i]) = (S::zero(), S::zero());
            }
        }
        let bent = |face: FaceId| film(face).filter(|film| !film.straight());
        let flags = |faces: &[FaceId], start: usize, member: &dyn Fn(FaceId) -> bool| -> Box<[S]> {
            let flag = |member: bool| if member { S::one() } else { S::zero() };
            let places = faces.iter().enumerate();
            places.map(|(i, &face)| flag(start + i < self.count && member(face))).collect()
        };
        let (mut groups, mut radiant) = (Vec::new(), Vec::new());
        for (chunk, faces) in self.faces.chunks(S::SIDE).enumerate() {
            let start = chunk * S::SIDE;
            let mut kinds: Vec<&Film<S>> = Vec::new();
            for &face in faces {
                if let Some(film) = bent(face).filter(|film| !kinds.iter().any(|kind| kind.alike(film))) {
                    kinds.push(film);
                }
            }
            let group = |kind: &&Film<S>| {
                let member = |face: FaceId| bent(face).is_some_and(|film| kind.alike(film));
                // Another place computes what the first of the kind would, and it is thrown away.
                let film = |&face: &FaceId| bent(face).filter(|film| kind.alike(film)).unwrap_or(kind);
                let films: Vec<_> = faces.iter().map(film).collect();
                Group {
                    start,
                    film: Film::together(&films),
                    factor: faces.iter().map(|&face| numbers.faces[face].area_factor).collect(),
                    members: flags(faces, start, &member),
                }
            };
            groups.extend(kinds.iter().map(group));
            if faces.iter().any(|&face| radiates(face)) {
                radiant.push((start, flags(faces, start, &|face| radiates(face))));
            }
        }
        (self.bent, self.radiant) = (groups, radiant);
    }

    /// Takes over what the wind makes of films.
    #[inline(always)]
    fn blow(&mut self, drive: &Drive<S>) {
        let [first, second] = &mut self.forced;
        for ((&face, first), second) in self.faces[..self.count].iter().zip(first).zip(second) {
            [*first, *second] = drive.faces[face].forced;
        }
        for &(i, factor) in &self.windy {
            self.film[1][i] = self.forced[0][i] * factor;
        }
    }

    /// Tangents at the temperatures of an iterate.
    #[inline(always)]
    fn bend<V: Abreast<S>>(&mut self, temperatures: &[S]) {
        let half = V::constant(0.5);
        for group in &self.bent {
            let start = group.start;
            let temperature = V::pick(temperatures, &self.faces[start..start + S::SIDE]);
            let difference = temperature - part!(self.air, start);
            let forced = [part!(self.forced[0], start), part!(self.forced[1], start)];
            let flux = group.film.flux_of(
                #[inline(always)]
                |numbers| V::load(numbers),
                difference,
                &forced,
            );
            let factor = V::load(&group.factor);
            let line = Line::tangent(flux.flux * factor, flux.slope * factor, difference);
            let members = half.lt(V::load(&group.members));
            line.store(members, &mut self.film, start);
        }
        for (start, members) in &self.radiant {
            let temperature = V::pick(temperatures, &self.faces[*start..*start + S::SIDE]);
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

impl<S: Real> Room<S> {
    fn new(plan: &Plan, numbers: &Coefficients<S>, laws: &[FaceLaws<S>], zone: usize) -> Self {
        let (of_plan, of_zone) = (&plan.zones[zone], &numbers.zones[zone]);
        let mut order: Vec<usize> = (0..of_plan.faces.len()).collect();
        order.sort_by_key(|&i| of_plan.face_rows[i]);
        let own = order.iter().filter(|&&i| of_plan.face_rows[i] < plan.own_rows).count();
        let faces: Vec<FaceId> = order.iter().map(|&i| of_plan.faces[i]).collect();
        let stride = (faces.len() + 2).next_multiple_of(S::SIDE);
        let mut inner = Laws::new(&faces, stride, laws);
        let exact = matches!(of_zone.emission, Emission::Exact) && !of_zone.exchange.is_empty();
        inner.sort(numbers, |_| true, |_| exact);
        // In straight lines all faces emit alike: their offset does nothing.
        inner.emission[0].fill(S::zero());
        if of_zone.exchange.is_empty() {
            inner.emission[1].fill(S::one());
        }
        inner.emission[1][faces.len()..].fill(S::one());
        let outside: Vec<FaceId> = faces[..own].iter().map(|face| face ^ 1).collect();
        let mut outer = Laws::new(&outside, stride, laws);
        let of = |face: FaceId| &numbers.faces[face];
        outer.sort(
            numbers,
            |face| !matches!(of(face).boundary, Boundary::Adiabatic),
            |face| {
                matches!(&of(face).boundary, Boundary::Outdoors(outdoors)
                    if matches!(outdoors.emission, Some(Emission::Exact)))
            },
        );
        let fixed =
            |&face: &FaceId| matches!(of(face).boundary, Boundary::Imposed(_)) && of(face).film.is_none();
        let mut room = Self::blank(inner, outer, stride);
        room.first_row = order.first().map_or(0, |&i| of_plan.face_rows[i]);
        room.shared = order[own..].iter().map(|&i| of_plan.face_rows[i]).chain([of_plan.air_row]).collect();
        room.walls = faces[..own].iter().map(|&face| (face / 2, face % 2)).collect();
        room.fixed = outside.iter().map(fixed).collect();
        for (i, &k) in order.iter().enumerate() {
            (room.area[i], room.share[i]) = (of_zone.areas[k], of_zone.radiant_shares[k]);
        }
        for (i, &face) in outside.iter().enumerate() {
            (room.wall_area[i], room.emissivity[i]) = (numbers.walls[face / 2].area, of(face).emissivity);
        }
        if exact {
            // What bends has no slope yet.
            room.unslope.fill(S::zero());
        }
        if !of_zone.exchange.is_empty() {
            let n = faces.len();
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
            from_film: zeros(),
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

    /// Number of faces; the air's place.
    #[inline(always)]
    fn faces(&self) -> usize {
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
    fn begin(&mut self, drive: &Drive<S>, radiant: S, sources: &[[S; 2]]) {
        self.inner.blow(drive);
        self.outer.blow(drive);
        let faces = self.inner.faces[..self.inner.count].iter().zip(&self.area).zip(&self.share);
        for (base, ((&face, &area), &share)) in self.base.iter_mut().zip(faces) {
            *base = area * drive.faces[face].solar + radiant * share;
        }
        for (i, (&(w, e), &face)) in self.walls.iter().zip(&self.outer.faces).enumerate() {
            let at = &drive.faces[face];
            self.base[i] += self.wall_area[i] * sources[w][e];
            self.enters[i] = sources[w][1 - e] + (at.solar + at.longwave);
            self.outer.air[i] = at.temperature;
            if self.fixed[i] {
                self.held[i] = at.temperature;
            }
        }
    }

    /// Eliminates the other faces of the walls, and sums up what acts on the faces in the zone.
    #[inline(always)]
    fn gather<V: Abreast<S>>(&mut self, front: Front) {
        let faces = self.faces();
        for start in (0..faces).step_by(S::SIDE) {
            let places = start..start + S::SIDE;
            let (mut gain, mut right) = (V::zero(), part!(self.base, start));
            if start < self.own {
                let there = part!(self.outer.air, start);
                let film = Line {
                    offset: part!(self.outer.film[0], start),
                    slope: part!(self.outer.film[1], start),
                };
                let [emission, slope] = &self.outer.emission;
                let emission: Line<V> = Line { offset: part!(emission, start), slope: part!(slope, start) };
                let to_own = part!(self.responses[1], start);
                let emissivity = part!(self.emissivity, start);
                if front == Front::Whole {
                    let slope = film.slope + emissivity * emission.slope;
                    let inverse = V::one() / (slope - part!(self.responses[3], start));
                    let give = part!(self.responses[2], start) * inverse;
                    gain = part!(self.responses[0], start) + to_own * give;
                    inverse.store(&mut self.inverse[places.clone()]);
                    give.store(&mut self.outside[1][places.clone()]);
                }
                let enters = part!(self.enters, start) + film.slope * there
                    - film.offset
                    - emissivity * emission.offset;
                let offset = part!(self.held, start) + enters * part!(self.inverse, start);
                offset.store(&mut self.outside[0][places.clone()]);
                right += to_own * offset;
            }
            let film: Line<V> =
                Line { offset: part!(self.inner.film[0], start), slope: part!(self.inner.film[1], start) };
            let area = part!(self.area, start);
            let mut from_film = area * film.offset;
            right = right - from_film;
            if front == Front::Whole {
                let to_air = area * film.slope;
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
                    from_film = from_film - by_emission * offset;
                }
                to_air.store(&mut self.to_air[places.clone()]);
                by_emission.store(&mut self.by_emission[places.clone()]);
                diagonal.store(&mut self.diagonal[places.clone()]);
            }
            from_film.store(&mut self.from_film[places.clone()]);
            right.store(&mut self.right[places]);
        }
        self.right[faces] = total(&self.from_film[..faces]);
        if front == Front::Whole {
            self.diagonal[faces] = total(&self.to_air[..self.own]);
        }
    }

    /// Eliminates the own faces, rows in registers.
    #[allow(clippy::absurd_extreme_comparisons, reason = "only the first number is the smallest")]
    #[inline(always)]
    fn eliminate<V: Abreast<S>, const C: usize>(&mut self) {
        let (faces, own, stride) = (self.faces(), self.own, C * S::SIDE);
        let (exchange, rows) = (&self.exchange[..stride * stride], &mut self.rows[..stride * stride]);
        let (diagonal, right) = (&self.diagonal[..stride], &self.right[..stride]);
        let (by_air, pivots, below) =
            (&self.to_air[..stride], &mut self.pivots[..stride], &mut self.below[..stride]);
        let mut air: [V; C] = load_row(&self.by_emission, 0);
        for entry in &mut air {
            *entry = -*entry;
        }
        enter(&mut air, faces, diagonal[faces]);
        enter(&mut air, faces + 1, right[faces]);
        each!(I, 'rows: {
            if const { I + 1 >= C * S::SIDE } {
                break 'rows;
            }
            if I >= faces {
                break 'rows;
            }
            let first = I / S::SIDE;
            let mut row: [V; C] = load_row(&exchange[I * stride..], first);
            if I < own {
                row[first] += V::alone(diagonal[I], I % S::SIDE);
                enter(&mut row, faces, -by_air[I]);
                enter(&mut row, faces + 1, right[I]);
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
        for (&entry, numbers) in air.iter().zip(rows[faces * stride..].chunks_exact_mut(S::SIDE)) {
            entry.store(numbers);
        }
    }

    /// The same for a front of any size.
    #[inline(always)]
    fn eliminate_long(&mut self) {
        let (faces, own, stride) = (self.faces(), self.own, self.stride);
        let (rows, air) = self.rows.split_at_mut(faces * stride);
        for (entry, &by_emission) in air.iter_mut().zip(&self.by_emission) {
            *entry = -by_emission;
        }
        air[faces] = self.diagonal[faces];
        air[faces + 1] = self.right[faces];
        for i in 0..faces {
            let (above, row) = rows.split_at_mut(i * stride);
            let row = &mut row[..stride];
            row.copy_from_slice(&self.exchange[i * stride..(i + 1) * stride]);
            if i < own {
                row[i] += self.diagonal[i];
                row[faces] = -self.to_air[i];
                row[faces + 1] = self.right[i];
            }
            for (above, &inverse) in above.chunks_exact(stride).zip(&self.pivots).take(own) {
                let factor = above[i] * inverse;
                for (entry, &above) in row[i..faces + 2].iter_mut().zip(&above[i..]) {
                    *entry = *entry - factor * above;
                }
            }
            if i < own {
                self.pivots[i] = S::one() / row[i];
                self.below[i] = air[i];
                let factor = air[i] * self.pivots[i];
                for (entry, &row) in air[i + 1..faces + 2].iter_mut().zip(&row[i + 1..]) {
                    *entry = *entry - factor * row;
                }
            }
        }
    }

    /// Assembles the front and eliminates the own faces.
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
        let (faces, own, stride) = (self.faces(), self.own, self.stride);
        for j in 0..own {
            let mut line = vec![S::zero(); faces + 1];
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
        for shared in own..=faces {
            let mut line = vec![S::zero(); faces + 1];
            line[shared] = S::one();
            self.back(&mut line, |i| i);
            self.shares[shared * stride..shared * stride + own].copy_from_slice(&line[..own]);
        }
    }

    /// Values, whose places are given, through the elimination of the own faces.
    #[inline(always)]
    fn forward(&self, values: &mut [S], place: impl Fn(usize) -> usize) {
        let faces = self.faces();
        let rows = self.rows.chunks_exact(self.stride).zip(self.pivots.iter().zip(&self.below));
        for (k, (row, (&inverse, &below))) in rows.enumerate().take(self.own) {
            let known = values[place(k)] * inverse;
            for (i, &entry) in row.iter().enumerate().take(faces).skip(k + 1) {
                let at = place(i);
                values[at] = values[at] - entry * known;
            }
            let at = place(faces);
            values[at] = values[at] - below * known;
        }
    }

    /// Temperatures of the own faces, from the last to the first, once the shared unknowns are known.
    #[inline(always)]
    fn back(&self, values: &mut [S], place: impl Fn(usize) -> usize) {
        let faces = self.faces();
        let rows = self.rows.chunks_exact(self.stride).zip(&self.pivots);
        for (k, (row, &inverse)) in rows.enumerate().take(self.own).rev() {
            let mut sum = values[place(k)] - row[faces] * values[place(faces)];
            let entries = row.iter().zip(&self.inner.emission[1]).enumerate();
            for (j, (&entry, &slope)) in entries.take(faces).skip(k + 1) {
                sum = sum - entry * (slope * values[place(j)]);
            }
            values[place(k)] = sum * inverse * self.unslope[k];
        }
    }

    /// Adds what the own faces leave to the room block.
    #[inline(always)]
    fn leave(&self, front: Front, stays: bool, block: &mut RoomBlock<'_, S>) {
        let (faces, own) = (self.faces(), self.own);
        if stays {
            for (i, &row) in (own..).zip(&self.shared) {
                block.right[row] += self.right[i] + self.answer[i];
            }
        }
        if front == Front::Right {
            return;
        }
        let air_row = self.shared[faces - own];
        for (i, &row) in (own..).zip(&self.shared) {
            let mut right = self.entry(i, faces + 1);
            for (j, &column) in (own..faces).zip(&self.shared) {
                let entry = if i <= j || i == faces { self.entry(i, j) } else { self.entry(j, i) };
                block.add(row, column, entry * self.inner.emission[1][j]);
                right = right - entry * self.inner.emission[0][j];
            }
            block.add(row, air_row, self.entry(i, faces));
            if i < faces {
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
        let (end, stride) = (self.faces() + 1, self.stride);
        for start in (0..end).step_by(S::SIDE) {
            let mut sum = V::zero();
            let lines = self.answers.chunks_exact(stride);
            for (line, &right) in lines.zip(&self.right).take(self.own) {
                sum += V::load(&line[start..start + S::SIDE]) * V::everywhere(right);
            }
            sum.store(&mut self.answer[start..start + S::SIDE]);
        }
    }

    /// Temperatures of the own faces and of the other faces of their walls, once the shared unknowns are known.
    #[inline(always)]
    fn resolve<V: Abreast<S>>(&mut self, stays: bool, block: &mut [S], solved: &mut [S]) {
        let (faces, own, stride) = (self.faces(), self.own, self.stride);
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
            for (i, (value, &row)) in answer[own..=faces].iter_mut().zip(&*shared).enumerate() {
                let (offset, slope) = (inner.emission[0][own + i], inner.emission[1][own + i]);
                *value = if own + i == faces { block[row] } else { offset + slope * block[row] };
            }
            for (k, (row, &inverse)) in rows.chunks_exact(stride).zip(&*pivots).enumerate().take(own).rev() {
                // The one that is known last comes last.
                let mut sum = row[faces + 1];
                for (&entry, &value) in row[k + 1..=faces].iter().zip(&answer[k + 1..=faces]).rev() {
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

    /// The own faces in hand, and the other faces of their walls, to where all faces are.
    #[inline(always)]
    fn spread<V: Abreast<S>>(&mut self, solved: &mut [S]) {
        for start in (0..self.own).step_by(S::SIDE) {
            let places = start..start + S::SIDE;
            let other =
                part!(self.outside[0], start) + part!(self.outside[1], start) * part!(self.right, start);
            other.store(&mut self.answer[places]);
        }
        for ((&(w, e), &own), &other) in self.walls.iter().zip(&self.right).zip(&self.answer) {
            (solved[2 * w + e], solved[2 * w + 1 - e]) = (own, other);
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

/// Elimination of all own faces.
struct Eliminate<'r, S: Real> {
    rooms: &'r mut [Room<S>],
    iterate: Option<&'r Unknowns<S>>,
    front: Front,
    stays: bool,
}

impl<S: Real> Task<S> for Eliminate<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Abreast<S>>(self) {
        for (zone, room) in self.rooms.iter_mut().enumerate() {
            if let Some(iterate) = self.iterate {
                if !room.inner.bent.is_empty() {
                    room.inner.air.fill(iterate.air[zone]);
                }
                // A loop: the correlations are compiled once.
                for laws in [&mut room.inner, &mut room.outer] {
                    laws.bend::<V>(&iterate.faces);
                }
            }
            room.gather::<V>(self.front);
        }
        for room in self.rooms {
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

/// Temperatures of all own faces.
struct Resolve<'r, S: Real> {
    rooms: &'r mut [Room<S>],
    stays: bool,
    block: &'r mut [S],
    solved: &'r mut [S],
}

impl<S: Real> Task<S> for Resolve<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: Abreast<S>>(self) {
        for room in self.rooms {
            room.resolve::<V>(self.stays, self.block, self.solved);
        }
    }
}

impl<S: Real> Rooms<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>, laws: &[FaceLaws<S>]) -> Self {
        Self { rooms: (0..plan.zones.len()).map(|zone| Room::new(plan, numbers, laws, zone)).collect() }
    }

    /// Takes over how walls answer.
    pub(crate) fn respond(&mut self, responses: &[[[S; 2]; 2]]) {
        for room in &mut self.rooms {
            room.respond(responses);
        }
    }

    /// Takes over what drives a stage.
    #[inline(never)]
    pub(crate) fn begin(&mut self, drive: &Drive<S>, sources: &[[S; 2]]) {
        S::vectorised(
            #[inline(always)]
            || {
                for (room, zone) in self.rooms.iter_mut().zip(&drive.zones) {
                    room.begin(drive, zone.radiant, sources);
                }
            },
        );
    }

    /// Eliminates the own faces of all zones, along the tangents at an iterate or as laws stand, and adds what they leave to
    /// the room block; `stays`: the matrix is the same until it is entered anew.
    #[inline(never)]
    pub(crate) fn eliminate(
        &mut self,
        iterate: Option<&Unknowns<S>>,
        front: Front,
        stays: bool,
        block: &mut RoomBlock<'_, S>,
    ) {
        S::vectorised(
            #[inline(always)]
            || {
                S::abreast(Eliminate { rooms: &mut self.rooms, iterate, front, stays });
                for room in &self.rooms {
                    room.leave(front, stays, block);
                }
            },
        );
    }

    /// Solves for the own faces, once the others are known.
    #[inline(never)]
    pub(crate) fn resolve(&mut self, stays: bool, block: &mut [S], solved: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || S::abreast(Resolve { rooms: &mut self.rooms, stays, block, solved }),
        );
    }

    /// Another right-hand side through the elimination of the own faces.
    #[inline(never)]
    pub(crate) fn forward(&self, block: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || {
                for room in &self.rooms {
                    room.forward(
                        block,
                        #[inline(always)]
                        |i| room.row(i),
                    );
                }
            },
        );
    }

    /// The own faces of another solution.
    #[inline(never)]
    pub(crate) fn back(&self, block: &mut [S]) {
        S::vectorised(
            #[inline(always)]
            || {
                for room in &self.rooms {
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
    pub(crate) fn adopt(&mut self, laws: &[FaceLaws<S>]) {
        for room in &mut self.rooms {
            for side in [&mut room.inner, &mut room.outer] {
                for (i, &face) in side.faces[..side.count].iter().enumerate() {
                    (side.film[0][i], side.film[1][i]) = (laws[face].film.offset, laws[face].film.slope);
                    if !side.radiant.is_empty() {
                        let emission = laws[face].emission;
                        (side.emission[0][i], side.emission[1][i]) = (emission.offset, emission.slope);
                    }
                }
            }
        }
    }

    /// The laws of the other faces, which are booked.
    #[inline(never)]
    pub(crate) fn tell_laws(&self, laws: &mut [FaceLaws<S>]) {
        for outer in self.rooms.iter().map(|room| &room.outer) {
            let films = outer.film[0].iter().zip(&outer.film[1]);
            let emissions = outer.emission[0].iter().zip(&outer.emission[1]);
            for ((&face, film), emission) in outer.faces[..outer.count].iter().zip(films).zip(emissions) {
                laws[face] = FaceLaws {
                    film: Line { offset: *film.0, slope: *film.1 },
                    emission: Line { offset: *emission.0, slope: *emission.1 },
                };
            }
        }
    }

    /// The other faces as lines of the own ones, and what a watt does to them.
    #[inline(never)]
    pub(crate) fn tell_locals(&self, locals: &mut [LocalFaces<S>], inverses: &mut [S]) {
        for room in &self.rooms {
            for (i, &(w, e)) in room.walls.iter().enumerate() {
                let line = Line { offset: room.outside[0][i], slope: room.outside[1][i] };
                locals[w] = LocalFaces::One { side: 1 - e, line };
                inverses[w] = room.inverse[i];
            }
        }
    }
}

impl Room<f64> {
    /// [`Room::forward`] of values of another kind of number.
    #[inline(always)]
    fn forward_beside<R: Real>(&self, values: &mut [R]) {
        let faces = self.faces();
        let air = self.row(faces);
        for k in 0..self.own {
            let known = values[self.row(k)].scale(self.pivots[k]);
            for i in k + 1..faces {
                let at = self.row(i);
                values[at] = values[at] - known.scale(self.entry(k, i));
            }
            values[air] = values[air] - known.scale(self.below[k]);
        }
    }

    /// [`Room::back`] of values of another kind of number.
    #[inline(always)]
    fn back_beside<R: Real>(&self, values: &mut [R]) {
        let faces = self.faces();
        for k in (0..self.own).rev() {
            let mut sum = values[self.row(k)] - values[self.row(faces)].scale(self.entry(k, faces));
            for j in k + 1..faces {
                sum = sum - values[self.row(j)].scale(self.entry(k, j) * self.inner.emission[1][j]);
            }
            values[self.row(k)] = sum.scale(self.pivots[k] * self.unslope[k]);
        }
    }

    /// The transpose of [`Room::back`].
    fn back_transposed(&self, values: &mut [f64]) {
        let faces = self.faces();
        for k in 0..self.own {
            let weight = values[self.row(k)] * (self.pivots[k] * self.unslope[k]);
            values[self.row(k)] = weight;
            values[self.row(faces)] -= self.entry(k, faces) * weight;
            for j in k + 1..faces {
                values[self.row(j)] -= self.entry(k, j) * self.inner.emission[1][j] * weight;
            }
        }
    }

    /// The transpose of [`Room::forward`].
    fn forward_transposed(&self, values: &mut [f64]) {
        let faces = self.faces();
        for k in (0..self.own).rev() {
            let mut sum = self.below[k] * values[self.row(faces)];
            for i in k + 1..faces {
                sum += self.entry(k, i) * values[self.row(i)];
            }
            values[self.row(k)] -= self.pivots[k] * sum;
        }
    }
}

impl Rooms<f64> {
    /// Right-hand sides of another kind of number through the elimination of the own faces.
    #[inline(always)]
    pub(crate) fn forward_beside<R: Real>(&self, values: &mut [R]) {
        self.rooms.iter().for_each(|room| room.forward_beside(values));
    }

    /// The own faces of their solution.
    #[inline(always)]
    pub(crate) fn back_beside<R: Real>(&self, values: &mut [R]) {
        self.rooms.iter().for_each(|room| room.back_beside(values));
    }

    /// The transpose of [`Self::back_beside`].
    pub(crate) fn back_transposed(&self, values: &mut [f64]) {
        self.rooms.iter().for_each(|room| room.back_transposed(values));
    }

    /// The transpose of [`Self::forward_beside`].
    pub(crate) fn forward_transposed(&self, values: &mut [f64]) {
        self.rooms.iter().for_each(|room| room.forward_transposed(values));
    }
}

/// Whether a wall of constant properties has one face in a zone and the other in none.
pub(crate) fn of_one_room(plan: &Plan, wall: usize) -> bool {
    let roles = [plan.faces[2 * wall].role, plan.faces[2 * wall + 1].role];
    let inside = roles.iter().filter(|role| matches!(role, FaceRole::Zone { .. })).count();
    !plan.walls[wall].nonlinear && inside == 1
}

#[cfg(test)]
mod tests;
