//! Reverse derivatives: numbers that record their operations on a tape.
//!
//! The tape is the list of all operations in the order in which they were computed. An entry holds the places of its
//! operands and the partial derivatives by them. Propagation goes through the list from its end and turns weights
//! on results (the derivatives of the chosen quantity by each of them) into weights on what they were computed from.
//! Each thread has a tape of its own, which exists only while a recording does.
//!
//! A number that depends on nothing has no entry. Neither has one that depends on a single entry, by however many
//! functions: it keeps its slope by that entry. Only where two entries meet a new one is made.
//!
//! Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 3 and 4, doi:10.1137/1.9780898717761.

use core::cell::RefCell;
use core::marker::PhantomData;
use core::mem::ManuallyDrop;
use core::ops::{Add, Div, Mul, Neg, Range, Sub};

use crate::number::macros::{add_assign, chain_rule};
use crate::number::real::{ConstantTerm, Equations, LinearSystem, Logistic, Real};

thread_local! {
    // Emptied by each recording at its end; a value without a destructor is reached faster.
    static TAPE: ManuallyDrop<RefCell<Tape>> = const { ManuallyDrop::new(RefCell::new(Tape::new())) };
}

#[inline(always)]
fn with_tape<R>(work: impl FnOnce(&mut Tape) -> R) -> R {
    TAPE.with(|tape| work(&mut tape.borrow_mut()))
}

/// Place of a number that depends on nothing: the first entry, which is no operation.
const NOWHERE: u32 = 0;

/// One operation: the places of its operands, and its partial derivatives by them.
#[derive(Debug, Clone, Copy)]
struct Entry {
    of: [u32; 2],
    slope: [f64; 2],
}

impl Entry {
    /// A variable: no operation.
    const VARIABLE: Self = Self { of: [NOWHERE; 2], slope: [0.0; 2] };
}

/// A term of an equation: `slope` times the number at `of` is added to it.
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
    terms: Vec<Term>,
    unknowns: Range<usize>,
}

/// The operations of a thread since its recording began.
#[derive(Debug)]
pub(crate) struct Tape {
    entries: Vec<Entry>,
    solves: Vec<Solve>,
    /// Memory of the terms of earlier solves, to be used again.
    unused: Vec<Vec<Term>>,
    /// Entries of variables, to be copied: the unknowns of a stage are many.
    variables: Vec<Entry>,
}

impl Tape {
    const fn new() -> Self {
        Self { entries: Vec::new(), solves: Vec::new(), unused: Vec::new(), variables: Vec::new() }
    }

    /// Begins a recording on the tape of this thread.
    pub(crate) fn record() -> Recording {
        with_tape(|tape| {
            *tape = Self::new();
            tape.entries.push(Entry::VARIABLE);
        });
        Recording(PhantomData)
    }

    /// Makes entries for so many variables; the place of the first.
    pub(crate) fn reserve(numbers: usize) -> u32 {
        with_tape(|tape| {
            let first = tape.entries.len();
            tape.entries.resize(first + numbers, Entry::VARIABLE);
            narrow(first)
        })
    }

    /// Number of entries.
    pub(crate) fn len() -> usize {
        with_tape(|tape| tape.entries.len())
    }

    /// Keeps the first `len` entries, and no equations.
    pub(crate) fn truncate(len: usize) {
        with_tape(|tape| {
            tape.entries.truncate(len);
            tape.unused.extend(tape.solves.drain(..).map(|solve| solve.terms));
        });
    }

    /// Propagates weights from the end of the tape back to the entry `to`. Those of the entries passed become zero.
    /// `transposed` turns weights on the unknowns of a stage into weights on its equations, and may add to those on the entries before.
    pub(crate) fn propagate(
        weights: &mut Vec<f64>,
        to: usize,
        mut transposed: impl FnMut(usize, &mut [f64], &mut [f64]),
    ) {
        with_tape(|tape| {
            if weights.len() < tape.entries.len() {
                weights.resize(tape.entries.len(), 0.0);
            }
            let mut end = tape.entries.len();
            for solve in tape.solves.iter().rev() {
                tape.propagate_entries(weights, solve.unknowns.end..end);
                end = solve.unknowns.start;
                let (before, unknowns) = weights.split_at_mut(end);
                let unknowns = &mut unknowns[..solve.unknowns.len()];
                transposed(solve.stage, unknowns, before);
                for term in &solve.terms {
                    before[term.of as usize] += term.slope * unknowns[term.equation as usize];
                }
                unknowns.fill(0.0);
            }
            tape.propagate_entries(weights, to..end);
        });
    }

