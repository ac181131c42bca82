//! A chain of cells eliminated onto its two ends: the tridiagonal system of a wall, and the engine's only solver for it.
//!
//! Cell i exchanges heat along link i with the cell (or the outside surface) before it and along link i + 1 with the cell (or
//! the inside surface) behind it. In one implicit stage each cell satisfies
//!
//! `storage_i T_i = heat_i + flux_i - flux_(i+1)` with `flux_i = left_i T_(i-1) - right_i T_i + offset_i`.
//!
//! Gaussian elimination from outside to inside leaves
//!
//! `T_i = known_i + to_outside_i T_outside + next_i T_(i+1)`,
//!
//! where the inside surface follows the last cell. The heat that the wall sends into its surfaces is then an affine function of
//! both surface temperatures. Storage is positive and each column sums up to it, so that the matrix is an M-matrix: pivots
//! are positive in the order of the cells.
//!
//! Nothing is subtracted. A thin sheet of metal conducts `k/d` = 1e6 W/(m2 K) from cell to cell and stores 100 W/(m2 K) in a
//! stage: as a difference of conductances the storage would keep ten digits only, and the heat balance of a wall would not
//! close. Instead the sums of the columns, which are storage, pass from each eliminated cell to what is left, and pivots are sums of
//! positive numbers (Grassmann, Taksar & Heyman 1985, Oper. Res. 33(5), doi:10.1287/opre.33.5.1107, for stochastic matrices). Every
//! factor then keeps all its digits.
//!
//! Right-hand sides may be of another kind of number than the matrix, see [`Product`].

use crate::linear::product::Product;
use crate::number::real::Real;

/// Heat flux along a link, `left x_left - right x_right + offset` [W/m2], positive towards the inside. For cells x is the
/// temperature above the one that their tangent touches at, for surfaces the temperature.
#[derive(Debug, Clone, Copy)]
pub struct Link<S> {
    /// Slope of the flux by the temperature on the outer side [W/(m2 K)].
    pub left: S,

    /// Slope of the flux by the temperature on the inner side, with the opposite sign [W/(m2 K)].
    pub right: S,

    /// Part that depends on neither [W/m2].
    pub offset: S,
}

impl<S: Real> Link<S> {
    /// Flux between two temperatures.
    #[inline(always)]
    pub fn flux(&self, left: S, right: S) -> S {
        self.left * left - self.right * right + self.offset
    }
}

/// Heat that the wall sends into its surfaces, `source_e + sum_o response_eo T_o` [W/m2].
#[derive(Debug, Clone, Copy)]
pub struct Condensed<S> {
    /// Heat into the outside and the inside surface at surfaces of 0 degC [W/m2].
    pub source: [S; 2],

    /// How heat into the surfaces follows their temperatures.
    pub response: Response<S>,
}

/// Heat that a wall sends into its surfaces per degree of each of them.
#[derive(Debug, Clone, Copy)]
pub struct Response<S> {
    /// Heat into the other surface by the outside and by the inside surface [W/(m2 K)].
    pub across: [S; 2],

    /// What the wall stores of the heat that it takes from a surface, by that surface [W/(m2 K)].
    pub stored: [S; 2],
}

impl<S: Real> Response<S> {
    /// No heat.
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { across: [S::zero(); 2], stored: [S::zero(); 2] }
    }

    /// Heat into a surface by its own temperature [W/(m2 K)]: what it loses, not positive.
    #[inline(always)]
    pub(crate) fn own(&self, e: usize) -> S {
        -(self.across[e] + self.stored[e])
    }

    /// Heat into a surface by the temperature of the other one [W/(m2 K)].
    #[inline(always)]
    pub(crate) fn other(&self, e: usize) -> S {
        self.across[1 - e]
    }

    /// Heat into a surface at temperatures of both [W/m2].
    #[inline(always)]
    pub(crate) fn heat(&self, e: usize, surfaces: [S; 2]) -> S {
        self.own(e) * surfaces[e] + self.other(e) * surfaces[1 - e]
    }

    /// Heat into surface e per degree of surface o [W/(m2 K)].
    #[cfg(test)]
    pub(crate) fn matrix(&self) -> [[S; 2]; 2] {
        [[self.own(0), self.other(0)], [self.other(1), self.own(1)]]
    }
}

