"""Comfort in the rooms of a study, of the model before and after the calibration, over the whole record."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mascarin.comfort import Conditions
from mascarin.errors import InputError, did_you_mean
from mascarin.figures.files import save

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.comfort import Comfort
    from mascarin.study.context.context import StudyContext
    from mascarin.study.steps.findings import Findings, ModelRun

_OUTPUTS = ("air_temperature", "mean_radiant_temperature", "relative_humidity")


def require_rooms(study: StudyContext) -> None:
    """Refuse a comfort that cannot be rated, before the first run.

    Parameters
    ----------
    study : StudyContext
        The study.

    Raises
    ------
    InputError
        There is no such zone, the index needs a humidity that the model does not have, it is not known what
        is seen from a seat, or a package is not installed.
    """
    zones = list(study.building.zones)
    known = {output.name for output in study.building.outputs()}
    for zone, settings in study.plan.comfort.items():
        with study.places.blame("comfort", zone):
            if zone not in zones:
                raise InputError(f"found the zone '{zone}'; {did_you_mean(zone, zones)}")
            simulated = settings.humidity in (None, "simulated")
            needed = "humidity" in settings.index_used.needs and simulated
            if needed and f"{zone}.relative_humidity" not in known:
                raise InputError(
                    "found no humidity; expected 'humidity:' with percent or 'outdoor', because "
                    f"{settings.index_used.title} needs it and the model has no output "
                    f"{zone}.relative_humidity"
                )
            settings.view(study.building, zone)
            # One value says before the first run when a package is missing.
            here = Conditions(np.array([25.0]), np.array([25.0]), 50.0, 20.0, 20.0)
            settings.index_used.evaluate(here, settings.limits)


def rated(findings: Findings) -> dict[tuple[str, str], Comfort]:
    """The comfort of each zone that the study names, by model and zone.

    Parameters
    ----------
    findings : Findings
        The results of a study.

    Returns
    -------
    dict of (str, str) to Comfort
        Model and zone -> comfort; empty where the study asks for none.
    """
    study = findings.context
    if not study.plan.comfort:
        return {}
    return {
        (run.label, zone): found
        for run in (findings.nominal, findings.fitted)
        for zone, found in _of_model(study, run).items()
    }


def _of_model(study: StudyContext, run: ModelRun) -> dict[str, Comfort]:
    building = run.simulation.building.replace(run.results.provenance.changed)
    known = {output.name for output in building.outputs()}
    recorded = {building.output(sensor.output).name for sensor in study.plan.sensors.values()}
    wanted = [f"{zone}.{what}" for zone in study.plan.comfort for what in _OUTPUTS]
    for zone, settings in study.plan.comfort.items():
        view = settings.view(building, zone)
        wanted += [] if view is None else [building.output(name).name for name in view.outputs]
    further = [name for name in dict.fromkeys(wanted) if name in known and name not in recorded]
    results = study.models.of_building(building, further).run()
    return {
        zone: results.comfort(zone, study.climate, settings, building)
        for zone, settings in study.plan.comfort.items()
    }


def comfort_table(found: dict[tuple[str, str], Comfort]) -> pd.DataFrame:
    """Hours and degree-hours of each model, zone and month.

    Parameters
    ----------
    found : dict of (str, str) to Comfort
        From `rated`.

    Returns
    -------
    pandas.DataFrame
        Columns model, zone, index, limits, month, and those of `Comfort.by_month` [h; K h or PMV h].
    """
    import pandas as pd

    tables = []
    for (model, zone), one in found.items():
        table = one.by_month().rename_axis("month").reset_index()
        first = {
            "model": model,
            "zone": zone,
            "index": one.settings.index,
            "limits": str(one.settings.limits),
        }
        for position, (name, value) in enumerate(first.items()):
            table.insert(position, name, value)
        tables.append(table)
    return pd.concat(tables, ignore_index=True)


def comfort_figures(found: dict[tuple[str, str], Comfort], folder: Path) -> list[Path]:
    """Carpets and series of each model and zone.

    Parameters
    ----------
    found : dict of (str, str) to Comfort
        From `rated`.
    folder : Path
        Where to.

    Returns
    -------
    list of Path
        The files.
    """
    return [
        save(one.plot(kind), folder / f"comfort-{zone}-{model}-{kind}.svg")
        for (model, zone), one in found.items()
        for kind in ("carpet", "series")
    ]
