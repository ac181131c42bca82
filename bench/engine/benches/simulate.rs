//! The engine alone, without Python: one run, and one pack of eight members on one thread, of every case.

use std::path::PathBuf;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use mascarin_bench::Case;

fn simulate(criterion: &mut Criterion) {
    let folder =
        std::env::var_os("MASCARIN_BENCH_CASES").expect("MASCARIN_BENCH_CASES: the folder with the cases");
    let cases = Case::read_all(&PathBuf::from(folder));
    let mut group = criterion.benchmark_group("run");
    for case in &cases {
        group.bench_function(&case.name, |bencher| bencher.iter(|| case.run(None).expect("a run")));
    }
    group.finish();
    let mut group = criterion.benchmark_group("pack");
    for case in &cases {
        group.bench_function(&case.name, |bencher| bencher.iter(|| case.pack(None).expect("a pack")));
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3))
        .without_plots();
    targets = simulate
}
criterion_main!(benches);
