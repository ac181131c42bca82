//! Where the heat that windows absorb acts: in cells and on surfaces, and in the air behind blinds.

use crate::building::coefficients::Coefficients;
use crate::building::glazing::{Node, Site};
use crate::building::ids::{BySide, SideId};
use crate::building::layout::SideRole;
use crate::building::plan::Plan;
use crate::number::real::Real;
use crate::weather::sun::SolarConditions;
use crate::weather::surface::SurfaceConditions;

impl<S: Real> SolarConditions<S> {
    /// Assigns the heat absorbed in panes to the cells and surfaces where it acts, and that of inner blinds to the air behind
    /// them.
    #[inline(always)]
    pub(crate) fn absorb_in_panes(
        &mut self,
        plan: &Plan,
        coefficients: &Coefficients<S>,
        surfaces: &mut BySide<SurfaceConditions<S>>,
    ) {
        for (at, &w) in self.windows.iter_mut().zip(&plan.windows) {
            let Some(glass) = &plan.walls[w].glass else { continue };
            let mut both = [S::zero(); 2];
            at.cells.fill(S::zero());
            for (site, &heat) in glass.sites.iter().zip(&at.panes) {
                match site {
                    Site::Middle(cell) => at.cells[*cell] += heat,
                    Site::Surfaces(nodes) => {
                        for node in nodes {
                            match node {
                                Node::Outside => both[0] += heat.scale(0.5),
                                Node::Cell(cell) => at.cells[*cell] += heat.scale(0.5),
                                Node::Inside => both[1] += heat.scale(0.5),
                            }
                        }
                    }
                }
            }
            surfaces[SideId::outside(w)].solar = both[0];
            surfaces[SideId::inside(w)].solar += both[1];
            let wall = &coefficients.walls[w];
            let carried = wall.glass.as_ref().and_then(|glass| glass.blind.as_ref()?.1.to_air);
            if let (Some(part), Some(&heat), SideRole::Zone { zone, .. }) =
                (carried, at.panes.last(), plan.surfaces[SideId::inside(w)].role)
            {
                surfaces[SideId::inside(w)].solar += -(part * heat);
                self.to_air[zone] += wall.area * part * heat;
            }
        }
    }
}
