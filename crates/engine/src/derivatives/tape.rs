//! A number that remembers how it was made, and the tape on which it does.
//!
//! Each thread has a tape of its own. It grows while physics runs with [`Taped`] numbers; [`Tape::pull`] then carries
//! weights on results back to what they depend on. A number that depends on nothing takes no place.

use core::cell::RefCell;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use crate::real::{Logistic, Real};

thread_local! {
    static TAPE: RefCell<Tape> = const { RefCell::new(Tape { entries: Vec::new() }) };
}

/// Place of what depends on nothing.
const NOWHERE: u32 = 0;

/// One number: the places of the two that it was made of, and its slopes by them.
#[derive(Debug, Clone, Copy)]
struct Entry {
    of: [u32; 2],
    slope: [f64; 2],
}

/// Everything that was computed on a thread since the tape was cleared.
#[derive(Debug)]
pub(super) struct Tape {
    entries: Vec<Entry>,
}

impl Tape {
    /// Forgets everything.
    pub(super) fn clear() {
        TAPE.with_borrow_mut(|tape| {
            tape.entries.clear();
            tape.entries.push(Entry { of: [NOWHERE; 2], slope: [0.0; 2] });
        });
    }

    /// Number of entries.
    pub(super) fn len() -> usize {
        TAPE.with_borrow(|tape| tape.entries.len())
    }

    /// Forgets what follows the first `len` entries.
    pub(super) fn cut(len: usize) {
        TAPE.with_borrow_mut(|tape| tape.entries.truncate(len));
    }

    /// Carries weights back from the end of the tape to the entry `to`. Those of the entries passed become zero.
    pub(super) fn pull(weights: &mut Vec<f64>, to: usize) {
        TAPE.with_borrow(|tape| {
            weights.resize(tape.entries.len(), 0.0);
            for (k, entry) in tape.entries.iter().enumerate().skip(to).rev() {
                let weight = weights[k];
                if weight != 0.0 {
                    weights[k] = 0.0;
                    weights[entry.of[0] as usize] += weight * entry.slope[0];
                    weights[entry.of[1] as usize] += weight * entry.slope[1];
                }
            }
        });
    }
}

/// A value and its place on the tape of this thread.
#[derive(Debug, Clone, Copy)]
pub(super) struct Taped {
    value: f64,
    place: u32,
}

impl Taped {
    /// A number that others may depend on.
    pub(super) fn variable(value: f64) -> Self {
        Self { value, place: push(Entry { of: [NOWHERE; 2], slope: [0.0; 2] }) }
    }

    /// Where its weight is found; that of a number which depends on nothing goes nowhere.
    pub(super) fn place(self) -> usize {
        self.place as usize
    }

    #[inline(always)]
    fn fixed(value: f64) -> Self {
        Self { value, place: NOWHERE }
    }

    /// f(self) from the value and slope of f.
    #[inline(never)]
    fn chain(self, value: f64, slope: f64) -> Self {
        self.join(NOWHERE, value, [slope, 0.0])
    }

    // Called, not inlined: physics is large enough without a copy of this for each of its operations.
    #[inline(never)]
    fn join(self, other: u32, value: f64, slope: [f64; 2]) -> Self {
        if self.place == NOWHERE && other == NOWHERE {
            return Self::fixed(value);
        }
        // What differs from another number by a constant has its slopes, and needs no place of its own.
        if other == NOWHERE && slope[0] == 1.0 {
            return Self { value, place: self.place };
        }
        if self.place == NOWHERE && slope[1] == 1.0 {
            return Self { value, place: other };
        }
        Self { value, place: push(Entry { of: [self.place, other], slope }) }
    }
}

#[inline(always)]
fn push(entry: Entry) -> u32 {
    TAPE.with_borrow_mut(|tape| {
        let place = tape.entries.len();
        tape.entries.push(entry);
        u32::try_from(place).expect("one step makes far fewer than 2^32 numbers")
    })
}

impl Add for Taped {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.join(other.place, self.value + other.value, [1.0, 1.0])
    }
}
impl Sub for Taped {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.join(other.place, self.value - other.value, [1.0, -1.0])
    }
}
impl Mul for Taped {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.join(other.place, self.value * other.value, [other.value, self.value])
    }
}
impl Div for Taped {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = 1.0 / other.value;
        self.join(other.place, value, [inverse, -value * inverse])
    }
}
impl Neg for Taped {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}
impl AddAssign for Taped {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Real for Taped {
    type Mask = bool;
    const LANES: usize = 1;
    const DERIVATIVES: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::fixed(value)
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self.value
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline(never)]
    fn exp(self) -> Self {
        let value = Real::exp(self.value);
        self.chain(value, value)
    }
    #[inline(never)]
    fn ln(self) -> Self {
        self.chain(Real::ln(self.value), 1.0 / self.value)
    }
    #[inline(never)]
    fn logistic(self) -> Logistic<Self> {
        let at = self.value.logistic();
        let slopes = at.slopes(self.value);
        Logistic {
            rise: self.chain(at.rise, slopes.rise),
            rest: self.chain(at.rest, slopes.rest),
            tail: self.chain(at.tail, slopes.tail),
        }
    }
    #[inline(never)]
    fn inverse_cbrt(self) -> Self {
        // d x^(-1/3)/dx = -1/3 x^(-4/3)
        let y = self.value.inverse_cbrt();
        let square = y * y;
        self.chain(y, square * square * (-1.0 / 3.0))
    }
    #[inline(never)]
    fn sin(self) -> Self {
        self.chain(Real::sin(self.value), Real::cos(self.value))
    }
    #[inline(never)]
    fn cos(self) -> Self {
        self.chain(Real::cos(self.value), -Real::sin(self.value))
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes of a function of two variables.
    fn slopes(f: impl Fn(Taped, Taped) -> Taped, at: [f64; 2]) -> [f64; 2] {
        Tape::clear();
        let [x, y] = at.map(Taped::variable);
        let result = f(x, y);
        let mut weights = vec![0.0; Tape::len()];
        weights[result.place()] = 1.0;
        Tape::pull(&mut weights, y.place() + 1);
        [weights[x.place()], weights[y.place()]]
    }

    #[test]
    fn every_operation_is_carried_back() {
        let f = |x: Taped, y: Taped| {
            let mut sum = (x * y).exp() / y.sqrt() - x.scale(3.0) * x.cbrt();
            sum += y.ln() * x.sin() - (-y).cos() + x.max(y) + Taped::constant(2.0) * x.powf(y);
            sum
        };
        let value = |x: f64, y: f64| {
            (x * y).exp() / y.sqrt() - 3.0 * x * x.cbrt() + y.ln() * x.sin() - y.cos()
                + x.max(y)
                + 2.0 * x.powf(y)
        };
        let (x, y, h) = (1.3, 0.7, 1e-6);
        let [by_x, by_y] = slopes(f, [x, y]);
        assert!((by_x - (value(x + h, y) - value(x - h, y)) / (2.0 * h)).abs() < 1e-8);
        assert!((by_y - (value(x, y + h) - value(x, y - h)) / (2.0 * h)).abs() < 1e-8);
    }

    #[test]
    fn what_depends_on_nothing_takes_no_place() {
        Tape::clear();
        let two = Taped::constant(2.0);
        let _ = (two * two).exp() + two;
        assert_eq!(Tape::len(), 1);
    }
}
