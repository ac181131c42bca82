//! Fronts of several sizes: what they find leaves no residual, in all numbers with the same bits.

use core::ops::Range;

use super::{Eliminate, Front, Laws, Resolve, ZoneFront};
use crate::building::ids::SurfaceId;
use crate::linear::coupled::CoupledSystem;
use crate::linear::surface_balance::SurfaceLaws;
use crate::number::line::Line;
use crate::number::real::Real;
use crate::number::simd::{LaneTask, Level, WIDTH, run};

/// What the rest of the building does to each shared unknown: it holds it, and warms it.
const HELD: f64 = 2.0;
const WARMTH: f64 = 30.0;

/// Positive numbers that follow no rule.
struct Numbers(u64);

impl Numbers {
    fn next<S: Real>(&mut self) -> S {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        S::constant(0.1 + (self.0 >> 40) as f64 / (1u64 << 24) as f64)
    }
}

/// A zone of some surfaces, the first of them its own; their emission bends or not.
fn room<S: Real>(surfaces: usize, own: usize, bends: bool) -> ZoneFront<S> {
    let mut numbers = Numbers(7 + 31 * surfaces as u64 + own as u64);
    let ids: Vec<_> = (0..surfaces).map(SurfaceId::from_index).collect();
    let stride = (surfaces + 2).next_multiple_of(S::SIDE);
    let mut line = |offset: f64| Line { offset: numbers.next::<S>().scale(offset), slope: numbers.next() };
    let laws: Vec<_> = (0..2 * surfaces)
        .map(|_| SurfaceLaws { convection: line(3.0), emission: line(if bends { 300.0 } else { 0.0 }) })
        .collect();
    let mut inner = Laws::new(&ids, stride, &laws[..surfaces].to_vec().into());
    inner.emission[1][surfaces..].fill(S::one());
    if bends {
        inner.radiant.push((0, Box::default()));
    }
    let outer = Laws::new(&ids[..own], stride, &laws[surfaces..].to_vec().into());
    let mut room = ZoneFront::blank(inner, outer, stride);
    room.shared = (own..=surfaces).collect();
    for i in 0..surfaces {
        room.area[i] = numbers.next();
        room.base[i] = numbers.next::<S>().scale(100.0);
        for j in 0..i {
            let exchange: S = numbers.next();
            for (a, b) in [(i, j), (j, i)] {
                room.exchange[a * stride + b] = -exchange;
                room.exchange[a * stride + a] += exchange;
            }
        }
    }
    for i in 0..own {
        room.walls.push((i, 1));
        (room.emissivity[i], room.enters[i]) = (numbers.next(), numbers.next::<S>().scale(50.0));
        room.outer.air[i] = numbers.next::<S>().scale(20.0);
        for (response, sign) in room.responses.iter_mut().zip([-2.0, 1.0, 1.0, -2.0]) {
            response[i] = numbers.next::<S>().scale(sign);
        }
    }
    room
}

/// All unknowns, and the other surfaces of the walls.
fn solve<S: Real>(
    room: &mut ZoneFront<S>,
    block: &mut CoupledSystem<'_, S>,
    front: Front,
    stays: bool,
) -> Vec<S> {
    if front == Front::Whole {
        block.clear_matrix();
    }
    block.clear_right();
    for &row in &room.shared {
        if front == Front::Whole {
            block.add(row, row, S::constant(HELD));
        }
        block.right[row] += S::constant(WARMTH);
    }
    let zone_fronts = core::slice::from_mut(room);
    S::abreast(Eliminate { zone_fronts, iterate: None, front, stays });
    zone_fronts[0].leave(front, stays, block);
    if front == Front::Whole {
        block.keep_matrix();
    }
    block.keep_right();
    block.begin();
    block.solve_rest();
    let mut solved = vec![S::zero(); 2 * zone_fronts[0].own];
    S::abreast(Resolve { zone_fronts, stays, block: &mut block.right, solved: &mut solved });
    let others = solved.chunks_exact(2).map(|pair| pair[0]);
    block.right.iter().copied().chain(others).collect()
}

/// Heat that nothing accounts for, by unknown: of a solution, or (`way`) of one that only `right` makes.
fn residuals(room: &ZoneFront<f64>, found: &[f64], way: Option<&[f64]>) -> Vec<f64> {
    let (surfaces, own, stride) = (room.inner.count, room.own, room.stride);
    let constant = if way.is_some() { 0.0 } else { 1.0 };
    let air = found[surfaces];
    let mut left = vec![0.0; surfaces + 1];
    for i in 0..surfaces {
        let convection = room.area[i]
            * (constant * room.inner.convection[0][i] + room.inner.convection[1][i] * (found[i] - air));
        left[surfaces] -= convection;
        left[i] += convection - constant * room.base[i];
        for (j, found) in found[..surfaces].iter().enumerate() {
            let emission = constant * room.inner.emission[0][j] + room.inner.emission[1][j] * found;
            left[i] += room.exchange[i * stride + j] * emission;
        }
        if i < own {
            let [own, to_own, to_other, other] = [0, 1, 2, 3].map(|k: usize| room.responses[k][i]);
            let slope = room.outer.convection[1][i] + room.emissivity[i] * room.outer.emission[1][i];
            let enters = room.enters[i] + room.outer.convection[1][i] * room.outer.air[i]
                - room.outer.convection[0][i]
                - room.emissivity[i] * room.outer.emission[0][i];
            let outside = (constant * enters + to_other * found[i]) / (slope - other);
            if way.is_none() {
                assert!(
                    (outside - found[surfaces + 1 + i]).abs() < 1e-9,
                    "other face {i} of {surfaces}, {own}"
                );
            }
            left[i] -= own * found[i] + to_own * outside;
        }
    }
    for (i, left) in left.iter_mut().enumerate() {
        if i >= own {
            *left += HELD * found[i] - constant * WARMTH;
        }
        *left -= way.map_or(0.0, |right| right[i]);
    }
    left
}

