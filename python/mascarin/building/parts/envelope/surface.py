"""Layers, constructions, surfaces with their two sides, and sensors in walls."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any, ClassVar, Literal

from pydantic import ConfigDict, Field, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.base.dimensions import System
from mascarin.building.base.names import (
    ConstructionName,
    MaterialName,
    Name,
    ScheduleName,
    SoilBlockName,
    SurfaceName,
    ZoneName,
)
from mascarin.building.base.number import Number, Remark, problem
from mascarin.building.base.part import Part, Shorthand, fault, insist, refuse
from mascarin.building.base.time_series import Columns
from mascarin.building.parts.envelope.convection import CONVECTION, Convection, by_wind_direction
from mascarin.building.parts.envelope.imposed import GROUND, ImposedTemperature
from mascarin.building.parts.envelope.measured_values import Driven

FACINGS = ("outdoors", "zone", "ground", "soil", "imposed", "measured", "scheduled", "heat_flux", "adiabatic")

#: Quantities of the ground, as the engine has them.
_MEAN, _AMPLITUDE, _COLDEST_DAY = (number.quantity for number in GROUND.numbers)


class Layer(Part):
    """One layer of a construction.

    Examples
    --------
    >>> Layer(material="concrete", thickness=0.2).name
    'concrete'
    """

    name: Name = Field(
        "", description="Name within the construction; none: the material's", validate_default=False
    )
    material: MaterialName = Field(description="Name of a material")
    thickness: q.Thickness | None = Field(None, description="Thickness; none for a resistance")
    nodes: q.NodeCount | None = Field(None, description="Number of finite volumes; none: chosen by Mascarin")

    @model_validator(mode="after")
    def _named(self) -> Layer:
        if self.name in ("outside", "inside"):
            raise problem(f"the name '{self.name}'", "another name", "Results have the name of the layer.")
        if not self.name:
            self._fill(name=self.material)
        return self

    def written(self, *, keep_derived: bool = False) -> dict[str, Any]:
        """What was given, and the name, so that results keep it when another material is put in."""
        return {"name": self.name} | super().written(keep_derived=keep_derived)


class Construction(Part):
    """Layers from outside to inside.

    Examples
    --------
    >>> wall = Construction(
    ...     layers=[Layer(material="wool", thickness=0.1), Layer(material="board", thickness=0.012)]
    ... )
    >>> [layer.name for layer in wall.layers]
    ['wool', 'board']
    """

    layers: tuple[Layer, ...] = Field(description="Layers from outside to inside")

    @model_validator(mode="after")
    def _sound(self) -> Construction:
        if not self.layers:
            refuse(fault(("layers",), "no layers", "at least one layer", "List them from outside to inside."))
        twice = [name for name, count in Counter(layer.name for layer in self.layers).items() if count > 1]
        insist(
            *(
                fault(
                    ("layers",),
                    f"two layers called '{name}'",
                    "a different name for each layer",
                    "Add 'name:' to one of them, for instance 'outer' and 'inner'.",
                )
                for name in twice
            )
        )
        return self


class Exact(Part):
    """Exchange with the fourth power of temperature."""

    kind: Literal["exact"] = "exact"


class Linearised(Part):
    """Exchange linearised about a reference temperature."""

    kind: Literal["linearised"] = "linearised"
    reference: q.ReferenceTemperature = Number(20.0, source=Remark("usual room temperature"), assumed=True)


class NoLongwave(Part):
    """No separate exchange: the surface heat transfer coefficient includes radiation."""

    kind: Literal["none"] = "none"


OutdoorLongwave = Annotated[
    Exact | Linearised | NoLongwave, Field(discriminator="kind"), Shorthand(word="kind")
]


def _or_temperature(schema: dict[str, Any]) -> None:
    """Allow the short form of :class:`Ground` in its JSON Schema."""
    mean = schema["properties"]["mean"]
    schema["properties"]["temperature"] = mean
    schema["oneOf"] = [{"required": ["mean"]}, {"required": ["temperature"]}]
    del schema["required"]


class Ground(Part):
    """Temperature of the ground: ``mean - amplitude cos(2 pi (day - coldest_day)/365)``.

    ``temperature`` may replace ``mean`` where it is the same all year. Without a ``coldest_day`` a building
    takes 15 January north of the equator, and 15 July south of it.

    Examples
    --------
    >>> Ground(mean=12, amplitude=4, coldest_day=40)
    Ground(mean=12 degC, amplitude=4 K, coldest_day=40 d)
    """

    model_config = ConfigDict(json_schema_extra=_or_temperature)
    advice: ClassVar[Mapping[str, str]] = {
        "measured": "Write 'measured: COLUMN' in the side, in place of 'ground:'."
    }

    mean: Annotated[Number, _MEAN]
    amplitude: Annotated[Number, _AMPLITUDE] = Number(0.0, source=Remark("not given: the same all year"))
    coldest_day: Annotated[Number, _COLDEST_DAY] | None = None

    @model_validator(mode="before")
    @classmethod
    def _constant(cls, raw: Any) -> Any:
        """Read ``{temperature: 22}`` as a constant mean."""
        if isinstance(raw, int | float) and not isinstance(raw, bool):
            raise problem(
                f"the number {raw:g}",
                "a mapping with the temperature of the ground",
                f"Write 'ground: {{temperature: {raw:g}}}', or 'ground: {{mean: {raw:g}, amplitude: 4}}' "
                "for one "
                "that changes over the year.",
            )
        if isinstance(raw, dict) and "temperature" in raw and "mean" not in raw:
            return {("mean" if key == "temperature" else key): value for key, value in raw.items()}
        return raw


class HeatFlux(Driven):
    """Heat that is given to a surface whatever its temperature: by a foil or a guarded plate.

    Examples
    --------
    >>> HeatFlux(flux=120)
    HeatFlux(flux=120 W/m2)
    >>> HeatFlux(column="q_plate", unit="kW/m2").course.name
    'q_plate [kW/m2]'
    """

    NUMBER: ClassVar = "flux"
    KIND: ClassVar = "heat_flux"

    flux: q.HeatFlux | None = None
    unit: Literal["W/m2", "kW/m2"] | None = Field(None, description="Unit of the column; none: W/m2")
    schedule: ScheduleName | None = Field(
        None, description="Schedule of the fraction of the flux; none: always 1"
    )


#: Description of a key beside `irradiance`.
BEHIND_OBSTACLES = (
    "Whether the irradiance was measured behind all that stands in front, and is used as it is; none: no"
)


class Exposure(Part):
    """Which parts of the weather act on a side, beside the air temperature.

    Examples
    --------
    >>> Exposure(sun=False)
    Exposure(sun=False, wind=True, sky=True)
    """

    sun: bool = Field(True, description="Solar radiation, from sky and ground")
    wind: bool = Field(True, description="Wind in the heat transfer coefficient")
    sky: bool = Field(
        True, description="Long-wave exchange with the sky; without it, with surroundings at air temperature"
    )


@cache
def _exposure(*, exposed: bool) -> Exposure:
    """To everything, or to nothing."""
    return Exposure(sun=exposed, wind=exposed, sky=exposed)


class Side(Part):
    """One side of a surface: what it faces, and how it exchanges heat with that.

    Examples
    --------
    >>> outdoors = Side(outdoors=True, convection="tarp", emissivity=0.9, absorptance=0.6)
    >>> indoors = Side(zone="room", convection=3, emissivity=0.9)
    >>> outdoors.faces, indoors.faces
    ('outdoors', 'zone')
    """

    advice: ClassVar[Mapping[str, str]] = {
        "temperature": "For a surrounding of a given temperature write 'ground: {temperature: 24}', for a "
        "measured "
        "one 'measured: COLUMN', for a room that is held at it a zone with 'heating' and 'cooling'.",
        "emissivity": "For no long-wave exchange leave it out and write 'longwave: none' in the side "
        "outdoors, or in the zone that "
        "it faces; bright metal has an emissivity of about 0.05.",
        "convection": "Write 'convection: 8' for a coefficient [W/(m2 K)], or 'convection: {kind: tarp}' "
        "for a "
        "correlation.",
    }

    outdoors: Literal[True] | None = Field(None, description="Faces the weather: write true")
    zone: ZoneName | None = Field(None, description="Faces the air of this zone")
    ground: Ground | None = Field(None, description="Touches ground of this temperature")
    soil: SoilBlockName | None = Field(
        None, description="Touches this block of soil, which lies in two or three dimensions around it"
    )
    imposed: ImposedTemperature | None = Field(
        None,
        description="Touches something whose temperature, heat or coefficient follows a law, such as soil at "
        "a depth, or a heating mat",
    )
    measured: Columns | None = Field(
        None,
        description="Faces air of this measured column, or of the mean of several; without convection, "
        "has its temperature",
    )
    scheduled: ScheduleName | None = Field(
        None,
        description="Faces air of the temperature of this schedule; without convection, has its temperature",
    )
    heat_flux: Annotated[HeatFlux, Shorthand(number="flux")] | None = Field(
        None,
        description="Heat given to the surface from outside: a number [W/m2], or a part with a schedule or "
        "column",
    )
    adiabatic: Literal[True] | None = Field(None, description="No heat flow: write true")

    convection: Convection | None = Field(None, description=CONVECTION)
    emissivity: q.Emissivity | None = None
    absorptance: q.Absorptance | None = None
    area_factor: q.AreaFactor | None = None
    sky_view: q.SkyView | None = None
    ground_view: q.GroundView | None = None
    height: q.Height | None = None
    longwave: OutdoorLongwave | None = Field(
        None, description="Exchange with sky, air and ground; none: exact"
    )
    irradiance: str | None = Field(
        None,
        description="Measured column of the irradiance on this plane [W/m2], free of obstacles: what stands "
        "in front of the surface takes its part of it",
    )
    behind_obstacles: bool | None = Field(None, description=BEHIND_OBSTACLES)
    exposure: Exposure | None = Field(
        None, description="Parts of the weather that act on a side facing outdoors; none: all"
    )

    @property
    def faces(self) -> str:
        """Which kind of surroundings the side faces."""
        return next(name for name in FACINGS if getattr(self, name) is not None)

    @property
    def closed(self) -> bool:
        """Whether no temperature beyond it drives heat through it: adiabatic, or with a heat flux."""
        return self.adiabatic is not None or self.heat_flux is not None

    @property
    def measured_columns(self) -> tuple[str, ...]:
        """Measured columns of the temperature that it faces."""
        if self.measured is None:
            return ()
        return (self.measured,) if isinstance(self.measured, str) else self.measured

    def in_words(self) -> str:
        """What the side faces: the zone, or measured columns or a schedule by name."""
        if self.measured is not None:
            return f"measured {' and '.join(self.measured_columns)}"
        if self.scheduled is not None:
            return f"schedule {self.scheduled}"
        if self.imposed is not None:
            return self.imposed.row.title
        if self.soil is not None:
            return f"soil {self.soil}"
        return self.zone or self.faces

    def in_short(self) -> str:
        """What the side faces."""
        return f"zone {self.zone}" if self.zone else self.faces

    @property
    def exposed(self) -> Exposure:
        """Parts of the weather that act on it; none unless it faces outdoors."""
        if not self.outdoors:
            return _exposure(exposed=False)
        return self.exposure or _exposure(exposed=True)

    @property
    def sunlit(self) -> bool:
        """Whether its irradiance comes from the climate."""
        return self.exposed.sun and self.irradiance is None

    @model_validator(mode="after")
    def _sound(self) -> Side:
        stated = [name for name in FACINGS if getattr(self, name) is not None]
        if len(stated) != 1:
            actual = " and ".join(stated) or "a side that faces nothing"
            remedy = "A side faces one thing only."
            if self.heat_flux is not None:
                remedy = "A surface has a heat flux or a temperature beside it, not both: keep one of them."
            raise problem(actual, f"exactly one of {', '.join(FACINGS)}", remedy)
        insist(*self._missing(), *self._inactive())
        return self

    def _missing(self) -> list[InitErrorDetails]:
        """What is needed here and not given; whether emissivity is needed depends on the zone."""
        needed = []
        if self.outdoors or self.zone is not None:
            needed.append("convection")
        if self.outdoors and not isinstance(self.longwave, NoLongwave):
            needed.append("emissivity")
        if self.sunlit or self.irradiance is not None:
            needed.append("absorptance")
        return [
            fault(
                (key,),
                "nothing",
                f"{self._meaning(key)}, needed on a side facing {self.faces}",
                f"Add '{key}:'.",
            )
            for key in needed
            if getattr(self, key) is None
        ]

    def _inactive(self) -> list[InitErrorDetails]:
        """What is given and has no effect here."""
        touches = self.adiabatic is not None or self.heat_flux is not None or self.soil is not None
        air = self.convection is not None and not touches
        acts = {
            "convection": not touches,
            "area_factor": air,
            "emissivity": bool(self.outdoors or self.zone is not None),
            "absorptance": self.sunlit or self.zone is not None or self.irradiance is not None,
            "sky_view": self.sunlit or self.exposed.sky,
            "ground_view": self.sunlit,
            "height": self.exposed.wind,
            "longwave": bool(self.outdoors),
            "irradiance": self.exposed.sun or (self.measured is not None and air),
            "behind_obstacles": bool(self.outdoors) and self.irradiance is not None,
        }
        return [
            fault(
                (key,),
                f"'{key}' on a side facing {self.faces}{self._sheltered(key)}",
                "only what has an effect on this side",
                f"Remove '{key}:': it has no effect here.",
            )
            for key, active in acts.items()
            if getattr(self, key) is not None and not active
        ] + self._unexposed()

    def _sheltered(self, key: str) -> str:
        """The missing part of the weather, where a key has no effect because of it."""
        away = {"sky_view": "sun or sky", "height": "wind"}
        away |= dict.fromkeys(("absorptance", "ground_view", "irradiance"), "sun")
        return f" without {away[key]}" if self.outdoors and key in away else ""

    def _unexposed(self) -> list[InitErrorDetails]:
        if self.outdoors or self.exposure is None:
            return []
        return [
            fault(
                ("exposure",),
                f"'exposure' on a side facing {self.faces}",
                "only what has an effect on this side",
                "Remove 'exposure:': this side does not face outdoors.",
            )
        ]


class Surface(Part):
    """A plane wall, roof, floor or door with two sides.

    Examples
    --------
    >>> wall = Surface(
    ...     construction="shell",
    ...     area=12,
    ...     tilt=90,
    ...     azimuth=180,
    ...     outside=Side(outdoors=True, convection=15, emissivity=0.9, absorptance=0.6),
    ...     inside=Side(zone="room", convection=3, emissivity=0.9),
    ... )
    >>> float(wall.area)
    12.0
    """

    construction: ConstructionName = Field(description="Name of a construction")
    vertices: tuple[tuple[q.Coordinate, q.Coordinate, q.Coordinate], ...] | None = Field(
        None, description="Corners [x, y, z], counter-clockwise seen from outside"
    )
    area: q.Area | None = None
    tilt: q.Tilt | None = None
    azimuth: q.Azimuth | None = None
    outside: Side = Field(description="The outer side")
    inside: Side = Field(description="The inner side")
    dimensions: System | None = Field(
        None,
        description="Dimensions of its area: internal, overall_internal or external; none: the building's",
    )
    internal_mass: bool = Field(False, description="Whether both sides face the same zone, as for furniture")

    @property
    def sides(self) -> tuple[Side, Side]:
        """Outside, inside."""
        return (self.outside, self.inside)

    @model_validator(mode="after")
    def _sound(self) -> Surface:
        insist(*self._shape(), *self._zones())
        return self

    def _shape(self) -> list[InitErrorDetails]:
        if self.vertices is not None:
            return []
        needed = ["area", "tilt", *(["azimuth"] if self._direction_acts() else [])]
        return [
            fault((key,), "nothing", self._meaning(key), f"Add '{key}:' (or 'vertices:').")
            for key in needed
            if getattr(self, key) is None
        ]

    def _direction_acts(self) -> bool:
        """Whether solar radiation, wind or the view factors of a zone depend on the azimuth."""
        windy = by_wind_direction(self.outside.convection) and self.outside.exposed.wind
        sun = windy or any(side.sunlit for side in self.sides)
        faces_a_zone = any(side.zone is not None for side in self.sides)
        return (sun or faces_a_zone) and self.tilt is not None and 0.0 < self.tilt < 180.0

    def _zones(self) -> list[InitErrorDetails]:
        same = self.outside.zone is not None and self.outside.zone == self.inside.zone
        if same and not self.internal_mass:
            return [
                fault(
                    ("inside", "zone"),
                    f"both sides facing zone '{self.inside.zone}'",
                    "two different facings",
                    "If this is mass inside the zone, write 'internal_mass: true'.",
                )
            ]
        if self.internal_mass and not same:
            wrong = "true, but the sides face different things"
            return [
                fault(("internal_mass",), wrong, "both sides facing one zone", "Remove 'internal_mass:'.")
            ]
        return []


class WallSensor(Part):
    """A temperature sensor inside a wall.

    Examples
    --------
    >>> float(WallSensor(surface="south", depth=0.05).depth)
    0.05
    """

    surface: SurfaceName = Field(description="Name of a surface")
    depth: q.Depth
