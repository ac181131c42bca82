//! Packs of unlike members: each has the bits of its run alone, whatever its neighbours do.
//!
//! Members differ in every parameter, so that they need other numbers of iterations, sweeps and repetitions of the warm-up: a lane that has
//! ended must not depend on those that go on.

use std::process::Command;

use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather};
use crate::common::difficult::{jumps, sharp};
use crate::common::glazed::{glazed_outputs, glazed_rooms};
use crate::common::random::{Case, Contents, Random, outputs};
use crate::common::{ALL_SCHEMES, forcing, options, try_run, values, warmup, weather};
use crate::rooms_side_by_side::row;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::simd::Level;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::{Ensemble, ensemble, screening};
use mascarin_engine::run::{Options, Warmup};
use mascarin_engine::{RunControl, Scheme};

/// Says in which process a test runs, and with which vector registers.
const CHILD: &str = "MASCARIN_TEST_UNLIKE";

/// A building and how it is run.
struct Building {
    name: String,
    plan: Plan,
    rows: Vec<f64>,
    options: Options,
    /// One after the other.
    members: Vec<f64>,
    count: usize,
}

impl Building {
    /// Members differ from the description by up to `spread` of a third of their parameters.
    fn new(
        name: String,
        plan: Plan,
        (rows, options): (Vec<f64>, Options),
        count: usize,
        spread: f64,
    ) -> Self {
        let mut random = Random::new(0x5eed);
        let nominal = values(&plan);
        let mut vary = |value: f64| {
            if random.chance(0.35) { value * random.between(1.0 - spread, 1.0) } else { value }
        };
        let members = (0..count).flat_map(|_| nominal.iter().map(|&value| vary(value)).collect::<Vec<_>>());
        let members = members.collect();
        Self { name, plan, rows, options, members, count }
    }

    fn member(&self, k: usize) -> &[f64] {
        let width = self.members.len() / self.count;
        &self.members[k * width..(k + 1) * width]
    }

    fn run(&self, single: bool, order: &[usize]) -> Ensemble {
        let numbers: Vec<f64> = order.iter().flat_map(|&k| self.member(k)).copied().collect();
        let drive =
            Forcing::new(&self.rows, self.options.scheme.weights().len(), self.plan.n_channels()).unwrap();
        let run = if single { screening } else { ensemble };
        run(&self.plan, &numbers, &drive, &self.options, &RunControl::default()).unwrap()
    }

    /// Records of each member in a pack of others, in its place of `order`, as bits; none where it failed.
    fn together(&self, single: bool, order: &[usize]) -> Vec<Option<Vec<u64>>> {
        let found = self.run(single, order);
        let length = found.records.len() / order.len();
        let mut by_member = vec![None; self.count];
        for (records, &k) in found.records.chunks(length).zip(order) {
            by_member[k] = Some(bits(records));
        }
        for (place, _) in found.failures {
            by_member[order[place]] = None;
        }
        by_member
    }

    /// The same of runs alone.
    fn alone(&self) -> Vec<Option<Vec<u64>>> {
        let run = |k| try_run(&self.plan, self.member(k), &self.rows, &self.options).ok();
        (0..self.count).map(|k| Some(bits(&run(k)?.records))).collect()
    }
}

fn bits(records: &[f64]) -> Vec<u64> {
    records.iter().map(|record| record.to_bits()).collect()
}

/// Where members differ, and by how much.
fn differences(
    building: &Building,
    found: &[Option<Vec<u64>>],
    expected: &[Option<Vec<u64>>],
) -> Vec<String> {
    let apart = |found: &[u64], expected: &[u64]| {
        let pairs = found.iter().zip(expected);
        pairs.map(|(&a, &b)| (f64::from_bits(a) - f64::from_bits(b)).abs()).fold(0.0, f64::max)
    };
    let members = found.iter().zip(expected).enumerate().filter(|(_, (found, expected))| found != expected);
    members
        .map(|(k, pair)| match pair {
            (Some(found), Some(expected)) => {
                format!("{}, member {k}: {:e} apart", building.name, apart(found, expected))
            }
            (found, expected) => format!(
                "{}, member {k}: found {}, expected {}",
                building.name,
                found.is_some(),
                expected.is_some()
            ),
        })
        .collect()
}

fn short_warmup(dt: f64) -> Warmup {
    Warmup { max_cycles: 40, ..warmup(dt) }
}

/// Random buildings, with and without a warm-up.
fn random_buildings(seeds: core::ops::Range<u64>, count: usize) -> impl Iterator<Item = Building> {
    seeds.map(move |seed| {
        let mut case = Case::new(seed, Contents::All);
        case.scheme = ALL_SCHEMES[usize::try_from(seed % 4).unwrap()];
        case.dt = [900.0, 3600.0, 10_800.0][usize::try_from(seed / 4 % 3).unwrap()];
        case.steps = warmup(case.dt).steps + 4;
        let plan = case.plan();
        let rows = case.rows(&plan);
        let warmup = if seed % 3 == 0 { None } else { Some(short_warmup(case.dt)) };
        let options = Options { warmup, ..case.options() };
        Building::new(format!("seed {seed}, {:?}", case.scheme), plan, (rows, options), count, 0.03)
    })
}

