//! A number that remembers how it was made, and the tape on which it does.
//!
//! Each thread has a tape of its own. It grows while physics runs with [`Taped`] numbers; [`Tape::pull`] then carries
//! weights on results back to what they depend on.
//!
//! A number that depends on nothing takes no place, nor does one that depends on a single entry, by however many
//! functions: it keeps its slope by that entry. Only where two of them meet an entry is made.

use core::cell::RefCell;
use core::mem::ManuallyDrop;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Range, Sub};

use crate::number::real::{Equations, LinearSystem, Logistic, Real};

thread_local! {
    // Cleared after each use; what is never dropped is reached faster.
    static TAPE: ManuallyDrop<RefCell<Tape>> = const { ManuallyDrop::new(RefCell::new(Tape::new())) };
}

#[inline(always)]
fn with_tape<R>(work: impl FnOnce(&mut Tape) -> R) -> R {
    TAPE.with(|tape| work(&mut tape.borrow_mut()))
}

/// Place of what depends on nothing.
const NOWHERE: u32 = 0;

/// One number: the places of the two that it was made of, and its slopes by them.
#[derive(Debug, Clone, Copy)]
struct Entry {
    of: [u32; 2],
    slope: [f64; 2],
}

/// What an equation was made of, a term at a time: `slope` times the number at `of` is added to it.
#[derive(Debug, Clone, Copy)]
struct Term {
    equation: u32,
    of: u32,
    slope: f64,
}

/// Equations that were solved together: their terms, and the entries of their unknowns.
#[derive(Debug, Clone)]
struct Solve {
    stage: usize,
    terms: Range<usize>,
    unknowns: Range<usize>,
}

/// Everything that was computed on a thread since the tape was cleared.
#[derive(Debug)]
pub(crate) struct Tape {
    entries: Vec<Entry>,
    terms: Vec<Term>,
    solves: Vec<Solve>,
}

impl Tape {
    const fn new() -> Self {
        Self { entries: Vec::new(), terms: Vec::new(), solves: Vec::new() }
    }

    /// Forgets everything.
    pub(crate) fn clear() {
        with_tape(|tape| {
            *tape = Self::new();
            tape.entries.push(Entry { of: [NOWHERE; 2], slope: [0.0; 2] });
        });
    }

    /// Makes entries for so many numbers that others may depend on; the place of the first.
    pub(crate) fn reserve(numbers: usize) -> u32 {
        with_tape(|tape| {
            let first = tape.entries.len();
            tape.entries.resize(first + numbers, Entry { of: [NOWHERE; 2], slope: [0.0; 2] });
            narrow(first)
        })
    }

    /// Number of entries.
    pub(crate) fn len() -> usize {
        with_tape(|tape| tape.entries.len())
    }

    /// Forgets what follows the first `len` entries, and all equations.
    pub(crate) fn cut(len: usize) {
        with_tape(|tape| {
            tape.entries.truncate(len);
            tape.terms.clear();
            tape.solves.clear();
        });
    }

    /// Carries weights back from the end of the tape to the entry `to`. Those of the entries passed become zero.
    /// `transposed` turns weights on the unknowns of a stage into weights on its equations.
    pub(crate) fn pull(weights: &mut Vec<f64>, to: usize, mut transposed: impl FnMut(usize, &mut [f64])) {
        with_tape(|tape| {
            if weights.len() < tape.entries.len() {
                weights.resize(tape.entries.len(), 0.0);
            }
            let mut end = tape.entries.len();
            for solve in tape.solves.iter().rev() {
                tape.pull_entries(weights, solve.unknowns.end..end);
                end = solve.unknowns.start;
                let (before, unknowns) = weights.split_at_mut(end);
                let unknowns = &mut unknowns[..solve.unknowns.len()];
                transposed(solve.stage, unknowns);
                for term in &tape.terms[solve.terms.clone()] {
                    before[term.of as usize] += term.slope * unknowns[term.equation as usize];
                }
                unknowns.fill(0.0);
            }
            tape.pull_entries(weights, to..end);
        });
    }

    fn pull_entries(&self, weights: &mut [f64], range: Range<usize>) {
        let first = range.start;
        for (k, entry) in self.entries[range].iter().enumerate().rev() {
            let weight = weights[first + k];
            if weight != 0.0 {
                weights[first + k] = 0.0;
                weights[entry.of[0] as usize] += weight * entry.slope[0];
                weights[entry.of[1] as usize] += weight * entry.slope[1];
            }
        }
    }
}

/// The terms of equations until they are solved.
#[derive(Debug, Clone, Default)]
pub struct EquationTerms {
    terms: Vec<Term>,
    equations: usize,
}

