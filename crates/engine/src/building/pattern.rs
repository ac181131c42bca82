//! Where the entries of the coupled matrix and of its factors are stored: row by row, only those that are not zero.
//!
//! Found once from the order of elimination (symbolic factorisation; George & Liu 1989, doi:10.1137/1031001). The pattern is
//! symmetric, the numbers need not be. A pivot row is stored without gaps, and its entries are subtracted from those of a later
//! row in segments that are without gaps in both.

use core::ops::Range;

/// Places of the entries of a sparse matrix and of its factors.
///
/// The elimination reads all of this for each solution: half as many bytes in one array of each kind take less of the fast
/// memory of the processor than the matrix itself.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    rows: Vec<RowPattern>,
    /// Of all rows, row by row: the later rows that it meets one by one, and as runs without gaps.
    later: Vec<LaterRow>,
    reach: Vec<[u32; 2]>,
    /// Of all [`Self::later`].
    segments: Vec<Segment>,
    /// Column of each stored entry.
    columns: Vec<u32>,
}

/// What is known of a row beforehand.
#[derive(Debug, Clone)]
pub(crate) struct RowPattern {
    /// Places of its entries, by column: the first, the diagonal, and behind the last.
    first: u32,
    diagonal: u32,
    end: u32,
    /// Where its later rows, and their runs, begin.
    later: u32,
    reach: u32,
}

/// A row that the elimination of an earlier one changes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaterRow {
    row: u32,
    entry: u32,
    /// Where its segments begin.
    segments: u32,
}

/// Entries of a pivot row and of a later row in the same columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Segment {
    /// Entries of the pivot row, counted from the one behind its diagonal.
    of_pivot: [u32; 2],
    /// Place of the first in the later row.
    place: u32,
}

/// An index as it is stored.
#[allow(clippy::cast_possible_truncation, reason = "a matrix of so many entries does not fit into memory")]
fn short(index: usize) -> u32 {
    debug_assert!(u32::try_from(index).is_ok());
    index as u32
}

impl RowPattern {
    /// Place of its diagonal.
    #[inline(always)]
    pub(crate) fn diagonal(&self) -> usize {
        self.diagonal as usize
    }

    /// Place behind its last entry.
    #[inline(always)]
    pub(crate) fn end(&self) -> usize {
        self.end as usize
    }
}

impl LaterRow {
    /// The row.
    #[inline(always)]
    pub(crate) fn row(&self) -> usize {
        self.row as usize
    }

    /// Place of its entry in the column of the pivot.
    #[inline(always)]
    pub(crate) fn entry(&self) -> usize {
        self.entry as usize
    }
}

impl Segment {
    /// Entries of the pivot row, counted from the one behind its diagonal.
    #[inline(always)]
    pub(crate) fn of_pivot(&self) -> Range<usize> {
        self.of_pivot[0] as usize..self.of_pivot[1] as usize
    }

