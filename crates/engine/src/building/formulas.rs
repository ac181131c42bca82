//! Laws of the description: the published ones checked against their tables, those written as text read once for a plan.

use std::sync::Arc;

use super::ids::{BySide, SideId};
use crate::error::EngineError;
use crate::input::description::{
    Convection, DerivedOutput, Description, Facing, Material, MeltingCurve, PcmLaw, PublishedLaw, Side, Sky,
    Sorption, TextLaw,
};
use crate::physics::convection::formula_text::{FormulaText, SideNames};
use crate::physics::convection::law::row;
use crate::physics::diffuse::DiffuseSky;
use crate::physics::formula::expression::ExpressionText;
use crate::physics::formula::function::{FunctionText, Kind};
use crate::physics::imposed;
use crate::physics::law_row::{LawRow, Sides, unknown_kind};
use crate::physics::leakage;
use crate::physics::longwave::sky;
use crate::physics::pcm::history;
use crate::physics::pcm::text::FractionText;
use crate::physics::sorption;

/// The law of each surface that is written as text.
pub(crate) fn read(description: &Description) -> Result<BySide<Option<Arc<FormulaText>>>, EngineError> {
    let mut known: Vec<(&Convection, SideNames, Arc<FormulaText>)> = Vec::new();
    let mut texts = Vec::with_capacity(2 * description.surfaces.len());
    for (index, wall) in description.surfaces.iter().enumerate() {
        for id in SideId::pair(index) {
            let (side, name) =
                if id.is_outside() { (&wall.outside, "outside") } else { (&wall.inside, "inside") };
            check_law(side).map_err(|fault| {
                EngineError::Description(format!("surface {}, {name}, convection: {fault}", wall.name))
            })?;
            let text = of_side(side, &mut known).map_err(|fault| {
                EngineError::Description(format!("surface {}, {name}, convection.{fault}", wall.name))
            })?;
            texts.push((id, text));
        }
    }
    texts.sort_by_key(|(id, _)| id.index());
    Ok(texts.into_iter().map(|(_, text)| text).collect())
}

/// Refuses laws of melting that do not exist or lack numbers, and melting curves whose text cannot be read.
pub(crate) fn check_curves(description: &Description) -> Result<(), EngineError> {
    for (index, material) in description.materials.iter().enumerate() {
        let Material::Pcm { law, .. } = material else { continue };
        let curves: Vec<&MeltingCurve> = match law {
            PcmLaw::Melting { curve, .. } => vec![curve],
            PcmLaw::History { model, curves, numbers, .. } => {
                history::check(model, curves.len(), numbers).map_err(|text| {
                    EngineError::Description(format!("material {index}, law of melting: {text}"))
                })?;
                curves.iter().collect()
            }
            PcmLaw::Tabulated { .. } => Vec::new(),
        };
        for curve in curves {
            let MeltingCurve::Text { formula, numbers, range, .. } = curve else { continue };
            let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
            let refuse =
                |text: String| EngineError::Description(format!("material {index}, melting curve: {text}"));
            FractionText::new(formula, &names).map_err(|found| refuse(found.fault.to_string()))?;
            if !(range[0] < range[1] && range.iter().all(|end| end.is_finite())) {
                return Err(refuse(format!("found the range {range:?}, expected one that rises")));
            }
        }
    }
    Ok(())
}

