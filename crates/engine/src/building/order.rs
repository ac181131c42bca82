//! The numbering of the unknowns of the coupled system: surfaces in contact with zones, and the air of each zone.
//!
//! First come, zone by zone, the surfaces that exchange heat with their own zone only: surfaces of walls of constant
//! properties, and of most windows, whose other surface is in contact with no zone. Of all others, the unknown with the fewest neighbours comes next
//! (minimum degree; Tinney & Walker 1967, doi:10.1109/PROC.1967.6011; George & Liu 1989, doi:10.1137/1031001), which keeps the
//! factors sparse: unknowns of different zones are coupled only by the walls and the air paths between the zones.
//!
//! In a building of few zones the other surfaces of walls of constant properties come before the surfaces of nonlinear walls
//! and the airs: they need not be eliminated again where only these change. In a building of many zones that would couple all
//! airs with each other. Of both orders, the one with less work is taken.
//!
//! Where it is less work still, the surfaces of thick walls between zones ([`thick_walls`](super::thick_walls)) are eliminated with their own zone, as if
//! they did not meet.

use std::collections::BTreeSet;

use super::ids::SideId;
use super::layout::{SidePlan, SideRole, SurfacePlan, ZonePlan};
use super::pattern::{DENSE, Pattern};
use crate::input::description::{Description, Facing, Vent, ZoneLongwave};

/// The order of elimination; see [`Plan`](crate::building::plan::Plan).
#[derive(Debug, Clone)]
pub(crate) struct Order {
    pub(crate) own_rows: usize,
    pub(crate) pattern: Pattern,
    pub(crate) constant_rows: usize,
    /// Walls whose surfaces are eliminated as if they did not meet.
    pub(crate) thick: Vec<bool>,
}

/// Finds the unknowns and numbers them in the order of elimination. Thick walls are treated as such where it is less work, or
/// always.
pub(crate) fn number_unknowns(
    description: &Description,
    walls: &[SurfacePlan],
    (thick, always): (Vec<bool>, bool),
) -> (Vec<SidePlan>, Vec<ZonePlan>, Order) {
    let (mut surfaces, mut zones) = find_unknowns(description);
    // Positions and order, if the work on the coupled system and on the fronts is not more than allowed; and that work.
    let arrange = |thick: Vec<bool>, most_work: usize| {
        let groups = groups(description, walls, &surfaces, &thick);
        let neighbours = neighbours(description, &surfaces, &zones, (&groups, &thick));
        let of_fronts = work_of_fronts(&zones, &groups);
        let (elimination, groups) = order(&neighbours, &groups, most_work.saturating_sub(of_fronts))?;
        let work = elimination.work() + of_fronts;
        let (position, order) = Order::new(elimination, &groups, thick);
        Some((position, order, work))
    };
    let none = vec![false; walls.len()];
    let apart = if always || thick.contains(&true) { arrange(thick, usize::MAX) } else { None };
    // Where surfaces of a wall do not meet, a zone is solved once more.
    let again: usize = zones.iter().map(|zone| (zone.surfaces.len() + 2).pow(2)).sum();
    let most_work = apart.as_ref().map_or(usize::MAX, |(_, _, work)| work + again);
    let found = if always { None } else { arrange(none, most_work) }.or(apart);
    #[allow(clippy::expect_used, reason = "one of both is followed to its end")]
    let (position, order, _) = found.expect("an order");
    for surface in &mut surfaces {
        if let SideRole::Zone { row, .. } = &mut surface.role {
            *row = position[*row];
        }
    }
    for zone in &mut zones {
        zone.air_row = position[zone.air_row];
        zone.surface_rows = zone.surface_rows.iter().map(|&row| position[row]).collect();
    }
    (surfaces, zones, order)
}

/// Eliminations of the surfaces of constant walls for one of the rest, at least: most balances change from stage to stage.
const SHARE_OF_CONSTANT: usize = 4;

/// Multiplications of the elimination of the zones' own surfaces.
fn work_of_fronts(zones: &[ZonePlan], groups: &[(usize, usize)]) -> usize {
    let of_zone = |zone: &ZonePlan| -> usize {
        let own = zone.surface_rows.iter().filter(|&&row| groups[row].0 == OWN).count();
        let row = zone.surfaces.len() + 2;
        // Of the symmetric part one half.
        (0..own).map(|k| (row - k).pow(2) / 2).sum()
    };
    zones.iter().map(of_zone).sum()
}

