//! Fronts of 1 to 40 surfaces: against a dense solver, without a residual, with the same bits in all numbers and by both
//! eliminations, and their transpose.

mod large;

use super::eliminate::Factors;
use super::exterior::Exterior;
use super::front::ZoneFront;
use super::fronts::{Eliminate, Solve};
use super::laws::Laws;
use super::layout::{Elimination, Layout, air_places, places};
use crate::building::ids::SideId;
use crate::building::pattern::Pattern;
use crate::linear::coupled::CoupledSystem;
use crate::linear::surface_balance::SurfaceLaws;
use crate::linear::testing::{Numbers, adjoint, close, dense_solution};
use crate::linear::wall::Response;
use crate::number::dual::Dual;
use crate::number::lanes::Lanes;
use crate::number::line::Line;
use crate::number::real::{Chunk, ChunkTask, Real};
use crate::number::simd::{LaneTask, Level, WIDTH, run};

/// What the rest of the building does to each retained unknown: a conductance to 0 degC [W/K], and heat [W].
const HELD: f64 = 2.0;
const WARMTH: f64 = 30.0;

/// A random front of some surfaces, the first of them eliminated; their emission is nonlinear or not.
fn front<S: Real>(surfaces: usize, eliminated: usize, nonlinear: bool) -> ZoneFront<S> {
    let mut numbers = Numbers::new(7 + 31 * surfaces as u64 + eliminated as u64);
    let ids: Vec<_> = (0..surfaces).map(SideId::inside).collect();
    let retained_rows: Vec<usize> = (eliminated..=surfaces).collect();
    let places = places(&pattern(retained_rows.len()), eliminated, &retained_rows);
    let layout = Layout {
        zones: vec![0],
        members: 1,
        surfaces,
        eliminated,
        stride: (surfaces + 2).next_multiple_of(S::CHUNK),
        first_rows: vec![0],
        air_places: air_places(&places, retained_rows.len()),
        places,
        register_places: Vec::new(),
        retained_rows,
        exterior: eliminated,
        windows: 0,
        walls: ids[..eliminated].to_vec(),
    };
    let stride = layout.stride;
    let mut line = |offset: f64| Line { offset: numbers.next::<S>().scale(offset), slope: numbers.next() };
    let laws: Vec<_> = (0..2 * surfaces)
        .map(|_| SurfaceLaws { convection: line(3.0), emission: line(if nonlinear { 300.0 } else { 0.0 }) })
        .collect();
    let mut interior = Laws::new(&ids, stride, &laws.clone().into());
    interior.emission[1][surfaces..].fill(S::one());
    if nonlinear {
        interior.set_emission_nonlinear();
    }
    let outside: Vec<_> = layout.walls.iter().map(|surface| surface.opposite()).collect();
    let exterior = Exterior::blank(Laws::new(&outside, stride, &laws.into()), stride);
    let mut front = ZoneFront::blank(layout, interior, exterior);
    for i in 0..surfaces {
        front.area[i] = numbers.next();
        front.heat[i] = numbers.next::<S>().scale(100.0);
        for j in 0..i {
            let exchange: S = numbers.next();
            for (a, b) in [(i, j), (j, i)] {
                front.equations.exchange[a * stride + b] = -exchange;
                front.equations.exchange[a * stride + a] += exchange;
            }
        }
    }
    for i in 0..eliminated {
        let exterior = &mut front.exterior;
        (exterior.emissivity[i], exterior.heat[i]) = (numbers.next(), numbers.next::<S>().scale(50.0));
        exterior.laws.air[i] = numbers.next::<S>().scale(20.0);
        exterior.wall_area[i] = numbers.next();
        let response =
            Response { across: [numbers.next(), numbers.next()], stored: [numbers.next(), numbers.next()] };
        exterior.set_response(i, 1, &response, false);
    }
    front
}

/// All unknowns, then the exterior surfaces.
fn solve<S: Real>(
    zone: &mut ZoneFront<S>,
    coupled: &mut CoupledSystem<'_, S>,
    elimination: Elimination,
    constant: bool,
) -> Vec<S> {
    if elimination == Elimination::Full {
        coupled.clear_matrix();
    }
    coupled.clear_right();
    for &row in &zone.layout.retained_rows {
        if elimination == Elimination::Full {
            coupled.add_diagonal(row, S::constant(HELD));
        }
        coupled.right[row] += S::constant(WARMTH);
    }
    let zone_fronts = core::slice::from_mut(zone);
    S::in_chunks(Eliminate { zone_fronts, iterate: None, elimination, constant });
    zone_fronts[0].add_schur_complement(elimination, constant, coupled);
    if elimination == Elimination::Full {
        coupled.keep_matrix();
    }
    coupled.keep_right();
    coupled.begin();
    coupled.solve_rest();
    let mut surfaces = vec![S::zero(); 2 * zone_fronts[0].layout.eliminated];
    let unknowns = &mut coupled.right;
    S::in_chunks(Solve { zone_fronts, constant, unknowns, surfaces: &mut surfaces });
    let exterior = surfaces.chunks_exact(2).map(|pair| pair[0]);
    coupled.right.iter().copied().chain(exterior).collect()
}