/// Refuses published laws that do not exist or lack numbers, besides those of sides.
pub(crate) fn check_published(description: &Description) -> Result<(), EngineError> {
    type Row = fn(&PublishedLaw) -> Option<LawRow>;
    let mut laws: Vec<(String, &PublishedLaw, Row)> = Vec::new();
    if let Sky::Law(law) = &description.site.sky {
        laws.push(("sky".to_owned(), law, sky::row));
    }
    for zone in &description.zones {
        if let Some(law) = &zone.infiltration.leakage {
            laws.push((format!("zone {}, leakage", zone.name), law, leakage::row));
        }
    }
    for buffer in description.humidity.iter().flat_map(|humidity| &humidity.buffers) {
        if let Sorption::Law(law) = &buffer.sorption {
            let name = &description.surfaces[buffer.surface].name;
            laws.push((format!("humidity, surface {name}, sorption"), law, sorption::row));
        }
    }
    for wall in &description.surfaces {
        for (name, side) in [("outside", &wall.outside), ("inside", &wall.inside)] {
            if let Facing::Imposed { law } = &side.facing {
                laws.push((format!("surface {}, {name}, facing", wall.name), law, imposed::row));
            }
        }
    }
    for bridge in &description.thermal_bridges {
        if let Facing::Imposed { law } = &bridge.to {
            laws.push((format!("thermal bridge {}, to", bridge.name), law, imposed::row));
            if imposed::row(law).is_some_and(|row| row.gives_heat || row.gives_coefficient) {
                return Err(EngineError::Description(format!(
                    "thermal bridge {}, to: found '{}', which gives heat or a coefficient, expected a law of a temperature alone",
                    bridge.name, law.kind
                )));
            }
        }
    }
    for (place, law, row) in laws {
        (row(law).ok_or_else(|| unknown_kind(law)).and_then(|row| row.check(law)))
            .map_err(|fault| EngineError::Description(format!("{place}: {fault}")))?;
    }
    Ok(())
}

/// The model of the diffuse radiation.
pub(crate) fn diffuse_sky(description: &Description) -> Result<DiffuseSky, EngineError> {
    let kind = &description.site.diffuse;
    DiffuseSky::named(kind).ok_or_else(|| {
        let names: Vec<_> = DiffuseSky::ALL.iter().map(|model| model.kind).collect();
        EngineError::Description(format!(
            "diffuse sky: found the kind '{kind}', expected one of {}",
            names.join(", ")
        ))
    })
}

/// Refuses other laws as text that cannot be read.
pub(crate) fn check_texts(description: &Description) -> Result<(), EngineError> {
    let mut laws: Vec<(String, &str, &TextLaw)> = Vec::new();
    for (index, material) in description.materials.iter().enumerate() {
        if let Material::Variable { conductivity, .. } = material {
            laws.push((format!("material {index}, conductivity"), "conductivity", conductivity));
        }
    }
    for zone in &description.zones {
        if let Some(law) = &zone.infiltration.law {
            laws.push((format!("zone {}, infiltration", zone.name), "infiltration", law));
        }
    }
    if let Sky::Text { temperature, law } = &description.site.sky {
        let kind = if *temperature { "sky_temperature" } else { "sky_emissivity" };
        laws.push(("sky".to_owned(), kind, law));
    }
    for (place, kind, law) in laws {
        let names: Vec<&str> = law.numbers.iter().map(|number| number.name.as_str()).collect();
        FunctionText::new(Kind::named(kind), &law.formula, law.valid.as_deref(), &names)
            .map_err(|found| EngineError::Description(format!("{place}: {}: {}", found.key, found.fault)))?;
    }
    check_derived(&description.outputs)
}

/// Refuses derived outputs whose text cannot be read, and loops of them.
fn check_derived(outputs: &[DerivedOutput]) -> Result<(), EngineError> {
    let mut sound = vec![false; outputs.len()];
    for output in outputs {
        let of: Vec<&str> = output.of.iter().map(|used| used.name.as_str()).collect();
        let names: Vec<&str> = output.law.numbers.iter().map(|number| number.name.as_str()).collect();
        ExpressionText::new(&output.law.formula, &of, &names, &[]).map_err(|found| {
            EngineError::Description(format!("output {}: {}: {}", output.name, found.key, found.fault))
        })?;
    }
    // Each round finds those that need only sound ones.
    for _ in outputs {
        for (index, output) in outputs.iter().enumerate() {
            let derived = output.of.iter().filter(|used| used.kind == "derived");
            let mut places = derived.map(|used| used.place.derived);
            sound[index] |= places.all(|place| sound.get(place).copied().unwrap_or(false));
        }
    }
    match outputs.iter().zip(sound).find(|(_, sound)| !sound) {
        Some((output, _)) => Err(EngineError::Description(format!(
            "output {}: found a loop of derived outputs, expected none",
            output.name
        ))),
        None => Ok(()),
    }
}

