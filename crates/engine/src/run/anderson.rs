//! Anderson acceleration of a fixed-point iteration: the next iterate from the last ones and their images.
//!
//! Of the weighted mean of the last images, whose weights add up to one, those weights are taken that make the same mean of the
//! residuals (image less iterate) smallest. For a linear map this is as fast as GMRES. Sources: Anderson (1965),
//! doi:10.1145/321296.321305; Walker & Ni (2011), doi:10.1137/10078356X.

use std::collections::VecDeque;

use crate::number::real::{ByPrecision, Mask, Real};

/// Part of the square of a change that must not lie in the space of newer changes: otherwise it says nothing new, only round-off.
const NEW_PART: ByPrecision = ByPrecision { double: 1e-10, single: 1e-4 };

/// What is known of a map from the last iterates.
#[derive(Debug, Clone)]
pub(crate) struct Anderson<S> {
    /// Weight of the square of each number in the size of a residual.
    weights: Vec<S>,
    depth: usize,
    /// Image and residual of the last iterate.
    last: [Vec<S>; 2],
    /// Changes of image and residual from one iterate to the next; the newest ones first.
    changes: VecDeque<[Vec<S>; 2]>,
}

impl<S: Real> Anderson<S> {
    /// Knows one iterate by its image and residual, and will remember `depth` changes from one to the next.
    pub(crate) fn new(weights: Vec<S>, depth: usize, image: &[S], residual: &[S]) -> Self {
        Self { weights, depth, last: [image.to_vec(), residual.to_vec()], changes: VecDeque::new() }
    }

    fn product(&self, a: &[S], b: &[S]) -> S {
        let pairs = self.weights.iter().zip(a.iter().zip(b));
        pairs.fold(S::zero(), |sum, (&weight, (&a, &b))| sum + weight * a * b)
    }

    /// Square of the size of a residual.
    pub(crate) fn square(&self, residual: &[S]) -> S {
        self.product(residual, residual)
    }

    /// Learns from another iterate, in the lanes of a mask; all others forget the changes that they know.
    pub(crate) fn learn(&mut self, mask: S::Mask, image: &[S], residual: &[S]) {
        let oldest = if self.changes.len() < self.depth { None } else { self.changes.pop_back() };
        let size = image.len();
        let mut change = oldest.unwrap_or_else(|| [vec![S::zero(); size], vec![S::zero(); size]]);
        for ((change, last), now) in change.iter_mut().zip(&mut self.last).zip([image, residual]) {
            for ((change, last), &now) in change.iter_mut().zip(last).zip(now) {
                *change = S::select(mask, now - *last, S::zero());
                *last = S::select(mask, now, *last);
            }
        }
        if (!mask).any() {
            for number in self.changes.iter_mut().flatten().flatten() {
                *number = S::select(mask, *number, S::zero());
            }
        }
        self.changes.push_front(change);
    }

    /// The next iterate: the last image less the share of each change that makes the residual smallest.
    pub(crate) fn next(&self) -> Vec<S> {
        let [image, _] = &self.last;
        let mut next = image.clone();
        for (share, [change, _]) in self.shares().into_iter().zip(&self.changes) {
            for (next, &change) in next.iter_mut().zip(change) {
                *next = *next - share * change;
            }
        }
        next
    }

    /// Shares of the changes in the last residual, by the normal equations: `L D L^T` of the Gram matrix of the scaled changes.
    /// A change that lies in the space of newer ones is left out.
    fn shares(&self) -> Vec<S> {
        let (count, [_, residual]) = (self.changes.len(), &self.last);
        let residuals: Vec<&[S]> = self.changes.iter().map(|[_, residual]| &residual[..]).collect();
        let mut lower = vec![vec![S::zero(); count]; count];
        let (mut scales, mut inverse) = (vec![S::zero(); count], vec![S::zero(); count]);
        let mut shares = vec![S::zero(); count];
        for i in 0..count {
            let square = self.square(residuals[i]);
            let some = S::constant(f64::MIN_POSITIVE).lt(square);
            scales[i] = S::select(some, S::one() / square.sqrt(), S::zero());
            // First the entries of `L D`, then those of `L`.
            for j in 0..i {
                let product = self.product(residuals[i], residuals[j]) * scales[i] * scales[j];
                lower[i][j] = (0..j).fold(product, |rest, k| rest - lower[i][k] * lower[j][k]);
            }
            let mut pivot = S::select(some, S::one(), S::zero());
            shares[i] = self.product(residuals[i], residual) * scales[i];
            for k in 0..i {
                let entry = lower[i][k] * inverse[k];
                pivot = pivot - entry * lower[i][k];
                shares[i] = shares[i] - entry * shares[k];
                lower[i][k] = entry;
            }
            let new = S::constant(NEW_PART.of::<S>()).lt(pivot);
            inverse[i] = S::select(new, S::one() / pivot, S::zero());
        }
        for i in (0..count).rev() {
            let own = shares[i] * inverse[i];
            shares[i] = (i + 1..count).fold(own, |rest, k| rest - lower[k][i] * shares[k]);
        }
        shares.iter().zip(scales).map(|(&share, scale)| share * scale).collect()
    }
}
