//! Which plants run and where saturation takes vapour away in a stage: its linear systems, solved until no zone changes its mode and no
//! layer its tangent.

use crate::building::coefficients::HumidityCoefficients;
use crate::number::real::{Mask, Real};

use super::balances::{Place, VapourBalances};
use super::plants::Mode;

/// Solutions of a stage at most: plants and saturation begin or end in some zones from one to the next, and lines are drawn anew.
const MAX_SOLUTIONS: usize = 30;
/// Part of the way of a round, by that of the round before.
const DAMPING: f64 = 0.5;
/// Sweeps over the zones where modes or tangents cycle, before the next solutions, and how often this is repeated at most.
const SWEEPS: usize = 40;
const MAX_ROUNDS: usize = 30;

impl<S: Real> VapourBalances<'_, S> {
    /// Humidity ratios, and what plants and saturation take away: an active-set method (Hintermueller, Ito & Kunisch 2002,
    /// doi:10.1137/S1052623401383558), which ends after a few solutions.
    #[inline(always)]
    pub(super) fn solve(&mut self, humidity: &HumidityCoefficients<S>, start: &[S], place: Place) {
        self.modes.fill(Mode::idle());
        self.assemble(humidity, start, place);
        let open = self.follow_modes(humidity, start, place);
        if open.any() {
            self.leave_cycle(humidity, start, place, open);
        }
    }

    /// Solutions until no zone changes its mode; where some still do.
    #[inline(always)]
    fn follow_modes(&mut self, humidity: &HumidityCoefficients<S>, start: &[S], place: Place) -> S::Mask {
        let mut changed = S::Mask::splat(false);
        for _ in 0..MAX_SOLUTIONS {
            self.solve_in_modes(place.stage);
            changed = S::Mask::splat(false);
            for (z, (limits, zone)) in self.limits.iter().zip(&humidity.zones).enumerate() {
                let plants = zone.has_plants();
                let next = limits.mode(plants, self.reached[z], self.removed[z], self.diagonal[z]);
                changed = changed | next.differs(&self.modes[z]);
                self.modes[z] = next;
            }
            if !humidity.surfaces.is_empty() {
                self.finish_stage(humidity, start, place);
                let far = self.follow_curves(humidity, place.stage);
                if far.any() {
                    self.assemble(humidity, start, place);
                }
                changed = changed | far;
            }
            if !changed.any() {
                break;
            }
        }
        changed
    }

    /// Modes of the lanes in which those of several zones change each other for ever, or tangents of the sorption, then solutions from there.
    ///
    /// What is taken away bends both ways, so the active-set method may cycle. Zone after zone, each with the solution of its own balance
    /// beside those of the others (nonlinear Gauss-Seidel), the ratios converge from any start: the matrix is an M-matrix, and what is
    /// taken away never falls with the ratio (Ortega & Rheinboldt 1970, doi:10.1137/1.9780898719468, 13.1). The sorption bends both ways,
    /// too: two tangents may lead to each other. Drawn on the way to the contents reached, in each round at a smaller part of it, they do not
    /// (damped Newton method, 14.4 there).
    #[cold]
    #[inline(never)]
    fn leave_cycle(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        start: &[S],
        place: Place,
        mut open: S::Mask,
    ) {
        let mut ratios: Vec<S> =
            (0..humidity.zones.len()).map(|z| self.held(start, z, place.ratio)).collect();
        let mut part = 1.0;
        for _ in 0..MAX_ROUNDS {
            part *= DAMPING;
            for _ in 0..SWEEPS {
                self.solve_zone_by_zone(humidity, place.stage, &mut ratios, open);
                self.go_toward(humidity, (start, place), &ratios, (part, open));
            }
            open = self.follow_modes(humidity, start, place);
            if !open.any() {
                return;
            }
        }
    }

    /// Tangents of the sorption in the open lanes at a part of the way to what layers contain beside some ratios.
    fn go_toward(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        (start, place): (&[S], Place),
        ratios: &[S],
        (part, open): (f64, S::Mask),
    ) {
        if humidity.surfaces.is_empty() {
            return;
        }
        for (reached, &ratio) in self.reached.iter_mut().zip(ratios) {
            *reached = S::select(open, ratio, *reached);
        }
        self.finish_stage(humidity, start, place);
        self.redraw_tangents(humidity, (part, open));
        self.assemble(humidity, start, place);
    }

    /// The balance of each zone beside the ratios of the others, in the open lanes: its ratio and its mode.
    fn solve_zone_by_zone(
        &mut self,
        humidity: &HumidityCoefficients<S>,
        stage: usize,
        ratios: &mut [S],
        open: S::Mask,
    ) {
        let Self { plan, flows, diagonal, right, modes, limits, .. } = self;
        for (z, (limits, zone)) in limits.iter().zip(&humidity.zones).enumerate() {
            let mut brought = right[z];
            for (&[from, to], &carried) in plan.carries.iter().zip(&flows[stage].carried) {
                if to == z && from != z {
                    brought += carried * ratios[from];
                }
            }
            let mode = limits.mode(zone.has_plants(), S::zero(), brought, diagonal[z]);
            let free = (brought - mode.value) / diagonal[z];
            ratios[z] = S::select(open, S::select(mode.held, mode.value, free), ratios[z]);
            let before = modes[z];
            modes[z] = Mode {
                held: (open & mode.held) | (!open & before.held),
                value: S::select(open, mode.value, before.value),
            };
        }
    }

    /// The linear system with each zone held at a humidity ratio, or with a fixed amount taken away.
    #[inline(always)]
    fn solve_in_modes(&mut self, stage: usize) {
        let Self { plan, flows, system, diagonal, right, modes, removed, reached, .. } = self;
        if plan.carries.is_empty() {
            // Zones that exchange no air, such as a single one: with the bits of the system below.
            for (z, mode) in modes.iter().enumerate() {
                let free = S::one() / diagonal[z] * (right[z] - mode.value);
                reached[z] = S::select(mode.held, mode.value, free);
                removed[z] = S::select(mode.held, right[z] - diagonal[z] * reached[z], mode.value);
            }
            return;
        }
        system.clear_matrix();
        for (z, mode) in modes.iter().enumerate() {
            let row = plan.rows[z];
            system.add_diagonal(row, S::select(mode.held, S::one(), diagonal[z]));
            system.right[row] = S::select(mode.held, mode.value, right[z] - mode.value);
        }
        let carried = &flows[stage].carried;
        for ((&[_, to], &place), &carried) in plan.carries.iter().zip(&plan.places).zip(carried) {
            if let Some(place) = place {
                system.add_at(place, -S::select(modes[to].held, S::zero(), carried));
            }
        }
        system.solve_rest();
        for (z, mode) in modes.iter().enumerate() {
            reached[z] = system.right[plan.rows[z]];
            removed[z] = right[z] - diagonal[z] * reached[z];
            // What a held zone is given more than it needs is taken away.
            removed[z] = S::select(mode.held, removed[z], mode.value);
        }
        for (&[from, to], &carried) in plan.carries.iter().zip(carried) {
            if from != to {
                let brought = S::select(modes[to].held, carried * reached[from], S::zero());
                removed[to] += brought;
            }
        }
    }
}