/// Buildings made for one feature each: phase change, loads of many rooms with windows, hysteresis, sharp melting ranges.
fn made_buildings(count: usize) -> Vec<Building> {
    let mut all = Vec::new();
    for scheme in [Scheme::Sdirk2, Scheme::LinearlyImplicit] {
        for dt in [900.0, 10_800.0] {
            let plan = Plan::new(conditioned(0.04)).unwrap();
            let rows = forcing(&plan, scheme, warmup(dt).steps + 16, dt, conditioned_weather);
            let options =
                Options { warmup: Some(short_warmup(dt)), ..options(scheme, dt, conditioned_outputs()) };
            all.push(Building::new(format!("conditioned, {scheme:?}"), plan, (rows, options), count, 0.2));
        }
        for description in glazed_rooms() {
            let plan = Plan::new(description).unwrap();
            let rows = forcing(&plan, scheme, 24, 3600.0, weather);
            let given =
                Options { warmup: Some(short_warmup(3600.0)), ..options(scheme, 3600.0, glazed_outputs()) };
            all.push(Building::new(format!("glazed, {scheme:?}"), plan, (rows, given), count, 0.1));
        }
        let plan = row(true, true);
        let rows = forcing(&plan, scheme, 24, 3600.0, weather);
        let outputs = outputs(&plan.description);
        let given = Options { warmup: Some(short_warmup(3600.0)), ..options(scheme, 3600.0, outputs) };
        all.push(Building::new(format!("row, {scheme:?}"), plan, (rows, given), count, 0.1));
    }
    for (width, nodes, heated) in [(1e-3, 6, true), (0.1, 8, false), (1.0, 4, true)] {
        let plan = Plan::new(sharp(width, 0.006, nodes, heated)).unwrap();
        let dt = 3600.0;
        let rows = forcing(&plan, Scheme::Sdirk2, 24, dt, |time, row| jumps(time, dt, row));
        let outputs = outputs(&plan.description);
        let given = options(Scheme::Sdirk2, dt, outputs);
        all.push(Building::new(format!("sharp {width} K"), plan, (rows, given), count, 0.05));
    }
    all
}

/// In every order and in packs of any length a member has the bits of its run alone.
fn check_double(building: &Building, random: &mut Random) -> Vec<String> {
    let expected = building.alone();
    let order: Vec<usize> = (0..building.count).collect();
    let mut all = differences(building, &building.together(false, &order), &expected);
    let shuffled = random.permutation(building.count);
    all.extend(differences(building, &building.together(false, &shuffled), &expected));
    let mut found = vec![None; building.count];
    let mut rest = &shuffled[..];
    while !rest.is_empty() {
        let (chunk, others) = rest.split_at((1 + random.below(11)).min(rest.len()));
        let of_chunk = building.together(false, chunk);
        for &k in chunk {
            found[k].clone_from(&of_chunk[k]);
        }
        rest = others;
    }
    all.extend(differences(building, &found, &expected));
    all
}

/// In single precision a member has the bits that it has at another place, with other neighbours.
fn check_single(building: &Building, random: &mut Random) -> Vec<String> {
    if building.options.scheme == Scheme::ApparentCapacity {
        return Vec::new();
    }
    let order: Vec<usize> = (0..building.count).collect();
    let expected = building.together(true, &order);
    let shuffled = random.permutation(building.count);
    let mut all = differences(building, &building.together(true, &shuffled), &expected);
    for k in [0, building.count - 1] {
        let mut alone = expected.clone();
        alone[k].clone_from(&building.together(true, &[k])[k]);
        all.extend(differences(building, &alone, &expected));
    }
    all
}

fn check(buildings: impl IntoIterator<Item = Building>) {
    let mut random = Random::new(77);
    let mut wrong = Vec::new();
    for building in buildings {
        wrong.extend(check_double(&building, &mut random));
        wrong.extend(check_single(&building, &mut random).into_iter().map(|text| format!("single: {text}")));
    }
    assert!(wrong.is_empty(), "{} differ: {}", wrong.len(), wrong.join("\n"));
}

#[test]
fn members_of_made_buildings_are_those_alone() {
    check(made_buildings(19));
}

#[test]
fn members_of_random_buildings_are_those_alone() {
    check(random_buildings(0..24, 11));
}

/// In a process of its own, as the variable that chooses the registers is read there.
#[test]
fn child() {
    if std::env::var_os(CHILD).is_some() {
        check(made_buildings(11).into_iter().take(4));
        check(random_buildings(100..106, 9));
        println!("all alike with {:?}", Level::in_use());
    }
}

#[test]
fn members_are_those_alone_with_all_registers() {
    for level in Level::available() {
        let name = match level {
            Level::Array => "array",
            Level::Neon(_) => "neon",
            Level::Avx2(_) => "avx2",
            Level::Avx512(_) => "avx512",
        };
        let done = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "unlike_members::child", "--nocapture"])
            .envs([(CHILD, "yes"), (Level::VARIABLE, name)])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stdout).into_owned();
        assert!(
            done.status.success() && said.contains(&format!("all alike with {level:?}")),
            "{name}: {said}"
        );
    }
}
