//! Identifiers of the parts of a building, and tables indexed by them.
//!
//! A wall has two surfaces, its outside and its inside. A wall is named by its position in the description; a surface by
//! [`SurfaceId`].

use core::ops::{Deref, DerefMut, Index, IndexMut};

/// One of the two surfaces of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SurfaceId(usize);

impl SurfaceId {
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
pub struct BySurface<T>(Vec<T>);

impl<T> BySurface<T> {
    /// All surfaces with their values.
    pub fn entries(&self) -> impl Iterator<Item = (SurfaceId, &T)> {
        self.0.iter().enumerate().map(|(index, value)| (SurfaceId(index), value))
    }

    /// All surfaces.
    pub fn ids(&self) -> impl Iterator<Item = SurfaceId> + Clone + use<T> {
        (0..self.0.len()).map(SurfaceId)
    }
}

impl<T: Copy> BySurface<T> {
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

impl<T> From<Vec<T>> for BySurface<T> {
    fn from(values: Vec<T>) -> Self {
        Self(values)
    }
}

impl<T> FromIterator<T> for BySurface<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl<'a, T> IntoIterator for &'a BySurface<T> {
    type Item = &'a T;
    type IntoIter = core::slice::Iter<'a, T>;
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a, T> IntoIterator for &'a mut BySurface<T> {
    type Item = &'a mut T;
    type IntoIter = core::slice::IterMut<'a, T>;
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}

impl<T> Index<SurfaceId> for BySurface<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, surface: SurfaceId) -> &T {
        &self.0[surface.0]
    }
}

impl<T> IndexMut<SurfaceId> for BySurface<T> {
    #[inline(always)]
    fn index_mut(&mut self, surface: SurfaceId) -> &mut T {
        &mut self.0[surface.0]
    }
}

impl<T> Deref for BySurface<T> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for BySurface<T> {
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
            let [outside, inside] = SurfaceId::pair(wall);
            assert_eq!((outside.wall(), outside.side()), (wall, 0));
            assert_eq!((inside.wall(), inside.side()), (wall, 1));
            assert_eq!((outside.opposite(), inside.opposite()), (inside, outside));
            assert!(outside.is_outside() && !inside.is_outside());
            assert_eq!(SurfaceId::new(wall, 1), SurfaceId::from_index(inside.index()));
        }
    }

    #[test]
    fn a_table_has_a_pair_for_each_wall() {
        let mut table: BySurface<f64> = [1.0, 2.0, 3.0, 4.0].into_iter().collect();
        table.set_pair(1, [7.0, 8.0]);
        assert_eq!((table.pair(0), table.pair(1)), ([1.0, 2.0], [7.0, 8.0]));
        assert_eq!(table[SurfaceId::inside(1)], 8.0);
        assert_eq!(table.ids().count(), 4);
    }
}
