"""The fabric: layers, constructions, surfaces and what their two sides face, sensors in walls."""

from __future__ import annotations

from collections import Counter
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, model_validator
from pydantic_core import InitErrorDetails

from mascarin.building import quantities as q
from mascarin.building.convection import Convection, Doe2, Mowitt, Tarp
from mascarin.building.names import ConstructionName, MaterialName, Name, SurfaceName, ZoneName
from mascarin.building.number import Number, Remark, problem
from mascarin.building.part import Part, Shorthand, fault, insist, refuse

FACINGS = ("outdoors", "zone", "ground", "measured", "adiabatic")


class Layer(Part):
    """One layer of a construction."""

    name: Name = Field(
        "", description="Name within the construction; none: the material's", validate_default=False
    )
    material: MaterialName = Field(description="Name of a material")
    thickness: q.Thickness | None = Field(None, description="Thickness; none for a bare resistance")
    nodes: q.NodeCount | None = Field(None, description="Number of finite volumes; none: chosen by Mascarin")

    @model_validator(mode="after")
    def _named(self) -> Layer:
        if self.name in ("outside", "inside"):
            raise problem(f"the name '{self.name}'", "a name that no face has", "Results are called by it.")
        if not self.name:
            self._fill(name=self.material)
        return self

    def written(self, *, keep_derived: bool = False) -> dict[str, Any]:
        """What was given, and the name, so that results keep it when another material is put in."""
        return {"name": self.name} | super().written(keep_derived=keep_derived)


