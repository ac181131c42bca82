//! Panes and gaps as a wall: heat through a window.
//!
//! The surfaces of the panes are nodes: the outermost and innermost are the surfaces of the wall, those on the gaps are cells
//! without heat capacity. A pane that has one holds it in a cell in its middle. Sun absorbed in a pane acts in its
//! middle, or half on each of its surfaces: the same for the flows out of it.
//!
//! Between two panes the long-wave exchange is that of two large grey plates, exact in T^4 and iterated with the rest.
//! The convective conductance of a gap is worked out once per stage, at the temperatures that are expected there.
//!
//! Sources:
//! - Gas properties and convection in gaps by tilt: ISO 15099:2003, 5.3 and annex B, after Elsherbiny, Raithby &
//!   Hollands (1982), doi:10.1115/1.3245063; Hollands, Unny, Raithby & Konicek (1976), doi:10.1115/1.3450517;
//!   Wright (1996), ASHRAE Trans. 102(1).
//! - Films of a rated U value: ISO 10292:1994 and EN 673.
//! - A unit by U and g: Arasteh, Kohler & Griffith (2009), LBNL-2804E.

use crate::building::coefficients::{Cell, Matter};
use crate::input::description::{Gap, Gas, Glazing, Pane, Surface};
use crate::input::values::Values;
use crate::linear::wall::Link;
use crate::number::real::{Mask, Real};
use crate::physics::longwave::{KELVIN, SIGMA};
use crate::physics::optics::{Diffuse, Optics};

/// Gas constant [J/(mol K)] (CODATA 2018).
const GAS_CONSTANT: f64 = 8.314_462_618;
/// Standard gravity [m/s2].
const GRAVITY: f64 = 9.806_65;
/// Temperature differences across a gap are rounded off within this [K].
const ROUND_OFF: f64 = 0.01;
/// What rated films leave of a frame's or a sheet's resistance is no less than this [m2 K/W].
const LEAST_RESISTANCE: f64 = 1e-3;

/// Where the sun absorbed in a pane acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// In a cell in the middle of the pane.
    Middle(usize),
    /// Half on each surface of the pane.
    Surfaces([Node; 2]),
}

/// A surface of a pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Node {
    /// The outside surface of the wall.
    Outside,
    /// A cell of the wall.
    Cell(usize),
    /// The inside surface of the wall.
    Inside,
}

/// A glazing laid out as cells and links.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GlassPlan {
    /// Pane that each cell belongs to.
    pub cell_panes: Vec<usize>,
    /// Where each pane takes up sun.
    pub sites: Vec<Site>,
    /// Link that stands for each gap.
    pub gap_links: Vec<usize>,
}

impl GlassPlan {
    /// Lays out a glazing.
    #[must_use]
    pub fn new(glazing: &Glazing) -> Self {
        let panes: &[Pane] = match glazing {
            Glazing::Panes { panes, .. } => panes,
            Glazing::Simple { .. } => &[],
        };
        let mut plan = Self { cell_panes: Vec::new(), sites: Vec::new(), gap_links: Vec::new() };
        for (k, pane) in panes.iter().enumerate() {
            let add = |plan: &mut Self| {
                plan.cell_panes.push(k);
                plan.cell_panes.len() - 1
            };
            let front = if k == 0 { Node::Outside } else { Node::Cell(add(&mut plan)) };
            let middle = pane.storage.map(|_| add(&mut plan));
            let last = k + 1 == panes.len();
            let back = if last { Node::Inside } else { Node::Cell(add(&mut plan)) };
            plan.sites.push(middle.map_or(Site::Surfaces([front, back]), Site::Middle));
            if let Node::Cell(cell) = back {
                plan.gap_links.push(cell + 1);
            }
        }
        if plan.sites.is_empty() {
            plan.sites.push(Site::Surfaces([Node::Outside, Node::Inside]));
        }
        plan
    }
}

/// A window's numbers.
#[derive(Debug, Clone)]
pub struct Glass<S> {
    /// Solar optics.
    pub optics: Optics<S>,
    /// For the light of the horizon outside.
    pub horizon: Diffuse<S>,
    /// Gaps whose conductance depends on temperature, with their links.
    gaps: Vec<(usize, FilledGap<S>)>,
}

