//! Rated values of windows: U value, solar heat gain and transmittances, from the same panes and gaps that a run uses.
//!
//! Source: EN 673:2011 and EN 410:2011: the surface resistances, and panes of 2.5 degC outside and 17.5 degC inside.

use crate::building::coefficients::{Coefficients, Matter};
use crate::building::glazing::{Glass, GlassPlan, Node, Site};
use crate::building::plan::Plan;

/// Surface resistances outside and inside [m2 K/W] (EN 673:2011, 8.2).
const SURFACES: [f64; 2] = [0.04, 0.13];
/// Temperatures of the outermost and the innermost surface [degC].
const SIDES: [f64; 2] = [2.5, 17.5];
/// Iterations for the conductances of gaps: each reduces the error to a tenth or less.
const ITERATIONS: usize = 40;

/// What a window is rated at, without its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowRating {
    /// U value [W/(m2 K)].
    pub u_value: f64,
    /// Total solar heat gain at normal incidence [-].
    pub solar_heat_gain: f64,
    /// Solar transmittance at normal incidence [-].
    pub transmittance: f64,
    /// Hemispherical solar transmittance [-].
    pub diffuse_transmittance: f64,
}

/// The ratings of all windows of a plan, in the order of [`Plan::windows`].
#[must_use]
pub fn window_ratings(plan: &Plan, numbers: &[f64]) -> Vec<WindowRating> {
    let coefficients = Coefficients::new(plan, numbers);
    let rate = |&w: &usize| {
        let (wall, layout) = (&coefficients.walls[w], plan.walls[w].glass.as_ref());
        let half = |cell: usize| match wall.cells[cell].matter {
            Matter::Solid { conductivity, .. } => 0.5 * wall.cells[cell].thickness / conductivity,
            Matter::Pcm(_) => 0.0,
        };
        let last = wall.cells.len();
        let ends = |link: usize| {
            let before = if link > 0 { half(link - 1) } else { 0.0 };
            before + if link < last { half(link) } else { 0.0 }
        };
        let links = (0..=last).map(|link| wall.extra[link] + ends(link)).collect();
        wall.glass.as_ref().zip(layout).map(|(glass, layout)| rated(glass, layout, links))
    };
    plan.windows.iter().filter_map(rate).collect()
}

/// `links`: resistances from node to node [m2 K/W]; those of gaps filled with gas are computed here.
fn rated(glass: &Glass<f64>, layout: &GlassPlan, mut links: Vec<f64>) -> WindowRating {
    let depths = |links: &[f64]| {
        let mut depth = SURFACES[0];
        let mut all = vec![depth];
        for link in links {
            depth += link;
            all.push(depth);
        }
        (all, depth + SURFACES[1])
    };
    for _ in 0..ITERATIONS {
        let (places, whole) = depths(&links);
        let across = whole - SURFACES[0] - SURFACES[1];
        let at = |place: &f64| SIDES[0] + (SIDES[1] - SIDES[0]) * (place - SURFACES[0]) / across;
        let temperatures: Vec<f64> = places.iter().map(at).collect();
        let cells = &temperatures[1..temperatures.len() - 1];
        let gaps = glass.gaps().iter();
        let convection: Vec<f64> =
            gaps.map(|(link, gap)| gap.convection(cells[link - 1], cells[*link])).collect();
        glass.linearise(cells, &convection, |link, tangent| {
            let (outer, inner) = (temperatures[link], temperatures[link + 1]);
            let flow = tangent.left * outer - tangent.right * inner + tangent.offset;
            links[link] = (outer - inner) / flow;
        });
    }
    let (places, whole) = depths(&links);
    let inward = |node: Node| match node {
        Node::Outside => places[0] / whole,
        Node::Cell(cell) => places[cell + 1] / whole,
        Node::Inside => places[places.len() - 1] / whole,
    };
    let mut panes = vec![0.0; layout.sites.len()];
    // As with an open blind.
    let transmittance = glass.optics.beam.split(1.0, layout.split(&mut panes).0);
    let mut gain = transmittance;
    for (absorbed, site) in panes.iter().zip(&layout.sites) {
        gain += absorbed
            * match site {
                Site::Middle(cell) => inward(Node::Cell(*cell)),
                Site::Surfaces(nodes) => 0.5 * (inward(nodes[0]) + inward(nodes[1])),
            };
    }
    WindowRating {
        u_value: 1.0 / whole,
        solar_heat_gain: gain,
        transmittance,
        diffuse_transmittance: glass.optics.front.transmittance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::building::test_buildings::{WINDOW, glazed_zone, values};

    /// A unit by U and g has both, within the part of the temperature difference that the panes take.
    #[test]
    fn a_simple_unit_has_its_rating() {
        let plan = Plan::new(glazed_zone("area", false)).unwrap();
        let found = window_ratings(&plan, &values(&plan.description));
        assert_eq!((found.len(), plan.windows[0]), (1, WINDOW));
        let rating = found[0];
        assert!((rating.u_value / 2.1 - 1.0).abs() < 0.002, "{rating:?}");
        assert!((rating.solar_heat_gain - 0.7).abs() < 1e-4, "{rating:?}");
        assert!(rating.diffuse_transmittance < rating.transmittance && rating.transmittance < 0.7);
    }
}
