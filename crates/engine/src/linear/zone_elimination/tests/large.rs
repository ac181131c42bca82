//! Large fronts, which are solved by iteration: against the dense solver, in lanes, and where the iteration is given up.

use super::super::conjugate::{Symmetric, length_of_line};
use super::*;

/// Sizes with whole and partly filled registers, with none, one and some retained surfaces.
fn sizes() -> impl Iterator<Item = (usize, usize)> {
    [(1, 1), (2, 1), (7, 7), (8, 8), (9, 8), (16, 13), (33, 33), (40, 38), (70, 69), (130, 126)].into_iter()
}

fn large_front<S: Real>(surfaces: usize, eliminated: usize, nonlinear: bool) -> ZoneFront<S> {
    let mut front = front::<S>(surfaces, eliminated, nonlinear);
    front.make_large();
    front
}

#[test]
fn large_fronts_are_solved_as_the_dense_solver_solves_them() {
    for (surfaces, eliminated) in sizes() {
        for nonlinear in [false, true] {
            let context = format!("{surfaces} surfaces, {eliminated} eliminated, nonlinear {nonlinear}");
            let pattern = pattern(surfaces + 1 - eliminated);
            let mut front = large_front::<f64>(surfaces, eliminated, nonlinear);
            let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
            let found = solve(&mut front, &mut coupled, Elimination::Full, false);
            let (matrix, right) = balances(&front);
            close(&found, &dense_solution(&matrix, &right), 1e-12, &context);
            let mut heat = Numbers::new(11).line(surfaces + 1);
            let padded = [&heat[..], &vec![0.0; eliminated]].concat();
            let expected = dense_solution(&matrix, &padded);
            front.forward_in_building(&mut heat);
            coupled.solve_again(&mut heat);
            front.back_in_building(&mut heat);
            close(&heat, &expected[..=surfaces], 1e-12, &format!("another right-hand side: {context}"));
        }
    }
}

/// The balances of the eliminated surfaces close to round-off of the heat that they exchange.
#[test]
fn balances_of_large_fronts_close() {
    for (surfaces, eliminated) in sizes() {
        let pattern = pattern(surfaces + 1 - eliminated);
        let mut front = large_front::<f64>(surfaces, eliminated, true);
        let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
        let found = solve(&mut front, &mut coupled, Elimination::Full, false);
        let (matrix, right) = balances(&front);
        for (i, (row, &right)) in matrix.chunks(found.len()).zip(&right).enumerate() {
            let terms = || row.iter().zip(&found).map(|(a, x)| a * x);
            let (sum, size): (f64, f64) = (terms().sum(), terms().map(f64::abs).sum());
            assert!(
                (sum - right).abs() < 1e-14 * (size + right.abs()),
                "row {i} of {surfaces}: {}",
                sum - right
            );
        }
    }
}

struct LargeFronts;

fn large_fronts<S: Real>() -> Vec<S> {
    let mut all = Vec::new();
    for (surfaces, eliminated) in sizes() {
        for nonlinear in [false, true] {
            let pattern = pattern(surfaces + 1 - eliminated);
            let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
            let mut front = large_front::<S>(surfaces, eliminated, nonlinear);
            all.extend(solve(&mut front, &mut coupled, Elimination::Full, false));
            let mut heat: Vec<S> = Numbers::new(11).line(surfaces + 1).into_iter().map(S::constant).collect();
            front.forward_in_building(&mut heat);
            coupled.solve_again(&mut heat);
            front.back_in_building(&mut heat);
            all.extend(heat);
        }
    }
    all
}

impl LaneTask for LargeFronts {
    type Output = Vec<u64>;
    fn run<S: Real>(self, _: impl Fn(&[f64]) -> S + Copy) -> Vec<u64> {
        S::vectorised(large_fronts::<S>).iter().map(|value| value.lane(WIDTH - 1).to_bits()).collect()
    }
    fn without_lanes(self) -> Vec<u64> {
        large_fronts::<f64>().iter().map(|value| value.to_bits()).collect()
    }
}