/// Cells and massless resistances of a glazed wall.
pub struct GlassWall<S> {
    /// Cells, outside to inside.
    pub cells: Vec<Cell<S>>,
    /// Massless resistance in each link [m2 K/W].
    pub extra: Vec<S>,
    /// The rest.
    pub glass: Glass<S>,
}

impl<S: Real> GlassWall<S> {
    /// Evaluates a glazing in a window.
    pub fn new(values: &Values<'_, S>, glazing: &Glazing, plan: &GlassPlan, window: &Surface) -> Self {
        let tilt = values.get(window.tilt);
        match glazing {
            Glazing::Panes { panes, gaps, angular } => {
                let (cells, mut extra) = pane_cells(values, panes, plan);
                let mut filled = Vec::new();
                for (k, (gap, &link)) in gaps.iter().zip(&plan.gap_links).enumerate() {
                    match gap {
                        Gap::Given { conductance } => extra[link] = S::one() / values.get(*conductance),
                        Gap::Filled { thickness, pressure, gas } => {
                            let surfaces = [panes[k].emissivity[1], panes[k + 1].emissivity[0]];
                            let sizes = [values.get(*thickness), values.get_or(window.cavity_height, 1.0)];
                            let exchange = plates(surfaces.map(|id| values.get(id)));
                            let gap = FilledGap::new(*gas, values.get(*pressure), sizes, tilt, exchange);
                            // Replaced in every iteration; one that is not zero keeps the set-up finite.
                            extra[link] = S::one();
                            filled.push((link, gap));
                        }
                    }
                }
                let optics = if let Some(table) = angular {
                    Optics::of_table(values, table)
                } else {
                    let panes: Vec<_> = panes.iter().filter_map(|pane| pane.optics.clone()).collect();
                    Optics::of_panes(values, &panes)
                };
                Self { cells, extra, glass: Glass::new(optics, filled, tilt) }
            }
            Glazing::Simple { u_value, solar_heat_gain, panes, category, films } => {
                let films = films.map(|id| values.get(id));
                let (u, gain) = (values.get(*u_value), values.get(*solar_heat_gain));
                let resistance = rated_resistance(u, films[0] + films[1]);
                let [transmittance, absorptance] = split_gain(u, gain, resistance, films);
                let optics =
                    Optics::of_sheet(transmittance, absorptance, values.get(*panes), values.get(*category));
                let glass = Glass::new(optics, Vec::new(), tilt);
                Self { cells: Vec::new(), extra: vec![resistance], glass }
            }
        }
    }
}

/// Surfaces of panes as cells without thickness, middles as cells of the pane's thickness.
fn pane_cells<S: Real>(values: &Values<'_, S>, panes: &[Pane], plan: &GlassPlan) -> (Vec<Cell<S>>, Vec<S>) {
    let mut extra = vec![S::zero(); plan.cell_panes.len() + 1];
    let middle = |cell: usize| plan.sites.contains(&Site::Middle(cell));
    let mut cells = Vec::with_capacity(plan.cell_panes.len());
    for (i, &k) in plan.cell_panes.iter().enumerate() {
        let pane = &panes[k];
        let conductivity = values.get(pane.conductivity);
        let (thickness, capacity) = match pane.storage {
            Some([density, heat]) if middle(i) => {
                (values.get(pane.thickness), values.get(density) * values.get(heat))
            }
            _ => (S::zero(), S::zero()),
        };
        cells.push(Cell { thickness, matter: Matter::Solid { conductivity, capacity } });
    }
    for (pane, site) in panes.iter().zip(&plan.sites) {
        if let Site::Surfaces([front, _]) = site {
            let link = if let Node::Cell(cell) = front { cell + 1 } else { 0 };
            extra[link] = values.get(pane.thickness) / values.get(pane.conductivity);
        }
    }
    (cells, extra)
}

/// What rated films leave of a resistance [m2 K/W].
pub(crate) fn rated_resistance<S: Real>(u_value: S, films: S) -> S {
    (S::one() / u_value - films).max(S::constant(LEAST_RESISTANCE))
}

