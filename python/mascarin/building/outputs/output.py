"""The results that a run of a building can give, by name."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from itertools import groupby
from typing import TYPE_CHECKING

from mascarin.building.base.part import cached_on
from mascarin.building.outputs.kinds import KINDS, OutputKind, OutputName
from mascarin.building.outputs.locations import Place, owners, places
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from mascarin.building.parts.description import Description

_WORD = re.compile(r"LAYER_LAYER|[A-Z]+")
#: Parts of a building that have an output only with humidity.
_HUMID = ("humid_zone", "dried_zone", "humidified_zone", "humid_side")


@dataclass(frozen=True)
class Output:
    """A result of a run.

    The mean radiant temperature of a zone is the mean of its surface temperatures, weighted by area; it does
    not use view factors to a point or emissivities. The operative temperature is the mean of air and
    mean radiant temperature; the globe temperature is that of a black globe of 0.15 m between the two.

    Heating and cooling loads are ideal loads, neither below 0, as means over the step that ends at the
    record; the net load is heating less cooling. Air changes include infiltration, ventilation, openings and
    the outdoor air of ventilation units.

    Solar radiation is the mean over the step that ends at the record: incident on a surface or window after
    shading [W/m2], transmitted by a window or by all windows of a zone, and lost by a zone through its
    windows [W]; absorbed by a side of a surface, or by all panes of a window [W/m2]. The solar transmittance
    of a window is what it transmits over what is incident on its glass, 0 without sun. A window between two
    zones transmits into the zone of its inside, less what it transmits the other way.

    In a building with humidity, the relative humidity at a side is that of the air of the zone at the
    temperature of the surface; condensation is 1 where the surface has dew or frost, else 0. The
    latent loads are what ideal drying takes away and ideal humidifying adds, neither below 0, as means over
    the step.

    The long-wave radiation that a side gains from its surroundings [W/m2] and its convective heat transfer
    coefficient [W/(m2 K)] are those at the time of the record.

    Attributes
    ----------
    name : str
        Its name.
    unit : str
        Its unit.
    kind : str
        What it is.
    zone, surface, sensor, vent, control, source : int or None
        Position of the zone, surface, sensor, vent, control or heat source in the description.
    side : int or None
        0 for the outside, 1 for the inside.
    layer : int or None
        Position of the layer, counted from outside.
    interface : int or None
        Number of layers outside the interface, at least 1.
    derived : int or None
        Position among the derived outputs of the description.
    means : bool
        Whether it is derived from means over the interval alone.
    aliases : tuple of str
        Other names.

    Examples
    --------
    >>> from mascarin import examples
    >>> import mascarin as mc
    >>> mc.load(examples.FOLDER / "lgi" / "building.yaml").output("room.air_temperature").unit
    'degC'
    """

    name: str
    unit: str
    kind: str
    zone: int | None = None
    surface: int | None = None
    side: int | None = None
    layer: int | None = None
    interface: int | None = None
    sensor: int | None = None
    vent: int | None = None
    control: int | None = None
    source: int | None = None
    derived: int | None = None
    means: bool = False
    aliases: tuple[str, ...] = ()

    @property
    def mean(self) -> bool:
        """Whether a record is the mean over the interval before it, and not a state at its time."""
        return self.means or KINDS[self.kind].mean

    @property
    def usual(self) -> bool:
        """Whether a run records it where no outputs are named."""
        return KINDS[self.kind].usual

    @property
    def meaning(self) -> str:
        """What it is, in one sentence."""
        return KINDS[self.kind].meaning

    @property
    def label(self) -> str:
        """Title of figures of it."""
        return self.name.replace("_", " ") if self.derived is not None else KINDS[self.kind].label

    @property
    def place(self) -> dict[str, int]:
        """Positions that are set for this kind, by name."""
        keys = ("zone", "surface", "side", "layer", "interface", "sensor", "vent", "control", "source")
        return {key: value for key in (*keys, "derived") if (value := getattr(self, key)) is not None}


def outputs(building: Description) -> list[Output]:
    """All results of a building: zones, surfaces, sensors, in the order of the description.

    Those of a part stand in the order of the engine's table; those of its sides and layers side by side.
    """
    return list(cached_on(building, "_outputs", lambda: _with_unit(building, list(_all_outputs(building)))))


def _all_outputs(building: Description) -> Iterator[Output]:
    for owner, names in owners(building).items():
        rows = [(kind, row, name) for kind, row in KINDS.items() for name in row.names if name.owner == owner]
        # Rows of sides, or of layers, that follow each other: side by side, or layer by layer.
        groups = [list(group) for _, group in groupby(rows, key=lambda row: _WORD.findall(row[2].pattern))]
        for index, part in enumerate(names):
            for group in groups:
                candidates = [
                    (location, kind, row, name)
                    for kind, row, name in group
                    for location in places(building, owner, index, part, row.of)
                ]
                candidates.sort(key=lambda candidate: tuple(candidate[0].positions.values()))
                yield from (_output(*candidate) for candidate in candidates)


def _with_unit(building: Description, all_outputs: list[Output]) -> list[Output]:
    """Give derived outputs their unit, and say which of them are means over the interval."""
    means = {output.name: output.mean for output in all_outputs if output.derived is None}
    derived = building.derived_outputs

    def is_mean(name: str, above: tuple[str, ...] = ()) -> bool:
        used = [word for word in derived[name].used if word in means or word in derived]
        return bool(used) and all(
            means[word] if word in means else word not in above and is_mean(word, (*above, name))
            for word in used
        )

    return [
        output
        if output.derived is None
        else replace(output, unit=derived[output.name].unit, means=is_mean(output.name))
        for output in all_outputs
    ]


def _output(location: Place, kind: str, row: OutputKind, name: OutputName) -> Output:
    def written(pattern: str) -> str:
        return _WORD.sub(lambda word: location.words[word[0]], pattern)

    aliases = (written(name.alias),) if name.alias else ()
    return Output(written(name.pattern), row.unit, kind, aliases=aliases, **location.positions)  # type: ignore[arg-type]


def named(building: Description, names: Iterable[str]) -> list[Output]:
    """Results by their names or other names of them; see `Building.output`."""
    by_name = cached_on(building, "_outputs_by_name", lambda: _all_names(building))
    return [_by_name(by_name, name, damp=building.humidity is not None) for name in names]


def _all_names(building: Description) -> dict[str, Output]:
    """All results by their names and other names."""
    by_name: dict[str, Output] = {}
    for output in reversed(outputs(building)):
        by_name.update(dict.fromkeys((*output.aliases, output.name), output))
    return by_name


def chosen(building: Description, names: Iterable[str]) -> list[Output]:
    """Results by names and patterns, each under the name that was asked for.

    Parameters
    ----------
    building : Description
        The building.
    names : iterable of str
        Names, other names, and patterns such as ``*.air_temperature``, which stand for all names that fit.

    Returns
    -------
    list of Output
        In the order of the names; what a pattern stands for, once.

    Raises
    ------
    InputError
        There is no such output, or none that fits a pattern.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> [output.name for output in chosen(box(), ["room.air_t*", "facade.inside_temperature"])]
    ['room.air_temperature', 'facade.inside_temperature']
    """
    all_outputs = outputs(building)
    asked: list[Output] = []
    for name in names:
        if any(sign in str(name) for sign in "*?["):
            fitting = [output for output in all_outputs if fnmatchcase(output.name, name)]
            if not fitting:
                names_of_all = [output.name for output in all_outputs]
                raise InputError(
                    f"{name}: found no output that fits; expected a pattern that fits one of the "
                    f"{len(all_outputs)} of this building, which 'mascarin outputs' lists. "
                    f"{did_you_mean(name, names_of_all)}".rstrip()
                )
            present = {output.name for output in asked}
            asked += [output for output in fitting if output.name not in present]
        else:
            output = named(building, [name])[0]
            aliases = tuple({output.name, *output.aliases} - {name})
            asked.append(output if output.name == name else replace(output, name=name, aliases=aliases))
    return asked


def _humid_names() -> set[str]:
    """Ends of the names of outputs that a building has only with humidity."""
    patterns = [pattern for row in KINDS.values() if row.of in _HUMID for pattern in row.patterns]
    return {pattern.partition(".")[2] for pattern in patterns}


def _by_name(by_name: Mapping[str, Output], name: str, *, damp: bool) -> Output:
    if name not in by_name:
        if not damp and str(name).partition(".")[2] in _humid_names():
            raise InputError(
                f"{name}: found a building without 'humidity:', expected one with it. Add 'humidity: {{}}' "
                "to the building: the air of its zones then has a vapour balance"
            )
        owner, _, what = str(name).partition(".")
        of_owner = [candidate for candidate in by_name if candidate.partition(".")[0] == owner]
        similar = [candidate for candidate in of_owner if what and what in candidate.partition(".")[2]]
        hint = did_you_mean(name, by_name) or (
            f"'{owner}' has {', '.join(similar or of_owner[:8])}." if of_owner else ""
        )
        raise InputError(
            f"{name}: found no such output; expected one of the {len(by_name)} of this building, which "
            "'mascarin "
            f"outputs' lists. {hint}".rstrip()
        )
    return by_name[name]
