//! A glazing as a wall of cells: heat through a window.
//!
//! The surfaces of the panes are nodes: the outermost and innermost are the surfaces of the wall, those on the gaps are cells
//! without heat capacity. A pane with a heat capacity holds it in a cell in its middle. Sun absorbed in a pane acts in its
//! middle, or half on each of its surfaces: both give the same flows out of the pane.
//!
//! The long-wave exchange between two panes is exact in T^4 and iterated with the rest. The convective conductance of a gap is
//! computed once per stage, at temperatures predicted for it (laws in [`window_gaps`](crate::physics::window_gaps)).
//!
//! A blind is one more node outside of the glass or inside of it ([`blinds`](crate::physics::blinds)).
//!
//! A unit by U and g has two panes without heat capacity, the outermost and the innermost, and one gap between them.
//!
//! Source of the surface resistances of a rated U value: ISO 10292:1994 and EN 673.

use super::cell::{Cell, Matter};
use super::ids::SideId;
use crate::input::description::{self, Gap, Glazing, Pane, Surface};
use crate::input::values::Values;
use crate::number::elementary::sin_of_degrees;
use crate::number::real::Real;
use crate::physics::blinds::{Blind, OPEN};
use crate::physics::optics::{Diffuse, Optics, Rating};
use crate::physics::window_gaps::{GapTangent, GasGap};

/// What rated surface resistances leave of a frame's or a sheet's resistance is no less than this [m2 K/W].
const LEAST_RESISTANCE: f64 = 1e-3;
/// Resistance of a pane of a unit by U and g [m2 K/W], 4 mm of glass; a quarter of the whole at most.
const PANE_RESISTANCE: f64 = 0.004;

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
    /// Where the sun absorbed in each pane acts.
    pub sites: Vec<Site>,
    /// Link across each gap.
    pub gap_links: Vec<usize>,
    /// Link between a blind and the glass, and the place of the blind among the sites.
    pub blind: Option<[usize; 2]>,
}

impl GlassPlan {
    /// Lays out a glazing, with its blind.
    #[must_use]
    pub fn new(glazing: &Glazing, blind: Option<&description::Blind>) -> Self {
        let mut plan = Self::of_panes(glazing);
        match blind {
            Some(blind) if blind.inside => plan.add_inner_blind(),
            Some(_) => plan.add_outer_blind(),
            None => {}
        }
        plan
    }

    /// The innermost surface of the panes becomes a cell, the blind the inside surface.
    fn add_inner_blind(&mut self) {
        let cell = self.cell_panes.len();
        self.replace(Node::Inside, Node::Cell(cell));
        self.cell_panes.push(self.cell_panes.last().map_or(0, |pane| *pane));
        self.blind = Some([cell + 1, self.sites.len()]);
        self.sites.push(Site::Surfaces([Node::Inside; 2]));
    }

    /// The outermost surface of the panes becomes the first cell, the blind the outside surface.
    fn add_outer_blind(&mut self) {
        for site in &mut self.sites {
            match site {
                Site::Middle(cell) => *cell += 1,
                Site::Surfaces(nodes) => {
                    for node in nodes {
                        if let Node::Cell(cell) = node {
                            *cell += 1;
                        }
                    }
                }
            }
        }
        self.replace(Node::Outside, Node::Cell(0));
        for link in &mut self.gap_links {
            *link += 1;
        }
        self.cell_panes.insert(0, 0);
        self.blind = Some([0, 0]);
        self.sites.insert(0, Site::Surfaces([Node::Outside; 2]));
    }

    fn replace(&mut self, old: Node, new: Node) {
        let surfaces = self.sites.iter_mut().filter_map(|site| match site {
            Site::Surfaces(nodes) => Some(nodes),
            Site::Middle(_) => None,
        });
        for node in surfaces.flatten().filter(|node| **node == old) {
            *node = new;
        }
    }

    /// Whether no pane stores heat.
    pub(crate) fn stores_nothing(&self) -> bool {
        !self.sites.iter().any(|site| matches!(site, Site::Middle(_)))
    }

