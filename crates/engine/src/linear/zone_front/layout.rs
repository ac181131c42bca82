//! The unknowns of a front: which are eliminated, which are retained, and their rows.

use crate::building::ids::SurfaceId;
use crate::building::pattern::Pattern;

/// The unknowns of a front and their rows.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// Number of surfaces, the eliminated ones first. The air comes after them, then the right-hand side.
    pub(super) surfaces: usize,
    /// Number of eliminated surfaces.
    pub(super) eliminated: usize,
    /// Numbers in a row: all unknowns and the right-hand side, and as many more as fill the last register.
    pub(super) stride: usize,
    /// Row of the first eliminated surface among the unknowns of the building, and rows of the retained unknowns.
    pub(super) first_row: usize,
    pub(super) retained_rows: Vec<usize>,
    /// Places of their entries in the coupled matrix, row by row; none where two of them do not meet.
    pub(super) places: Vec<Option<usize>>,
    /// Places of the entries of each retained row in the column of the air, and of the air in its column.
    pub(super) air_places: Vec<[usize; 2]>,
    /// The eliminated surfaces, those of thick walls last.
    pub(super) walls: Vec<SurfaceId>,
    /// Number of eliminated surfaces whose wall is not thick: its other surface is exterior.
    pub(super) exterior: usize,
}

impl Layout {
    /// Row of an unknown of the front among the unknowns of the building.
    #[inline(always)]
    pub(super) fn row(&self, i: usize) -> usize {
        if i < self.eliminated { self.first_row + i } else { self.retained_rows[i - self.eliminated] }
    }
}

/// Places in the coupled matrix, whose rows begin with `own_rows`, of the entries of some rows in the columns of the same
/// rows.
pub(super) fn places(pattern: &Pattern, own_rows: usize, rows: &[usize]) -> Vec<Option<usize>> {
    let entries = rows.iter().flat_map(|&row| rows.iter().map(move |&column| (row, column)));
    entries.map(|(row, column)| pattern.place(row - own_rows, column - own_rows)).collect()
}

/// Places of the entries between each of some retained rows and the last of them, from [`places`]: they all meet the air.
pub(super) fn air_places(places: &[Option<usize>], count: usize) -> Vec<[usize; 2]> {
    let air = count - 1;
    let pair = |i: usize| Some([places[i * count + air]?, places[air * count + i]?]);
    (0..count).filter_map(pair).collect()
}

/// What is to be eliminated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Elimination {
    /// The matrix with its right-hand side.
    Full,
    /// The right-hand side alone: the matrix is that of the last elimination.
    RightHandSide,
}
