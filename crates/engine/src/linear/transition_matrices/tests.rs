//! A step by the maps is the step that a plain elimination gives: random walls of 1 to 40 cells, both schemes.

use serde_json::{Value, json};

use super::TransitionMatrices;
use crate::building::coefficients::Coefficients;
use crate::building::plan::Plan;
use crate::linear::wall::WallSystem;
use crate::weather::heat_sources::SourceConditions;

/// Random numbers from 0 to 1 (multiplicative congruence with the factor of Knuth's MMIX).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn many(&mut self, count: usize, low: f64, high: f64) -> Vec<f64> {
        (0..count).map(|_| self.between(low, high)).collect()
    }
}

/// A wall in numbers of its own, beside those of the engine.
struct Wall {
    area: f64,
    /// Thickness [m], conductivity [W/(m K)], heat capacity [J/(m3 K)] of each cell.
    cells: Vec<[f64; 3]>,
    /// Massless resistance in front of each cell, and behind the last [m2 K/W].
    resistances: Vec<f64>,
    /// Cells of no thickness in which heat is released.
    heated: Vec<usize>,
}

impl Wall {
    fn random(random: &mut Random, cells: usize) -> Self {
        let area = random.between(0.5, 20.0);
        let mut kinds = Vec::new();
        while kinds.len() < cells {
            let kind = [random.between(0.002, 0.03), random.between(0.03, 3.0), random.between(5e4, 3e6)];
            // Some neighbours are of the same layer.
            let same = if random.between(0.0, 1.0) < 0.5 { 3 } else { 1 };
            kinds.extend(vec![kind; same.min(cells - kinds.len())]);
        }
        let mut resistance = || (random.between(0.0, 1.0) - 0.7).max(0.0);
        let resistances = (0..=cells).map(|_| resistance()).collect();
        Self { area, cells: kinds, resistances, heated: Vec::new() }
    }

    /// Heat is released behind some of its cells, and not behind the last.
    fn heated(mut self, behind: &[usize]) -> Self {
        for (already, &cell) in behind.iter().enumerate() {
            let plane = cell + 1 + already;
            self.cells.insert(plane, [0.0, 1.0, 0.0]);
            self.resistances.insert(plane, 0.0);
            self.heated.push(plane);
        }
        self
    }

    /// Conductances in front of each cell, and behind the last [W/(m2 K)].
    fn conductances(&self) -> Vec<f64> {
        let half = |cell: Option<&[f64; 3]>| cell.map_or(0.0, |[d, k, _]| 0.5 * d / k);
        let before = |link: usize| link.checked_sub(1).and_then(|cell| self.cells.get(cell));
        let resistance =
            |link: usize| half(before(link)) + self.resistances[link] + half(self.cells.get(link));
        (0..=self.cells.len()).map(|link| 1.0 / resistance(link)).collect()
    }

    /// Cells at the end of a backward Euler stage of a length [s] from given ones, between two surfaces; `heat` of each source [W/m2].
    fn stage(&self, length: f64, from: &[f64], surfaces: [f64; 2], heat: &[f64]) -> Vec<f64> {
        let (n, links) = (self.cells.len(), self.conductances());
        let rates: Vec<f64> = self.cells.iter().map(|[d, _, capacity]| d * capacity / length).collect();
        let mut right: Vec<f64> = from.iter().zip(&rates).map(|(from, rate)| from * rate).collect();
        right[0] += links[0] * surfaces[0];
        right[n - 1] += links[n] * surfaces[1];
        for (&plane, heat) in self.heated.iter().zip(heat) {
            right[plane] += heat;
        }
        // Thomas' algorithm.
        let mut diagonal: Vec<f64> = (0..n).map(|i| rates[i] + links[i] + links[i + 1]).collect();
        for i in 1..n {
            let factor = links[i] / diagonal[i - 1];
            diagonal[i] -= factor * links[i];
            right[i] += factor * right[i - 1];
        }
        for i in (0..n).rev() {
            let behind = if i + 1 < n { links[i + 1] * right[i + 1] } else { 0.0 };
            right[i] = (right[i] + behind) / diagonal[i];
        }
        right
    }
}

