//! The elimination of a chain against a dense solver, its closed-form answers and its transpose.

use super::{Link, Response, Tridiagonal};
use crate::linear::product::{PlainMatrix, SameKind};
use crate::linear::testing::{Numbers, adjoint, close, dense_solution};
use crate::number::dual::Dual;
use crate::number::real::Real;

/// A chain with random links and storage.
struct Chain {
    links: Vec<Link<f64>>,
    storage: Vec<f64>,
}

fn chain(cells: usize) -> Chain {
    let mut numbers = Numbers::new(cells as u64 + 3);
    let link =
        |_| Link { left: numbers.next::<f64>(), right: numbers.next(), offset: numbers.next::<f64>() - 0.6 };
    let links = (0..=cells).map(link).collect();
    Chain { links, storage: (0..cells).map(|_| numbers.next()).collect() }
}

impl Chain {
    /// The tridiagonal matrix of the cells, row by row.
    fn matrix(&self) -> Vec<f64> {
        let n = self.storage.len();
        let mut matrix = vec![0.0; n * n];
        for i in 0..n {
            matrix[i * n + i] = self.storage[i] + self.links[i].right + self.links[i + 1].left;
            if i > 0 {
                matrix[i * n + i - 1] = -self.links[i].left;
            }
            if i + 1 < n {
                matrix[i * n + i + 1] = -self.links[i + 1].right;
            }
        }
        matrix
    }

    /// Cells between two surfaces, by the dense solver; links with their offsets or without.
    fn dense(&self, heat: &[f64], surfaces: [f64; 2], offset: bool) -> Vec<f64> {
        let n = self.storage.len();
        let mut right = heat.to_vec();
        for (i, right) in right.iter_mut().enumerate() {
            if offset {
                *right += self.links[i].offset - self.links[i + 1].offset;
            }
            if i == 0 {
                *right += self.links[0].left * surfaces[0];
            }
            if i + 1 == n {
                *right += self.links[n].right * surfaces[1];
            }
        }
        dense_solution(&self.matrix(), &right)
    }

    /// Heat into both surfaces along the links.
    fn heat(&self, cells: &[f64], surfaces: [f64; 2]) -> [f64; 2] {
        let n = cells.len();
        let all = [&[surfaces[0]], cells, &[surfaces[1]]].concat();
        [-self.links[0].flux(all[0], all[1]), self.links[n].flux(all[n], all[n + 1])]
    }

    fn factors(&self) -> (Tridiagonal<f64>, Response<f64>) {
        let mut factors = Tridiagonal::new(self.storage.len());
        let response = factors.factor(&self.links, |i| self.storage[i]);
        (factors, response)
    }
}

const SURFACES: [f64; 2] = [3.0, -1.5];

#[test]
fn the_chain_is_solved_as_the_dense_solver_solves_it() {
    for n in 0..=40 {
        let chain = chain(n);
        let heat = Numbers::new(n as u64).line(n);
        let mut factors = Tridiagonal::new(n);
        let condensed = factors.condense(&chain.links, |i| chain.storage[i], |i| heat[i]);
        let mut cells = vec![0.0; n];
        factors.cells(SURFACES, cells.iter_mut(), |cell, temperature| *cell = temperature);
        close(&cells, &chain.dense(&heat, SURFACES, true), 1e-13, &format!("{n} cells"));
        let expected = chain.heat(&cells, SURFACES);
        let affine = [0, 1].map(|e| condensed.source[e] + condensed.response.heat(e, SURFACES));
        close(&affine, &expected, 1e-13, &format!("heat from {n} cells"));
        let (_, response) = chain.factors();
        assert_eq!(
            response.matrix(),
            condensed.response.matrix(),
            "bits of {n} cells without their right-hand side"
        );
    }
}