const SIZES: [(usize, usize); 14] = [
    (1, 0),
    (1, 1),
    (2, 1),
    (3, 3),
    (5, 0),
    (6, 5),
    (7, 7),
    (8, 7),
    (9, 4),
    (10, 10),
    (11, 9),
    (14, 13),
    (15, 14),
    (20, 17),
];

fn whole(size: usize) -> Vec<Range<usize>> {
    vec![Range { start: 0, end: size }]
}

fn reach(shared: usize) -> Vec<Vec<Range<usize>>> {
    (0..shared)
        .map(|k| whole(shared).into_iter().map(|run| k + 1..run.end).filter(|run| !run.is_empty()).collect())
        .collect()
}

fn close(left: &[f64], context: &str) {
    assert!(left.iter().all(|left| left.abs() < 1e-9), "{context}: {left:?}");
}

#[test]
fn nothing_is_left() {
    for (surfaces, own) in SIZES {
        for bends in [false, true] {
            let context = format!("{surfaces} faces, {own} own, bent {bends}");
            let reach = reach(surfaces + 1 - own);
            let mut room = room::<f64>(surfaces, own, bends);
            let mut block = CoupledSystem::new(&reach, own, 0);
            let found = solve(&mut room, &mut block, Front::Whole, false);
            close(&residuals(&room, &found, None), &context);
            let right: Vec<f64> = (0..=surfaces).map(|i| 3.0 + i as f64).collect();
            let mut again = right.clone();
            room.forward(&mut again, |i| i);
            block.solve_again(&mut again);
            room.back(&mut again, |i| i);
            close(&residuals(&room, &again, Some(&right)), &context);
        }
    }
}

/// A front whose matrix stays answers to new right-hand sides.
#[test]
fn the_matrix_stays() {
    for (surfaces, own) in SIZES {
        let context = format!("{surfaces} faces, {own} own");
        let reach = reach(surfaces + 1 - own);
        let mut room = room::<f64>(surfaces, own, false);
        let mut block = CoupledSystem::new(&reach, own, 0);
        let found = solve(&mut room, &mut block, Front::Whole, true);
        close(&residuals(&room, &found, None), &context);
        room.base.iter_mut().take(surfaces).enumerate().for_each(|(i, base)| *base += 10.0 * i as f64);
        let found = solve(&mut room, &mut block, Front::Right, true);
        close(&residuals(&room, &found, None), &context);
    }
}

/// All sizes, one after the other.
struct Fronts;

fn fronts<S: Real>() -> Vec<S> {
    let mut all = Vec::new();
    for (surfaces, own) in SIZES {
        for (bends, stays) in [(false, false), (true, false), (false, true)] {
            let reach = reach(surfaces + 1 - own);
            let mut block = CoupledSystem::new(&reach, own, 0);
            all.extend(solve(&mut room::<S>(surfaces, own, bends), &mut block, Front::Whole, stays));
        }
    }
    all
}

impl LaneTask for Fronts {
    type Output = Vec<u64>;
    fn run<S: Real>(self, _: impl Fn([f64; WIDTH]) -> S + Copy) -> Vec<u64> {
        S::vectorised(fronts::<S>).iter().map(|value| value.lane(WIDTH - 1).to_bits()).collect()
    }
}

#[test]
fn lanes_give_the_bits_of_a_plain_number() {
    let plain: Vec<_> = fronts::<f64>().iter().map(|value| value.to_bits()).collect();
    for level in Level::available() {
        assert_eq!(run(level, Fronts), plain, "{level:?}");
    }
}

/// `w . (A^-1 b) = (A^-T w) . b`.
#[test]
fn the_transpose_is_the_transpose() {
    for (surfaces, own) in SIZES {
        let reach = reach(surfaces + 1 - own);
        let mut room = room::<f64>(surfaces, own, true);
        let mut block = CoupledSystem::new(&reach, own, 0);
        solve(&mut room, &mut block, Front::Whole, false);
        let mut numbers = Numbers(surfaces as u64);
        let mut line = || -> Vec<f64> { (0..=surfaces).map(|_| numbers.next()).collect() };
        let (right, weights) = (line(), line());
        let (mut forth, mut back) = (right.clone(), weights.clone());
        room.forward_beside(&mut forth);
        block.solve_beside(&mut forth);
        room.back_beside(&mut forth);
        close(&residuals(&room, &forth, Some(&right)), "beside");
        room.back_transposed(&mut back);
        block.solve_transposed(&mut back);
        room.forward_transposed(&mut back);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (forth, back) = (dot(&weights, &forth), dot(&back, &right));
        assert!(
            (forth - back).abs() < 1e-12 * forth.abs(),
            "{surfaces} faces, {own} own: {forth} is not {back}"
        );
    }
}
