//! Tangents at an iterate: value and slope of enthalpy and flux against the laws themselves.

use super::{Iterate, PhaseChange, Start, Storage, StorageRule};
use crate::building::coefficients::{Cell, Matter, WallCoefficients};
use crate::input::description::{MeltingCurve, ParamId, PcmLaw};
use crate::input::values::Values;
use crate::linear::tridiagonal::Link;
use crate::physics::pcm::{PcmCoefficients, PcmHistory};

const ID: fn(u32) -> ParamId = ParamId;

/// Melting between about 21 and 25 degC; a solid conducts `solid` W/(m K), the liquid 0.18.
fn pcm(solid: f64) -> PcmCoefficients<f64> {
    let numbers = [solid, 0.18, 855.0, 855.0, 3134.0, 2833.0, 71e3, 23.4, 2.0];
    let curve = MeltingCurve::TanhWidth { melting_temperature: ID(7), width: ID(8) };
    let law = PcmLaw::Melting { latent_heat: ID(6), curve };
    PcmCoefficients::new(&Values::new(&numbers), [ID(0), ID(1)], [ID(2), ID(3)], [ID(4), ID(5)], &law)
}

/// Two cells of phase change, then a solid one: links of all kinds.
fn wall(solid: f64) -> WallCoefficients<f64> {
    let changing = Cell { thickness: 0.005, matter: Matter::Pcm(0) };
    let board = Cell { thickness: 0.0125, matter: Matter::Solid { conductivity: 0.16, capacity: 8e5 } };
    WallCoefficients {
        area: 1.0,
        cells: vec![changing.clone(), changing, board],
        extra: vec![0.0; 4],
        massless: vec![false; 4],
        pcm: vec![pcm(solid)],
        layer_resistance: Vec::new(),
        planes: false,
        glass: None,
    }
}

const CELLS: [f64; 3] = [22.5, 24.0, 21.0];
const SURFACES: [f64; 2] = [23.0, 20.0];

/// The linearisation of a wall at an iterate.
fn linearised(
    wall: &WallCoefficients<f64>,
    (cells, surfaces): ([f64; 3], [f64; 2]),
    outer: Option<&[f64]>,
    rule: StorageRule,
) -> (Vec<Link<f64>>, Vec<Storage<f64>>) {
    let none = Link { left: 0.0, right: 0.0, offset: 0.0 };
    let (mut links, mut storage) = (vec![none; 4], vec![Storage::constant(8e5); 3]);
    let memory = CELLS.map(|temperature| PcmHistory::new(0.0, temperature));
    let enthalpy = CELLS.map(|cell| wall.pcm[0].at(cell - 1.0, &memory[0]).enthalpy);
    let start = CELLS.map(|cell| cell - 1.0);
    let start = Start { cells: &start, enthalpy: &enthalpy, memory: &memory };
    let at = Iterate { cells: &cells, surfaces, outer };
    PhaseChange::new(wall).linearise(wall, &at, &start, rule, (&mut links, &mut storage));
    (links, storage)
}

/// Flux along a link at the iterate itself: the change of cells is zero, surfaces and solid cells count from zero.
fn flux_at_iterate(links: &[Link<f64>], cells: [f64; 3], surfaces: [f64; 2], link: usize) -> f64 {
    let at = [surfaces[0], 0.0, 0.0, cells[2], surfaces[1]];
    links[link].flux(at[link], at[link + 1])
}

/// The law's own flux: by the integrals of the conductivity, and by resistances in series to the board.
fn exact_flux(wall: &WallCoefficients<f64>, cells: [f64; 3], surfaces: [f64; 2], link: usize) -> f64 {
    let memory = PcmHistory::new(0.0, 0.0);
    let at = |temperature: f64| wall.pcm[0].at(temperature, &memory);
    let potential = |temperature: f64| at(temperature).potential;
    match link {
        0 => (potential(surfaces[0]) - potential(cells[0])) / 0.0025,
        1 => (potential(cells[0]) - potential(cells[1])) / 0.005,
        _ => (cells[1] - cells[2]) / (0.0025 / at(cells[1]).conductivity + 0.00625 / 0.16),
    }
}