/// A published law has its numbers, and stands where it may.
fn check_law(side: &Side) -> Result<(), String> {
    if let (Facing::Imposed { law }, Some(_)) = (&side.facing, &side.convection)
        && imposed::row(law).is_some_and(|row| row.gives_coefficient)
    {
        return Err(format!(
            "found convection beside '{}', which gives the coefficient, expected none",
            law.kind
        ));
    }
    let Some(Convection::Law(law)) = &side.convection else { return Ok(()) };
    let row = row(law).ok_or_else(|| unknown_kind(law))?;
    row.check(law)?;
    let imposed = matches!(side.facing, Facing::Measured { .. } | Facing::Imposed { .. });
    if imposed && row.sides != Sides::Any {
        return Err("found a correlation at an imposed temperature, expected a constant coefficient".into());
    }
    Ok(())
}

/// The law of a side; sides with the same text share it.
fn of_side<'a>(
    side: &'a Side,
    known: &mut Vec<(&'a Convection, SideNames, Arc<FormulaText>)>,
) -> Result<Option<Arc<FormulaText>>, String> {
    let Some(law @ Convection::Formula { formula, valid, numbers }) = &side.convection else {
        return Ok(None);
    };
    let outdoors = matches!(side.facing, Facing::Outdoors);
    let given = SideNames {
        wind: outdoors && side.exposure.wind,
        sun: outdoors && side.exposure.sun,
        zone: matches!(side.facing, Facing::Zone { .. }),
        height: side.height.is_some(),
    };
    let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
    let same = known.iter().find(|(other, others, _)| {
        *others == given
            && matches!(other, Convection::Formula { formula: f, valid: v, numbers: n }
                if f == formula && v == valid && n.iter().map(|number| number.name.as_str()).eq(names.iter().copied()))
    });
    if let Some((_, _, text)) = same {
        return Ok(Some(Arc::clone(text)));
    }
    let text = FormulaText::new(formula, valid.as_deref(), &names, given)
        .map_err(|found| format!("{}: {}", found.key, found.fault))?;
    let text = Arc::new(text);
    known.push((law, given, Arc::clone(&text)));
    Ok(Some(text))
}

#[cfg(test)]
mod tests {
    use super::read;
    use crate::building::test_buildings::zones_in_a_row;
    use crate::input::description::{Convection, Facing, ParamId};

    /// The error for a law outside of a wall of a room.
    #[track_caller]
    fn refused(kind: &str, numbers: &[&str], facing: Facing) -> String {
        let numbers: Vec<_> = numbers.iter().map(|name| (*name, ParamId(0))).collect();
        let mut description = zones_in_a_row(1);
        let outside = &mut description.surfaces[0].outside;
        (outside.convection, outside.facing) = (Some(Convection::law(kind, &numbers)), facing);
        match read(&description) {
            Ok(_) => panic!("no refusal of {kind}"),
            Err(error) => error.to_string(),
        }
    }

    #[test]
    fn laws_have_their_numbers_and_stand_where_they_may() {
        let outdoors = Facing::Outdoors;
        assert!(
            refused("trap", &[], outdoors.clone())
                .contains("surface wall, outside, convection: found the kind 'trap'")
        );
        assert!(refused("tarp", &[], outdoors.clone()).contains("'tarp' without 'factor'"));
        assert!(refused("tarp", &["factor", "wind"], outdoors.clone()).contains("number 'wind' of 'tarp'"));
        let half = refused("tarp", &["factor", "roughness"], outdoors);
        assert!(half.contains("roughness and perimeter together"), "{half}");
        let imposed = refused("mowitt", &["factor"], Facing::Measured { channel: 0 });
        assert!(imposed.contains("at an imposed temperature"), "{imposed}");
    }
}