/// Transmittance and absorptance that give a solar heat gain at the rated films.
fn split_gain<S: Real>(u_value: S, gain: S, resistance: S, films: [S; 2]) -> [S; 2] {
    let cubic = |c: [f64; 3]| gain * (S::constant(c[1]) + gain.scale(c[0])) + S::constant(c[2]);
    let single = S::select(
        gain.lt(S::constant(0.7206)),
        cubic([0.939_998, 0.203_32, 0.0]),
        cubic([0.0, 1.304_15, -0.305_15]),
    );
    let many = S::select(
        gain.lt(S::constant(0.15)),
        gain.scale(0.410_40),
        cubic([0.085_775, 0.963_954, -0.084_958]),
    );
    // Between the two families of glass the correlation is interpolated by U.
    let share = ((u_value - S::constant(3.4)).scale(1.0 / 1.1)).max(S::zero()).min(S::one());
    let transmittance = (many + share * (single - many)).max(S::zero()).min(gain);
    let inward = (films[0] + resistance.scale(0.5)) / (films[0] + resistance + films[1]);
    let absorptance = (gain - transmittance) / inward;
    // No more than what is not transmitted: else T and A follow from T + A = 1 and T + N A = g.
    let full = (S::one() - gain) / (S::one() - inward);
    let too_much = (S::one() - transmittance).lt(absorptance);
    [S::select(too_much, S::one() - full, transmittance), S::select(too_much, full, absorptance)]
}

/// Exchange factor of two large grey plates [-].
fn plates<S: Real>(emissivities: [S; 2]) -> S {
    let [a, b] = emissivities;
    // Both emissivities may be next to nothing, not nothing.
    S::one() / (S::one() / a + S::one() / b - S::one())
}

/// `a + b T` of conductivity, viscosity and specific heat, T in K, and the molar mass [kg/mol].
#[derive(Debug, Clone, Copy)]
struct Properties {
    conductivity: [f64; 2],
    viscosity: [f64; 2],
    specific_heat: [f64; 2],
    molar_mass: f64,
}

fn properties(gas: Gas) -> Properties {
    let [conductivity, viscosity, specific_heat, [molar_mass, _]] = match gas {
        Gas::Air => [[2.873e-3, 7.760e-5], [3.723e-6, 4.940e-8], [1002.737, 1.2324e-2], [28.97e-3, 0.0]],
        Gas::Argon => [[2.285e-3, 5.149e-5], [3.379e-6, 6.451e-8], [521.9285, 0.0], [39.948e-3, 0.0]],
        Gas::Krypton => [[9.443e-4, 2.826e-5], [2.213e-6, 7.777e-8], [248.0907, 0.0], [83.80e-3, 0.0]],
        Gas::Xenon => [[4.538e-4, 1.723e-5], [1.069e-6, 7.414e-8], [158.3397, 0.0], [131.30e-3, 0.0]],
    };
    Properties { conductivity, viscosity, specific_heat, molar_mass }
}

/// A gap filled with gas.
#[derive(Debug, Clone)]
struct FilledGap<S> {
    gas: Properties,
    /// One over its thickness [1/m].
    inverse: S,
    /// Rayleigh number times viscosity, conductivity and the cube of temperature, over specific heat and difference.
    driving: S,
    /// Height over thickness [-].
    aspect: S,
    /// Factor of the circulation round the whole gap [-], and the Rayleigh number where it sets in.
    round: [S; 2],
    /// Of the outside normal [deg].
    tilt: S,
    exchange: S,
}

impl<S: Real> FilledGap<S> {
    /// A gap of a thickness and a height [m].
    fn new(gas: Gas, pressure: S, [thickness, height]: [S; 2], tilt: S, exchange: S) -> Self {
        let gas = properties(gas);
        let (aspect, density) = (height / thickness, pressure.scale(gas.molar_mass / GAS_CONSTANT));
        Self {
            gas,
            inverse: S::one() / thickness,
            driving: (density * density * thickness * thickness * thickness).scale(GRAVITY),
            aspect,
            round: [
                aspect.powf(S::constant(-0.272)).scale(0.242),
                aspect.scale(Real::powf(0.242, -1.0 / 0.272)),
            ],
            tilt,
            exchange,
        }
    }

    /// Conductance of the gas [W/(m2 K)] between surfaces at two temperatures [degC].
    #[inline(always)]
    fn convection(&self, outer: S, inner: S) -> S {
        let mean = (outer + inner).scale(0.5) + S::constant(KELVIN);
        let linear = |[a, b]: [f64; 2]| S::constant(a) + mean.scale(b);
        let conductivity = linear(self.gas.conductivity);
        let difference = (outer - inner).smooth_abs(ROUND_OFF);
        let rayleigh = self.driving * linear(self.gas.specific_heat) * difference
            / (linear(self.gas.viscosity) * conductivity * (mean * mean * mean));
        // Tilt 0 surfaces up: heat that flows outwards flows up.
        let inclination = S::select(outer.lt(inner), self.tilt, S::constant(180.0) - self.tilt);
        self.nusselt(rayleigh, inclination) * conductivity * self.inverse
    }

