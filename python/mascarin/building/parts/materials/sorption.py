"""Moisture content of materials by relative humidity: published values, tables, straight lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from mascarin.building import quantities as q
from mascarin.building.base.law_classes import PublishedLaw, classes_of, union_of
from mascarin.building.base.law_table import SORPTION
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand, derived_number

DATASET: Final = (
    "EnergyPlus 25.2, data set MoistureMaterials.idf (U.S. Department of Energy): sorption "
    "a phi^b + c phi^d, vapour resistance factor"
)

#: Relative humidities of the straight lines that stand for a published curve [-].
_POINTS: Final = (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0)

Kind = Literal["gypsum", "concrete", "brick", "wood", "plywood", "plaster", "carpet"]


@dataclass(frozen=True)
class _Curve:
    """``a phi^b + c phi^d`` [kg/kg], and the vapour resistance factor [-]."""

    a: float
    b: float
    c: float
    d: float
    resistance: float

    def content(self, humidity: float) -> float:
        """Moisture content [kg/kg]."""
        return float(self.a * humidity**self.b + self.c * humidity**self.d)


#: Plaster of gypsum sorbs as gypsum board does, and is as open to vapour.
_PUBLISHED: Final[Mapping[str, _Curve]] = {
    "gypsum": _Curve(0.0068, 0.939, 0.0202, 12.2, 6.0),
    "plaster": _Curve(0.0068, 0.939, 0.0202, 12.2, 6.0),
    "concrete": _Curve(0.045, 0.352, 0.0859, 14.8, 6.6),
    "brick": _Curve(0.01385, 9.638, 0.02462, 0.6763, 19.5897),
    "wood": _Curve(0.204, 2.32, 0.43, 72.0, 150.0),
    "plywood": _Curve(0.218, 1.44, 0.535, 28.16, 400.0),
    "carpet": _Curve(0.136, 0.48, 0.207, 9.5, 4.0),
}


class Published(Part):
    """The published sorption of a kind of material; its density is that of the material.

    Kinds are gypsum, plaster (gypsum plaster), concrete, brick, wood, plywood and carpet.

    Examples
    --------
    >>> board = Published(like="gypsum")
    >>> humidities, contents = board.table(800.0)
    >>> humidities[6], round(contents[6], 2)
    (0.5, 2.84)
    """

    has_usual_kind: ClassVar[bool] = True
    kind: Literal["published"] = "published"
    like: Kind = Field(description="Kind of material")
    factor: q.ContentFactor = Number(1.0, source=DATASET, assumed=True)
    vapour_resistance: q.VapourResistance | None = None
    depth: q.PenetrationDepth | None = None
    deep_depth: q.PenetrationDepth | None = None

    @model_validator(mode="after")
    def _resisting(self) -> Published:
        if self.vapour_resistance is None:
            value = _PUBLISHED[self.like].resistance
            number = derived_number(Published, "vapour_resistance", value, DATASET, assumed=True)
            self._fill(vapour_resistance=number)
        return self

    def table(self, density: float) -> tuple[list[float], list[float]]:
        """Relative humidities [-] and contents [kg/m3] of a material of a density [kg/m3]."""
        curve = _PUBLISHED[self.like]
        return list(_POINTS), [density * curve.content(humidity) for humidity in _POINTS]


class SorptionLaw(PublishedLaw):
    """A published law of the moisture content: a class for each row of the engine's table.

    Examples
    --------
    >>> from mascarin.building import LinearSorption, SorptionLaw
    >>> issubclass(LinearSorption, SorptionLaw)
    True
    """

    if TYPE_CHECKING:

        def __init__(self, **numbers: Any) -> None: ...


#: Classes of the laws by their names: `LinearSorption` and so on.
SORPTIONS: Final = classes_of(
    SORPTION.values(),
    SorptionLaw,
    "{}Sorption",
    common={
        "vapour_resistance": (q.VapourResistance, ...),
        "depth": (q.PenetrationDepth | None, None),
        "deep_depth": (q.PenetrationDepth | None, None),
    },
    examples={"vapour_resistance": 8.0},
)
SORPTIONS["LinearSorption"].has_usual_kind = True
globals().update(SORPTIONS)


class TabulatedSorption(Part):
    """A measured isotherm: straight lines between points, the first and the last without end.

    Examples
    --------
    >>> wood = TabulatedSorption(humidities=[0, 0.5, 0.9], contents=[0, 40, 85], vapour_resistance=50)
    >>> wood.table(0.0)[1][1]
    40.0
    """

    has_usual_kind: ClassVar[bool] = True
    kind: Literal["table"] = "table"
    humidities: tuple[q.TableHumidity, ...] = Field(description="Relative humidities, rising [-]")
    contents: tuple[q.TableContent, ...] = Field(description="Moisture contents, rising [kg/m3]")
    factor: q.ContentFactor = Number(1.0, source=Remark("as given"), assumed=True)
    vapour_resistance: q.VapourResistance
    depth: q.PenetrationDepth | None = None
    deep_depth: q.PenetrationDepth | None = None

    @model_validator(mode="after")
    def _rises(self) -> TabulatedSorption:
        if len(self.humidities) != len(self.contents) or len(self.humidities) < 2:
            raise problem(
                f"{len(self.humidities)} humidities and {len(self.contents)} contents",
                "as many of both, at least 2",
                "Give one content for each humidity.",
            )
        for key in ("humidities", "contents"):
            values = getattr(self, key)
            for before, after in pairwise(values):
                if after <= before:
                    raise problem(
                        f"{key} with {float(after):g} after {float(before):g}",
                        "numbers that rise from one point to the next",
                        "Sort the points by humidity; leave out points of equal content.",
                    )
        return self

    def table(self, density: float) -> tuple[list[float], list[float]]:
        """Relative humidities [-] and contents [kg/m3]; the density does not matter."""
        del density
        return [float(number) for number in self.humidities], [float(number) for number in self.contents]


def _kind(raw: Any) -> str:
    """The kind that is meant: by its word, or by what is given."""
    if isinstance(raw, str):
        return "published"
    if not isinstance(raw, Mapping):
        return str(getattr(raw, "kind", "linear"))
    meant = "published" if "like" in raw else "table" if "humidities" in raw else "linear"
    return str(raw.get("kind", meant))


if TYPE_CHECKING:
    Sorption = Published | SorptionLaw | TabulatedSorption
else:
    Sorption = Annotated[
        union_of(
            [
                Annotated[Published, Shorthand(word="like"), Tag("published")],
                *(Annotated[law, Tag(law.row.kind)] for law in SORPTIONS.values()),
                Annotated[TabulatedSorption, Tag("table")],
            ]
        ),
        Discriminator(_kind),
    ]
