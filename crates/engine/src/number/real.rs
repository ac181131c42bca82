//! The number trait [`Real`] that all physics is written over, and what goes with it: truth values ([`Mask`]), neighbouring
//! numbers of an array ([`Chunk`]), and the equations of a stage whose solution is known ([`Equations`]).
//!
//! The same law runs as a plain `f64` (`plain`), on several ensemble members at once, one in each lane
//! ([`lanes`](super::lanes), [`simd`](super::simd)), with forward derivatives ([`dual`](super::dual)) and on a tape for
//! reverse derivatives ([`tape`](super::tape)).
//!
//! A member must give the same bits alone and in a lane. Therefore elementary functions are our own
//! (`elementary`), lanes apply them element by element, nothing is contracted to fused operations,
//! and code on lane values selects instead of branching.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A truth value per lane.
pub trait Mask: Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// The same answer in every lane.
    fn splat(value: bool) -> Self;
    /// True when any lane is true.
    fn any(self) -> bool;
    /// Answer of one lane.
    fn lane(self, lane: usize) -> bool;
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> bool {
        self
    }
}

/// The logistic function of x, to the base 2.
#[derive(Debug, Clone, Copy)]
pub struct Logistic<S> {
    /// `1/(1 + 2^-x)`.
    pub rise: S,
    /// `1/(1 + 2^x)`, which is `1 - rise`.
    pub rest: S,
    /// `ln(1 + 2^-|x|)`, within 4e-16.
    pub tail: S,
}

impl<S: Real> Logistic<S> {
    /// The slopes of all parts at the x that they belong to.
    #[inline(always)]
    pub(crate) fn slopes(&self, x: S) -> Self {
        let rise = (self.rise * self.rest).scale(core::f64::consts::LN_2);
        let tail = S::select(x.lt(S::zero()), self.rise, -self.rest).scale(core::f64::consts::LN_2);
        Self { rise, rest: -rise, tail }
    }
}

