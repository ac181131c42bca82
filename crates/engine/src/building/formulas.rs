//! Laws that are written as text, read once for a plan.

use std::sync::Arc;

use super::ids::{BySurface, SurfaceId};
use crate::error::EngineError;
use crate::input::description::{Convection, Description, Facing, Material, MeltingCurve, PcmLaw, Side};
use crate::physics::convection::formula_text::FormulaText;
use crate::physics::pcm::history;
use crate::physics::pcm::text::FractionText;

/// The law of each surface that is written as text.
pub(crate) fn read(description: &Description) -> Result<BySurface<Option<Arc<FormulaText>>>, EngineError> {
    let mut known: Vec<(&Convection, bool, Arc<FormulaText>)> = Vec::new();
    let mut texts = Vec::with_capacity(2 * description.surfaces.len());
    for (index, wall) in description.surfaces.iter().enumerate() {
        for id in SurfaceId::pair(index) {
            let (side, name) =
                if id.is_outside() { (&wall.outside, "outside") } else { (&wall.inside, "inside") };
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

/// The law of a side; sides with the same text share it.
fn of_side<'a>(
    side: &'a Side,
    known: &mut Vec<(&'a Convection, bool, Arc<FormulaText>)>,
) -> Result<Option<Arc<FormulaText>>, String> {
    let Some(law @ Convection::Formula { formula, valid, numbers }) = &side.convection else {
        return Ok(None);
    };
    let wind = matches!(side.facing, Facing::Outdoors) && side.exposure.wind;
    let names: Vec<&str> = numbers.iter().map(|number| number.name.as_str()).collect();
    let same = known.iter().find(|(other, windy, _)| {
        *windy == wind
            && matches!(other, Convection::Formula { formula: f, valid: v, numbers: n }
                if f == formula && v == valid && n.iter().map(|number| number.name.as_str()).eq(names.iter().copied()))
    });
    if let Some((_, _, text)) = same {
        return Ok(Some(Arc::clone(text)));
    }
    let text = FormulaText::new(formula, valid.as_deref(), &names, wind)
        .map_err(|found| format!("{}: {}", found.key, found.fault))?;
    let text = Arc::new(text);
    known.push((law, wind, Arc::clone(&text)));
    Ok(Some(text))
}