#[test]
fn lanes_give_the_bits_of_a_large_front_alone() {
    let plain: Vec<_> = large_fronts::<f64>().iter().map(|value| value.to_bits()).collect();
    for level in Level::available() {
        assert_eq!(run(level, LargeFronts), plain, "{level:?}");
    }
}

/// A matrix for each lane: some lanes need more iterations than others, or have a right-hand side of zeros.
struct Lines;

/// Exchange areas, diagonal and two right-hand sides; the diagonal is a given part of the exchange areas.
fn equations<S: Real>(n: usize, part: S, right: S) -> (Vec<S>, Vec<S>, Vec<S>) {
    let (stride, line) = ((n + 2).next_multiple_of(S::CHUNK), length_of_line(n));
    let mut numbers = Numbers::new(n as u64);
    let mut rows = vec![S::zero(); stride * stride];
    for i in 0..n {
        for j in (0..i).filter(|j| i - j < 6) {
            let exchange: S = numbers.next();
            (rows[i * stride + j], rows[j * stride + i]) = (-exchange, -exchange);
            rows[i * stride + i] += exchange;
            rows[j * stride + j] += exchange;
        }
    }
    let mut diagonal = vec![S::zero(); stride];
    let mut lines = vec![S::zero(); 2 * line];
    for i in 0..n {
        diagonal[i] = part * numbers.next();
        lines[i] = right * numbers.next();
        lines[line + i] = numbers.next();
    }
    (rows, diagonal, lines)
}

fn lines<S: Real>(parts: S, rights: S, most: usize) -> Vec<S> {
    let n = 45;
    let (rows, diagonal, mut lines) = equations(n, parts, rights);
    let stride = (n + 2).next_multiple_of(S::CHUNK);
    Symmetric { rows: &rows, stride, diagonal: &diagonal, unknowns: n }.solve_within(&mut lines, most);
    lines
}

/// Diagonals as parts of the exchange areas, and right-hand sides, lane by lane.
const PARTS: [f64; WIDTH] = [1.0, 1e-3, 10.0, 0.1, 1.0, 1e3, 0.5, 2.0];
const RIGHTS: [f64; WIDTH] = [1.0, 1.0, 0.0, 1e-9, 0.0, 5.0, 1.0, -1.0];

impl LaneTask for Lines {
    type Output = Vec<[u64; WIDTH]>;
    fn run<S: Real>(self, pack: impl Fn(&[f64]) -> S + Copy) -> Vec<[u64; WIDTH]> {
        let all = [5, 1000].map(|most| lines(pack(&PARTS), pack(&RIGHTS), most));
        let bits = |number: &S| core::array::from_fn(|lane| number.lane(lane).to_bits());
        all.iter().flat_map(|lines| lines.iter().map(bits).collect::<Vec<_>>()).collect()
    }
    fn without_lanes(self) -> Vec<[u64; WIDTH]> {
        alone()
    }
}

fn alone() -> Vec<[u64; WIDTH]> {
    let of_lane = |lane: usize| [5, 1000].map(|most| lines(PARTS[lane], RIGHTS[lane], most)).concat();
    let lanes: [Vec<f64>; WIDTH] = core::array::from_fn(of_lane);
    (0..lanes[0].len()).map(|k| core::array::from_fn(|lane| lanes[lane][k].to_bits())).collect()
}

/// A lane that has converged, or that is eliminated in the end, keeps its bits while others go on.
#[test]
fn a_lane_does_not_depend_on_the_others() {
    for level in Level::available() {
        assert_eq!(run(level, Lines), alone(), "{level:?}");
    }
}

/// Where the iteration takes too long the equations are eliminated: the same solution.
#[test]
fn equations_that_take_too_many_iterations_are_eliminated() {
    for (part, right) in PARTS.into_iter().zip(RIGHTS) {
        let (few, many) = (lines(part, right, 2), lines(part, right, 1000));
        close(&few, &many, 1e-11, &format!("{part} of the exchange areas"));
    }
}