/// A number that the physics can be computed with.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Comparison results.
    type Mask: Mask;
    /// Number of ensemble members carried.
    const LANES: usize;
    /// What the number keeps of the equations whose solution it is part of.
    type Equations: Equations<Self>;
    /// True when the number carries derivatives. (Steps are followed along known solutions; where tests make a whole run of such
    /// numbers, to compare with that, Newton's method adds one iteration, so that derivatives converge too.)
    const DERIVATIVES: bool;
    /// Whether it has single precision.
    const SINGLE: bool = false;
    /// How many neighbouring numbers of an array are computed at once, see [`Chunk`].
    const CHUNK: usize = 1;
    /// Whether [`Self::CHUNK`] of them fit into one or two registers, so that a row of a matrix can stay in registers.
    const IN_REGISTERS: bool = false;

    /// Does a task on neighbouring numbers of an array, [`Self::CHUNK`] of them at once.
    #[inline(always)]
    fn in_chunks<T: ChunkTask<Self>>(task: T) -> T::Output {
        task.run::<Self>()
    }

    /// The same constant in every lane.
    fn constant(value: f64) -> Self;
    /// Value of one lane, without derivatives.
    fn lane(self, lane: usize) -> f64;
    /// Constants that belong to the value of each lane, from a table. (This is for numbers of one lane.)
    #[inline(always)]
    fn look_up<const K: usize>(self, find: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        find(self.lane(0)).map(Self::constant)
    }
    /// Numbers by lane. (Without derivatives, this is for numbers of one lane and for lanes in registers.)
    #[inline(always)]
    fn of_lanes(number: impl Fn(usize) -> f64) -> Self {
        Self::constant(number(0))
    }
    /// The value alone, without derivatives.
    #[inline(always)]
    #[must_use]
    fn fixed(self) -> Self {
        self
    }
    /// The same derivatives at another value.
    #[inline(always)]
    #[must_use]
    fn with_value(self, value: f64) -> Self {
        Self::constant(value)
    }
    /// Whether it has derivatives that are not zero.
    #[inline(always)]
    fn carries(self) -> bool {
        false
    }
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Exponential; the argument is clamped to \[-708, 709\], in single precision to \[-87, 88\].
    #[must_use]
    fn exp(self) -> Self;
    /// Natural logarithm of a positive normal number.
    #[must_use]
    fn ln(self) -> Self;
    /// `x^(-1/3)` of a positive normal number.
    #[must_use]
    fn inverse_cbrt(self) -> Self;
    /// The logistic function to the base 2, and its integral.
    #[must_use]
    fn logistic(self) -> Logistic<Self>;
    /// Sine of an angle in rad.
    #[must_use]
    fn sin(self) -> Self;
    /// Cosine of an angle in rad.
    #[must_use]
    fn cos(self) -> Self;
    /// True where self < other.
    fn lt(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Runs `work` with the vector instructions that this number is made of, if any.
    ///
    /// Only code that is inlined into `work` uses these instructions: hence the `inline(always)` on all physics.
    #[inline(always)]
    fn vectorised<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
    /// Cube root of a positive normal number.
    #[inline(always)]
    #[must_use]
    fn cbrt(self) -> Self {
        let inverse = self.inverse_cbrt();
        self * inverse * inverse
    }
    /// Power of a positive base.
    #[inline(always)]
    #[must_use]
    fn powf(self, exponent: Self) -> Self {
        (exponent * self.ln()).exp()
    }
    /// The smaller one.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
    /// The larger one.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
    /// Magnitude.
    #[inline(always)]
    #[must_use]
    fn abs(self) -> Self {
        Self::select(self.lt(Self::zero()), -self, self)
    }
    /// `sqrt(self^2 + radius^2)`: nearly `|self|`, but smooth at zero, so that its powers have a finite slope there.
    #[inline(always)]
    #[must_use]
    fn smooth_abs(self, radius: f64) -> Self {
        (self * self + Self::constant(radius * radius)).sqrt()
    }
    /// Zero.
    #[inline(always)]
    #[must_use]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// One.
    #[inline(always)]
    #[must_use]
    fn one() -> Self {
        Self::constant(1.0)
    }
    /// Product with a constant.
    #[inline(always)]
    #[must_use]
    fn scale(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }
    /// Fourth power.
    #[inline(always)]
    #[must_use]
    fn pow4(self) -> Self {
        let square = self * self;
        square * square
    }
}

/// A tolerance or a step that depends on the rounding of numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByPrecision {
    pub(crate) double: f64,
    pub(crate) single: f64,
}

impl ByPrecision {
    /// The one for a kind of numbers.
    #[inline(always)]
    pub(crate) fn of<S: Real>(self) -> f64 {
        if const { S::SINGLE } { self.single } else { self.double }
    }
}

/// Whether two numbers have the same bits in all lanes. Never for numbers with derivatives: their slopes may differ.
pub(crate) fn same<S: Real>(a: S, b: S) -> bool {
    !S::DERIVATIVES && (0..S::LANES).all(|lane| a.lane(lane).to_bits() == b.lane(lane).to_bits())
}

/// [`Real::CHUNK`] neighbouring numbers of an array that are computed at once: eight plain numbers, but only one number of any
/// other kind, because it fills registers by itself. Each result has the bits that it would have if it was computed alone.
pub trait Chunk<S: Real>: Real {
    /// The first numbers of a slice.
    fn load(numbers: &[S]) -> Self;
    /// Writes to the first places of a slice.
    fn store(self, numbers: &mut [S]);
    /// The same number in all places.
    fn filled(number: S) -> Self;
    /// A number in one place and zero in all others.
    fn single(number: S, place: usize) -> Self;
    /// The number in one place, copied to all places.
    #[must_use]
    fn broadcast(self, place: usize) -> Self;
    /// The number in the first place.
    fn first(self) -> S;
    /// Numbers by their places in a slice.
    fn gather(numbers: &[S], places: &[usize]) -> Self;
    /// Writes to places of a slice.
    fn scatter(self, numbers: &mut [S], places: &[usize]);
}