/// The factors of a chain of cells.
#[derive(Debug, Clone)]
pub(crate) struct Tridiagonal<S> {
    /// One over the pivots [m2 K/W].
    inverse: Vec<S>,
    /// `T_i = known_i + to_outside_i T_outside + next_i T_(i+1)`.
    known: Vec<S>,
    to_outside: Vec<S>,
    next: Vec<S>,
    /// Heat into the outside surface per degree of `known` of each cell [W/(m2 K)].
    path: Vec<S>,
}

impl<S: Real> Tridiagonal<S> {
    /// For a number of cells.
    pub(crate) fn new(cells: usize) -> Self {
        let zeros = || vec![S::zero(); cells];
        Self { inverse: zeros(), known: zeros(), to_outside: zeros(), next: zeros(), path: zeros() }
    }

    /// Eliminates the cells from the matrix. `storage`: heat per degree of each cell [W/(m2 K)].
    #[inline(always)]
    pub(crate) fn factor(&mut self, links: &[Link<S>], storage: impl Fn(usize) -> S) -> Response<S> {
        self.eliminate::<false>(links, storage, |_| S::zero()).response
    }

    /// Eliminates the cells from the matrix and from the right-hand side; [`Self::cells`] then gives the cells. `heat`: what is
    /// released in each cell beside the fluxes along the links [W/m2].
    #[inline(always)]
    pub(crate) fn condense(
        &mut self,
        links: &[Link<S>],
        storage: impl Fn(usize) -> S,
        heat: impl Fn(usize) -> S,
    ) -> Condensed<S> {
        self.eliminate::<true>(links, storage, heat)
    }

    /// The elimination, with its right-hand side or without.
    #[inline(always)]
    fn eliminate<const RIGHT: bool>(
        &mut self,
        links: &[Link<S>],
        storage: impl Fn(usize) -> S,
        heat: impl Fn(usize) -> S,
    ) -> Condensed<S> {
        let n = self.inverse.len();
        // Slices of a common length: the compiler then leaves out the checks of the indices.
        let links = &links[..=n];
        let (inverses, nexts) = (&mut self.inverse[..n], &mut self.next[..n]);
        let (to_outsides, knowns) = (&mut self.to_outside[..n], &mut self.known[..n]);
        let paths = &mut self.path[..n];
        let (outer, inner) = (&links[0], &links[n]);
        if n == 0 {
            let response = Response { across: [outer.left, outer.right], stored: [S::zero(); 2] };
            return Condensed { source: [-outer.offset, outer.offset], response };
        }
        // Of the node before: the outside surface is its own. `passed` is what it stores by the temperature of this cell.
        let (mut known, mut to_outside, mut passed) = (S::zero(), S::one(), S::zero());
        // Heat into the outside surface: its known part, by the next node, and what is stored by its own temperature.
        let (mut first, mut path, mut stored) = (S::zero(), outer.right, S::zero());
        for i in 0..n {
            let (before, after) = (&links[i], &links[i + 1]);
            let mut holds = storage(i);
            // Nothing is before the first cell. Numbers on a tape are spared the sum where it is not in a hot loop.
            if const { RIGHT } || i > 0 {
                holds += passed;
            }
            let inverse = S::one() / (holds + path + after.left);
            if const { RIGHT } {
                let right = heat(i) + before.offset - after.offset;
                known = (right + before.left * known) * inverse;
                first += path * known;
                knowns[i] = known;
            }
            let next = after.right * inverse;
            to_outside = before.left * to_outside * inverse;
            stored += holds * to_outside;
            passed = holds * next;
            (inverses[i], nexts[i], to_outsides[i], paths[i]) = (inverse, next, to_outside, path);
            path = path * next;
        }
        Condensed {
            source: [first - outer.offset, inner.left * known + inner.offset],
            response: Response { across: [inner.left * to_outside, path], stored: [stored, passed] },
        }
    }