/// Without storage and heat a chain is a series of resistances: `U = 1/sum(1/k)`, and the temperature falls along them.
#[test]
fn a_chain_at_rest_is_a_series_of_resistances() {
    for n in 0..=40 {
        let mut chain = chain(n);
        for link in &mut chain.links {
            *link = Link { left: link.left, right: link.left, offset: 0.0 };
        }
        chain.storage.fill(0.0);
        let resistances: Vec<f64> = chain.links.iter().map(|link| 1.0 / link.left).collect();
        let total: f64 = resistances.iter().sum();
        let (factors, response) = chain.factors();
        let u = 1.0 / total;
        close(response.matrix().as_flattened(), &[-u, u, u, -u], 1e-12, &format!("{n} cells"));
        let mut cells = vec![0.0; n];
        factors.back::<SameKind, _>(|_, known| known, [20.0, -10.0], &mut cells);
        let mut outside_of = 0.0;
        for (i, cell) in cells.iter().enumerate() {
            outside_of += resistances[i];
            let expected = 20.0 - 30.0 * outside_of / total;
            assert!((cell - expected).abs() < 1e-12, "cell {i} of {n}: {cell} is not {expected}");
        }
    }
}

/// Another right-hand side through the factors; derivatives beside a plain matrix are solved like values.
#[test]
fn other_right_hand_sides_are_solved_with_the_same_factors() {
    for n in 0..=40 {
        let chain = chain(n);
        let (factors, response) = chain.factors();
        let mut numbers = Numbers::new(n as u64 + 100);
        let (heat, slopes) = (numbers.line(n), numbers.line(n));
        let mut known = vec![0.0; n];
        let sources = factors.forward::<SameKind, _>(&chain.links, &mut known, |i, _| heat[i]);
        let mut cells = vec![0.0; n];
        factors.back::<SameKind, _>(|i, _| known[i], SURFACES, &mut cells);
        close(&cells, &chain.dense(&heat, SURFACES, false), 1e-13, &format!("{n} cells"));
        let mut plain = chain;
        plain.links.iter_mut().for_each(|link| link.offset = 0.0);
        let affine = [0, 1].map(|e| sources[e] + response.heat(e, SURFACES));
        close(&affine, &plain.heat(&cells, SURFACES), 1e-13, &format!("heat from {n} cells"));
        let mut duals: Vec<Dual<1>> =
            heat.iter().zip(&slopes).map(|(&value, &slope)| Dual { value, slope: [slope] }).collect();
        let surfaces = [Dual::variable(SURFACES[0], 0), Dual::constant(SURFACES[1])];
        factors.forward::<PlainMatrix, _>(&plain.links, &mut duals, |_, heat| heat);
        factors.back::<PlainMatrix, _>(|_, known| known, surfaces, &mut duals);
        let values: Vec<f64> = duals.iter().map(|dual| dual.value).collect();
        assert_eq!(values, cells, "bits of {n} cells");
        let slopes_found: Vec<f64> = duals.iter().map(|dual| dual.slope[0]).collect();
        close(
            &slopes_found,
            &plain.dense(&slopes, [1.0, 0.0], false),
            1e-13,
            &format!("slopes of {n} cells"),
        );
    }
}

/// `w . (A^-1 b) = (A^-T w) . b`, surfaces and heat into them among the unknowns and equations.
#[test]
fn the_transposed_sweeps_are_the_transpose() {
    for n in 0..=40 {
        let chain = chain(n);
        let (factors, _) = chain.factors();
        let mut numbers = Numbers::new(n as u64 + 200);
        let (heat, weights) = (numbers.line(n), numbers.line(n));
        let outer = [0.7, -0.4];
        let mut cells = heat.clone();
        let sources = factors.forward::<SameKind, _>(&chain.links, &mut cells, |_, heat| heat);
        factors.back::<SameKind, _>(|_, known| known, SURFACES, &mut cells);
        let mut back = weights.clone();
        let by_surfaces = factors.back_transposed(&mut back);
        factors.forward_transposed(&chain.links, outer, &mut back);
        let forth = ([&weights[..], &outer].concat(), [&cells[..], &sources].concat());
        let back = ([&back[..], &by_surfaces].concat(), [&heat[..], &SURFACES].concat());
        adjoint((&forth.0, &forth.1), (&back.0, &back.1), &format!("{n} cells"));
    }
}
