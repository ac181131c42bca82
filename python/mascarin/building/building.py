"""The building: the root of a description."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from pydantic import Field, ValidationError, model_validator

from mascarin.building.derived import settle_surfaces, settle_windows, settle_zones
from mascarin.building.glazing import Glazing
from mascarin.building.leaves import steps
from mascarin.building.material import Material
from mascarin.building.names import Name, known_names
from mascarin.building.number import Interval, Number
from mascarin.building.parameters import Parameter, lookup, parameters, resolve
from mascarin.building.part import Part, insist, is_number
from mascarin.building.rules import faults
from mascarin.building.schedule import Schedule
from mascarin.building.site import Site
from mascarin.building.surface import Construction, Sensor, Surface
from mascarin.building.window import Shade, Window
from mascarin.building.zone import AirPath, Opening, Zone

if TYPE_CHECKING:
    from pydantic import ModelWrapValidatorHandler

    from mascarin.building.engine_input import EngineDescription
    from mascarin.building.outputs import Output


class Building(Part):
    """A building, its site, and everything it is made of."""

    name: str = Field("building", description="What the results are headed with")
    site: Site = Field(description="Where it stands")
    materials: dict[Name, Material] = Field(default_factory=dict, description="Materials by name")
    constructions: dict[Name, Construction] = Field(
        default_factory=dict, description="Layered constructions by name"
    )
    schedules: dict[Name, Schedule] = Field(default_factory=dict, description="Schedules by name")
    zones: dict[Name, Zone] = Field(default_factory=dict, description="Air zones by name")
    air_paths: dict[Name, AirPath] = Field(
        default_factory=dict, description="Air exchanged between zones, by name"
    )
    openings: dict[Name, Opening] = Field(
        default_factory=dict, description="Openings between zones and outdoors, by name"
    )
    surfaces: dict[Name, Surface] = Field(
        default_factory=dict, description="Walls, roofs, floors, doors by name"
    )
    glazings: dict[Name, Glazing] = Field(default_factory=dict, description="Glazings by name")
    windows: dict[Name, Window] = Field(default_factory=dict, description="Windows in the surfaces by name")
    shades: dict[Name, Shade] = Field(
        default_factory=dict, description="Overhangs, fins and other opaque screens outdoors by name"
    )
    sensors: dict[Name, Sensor] = Field(default_factory=dict, description="Thermometers inside walls by name")

    @model_validator(mode="wrap")
    @classmethod
    def _whole(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Let parts refer to each other, then check what holds between them."""
        with known_names(data):
            building = handler(data)
        insist(*faults(building))
        building._settle(surfaces=settle_surfaces(building.surfaces))
        building._settle(windows=settle_windows(building.windows, building.surfaces))
        building._settle(zones=settle_zones(building.zones, building.surfaces))
        return building

    @cached_property
    def _parameters(self) -> dict[str, Parameter]:
        return {parameter.path: parameter for parameter in parameters(self)}

    def parameters(self) -> list[Parameter]:
        """All numeric leaves, in the order of the description."""
        return list(self._parameters.values())

    def parameter(self, path: str) -> Parameter:
        """One numeric leaf, by its path or one of the short ways to write it.

        Raises
        ------
        InputError
            If there is no such leaf; the text names the nearest ones.
        """
        return self._parameters[resolve(self, path, self._parameters)]

    def replace(self, values: Mapping[str, Any]) -> Building:
        """Give the same building with other values.

        Parameters
        ----------
        values : mapping of str to float
            New values by path; a number keeps its range. A whole part may be replaced as well: its path and
            what the YAML file would hold there (``surfaces.roof.outside.convection: tarp``). None removes
            a key.

        Returns
        -------
        Building
            Checked like a description that has been read. What Mascarin had derived from the description
            stays as it was when only parameters change, and is derived anew when structure changes.

        Raises
        ------
        InputError
            If a path does not exist or a value cannot be.
        """
        from mascarin.building.reading import explained

        places = {self._place(path, value): value for path, value in values.items()}
        structural = any(self._is_structural(path) for path in places)
        plain = _plain(self, keep_settled=not structural)
        for path, value in places.items():
            _put(plain, path.split("."), value)
        try:
            return Building.model_validate(plain)
        except ValidationError as error:
            raise explained(error, plain, self.name) from None

    def _place(self, path: str, value: Any) -> str:
        """Find what a path means: a number, or a whole part, written so far or not."""
        number = lookup(self, path, self._parameters)
        if number is not None and (number == path or is_number(value)):
            return number
        *above, key = path.split(".")
        holder = _get(self, above)
        fields = type(holder).model_fields if isinstance(holder, Part) else holder
        if isinstance(fields, Mapping) and key in fields:
            return path
        return self.parameter(path).path

    def _is_structural(self, path: str) -> bool:
        parameter = self._parameters.get(path)
        return parameter is None or parameter.structural

    def outputs(self) -> list[Output]:
        """All results that a run of this building can give."""
        from mascarin.building.outputs import outputs

        return outputs(self)

    def output(self, name: str) -> Output:
        """One result by its name or alias.

        Raises
        ------
        InputError
            If there is no such result; the text names the nearest ones.
        """
        from mascarin.building.outputs import find

        return find(self, name)

    def sources(self) -> list[str]:
        """Where the numbers that act in this building and the methods of a run come from, once each."""
        from mascarin.building.references import sources

        return sources(self)

    def to_engine(
        self, step_seconds: float = 900.0, ranges: Mapping[str, Interval] | None = None
    ) -> EngineDescription:
        """Describe the building to the engine.

        Parameters
        ----------
        step_seconds : float
            Time step for which the mesh is chosen. [s]
        ranges : mapping of str to (low, high), optional
            Ranges of the parameters that will vary; the mesh holds at their worst ends. [unit of each]

        Raises
        ------
        InputError
            If a range names no parameter, or the vertices of a zone do not close.
        """
        from mascarin.building.engine_input import describe

        return describe(self, step_seconds, ranges or {})


def _plain(part: Any, *, keep_settled: bool) -> Any:
    """Write a part as the mapping that reads as this part; numbers keep their notes."""
    if isinstance(part, Number):
        return part if keep_settled or not part.settled else None
    if isinstance(part, tuple):
        return [_plain(piece, keep_settled=keep_settled) for piece in part]
    if isinstance(part, Part | Mapping):
        pieces = steps(part) if isinstance(part, Part) else part.items()
        plain = {key: _plain(piece, keep_settled=keep_settled) for key, piece in pieces}
        return {key: value for key, value in plain.items() if value is not None}
    return part


def _index(pieces: Any, step: str) -> Any:
    """Key of a step in a mapping or list; layers of a list go by name."""
    if not isinstance(pieces, list | tuple):
        return step if step in pieces else None
    for index, piece in enumerate(pieces):
        name = piece.get("name") if isinstance(piece, Mapping) else getattr(piece, "name", None)
        if (name or str(index)) == step:
            return index
    return None


def _get(part: Any, path: list[str]) -> Any:
    for step in path:
        part = next((piece for key, piece in steps(part) if key == step), None)
    return part


def _put(plain: Any, path: list[str], value: Any) -> None:
    for step in path[:-1]:
        plain = plain[_index(plain, step)]
    key = _index(plain, path[-1])
    key = path[-1] if key is None else key
    before = plain[key] if not isinstance(plain, Mapping) or key in plain else None
    if value is None and isinstance(plain, dict):
        plain.pop(key, None)
        return
    if isinstance(before, Number) and isinstance(value, int | float) and not isinstance(value, Number | bool):
        value = Number(value, range=before.range)
    plain[key] = value
