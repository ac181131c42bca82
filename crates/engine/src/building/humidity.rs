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
    /// Of each zone: the first of those that it exchanges vapour with, directly or through others; itself where there is none before it.
    pub(crate) groups: Vec<usize>,
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
        let groups = groups(description.zones.len(), &between);
        Some(Self { recovered: carries.len() - others, places, carries, rows, pattern, groups })
    }

    /// How many of [`Self::carries`] recover vapour: the last ones.
    pub(crate) fn recovered(&self) -> usize {
        self.recovered
    }
}

/// The first zone of the group of each zone, from pairs that exchange vapour.
fn groups(zones: usize, pairs: &[[usize; 2]]) -> Vec<usize> {
    let mut groups: Vec<usize> = (0..zones).collect();
    for pair in pairs {
        let [a, b] = pair.map(|zone| groups[zone]);
        let (first, other) = (a.min(b), a.max(b));
        groups.iter_mut().filter(|group| **group == other).for_each(|group| *group = first);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_of_zones_that_exchange_vapour() {
        assert_eq!(groups(6, &[[4, 1], [2, 5], [5, 1]]), [0, 1, 1, 3, 1, 1]);
        assert_eq!(groups(2, &[]), [0, 1]);
    }
}