    /// Temperatures of the cells after [`Self::condense`] from those of the surfaces, from the last cell to the first; `write` is given each with
    /// the place of the cell.
    #[inline(always)]
    pub(crate) fn cells<P>(
        &self,
        [outside, inside]: [S; 2],
        places: impl DoubleEndedIterator<Item = P> + ExactSizeIterator,
        write: impl Fn(P, S),
    ) {
        let mut behind = inside;
        let factors = self.known.iter().zip(&self.to_outside).zip(&self.next);
        for (place, ((&known, &to_outside), &next)) in places.zip(factors).rev() {
            behind = known + to_outside * outside + next * behind;
            write(place, behind);
        }
    }

    /// Eliminates the cells from another right-hand side. `heat` gives the heat released in a cell [W/m2] from its number and
    /// the value in `known`, which is replaced by what [`Self::back`] needs. Returns the heat into the surfaces [W/m2].
    #[inline(always)]
    pub(crate) fn forward<P: Product<S, R>, R: Real>(
        &self,
        links: &[Link<S>],
        known: &mut [R],
        heat: impl Fn(usize, R) -> R,
    ) -> [R; 2] {
        let (mut first, mut before) = (R::zero(), R::zero());
        for (i, known) in known.iter_mut().enumerate() {
            let mut right = heat(i, *known);
            if i > 0 {
                right += P::of(links[i].left, before);
            }
            before = P::of(self.inverse[i], right);
            *known = before;
            first += P::of(self.path[i], before);
        }
        [first, P::of(links[self.inverse.len()].left, before)]
    }

    /// Cell temperatures from those of the surfaces and from what [`Self::forward`] left in `known`.
    #[inline(always)]
    pub(crate) fn back<P: Product<S, R>, R: Real>(
        &self,
        known: impl Fn(usize, R) -> R,
        [outside, inside]: [R; 2],
        cells: &mut [R],
    ) {
        let mut behind = inside;
        for (i, cell) in cells.iter_mut().enumerate().rev() {
            behind = known(i, *cell) + P::of(self.to_outside[i], outside) + P::of(self.next[i], behind);
            *cell = behind;
        }
    }
}

impl<S: Real> Tridiagonal<S> {
    /// [`Self::back`] with surfaces of 0 degC.
    #[inline(always)]
    pub(crate) fn back_between_zeros(&self, cells: &mut [S]) {
        let mut behind = S::zero();
        for (cell, &next) in cells.iter_mut().zip(&self.next).rev() {
            behind = *cell + next * behind;
            *cell = behind;
        }
    }
}

impl Tridiagonal<f64> {
    /// The transpose of [`Self::back`] in place: weights on the surfaces from weights on the cells, which become weights on what
    /// `forward` left.
    #[inline(always)]
    pub(crate) fn back_transposed(&self, cells: &mut [f64]) -> [f64; 2] {
        let (mut outside, mut behind) = (0.0, 0.0);
        for (i, cell) in cells.iter_mut().enumerate() {
            *cell += behind;
            outside += self.to_outside[i] * *cell;
            behind = self.next[i] * *cell;
        }
        [outside, behind]
    }

    /// The transpose of [`Self::forward`] in place: weights on heat released in the cells from weights on heat into the surfaces
    /// and on what `forward` left.
    #[inline(always)]
    pub(crate) fn forward_transposed(
        &self,
        links: &[Link<f64>],
        [outside, inside]: [f64; 2],
        cells: &mut [f64],
    ) {
        let mut behind = links[self.inverse.len()].left * inside;
        for (i, cell) in cells.iter_mut().enumerate().rev() {
            let weight = (*cell + behind + outside * self.path[i]) * self.inverse[i];
            *cell = weight;
            behind = links[i].left * weight;
        }
    }
}

#[cfg(test)]
mod tests;
