//! Materials, layers and glazings.

use super::numbers::{check_count, check_fractions, check_rising};
use super::{Checked, check_index, check_schedule, refuse};
use crate::input::description::{
    Angular, Construction, Description, Glazing, Material, MeltingCurve, PcmLaw, TablePoints,
};

/// The tables of a phase-change material.
pub(super) fn check_material(material: &Material) -> Checked {
    let Material::Pcm { law, .. } = material else { return Ok(()) };
    match law {
        PcmLaw::Melting { curve, .. } => check_curve(curve),
        PcmLaw::History { curves, .. } => curves.iter().try_for_each(check_curve),
        PcmLaw::Tabulated { temperatures, points, melting_range, .. } => {
            let place = "a tabulated phase-change law";
            check_rising(&format!("{place}, temperatures"), temperatures)?;
            check_rising(&format!("{place}, melting range"), melting_range)?;
            let why = "one for each temperature";
            match points {
                TablePoints::Enthalpies(enthalpies) => {
                    check_count(&format!("{place}, enthalpies"), enthalpies.len(), temperatures.len(), why)?;
                    check_rising(&format!("{place}, enthalpies"), enthalpies)
                }
                TablePoints::Capacities(capacities) => {
                    check_count(&format!("{place}, capacities"), capacities.len(), temperatures.len(), why)?;
                    match capacities.iter().find(|capacity| !(capacity.is_finite() && **capacity > 0.0)) {
                        Some(capacity) => {
                            refuse(format_args!("{place}, capacities"), capacity, "numbers above zero")
                        }
                        None => Ok(()),
                    }
                }
            }
        }
    }
}

fn check_curve(curve: &MeltingCurve) -> Checked {
    match curve {
        MeltingCurve::Fractions { temperatures, fractions, .. } => {
            check_rising("measured liquid fractions, temperatures", temperatures)?;
            let place = "measured liquid fractions";
            check_count(place, fractions.len(), temperatures.len(), "one for each temperature")?;
            check_fractions(place, fractions)?;
            match fractions.windows(2).find(|pair| pair[0] > pair[1]) {
                Some(pair) => refuse(place, format_args!("{} after {}", pair[1], pair[0]), "no fall"),
                None => Ok(()),
            }
        }
        MeltingCurve::SmoothStep { continuity, .. } if !(1..=2).contains(continuity) => {
            refuse("a smooth step", format_args!("continuity {continuity}"), "1 or 2")
        }
        _ => Ok(()),
    }
}

/// Layers or a glazing, and their materials.
pub(super) fn check_construction(description: &Description, construction: &Construction) -> Checked {
    let place = format!("construction {}", construction.name);
    if let Some(blind) = &construction.blind {
        if construction.glazing.is_none() {
            return refuse(place, "a blind without a glazing", "a glazing");
        }
        check_schedule(description, format_args!("{place}, blind"), blind.schedule)?;
    }
    match (&construction.glazing, construction.layers.is_empty()) {
        (None, true) => return refuse(place, "neither layers nor a glazing", "one of both"),
        (Some(_), false) => return refuse(place, "layers and a glazing", "one of both"),
        (Some(glazing), true) => return check_glazing(&place, glazing),
        (None, false) => {}
    }
    for layer in &construction.layers {
        let place = format!("{place}, layer {}", layer.name);
        check_index(&place, "material", layer.material, description.materials.len())?;
        let material = &description.materials[layer.material];
        let massless = matches!(material, Material::Resistance { .. } | Material::Rated { .. });
        let (nodes, thick) = (layer.nodes, layer.thickness.is_some());
        if massless && (nodes > 0 || thick) {
            let found =
                format_args!("{nodes} nodes and {}", if thick { "a thickness" } else { "no thickness" });
            return refuse(place, found.to_string(), "a resistance without nodes and without thickness");
        }
        if !massless && (nodes == 0 || !thick) {
            let found =
                format_args!("{nodes} nodes and {}", if thick { "a thickness" } else { "no thickness" });
            return refuse(place, found.to_string(), "at least one node and a thickness");
        }
    }
    Ok(())
}

fn check_glazing(place: &str, glazing: &Glazing) -> Checked {
    let Glazing::Panes { panes, gaps, angular } = glazing else { return Ok(()) };
    if panes.is_empty() || gaps.len() + 1 != panes.len() {
        let found = format_args!("{} panes and {} gaps", panes.len(), gaps.len()).to_string();
        return refuse(place, found, "at least one pane, and one gap less than panes");
    }
    if let Some(table) = angular {
        return check_angular(place, table, panes.len());
    }
    match panes.iter().position(|pane| pane.optics.is_none()) {
        Some(pane) => {
            refuse(place, format_args!("pane {pane} without optics"), "optics of every pane or of the unit")
        }
        None => Ok(()),
    }
}

fn check_angular(place: &str, table: &Angular, panes: usize) -> Checked {
    let within = |part: &str| format!("{place}, {part}");
    let (angles, count) = (&table.angles, table.angles.len());
    check_rising(&within("angles"), angles)?;
    if angles.first() != Some(&0.0) || angles.last() != Some(&90.0) {
        let found = format_args!("{} to {} deg", angles[0], angles[count - 1]).to_string();
        return refuse(within("angles"), found, "0 to 90 deg");
    }
    check_count(&within("transmittance"), table.transmittance.len(), count, "one for each angle")?;
    check_fractions(&within("transmittance"), &table.transmittance)?;
    check_count(&within("absorptance"), table.absorptance.len(), panes, "a list for each pane")?;
    for pane in &table.absorptance {
        check_count(&within("absorptance of a pane"), pane.len(), count, "one for each angle")?;
        check_fractions(&within("absorptance of a pane"), pane)?;
    }
    check_fractions(&within("diffuse transmittance"), &table.diffuse_transmittance)?;
    if let Some(diffuse) = &table.diffuse_absorptance {
        check_count(&within("diffuse absorptance"), diffuse.len(), panes, "one for each pane")?;
        check_fractions(&within("diffuse absorptance"), diffuse)?;
    }
    check_fractions(&within("transmittance from inside"), &table.back_transmittance)?;
    if let Some(back) = &table.back_absorptance {
        check_count(&within("absorptance from inside"), back.len(), panes, "one for each pane")?;
        check_fractions(&within("absorptance from inside"), back)?;
    }
    Ok(())
}