#[test]
fn fluxes_have_the_value_and_the_slopes_of_their_laws() {
    const STEP: f64 = 1e-5;
    let wall = wall(0.22);
    let (links, _) = linearised(&wall, (CELLS, SURFACES), None, StorageRule::Enthalpy);
    for link in 0..3 {
        let flux = flux_at_iterate(&links, CELLS, SURFACES, link);
        let exact = exact_flux(&wall, CELLS, SURFACES, link);
        assert!((flux - exact).abs() < 1e-9, "link {link}: {flux} is not {exact}");
        // Unknowns in their order: outside surface, cells.
        let slope = |node: usize| {
            let shifted = |by: f64| {
                let (mut cells, mut surfaces) = (CELLS, SURFACES);
                let shifted = if node == 0 { &mut surfaces[0] } else { &mut cells[node - 1] };
                *shifted += by;
                exact_flux(&wall, cells, surfaces, link)
            };
            (shifted(STEP) - shifted(-STEP)) / (2.0 * STEP)
        };
        let (left, right) = (slope(link), -slope(link + 1));
        assert!((links[link].left / left - 1.0).abs() < 1e-7, "link {link}: {} {left}", links[link].left);
        assert!((links[link].right / right - 1.0).abs() < 1e-7, "link {link}: {} {right}", links[link].right);
    }
}

/// However steeply the conductivity rises, a warmer left end sends more heat and a warmer right end less.
#[test]
fn slopes_keep_their_sign() {
    for solid in [0.02, 2.0] {
        let wall = wall(solid);
        for step in 0..80 {
            let cells = [22.0, 18.0 + 0.1 * f64::from(step), 60.0 - 1.2 * f64::from(step)];
            let (links, _) = linearised(&wall, (cells, SURFACES), None, StorageRule::Enthalpy);
            for (i, link) in links[..3].iter().enumerate() {
                assert!(link.left > 0.0 && link.right > 0.0, "link {i} at {cells:?}: {link:?}");
            }
            let flux = flux_at_iterate(&links, cells, SURFACES, 2);
            let exact = exact_flux(&wall, cells, SURFACES, 2);
            assert!((flux - exact).abs() < 1e-9 * (1.0 + exact.abs()), "{flux} is not {exact}");
        }
    }
}

#[test]
fn storage_is_the_tangent_of_the_enthalpy() {
    const STEP: f64 = 1e-5;
    let wall = wall(0.22);
    let law = |temperature: f64| wall.pcm[0].at(temperature, &PcmHistory::new(0.0, 0.0)).enthalpy;
    let (_, storage) = linearised(&wall, (CELLS, SURFACES), None, StorageRule::Enthalpy);
    // Both parts about the iterate itself sum up to the same tangent.
    let (_, split) = linearised(&wall, (CELLS, SURFACES), Some(&CELLS), StorageRule::Enthalpy);
    for i in 0..2 {
        let mut tangent = storage[i];
        let slope = (law(CELLS[i] + STEP) - law(CELLS[i] - STEP)) / (2.0 * STEP);
        assert_eq!((tangent.reference, tangent.at_solution()), (CELLS[i], law(CELLS[i])));
        assert!((tangent.capacity / slope - 1.0).abs() < 1e-7, "cell {i}: {} {slope}", tangent.capacity);
        assert!((split[i].offset / tangent.offset - 1.0).abs() < 1e-12, "{split:?}");
        assert!((split[i].capacity / tangent.capacity - 1.0).abs() < 1e-12, "{split:?}");
        tangent.change = 0.5;
        assert_eq!(tangent.at_solution(), tangent.offset + 0.5 * tangent.capacity);
    }
    assert_eq!((storage[2].reference, storage[2].capacity), (0.0, 8e5));
}

/// `H_old + c(T_old) (T - T_old)`: the capacity stays that of the start.
#[test]
fn the_apparent_capacity_is_that_of_the_start() {
    let wall = wall(0.22);
    let memory = PcmHistory::new(0.0, 0.0);
    let (_, storage) = linearised(&wall, (CELLS, SURFACES), None, StorageRule::ApparentCapacity);
    for i in 0..2 {
        let old = wall.pcm[0].at(CELLS[i] - 1.0, &memory);
        assert_eq!(storage[i].capacity, old.capacity);
        assert!((storage[i].offset - (old.enthalpy + old.capacity)).abs() < 1e-6, "{storage:?}");
    }
}