    /// Place of the first in the later row.
    #[inline(always)]
    pub(crate) fn place(&self) -> usize {
        self.place as usize
    }
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
        let mut pattern = Self {
            rows: Vec::with_capacity(later.len() + 1),
            later: Vec::new(),
            reach: Vec::new(),
            segments: Vec::new(),
            columns: Vec::new(),
        };
        let (mut before_later, mut before_reach) = (0, 0);
        for (k, mut own) in of_row.into_iter().enumerate() {
            own.sort_unstable();
            let start = pattern.columns.len();
            let before = own.partition_point(|&column| column < k);
            pattern.columns.extend(own.into_iter().map(short));
            let runs = runs(&later[k]);
            pattern.rows.push(RowPattern {
                first: short(start),
                diagonal: short(start + before),
                end: short(pattern.columns.len()),
                later: short(before_later),
                reach: short(before_reach),
            });
            before_later += later[k].len();
            before_reach += runs.len();
            pattern.reach.extend(runs.iter().map(|run| [short(run.start), short(run.end)]));
        }
        // One more of each tells where the last one ends.
        let end = short(pattern.columns.len());
        let (later_rows, reach) = (short(before_later), short(before_reach));
        pattern.rows.push(RowPattern { first: end, diagonal: end, end, later: later_rows, reach });
        for (k, coupled) in later.iter().enumerate() {
            for &row in coupled {
                pattern.add_later_row(k, row, coupled);
            }
        }
        pattern.later.push(LaterRow { row: 0, entry: 0, segments: short(pattern.segments.len()) });
        pattern
    }

    fn add_later_row(&mut self, pivot: usize, row: usize, coupled: &[usize]) {
        let first = self.segments.len();
        for (i, &column) in coupled.iter().enumerate() {
            let (here, i) = (short(self.place_of_coupled(row, column)), short(i));
            match self.segments[first..].last_mut() {
                Some(last) if last.place + (last.of_pivot[1] - last.of_pivot[0]) == here => {
                    last.of_pivot[1] = i + 1;
                }
                _ => self.segments.push(Segment { of_pivot: [i, i + 1], place: here }),
            }
        }
        let entry = short(self.place_of_coupled(row, pivot));
        self.later.push(LaterRow { row: short(row), entry, segments: short(first) });
    }

    fn place_of_coupled(&self, row: usize, column: usize) -> usize {
        self.place(row, column).unwrap_or_else(|| unreachable!("elimination couples all that a pivot meets"))
    }

    /// Later rows that a row meets, one by one.
    #[inline(always)]
    pub(crate) fn later(&self, row: usize) -> &[LaterRow] {
        &self.later[self.rows[row].later as usize..self.rows[row + 1].later as usize]
    }

    /// The same with what the elimination of the row changes in each.
    #[inline(always)]
    pub(crate) fn changes(&self, row: usize) -> impl Iterator<Item = (&LaterRow, &[Segment])> {
        let places = self.rows[row].later as usize..=self.rows[row + 1].later as usize;
        self.later[places].windows(2).map(
            #[inline(always)]
            |rows| (&rows[0], &self.segments[rows[0].segments as usize..rows[1].segments as usize]),
        )
    }

    /// Later rows that a row meets, as runs without gaps.
    #[inline(always)]
    pub(crate) fn reach(&self, row: usize) -> impl Iterator<Item = Range<usize>> {
        self.reach[self.rows[row].reach as usize..self.rows[row + 1].reach as usize].iter().map(
            #[inline(always)]
            |&[start, end]| start as usize..end as usize,
        )
    }

    /// Number of unknowns.
    pub(crate) fn size(&self) -> usize {
        self.rows.len() - 1
    }

    /// Number of stored entries.
    pub(crate) fn entries(&self) -> usize {
        self.columns.len()
    }

    #[inline(always)]
    pub(crate) fn row(&self, row: usize) -> &RowPattern {
        &self.rows[row]
    }

    /// Place of the first entry of a row; behind the last row, the number of entries.
    pub(crate) fn start(&self, row: usize) -> usize {
        self.rows[row].first as usize
    }

    /// Place of an entry; none where the matrix and its factors are zero.
    pub(crate) fn place(&self, row: usize, column: usize) -> Option<usize> {
        let row = &self.rows[row];
        let (first, column) = (row.first as usize, u32::try_from(column).ok()?);
        let found = self.columns[first..row.end()].binary_search(&column).ok()?;
        Some(first + found)
    }
}

/// Ascending numbers gathered into runs without gaps.
fn runs(numbers: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some(run) if run.end == number => run.end += 1,
            _ => runs.push(number..number + 1),
        }
    }
    runs
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
        let changes = |row: usize| -> Vec<(usize, usize, Vec<(Range<usize>, usize)>)> {
            let of = |segment: &Segment| (segment.of_pivot(), segment.place());
            let all = pattern.changes(row);
            all.map(|(later, segments)| (later.row(), later.entry(), segments.iter().map(of).collect()))
                .collect()
        };
        assert_eq!(changes(0)[0], (1, 3, vec![(0..1, 4), (1..2, 6)]));
        // Row 2 has columns 2 and 3 side by side.
        assert_eq!(changes(1)[0].2, [(0..2, 8)]);
        assert_eq!(changes(2), [(3, 13 - 1, vec![(0..1, 13)])]);
        assert!(changes(3).is_empty() && pattern.reach(0).eq([1..2, 3..4]));
    }

    #[test]
    fn runs_of_numbers() {
        assert_eq!(runs(&[1, 2, 3, 7, 9, 10]), [1..4, 7..8, 9..11]);
        assert!(runs(&[]).is_empty());
    }
}