/// The heat balances of all surfaces, the air and all exterior surfaces as they are written in a textbook: matrix (unknowns are
/// their temperatures) and right-hand side.
fn balances(front: &ZoneFront<f64>) -> (Vec<f64>, Vec<f64>) {
    let Layout { surfaces, eliminated, stride, .. } = front.layout;
    let (air, n) = (surfaces, surfaces + 1 + eliminated);
    let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
    let mut add = |row: usize, column: usize, value: f64| matrix[row * n + column] += value;
    let (laws, exterior) = (&front.laws, &front.exterior);
    for i in 0..surfaces {
        // Convection to the air.
        let (offset, slope) = (front.area[i] * laws.convection[0][i], front.area[i] * laws.convection[1][i]);
        for (row, sign) in [(i, 1.0), (air, -1.0)] {
            add(row, i, sign * slope);
            add(row, air, -sign * slope);
            right[row] -= sign * offset;
        }
        right[i] += front.heat[i];
        // Long-wave exchange.
        for j in 0..surfaces {
            let area = front.equations.exchange[i * stride + j];
            add(i, j, area * laws.emission[1][j]);
            right[i] -= area * laws.emission[0][j];
        }
        if i >= eliminated {
            add(i, i, HELD);
            right[i] += WARMTH;
            continue;
        }
        // The wall and its exterior surface.
        let other = surfaces + 1 + i;
        let [stays, to_exterior, to_interior, leaves, _] = [0, 1, 2, 3, 4].map(|k| exterior.responses[k][i]);
        add(i, i, stays + exterior.wall_area[i] * to_exterior);
        add(i, other, -to_interior);
        add(other, i, -to_exterior);
        add(other, other, leaves);
        let (convection, emission, emissivity) =
            (&exterior.laws.convection, &exterior.laws.emission, exterior.emissivity[i]);
        add(other, other, convection[1][i] + emissivity * emission[1][i]);
        right[other] += exterior.heat[i] + convection[1][i] * exterior.laws.air[i]
            - convection[0][i]
            - emissivity * emission[0][i];
    }
    add(air, air, HELD);
    right[air] += WARMTH;
    (matrix, right)
}

/// Numbers of surfaces, and of those that are eliminated: all sizes; all of them, all but one, half of them, some or none.
fn sizes() -> Vec<(usize, usize)> {
    let eliminated = |surfaces: usize| [surfaces, surfaces - 1, surfaces / 2][surfaces % 3];
    let all = (1..=40).map(|surfaces| (surfaces, eliminated(surfaces)));
    all.chain([(1, 0), (5, 0), (6, 5), (7, 7), (8, 7), (9, 4), (10, 10), (14, 13), (15, 15)]).collect()
}

/// All retained unknowns meet each other.
fn pattern(retained: usize) -> Pattern {
    Pattern::new(&(0..retained).map(|k| (k + 1..retained).collect()).collect::<Vec<_>>())
}

