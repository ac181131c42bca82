//! The system of the vapour balances of zones: which zones exchange vapour by air, and where that stands in the matrix.

use super::order::number_zones;
use super::pattern::Pattern;
use crate::input::description::{Description, Vent};

/// The vapour balances of a building.
#[derive(Debug, Clone)]
pub(crate) struct HumidityPlan {
    /// Air that carries vapour, from a zone to another one: of each air path and of each door both ways, of each directed flow,
    /// of each opening between zones both ways, then of each exhaust to each supply of the units that recover vapour; there both may be one zone.
    pub(crate) carries: Vec<[usize; 2]>,
    /// Place in the matrix of what each of them brings; none where both zones are one.
    pub(crate) places: Vec<Option<usize>>,
    /// How many of them recover vapour: the last ones.
    recovered: usize,
    /// Row of each zone.
    pub(crate) rows: Vec<usize>,
    pub(crate) pattern: Pattern,
}

impl HumidityPlan {
    pub(crate) fn new(description: &Description) -> Option<Self> {
        let humidity = description.humidity.as_ref()?;
        let mut carries = Vec::new();
        let paths = description.air_paths.iter().map(|path| path.between);
        for [a, b] in paths.chain(description.doors.iter().map(|door| door.between)) {
            carries.extend([[a, b], [b, a]]);
        }
        carries.extend(description.directed_flows.iter().map(|flow| [flow.from, flow.to]));
        for [a, b] in description.vents.iter().filter_map(Vent::between) {
            carries.extend([[a, b], [b, a]]);
        }
        let others = carries.len();
        for (unit, recovery) in description.ventilation_units.iter().zip(&humidity.recoveries) {
            if recovery.is_some() {
                let of = |exhaust: usize| unit.supply.iter().map(move |supply| [exhaust, supply.zone]);
                carries.extend(unit.exhaust.iter().flat_map(|exhaust| of(exhaust.zone)));
            }
        }
        let between: Vec<[usize; 2]> = carries.iter().copied().filter(|[from, to]| from != to).collect();
        let (rows, pattern) = number_zones(description.zones.len(), &between);
        let place = |&[from, to]: &[usize; 2]| pattern.place(rows[to], rows[from]).filter(|_| from != to);
        let places = carries.iter().map(place).collect();
        Some(Self { recovered: carries.len() - others, places, carries, rows, pattern })
    }

    /// How many of [`Self::carries`] recover vapour: the last ones.
    pub(crate) fn recovered(&self) -> usize {
        self.recovered
    }
}
