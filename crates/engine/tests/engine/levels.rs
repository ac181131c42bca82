//! Runs with the vector registers that the environment asks for: the same bits with all of them.

use std::process::Command;

use crate::common::{cell, cell_members, cell_outputs, cell_weather, forcing, options, values};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::error::EngineError;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::number::simd::Level;
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::screening;
use mascarin_engine::run::simulate;

/// Says in which process the test below runs.
const CHILD: &str = "MASCARIN_TEST_CHILD";

/// Records of a short run, as bits.
fn records() -> Result<Vec<u64>, EngineError> {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 24, 900.0, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let options = options(Scheme::Sdirk2, 900.0, cell_outputs());
    let run = simulate(&plan, &values(&plan), &drive, &options, &RunControl::default())?;
    Ok(run.records.iter().map(|record| record.to_bits()).collect())
}

/// Records of some members in single precision, as bits.
fn screened() -> Result<Vec<u64>, EngineError> {
    let plan = Plan::new(cell(0.04)).unwrap();
    let rows = forcing(&plan, Scheme::Sdirk2, 24, 900.0, cell_weather);
    let drive = Forcing::new(&rows, 2, plan.n_channels()).unwrap();
    let options = options(Scheme::Sdirk2, 900.0, cell_outputs());
    let found = screening(&plan, &cell_members(&plan, 5), &drive, &options, &RunControl::default())?;
    Ok(found.records.iter().map(|record| record.to_bits()).collect())
}

/// In a process of its own, as the variable is read there: prints the level in use and the records.
#[test]
fn child() {
    if std::env::var_os(CHILD).is_some() {
        match records() {
            Ok(records) => {
                println!("level {:?} records {records:x?}", Level::in_use());
                println!("screened {:x?}", screened().unwrap());
            }
            Err(error) => println!("error {error}"),
        }
    }
}

fn run_with(lanes: &str) -> String {
    let done = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "levels::child", "--nocapture"])
        .envs([(CHILD, "yes"), (Level::VARIABLE, lanes)])
        .output()
        .unwrap();
    assert!(done.status.success(), "{done:?}");
    String::from_utf8(done.stdout).unwrap()
}

fn name(level: Level) -> &'static str {
    match level {
        Level::Array => "array",
        Level::Neon(_) => "neon",
        Level::Avx2(_) => "avx2",
        Level::Avx512(_) => "avx512",
    }
}

#[test]
fn single_runs_use_the_registers_asked_for_and_keep_their_bits() {
    let expected = format!("records {:x?}", records().unwrap());
    for level in Level::available() {
        let said = run_with(name(level));
        assert!(said.contains(&format!("level {level:?} {expected}")), "{level:?}: {said}");
    }
}

/// All registers give the same bits in single precision; without any, members are run in double precision.
#[test]
fn members_in_single_precision_keep_their_bits() {
    let expected = format!("screened {:x?}", screened().unwrap());
    for level in Level::available() {
        let same = run_with(name(level)).contains(&expected);
        let widest = Level::available().last() == Some(Level::Array);
        assert_eq!(same, level != Level::Array || widest, "{level:?}");
    }
}

#[test]
fn a_name_that_is_not_known_is_an_error_of_single_runs_too() {
    let said = run_with("wide");
    assert!(said.contains("found 'wide', expected avx512, avx2, neon or array"), "{said}");
}