    /// Nusselt number, heat flowing from below where the inclination is below 90 deg.
    #[inline(always)]
    fn nusselt(&self, rayleigh: S, inclination: S) -> S {
        let upright = S::constant(90.0);
        let steep = !inclination.lt(S::constant(60.0));
        let over = upright.lt(inclination);
        let mut nusselt = S::one();
        if steep.any() {
            nusselt = vertical_nusselt(rayleigh, self.round);
        }
        if over.any() {
            let hanging = S::one() + (nusselt - S::one()) * radians(inclination).sin();
            nusselt = S::select(over, hanging, nusselt);
        }
        let between = steep & inclination.lt(upright);
        if between.any() {
            let low = nusselt_at_60(rayleigh, self.aspect);
            let blend = low + (nusselt - low) * (inclination - S::constant(60.0)).scale(1.0 / 30.0);
            nusselt = S::select(between, blend, nusselt);
        }
        if (!steep).any() {
            nusselt = S::select(steep, nusselt, sloped_nusselt(rayleigh, inclination));
        }
        nusselt
    }
}

fn radians<S: Real>(degrees: S) -> S {
    degrees.scale(core::f64::consts::PI / 180.0)
}

/// 90 deg; the circulation round the whole gap with its factor and the Rayleigh number from which it exceeds one.
#[inline(always)]
fn vertical_nusselt<S: Real>(rayleigh: S, [round, onset]: [S; 2]) -> S {
    let logarithm = rayleigh.max(S::constant(1e-12)).ln();
    let (slow, fast) = (rayleigh.lt(S::constant(1e4)), !rayleigh.lt(S::constant(5e4)));
    let choose = |below: f64, between: f64, above: f64| {
        S::select(slow, S::constant(below), S::select(fast, S::constant(above), S::constant(between)))
    };
    let exponent = choose(2.298_475_5, 0.4134, 1.0 / 3.0);
    let factor = choose(1.759_667_8e-10, 0.028_154, 0.067_383_8);
    let core = choose(1.0, 0.0, 0.0) + (logarithm * exponent).exp() * factor;
    if onset.lt(rayleigh).any() { core.max(round * logarithm.scale(0.272).exp()) } else { core }
}

/// 60 deg.
#[inline(always)]
fn nusselt_at_60<S: Real>(rayleigh: S, aspect: S) -> S {
    let logarithm = rayleigh.max(S::constant(1e-12)).ln();
    let turn = ((logarithm - S::constant(Real::ln(3160.0))).scale(20.6).exp() + S::one())
        .powf(S::constant(-0.1))
        .scale(0.5);
    let base = logarithm.scale(0.314).exp().scale(0.0936) / (S::one() + turn);
    let first = (base.powf(S::constant(7.0)) + S::one()).powf(S::constant(1.0 / 7.0));
    let second = (S::constant(0.104) + S::constant(0.175) / aspect) * logarithm.scale(0.283).exp();
    first.max(second)
}

/// Below 60 deg.
#[inline(always)]
fn sloped_nusselt<S: Real>(rayleigh: S, inclination: S) -> S {
    let angle = radians(inclination);
    let driving = (rayleigh * angle.cos()).max(S::constant(1e-12));
    let part = |x: S| x.max(S::zero());
    let lift = (angle.scale(1.8)).sin().max(S::constant(1e-12)).powf(S::constant(1.6)).scale(1708.0);
    let onset = part(S::one() - S::constant(1708.0) / driving);
    S::one()
        + (onset * (S::one() - lift / driving)).scale(1.44)
        + part((driving.scale(1.0 / 5830.0)).cbrt() - S::one())
}

impl<S: Real> Glass<S> {
    fn new(optics: Optics<S>, gaps: Vec<(usize, FilledGap<S>)>, tilt: S) -> Self {
        Self { horizon: optics.beam.horizon(radians(tilt).sin()), optics, gaps }
    }

    /// Number of gaps whose conductance depends on temperature.
    pub fn filled_gaps(&self) -> usize {
        self.gaps.len()
    }

