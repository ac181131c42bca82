//! Solutions of the stages of a plain run: numbers with derivatives are computed along them.
//!
//! A step is made in parts, mostly in one. Of each part its stages, its loads and the state at its end are kept, the last one excepted:
//! that is the state which the run has reached.

use core::ops::Range;

use crate::linear::unknowns::Unknowns;
use crate::number::real::Real;
use crate::step::halving::Part;
use crate::step::state::State;

/// The solution of a part of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KnownPart<'a> {
    pub(crate) part: Part,
    pub(crate) stages: &'a [Unknowns<f64>],
    /// Ideal loads, means over the part [W].
    pub(crate) load: &'a [f64],
    /// The state at its end, where another part follows.
    pub(crate) reached: Option<&'a State<f64>>,
}

/// Solutions of the stages of a step, which a stepper keeps for derivatives.
#[derive(Debug, Clone)]
pub(crate) struct StageSolutions<S> {
    keeps: bool,
    /// Solutions of the stages of this step, and how many there are.
    kept: Vec<Unknowns<S>>,
    count: usize,
    /// Parts that have been accepted, with the number of stages up to the end of each.
    parts: Vec<(Part, usize)>,
    /// Their loads, one part after the other [W].
    loads: Vec<S>,
    /// The states between them.
    between: Vec<State<S>>,
}

impl<S: Real> StageSolutions<S> {
    pub(crate) fn nothing() -> Self {
        let (kept, parts, loads, between) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { keeps: false, kept, count: 0, parts, loads, between }
    }

    /// Keeps solutions from now on.
    pub(crate) fn start(&mut self) {
        self.keeps = true;
    }

    /// Whether solutions are kept.
    #[inline(always)]
    pub(crate) fn keeps(&self) -> bool {
        self.keeps
    }

    /// A step begins.
    #[inline(always)]
    pub(crate) fn begin(&mut self) {
        self.count = 0;
        self.parts.clear();
        self.loads.clear();
        self.between.clear();
    }

    /// The stages of a part begin, or begin again.
    #[inline(always)]
    pub(crate) fn restart(&mut self) {
        self.count = self.accepted();
    }

    /// Number of stages of the parts that have been accepted.
    fn accepted(&self) -> usize {
        self.parts.last().map_or(0, |&(_, end)| end)
    }

    /// A stage has been solved.
    #[inline(always)]
    pub(crate) fn keep(&mut self, solved: &Unknowns<S>) {
        if self.keeps {
            if let Some(kept) = self.kept.get_mut(self.count) {
                kept.copy_from(solved);
            } else {
                self.kept.push(solved.clone());
            }
            self.count += 1;
        }
    }

    /// The last stage has been corrected.
    #[inline(always)]
    pub(crate) fn amend(&mut self, solved: &Unknowns<S>) {
        if let Some(last) = self.count.checked_sub(1) {
            self.kept[last].copy_from(solved);
        }
    }

    /// A part has been accepted, and has led to a state.
    #[inline(always)]
    pub(crate) fn accept(&mut self, part: Part, state: &State<S>) {
        if self.keeps {
            self.parts.push((part, self.count));
            self.loads.extend_from_slice(&state.load);
            if !part.is_last() {
                self.between.push(state.clone());
            }
        }
    }
}

impl StageSolutions<f64> {
    /// The parts of the step just made.
    pub(crate) fn parts(&self) -> impl Iterator<Item = KnownPart<'_>> {
        let zones = self.loads.len() / self.parts.len().max(1);
        self.parts.iter().enumerate().map(move |(k, &(part, end))| KnownPart {
            part,
            stages: &self.kept[self.first_stage(k)..end],
            load: &self.loads[k * zones..(k + 1) * zones],
            reached: self.between.get(k),
        })
    }

    fn first_stage(&self, part: usize) -> usize {
        part.checked_sub(1).map_or(0, |before| self.parts[before].1)
    }

    /// The parts of the step just made, and their numbers; of cells only some.
    pub(crate) fn write(&self, cells: &[Range<usize>], (parts, numbers): (&mut Vec<Part>, &mut Vec<f64>)) {
        for known in self.parts() {
            parts.push(known.part);
            numbers.extend_from_slice(known.load);
            for stage in known.stages {
                numbers.extend_from_slice(&stage.surfaces);
                numbers.extend_from_slice(&stage.air);
                for cells in cells {
                    numbers.extend_from_slice(&stage.cells[cells.clone()]);
                }
            }
            if let Some(reached) = known.reached {
                reached.write(numbers);
            }
        }
    }

    /// Reads what was written of a step whose parts have some stages each; unknowns and state are of the building.
    pub(crate) fn read(
        &mut self,
        cells: &[Range<usize>],
        (parts, mut numbers): (&[Part], &[f64]),
        stages: usize,
        (unknowns, state): (&Unknowns<f64>, &State<f64>),
    ) {
        let mut take = |values: &mut [f64]| {
            if let Some((own, rest)) = numbers.split_at_checked(values.len()) {
                values.copy_from_slice(own);
                numbers = rest;
            }
        };
        self.begin();
        self.kept.resize(self.kept.len().max(parts.len() * stages), unknowns.clone());
        let zones = state.load.len();
        self.loads.resize(parts.len() * zones, 0.0);
        for (k, &part) in parts.iter().enumerate() {
            take(&mut self.loads[k * zones..(k + 1) * zones]);
            for stage in &mut self.kept[self.count..self.count + stages] {
                take(&mut stage.surfaces);
                take(&mut stage.air);
                for cells in cells {
                    take(&mut stage.cells[cells.clone()]);
                }
            }
            self.count += stages;
            self.parts.push((part, self.count));
            if !part.is_last() {
                let mut all = vec![0.0; state.count()];
                take(&mut all);
                let mut reached = state.clone();
                reached.read(&all, |mine, value| *mine = value);
                self.between.push(reached);
            }
        }
    }
}