impl<S: Real> Chunk<S> for S {
    #[inline(always)]
    fn load(numbers: &[S]) -> Self {
        numbers[0]
    }
    #[inline(always)]
    fn store(self, numbers: &mut [S]) {
        numbers[0] = self;
    }
    #[inline(always)]
    fn filled(number: S) -> Self {
        number
    }
    #[inline(always)]
    fn single(number: S, _place: usize) -> Self {
        number
    }
    #[inline(always)]
    fn broadcast(self, _place: usize) -> Self {
        self
    }
    #[inline(always)]
    fn first(self) -> S {
        self
    }
    #[inline(always)]
    fn gather(numbers: &[S], places: &[usize]) -> Self {
        numbers[places[0]]
    }
    #[inline(always)]
    fn scatter(self, numbers: &mut [S], places: &[usize]) {
        numbers[places[0]] = self;
    }
}

/// Work on neighbouring numbers of an array.
pub trait ChunkTask<S: Real> {
    /// Its result.
    type Output;
    /// Does the work with one kind of registers.
    fn run<V: Chunk<S>>(self) -> Self::Output;
}

// ---------------------------------------------------------------- equations
//
// Let z be the solution of the equations `r(z, p) = 0`. A change dp of the parameters moves it by `dz = A^-1 (dr/dp) dp` with
// `A = -dr/dz` (implicit function theorem). Forward derivatives therefore need only the slopes of r at the solution, where z
// is a constant, and one solve with the factors of the plain matrix A, for all slopes at once. Reverse derivatives keep the
// terms of r, and solve with the transposed matrix in the reverse pass. No elimination is computed with derivatives.
//
// Source: Griewank & Walther (2008), Evaluating Derivatives, 2nd ed., ch. 15, doi:10.1137/1.9780898717761.

/// A factored linear system with plain coefficients: the matrix A of a stage.
pub trait LinearSystem {
    /// Replaces the right-hand sides of all equations by their solution. `scratch` is working memory of any size.
    fn solve<R: Real>(&self, rows: &mut [R], scratch: &mut Vec<R>);
}

/// A term of two equations that is the same in all stages but for the solution: `factors[e] number (known[a] - known[b])` is added to
/// equation `equations[e]`, where `known` are the values of a stage and `between` is `[a, b]`.
#[derive(Debug, Clone, Copy)]
pub struct ConstantTerm<S> {
    /// The number, which stays the same during a run.
    pub number: S,
    /// The values whose difference it multiplies.
    pub between: [usize; 2],
    /// The equations.
    pub equations: [usize; 2],
    /// Its factors in them.
    pub factors: [f64; 2],
}

/// What a kind of number keeps of the equations of a stage. Plain numbers keep nothing.
pub trait Equations<S: Copy>: Clone + Debug + Default + Send + Sync {
    /// Whether the system of each stage is needed once more after the step.
    const SOLVED_LATER: bool = false;

    /// Begins a system of `equations` equations without terms.
    fn begin(&mut self, equations: usize);

    /// Adds terms that are the same in all stages but for the solution. Numbers on a tape do so in the reverse pass.
    fn add_steady(&mut self, terms: &[ConstantTerm<S>], known: &[f64]);

    /// Adds the term `factor * number` to an equation.
    fn add(&mut self, equation: usize, number: S, factor: f64);

    /// Solves the equations of a stage with its factored `system`. `at` is the known solution: the values of `solution`,
    /// whose unknowns are cells, surfaces and zone airs.
    fn solve<L: LinearSystem>(&mut self, stage: usize, system: &L, at: &[f64], solution: [&mut [S]; 3]);
}

impl<S: Copy + Debug> Equations<S> for () {
    fn begin(&mut self, _equations: usize) {}

    fn add_steady(&mut self, _terms: &[ConstantTerm<S>], _known: &[f64]) {}

    fn add(&mut self, _equation: usize, _number: S, _factor: f64) {}

    fn solve<L: LinearSystem>(&mut self, _stage: usize, _system: &L, _at: &[f64], _solution: [&mut [S]; 3]) {}
}