    /// Convective conductances of the gaps at expected temperatures [W/(m2 K)].
    #[inline(always)]
    pub fn expect(&self, cells: &[S], convection: &mut [S]) {
        for ((link, gap), convection) in self.gaps.iter().zip(convection) {
            *convection = gap.convection(cells[link - 1], cells[*link]);
        }
    }

    /// Links of the gaps about an iterate.
    #[inline(always)]
    pub fn linearise(&self, cells: &[S], convection: &[S], links: &mut [Link<S>]) {
        for ((link, gap), &convection) in self.gaps.iter().zip(convection) {
            let emission = |temperature: S| {
                let kelvin = temperature + S::constant(KELVIN);
                let cube = (kelvin * kelvin * kelvin).scale(SIGMA) * gap.exchange;
                (cube * kelvin, cube.scale(4.0))
            };
            let (outer, inner) = (cells[link - 1], cells[*link]);
            let ((out, left), (back, right)) = (emission(outer), emission(inner));
            let (left, right) = (left.fixed(), right.fixed());
            links[*link] = Link {
                left: convection + left,
                right: convection + right,
                offset: out - back - left * outer + right * inner,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gap(gas: Gas, thickness: f64, tilt: f64) -> FilledGap<f64> {
        FilledGap::new(gas, 101_325.0, [thickness, 1.0], tilt, plates([0.84, 0.84]))
    }

    /// Still gas conducts: 5 mm of air upright at 10 degC, k = 2.873e-3 + 7.76e-5 T.
    #[test]
    fn a_thin_gap_conducts() {
        let h = gap(Gas::Air, 0.005, 90.0).convection(8.0, 12.0);
        let expected = (2.873e-3 + 7.76e-5 * 283.15) / 0.005;
        assert!((h / expected - 1.0).abs() < 1e-3, "{h} is not {expected}");
    }

    /// EN 673 prints for 12 mm of air between uncoated panes (283 K, 15 K, e = 0.837) a total of about 5.8 W/(m2 K).
    #[test]
    fn an_upright_gap_of_air() {
        let g = gap(Gas::Air, 0.012, 90.0);
        let radiative = g.exchange * SIGMA * 4.0 * 283.15 * 283.15 * 283.15;
        let total = g.convection(2.5, 17.5) + radiative;
        assert!((5.6..6.0).contains(&total), "{total}");
    }

    /// From below the gas turns over, from above it lies still; the branches meet at 60 and 90 deg.
    #[test]
    fn tilt() {
        let up = gap(Gas::Air, 0.016, 0.0);
        assert!(up.convection(0.0, 20.0) > 1.5 * up.convection(20.0, 0.0));
        let still = (2.873e-3 + 7.76e-5 * 283.15) / 0.016;
        assert!((up.convection(20.0, 0.0) / still - 1.0).abs() < 1e-9);
        for angle in [60.0, 90.0] {
            let [below, above] =
                [-1e-7, 1e-7].map(|d| gap(Gas::Air, 1.0 / 60.0, 90.0).nusselt(2e4, angle + d));
            let most = if angle < 61.0 { 0.15 } else { 1e-6 };
            assert!((below / above - 1.0).abs() < most, "{angle}: {below} and {above}");
        }
    }

    /// A pane without capacity, and one with: cells and links.
    #[test]
    fn layout() {
        use crate::input::description::ParamId;
        let pane = |storage| Pane {
            thickness: ParamId(0),
            conductivity: ParamId(0),
            storage,
            emissivity: [ParamId(0); 2],
            optics: None,
        };
        let gaps = vec![Gap::Given { conductance: ParamId(0) }];
        let light = Glazing::Panes { panes: vec![pane(None), pane(None)], gaps: gaps.clone(), angular: None };
        let plan = GlassPlan::new(&light);
        assert_eq!(plan.cell_panes, [0, 1]);
        assert_eq!(plan.gap_links, [1]);
        assert_eq!(
            plan.sites,
            [Site::Surfaces([Node::Outside, Node::Cell(0)]), Site::Surfaces([Node::Cell(1), Node::Inside])]
        );
        let heavy = Some([ParamId(0); 2]);
        let heavy = Glazing::Panes { panes: vec![pane(heavy), pane(heavy)], gaps, angular: None };
        let plan = GlassPlan::new(&heavy);
        assert_eq!(plan.cell_panes, [0, 0, 1, 1]);
        assert_eq!(plan.gap_links, [2]);
        assert_eq!(plan.sites, [Site::Middle(0), Site::Middle(3)]);
    }
}
