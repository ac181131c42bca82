//! Identifiers of the parts of a building, and tables indexed by them.
//!
//! A wall has two surfaces, its outside and its inside. A wall is named by its position in the description; a surface by
//! [`SideId`].

use core::ops::{Deref, DerefMut, Index, IndexMut, Range};

/// One of the two surfaces of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SideId(usize);

impl SideId {
    /// The surface of a wall on a side: 0 outside, 1 inside.
    #[must_use]
    #[inline(always)]
    pub const fn new(wall: usize, side: usize) -> Self {
        Self(2 * wall + side)
    }

    /// The outside surface of a wall.
    #[must_use]
    #[inline(always)]
    pub const fn outside(wall: usize) -> Self {
        Self(2 * wall)
    }

    /// The inside surface of a wall.
    #[must_use]
    #[inline(always)]
    pub const fn inside(wall: usize) -> Self {
        Self(2 * wall + 1)
    }

    /// Both surfaces of a wall: outside, inside.
    #[must_use]
    #[inline(always)]
    pub const fn pair(wall: usize) -> [Self; 2] {
        [Self::outside(wall), Self::inside(wall)]
    }

    /// The surface at a position of a table of all surfaces.
    #[must_use]
    #[inline(always)]
    pub const fn from_index(index: usize) -> Self {
        Self(index)
    }

    /// Position in a table of all surfaces.
    #[must_use]
    #[inline(always)]
    pub const fn index(self) -> usize {
        self.0
    }

    /// The wall that it belongs to.
    #[must_use]
    #[inline(always)]
    pub const fn wall(self) -> usize {
        self.0 / 2
    }

    /// Its side of the wall: 0 outside, 1 inside.
    #[must_use]
    #[inline(always)]
    pub const fn side(self) -> usize {
        self.0 % 2
    }

    /// Whether it is the outside surface of its wall.
    #[must_use]
    #[inline(always)]
    pub const fn is_outside(self) -> bool {
        self.0.is_multiple_of(2)
    }

    /// The other surface of its wall.
    #[must_use]
    #[inline(always)]
    pub const fn opposite(self) -> Self {
        Self(self.0 ^ 1)
    }
}

/// A value for each surface of a building, wall by wall, the outside before the inside.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BySide<T>(Vec<T>);

impl<T> BySide<T> {
    /// All surfaces with their values.
    pub fn entries(&self) -> impl Iterator<Item = (SideId, &T)> {
        self.0.iter().enumerate().map(|(index, value)| (SideId(index), value))
    }

    /// The values of neighbouring surfaces, by their places.
    #[inline(always)]
    pub(crate) fn places(&self, places: &Range<usize>) -> &[T] {
        &self.0[places.clone()]
    }

    /// The same, to be changed.
    #[inline(always)]
    pub(crate) fn places_mut(&mut self, places: &Range<usize>) -> &mut [T] {
        &mut self.0[places.clone()]
    }

    /// All surfaces.
    pub fn ids(&self) -> impl Iterator<Item = SideId> + Clone + use<T> {
        (0..self.0.len()).map(SideId)
    }
}

impl<T: Copy> BySide<T> {
    /// The values of both surfaces of a wall: outside, inside.
    #[inline(always)]
    pub fn pair(&self, wall: usize) -> [T; 2] {
        [self.0[2 * wall], self.0[2 * wall + 1]]
    }

    /// Replaces the values of both surfaces of a wall.
    #[inline(always)]
    pub fn set_pair(&mut self, wall: usize, values: [T; 2]) {
        self.0[2 * wall..2 * wall + 2].copy_from_slice(&values);
    }
}

impl<T> From<Vec<T>> for BySide<T> {
    fn from(values: Vec<T>) -> Self {
        Self(values)
    }
}

impl<T> FromIterator<T> for BySide<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl<'a, T> IntoIterator for &'a BySide<T> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a, T> IntoIterator for &'a mut BySide<T> {
    type Item = &'a mut T;
    type IntoIter = core::slice::IterMut<'a, T>;
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}

impl<T> Index<SideId> for BySide<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, surface: SideId) -> &T {
        &self.0[surface.0]
    }
}

impl<T> IndexMut<SideId> for BySide<T> {
    #[inline(always)]
    fn index_mut(&mut self, surface: SideId) -> &mut T {
        &mut self.0[surface.0]
    }
}

impl<T> Deref for BySide<T> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for BySide<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_knows_its_wall_and_the_other_side() {
        for wall in 0..3 {
            let [outside, inside] = SideId::pair(wall);
            assert_eq!((outside.wall(), outside.side()), (wall, 0));
            assert_eq!((inside.wall(), inside.side()), (wall, 1));
            assert_eq!((outside.opposite(), inside.opposite()), (inside, outside));
            assert!(outside.is_outside() && !inside.is_outside());
            assert_eq!(SideId::new(wall, 1), SideId::from_index(inside.index()));
        }
    }

    #[test]
    fn a_table_has_a_pair_for_each_wall() {
        let mut table: BySide<f64> = [1.0, 2.0, 3.0, 4.0].into_iter().collect();
        table.set_pair(1, [7.0, 8.0]);
        assert_eq!((table.pair(0), table.pair(1)), ([1.0, 2.0], [7.0, 8.0]));
        assert_eq!(table[SideId::inside(1)], 8.0);
        assert_eq!(table.ids().count(), 4);
    }
}
