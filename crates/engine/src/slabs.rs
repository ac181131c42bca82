//! Walls of constant properties: factored once per stage length, then swept over flat arrays.
//!
//! Their elimination is that of [`Chain::factor`]; what is left of a stage is one sweep over what the cells hold and one
//! over what they reach. What the sweeps need of a cell stands beside what they need of the next.

use core::ops::Range;

use crate::coefficients::Coefficients;
use crate::conduction::Chain;
use crate::plan::Plan;
use crate::real::Real;

/// One wall.
#[derive(Debug, Clone)]
struct Slab<S> {
    wall: usize,
    cells: Range<usize>,
    /// Heat into the inside face per `known` of the last cell [W/(m2 K)].
    last: S,
}

/// All of them; arrays run over all cells of the building.
#[derive(Debug, Clone)]
pub(crate) struct Slabs<S> {
    walls: Vec<Slab<S>>,
    /// Cells of slabs that follow each other.
    runs: Vec<Range<usize>>,
    /// Heat capacity [J/(m3 K)] and volume [m3].
    capacity: Vec<S>,
    volume: Vec<S>,
    /// `known_i = gain_i held_i + carry_i known_(i-1)`.
    gain: Vec<S>,
    carry: Vec<S>,
    /// Heat into the outside face per `known` [W/(m2 K)].
    weight: Vec<S>,
    /// `T_i = known_i + to_outside_i T_outside + next_i T_(i+1)`.
    to_outside: Vec<S>,
    next: Vec<S>,
    known: Vec<S>,
}

impl<S: Real> Slabs<S> {
    pub(crate) fn new(plan: &Plan, numbers: &Coefficients<S>, chains: &[Chain<S>]) -> Self {
        let zeros = || vec![S::zero(); plan.n_cells];
        let mut slabs = Self {
            walls: Vec::new(),
            runs: Vec::new(),
            capacity: zeros(),
            volume: zeros(),
            gain: zeros(),
            carry: zeros(),
            weight: zeros(),
            to_outside: zeros(),
            next: zeros(),
            known: zeros(),
        };
        for (wall, of_plan) in plan.walls.iter().enumerate().filter(|(_, wall)| !wall.nonlinear) {
            let cells = of_plan.first_cell..of_plan.first_cell + of_plan.len();
            for (cell, k) in numbers.walls[wall].cells.iter().zip(cells.clone()) {
                slabs.volume[k] = numbers.walls[wall].area * cell.thickness;
                slabs.capacity[k] = chains[wall].storage[k - cells.start].capacity;
            }
            match slabs.runs.last_mut() {
                Some(run) if run.end == cells.start => run.end = cells.end,
                _ => slabs.runs.push(cells.clone()),
            }
            slabs.walls.push(Slab { wall, cells, last: S::zero() });
        }
        slabs
    }

    /// Factors all walls for a stage length [s].
    #[inline(always)]
    pub(crate) fn factor(
        &mut self,
        numbers: &Coefficients<S>,
        chains: &mut [Chain<S>],
        responses: &mut [[[S; 2]; 2]],
        length: f64,
    ) {
        for slab in &mut self.walls {
            let chain = &mut chains[slab.wall];
            responses[slab.wall] = chain.factor(&numbers.walls[slab.wall], length);
            for (i, k) in slab.cells.clone().enumerate() {
                self.gain[k] = chain.rate[i] * chain.inverse[i];
                self.carry[k] = chain.links[i].left * chain.inverse[i];
                self.weight[k] = chain.links[0].right * chain.path[i];
                self.to_outside[k] = chain.to_outside[i];
                self.next[k] = chain.next[i];
            }
            if let Some(link) = chain.links.last() {
                slab.last = link.left;
            }
        }
    }

    /// Forward sweep: the part of the heat into the faces [W/m2] that comes from what the cells held [J/m3].
    #[inline(always)]
    pub(crate) fn sources(&mut self, held: &[S], sources: &mut [[S; 2]]) {
        for slab in &self.walls {
            let cells = slab.cells.clone();
            let (gain, carry) = (&self.gain[cells.clone()], &self.carry[cells.clone()]);
            let (weight, held) = (&self.weight[cells.clone()], &held[cells.clone()]);
            let sweep = self.known[cells].iter_mut().zip(held).zip(gain).zip(carry).zip(weight);
            let (mut before, mut outside) = (S::zero(), S::zero());
            for ((((known, &held), &gain), &carry), &weight) in sweep {
                before = gain * held + carry * before;
                *known = before;
                outside += weight * before;
            }
            sources[slab.wall] = [outside, slab.last * before];
        }
    }

    /// Backward sweep: cell temperatures from those of the faces.
    #[inline(always)]
    pub(crate) fn temperatures(&self, faces: &[S], cells: &mut [S]) {
        for slab in &self.walls {
            let range = slab.cells.clone();
            let (outside, mut behind) = (faces[2 * slab.wall], faces[2 * slab.wall + 1]);
            let (known, to_outside) = (&self.known[range.clone()], &self.to_outside[range.clone()]);
            let (next, cells) = (&self.next[range.clone()], &mut cells[range]);
            let sweep = cells.iter_mut().zip(known).zip(to_outside).zip(next).rev();
            for (((cell, &known), &to_outside), &next) in sweep {
                behind = known + to_outside * outside + next * behind;
                *cell = behind;
            }
        }
    }

    /// `held = start + ratio (reached - start)` in enthalpies [J/m3], `reached` from temperatures.
    #[inline(always)]
    pub(crate) fn hold_over(&self, cells: &[S], enthalpy: &[S], ratio: f64, held: &mut [S]) {
        for run in &self.runs {
            let (cells, start) = (&cells[run.clone()], &enthalpy[run.clone()]);
            let parts = held[run.clone()].iter_mut().zip(cells).zip(start).zip(&self.capacity[run.clone()]);
            for (((held, &cell), &start), &capacity) in parts {
                *held = start + (capacity * cell - start).scale(ratio);
            }
        }
    }

    /// Takes over the enthalpies that belong to temperatures; the heat stored [J].
    #[inline(always)]
    pub(crate) fn accept(&self, cells: &[S], enthalpy: &mut [S]) -> S {
        // Four sums that do not wait for each other.
        let mut stored = [S::zero(); 4];
        for run in &self.runs {
            let (capacity, volume) = (&self.capacity[run.clone()], &self.volume[run.clone()]);
            let parts = enthalpy[run.clone()].iter_mut().zip(&cells[run.clone()]).zip(capacity).zip(volume);
            for (i, (((enthalpy, &cell), &capacity), &volume)) in parts.enumerate() {
                let reached = capacity * cell;
                stored[i % 4] += volume * (reached - *enthalpy);
                *enthalpy = reached;
            }
        }
        (stored[0] + stored[1]) + (stored[2] + stored[3])
    }
}
