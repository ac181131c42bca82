"""The building: a checked description with its parameters, outputs and checks."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from pydantic import ValidationError, model_validator

from mascarin._io import atomic, display, identity
from mascarin._io.arguments import mapping_of
from mascarin._io.durations import seconds_of
from mascarin._io.listing import Listing
from mascarin.building.base.error_texts import explained
from mascarin.building.base.leaves import leaves
from mascarin.building.base.names import known_names
from mascarin.building.base.number import Interval, Number, is_number
from mascarin.building.base.part import Part, insist, plain_value
from mascarin.building.base.replacement import piece_at, put, replaced_at, without_parts
from mascarin.building.checks import summary
from mascarin.building.checks.consistency import faults, faults_of_values
from mascarin.building.checks.dimensions import with_converted_bridges
from mascarin.building.checks.overview import check
from mascarin.building.engine_input import EngineDescription, describe
from mascarin.building.files.defaults import require_building, with_defaults
from mascarin.building.files.yaml_document import read
from mascarin.building.files.yaml_text import text_of
from mascarin.building.outputs import output as results
from mascarin.building.outputs.output import Output
from mascarin.building.parameters.parameter import Parameter, listed, lookup, parameters, resolve
from mascarin.building.parameters.sources import sources
from mascarin.building.parameters.ties import spread, spread_ranges, with_tied
from mascarin.building.parts.defaults import DERIVED
from mascarin.building.parts.description import Description
from mascarin.building.parts.weather import unstated
from mascarin.errors import InputError

if TYPE_CHECKING:
    from pydantic import ModelWrapValidatorHandler


class Building(Description):
    """A building: its site, and everything that it is made of.

    A building is made from objects, as below, from a file (`from_yaml`) or from a mapping (`from_dict`). It
    is immutable: `replace` and `with_values` return another one. Numbers are given in the units that the
    parts name; ``{"value": 0.5, "range": [0.2, 1], "source": "blower door"}`` gives a number with its
    plausible range and its source.

    Raises
    ------
    InputError
        If the parts do not fit together. The text names each error by its path.

    Examples
    --------
    >>> import mascarin as mc
    >>> b = mc.building
    >>> outdoors = b.Side(outdoors=True, convection=15, emissivity=0.9, absorptance=0.6)
    >>> indoors = b.Side(zone="room", convection=3, emissivity=0.9)
    >>> room = mc.Building(
    ...     name="room",
    ...     site=b.Site(latitude=48, longitude=2, altitude=100, timezone="Europe/Paris"),
    ...     materials={"concrete": b.Solid(conductivity=1.75, density=2240, specific_heat=900)},
    ...     constructions={"wall": b.Construction(layers=[b.Layer(material="concrete", thickness=0.2)])},
    ...     zones={"room": b.Zone(volume=30, infiltration=0.5)},
    ...     surfaces={
    ...         "south": b.Surface(
    ...             construction="wall", area=16, tilt=90, azimuth=180, outside=outdoors, inside=indoors
    ...         ),
    ...         "rest": b.Surface(
    ...             construction="wall", area=50, tilt=90, azimuth=0,
    ...             outside=b.Side(adiabatic=True), inside=indoors,
    ...         ),
    ...     },
    ... )
    >>> room.parameter("zones.room.volume").value
    30.0
    >>> room.with_values({"zones.room.volume": 32}).parameter("zones.room.volume").value
    32.0
    >>> mc.Building.from_dict(room.to_dict()) == room
    True
    """

    @model_validator(mode="wrap")
    @classmethod
    def _assembled(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Let parts refer to each other by name, then check how they fit together."""
        if isinstance(data, Building):
            return handler(data)
        description = with_defaults(without_parts(require_building(data)))
        with known_names(description):
            building = handler(description)
        insist(*faults(building))
        for section, derive in DERIVED.items():
            building._fill(**{section: derive(building)})
        building._fill(zones=with_converted_bridges(building))
        insist(*faults_of_values(building))
        return building

    # --- from and to files and mappings ---------------------------------------------------------------------
    @classmethod
    def from_yaml(cls, path: str | Path) -> Self:
        """Read a building from a YAML file.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Building
            Checked and immutable.

        Raises
        ------
        InputError
            If the file cannot be read or its description has errors. The text names each error by file, line
            and path, with what was found, what was expected and what to do.

        Examples
        --------
        >>> from mascarin import examples
        >>> Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml").name
        'LGI cell'
        """
        return read(path, cls, "a building", blanks=False, finish=replaced_at)

    @classmethod
    def from_dict(cls, description: Mapping[str, Any]) -> Self:
        """Make a building from a mapping with the content of a YAML file.

        Parameters
        ----------
        description : mapping
            Sections of the description; parts may be mappings or objects of `mascarin.building`.

        Returns
        -------
        Building
            Checked and immutable.

        Raises
        ------
        InputError
            If the description has errors. The text names each error by its path.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> Building.from_dict(cell.to_dict()) == cell
        True
        """
        if not isinstance(description, Mapping):
            raise InputError(
                f"description: found {type(description).__name__}; expected a mapping with the sections of a "
                "building. Read files with Building.from_yaml"
            )
        return cls._read(without_parts(dict(description)), str(description.get("name", "building")))

    @classmethod
    def _read(cls, plain: dict[str, Any], name: str) -> Self:
        try:
            return cls.model_validate(plain)
        except ValidationError as error:
            raise explained(error, plain, name) from None

    def to_dict(self) -> dict[str, Any]:
        """Content of a YAML file of this building: mappings, lists, texts and numbers.

        Returns
        -------
        dict
            What was given, with ranges and sources. Defaults are left out, and so is what Mascarin derives
            (such as areas from vertices), unless it no longer follows from the rest because a value was
            replaced.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.to_dict()["site"]["timezone"]
        'UTC+4'
        """
        written = self.written()
        again = {path: number for path, number, _ in leaves(type(self).model_validate(written))}
        for path, number, _ in leaves(self):
            if number.derived and again.get(path) != number:
                put(written, self, path.split("."), Number(number, assumed=number.assumed))
        plain: dict[str, Any] = plain_value(written)
        return plain

    def to_yaml(self, path: str | Path | None = None) -> str:
        """Write the building as YAML; `from_yaml` reads an equal building from it.

        Parameters
        ----------
        path : str or Path, optional
            File to write; none: the text is only returned.

        Returns
        -------
        str
            The text.

        Raises
        ------
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.to_yaml().splitlines()[0]
        'name: LGI cell'
        """
        text = text_of(self.to_dict())
        if path is not None:
            atomic.write(Path(path), text, identity.DESCRIPTION)
        return text

    # --- parameters -----------------------------------------------------------------------------------------

    @cached_property
    def _parameters(self) -> dict[str, Parameter]:
        return {parameter.path: parameter for parameter in with_tied(self, parameters(self))}

    def parameters(self) -> Listing[Parameter]:
        """All numbers of the description, each with its path, unit, range and source.

        Returns
        -------
        list of Parameter
            In the order of the description; its `to_dataframe` gives a table.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.parameters()[0].path
        'site.latitude'
        """
        return listed(self._parameters.values())

    def parameter(self, path: str) -> Parameter:
        """One number of the description.

        Parameters
        ----------
        path : str
            Its path, such as ``materials.concrete.conductivity``, or a short form of it:
            ``constructions.wall.layers.concrete.conductivity`` is the same number, and
            ``surfaces.south.inside.convection`` stands for its coefficient.

        Returns
        -------
        Parameter
            Value, unit, range, source.

        Raises
        ------
        InputError
            If there is no such parameter; the text names the nearest ones.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.parameter("site.altitude").value
        55.0
        """
        return self._parameters[resolve(self, path, self._parameters)]

    def replace(self, values: Mapping[str, Any]) -> Self:
        """Return the same building with other values or parts.

        Parameters
        ----------
        values : mapping of str to float, part or other
            By path: a number, which keeps its range; a whole part, as an object or as what the YAML file
            would hold there (``"tarp"``, ``{"kind": "tarp", "roughness": "smooth"}``); a word; or None,
            which removes the key. ``*`` in a path stands for any name between two dots.

        Returns
        -------
        Building
            Checked as if read from a file. What Mascarin derived from the rest is derived again when a part,
            a word or a structural number is replaced; it stays when only numbers that may vary are replaced.

        Raises
        ------
        InputError
            If a path does not exist or a value is not possible.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.replace({"site.sky": "brunt"}).site.sky.kind
        'brunt'
        """
        changes = spread(self, mapping_of("values", values, "values or parts by path"))
        if stated := unstated(self.weather, changes):
            return self.replace(stated).replace(values)
        resolved = {self._resolved(path, value): without_parts(value) for path, value in changes.items()}
        plain = self.written(keep_derived=not any(map(self._is_structural, resolved)))
        for path, value in resolved.items():
            put(plain, self, path.split("."), value)
        return self._read(plain, self.name)

    def with_values(self, values: Mapping[str, float]) -> Self:
        """Return the same building with other numbers.

        Parameters
        ----------
        values : mapping of str to float
            New values by path; each keeps its range. [unit of each]

        Returns
        -------
        Building
            See `replace`.

        Raises
        ------
        InputError
            If a path is not that of a parameter, or a value is no number or outside its limits.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.with_values({"site.altitude": 60}).parameter("site.altitude").value
        60.0
        """
        values = mapping_of("values", values, "numbers by path, such as {'zones.room.volume': 30.0}")
        for path, value in values.items():
            if isinstance(value, bool) or not isinstance(value, int | float):
                try:
                    float(value)
                except (TypeError, ValueError):
                    raise InputError(
                        f"{path}: found {value!r}; expected a number [{self.parameter(path).unit}]. Use "
                        "Building.replace for parts and words"
                    ) from None
        return self.replace({self.parameter(path).path: float(value) for path, value in values.items()})

    def _resolved(self, path: str, value: Any) -> str:
        """Find what a path means: a number, or a whole part, given so far or not."""
        number = lookup(self, path, self._parameters)
        if number is not None and (number == path or is_number(value)):
            return number
        *above, key = path.split(".")
        holder = piece_at(self, above)
        fields = type(holder).model_fields if isinstance(holder, Part) else holder
        if isinstance(fields, Mapping) and (key in fields or (above and not isinstance(holder, Part))):
            return path  # what is there, or a new part of a section
        return self.parameter(path).path

    def _is_structural(self, path: str) -> bool:
        parameter = self._parameters.get(path)
        return parameter is None or parameter.structural

    # --- what a run needs and gives -------------------------------------------------------------------------

    def outputs(self) -> Listing[Output]:
        """All results that a run of this building can give.

        Returns
        -------
        list of Output
            In the order of the description; its `to_dataframe` gives a table.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.outputs()[0].name
        'room.air_temperature'
        """
        all_outputs = results.outputs(self)
        return Listing(all_outputs, f"{len(all_outputs)} outputs", ("name", "unit"))

    def output(self, name: str) -> Output:
        """One result.

        Parameters
        ----------
        name : str
            Its name or another name of it.

        Returns
        -------
        Output
            Name, unit, kind.

        Raises
        ------
        InputError
            If there is no such result; the text names the nearest ones.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.output("room.air_temperature").unit
        'degC'
        """
        return results.named(self, [name])[0]

    def sources(self) -> list[str]:
        """Sources of the numbers that act in this building and of the methods of a run, once each.

        Returns
        -------
        list of str
            Sources of numbers in the order of the description, then of methods.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> any("pvlib" in source for source in cell.sources())
        True
        """
        return sources(self)

    def check(self, step: str | float = "15min") -> list[str]:
        """Check the building for implausible values and describe it.

        Parameters
        ----------
        step : str or float
            Time step of the runs, such as ``"15min"``; a number is in seconds.

        Returns
        -------
        list of str
            Zones, surfaces with their U values, constructions with their mesh, time constants; then lines
            that start with ``warning:`` or ``assumed:``.

        Raises
        ------
        InputError
            If the step is no duration.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.check()[0]
        'LGI cell: 2 zones, 13 surfaces, 334 parameters'
        """
        return check(self, seconds_of(step))

    def to_engine(
        self, step_seconds: float = 900.0, ranges: Mapping[str, Interval] | None = None
    ) -> EngineDescription:
        """Describe the building to the engine.

        Parameters
        ----------
        step_seconds : float
            Time step for which the mesh is chosen. [s]
        ranges : mapping of str to (low, high), optional
            Ranges of the parameters that will vary; the mesh resolves the worst ends. [unit of each]

        Returns
        -------
        EngineDescription
            The description as text, and the values of the parameters in its order.

        Raises
        ------
        InputError
            If a range names no parameter, or the vertices of a zone do not enclose it.

        Examples
        --------
        >>> from mascarin import examples
        >>> cell = Building.from_yaml(examples.FOLDER / "lgi" / "building.yaml")
        >>> cell.to_engine().paths[0]
        'site.altitude'
        """
        return describe(self, step_seconds, spread_ranges(self, ranges or {}))

    def __repr__(self) -> str:
        return display.text(f"Building '{self.name}'", summary.rows(self, self.parameters()))

    def __str__(self) -> str:
        return repr(self)

    def _repr_html_(self) -> str:
        rows = summary.rows(self, self.parameters())
        return display.page(f"Building '{self.name}'", rows, tables=summary.tables(self, self.parameters()))
