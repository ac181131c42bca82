"""Phase-change layers of the fitted model, as the report shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mascarin.study.context.phase_change import law_curve, melting_layers, path
from mascarin.study.results.document.numbers import rounded
from mascarin.study_document.analysis import LayerDay, PhaseChangeEntry

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.study.context.context import StudyContext
    from mascarin.study.context.phase_change import MeltingLayer
    from mascarin.study.steps.findings import ModelRun


def phase_change(study: StudyContext, run: ModelRun) -> list[PhaseChangeEntry]:
    """States of each phase-change layer over the record."""
    building = run.simulation.building.replace(run.results.provenance.changed)
    return [_melting(study, run, building, layer) for layer in melting_layers(building)]


def _melting(study: StudyContext, run: ModelRun, building: Building, layer: MeltingLayer) -> PhaseChangeEntry:
    names = [output.name for output in run.results.outputs]
    fraction = run.results.records[:, names.index(layer.liquid_fraction)]
    temperature, enthalpy = path(run.results, building, layer)
    margin = 0.05 * float(np.ptp(temperature))
    ends = float(temperature.min()) - margin, float(temperature.max()) + margin
    law = law_curve(layer.of(building), *ends)
    stride = max(1, round(3600.0 / run.simulation.step_seconds))
    days = _shown_days(run, study, enthalpy)
    moved = max((float(np.ptp(enthalpy[rows])) for _, _, rows in days), default=0.0)
    material = layer.of(building)
    stated: dict[str, Any] = (
        {} if law is None else {"law_temperature": rounded(law[0]), "law_enthalpy": rounded(law[1])}
    )
    if material.one_curve is not None:
        # What a law with a state does beside its curve, where it is no second curve.
        stated["own_path"] = material.one_curve.path
    return PhaseChangeEntry(
        label=f"{layer.surface}: {layer.layer}",
        column=f"state/{layer.liquid_fraction}",
        hysteresis=material.hysteresis is not None,
        temperature=rounded(temperature[::stride]),
        enthalpy=rounded(enthalpy[::stride]),
        days=[
            LayerDay(
                label=f"{what}, {day}",
                temperature=rounded(temperature[rows]),
                enthalpy=rounded(enthalpy[rows]),
            )
            for what, day, rows in days
        ],
        rows=[
            ["liquid fraction at the start", f"{fraction[0]:.3f}"],
            ["smallest liquid fraction", f"{fraction.min():.3f}"],
            ["largest liquid fraction", f"{fraction.max():.3f}"],
            ["mean liquid fraction", f"{fraction.mean():.3f}"],
            ["largest change of enthalpy within a day", f"{moved:.0f} kJ/kg"],
        ],
        **stated,
    )


def _shown_days(
    run: ModelRun, study: StudyContext, enthalpy: npt.NDArray[np.float64]
) -> list[tuple[str, str, npt.NDArray[np.intp]]]:
    """The coldest and the warmest whole day, and the one with the largest change of enthalpy."""
    index = run.results.index
    day = index.tz_localize(None).normalize()
    steps_per_day = round(86400.0 / run.simulation.step_seconds)
    rows = {
        date: np.flatnonzero((day == date) & (index >= study.periods.compared_from)) for date in day.unique()
    }
    rows = {date: positions for date, positions in rows.items() if positions.size >= steps_per_day}
    if len(rows) < 3:
        return []
    mean = {date: float(enthalpy[positions].mean()) for date, positions in rows.items()}
    amplitude = {date: float(np.ptp(enthalpy[positions])) for date, positions in rows.items()}
    chosen = {
        "coldest": min(mean, key=mean.__getitem__),
        "warmest": max(mean, key=mean.__getitem__),
        "largest change of enthalpy": max(amplitude, key=amplitude.__getitem__),
    }
    return [(what, f"{date:%d %b %Y}", rows[date]) for what, date in chosen.items()]