    /// The panes among what has a site, and the blind.
    #[inline(always)]
    pub(crate) fn split<'a, T>(&self, all: &'a mut [T]) -> (&'a mut [T], Option<&'a mut T>) {
        match self.blind {
            None => (all, None),
            Some([_, 0]) => {
                let (blind, panes) = all.split_at_mut(1);
                (panes, blind.first_mut())
            }
            Some(_) => {
                let (panes, blind) = all.split_at_mut(all.len() - 1);
                (panes, blind.first_mut())
            }
        }
    }

    fn of_panes(glazing: &Glazing) -> Self {
        let Glazing::Panes { panes, .. } = glazing else {
            let sites = [Node::Outside, Node::Inside].map(|node| Site::Surfaces([node; 2]));
            return Self { cell_panes: vec![0, 1], sites: sites.to_vec(), gap_links: vec![1], blind: None };
        };
        let mut plan = Self { cell_panes: Vec::new(), sites: Vec::new(), gap_links: Vec::new(), blind: None };
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
    gaps: Vec<(usize, GasGap<S>)>,
    /// A blind, with its link to the glass.
    pub blind: Option<(usize, Blind<S>)>,
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
    /// Evaluates a glazing and its blind in a window.
    pub fn new(
        values: &Values<'_, S>,
        (glazing, blind): (&Glazing, Option<&description::Blind>),
        plan: &GlassPlan,
        window: &Surface,
    ) -> Self {
        let mut wall = Self::of_panes(values, glazing, plan, window);
        wall.glass.blind = blind.zip(plan.blind).map(|(blind, [link, _])| {
            // Replaced in every iteration: an open blind.
            wall.extra[link] = S::constant(OPEN);
            (link, Blind::new(values, blind))
        });
        wall
    }

    fn of_panes(values: &Values<'_, S>, glazing: &Glazing, plan: &GlassPlan, window: &Surface) -> Self {
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
                            let emissivities = surfaces.map(|id| values.get(id));
                            let gap = GasGap::new(*gas, values.get(*pressure), sizes, tilt, emissivities);
                            // Replaced in every iteration; a resistance above zero keeps the set-up finite.
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
            Glazing::Simple {
                u_value,
                solar_heat_gain,
                transmittance,
                panes,
                category,
                surface_resistances,
            } => {
                let surface_resistances = surface_resistances.map(|id| values.get(id));
                let u_value = values.get(*u_value);
                let whole = rated_resistance(u_value, surface_resistances[0] + surface_resistances[1]);
                let rating = Rating {
                    gain: values.get(*solar_heat_gain),
                    transmittance: transmittance.map(|id| values.get(id)),
                    u_value,
                    resistances: [whole, whole.scale(0.25).min(S::constant(PANE_RESISTANCE))],
                    panes: values.get(*panes),
                    category: values.get(*category),
                };
                let height = values.get_or(window.cavity_height, 1.0);
                Self::of_rating(&rating, plan, [tilt, height])
            }
        }
    }

    /// Two panes and one gap in place of a unit by its rated values.
    fn of_rating(rating: &Rating<S>, plan: &GlassPlan, [tilt, height]: [S; 2]) -> Self {
        let link = plan.gap_links[0];
        let matter = Matter::Solid { conductivity: S::one(), capacity: S::zero() };
        let surface = Cell { thickness: S::zero(), matter };
        let pane = rating.resistances[1];
        let gap = GasGap::of_rating(&rating.gaps(), height);
        let glass = Glass::new(Optics::of_rating(rating), vec![(link, gap)], tilt);
        // The gap's resistance is replaced in every iteration.
        let cells = vec![surface; plan.cell_panes.len()];
        let mut extra = vec![S::zero(); cells.len() + 1];
        (extra[link - 1], extra[link], extra[link + 1]) = (pane, S::one(), pane);
        Self { cells, extra, glass }
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
    let outer_blind = usize::from(matches!(plan.blind, Some([_, 0])));
    for (pane, site) in panes.iter().zip(plan.sites.iter().skip(outer_blind)) {
        if let Site::Surfaces([front, _]) = site {
            let link = if let Node::Cell(cell) = front { cell + 1 } else { 0 };
            extra[link] = values.get(pane.thickness) / values.get(pane.conductivity);
        }
    }
    (cells, extra)
}

/// What rated surface resistances leave of the resistance of a rated U value [m2 K/W].
pub(crate) fn rated_resistance<S: Real>(u_value: S, surface_resistances: S) -> S {
    (S::one() / u_value - surface_resistances).max(S::constant(LEAST_RESISTANCE))
}

impl<S: Real> Glass<S> {
    /// Optics for diffuse radiation on one of its sides.
    #[inline(always)]
    pub(crate) fn facing(&self, surface: SideId) -> &Diffuse<S> {
        if surface.is_outside() { &self.optics.front } else { &self.optics.back }
    }

    fn new(optics: Optics<S>, gaps: Vec<(usize, GasGap<S>)>, tilt: S) -> Self {
        let sine = sin_of_degrees(tilt);
        Self { horizon: optics.beam.horizon(sine), optics, gaps, blind: None }
    }

    /// The gap and its link, where there is one gap, whose conductance depends on temperature, and no blind.
    pub(crate) fn only_gap(&self) -> Option<&(usize, GasGap<S>)> {
        if let ([gap], None) = (&self.gaps[..], &self.blind) { Some(gap) } else { None }
    }

    /// The gaps whose conductance depends on temperature, with their links.
    pub(crate) fn gaps(&self) -> &[(usize, GasGap<S>)] {
        &self.gaps
    }

    /// Gives the number of each gap's link and the tangent of its heat flow at the temperatures of the cells.
    #[inline(always)]
    pub(crate) fn linearise(&self, cells: &[S], convection: &[S], mut set: impl FnMut(usize, GapTangent<S>)) {
        for ((link, gap), &convection) in self.gaps.iter().zip(convection) {
            set(*link, gap.tangent(convection, cells[link - 1], cells[*link]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let plan = GlassPlan::new(&light, None);
        assert_eq!(plan.cell_panes, [0, 1]);
        assert_eq!(plan.gap_links, [1]);
        assert_eq!(
            plan.sites,
            [Site::Surfaces([Node::Outside, Node::Cell(0)]), Site::Surfaces([Node::Cell(1), Node::Inside])]
        );
        let heavy = Some([ParamId(0); 2]);
        let heavy = Glazing::Panes { panes: vec![pane(heavy), pane(heavy)], gaps, angular: None };
        let plan = GlassPlan::new(&heavy, None);
        assert_eq!(plan.cell_panes, [0, 0, 1, 1]);
        assert_eq!(plan.gap_links, [2]);
        assert_eq!(plan.sites, [Site::Middle(0), Site::Middle(3)]);
    }
}