/// The walls between adiabatic sides, as a plan.
fn plan(walls: &[Wall]) -> Plan {
    let mut parameters = Vec::new();
    let mut number = |value: f64| {
        parameters.push(json!({"path": format!("number_{}", parameters.len()), "value": value}));
        parameters.len() - 1
    };
    let one = number(1.0);
    let (mut materials, mut constructions, mut surfaces) = (Vec::new(), Vec::new(), Vec::new());
    let mut heat_sources: Vec<Value> = Vec::new();
    for wall in walls {
        let mut layers: Vec<Value> = Vec::new();
        for (link, &resistance) in wall.resistances.iter().enumerate() {
            if resistance > 0.0 {
                layers.push(json!({"name": "massless", "material": materials.len(), "nodes": 0}));
                materials.push(json!({"kind": "resistance", "resistance": number(resistance)}));
            }
            if wall.heated.contains(&link) {
                heat_sources.push(json!({
                    "name": "mat", "surface": surfaces.len(), "layer": layers.len() - 1,
                    "means": {"kind": "electric", "power": one}
                }));
            } else if let Some(&[thickness, conductivity, capacity]) = wall.cells.get(link) {
                layers.push(json!({
                    "name": "solid", "material": materials.len(), "nodes": 1, "thickness": number(thickness)
                }));
                materials.push(json!({
                    "kind": "solid", "conductivity": number(conductivity), "density": one,
                    "specific_heat": number(capacity)
                }));
            }
        }
        let side = json!({"facing": {"kind": "adiabatic"}});
        surfaces.push(json!({
            "name": "wall", "construction": constructions.len(), "area": number(wall.area), "tilt": one,
            "azimuth": one, "outside": side, "inside": side
        }));
        constructions.push(json!({"name": "wall", "layers": layers}));
    }
    let wind = json!({
        "mast_height": one, "mast_exponent": one, "mast_layer": one, "exponent": one, "layer": one
    });
    let site = json!({
        "altitude": one, "ground_reflectance": one, "wind": wind, "cloud": [one, one, one],
        "sky": {"kind": "offset", "depression": one}, "diffuse": "isotropic"
    });
    let description = json!({
        "parameters": parameters, "site": site, "materials": materials, "constructions": constructions,
        "zones": [], "surfaces": surfaces, "heat_sources": heat_sources
    });
    Plan::new(serde_json::from_value(description).unwrap()).unwrap()
}

/// Largest difference, in units of the largest expected number.
fn apart(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    found.iter().zip(expected).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / largest
}

/// A step of all walls at once, by maps and by eliminations.
fn compare(walls: &[Wall], random: &mut Random, diagonal: f64, dt: f64) {
    let plan = plan(walls);
    let numbers: Vec<f64> = plan.description.parameters.iter().map(|parameter| parameter.value).collect();
    let coefficients = Coefficients::new(&plan, &numbers);
    let mut chains: Vec<_> = coefficients.walls.iter().map(WallSystem::new).collect();
    for (chain, wall) in chains.iter_mut().zip(&coefficients.walls) {
        chain.factor(wall, diagonal * dt);
    }
    let mut maps = TransitionMatrices::new(&plan, &coefficients, &chains, diagonal);
    maps.factor(&chains);
    let mut cells = random.many(plan.n_cells, -10.0, 40.0);
    let mut sources = vec![[0.0; 2]; walls.len()];
    // Two steps: the second one must not know of the first.
    for _ in 0..2 {
        let start = cells.clone();
        let (first, last) =
            (random.many(2 * walls.len(), -10.0, 40.0), random.many(2 * walls.len(), -10.0, 40.0));
        let ratio = (1.0 - diagonal) / diagonal;
        let (mut stored, mut expected_stored) = (0.0, 0.0);
        let count = plan.description.heat_sources.len();
        let heat = [random.many(count, -50.0, 100.0), random.many(count, -50.0, 100.0)];
        maps.begin();
        let mut expected = Vec::new();
        maps.first_sources(&chains, &cells, &mut sources);
        for stage in 0..if diagonal < 1.0 { 2 } else { 1 } {
            if stage == 1 {
                maps.set_first_surfaces(&first);
                maps.second_sources(&mut sources);
            }
            let released: Vec<_> = heat[stage].iter().map(|&heat| SourceConditions::of_heat(heat)).collect();
            maps.release(stage, &released, &mut sources);
            expected.clear();
            let mut before = 0;
            for (w, wall) in walls.iter().enumerate() {
                let (begin, links) = (plan.walls[w].first_cell, wall.conductances());
                let own = &start[begin..begin + wall.cells.len()];
                let [first_heat, own_heat] =
                    [&heat[0], &heat[stage]].map(|heat| &heat[before..before + wall.heated.len()]);
                before += wall.heated.len();
                let mut from = own.to_vec();
                if stage == 1 {
                    let surfaces = [first[2 * w], first[2 * w + 1]];
                    let reached = wall.stage(diagonal * dt, own, surfaces, first_heat);
                    for (from, reached) in from.iter_mut().zip(reached) {
                        *from += ratio * (reached - *from);
                    }
                }
                let free = wall.stage(diagonal * dt, &from, [0.0; 2], own_heat);
                let into = [links[0] * free[0], links[free.len()] * free[free.len() - 1]];
                let error = apart(&sources[w], &into);
                assert!(error < 1e-12, "{} cells, stage {stage}: heat is {error:e} apart", own.len());
                let surfaces = [last[2 * w], last[2 * w + 1]];
                let reached = wall.stage(diagonal * dt, &from, surfaces, own_heat);
                if stage == 1 || diagonal == 1.0 {
                    for ((reached, own), [thickness, _, capacity]) in reached.iter().zip(own).zip(&wall.cells)
                    {
                        expected_stored += wall.area * thickness * capacity * (reached - own);
                        stored += wall.area * thickness * capacity * (reached - own).abs();
                    }
                }
                expected.extend(reached);
            }
        }
        let heat = maps.finish(&last, &mut cells);
        let error = apart(&cells, &expected);
        assert!(error < 1e-12, "{} walls, dt {dt} s: cells are {error:e} apart", walls.len());
        let error = (heat - expected_stored).abs() / stored;
        assert!(error < 1e-12, "{} walls, dt {dt} s: stored heat is {error:e} apart", walls.len());
    }
}

