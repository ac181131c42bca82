//! The laws of several surfaces, linearised: convection and emission as straight lines.
//!
//! Arrays are in the order of the surfaces in the front, so that neighbouring surfaces are computed together, as many as
//! fill a register ([`Chunk`]). A register may hold surfaces of several correlations: each correlation is computed for all
//! of them, and a flag selects those that it belongs to.

use crate::building::coefficients::Coefficients;
use crate::building::ids::{BySide, SideId};
use crate::linear::surface_balance::SurfaceLaws;
use crate::number::line::Line;
use crate::number::real::{Chunk, Real};
use crate::physics::convection::SurfaceConvection;
use crate::physics::longwave::Emission;
use crate::weather::conditions::Conditions;

/// Surfaces of one register whose convection has the same correlation.
#[derive(Debug, Clone)]
struct Group<S> {
    /// Place of the first surface of the register.
    start: usize,
    convection: SurfaceConvection<Box<[S]>>,
    /// Convective area over plane area [-].
    factor: Box<[S]>,
    /// One for those that belong to it, else zero.
    members: Box<[S]>,
}

/// The linearised laws of some surfaces.
#[derive(Debug, Clone)]
pub(super) struct Laws<S> {
    /// Indices of the surfaces, and as many more as fill the last register.
    places: Vec<usize>,
    pub(super) count: usize,
    /// Convection off each surface, of its difference to the air [W/m2], and black emission, of its temperature [W/m2]: offset
    /// and slope.
    pub(super) convection: [Vec<S>; 2],
    pub(super) emission: [Vec<S>; 2],
    /// What the wind drives, see [`SurfaceConditions`](crate::weather::conditions::SurfaceConditions).
    forced: [Vec<S>; 2],
    /// Two further parts, which laws that are written as text have; none if no surface has such a law.
    forced_of_text: Option<[Vec<S>; 2]>,
    /// Temperature of the air in front of each surface [degC].
    pub(super) air: Vec<S>,
    /// Air in front of each surface less the mean of its zone [K]; none where no air is stratified.
    shift: Option<Vec<S>>,
    /// Surfaces whose heat transfer coefficient depends on the wind alone: place, convective area over plane area.
    by_wind: Vec<(usize, S)>,
    nonlinear: Vec<Group<S>>,
    /// Surfaces that emit with the fourth power of their temperature: place of the first of a register; one for those that do,
    /// else zero.
    fourth_power: Vec<(usize, Box<[S]>)>,
}

impl<S: Real> Laws<S> {
    /// The constant laws of some surfaces.
    pub(super) fn new(surfaces: &[SideId], stride: usize, laws: &BySide<SurfaceLaws<S>>) -> Self {
        let zeros = || vec![S::zero(); stride];
        let count = surfaces.len();
        let mut all = Self {
            places: surfaces.iter().map(|surface| surface.index()).collect(),
            count,
            convection: [zeros(), zeros()],
            emission: [zeros(), zeros()],
            forced: [zeros(), zeros()],
            forced_of_text: None,
            air: zeros(),
            shift: None,
            by_wind: Vec::new(),
            nonlinear: Vec::new(),
            fourth_power: Vec::new(),
        };
        for (i, &surface) in surfaces.iter().enumerate() {
            [all.convection[0][i], all.convection[1][i]] =
                [laws[surface].convection.offset, laws[surface].convection.slope];
            [all.emission[0][i], all.emission[1][i]] =
                [laws[surface].emission.offset, laws[surface].emission.slope];
        }
        all.places.resize(count.next_multiple_of(S::CHUNK), all.places.first().copied().unwrap_or(0));
        all
    }

    /// The surface at a place.
    #[inline(always)]
    pub(super) fn surface(&self, place: usize) -> SideId {
        SideId::from_index(self.places[place])
    }

