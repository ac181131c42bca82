"""The page beside the report in which the calibrated building runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Literal, cast, get_args

import numpy as np

from mascarin._io.arguments import kind_of
from mascarin.errors import InputError, SolverError
from mascarin.pages.live import Sent, live_page
from mascarin.pages.live.sliders import calibrated
from mascarin.study.carried.calibrated_building import FILE
from mascarin.study.context.storage import MODEL
from mascarin.study_document.document import LivePageEntry
from mascarin.weather import Measurements

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd

    from mascarin.building import Building
    from mascarin.simulation.preparation.initial import Initial
    from mascarin.study.context.context import StudyContext

PageContent = Literal["model", "measured", "none"]
"""What a study writes beside its report: the model, the model beside measured values, or no page."""
#: Length of its run at most. [d]
DAYS: Final = 14


def checked(content: str) -> PageContent:
    """The argument ``page`` of a study.

    Raises
    ------
    InputError
        It is none of the three.
    """
    if content not in get_args(PageContent):
        raise InputError(f"page: found {kind_of(content)}, expected {', '.join(get_args(PageContent))}")
    return cast("PageContent", content)


def write_page(study: StudyContext, building: Building, out: Path, content: PageContent) -> LivePageEntry:
    """Write the page, or say why there is none.

    Parameters
    ----------
    study : StudyContext
        The study.
    building : Building
        The calibrated building with its posterior.
    out : Path
        Folder of the results.
    content : str
        ``model`` or ``measured``.

    Returns
    -------
    LivePageEntry
        What the report says of it.
    """
    parameters, fixed = calibrated(building)
    if not parameters:
        reasons = "; ".join(f"{path}: {reason}" for path, reason in fixed.items())
        return LivePageEntry(refusal=f"none of the calibrated parameters can have a slider ({reasons})")
    start, end = period(study)
    options: dict[str, Any] = {
        "start": start,
        "end": end,
        "step": study.plan.step,
        "scheme": study.plan.scheme,
        "measurements": study.inputs.driving,
    }
    outputs = dict.fromkeys(building.output(s.output).name for s in study.plan.sensors.values())
    sent = Sent(base=FILE, inputs=[("Study", study.plan.name), ("Building", FILE)])
    if content == "measured":
        sent = sent._replace(**_compared(study, building, start, end))
    names = {"parameters": [each.path for each in parameters], "outputs": list(outputs)}
    refusal = ""
    for initial in _starts(study, start):
        try:
            live_page(building, study.climate, out / MODEL, **names, sent=sent, initial=initial, **options)
        except (InputError, SolverError) as error:
            refusal = refusal or str(error)
        else:
            break
    else:
        return LivePageEntry(refusal=refusal)
    return LivePageEntry(
        file=MODEL,
        period=[time.tz_localize(None).isoformat() for time in (start, end)],
        sliders=[each.path for each in parameters],
        fixed=list(fixed),
        measured=bool(sent.compared),
    )


def period(study: StudyContext) -> tuple[pd.Timestamp, pd.Timestamp]:
    """Days of the page: the whole record, or the first part with the most values that were not identified on.

    Parameters
    ----------
    study : StudyContext
        The study.

    Returns
    -------
    tuple of pandas.Timestamp
        Start and end, at most 14 days.
    """
    import pandas as pd

    periods, observation = study.periods, study.observation
    length, begin, end = pd.Timedelta(days=DAYS), periods.start, periods.end
    if end - begin <= length:
        return begin, end
    unused = (study.used["blind"] | study.used["corroboration"]) & np.isfinite(observation.measured)
    counts = np.concatenate([[0], np.cumsum(unused.sum(axis=1))])
    days = range(int((end - begin - length) / pd.Timedelta(days=1)) + 1)
    starts = [begin + periods.whole_steps(86400.0 * day) for day in days]
    inside = [counts[observation.times.searchsorted([start, start + length])] for start in starts]
    first = starts[int(np.argmax([last - earlier for earlier, last in inside]))]
    return first, first + periods.whole_steps(length.total_seconds())


def _starts(study: StudyContext, start: pd.Timestamp) -> list[Initial]:
    """Initial states to try: that of the study, where it can be had at the start of the page."""
    if start == study.periods.start:
        return [study.models.initial]
    # Sensors may have no values then; temperatures that the study states are those of its own start.
    return [study.models.initial, "repeat"] if study.plan.initial == "measured" else ["repeat"]


def _compared(
    study: StudyContext, building: Building, start: pd.Timestamp, end: pd.Timestamp
) -> dict[str, Any]:
    """Measured series of the sensors that have values in a period, by output."""
    import pandas as pd

    observation = study.observation
    during = observation.during(start, end)
    outputs: dict[str, str] = {}
    for s, (name, sensor) in enumerate(study.plan.sensors.items()):
        if np.isfinite(observation.measured[during, s]).any():
            outputs.setdefault(building.output(sensor.output).name, name)
    means = [name for name, kind in zip(observation.names, observation.kinds, strict=True) if kind == "mean"]
    table = pd.DataFrame(observation.measured, index=observation.times, columns=list(observation.names))
    return {"measurements": Measurements.from_table(table, mean=means), "compared": outputs}
