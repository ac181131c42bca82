"""A wall between two measured temperatures, and the study that identifies it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError
from mascarin.templates.room_text import flow
from mascarin.templates.short_texts import LayerText, layers_of, name_of, quoted

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.templates.study_text import LoggerRecord

_DEPTH: Final = re.compile(r"^(\d+(?:\.\d+)?)\s*mm$")
_OUTDOORS: Final = """\
    outside:
      outdoors: true
      # Radiation and wind were not measured: the coefficient contains them.
      longwave: none
      emissivity: 0.9
      convection: {value: 20, range: [5, 40], source: "ISO 6946: 0.04 m2 K/W is 25", assumed: true}
      exposure: {sun: false, wind: false, sky: false}"""
_SUNLIT: Final = """\
    outside:
      outdoors: true
      irradiance: IRRADIANCE
      absorptance: {value: 0.5, range: [0.1, 0.9], source: colour of the facade, assumed: true}
      emissivity: {value: 0.9, range: [0.8, 0.95], source: paint and mineral surfaces, assumed: true}
      convection: {value: 15, range: [4, 40], source: no wind was measured, assumed: true}"""


@dataclass(frozen=True)
class Wall:
    """A wall whose temperatures on both sides were measured.

    Attributes
    ----------
    layers : str
        From inside to outside, such as ``plasterboard + mineral wool 100mm + brick``.
    inside, outside : str
        Columns of the air temperatures.
    irradiance : str
        Column of the irradiance on the facade; empty: no sun.
    sensors : mapping of str to str
        Column -> ``inside``, ``outside`` or the depth from the inner surface, such as ``55mm``.
    latitude, longitude, altitude : float
        Of the place. [deg, deg, m]
    timezone : str
        Of the clock.

    Examples
    --------
    >>> Wall("plasterboard + mineral wool + brick", "T_in", "T_out").building().surfaces["wall"].inside.faces
    'measured'
    """

    layers: str
    inside: str
    outside: str
    irradiance: str = ""
    sensors: Mapping[str, str] | None = None
    latitude: float = 0.0
    longitude: float = 0.0
    altitude: float = 0.0
    timezone: str = "UTC"

    @property
    def _parts(self) -> list[LayerText]:
        return layers_of(self.layers, "layers of the wall")

    def outputs(self) -> dict[str, str]:
        """Column of each sensor -> output of the building.

        Raises
        ------
        InputError
            A place that is not in the wall.
        """
        outputs = {}
        for column, position in (self.sensors or {}).items():
            if position in ("inside", "outside"):
                outputs[column] = f"wall.{position}_temperature"
            else:
                self._depth(column, position)
                outputs[column] = f"{name_of(column)}.temperature"
        return outputs

    def _depth(self, column: str, position: str) -> float:
        """Depth of a sensor from the outer surface. [m]"""
        match, thickness = _DEPTH.match(position), sum(layer.thickness for layer in self._parts)
        depth = 1e-3 * float(match[1]) if match else -1.0
        if not 0.0 < depth < thickness:
            raise InputError(
                f"--sensor: found {column}={position}; expected inside, outside, or a depth from the inner "
                f"surface below the {1e3 * thickness:g} mm of the wall, such as {column}=55mm"
            )
        return thickness - depth

    def yaml(self) -> str:
        """The description, as text with comments."""
        return "\n".join(self._lines()) + "\n"

    def building(self) -> Building:
        """The building that the description is read as."""
        from mascarin.building.reading import parse

        return parse(self.yaml(), "building.yaml")

    def _lines(self) -> Iterator[str]:
        yield "# A wall between two measured air temperatures. Layers run from outside to inside."
        yield "# Numbers that are assumed are typical values with a plausible range: replace them by yours."
        yield "name: wall"
        yield "# Its boundary conditions are measured: latitude, longitude and altitude have no effect."
        yield (
            f"site: {{latitude: {self.latitude:g}, longitude: {self.longitude:g}, "
            f"altitude: {self.altitude:g}, timezone: {quoted(self.timezone)}, sky: offset}}"
        )
        yield "materials:"
        for name, material in {layer.name: layer.material for layer in self._parts}.items():
            yield f"  {name}: {flow(material)}"
        yield "constructions:"
        yield "  wall:"
        yield "    layers:"
        counts: dict[str, int] = {}
        for layer in reversed(self._parts):
            counts[layer.name] = counts.get(layer.name, 0) + 1
            own_name = {"name": f"{layer.name}_{counts[layer.name]}"} if counts[layer.name] > 1 else {}
            yield f"      - {flow({**own_name, 'material': layer.name, 'thickness': layer.thickness})}"
        yield "surfaces:"
        yield "  wall:"
        yield "    construction: wall"
        yield "    area: 1"
        yield "    tilt: 90"
        yield (_SUNLIT.replace("IRRADIANCE", quoted(self.irradiance)) if self.irradiance else _OUTDOORS)
        yield "    inside:"
        yield f"      measured: {quoted(self.inside)}"
        yield "      # Convection and radiation together."
        yield '      convection: {value: 7.7, range: [4, 12], source: "ISO 6946: 0.13 m2 K/W", assumed: true}'
        inner = {
            column: self._depth(column, position)
            for column, position in (self.sensors or {}).items()
            if position not in ("inside", "outside")
        }
        if inner:
            yield "sensors:"
            for column, depth in inner.items():
                yield f"  {name_of(column)}: {{surface: wall, depth: {depth:g}}}"

    def study(self, record: LoggerRecord) -> str:
        """The study of a logger file, as text.

        Parameters
        ----------
        record : LoggerRecord
            The file.

        Raises
        ------
        InputError
            A column that the file does not have, or no sensor.
        """
        from mascarin.templates.study_text import study_lines

        for option, column in (("--inside", self.inside), ("--outside", self.outside)):
            record.require(column, option)
        if self.irradiance:
            record.require(self.irradiance, "--irradiance")
        outputs = self.outputs()
        if not outputs:
            raise InputError(
                "--sensor: found none; expected at least one temperature that is compared, such as "
                "--sensor T_wall=inside"
            )
        for column in outputs:
            record.require(column, "--sensor")
        climate = iter(
            (
                "climate:",
                "  measured:",
                f"    table: {quoted(record.path.name)}",
                f"    timezone: {quoted(record.timezone)}",
                f"    columns: {{air_temperature: {quoted(self.outside)}}}",
                "    absent: [wind_speed, wind_direction, dew_point, radiation]",
            )
        )
        return "\n".join(study_lines(record, "My wall", climate, outputs, self._parameters())) + "\n"

    def _parameters(self) -> Iterator[str]:
        """Numbers that the temperatures tell most about: conductivities and both films."""
        for name, material in {layer.name: layer.material for layer in self._parts}.items():
            if "product" not in material:
                yield f"materials.{name}.conductivity"
        yield "surfaces.wall.inside.convection.coefficient"
        yield "surfaces.wall.outside.convection.coefficient"
        if self.irradiance:
            yield "surfaces.wall.outside.absorptance"
