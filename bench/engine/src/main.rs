//! A case once, for counting instructions: `mascarin-bench CASE.json run|pack|jacobian|gradient|nothing [STEPS]`.
//!
//! `nothing` reads the case and stops: what it takes is taken from the others.

use std::path::Path;
use std::process::exit;

use mascarin_bench::Case;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (Some(file), Some(what)) = (words.first(), words.get(1)) else {
        eprintln!("usage: mascarin-bench CASE.json run|pack|jacobian|gradient|nothing [STEPS]");
        exit(2);
    };
    let case = Case::read(Path::new(file));
    let steps = words.get(2).map(|text| text.parse().expect("a number of steps"));
    match what.as_str() {
        "run" => case.run(steps).expect("a run"),
        "pack" => case.pack(steps).expect("a pack"),
        "jacobian" => case.jacobian(steps).expect("a run with slopes"),
        "gradient" => case.gradient(steps).expect("a run and its gradient"),
        "nothing" => (),
        other => {
            eprintln!("found '{other}', expected run, pack, jacobian, gradient or nothing");
            exit(2);
        }
    }
}