/// The order with less work and its groups; none where both take more work than allowed.
fn order(
    neighbours: &[BTreeSet<usize>],
    groups: &[(usize, usize)],
    most_work: usize,
) -> Option<(Elimination, Vec<(usize, usize)>)> {
    let merged = |&group: &(usize, usize)| if group.0 == CONSTANT { (CHANGING, 0) } else { group };
    let all_changing: Vec<_> = groups.iter().map(merged).collect();
    let together = minimum_degree(neighbours.to_vec(), &all_changing, most_work);
    let ended = |elimination: &Elimination| elimination.later.len() == groups.len();
    // In a large building the other order couples nearly everything: it is not followed further than this one's work.
    let apart = minimum_degree(neighbours.to_vec(), groups, together.work().min(most_work));
    if ended(&apart) {
        Some((apart, groups.to_vec()))
    } else if ended(&together) {
        Some((together, all_changing))
    } else {
        None
    }
}

impl Order {
    /// An order that was found for these groups, after the positions of the unknowns.
    fn new(elimination: Elimination, groups: &[(usize, usize)], thick: Vec<bool>) -> (Vec<usize>, Self) {
        let in_group = |wanted: usize| groups.iter().filter(|(group, _)| *group == wanted).count();
        let (own_rows, constant_rows) = (in_group(OWN), in_group(CONSTANT));
        let Elimination { position, later, .. } = elimination;
        let of_row = |coupled: BTreeSet<usize>| {
            let mut rows: Vec<usize> = coupled.into_iter().map(|k| position[k] - own_rows).collect();
            rows.sort_unstable();
            rows
        };
        let mut later: Vec<Vec<usize>> = later.into_iter().skip(own_rows).map(of_row).collect();
        let size = later.len();
        // Entries that are zero change no bit of the solution.
        if size - constant_rows <= DENSE {
            for (row, later) in later.iter_mut().enumerate().skip(constant_rows) {
                *later = (row + 1..size).collect();
            }
        }
        (position, Self { own_rows, pattern: Pattern::new(&later), constant_rows, thick })
    }
}

/// Order of elimination of zones that exchange vapour by air: position of each zone, and the pattern of the matrix.
pub(crate) fn number_zones(count: usize, pairs: &[[usize; 2]]) -> (Vec<usize>, Pattern) {
    let mut neighbours = vec![BTreeSet::new(); count];
    for &[a, b] in pairs {
        neighbours[a].insert(b);
        neighbours[b].insert(a);
    }
    let groups = vec![(CHANGING, 0); count];
    let elimination = minimum_degree(neighbours, &groups, usize::MAX);
    let (position, order) = Order::new(elimination, &groups, Vec::new());
    (position, order.pattern)
}

/// The unknowns in the order of the description: the surfaces in contact with zones, then the air of each zone.
fn find_unknowns(description: &Description) -> (Vec<SidePlan>, Vec<ZonePlan>) {
    let mut zones: Vec<ZonePlan> = description
        .zones
        .iter()
        .map(|_| ZonePlan { surfaces: Vec::new(), surface_rows: Vec::new(), air_row: 0, windows: Vec::new() })
        .collect();
    let mut surfaces = Vec::with_capacity(2 * description.surfaces.len());
    let mut row = 0;
    for (wall, definition) in description.surfaces.iter().enumerate() {
        for (side, part) in [&definition.outside, &definition.inside].into_iter().enumerate() {
            let role = if let Facing::Zone { zone } = part.facing {
                zones[zone].surfaces.push(SideId::new(wall, side));
                zones[zone].surface_rows.push(row);
                row += 1;
                SideRole::Zone { zone, row: row - 1 }
            } else {
                SideRole::Exterior
            };
            surfaces.push(SidePlan { wall, side, role });
        }
    }
    for zone in &mut zones {
        zone.air_row = row;
        row += 1;
    }
    (surfaces, zones)
}

/// Group of the surfaces of constant walls and windows that exchange heat with their own zone only; in each zone, windows come
/// after the other walls and thick walls last.
const OWN: usize = 0;
/// Group of the other surfaces of constant walls.
const CONSTANT: usize = 1;
/// Group of the surfaces of nonlinear walls and of the air of zones.
const CHANGING: usize = 2;