class Construction(Part):
    """Layers from outside to inside."""

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
                    "a name of its own for each layer",
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
    """No exchange of its own: the film is a combined coefficient."""

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

    ``temperature`` may be written for ``mean`` where it is the same all year.
    """

    model_config = ConfigDict(json_schema_extra=_or_temperature)

    mean: q.GroundTemperature
    amplitude: q.GroundAmplitude = Number(0.0, source=Remark("not written: the same all year"))
    coldest_day: q.ColdestDay = Number(15.0, source=Remark("mid-January, for want of better"), assumed=True)

    @model_validator(mode="before")
    @classmethod
    def _constant(cls, raw: Any) -> Any:
        """Read ``{temperature: 22}`` as a constant mean."""
        if isinstance(raw, dict) and "temperature" in raw and "mean" not in raw:
            return {("mean" if key == "temperature" else key): value for key, value in raw.items()}
        return raw


class Exposure(Part):
    """What of the weather reaches a side, beside the temperature of the air."""

    sun: bool = Field(True, description="Sun, from sky and ground alike")
    wind: bool = Field(True, description="Wind on the film")
    sky: bool = Field(
        True, description="Long-wave exchange with the sky; without it the partner is at air temperature"
    )


class Side(Part):
    """One face of a surface: what it faces and how it exchanges heat with that."""

    outdoors: Literal[True] | None = Field(None, description="Faces the weather: write true")
    zone: ZoneName | None = Field(None, description="Faces the air of this zone")
    ground: Ground | None = Field(None, description="Touches ground of this temperature")
    measured: str | None = Field(
        None, description="Faces, or without convection is held at, this measured column"
    )
    adiabatic: Literal[True] | None = Field(None, description="Nothing flows: write true")

    convection: Convection | None = Field(None, description="Film coefficient: a number, or a correlation")
    emissivity: q.Emissivity | None = None
    absorptance: q.Absorptance | None = None
    area_factor: q.AreaFactor | None = None
    sky_view: q.SkyView | None = None
    height: q.Height | None = None
    longwave: OutdoorLongwave | None = Field(
        None, description="Exchange with sky, air and ground; none: exact"
    )
    irradiance: str | None = Field(None, description="Measured column of the irradiance on this plane [W/m2]")
    exposure: Exposure | None = Field(
        None, description="What of the weather reaches a side facing outdoors; none: all of it"
    )

    @property
    def faces(self) -> str:
        """Which of the five the side faces."""
        return next(name for name in FACINGS if getattr(self, name) is not None)

    @property
    def exposed(self) -> Exposure:
        """What of the weather reaches it: of nothing but outdoors, nothing."""
        if not self.outdoors:
            return Exposure(sun=False, wind=False, sky=False)
        return self.exposure or Exposure()

    @property
    def sunlit(self) -> bool:
        """Whether it takes its irradiance from the climate."""
        return self.exposed.sun and self.irradiance is None

    @model_validator(mode="after")
    def _sound(self) -> Side:
        given = [name for name in FACINGS if getattr(self, name) is not None]
        if len(given) != 1:
            found = " and ".join(given) or "a side that faces nothing"
            raise problem(found, f"exactly one of {', '.join(FACINGS)}", "A side faces one thing only.")
        insist(*self._missing(), *self._idle())
        return self

    def _missing(self) -> list[InitErrorDetails]:
        """Find what this facing cannot do without; a zone's emissivity depends on the zone."""
        needed = []
        if self.outdoors or self.zone is not None:
            needed.append("convection")
        if self.outdoors:
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

    def _idle(self) -> list[InitErrorDetails]:
        """Find what has been written and could not act here."""
        air = self.convection is not None and self.adiabatic is None
        acts = {
            "convection": self.adiabatic is None,
            "area_factor": air,
            "emissivity": bool(self.outdoors or self.zone is not None),
            "absorptance": self.sunlit or self.zone is not None or self.irradiance is not None,
            "sky_view": self.sunlit or self.exposed.sky,
            "height": self.exposed.wind,
            "longwave": bool(self.outdoors),
            "irradiance": self.exposed.sun or (self.measured is not None and air),
        }
        return [
            fault(
                (key,),
                f"'{key}' on a side facing {self.faces}{self._sheltered(key)}",
                "only what acts on this side",
                f"Remove '{key}:': it would change nothing here.",
            )
            for key, active in acts.items()
            if getattr(self, key) is not None and not active
        ] + self._unexposed()

    def _sheltered(self, key: str) -> str:
        """Say what keeps the weather off, where that is why a key does not act."""
        away = {"absorptance": "sun", "sky_view": "sun or sky", "height": "wind", "irradiance": "sun"}
        return f" without {away[key]}" if self.outdoors and key in away else ""

    def _unexposed(self) -> list[InitErrorDetails]:
        if self.outdoors or self.exposure is None:
            return []
        return [
            fault(
                ("exposure",),
                f"'exposure' on a side facing {self.faces}",
                "only what acts on this side",
                "Remove 'exposure:': no weather reaches this side.",
            )
        ]


class Surface(Part):
    """A plane wall, roof, floor or door between two sides."""

    construction: ConstructionName = Field(description="Name of a construction")
    vertices: tuple[tuple[q.Coordinate, q.Coordinate, q.Coordinate], ...] | None = Field(
        None, description="Corners [x, y, z], counter-clockwise seen from outside"
    )
    area: q.Area | None = None
    tilt: q.Tilt | None = None
    azimuth: q.Azimuth | None = None
    outside: Side = Field(description="The outer face")
    inside: Side = Field(description="The inner face")
    internal_mass: bool = Field(False, description="Whether both sides face the same zone on purpose")

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
        """Tell whether sun, wind or the view between the faces of a zone depend on the azimuth."""
        windy = isinstance(self.outside.convection, Tarp | Mowitt | Doe2) and self.outside.exposed.wind
        sun = windy or any(side.sunlit for side in self.sides)
        seen = any(side.zone is not None for side in self.sides)
        return (sun or seen) and self.tilt is not None and 0.0 < self.tilt < 180.0

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
            return [
                fault(
                    ("internal_mass",),
                    "true, but the sides face different things",
                    "both sides facing one zone",
                    "Remove 'internal_mass:'.",
                )
            ]
        return []


class Sensor(Part):
    """A thermometer in a wall."""

    surface: SurfaceName = Field(description="Name of a surface")
    depth: q.Depth