    fn propagate_entries(&self, weights: &mut [f64], range: Range<usize>) {
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

/// Adds the weights on the numbers of steady terms, from weights on the equations of a stage.
pub(crate) fn add_steady_weights(
    terms: &[ConstantTerm<Taped>],
    known: &[f64],
    equations: &[f64],
    weights: &mut [f64],
) {
    for &ConstantTerm { number, between: [a, b], equations: [i, j], factors } in terms {
        let slope = (known[a] - known[b]) * (factors[0] * equations[i] + factors[1] * equations[j]);
        weights[number.place as usize] += number.slope * slope;
    }
}

/// A recording on the tape of this thread. Its end releases the memory of the tape, also after an error or a panic.
// Not Send: it belongs to the tape of one thread.
#[derive(Debug)]
pub(crate) struct Recording(PhantomData<*const ()>);

impl Drop for Recording {
    fn drop(&mut self) {
        TAPE.with(|tape| {
            if let Ok(mut tape) = tape.try_borrow_mut() {
                *tape = Tape::new();
            }
        });
    }
}

/// Memory that the tape of this thread holds [bytes]: none outside a recording.
pub fn memory() -> usize {
    with_tape(|tape| {
        let terms = tape.solves.iter().map(|solve| &solve.terms).chain(&tape.unused);
        (tape.entries.capacity() + tape.variables.capacity()) * size_of::<Entry>()
            + tape.solves.capacity() * size_of::<Solve>()
            + tape.unused.capacity() * size_of::<Vec<Term>>()
            + terms.map(|terms| terms.capacity() * size_of::<Term>()).sum::<usize>()
    })
}

/// The terms of equations until they are solved.
#[derive(Debug, Clone, Default)]
pub struct EquationTerms {
    terms: Vec<Term>,
    equations: usize,
}

impl Equations<Taped> for EquationTerms {
    const SOLVED_LATER: bool = true;

    #[inline(always)]
    fn begin(&mut self, equations: usize) {
        self.terms.clear();
        self.equations = equations;
    }

    /// They need no place on the tape, see `add_steady_weights`.
    #[inline(always)]
    fn add_steady(&mut self, _terms: &[ConstantTerm<Taped>], _known: &[f64]) {}

    #[inline(always)]
    fn add(&mut self, equation: usize, number: Taped, factor: f64) {
        let slope = factor * number.slope;
        if slope != 0.0 {
            self.terms.push(Term { equation: narrow(equation), of: number.place, slope });
        }
    }

    fn solve<L: LinearSystem>(&mut self, stage: usize, _system: &L, at: &[f64], solution: [&mut [Taped]; 3]) {
        with_tape(|tape| {
            let first = tape.entries.len();
            if tape.variables.len() < self.equations {
                tape.variables.resize(self.equations, Entry::VARIABLE);
            }
            tape.entries.extend_from_slice(&tape.variables[..self.equations]);
            let terms = core::mem::replace(&mut self.terms, tape.unused.pop().unwrap_or_default());
            tape.solves.push(Solve { stage, terms, unknowns: first..tape.entries.len() });
            let (mut values, mut place) = (at, narrow(first));
            for unknowns in solution {
                let (own, rest) = values.split_at(unknowns.len());
                for (unknown, &value) in unknowns.iter_mut().zip(own) {
                    *unknown = Taped::new(value, place);
                    place += 1;
                }
                values = rest;
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
    /// A variable: a number with an entry of its own.
    pub(crate) fn variable(value: f64) -> Self {
        Self::new(value, push(Entry::VARIABLE))
    }

    /// Adds to the weight on the entry that this depends on.
    pub(crate) fn add_weight(self, weight: f64, weights: &mut [f64]) {
        if weight != 0.0 && self.slope != 0.0 {
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

    /// f(self, other) from the value and slopes of f. A number with the slope zero keeps no place: it may be read after the
    /// tape was shortened, such as a sun of zero that later steps do not evaluate again, and its place then belongs to another number.
    #[inline(always)]
    fn join(self, other: Self, value: f64, slope: [f64; 2]) -> Self {
        let slope = [self.slope * slope[0], other.slope * slope[1]];
        if slope[1] == 0.0 {
            let place = if slope[0] == 0.0 { NOWHERE } else { self.place };
            Self { value, slope: slope[0], place }
        } else if slope[0] == 0.0 {
            Self { value, slope: slope[1], place: other.place }
        } else if self.place == other.place {
            Self { value, slope: slope[0] + slope[1], place: self.place }
        } else {
            Self::new(value, push(Entry { of: [self.place, other.place], slope }))
        }
    }
}

// One copy only: inlining into each operation of the physics multiplies compile time.
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
add_assign!([] Taped);

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
    #[inline(always)]
    fn with_value(self, value: f64) -> Self {
        Self { value, ..self }
    }
    // One copy only: inlining multiplies compile time.
    chain_rule!(never);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::dual::Dual;

    /// The value of a function of two variables and its slopes by them.
    fn slopes(f: impl Fn(Taped, Taped) -> Taped, at: [f64; 2]) -> [f64; 3] {
        let _recording = Tape::record();
        let [x, y] = at.map(Taped::variable);
        let result = f(x, y);
        let mut weights = vec![0.0; Tape::len()];
        result.add_weight(1.0, &mut weights);
        Tape::propagate(&mut weights, 3, |_, _, _| {});
        [result.value, weights[1], weights[2]]
    }

    /// All operations and functions of a number, for x and y above zero.
    fn operations<S: Real>(x: S, y: S) -> Vec<S> {
        let [of_x, of_y] = [x, -y].map(S::logistic);
        let mut sum = x * y;
        sum += x / y;
        vec![
            sum,
            x - y.scale(3.0),
            (x * y).exp() / y.sqrt() - x.scale(3.0) * x.cbrt(),
            y.ln() * x.sin() - (-y).cos(),
            x.max(y) * x.min(y) + (x - y).abs(),
            S::constant(2.0) * x.powf(y) - y.inverse_cbrt(),
            of_x.rise * of_y.rest + of_y.tail / of_x.rest,
            S::select(x.lt(y), x * x, y.pow4()) * (x - y).smooth_abs(0.3),
            x.fixed() * y + (x - x.fixed()) + S::one() - S::zero(),
        ]
    }

    #[test]
    fn slopes_of_all_operations_are_those_of_forward_derivatives() {
        for at in [[1.3, 0.7], [0.4, 2.6], [7.0, 0.02]] {
            let [x, y] = [0, 1].map(|which| Dual::<2>::variable(at[which], which));
            for (k, forward) in operations(x, y).into_iter().enumerate() {
                let [value, by_x, by_y] = slopes(|x, y| operations(x, y)[k], at);
                assert_eq!(value.to_bits(), forward.value.to_bits(), "value {k} at {at:?}");
                for (reverse, forward) in [by_x, by_y].into_iter().zip(forward.slope) {
                    let error = (reverse - forward).abs() / forward.abs().max(1.0);
                    assert!(error < 1e-14, "slope {k} at {at:?}: {reverse} is not {forward}");
                }
            }
        }
    }

    #[test]
    fn slopes_agree_with_their_closed_forms() {
        // f = x^2 y + e^x / y: df/dx = 2 x y + e^x / y, df/dy = x^2 - e^x / y^2.
        let [value, by_x, by_y] = slopes(|x, y| x * x * y + x.exp() / y, [2.0, 4.0]);
        let exp = Real::exp(2.0);
        assert_eq!(value, 16.0 + exp / 4.0);
        assert!((by_x - (16.0 + exp / 4.0)).abs() < 1e-14 && (by_y - (4.0 - exp / 16.0)).abs() < 1e-14);
    }

    #[test]
    fn a_steady_term_collects_the_weights_on_both_of_its_equations() {
        let _recording = Tape::record();
        // 7 p with p = 1.5 is multiplied by 5 - 3, and -2 and 3 times that are added to equations of weights 0.5 and -2.
        let number = Taped::variable(1.5).scale(7.0);
        let term = ConstantTerm { number, between: [0, 2], equations: [0, 1], factors: [-2.0, 3.0] };
        let mut weights = [0.0; 2];
        add_steady_weights(&[term], &[5.0, 1.0, 3.0], &[0.5, -2.0], &mut weights);
        assert_eq!(weights, [0.0, 7.0 * 2.0 * (-2.0 * 0.5 + 3.0 * -2.0)]);
    }

    #[test]
    fn constants_have_no_entry() {
        let _recording = Tape::record();
        let two = Taped::constant(2.0);
        let _ = (two * two).exp() + two;
        assert_eq!(Tape::len(), 1);
        let x = Taped::variable(3.0);
        let _ = (x * two).exp() + x;
        assert_eq!(Tape::len(), 2, "functions of one variable need no entry more");
    }

    #[test]
    fn the_end_of_a_recording_releases_its_memory() {
        let record = |panics: bool| {
            let _recording = Tape::record();
            let x = Taped::variable(1.0);
            (0..1000).fold(x, |sum, k| sum * Taped::variable(f64::from(k)));
            assert!(memory() > 1000 * size_of::<Entry>());
            assert!(!panics, "a panic on purpose");
        };
        record(false);
        assert_eq!(memory(), 0);
        assert!(std::panic::catch_unwind(|| record(true)).is_err());
        assert_eq!(memory(), 0);
    }
}
