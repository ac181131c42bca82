"""The key ``comfort:`` of a study or design: which index, its limits, the person, the humidity, the hours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building.base.number import problem, shown
from mascarin.building.base.part import Part, fault, insist
from mascarin.building.parts.air.schedule import ClockTime
from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import Discomfort, Evaluation, Floats, discomfort
from mascarin.comfort.indices import INDICES, Band, Index, index_named, require_limits
from mascarin.comfort.seat import Point, Posture, SeatView, seen_from
from mascarin.comfort.surroundings import Surroundings
from mascarin.errors import InputError
from mascarin.physics import relative_humidity

if TYPE_CHECKING:
    from typing import Self

    import pandas as pd

    from mascarin.building import Building

IndexName = Literal[
    "operative", "adaptive-en", "adaptive-ashrae", "pmv", "set", "heat-index", "utci", "givoni"
]

_CHOICES = "a relative humidity from 0 to 100 %, 'outdoor' or 'simulated'"


def _known_humidity(raw: Any) -> Any:
    if raw is None or raw in ("outdoor", "simulated"):
        return raw
    number = isinstance(raw, int | float) and not isinstance(raw, bool)
    # Rooms are never drier than 1 %: a number up to 1 is a fraction.
    if not number or not (raw == 0.0 or 1.0 < raw <= 100.0):
        raise problem(shown(raw), _CHOICES, "Give percent, such as 60.")
    return float(raw)


def _text(raw: Any) -> Any:
    return str(raw) if isinstance(raw, int) and not isinstance(raw, bool) else raw


Category = Annotated[
    str | None,
    BeforeValidator(_text),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "integer"}, {"type": "null"}]}),
]
Humidity = Annotated[float | Literal["outdoor", "simulated"] | None, BeforeValidator(_known_humidity)]


class ComfortSettings(Part):
    """How comfort is assessed.

    Examples
    --------
    >>> settings = ComfortSettings(index="adaptive-en", category="II")
    >>> settings.limits
    'II'
    """

    index: IndexName = Field("adaptive-en", description="Comfort index")
    category: Category = Field(
        None,
        description="Category: I, II, III (adaptive-en), 80, 90 (adaptive-ashrae), A, B, C (pmv); by default "
        "II, 80 and B",
    )
    band: Band | None = Field(
        None,
        description="Lowest and highest comfortable value, for the indices operative, set, heat-index, utci "
        "[degC]",
    )
    humidity: Humidity = Field(
        None,
        description="Relative humidity of the room [%]; 'outdoor': the room has the humidity ratio of the "
        "outdoor air; 'simulated': that of the run. By default that of the run where it is recorded",
    )
    air_speed: Annotated[float, Field(ge=0.0, le=20.0)] = Field(
        0.1, description="Air speed around the person, such as 0.1 in a closed room, 0.9 under a fan [m/s]"
    )
    metabolic_rate: Annotated[float, Field(ge=0.5, le=10.0)] = Field(
        1.2, description="Metabolic rate: 1.0 sitting, 1.2 office, 1.6 standing work [met]"
    )
    clothing: Annotated[float, Field(ge=0.0, le=5.0)] = Field(
        0.5, description="Insulation of the clothing: 0.3 light, 0.5 summer, 1.0 winter [clo]"
    )
    seat: Point | None = Field(
        None,
        description="Position [x, y, z] of the person, in the coordinates of the vertices: surfaces and "
        "windows count by what is seen of them from there; by default they are weighted by area [m]",
    )
    posture: Posture = Field(
        "sphere",
        description="What sees the surfaces from the seat: a small sphere, or a seated or standing person "
        "(ISO 7726)",
    )
    facing: Annotated[float, Field(ge=0.0, le=360.0)] | None = Field(
        None,
        description="Direction in which the person looks, clockwise from north; none: four directions alike "
        "[deg]",
    )
    hours: tuple[tuple[ClockTime, ClockTime], ...] = Field(
        (), description='Hours in which somebody is there, such as [["08:00", "18:00"]]; by default all'
    )
    days: Literal["all", "weekdays", "weekends"] = Field("all", description="Days on which somebody is there")

    @model_validator(mode="after")
    def _sound(self) -> Self:
        insist(*self._faults())
        return self

    def _faults(self) -> list[InitErrorDetails]:
        index = INDICES[self.index]
        if index.categories and self.band is not None:
            return [fault(("band",), repr(list(self.band)), f"no band: {index.title} has categories: "
                          f"{', '.join(index.categories)}", "Write 'category:' instead.")]  # fmt: skip
        if not index.categories and self.category is not None:
            return [fault(("category",), repr(self.category), f"no category: the limits of {index.title} are "
                          "a band", "Write 'band: [low, high]' instead.")]  # fmt: skip
        try:
            require_limits(index, self.limits)
        except InputError as error:
            key = "category" if index.categories else "band"
            stated, _, expected = str(error).partition("found ")[2].partition("; expected ")
            return [fault((key,), stated, expected, f"Correct '{key}:'.")]
        if self.posture != "sphere" and self.seat is None:
            return [fault(("posture",), repr(self.posture), "a seat beside it", "Add 'seat: [x, y, z]'.")]
        if self.facing is not None and self.posture == "sphere":
            return [fault(("facing",), f"{self.facing:g} deg for a sphere, which is the same on all sides",
                          "posture: seated or standing beside it", "Add 'posture:'.")]  # fmt: skip
        if self.humidity is None or "humidity" in index.needs:
            return []
        return [fault(("humidity",), repr(self.humidity), f"none: {index.title} does not use it",
                      "Leave it out.")]  # fmt: skip

    @property
    def index_used(self) -> Index:
        """The index."""
        return index_named(self.index)

    @property
    def limits(self) -> str | Band | None:
        """Category or band: what was given, else what is usual for the index."""
        if self.category is not None:
            return self.category
        return self.band if self.band is not None else INDICES[self.index].usual

    def view(self, building: Building, zone: str) -> SeatView | None:
        """What is seen from the seat; None without one.

        Parameters
        ----------
        building : Building
            The building.
        zone : str
            Name of the zone.

        Raises
        ------
        InputError
            It is not known what is seen from the seat; see `mascarin.comfort.seen_from`.
        """
        if self.seat is None:
            return None
        return seen_from(building, zone, self.seat, self.posture, self.facing)

    def occupied(self, times: pd.DatetimeIndex) -> Floats:
        """Time that each record stands for, 0 where nobody is there.

        Parameters
        ----------
        times : pandas.DatetimeIndex, shape (times,)
            Local times of the records.

        Returns
        -------
        ndarray, shape (times,)
            Half of the two intervals beside each record. [h]

        Examples
        --------
        >>> import pandas as pd
        >>> times = pd.date_range("2001-07-02", periods=25, freq="1h", tz="UTC")
        >>> float(ComfortSettings(hours=[["08:00", "18:00"]]).occupied(times).sum())
        10.0
        """
        hours_since = np.asarray((times - times[0]).total_seconds(), dtype=np.float64) / 3600.0
        widths = np.diff(hours_since)
        weights = 0.5 * (np.append(widths, 0.0) + np.append(0.0, widths))
        is_present = np.ones(len(times), dtype=bool)
        if self.hours:
            clock = np.asarray(times.hour * 60 + times.minute, dtype=np.float64)
            is_present = np.any([_between(clock, *pair) for pair in self.hours], axis=0)
        if self.days != "all":
            weekend = np.asarray(times.day_of_week) >= 5
            is_present &= weekend if self.days == "weekends" else ~weekend
        return np.where(is_present, weights, 0.0)

    def conditions(
        self,
        air: npt.ArrayLike,
        radiant: npt.ArrayLike,
        around: Surroundings | None = None,
        humidity: npt.ArrayLike | None = None,
    ) -> Conditions:
        """Conditions of the person.

        Parameters
        ----------
        air, radiant : array_like, shape (..., times)
            Temperature of the air and mean radiant temperature. [degC]
        around : Surroundings, optional
            The outdoors at these times.
        humidity : array_like, shape (..., times), optional
            Simulated relative humidity. [%]

        Returns
        -------
        Conditions
            With the relative humidity that the settings name.

        Raises
        ------
        InputError
            The index needs a relative humidity or the outdoor air, and there is none.
        """
        index = self.index_used
        air_ = np.asarray(air, dtype=np.float64)
        if "outdoor temperature" in index.needs and around is None:
            raise InputError(
                f"comfort: {index.name}: found no climate; expected the weather of the run, because "
                f"{index.title} needs the outdoor temperature of the days before: climate=..."
            )
        return Conditions(
            air_temperature=air_,
            radiant_temperature=np.asarray(radiant, dtype=np.float64),
            relative_humidity=self._humidity(air_, around, humidity) if "humidity" in index.needs else None,
            running_mean=None if around is None else around.running_mean,
            prevailing_mean=None if around is None else around.prevailing_mean,
            **({} if around is None else {"pressure": around.pressure}),
            air_speed=self.air_speed,
            metabolic_rate=self.metabolic_rate,
            clothing=self.clothing,
        )

    def _humidity(
        self, air: Floats, around: Surroundings | None, simulated: npt.ArrayLike | None
    ) -> Floats | float:
        if isinstance(self.humidity, float):
            return self.humidity
        if self.humidity == "outdoor":
            if around is None or around.humidity_ratio is None:
                raise InputError(
                    "comfort: humidity: found 'outdoor', and "
                    f"{'no climate' if around is None else 'a climate without dew point'}; expected weather "
                    "with a dew point, or a relative humidity in percent"
                )
            # Air that would be supersaturated indoors has left water on surfaces: it is saturated.
            return np.minimum(relative_humidity(air, around.humidity_ratio, around.pressure), 100.0)
        if simulated is None:
            raise InputError(
                f"comfort: humidity: found none; expected {_CHOICES}, because {self.index_used.title} needs "
                "it. Record the output ZONE.relative_humidity of a building with moisture, or state "
                "humidity: 60 (percent) or humidity: outdoor (the room has the humidity ratio of the outdoor "
                "air)"
            )
        return np.asarray(simulated, dtype=np.float64)

    def evaluate(
        self,
        air: npt.ArrayLike,
        radiant: npt.ArrayLike,
        around: Surroundings | None = None,
        humidity: npt.ArrayLike | None = None,
    ) -> Evaluation:
        """Values of the index over time with the limits of comfort; arguments as those of `conditions`.

        Parameters
        ----------
        air, radiant : array_like, shape (..., times)
            Temperature of the air and mean radiant temperature. [degC]
        around : Surroundings, optional
            The outdoors at these times.
        humidity : array_like, shape (..., times), optional
            Simulated relative humidity. [%]

        Returns
        -------
        Evaluation
            Values and limits.

        Examples
        --------
        >>> settings = ComfortSettings(index="operative", band=[20, 26])
        >>> settings.evaluate([25.0, 28.0], [25.0, 30.0]).values
        array([25., 29.])
        """
        return self.index_used.evaluate(self.conditions(air, radiant, around, humidity), self.limits)

    def discomfort(
        self,
        air: npt.ArrayLike,
        radiant: npt.ArrayLike,
        hours: npt.ArrayLike,
        around: Surroundings | None = None,
        humidity: npt.ArrayLike | None = None,
    ) -> Discomfort:
        """Hours and degree-hours of discomfort, for one run or for many at once.

        Parameters
        ----------
        air, radiant : array_like, shape (..., times)
            Temperature of the air and mean radiant temperature, such as members x times. [degC]
        hours : array_like, shape (times,)
            Time that each record stands for, from `occupied`. [h]
        around : Surroundings, optional
            The outdoors at these times, from `Surroundings.of`.
        humidity : array_like, shape (..., times), optional
            Simulated relative humidity. [%]

        Returns
        -------
        Discomfort
            Arrays of the leading shape, such as one number for each member.

        Examples
        --------
        >>> settings = ComfortSettings(index="operative", band=[20, 26])
        >>> air = [[25.0, 27.0, 28.0], [25.0, 25.0, 25.0]]
        >>> settings.discomfort(air, air, hours=[0.5, 1.0, 0.5]).degree_hours
        array([2., 0.])
        """
        return discomfort(self.evaluate(air, radiant, around, humidity), hours)


def _between(clock: Floats, start: str, end: str) -> npt.NDArray[np.bool_]:
    """Where a clock time [min] is from start to end, over midnight where the end is earlier."""
    first, last = (60.0 * int(text[:2]) + int(text[3:]) for text in (start, end))
    if first < last:
        return np.asarray((clock >= first) & (clock < last))
    return np.asarray((clock >= first) | (clock < last))