#[test]
fn fronts_are_solved_as_the_dense_solver_solves_them() {
    for (surfaces, eliminated) in sizes() {
        for nonlinear in [false, true] {
            let context = format!("{surfaces} surfaces, {eliminated} eliminated, nonlinear {nonlinear}");
            let pattern = pattern(surfaces + 1 - eliminated);
            let mut front = front::<f64>(surfaces, eliminated, nonlinear);
            let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
            let found = solve(&mut front, &mut coupled, Elimination::Full, false);
            let (matrix, right) = balances(&front);
            close(&found, &dense_solution(&matrix, &right), 1e-12, &context);
            // Another right-hand side with the same factors: heat at surfaces and air alone.
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

/// Where the matrix is constant the influence coefficients solve for new right-hand sides.
#[test]
fn a_constant_matrix_is_kept() {
    for (surfaces, eliminated) in sizes() {
        let context = format!("{surfaces} surfaces, {eliminated} eliminated");
        let pattern = pattern(surfaces + 1 - eliminated);
        let mut front = front::<f64>(surfaces, eliminated, false);
        let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
        for part in [Elimination::Full, Elimination::RightHandSide, Elimination::RightHandSide] {
            let found = solve(&mut front, &mut coupled, part, true);
            let (matrix, right) = balances(&front);
            close(&found, &dense_solution(&matrix, &right), 1e-12, &context);
            front.heat.iter_mut().take(surfaces).enumerate().for_each(|(i, heat)| *heat += 10.0 * i as f64);
        }
    }
}

/// The factors of a front after it has been assembled.
struct EliminateBoth<'f, S> {
    front: &'f ZoneFront<S>,
}

impl<S: Real> ChunkTask<S> for EliminateBoth<'_, S> {
    type Output = [Factors<S>; 2];
    fn run<V: Chunk<S>>(self) -> [Factors<S>; 2] {
        let ZoneFront { equations, layout, .. } = self.front;
        let [mut fixed, mut any] = [(); 2].map(|()| Factors::new(layout));
        fixed.eliminate::<V>(equations, layout);
        any.eliminate_any(equations, layout);
        [fixed, any]
    }
}

/// All that is read of the factors later on, as bits; both zeros are one.
fn bits<S: Real>(front: &ZoneFront<S>, factors: &Factors<S>) -> Vec<u64> {
    let Layout { surfaces, eliminated, .. } = front.layout;
    let stride = front.layout.stride;
    let upper = (0..=surfaces).flat_map(|i| {
        // Pivots are kept inverted; the row of the air is read from the retained unknowns on.
        let first = if i == surfaces { eliminated } else { i + usize::from(i < eliminated) };
        let end = if i < surfaces && i >= eliminated { surfaces } else { surfaces + 2 };
        factors.rows[i * stride + first..i * stride + end].to_vec()
    });
    let pivots = factors.inverse_pivots[..eliminated].iter().chain(&factors.below[..eliminated]).copied();
    upper.chain(pivots).map(|x| (x.lane(0) + 0.0).to_bits()).collect()
}

/// The elimination in registers has the bits of the one of any size, alone and side by side.
#[test]
fn rows_in_registers_have_the_bits_of_rows_of_any_length() {
    fn check<S: Real>() {
        for (surfaces, eliminated) in sizes() {
            for nonlinear in [false, true] {
                let pattern = pattern(surfaces + 1 - eliminated);
                let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
                let mut front = front::<S>(surfaces, eliminated, nonlinear);
                solve(&mut front, &mut coupled, Elimination::Full, false);
                // Solving leaves temperatures in place of the right-hand side.
                S::in_chunks(Eliminate {
                    zone_fronts: core::slice::from_mut(&mut front),
                    iterate: None,
                    elimination: Elimination::Full,
                    constant: false,
                });
                let [fixed, any] = S::in_chunks(EliminateBoth { front: &front });
                let context = format!("{surfaces} surfaces, {eliminated} eliminated, nonlinear {nonlinear}");
                assert_eq!(bits(&front, &fixed), bits(&front, &any), "{context}");
                assert_eq!(bits(&front, &front.factors), bits(&front, &any), "{context}");
            }
        }
    }
    check::<f64>();
    check::<Dual<1>>();
}

/// Fronts of all sizes, one after the other.
struct AllFronts;

fn all_fronts<S: Real>() -> Vec<S> {
    let mut all = Vec::new();
    for (surfaces, eliminated) in sizes() {
        for (nonlinear, constant) in [(false, false), (true, false), (false, true)] {
            let pattern = pattern(surfaces + 1 - eliminated);
            let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
            let mut front = front::<S>(surfaces, eliminated, nonlinear);
            all.extend(solve(&mut front, &mut coupled, Elimination::Full, constant));
        }
    }
    all
}

impl LaneTask for AllFronts {
    type Output = Vec<u64>;
    fn run<S: Real>(self, _: impl Fn(&[f64]) -> S + Copy) -> Vec<u64> {
        S::vectorised(all_fronts::<S>).iter().map(|value| value.lane(WIDTH - 1).to_bits()).collect()
    }
    fn without_lanes(self) -> Vec<u64> {
        self.run(Lanes::<WIDTH>::of)
    }
}

#[test]
fn lanes_give_the_bits_of_a_plain_number() {
    let plain: Vec<_> = all_fronts::<f64>().iter().map(|value| value.to_bits()).collect();
    for level in Level::available() {
        assert_eq!(run(level, AllFronts), plain, "{level:?}");
    }
}

/// `w . (A^-1 b) = (A^-T w) . b`; derivatives beside a plain matrix are solved like values.
#[test]
fn the_transpose_is_the_transpose() {
    for (surfaces, eliminated) in sizes() {
        let context = format!("{surfaces} surfaces, {eliminated} eliminated");
        let pattern = pattern(surfaces + 1 - eliminated);
        let mut front = front::<f64>(surfaces, eliminated, true);
        let mut coupled = CoupledSystem::new(&pattern, eliminated, 0);
        solve(&mut front, &mut coupled, Elimination::Full, false);
        let (matrix, _) = balances(&front);
        let mut numbers = Numbers::new(surfaces as u64);
        let (right, weights) = (numbers.line(surfaces + 1), numbers.line(surfaces + 1));
        let mut forth: Vec<Dual<1>> =
            right.iter().zip(&weights).map(|(&value, &slope)| Dual { value, slope: [slope] }).collect();
        front.forward_values(&mut forth);
        coupled.solve_values(&mut forth);
        front.back_values(&mut forth);
        let dense = |right: &[f64]| {
            let mut all = dense_solution(&matrix, &[right, &vec![0.0; eliminated]].concat());
            all.truncate(surfaces + 1);
            all
        };
        let (values, slopes): (Vec<f64>, Vec<f64>) =
            forth.iter().map(|dual| (dual.value, dual.slope[0])).unzip();
        close(&values, &dense(&right), 1e-12, &context);
        close(&slopes, &dense(&weights), 1e-12, &context);
        let mut back = weights.clone();
        front.back_transposed(&mut back);
        coupled.solve_transposed(&mut back);
        front.forward_transposed(&mut back);
        adjoint((&weights, &values), (&back, &right), &context);
    }
}
