//! The equations of a front: heat balances of its surfaces [W] and of its air, the exterior surfaces eliminated.

use crate::number::line::Line;
use crate::number::real::{Abreast, Real};

use super::laws::Laws;
use super::{Elimination, Layout, ZoneFront};

/// The coefficients of a front. Unknowns are emissions, see the [module](super).
#[derive(Debug, Clone)]
pub(super) struct Equations<S> {
    /// Exchange areas: what a surface loses by its own emission and gains by that of others [m2]; symmetric.
    pub(super) exchange: Vec<S>,
    /// One for eliminated surfaces, else zero; and this over the slope of the emission [m2 K/W]: the temperature of a retained
    /// surface is an unknown of the coupled system, which its convection is assembled into.
    eliminated: Vec<S>,
    pub(super) inverse_slope: Vec<S>,
    /// Convective conductance to the air [W/K], the same per emission [m2], and heat into the air that depends on no
    /// temperature [W].
    pub(super) to_air: Vec<S>,
    pub(super) to_air_by_emission: Vec<S>,
    air_heat: Vec<S>,
    /// What the diagonal has beside the exchange [m2], for the air [W/K]; right-hand side [W].
    pub(super) diagonal: Vec<S>,
    pub(super) right: Vec<S>,
}

impl<S: Real> Equations<S> {
    /// Equations without exchange.
    pub(super) fn new(layout: &Layout, laws: &Laws<S>) -> Self {
        let zeros = || vec![S::zero(); layout.stride];
        let mut eliminated = zeros();
        eliminated[..layout.eliminated].fill(S::one());
        let slopes = eliminated.iter().zip(&laws.emission[1]);
        Self {
            exchange: vec![S::zero(); layout.stride * layout.stride],
            inverse_slope: slopes.map(|(&flag, &slope)| flag / slope).collect(),
            eliminated,
            to_air: zeros(),
            to_air_by_emission: zeros(),
            air_heat: zeros(),
            diagonal: zeros(),
            right: zeros(),
        }
    }
}

impl<S: Real> ZoneFront<S> {
    /// Eliminates the exterior surfaces, and sums up what acts on the surfaces of the zone and on its air.
    #[inline(always)]
    pub(super) fn assemble<V: Abreast<S>>(&mut self, elimination: Elimination) {
        let Layout { surfaces, eliminated, .. } = self.layout;
        for start in (0..surfaces).step_by(S::SIDE) {
            let (mut gain, mut right) = (V::zero(), part!(self.heat, start));
            if start < eliminated {
                let from_walls: (V, V) = self.exterior.eliminate(elimination, start);
                gain = from_walls.0;
                right += from_walls.1;
            }
            self.assemble_register(elimination, start, gain, right);
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
    fn assemble_register<V: Abreast<S>>(
        &mut self,
        elimination: Elimination,
        start: usize,
        gain: V,
        mut right: V,
    ) {
        let places = start..start + S::SIDE;
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
