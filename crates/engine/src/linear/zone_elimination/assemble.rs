//! The equations of a front: heat balances of its surfaces [W] and of its air, the exterior surfaces eliminated.

use crate::number::line::Line;
use crate::number::real::{Chunk, Real};

use super::front::ZoneFront;
use super::layout::{Elimination, Layout};

impl<S: Real> ZoneFront<S> {
    /// Eliminates the exterior surfaces, and sums up what acts on the surfaces of the zone and on its air.
    #[inline(always)]
    pub(super) fn assemble<V: Chunk<S>>(&mut self, elimination: Elimination) {
        let Layout { surfaces, eliminated, .. } = self.layout;
        for start in (0..surfaces).step_by(S::CHUNK) {
            let (mut gain, mut right) = (V::zero(), part!(self.heat, start));
            if start < eliminated {
                let from_walls: (V, V) = self.exterior.eliminate(elimination, start);
                gain = from_walls.0;
                right += from_walls.1;
            }
            self.assemble_register(elimination, start, gain, right);
        }
        if self.side_by_side() {
            return self.sum_airs::<V>(elimination == Elimination::Full);
        }
        let equations = &mut self.equations;
        equations.right[surfaces] = sum(&equations.air_heat[..surfaces]);
        if elimination == Elimination::Full {
            equations.diagonal[surfaces] = sum(&equations.to_air[..eliminated]);
        }
    }

    /// Adds convection and emission of the surfaces of one register. `gain`: heat from the wall by the surface's temperature
    /// [W/K], `right`: by nothing in the zone [W].
    #[inline(always)]
    fn assemble_register<V: Chunk<S>>(
        &mut self,
        elimination: Elimination,
        start: usize,
        gain: V,
        mut right: V,
    ) {
        let places = start..start + S::CHUNK;
        let (laws, equations) = (&self.laws, &mut self.equations);
        let convection: Line<V> = laws.convection_at(start);
        let area: V = part!(self.area, start);
        let mut air_heat = area * convection.offset;
        right = right - air_heat;
        if elimination == Elimination::Full {
            let to_air = area * convection.slope;
            if laws.emission_is_nonlinear() {
                let slope: V = part!(laws.emission[1], start);
                (part!(equations.eliminated, start) / slope)
                    .store(&mut equations.inverse_slope[places.clone()]);
            }
            let inverse_slope = part!(equations.inverse_slope, start);
            let diagonal = (to_air - gain) * inverse_slope;
            let by_emission = to_air * inverse_slope;
            if laws.emission_is_nonlinear() {
                let offset: V = part!(laws.emission[0], start);
                right += diagonal * offset;
                air_heat = air_heat - by_emission * offset;
            }
            to_air.store(&mut equations.to_air[places.clone()]);
            by_emission.store(&mut equations.to_air_by_emission[places.clone()]);
            diagonal.store(&mut equations.diagonal[places.clone()]);
        }
        air_heat.store(&mut equations.air_heat[places.clone()]);
        right.store(&mut equations.right[places]);
    }
}

#[inline(always)]
fn sum<S: Real>(numbers: &[S]) -> S {
    let mut sum = S::zero();
    for &number in numbers {
        sum += number;
    }
    sum
}