/// Group of each unknown, and the place among the groups of the first kind.
fn groups(
    description: &Description,
    walls: &[SurfacePlan],
    surfaces: &[SidePlan],
    thick: &[bool],
) -> Vec<(usize, usize)> {
    let in_zones = surfaces.iter().filter(|surface| surface.role != SideRole::Exterior).count();
    let mut groups = vec![(CHANGING, 0); in_zones + description.zones.len()];
    for pair in surfaces.chunks_exact(2) {
        let between_zones = pair.iter().all(|surface| matches!(surface.role, SideRole::Zone { .. }));
        for surface in pair {
            let SideRole::Zone { zone, row } = surface.role else { continue };
            let wall = &walls[surface.wall];
            if !between_zones && wall.eliminated_in_front(&description.zones[zone]) {
                groups[row] = (OWN, 3 * zone + usize::from(wall.nonlinear));
            } else if between_zones && !wall.nonlinear {
                groups[row] = if thick[surface.wall] { (OWN, 3 * zone + 2) } else { (CONSTANT, 0) };
            }
        }
    }
    groups
}

/// Which unknowns of the coupled system exchange heat directly. Those of the first group have no neighbours here: what each of them
/// meets in its zone meets already, so that their elimination couples nothing anew.
fn neighbours(
    description: &Description,
    surfaces: &[SidePlan],
    zones: &[ZonePlan],
    (groups, thick): (&[(usize, usize)], &[bool]),
) -> Vec<BTreeSet<usize>> {
    let row = |surface: SideId| match surfaces[surface.index()].role {
        SideRole::Zone { row, .. } => Some(row),
        SideRole::Exterior => None,
    };
    let unknowns = zones.iter().map(|zone| zone.surfaces.len() + 1).sum();
    let mut neighbours = vec![BTreeSet::new(); unknowns];
    let mut couple = |a: usize, b: usize| {
        neighbours[a].insert(b);
        neighbours[b].insert(a);
    };
    for (zone, definition) in zones.iter().zip(&description.zones) {
        let rows: Vec<usize> =
            zone.surface_rows.iter().copied().filter(|&row| groups[row].0 != OWN).collect();
        for (i, &a) in rows.iter().enumerate() {
            couple(a, zone.air_row);
            if !matches!(definition.longwave, ZoneLongwave::None) {
                rows[..i].iter().for_each(|&b| couple(a, b));
            }
        }
    }
    for wall in (0..description.surfaces.len()).filter(|&wall| !thick[wall]) {
        if let (Some(a), Some(b)) = (row(SideId::outside(wall)), row(SideId::inside(wall))) {
            couple(a, b);
        }
    }
    for path in &description.air_paths {
        couple(zones[path.between[0]].air_row, zones[path.between[1]].air_row);
    }
    for [a, b] in coupled_airs(description) {
        couple(zones[a].air_row, zones[b].air_row);
    }
    neighbours
}

/// Zones whose airs exchange heat through doors, by fans, through openings or through thermal bridges.
fn coupled_airs(description: &Description) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = description.doors.iter().map(|door| door.between).collect();
    pairs.extend(description.directed_flows.iter().map(|flow| [flow.from, flow.to]));
    for unit in description.ventilation_units.iter().filter(|unit| unit.recovery.is_some()) {
        for supply in &unit.supply {
            pairs.extend(unit.exhaust.iter().map(|exhaust| [exhaust.zone, supply.zone]));
        }
    }
    for bridge in &description.thermal_bridges {
        if let Facing::Zone { zone } = bridge.to {
            pairs.push([bridge.zone, zone]);
        }
    }
    pairs.extend(description.vents.iter().filter_map(Vent::between));
    pairs.retain(|[a, b]| a != b);
    pairs
}

/// An order of elimination and what it does.
struct Elimination {
    /// Position of each unknown in the order.
    position: Vec<usize>,
    /// By position the unknowns eliminated later that the eliminated one is coupled with, those that elimination adds (the
    /// fill) included.
    later: Vec<BTreeSet<usize>>,
    /// Multiplications for the surfaces of constant walls between zones, and for the rest.
    constant: usize,
    changing: usize,
}

impl Elimination {
    /// Multiplications, those for constant walls by their share.
    fn work(&self) -> usize {
        self.changing + self.constant / SHARE_OF_CONSTANT
    }
}

