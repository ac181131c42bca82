//! Where the entries of the coupled matrix and of its factors are stored: row by row, only those that are not zero.
//!
//! Found once from the order of elimination (symbolic factorisation; George & Liu 1989, doi:10.1137/1031001). The pattern is
//! symmetric, the numbers need not be. A pivot row is stored without gaps, and its entries are subtracted from those of a later
//! row in segments that are without gaps in both.

use core::ops::Range;

/// So many last rows, or fewer, are stored as if all of them met: they are eliminated in less time without their gaps
/// (`linear/coupled/dense.rs`).
pub(crate) const DENSE: usize = 6;

/// Places of the entries of a sparse matrix and of its factors.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    rows: Vec<RowPattern>,
    /// Column of each stored entry.
    columns: Vec<usize>,
}

/// What is known of a row beforehand.
#[derive(Debug, Clone)]
pub(crate) struct RowPattern {
    /// Places of its entries, by column.
    pub(crate) entries: Range<usize>,
    /// Place of the diagonal.
    pub(crate) diagonal: usize,
    /// Later rows that it meets, and what its elimination does to them.
    pub(crate) later: Vec<LaterRow>,
}

/// A row that the elimination of an earlier one changes.
#[derive(Debug, Clone)]
pub(crate) struct LaterRow {
    /// The row.
    pub(crate) row: usize,
    /// Place of its entry in the column of the pivot.
    pub(crate) entry: usize,
    /// Entries that change.
    pub(crate) segments: Vec<Segment>,
}

/// Entries of a pivot row and of a later row in the same columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Segment {
    /// Entries of the pivot row, counted from the one behind its diagonal.
    pub(crate) of_pivot: Range<usize>,
    /// Place of the first in the later row.
    pub(crate) place: usize,
}

impl Pattern {
    /// The pattern of a matrix whose rows meet these later rows (ascending), fill-in included.
    pub(crate) fn new(later: &[Vec<usize>]) -> Self {
        let mut of_row: Vec<Vec<usize>> = vec![Vec::new(); later.len()];
        for (k, coupled) in later.iter().enumerate() {
            // Earlier pivots come first: columns ascend.
            of_row[k].push(k);
            of_row[k].extend(coupled);
            for &row in coupled {
                of_row[row].push(k);
            }
        }
        let (mut rows, mut columns) = (Vec::with_capacity(later.len()), Vec::new());
        for (k, mut own) in of_row.into_iter().enumerate() {
            own.sort_unstable();
            let start = columns.len();
            let before = own.partition_point(|&column| column < k);
            columns.extend(own);
            rows.push(RowPattern {
                entries: start..columns.len(),
                diagonal: start + before,
                later: Vec::new(),
            });
        }
        let mut pattern = Self { rows, columns };
        for (k, coupled) in later.iter().enumerate() {
            let changed = coupled.iter().map(|&row| pattern.later_row(k, row, coupled)).collect();
            pattern.rows[k].later = changed;
        }
        pattern
    }

    fn later_row(&self, pivot: usize, row: usize, coupled: &[usize]) -> LaterRow {
        let place = |column| {
            self.place(row, column)
                .unwrap_or_else(|| unreachable!("elimination couples all that a pivot meets"))
        };
        let mut segments: Vec<Segment> = Vec::new();
        for (i, &column) in coupled.iter().enumerate() {
            let here = place(column);
            match segments.last_mut() {
                Some(last) if last.place + last.of_pivot.len() == here => last.of_pivot.end = i + 1,
                _ => segments.push(Segment { of_pivot: i..i + 1, place: here }),
            }
        }
        LaterRow { row, entry: place(pivot), segments }
    }

    /// Number of unknowns.
    pub(crate) fn size(&self) -> usize {
        self.rows.len()
    }

    /// Number of stored entries.
    pub(crate) fn entries(&self) -> usize {
        self.columns.len()
    }

    /// Place behind the stored entries, for what belongs to none of them.
    pub(crate) fn nowhere(&self) -> usize {
        self.columns.len()
    }

    #[inline(always)]
    pub(crate) fn row(&self, row: usize) -> &RowPattern {
        &self.rows[row]
    }

    #[inline(always)]
    pub(crate) fn rows(&self, rows: Range<usize>) -> &[RowPattern] {
        &self.rows[rows]
    }

    /// Place of the first entry of a row; behind the last row, the number of entries.
    pub(crate) fn start(&self, row: usize) -> usize {
        self.rows.get(row).map_or(self.columns.len(), |row| row.entries.start)
    }

    /// Place of an entry; none where the matrix and its factors are zero.
    pub(crate) fn place(&self, row: usize, column: usize) -> Option<usize> {
        let row = &self.rows[row];
        let found = self.columns[row.entries.clone()].binary_search(&column).ok()?;
        Some(row.entries.start + found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row 0 meets 1 and 3, which meet each other and 2: entries by column, and the segments of the first elimination.
    #[test]
    fn entries_stand_row_by_row() {
        let pattern = Pattern::new(&[vec![1, 3], vec![2, 3], vec![3], vec![]]);
        let found: Vec<Vec<bool>> =
            (0..4).map(|row| (0..4).map(|column| pattern.place(row, column).is_some()).collect()).collect();
        let (x, o) = (true, false);
        assert_eq!(found, [[x, x, o, x], [x, x, x, x], [o, x, x, x], [x, x, x, x]]);
        assert_eq!(pattern.entries(), 14);
        // Row 1: columns 0 to 3 at places 3 to 6; columns 1 and 3 are not side by side there.
        let LaterRow { row, entry, segments } = &pattern.row(0).later[0];
        let expected = [Segment { of_pivot: 0..1, place: 4 }, Segment { of_pivot: 1..2, place: 6 }];
        assert_eq!((*row, *entry, &segments[..]), (1, 3, &expected[..]));
        // Row 2 has columns 2 and 3 side by side.
        assert_eq!(pattern.row(1).later[0].segments, [Segment { of_pivot: 0..2, place: 8 }]);
    }
}
