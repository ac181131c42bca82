//! The unknowns of a front: which are eliminated, which are retained, and their rows.
//!
//! A front of several zones ([`side_by_side`](super::side_by_side)) has the unknowns of all of them: those of the same
//! number in their zones are neighbours.

use crate::building::ids::SideId;
use crate::building::pattern::Pattern;
use crate::building::plan::Plan;

use super::shape::ZoneShape;

/// The unknowns of a front and their rows.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// The zones; where there are fewer than fill a register, the first one again.
    pub(super) zones: Vec<usize>,
    /// Number of different zones.
    pub(super) members: usize,
    /// Number of surfaces, the eliminated ones first. The air comes after them, then the right-hand side.
    pub(super) surfaces: usize,
    /// Number of eliminated surfaces.
    pub(super) eliminated: usize,
    /// Numbers in a row: all unknowns and the right-hand side, and as many more as fill the last register.
    pub(super) stride: usize,
    /// Rows among the unknowns of the building: of the first eliminated surface of each zone, and of the retained unknowns.
    pub(super) first_rows: Vec<usize>,
    pub(super) retained_rows: Vec<usize>,
    /// Places of their entries in the coupled matrix, zone by zone and row by row; none where two of them do not meet.
    pub(super) places: Vec<Option<usize>>,
    /// Places of the diagonal of each retained row, of its entry in the column of the air, and of that of the air in its column;
    /// zone by zone.
    pub(super) air_places: Vec<[usize; 3]>,
    /// For zones side by side the same entry by entry, of all zones: first those of `places`, then the diagonals of the retained
    /// surfaces. What belongs to no entry goes nowhere, and so does a zone that stands here again.
    pub(super) register_places: Vec<usize>,
    /// The eliminated surfaces: those of windows after those of other walls, those of thick walls last.
    pub(super) walls: Vec<SideId>,
    /// Number of eliminated surfaces whose wall is not thick: its other surface is exterior. And how many of them, the last ones,
    /// are those of windows.
    pub(super) exterior: usize,
    pub(super) windows: usize,
}

impl Layout {
    /// The unknowns of some zones of one shape, of which the first `members` differ; `surfaces` are those of all of them.
    pub(super) fn new(
        plan: &Plan,
        shapes: &[ZoneShape],
        (zones, members): (&[usize], usize),
        surfaces: &[SideId],
        chunk: usize,
    ) -> Self {
        let (step, key) = (zones.len(), shapes[0].key);
        let row = |lane: usize, i: usize| {
            let zone = &plan.zones[zones[lane]];
            shapes[lane].order.get(i).map_or(zone.air_row, |&k| zone.surface_rows[k])
        };
        let count = key.surfaces - key.eliminated + 1;
        let of_zones = |lane: usize| -> Vec<Option<usize>> {
            let rows: Vec<usize> = (0..count).map(|i| row(lane, key.eliminated + i)).collect();
            places(&plan.pattern, plan.own_rows, &rows)
        };
        let by_zone: Vec<_> = (0..step).map(of_zones).collect();
        let nowhere = plan.pattern.nowhere();
        let entries = (0..count * count).chain((0..count - 1).map(|i| i * count + i));
        let of_lane = |k: usize, lane: usize| if lane < members { by_zone[lane][k] } else { None };
        let register_places: Vec<usize> = entries
            .flat_map(|k| (0..step).map(move |lane| (k, lane)))
            .map(|(k, lane)| of_lane(k, lane).unwrap_or(nowhere))
            .collect();
        let retained =
            (key.eliminated * step..(key.surfaces + 1) * step).map(|place| row(place % step, place / step));
        let eliminated = &surfaces[..key.eliminated * step];
        Self {
            zones: zones.to_vec(),
            members,
            surfaces: surfaces.len(),
            eliminated: eliminated.len(),
            stride: if step > 1 {
                (key.surfaces + 2) * step
            } else {
                (key.surfaces + 2).next_multiple_of(chunk)
            },
            first_rows: (0..step).map(|lane| if key.surfaces == 0 { 0 } else { row(lane, 0) }).collect(),
            retained_rows: retained.collect(),
            air_places: by_zone.iter().flat_map(|places| air_places(places, count)).collect(),
            places: by_zone.concat(),
            register_places,
            exterior: key.exterior * step,
            windows: key.windows * step,
            walls: eliminated.to_vec(),
        }
    }

    /// Number of zones side by side: the distance between neighbouring unknowns of one of them.
    #[inline(always)]
    pub(super) fn step(&self) -> usize {
        self.zones.len()
    }

    /// Places of the windows.
    #[inline(always)]
    pub(super) fn window_places(&self) -> core::ops::Range<usize> {
        self.exterior - self.windows..self.exterior
    }

    /// Numbers in a matrix.
    pub(super) fn matrix(&self) -> usize {
        let rows = if self.step() > 1 { self.surfaces / self.step() + 1 } else { self.stride };
        rows * self.stride
    }

    /// Row of an unknown of the front of one zone among the unknowns of the building.
    #[inline(always)]
    pub(super) fn row(&self, i: usize) -> usize {
        if i < self.eliminated { self.first_rows[0] + i } else { self.retained_rows[i - self.eliminated] }
    }
}

/// Places in the coupled matrix, whose rows begin with `own_rows`, of the entries of some rows in the columns of the same
/// rows.
pub(super) fn places(pattern: &Pattern, own_rows: usize, rows: &[usize]) -> Vec<Option<usize>> {
    let entries = rows.iter().flat_map(|&row| rows.iter().map(move |&column| (row, column)));
    entries.map(|(row, column)| pattern.place(row - own_rows, column - own_rows)).collect()
}

/// Places of the diagonal of each of some retained rows, and of the entries between it and the last of them, from [`places`]:
/// they all meet the air.
pub(super) fn air_places(places: &[Option<usize>], count: usize) -> Vec<[usize; 3]> {
    let air = count - 1;
    let of = |i: usize| Some([places[i * count + i]?, places[i * count + air]?, places[air * count + i]?]);
    (0..count).filter_map(of).collect()
}

/// What is to be eliminated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Elimination {
    /// The matrix with its right-hand side.
    Full,
    /// The right-hand side alone: the matrix is that of the last elimination.
    RightHandSide,
}