/// Eliminates group by group, always the unknown with the fewest neighbours next; those of the first group in their order.
/// Gives up where this takes more work than allowed.
fn minimum_degree(
    mut neighbours: Vec<BTreeSet<usize>>,
    groups: &[(usize, usize)],
    most_work: usize,
) -> Elimination {
    let n = neighbours.len();
    let key = |k: usize, degree: usize| (groups[k], if groups[k].0 == OWN { 0 } else { degree }, k);
    let mut waiting: BTreeSet<_> = (0..n).map(|k| key(k, neighbours[k].len())).collect();
    let mut found =
        Elimination { position: vec![usize::MAX; n], later: Vec::with_capacity(n), constant: 0, changing: 0 };
    while let Some((group, _, chosen)) = waiting.pop_first() {
        found.position[chosen] = found.later.len();
        let coupled = core::mem::take(&mut neighbours[chosen]);
        match group.0 {
            OWN => {}
            CONSTANT => found.constant += coupled.len() * coupled.len(),
            _ => found.changing += coupled.len() * coupled.len(),
        }
        if found.work() > most_work {
            break;
        }
        // Elimination couples all neighbours of the unknown with each other.
        for &k in &coupled {
            waiting.remove(&key(k, neighbours[k].len()));
            neighbours[k].extend(coupled.iter().filter(|&&other| other != k));
            neighbours[k].remove(&chosen);
            waiting.insert(key(k, neighbours[k].len()));
        }
        found.later.push(coupled);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(n: usize, couplings: &[[usize; 2]]) -> Vec<BTreeSet<usize>> {
        let mut neighbours = vec![BTreeSet::new(); n];
        for &[a, b] in couplings {
            neighbours[a].insert(b);
            neighbours[b].insert(a);
        }
        neighbours
    }

    /// Couplings that elimination adds to those of a graph.
    fn fill(n: usize, couplings: &[[usize; 2]], groups: &[(usize, usize)]) -> usize {
        let Elimination { later, .. } = minimum_degree(graph(n, couplings), groups, usize::MAX);
        later.iter().map(BTreeSet::len).sum::<usize>() - couplings.len()
    }

    /// A chain of zones joined by walls and air paths: surface, air, surface of each zone in a row, and so on. It has no
    /// cycle: minimum degree eliminates it from its ends, without fill, whatever the numbering.
    #[test]
    fn a_chain_of_zones_has_no_fill() {
        let n = 30;
        let numbered = |k: usize| k * 7 % n;
        let chain: Vec<[usize; 2]> = (1..n).map(|k| [numbered(k - 1), numbered(k)]).collect();
        let groups = vec![(CHANGING, 0); n];
        assert_eq!(fill(n, &chain, &groups), 0);
        let Elimination { later, .. } = minimum_degree(graph(n, &chain), &groups, usize::MAX);
        assert!(later[..n - 1].iter().all(|coupled| coupled.len() == 1) && later[n - 1].is_empty());
    }

    /// An order that takes more work than allowed is given up; one that takes as much is not.
    #[test]
    fn an_order_with_too_much_work_is_given_up() {
        let star: Vec<[usize; 2]> = (1..6).map(|k| [0, k]).collect();
        let groups = [(CHANGING, 0); 6];
        let whole = minimum_degree(graph(6, &star), &groups, usize::MAX);
        assert_eq!((whole.work(), whole.later.len()), (5, 6));
        assert_eq!(minimum_degree(graph(6, &star), &groups, 5).later.len(), 6);
        assert!(minimum_degree(graph(6, &star), &groups, 4).later.len() < 6);
    }

    /// A ring of n unknowns: each of the first n - 3 eliminations couples two neighbours anew.
    #[test]
    fn a_ring_has_the_least_fill() {
        for n in 4..9 {
            let ring: Vec<[usize; 2]> = (0..n).map(|k| [k, (k + 1) % n]).collect();
            assert_eq!(fill(n, &ring, &vec![(CHANGING, 0); n]), n - 3);
        }
    }

    /// A star is eliminated from its points; with its centre in an earlier group, all points are coupled with each other.
    #[test]
    fn groups_come_before_degrees() {
        let star: Vec<[usize; 2]> = (1..6).map(|k| [0, k]).collect();
        let mut groups = vec![(CHANGING, 0); 6];
        assert_eq!(fill(6, &star, &groups), 0);
        groups[0] = (CONSTANT, 0);
        assert_eq!(fill(6, &star, &groups), 5 * 4 / 2);
        assert_eq!(minimum_degree(graph(6, &star), &groups, usize::MAX).position[0], 0);
    }
}
