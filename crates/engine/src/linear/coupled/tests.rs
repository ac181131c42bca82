//! The coupled system against a dense solver: in parts, with other right-hand sides, transposed.

use super::CoupledSystem;
use crate::building::pattern::{DENSE, Pattern};
use crate::linear::testing::{Numbers, adjoint, close, dense_solution};
use crate::number::dual::Dual;

/// All rows meet each other.
fn full(size: usize) -> Pattern {
    Pattern::new(&(0..size).map(|k| (k + 1..size).collect()).collect::<Vec<_>>())
}

/// The matrix of a system that has not been factored, with all its zeros.
fn dense(system: &CoupledSystem<'_, f64>) -> Vec<f64> {
    let size = system.pattern.size();
    let entry = |k: usize| system.pattern.place(k / size, k % size).map_or(0.0, |place| system.matrix[place]);
    (0..size * size).map(entry).collect()
}

/// Five unknowns, three of them first; the last conductance between the others changes and the rest is solved again.
#[test]
fn the_rest_is_solved_again() {
    let pattern = Pattern::new(&[vec![1, 3], vec![2, 3, 4], vec![3, 4], vec![4], vec![]]);
    let conductances = [(0, 1, 2.0), (0, 3, 1.0), (1, 2, 0.5), (1, 4, 3.0), (2, 4, 1.5)];
    let held = [1.0, 0.5, 2.0, 0.0, 0.1];
    let assemble = |system: &mut CoupledSystem<'_, f64>| {
        for (a, b, conductance) in conductances {
            system.couple(a, b, conductance);
        }
        for (row, held) in held.into_iter().enumerate() {
            system.add(row, row, held);
            system.right[row] = held * 20.0 + 5.0;
        }
    };
    let mut system = CoupledSystem::new(&pattern, 0, 3);
    assemble(&mut system);
    system.keep_matrix();
    system.keep_right();
    for last in [0.2, 4.0, 1.0] {
        system.begin();
        system.couple(3, 4, last);
        system.right[4] += 7.0;
        system.solve_rest();
        system.solve_first();
        // The whole system, assembled anew.
        let mut whole = CoupledSystem::new(&pattern, 0, 3);
        assemble(&mut whole);
        whole.couple(3, 4, last);
        whole.right[4] += 7.0;
        let expected = dense_solution(&dense(&whole), &whole.right);
        close(&system.right, &expected, 1e-14, &format!("last conductance {last}"));
        let mut again = whole.right.clone();
        system.solve_again(&mut again);
        close(&again, &expected, 1e-14, &format!("solved again at {last}"));
    }
}

/// A random M-matrix that is not symmetric: columns sum up to more than nothing.
fn m_matrix(size: usize) -> Vec<f64> {
    let mut numbers = Numbers::new(size as u64);
    let mut matrix = vec![0.0; size * size];
    for row in 0..size {
        for column in (0..size).filter(|&column| column != row) {
            let (gain, held): (f64, f64) = (numbers.next(), numbers.next());
            matrix[row * size + column] = -gain;
            matrix[column * size + column] += gain + 0.1 * held;
        }
        matrix[row * size + row] += 0.1;
    }
    matrix
}

/// A system with such a matrix, factored, behind some rows that zones eliminate.
fn factored<'a>(matrix: &[f64], pattern: &'a Pattern, before: usize, first: usize) -> CoupledSystem<'a, f64> {
    let size = pattern.size();
    let mut system = CoupledSystem::new(pattern, before, first);
    for (k, &value) in matrix.iter().enumerate() {
        system.add(before + k / size, before + k % size, value);
    }
    system.keep_matrix();
    system.keep_right();
    system.begin();
    system.solve_rest();
    system
}

#[test]
fn random_m_matrices_are_solved_as_the_dense_solver_solves_them() {
    for size in 1..=40 {
        let (matrix, pattern) = (m_matrix(size), full(size));
        let (right, slopes) = (Numbers::new(7).line(size), Numbers::new(8).line(size));
        let expected = dense_solution(&matrix, &right);
        let mut bits = None;
        for (before, first) in [(0, 0), (3, size / 2), (1, size)] {
            let system = factored(&matrix, &pattern, before, first);
            let mut solution = [&vec![f64::NAN; before][..], &right].concat();
            system.solve_again(&mut solution);
            close(&solution[before..], &expected, 1e-12, &format!("{size} unknowns, {first} first"));
            let solved: Vec<u64> = solution[before..].iter().map(|x| x.to_bits()).collect();
            assert_eq!(*bits.get_or_insert_with(|| solved.clone()), solved, "{size} unknowns, {first} first");
            // Derivatives are solved like values.
            let mut duals = vec![Dual { value: f64::NAN, slope: [f64::NAN] }; before];
            duals.extend(right.iter().zip(&slopes).map(|(&value, &slope)| Dual { value, slope: [slope] }));
            system.solve_values(&mut duals);
            let found: Vec<f64> = duals[before..].iter().map(|dual| dual.slope[0]).collect();
            close(&found, &dense_solution(&matrix, &slopes), 1e-12, &format!("slopes of {size} unknowns"));
            assert!(duals[before..].iter().zip(&solved).all(|(dual, &bits)| dual.value.to_bits() == bits));
        }
    }
}

/// The last rows, of which all meet, eliminated by themselves: the factors and the solution have the bits of the sparse elimination.
#[test]
fn dense_rows_have_the_bits_of_sparse_ones() {
    let bits = |numbers: &[f64]| -> Vec<u64> { numbers.iter().map(|number| number.to_bits()).collect() };
    for size in 1..=9 {
        let (matrix, pattern) = (m_matrix(size), full(size));
        for first in 0..size {
            let mut system = CoupledSystem::new(&pattern, 0, first);
            assert_eq!(system.dense.is_some(), size - first <= DENSE, "{size} unknowns, {first} first");
            for (k, &value) in matrix.iter().enumerate() {
                system.add(k / size, k % size, value);
            }
            system.right = Numbers::new(5).line(size);
            system.keep_matrix();
            system.keep_right();
            let mut sparse = CoupledSystem { dense: None, ..system.clone() };
            for system in [&mut system, &mut sparse] {
                system.begin();
                system.solve_rest();
            }
            assert_eq!(bits(&system.matrix), bits(&sparse.matrix), "{size} unknowns, {first} first");
            assert_eq!(bits(&system.right), bits(&sparse.right), "{size} unknowns, {first} first");
        }
    }
    // Rows 0 and 2 do not meet.
    let pattern = Pattern::new(&[vec![1], vec![2], vec![]]);
    assert!(CoupledSystem::<f64>::new(&pattern, 0, 0).dense.is_none());
}

/// `w . (A^-1 b) = (A^-T w) . b`.
#[test]
fn the_transpose_is_the_transpose() {
    for size in 1..=40 {
        let (matrix, pattern) = (m_matrix(size), full(size));
        for first in [0, size / 2, size] {
            let system = factored(&matrix, &pattern, 0, first);
            let mut numbers = Numbers::new(size as u64 + 1);
            let (right, weights) = (numbers.line(size), numbers.line(size));
            let (mut solution, mut back) = (right.clone(), weights.clone());
            system.solve_values(&mut solution);
            system.solve_transposed(&mut back);
            adjoint((&weights, &solution), (&back, &right), &format!("{size} unknowns"));
        }
    }
}