impl Equations<Taped> for EquationTerms {
    #[inline(always)]
    fn begin(&mut self, equations: usize) {
        self.terms.clear();
        self.equations = equations;
    }

    #[inline(always)]
    fn add(&mut self, equation: usize, number: Taped, factor: f64) {
        if number.place != NOWHERE && factor != 0.0 {
            let slope = factor * number.slope;
            self.terms.push(Term { equation: narrow(equation), of: number.place, slope });
        }
    }

    fn solve<L: LinearSystem>(&mut self, stage: usize, _system: &L, at: &[f64], solution: [&mut [Taped]; 3]) {
        with_tape(|tape| {
            let (first, terms) = (tape.entries.len(), tape.terms.len());
            tape.entries.resize(first + self.equations, Entry { of: [NOWHERE; 2], slope: [0.0; 2] });
            tape.terms.extend_from_slice(&self.terms);
            let (terms, unknowns) = (terms..tape.terms.len(), first..tape.entries.len());
            tape.solves.push(Solve { stage, terms, unknowns });
            for (k, (unknown, &value)) in solution.into_iter().flatten().zip(at).enumerate() {
                *unknown = Taped::new(value, narrow(first + k));
            }
        });
    }
}

/// A place, narrow enough for the tape.
#[inline(always)]
fn narrow(place: usize) -> u32 {
    u32::try_from(place).expect("one step makes far fewer than 2^32 numbers")
}

/// A value, and the entry of the tape of this thread that it depends on, with its slope by it.
#[derive(Debug, Clone, Copy)]
pub struct Taped {
    value: f64,
    slope: f64,
    place: u32,
}

impl Taped {
    /// A number that others may depend on.
    pub(crate) fn variable(value: f64) -> Self {
        Self::new(value, push(Entry { of: [NOWHERE; 2], slope: [0.0; 2] }))
    }

    /// Adds to the weight of what this depends on.
    pub(crate) fn weigh(self, weight: f64, weights: &mut [f64]) {
        if weight != 0.0 {
            weights[self.place as usize] += self.slope * weight;
        }
    }

    /// The number at a place.
    #[inline(always)]
    pub(crate) fn new(value: f64, place: u32) -> Self {
        Self { value, slope: 1.0, place }
    }

    #[inline(always)]
    fn of(value: f64) -> Self {
        Self { value, slope: 0.0, place: NOWHERE }
    }

    /// f(self) from the value and slope of f.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, slope: self.slope * slope, place: self.place }
    }

    /// f(self, other) from the value and slopes of f.
    #[inline(always)]
    fn join(self, other: Self, value: f64, slope: [f64; 2]) -> Self {
        let slope = [self.slope * slope[0], other.slope * slope[1]];
        if other.place == NOWHERE {
            Self { value, slope: slope[0], place: self.place }
        } else if self.place == NOWHERE {
            Self { value, slope: slope[1], place: other.place }
        } else if self.place == other.place {
            Self { value, slope: slope[0] + slope[1], place: self.place }
        } else {
            Self::new(value, push(Entry { of: [self.place, other.place], slope }))
        }
    }
}

// Called, not inlined: physics is large enough without a copy of this for each of its operations.
#[inline(never)]
fn push(entry: Entry) -> u32 {
    with_tape(|tape| {
        let place = tape.entries.len();
        tape.entries.push(entry);
        narrow(place)
    })
}

impl Add for Taped {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.join(other, self.value + other.value, [1.0, 1.0])
    }
}
impl Sub for Taped {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.join(other, self.value - other.value, [1.0, -1.0])
    }
}
impl Mul for Taped {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.join(other, self.value * other.value, [other.value, self.value])
    }
}
impl Div for Taped {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = 1.0 / other.value;
        self.join(other, value, [inverse, -value * inverse])
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
    type Equations = EquationTerms;
    const LANES: usize = 1;
    const DERIVATIVES: bool = true;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::of(value)
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self.value
    }
    #[inline(always)]
    fn fixed(self) -> Self {
        Self::of(self.value)
    }
    #[inline(always)]
    fn carries(self) -> bool {
        self.place != NOWHERE
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
#[allow(clippy::disallowed_methods, reason = "compared with the functions of the standard library")]
mod tests {
    use super::*;

    /// Slopes of a function of two variables.
    fn slopes(f: impl Fn(Taped, Taped) -> Taped, at: [f64; 2]) -> [f64; 2] {
        Tape::clear();
        let [x, y] = at.map(Taped::variable);
        let result = f(x, y);
        let mut weights = vec![0.0; Tape::len()];
        result.weigh(1.0, &mut weights);
        Tape::pull(&mut weights, 3, |_, _| {});
        [weights[1], weights[2]]
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
