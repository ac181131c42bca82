"""The comfort of one room in one run: series, hours, table of months, figures, and what was assumed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from mascarin._io import display
from mascarin.comfort import plots
from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import Discomfort, Evaluation, Floats, discomfort
from mascarin.comfort.heat_balance import dissatisfied
from mascarin.comfort.settings import ComfortSettings
from mascarin.comfort.surroundings import Surroundings

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Comfort:
    """The comfort of a room over a run.

    Made by `Results.comfort`.

    Attributes
    ----------
    zone : str
        Name of the zone.
    settings : ComfortSettings
        Index, limits, person, humidity and hours.
    times : pandas.DatetimeIndex, shape (times,)
        Local times.
    conditions : Conditions
        What the person is exposed to.
    evaluation : Evaluation
        The index and its limits.
    weights : ndarray, shape (times,)
        Time that each value stands for; 0 where nobody is there. [h]
    notes : tuple of str
        What was used and assumed.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> outputs = ["room.air_temperature", "room.mean_radiant_temperature"]
    >>> run = mc.simulate(box(), box_climate(), step="1h", outputs=outputs)
    >>> found = run.comfort("room", index="operative", band=[20, 26])
    >>> float(found.discomfort.assessed_hours)
    72.0
    """

    zone: str
    settings: ComfortSettings
    times: pd.DatetimeIndex
    conditions: Conditions
    evaluation: Evaluation
    weights: Floats
    notes: tuple[str, ...] = ()
    _summary: list[Discomfort] = field(default_factory=list)

    @property
    def discomfort(self) -> Discomfort:
        """Hours and degree-hours outside the limits of comfort."""
        if not self._summary:
            self._summary.append(discomfort(self.evaluation, self.weights))
        return self._summary[0]

    @property
    def hours(self) -> float:
        """Time outside the limits of comfort. [h]"""
        return float(self.discomfort.hours)

    @property
    def degree_hours(self) -> float:
        """Distance from the limits, summed over time. [K h; PMV h for the PMV]"""
        return float(self.discomfort.degree_hours)

    def to_dataframe(self) -> pd.DataFrame:
        """Series of the room and the index over local time.

        Returns
        -------
        pandas.DataFrame
            Columns air_temperature, mean_radiant_temperature, operative_temperature [degC],
            relative_humidity [%] where it is known, the index with its limits, ppd [%] beside the PMV, and
            the hours that each row stands for.
        """
        import pandas as pd

        conditions, evaluation = self.conditions, self.evaluation
        columns: dict[str, Any] = {
            "air_temperature": conditions.air_temperature,
            "mean_radiant_temperature": conditions.radiant_temperature,
            "operative_temperature": conditions.operative_temperature,
        }
        if conditions.relative_humidity is not None:
            columns["relative_humidity"] = conditions.relative_humidity
        columns[self.settings.index.replace("-", "_")] = evaluation.values  # noqa: PD011
        if self.settings.index == "pmv":
            columns["ppd"] = dissatisfied(evaluation.values)
        columns |= {
            "lower_limit": evaluation.low,
            "upper_limit": evaluation.high,
            "occupied_hours": self.weights,
        }
        return pd.DataFrame(columns, index=self.times.rename("time"))

    def by_month(self) -> pd.DataFrame:
        """Hours and degree-hours of each month.

        Returns
        -------
        pandas.DataFrame
            One row for each month: occupied, hot, cold, humid and undefined hours [h], and degree-hours.

        Examples
        --------
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> outputs = ["room.air_temperature", "room.mean_radiant_temperature"]
        >>> run = mc.simulate(box(), box_climate(), step="1h", outputs=outputs)
        >>> run.comfort("room", index="operative", band=[20, 26]).by_month()["occupied"].tolist()
        [72.0]
        """
        import pandas as pd

        # The record at the end of a month belongs to the month that ends, and the first one to its own.
        ends = (self.times - pd.Timedelta(seconds=1)).where(self.times > self.times[0], self.times)
        months = ends.tz_localize(None).to_period("M")
        rows = {}
        for month in months.unique():
            part = discomfort(self.evaluation, np.where(months == month, self.weights, 0.0))
            if float(part.assessed_hours) > 0.0:
                rows[str(month)] = {
                    "occupied": float(part.assessed_hours), "hot": float(part.hot_hours),
                    "cold": float(part.cold_hours), "humid": float(part.humid_hours),
                    "undefined": float(part.undefined_hours), "degree_hours": float(part.degree_hours),
                }  # fmt: skip
        return pd.DataFrame.from_dict(rows, orient="index")

    def to_dict(self) -> dict[str, Any]:
        """Settings, hours and notes as values that JSON can hold."""
        discomfort = self.discomfort
        index = self.settings.index_used
        return {
            "zone": self.zone,
            "index": index.name,
            "limits": self.settings.limits,
            "settings": self.settings.to_dict(),
            "occupied_hours": float(discomfort.assessed_hours),
            "hours_of_discomfort": float(discomfort.hours),
            "hot_hours": float(discomfort.hot_hours),
            "cold_hours": float(discomfort.cold_hours),
            "humid_hours": float(discomfort.humid_hours),
            "degree_hours": float(discomfort.degree_hours),
            "hot_degree_hours": float(discomfort.hot_degree_hours),
            "cold_degree_hours": float(discomfort.cold_degree_hours),
            "unit_of_degree_hours": index.excess_unit,
            "undefined_hours": float(discomfort.undefined_hours),
            "not_valid": {why: float(time) for why, time in discomfort.reasons.items() if float(time) > 0.0},
            "validity": index.validity,
            "source": index.source,
            "notes": list(self.notes),
        }

    def plot(self, kind: str = "series", ax: Axes | None = None) -> Figure:
        """Draw the comfort of the room.

        Parameters
        ----------
        kind : str
            ``series``: the index between its limits; ``carpet``: distance from the limits over days and
            hours; ``profile``: mean day of the coolest and the warmest month; ``psychrometric``: hours on the
            psychrometric chart with Givoni's zones.
        ax : matplotlib.axes.Axes, optional
            Where to draw; default a new figure.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            There is no such kind, or the chart needs a humidity that is not known.
        """
        conditions = self.conditions
        room = {
            "air_temperature": conditions.air_temperature,
            "relative_humidity": None
            if conditions.relative_humidity is None
            else np.asarray(conditions.humidity),
            "pressure": conditions.pressure,
        }
        return plots.draw(kind, self.settings.index_used, self.times, self.evaluation, room, ax)

    def __repr__(self) -> str:
        return display.text(f"Comfort in '{self.zone}'", self._rows())

    def _repr_html_(self) -> str:
        return display.page(
            f"Comfort in '{self.zone}'",
            self._rows(),
            tables={"Months": self.by_month()},
            figures={"Carpet": self.plot("carpet")},
        )

    def _rows(self) -> list[tuple[str, str]]:
        index, discomfort = self.settings.index_used, self.discomfort
        limits = self.settings.limits
        chosen = f"category {limits}" if isinstance(limits, str) else f"band {limits}"
        unit = index.excess_unit
        rows = [
            ("index", f"{index.title} ({index.name}), {chosen}"),
            ("occupied", f"{float(discomfort.assessed_hours):g} h"),
            ("discomfort", f"{self.hours:.4g} h: {float(discomfort.hot_hours):.4g} h too hot, "
                           f"{float(discomfort.cold_hours):.4g} h too cold"),
            ("degree-hours", f"{self.degree_hours:.4g} {unit}: {float(discomfort.hot_degree_hours):.4g} hot, "
                             f"{float(discomfort.cold_degree_hours):.4g} cold"),
        ]  # fmt: skip
        if float(discomfort.humid_hours):
            rows.append(("too humid", f"{float(discomfort.humid_hours):.4g} h"))
        rows.append(("not valid", f"{float(discomfort.undefined_hours):.4g} h, counted as neither"))
        rows += [("", f"{float(h):.4g} h: {why}") for why, h in discomfort.reasons.items() if float(h) > 0.0]
        rows.append(("validity", index.validity))
        return [*rows, *(("note", note) for note in self.notes)]


def assess(
    zone: str,
    settings: ComfortSettings,
    times: pd.DatetimeIndex,
    air: npt.ArrayLike,
    radiant: npt.ArrayLike,
    around: Surroundings | None = None,
    humidity: npt.ArrayLike | None = None,
    notes: tuple[str, ...] = (),
) -> Comfort:
    """Assess the comfort of a room from its series.

    Parameters
    ----------
    zone : str
        Name of the zone.
    settings : ComfortSettings
        Index, limits, person, humidity and hours.
    times : pandas.DatetimeIndex, shape (times,)
        Local times with their zone.
    air, radiant : array_like, shape (times,)
        Temperature of the air and mean radiant temperature. [degC]
    around : Surroundings, optional
        The outdoors at these times.
    humidity : array_like, shape (times,), optional
        Simulated relative humidity. [%]
    notes : tuple of str
        What was used, for the result.

    Returns
    -------
    Comfort
        The comfort of the room.

    Examples
    --------
    >>> import pandas as pd
    >>> times = pd.date_range("2001-07-01", periods=3, freq="1h", tz="UTC")
    >>> settings = ComfortSettings(index="operative", band=[20, 26])
    >>> assess("room", settings, times, [27.0, 27.0, 25.0], [27.0, 27.0, 25.0]).degree_hours
    1.5
    """
    conditions = settings.conditions(air, radiant, around, humidity)
    evaluation = settings.index_used.evaluate(conditions, settings.limits)
    said = list(notes)
    if settings.humidity == "outdoor":
        said.append(
            "the room is assumed to have the humidity ratio of the outdoor air, at most saturated: no "
            "moisture from people, none stored, none removed by cooling"
        )
    elif isinstance(settings.humidity, float):
        said.append(f"the relative humidity is assumed to be {settings.humidity:g} % at all times")
    return Comfort(zone, settings, times, conditions, evaluation, settings.occupied(times), tuple(said))
