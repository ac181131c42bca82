//! The pressure network: pressures of zones at which as much air leaves each of them as enters it.
//!
//! The unknown of a zone is its pressure at the ground, above that of the outdoor air there. Through a part of an opening at a
//! height h, `dp = (p_a - e_a h) - (p_b - e_b h)` drives the flow from a to b, with `e = (rho - rho_outdoor) g`; outdoors, p is the pressure
//! of the wind and e is zero. What flows is the air where it comes from; flows are counted as volumes of air of the density of the site, so that
//! their balances are those of mass. They rise with the pressure difference: the balances are those of a minimum of a convex function, and
//! the solution is unique.
//!
//! Each iteration solves the sparse symmetric system of the balances as straight lines. Newton's tangents converge fast near the
//! solution, but jump to and fro about the root of a square root; lines through zero (secants) always approach it, by about half of the
//! distance (reweighted least squares, an MM algorithm: Hunter & Lange 2004, doi:10.1198/0003130042836). Tangents are taken where the
//! last iteration has brought the lane much nearer, secants elsewhere.

use crate::building::vents::VentPlan;
use crate::linear::coupled::CoupledSystem;
use crate::number::real::{ByPrecision, Mask, Real};
use crate::physics::vents::{PressureFlow, flow};

/// Iterations at most. Secants alone need some 45.
const MAX_ITERATIONS: usize = 80;
/// Largest imbalance of a zone over the sum of all flows [-].
const TOLERANCE: ByPrecision = ByPrecision { double: 1e-12, single: 1e-6 };
/// Tangents are taken where the imbalance has fallen to this part of the one before [-], in the first iterations; then secants alone.
const MUCH_NEARER: f64 = 0.6;
const WITH_TANGENTS: usize = 30;
/// Every zone has a leak to outdoors [m3/(s Pa)]: the pressure of a closed one is defined by it. Some millilitres in an hour.
pub(crate) const LEAK: f64 = 1e-10;

/// A part of an opening that air passes in one direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Link<S> {
    pub(crate) from: usize,
    /// None: outdoors.
    pub(crate) to: Option<usize>,
    /// Flow at 1 Pa with the air where it comes from, forwards and backwards [m3/s of air of the site].
    pub(crate) strengths: [S; 2],
    pub(crate) exponent: S,
    /// Pressure difference that wind and stack put on it [Pa].
    pub(crate) drive: S,
}

/// Solves for the pressures.
#[derive(Debug, Clone)]
pub(crate) struct VentNetwork<'a, S> {
    plan: &'a VentPlan,
    system: CoupledSystem<'a, S>,
    pub(crate) links: Vec<Link<S>>,
    laws: Vec<PressureFlow<S>>,
    /// Of each zone [Pa].
    pub(crate) pressures: Vec<S>,
    /// Flow that fans take out of each zone, whatever its pressure [m3/s of air of the site].
    pub(crate) drawn: Vec<S>,
    /// Flow out of each zone less that into it [m3/s of air of the site].
    surplus: Vec<S>,
}

impl<'a, S: Real> VentNetwork<'a, S> {
    pub(crate) fn new(plan: &'a VentPlan) -> Self {
        let zeros = vec![S::zero(); plan.rows.len()];
        Self {
            plan,
            system: CoupledSystem::new(&plan.pattern, 0, 0),
            links: Vec::new(),
            laws: Vec::new(),
            pressures: zeros.clone(),
            drawn: zeros.clone(),
            surplus: zeros,
        }
    }

    /// The flow of a link at the pressures [m3/s of air of the site].
    pub(crate) fn flow(&self, link: usize) -> S {
        self.laws[link].flow
    }

    /// Finds the pressures and the flows of all links. With derivatives, those follow from one more tangent at the solution (implicit
    /// function theorem).
    #[inline(always)]
    pub(crate) fn solve(&mut self) {
        self.pressures.fill(S::zero());
        let mut active = S::Mask::splat(true);
        let mut before = S::constant(f64::INFINITY);
        for iteration in 0..MAX_ITERATIONS {
            let (worst, all) = self.evaluate(true);
            active = active & all.scale(TOLERANCE.of::<S>()).lt(worst);
            if !active.any() {
                break;
            }
            let nearer = worst.lt(before.scale(MUCH_NEARER));
            let tangents = nearer & S::Mask::splat((1..WITH_TANGENTS).contains(&iteration));
            before = worst;
            self.move_pressures(active, tangents);
        }
        if S::DERIVATIVES {
            for pressure in &mut self.pressures {
                *pressure = pressure.fixed();
            }
            self.evaluate(false);
            let all = S::Mask::splat(true);
            self.move_pressures(all, all);
        }
        self.evaluate(false);
    }

    /// Laws and imbalances at the pressures, without derivatives if these are `fixed`. The largest imbalance and the sum of all flows.
    #[inline(always)]
    fn evaluate(&mut self, fixed: bool) -> (S, S) {
        let of = |number: S| if fixed { number.fixed() } else { number };
        let (mut worst, mut all) = (S::zero(), S::zero());
        for (surplus, (&pressure, &drawn)) in
            self.surplus.iter_mut().zip(self.pressures.iter().zip(&self.drawn))
        {
            let by_fans = of(drawn);
            *surplus = pressure.scale(LEAK) + by_fans;
            all += by_fans.abs();
        }
        self.laws.clear();
        for link in &self.links {
            let mut difference = self.pressures[link.from] + of(link.drive);
            if let Some(to) = link.to {
                difference = difference - self.pressures[to];
            }
            let [forwards, backwards] = link.strengths;
            let strength = S::select(difference.lt(S::zero()), backwards, forwards);
            let law = flow(of(strength), of(link.exponent), difference);
            self.surplus[link.from] += law.flow;
            if let Some(to) = link.to {
                self.surplus[to] = self.surplus[to] - law.flow;
            }
            all += law.flow.abs();
            self.laws.push(law);
        }
        for surplus in &self.surplus {
            worst = worst.max(surplus.abs());
        }
        (worst, all)
    }

    /// Moves the pressures of active lanes to the solution of the straight lines, tangents or secants.
    #[inline(always)]
    fn move_pressures(&mut self, active: S::Mask, tangents: S::Mask) {
        let Self { plan, system, links, laws, pressures, surplus, drawn: _ } = self;
        system.clear_matrix();
        for (&row, &surplus) in plan.rows.iter().zip(&*surplus) {
            system.add_diagonal(row, S::constant(LEAK));
            system.right[row] = -surplus;
        }
        for (link, law) in links.iter().zip(laws) {
            // The slopes of the matrix have no part in those of the solution: what it multiplies is zero there.
            let slope = S::select(tangents, law.slope, law.secant).fixed();
            let from = plan.rows[link.from];
            match link.to {
                Some(to) => system.couple(from, plan.rows[to], slope),
                None => system.add_diagonal(from, slope),
            }
        }
        system.solve_rest();
        for (pressure, &row) in pressures.iter_mut().zip(&plan.rows) {
            *pressure = S::select(active, *pressure + system.right[row], *pressure);
        }
    }
}