    /// The surfaces, without those that only fill the last register.
    #[inline(always)]
    pub(super) fn surfaces(&self) -> impl Iterator<Item = SideId> + '_ {
        self.places[..self.count].iter().map(
            #[inline(always)]
            |&place| SideId::from_index(place),
        )
    }

    /// Whether some emission is nonlinear.
    #[inline(always)]
    pub(super) fn emission_is_nonlinear(&self) -> bool {
        !self.fourth_power.is_empty()
    }

    /// Whether some convection is nonlinear.
    #[inline(always)]
    pub(super) fn convection_is_nonlinear(&self) -> bool {
        !self.nonlinear.is_empty()
    }

    /// Finds the convection that changes and the surfaces that emit with the fourth power of their temperature. `acts`: whether
    /// a surface has convection at all.
    pub(super) fn sort(
        &mut self,
        numbers: &Coefficients<S>,
        acts: impl Fn(SideId) -> bool,
        radiates: impl Fn(SideId) -> bool,
    ) {
        let convection =
            |surface: SideId| numbers.surfaces[surface].convection.as_ref().filter(|_| acts(surface));
        for i in 0..self.count {
            let surface = self.surface(i);
            let shifted = numbers.surfaces[surface].level.is_some();
            let by_wind = |law: &SurfaceConvection<S>| law.constant().is_none() && law.straight();
            if convection(surface).is_some_and(by_wind) && !shifted {
                self.by_wind.push((i, numbers.surfaces[surface].area_factor));
            }
            if !acts(surface) {
                (self.convection[0][i], self.convection[1][i]) = (S::zero(), S::zero());
            }
        }
        if self.surfaces().any(|surface| convection(surface).is_some_and(SurfaceConvection::is_text)) {
            self.forced_of_text = Some(self.forced.clone());
        }
        let shifted = |surface: SideId| numbers.surfaces[surface].level.is_some();
        if self.surfaces().any(|surface| shifted(surface) && convection(surface).is_some()) {
            self.shift = Some(vec![S::zero(); self.air.len()]);
        }
        // The line of a law in stratified air has an offset that changes, as that of a nonlinear law.
        let nonlinear =
            |surface: SideId| convection(surface).filter(|law| !law.straight() || shifted(surface));
        let padded: Vec<_> = self.places.iter().map(|&place| SideId::from_index(place)).collect();
        let (mut groups, mut fourth_power) = (Vec::new(), Vec::new());
        for (chunk, surfaces) in padded.chunks(S::CHUNK).enumerate() {
            let start = chunk * S::CHUNK;
            groups.extend(self.groups(numbers, start, surfaces, &nonlinear));
            if surfaces.iter().any(|&surface| radiates(surface)) {
                fourth_power.push((start, self.flags(start, surfaces, &radiates)));
            }
        }
        (self.nonlinear, self.fourth_power) = (groups, fourth_power);
    }

    /// The surfaces of one register by their correlation.
    fn groups<'n>(
        &self,
        numbers: &'n Coefficients<S>,
        start: usize,
        surfaces: &[SideId],
        nonlinear: &impl Fn(SideId) -> Option<&'n SurfaceConvection<S>>,
    ) -> Vec<Group<S>> {
        let mut kinds: Vec<&SurfaceConvection<S>> = Vec::new();
        for convection in surfaces.iter().filter_map(|&surface| nonlinear(surface)) {
            if !kinds.iter().any(|kind| kind.alike(convection)) {
                kinds.push(convection);
            }
        }
        let group = |kind: &&SurfaceConvection<S>| {
            let same = |surface: SideId| nonlinear(surface).filter(|convection| kind.alike(convection));
            // Surfaces of other correlations are computed with numbers of this one, and the result is not used.
            let convections: Vec<_> = surfaces.iter().map(|&surface| same(surface).unwrap_or(kind)).collect();
            Group {
                start,
                convection: SurfaceConvection::together(&convections),
                factor: surfaces.iter().map(|&surface| numbers.surfaces[surface].area_factor).collect(),
                members: self.flags(start, surfaces, |surface| same(surface).is_some()),
            }
        };
        kinds.iter().map(group).collect()
    }

    /// One for the surfaces of a register that are members, zero for the others and for those that only fill it.
    fn flags(&self, start: usize, surfaces: &[SideId], member: impl Fn(SideId) -> bool) -> Box<[S]> {
        let flag = |(i, &surface): (usize, &SideId)| {
            if start + i < self.count && member(surface) { S::one() } else { S::zero() }
        };
        surfaces.iter().enumerate().map(flag).collect()
    }

    /// Reads the wind at the surfaces.
    #[inline(always)]
    pub(super) fn set_wind(&mut self, conditions: &Conditions<S>) {
        if self.nonlinear.is_empty() && self.by_wind.is_empty() {
            return;
        }
        let places = &self.places[..self.count];
        let [first, second] = &mut self.forced;
        for (&place, (first, second)) in places.iter().zip(first.iter_mut().zip(second)) {
            [*first, *second, ..] = conditions.surfaces[SideId::from_index(place)].forced;
        }
        if let Some([third, fourth]) = &mut self.forced_of_text {
            for (&place, (third, fourth)) in places.iter().zip(third.iter_mut().zip(fourth)) {
                [.., *third, *fourth] = conditions.surfaces[SideId::from_index(place)].forced;
            }
        }
        if let Some(shifts) = &mut self.shift {
            for (&place, shift) in places.iter().zip(shifts) {
                *shift = conditions.surfaces[SideId::from_index(place)].air_shift;
            }
        }
        for &(i, factor) in &self.by_wind {
            self.convection[1][i] = self.forced[0][i] * factor;
        }
    }

    /// Replaces the nonlinear laws by their tangents at the temperatures of an iterate.
    #[inline(always)]
    pub(super) fn linearise<V: Chunk<S>>(&mut self, temperatures: &[S]) {
        let half = V::constant(0.5);
        for group in &self.nonlinear {
            let start = group.start;
            let temperature = V::gather(temperatures, &self.places[start..start + S::CHUNK]);
            let difference = temperature - part!(self.air, start);
            let [first, second] = &self.forced;
            let [third, fourth] = match &self.forced_of_text {
                Some([third, fourth]) => [part!(third, start), part!(fourth, start)],
                None => [V::zero(); 2],
            };
            let forced = [part!(first, start), part!(second, start), third, fourth];
            let to_air = match &self.shift {
                Some(shift) => difference - part!(shift, start),
                None => difference,
            };
            let flux = group.convection.flux_of(
                #[inline(always)]
                |numbers| V::load(numbers),
                to_air,
                &forced,
            );
            let factor = V::load(&group.factor);
            let line = Line::tangent(flux.flux * factor, flux.slope * factor, difference);
            let members = half.lt(V::load(&group.members));
            store(line, members, &mut self.convection, start);
        }
        for (start, members) in &self.fourth_power {
            let temperature = V::gather(temperatures, &self.places[*start..*start + S::CHUNK]);
            let (value, slope) = Emission::Exact.at(temperature);
            let line = Line::tangent(value, slope, temperature);
            store(line, half.lt(V::load(members)), &mut self.emission, *start);
        }
    }

    /// Copies laws that were linearised elsewhere.
    pub(super) fn copy_from(&mut self, laws: &BySide<SurfaceLaws<S>>) {
        for i in 0..self.count {
            let surface = self.surface(i);
            (self.convection[0][i], self.convection[1][i]) =
                (laws[surface].convection.offset, laws[surface].convection.slope);
            if self.emission_is_nonlinear() {
                let emission = laws[surface].emission;
                (self.emission[0][i], self.emission[1][i]) = (emission.offset, emission.slope);
            }
        }
    }

    /// Writes the laws to a table of all surfaces.
    pub(super) fn copy_to(&self, laws: &mut BySide<SurfaceLaws<S>>) {
        let convections = self.convection[0].iter().zip(&self.convection[1]);
        let emissions = self.emission[0].iter().zip(&self.emission[1]);
        for ((surface, convection), emission) in self.surfaces().zip(convections).zip(emissions) {
            laws[surface] = SurfaceLaws {
                convection: Line { offset: *convection.0, slope: *convection.1 },
                emission: Line { offset: *emission.0, slope: *emission.1 },
            };
        }
    }

    /// The convection of the surfaces of one register.
    #[inline(always)]
    pub(super) fn convection_at<V: Chunk<S>>(&self, start: usize) -> Line<V> {
        Line { offset: part!(self.convection[0], start), slope: part!(self.convection[1], start) }
    }

    /// The emission of the surfaces of one register.
    #[inline(always)]
    pub(super) fn emission_at<V: Chunk<S>>(&self, start: usize) -> Line<V> {
        Line { offset: part!(self.emission[0], start), slope: part!(self.emission[1], start) }
    }
}

/// Stores lines as offsets and slopes from a place on, where a flag is set.
#[inline(always)]
fn store<S: Real, V: Chunk<S>>(line: Line<V>, flag: V::Mask, lines: &mut [Vec<S>; 2], start: usize) {
    let [offset, slope] = lines;
    for (numbers, new) in [(offset, line.offset), (slope, line.slope)] {
        let numbers = &mut numbers[start..start + S::CHUNK];
        let new = if S::CHUNK == 1 { new } else { V::select(flag, new, V::load(numbers)) };
        new.store(numbers);
    }
}

#[cfg(test)]
impl<S> Laws<S> {
    /// Treats the emission as nonlinear, with the tangents that it has.
    pub(super) fn set_emission_nonlinear(&mut self) {
        self.fourth_power.push((0, Box::default()));
    }
}