const SDIRK2: f64 = 1.0 - core::f64::consts::FRAC_1_SQRT_2;
const BACKWARD_EULER: f64 = 1.0;

#[test]
fn a_map_is_the_step_of_the_elimination() {
    let mut random = Random(14);
    // Up to the longest wall with a map, and beyond.
    for cells in (1..=40).chain([48, 49, 50, 97, 300]) {
        let wall = [Wall::random(&mut random, cells)];
        for diagonal in [SDIRK2, BACKWARD_EULER] {
            let dt = random.between(30.0, 7200.0);
            compare(&wall, &mut random, diagonal, dt);
        }
    }
}

#[test]
fn maps_of_many_walls_do_not_mix() {
    let mut random = Random(41);
    for count in [2, 5, 17] {
        let walls: Vec<_> = (0..count).map(|w| Wall::random(&mut random, 1 + (7 * w) % 13)).collect();
        for diagonal in [SDIRK2, BACKWARD_EULER] {
            compare(&walls, &mut random, diagonal, 900.0);
        }
    }
}

/// Heat is released between layers, at one place or two; another wall has none.
#[test]
fn heat_is_released_in_walls() {
    let mut random = Random(8);
    for cells in [2, 5, 11, 60] {
        for diagonal in [SDIRK2, BACKWARD_EULER] {
            let walls = [
                Wall::random(&mut random, cells).heated(&[0]),
                Wall::random(&mut random, 3),
                Wall::random(&mut random, cells + 1).heated(&[0, cells - 1]),
            ];
            compare(&walls, &mut random, diagonal, 900.0);
        }
    }
}

/// Two layers of one cell each, at rest between two surfaces: nothing changes and the heat is that of the resistances.
#[test]
fn a_steady_state_stays() {
    let wall = Wall {
        area: 3.0,
        cells: vec![[0.1, 0.5, 2e6], [0.2, 2.0, 1e6]],
        resistances: vec![0.0, 0.3, 0.0],
        heated: Vec::new(),
    };
    // 0.2 + 0.3 + 0.1 m2 K/W, 30 K apart: 50 W/m2.
    let (surfaces, flux) = ([30.0, 0.0], 50.0);
    let mut cells = vec![30.0 - flux * 0.1, flux * 0.05];
    for diagonal in [SDIRK2, BACKWARD_EULER] {
        let plan = plan(core::slice::from_ref(&wall));
        let numbers: Vec<f64> = plan.description.parameters.iter().map(|parameter| parameter.value).collect();
        let coefficients = Coefficients::new(&plan, &numbers);
        let mut chain = WallSystem::new(&coefficients.walls[0]);
        chain.factor(&coefficients.walls[0], diagonal * 600.0);
        let chains = [chain];
        let mut maps = TransitionMatrices::new(&plan, &coefficients, &chains, diagonal);
        maps.factor(&chains);
        maps.begin();
        maps.first_sources(&chains, &cells, &mut [[0.0; 2]]);
        maps.set_first_surfaces(&surfaces);
        let heat = maps.finish(&surfaces, &mut cells);
        assert!((cells[0] - 25.0).abs() < 1e-13 && (cells[1] - 2.5).abs() < 1e-13, "{cells:?}");
        assert!(heat.abs() < 1e-13 * 3.0 * 0.1 * 2e6 * 30.0, "{heat}");
    }
}
