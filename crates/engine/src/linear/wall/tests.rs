//! A wall of solid layers: its steady state and its balances.

use super::WallSystem;
use crate::building::coefficients::{Cell, Matter, WallCoefficients};
use crate::linear::testing::{Numbers, close};

const STAGE: f64 = 300.0;

/// A wall of random solid cells with a massless layer in each link.
fn wall(cells: usize) -> WallCoefficients<f64> {
    let mut numbers = Numbers::new(cells as u64 + 1);
    let mut next = |size: f64| size * numbers.next::<f64>();
    let cell = |_| Cell {
        thickness: next(0.04),
        matter: Matter::Solid { conductivity: next(0.6), capacity: next(2.4e6) },
    };
    WallCoefficients {
        area: 1.0,
        cells: (0..cells).map(cell).collect(),
        extra: vec![0.05; cells + 1],
        massless: vec![true; cells + 1],
        pcm: Vec::new(),
        layer_resistance: Vec::new(),
        planes: false,
        glass: None,
    }
}

/// U = 1/sum(d/k): in a stage so long that storage does nothing.
#[test]
fn a_long_stage_gives_the_u_value() {
    for cells in [0, 1, 2, 6, 20] {
        let wall = wall(cells);
        let resistance = wall.cells.iter().fold(0.05 * (cells + 1) as f64, |sum, cell| match cell.matter {
            Matter::Solid { conductivity, .. } => sum + cell.thickness / conductivity,
            Matter::Pcm(_) => f64::NAN,
        });
        let response = WallSystem::new(&wall).factor(&wall, 1e18);
        let u = 1.0 / resistance;
        close(response.matrix().as_flattened(), &[-u, u, u, -u], 1e-9, &format!("{cells} cells"));
    }
}

/// Each cell stores what flows in and is released in it; what flows out of the ends is what the elimination gives.
#[test]
fn cells_and_surfaces_are_in_balance() {
    for cells in [0, 1, 2, 6, 20] {
        let wall = wall(cells);
        let mut chain = WallSystem::<f64>::new(&wall);
        chain.set_stage_length(&wall, STAGE);
        let mut numbers = Numbers::new(cells as u64);
        let (start, gains) = (numbers.line(cells), numbers.line(cells));
        let start: Vec<f64> = start.iter().map(|t| 20.0 + 5.0 * t).collect();
        let held: Vec<f64> =
            start.iter().zip(&chain.storage).map(|(t, storage)| storage.capacity * t).collect();
        let condensed = chain.condense_heated(&held, &gains);
        let surfaces = [23.0, 18.5];
        let mut found = vec![0.0; cells];
        chain.temperatures(surfaces, &mut found);
        for i in 0..cells {
            let stored = (chain.storage[i].at_solution() - held[i]) * chain.rate[i];
            let inflow = chain.link_flux(i, surfaces) - chain.link_flux(i + 1, surfaces) + gains[i];
            assert!((stored - inflow).abs() < 1e-9, "cell {i} of {cells}: {stored} is not {inflow}");
        }
        let heat = [-chain.link_flux(0, surfaces), chain.link_flux(cells, surfaces)];
        for (e, heat) in heat.into_iter().enumerate() {
            let expected = condensed.source[e] + condensed.response.heat(e, surfaces);
            assert!((heat - expected).abs() < 1e-9, "surface {e} of {cells}: {heat} is not {expected}");
        }
    }
}

/// A change of the enthalpies held and of the surfaces changes sources and cells by what the sweeps for changes give.
#[test]
fn changes_are_differences_of_solutions() {
    let wall = wall(6);
    let mut chain = WallSystem::<f64>::new(&wall);
    chain.set_stage_length(&wall, STAGE);
    let mut numbers = Numbers::new(5);
    let (held, change): (Vec<f64>, Vec<f64>) =
        (0..6).map(|_| (2e7 * numbers.next::<f64>(), 1e6 * numbers.next::<f64>())).unzip();
    let mut solve = |held: &[f64], surfaces: [f64; 2]| {
        let source = chain.condense(held).source;
        let mut cells = vec![0.0; 6];
        chain.temperatures(surfaces, &mut cells);
        (source, cells)
    };
    let more: Vec<f64> = held.iter().zip(&change).map(|(a, b)| a + b).collect();
    let (before, after) = (solve(&held, [10.0, 20.0]), solve(&more, [11.0, 18.0]));
    let (mut known, mut cells) = (vec![0.0; 6], vec![0.0; 6]);
    let sources = chain.source_changes(&change, &mut known);
    chain.temperature_changes(&known, [1.0, -2.0], &mut cells);
    let difference = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
    close(&sources, &difference(&after.0, &before.0), 1e-10, "sources");
    close(&cells, &difference(&after.1, &before.1), 1e-10, "cells");
}
