"""The variables of a design study with their options, and designs as samples of an ensemble."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.limits import at_least, at_most
from mascarin.building.parameters.ties import expanded, spread
from mascarin.design.variants.description import MAX_DESIGNS
from mascarin.errors import InputError
from mascarin.materials import product, products

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.design.variants.description import DesignFile, Variable
    from mascarin.study.file.locations import Faults, Places

#: Thickest layer of a phase-change material. [m]
MAX_PHASE_CHANGE_THICKNESS: Final = 0.2
#: A design: for each variable the number of its option, or a value where the variable is a range.
Design = tuple[float, ...]


@dataclass(frozen=True)
class Option:
    """One way to choose a variable.

    Attributes
    ----------
    label : str
        Name in tables.
    value : float or None
        The number, where it is one; the melting temperature of a product. [unit of the variable]
    numbers : mapping of str to float
        Parameters. [unit of each]
    parts : mapping of str to object
        Parts of the description, which need another compiled building.
    """

    label: str
    value: float | None = None
    numbers: Mapping[str, float] = field(default_factory=dict)
    parts: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Choice:
    """A variable with its options.

    Attributes
    ----------
    name, unit : str
        Name, and unit of its values.
    options : tuple of Option
        In the order of a grid; for a range, evenly spaced.
    paths : tuple of str
        Parameters of a variable of numbers.
    range : (float, float) or None
        Bounds, where a search may take any value between them. [unit]
    structural : bool
        Whether an option needs another compiled building.
    """

    name: str
    unit: str
    options: tuple[Option, ...]
    paths: tuple[str, ...] = ()
    range: tuple[float, float] | None = None
    structural: bool = False

    def option(self, chosen: float, *, free: bool) -> Option:
        """The option of a design; ``free`` where a range takes any value."""
        if free and self.range is not None:
            return number_option(chosen, self.paths)
        return self.options[int(chosen)]


@dataclass(frozen=True)
class Choices:
    """All variables of a study.

    Attributes
    ----------
    all : tuple of Choice
        Those that need another building first, so that designs of one structure stand side by side.
    free : bool
        Whether ranges take any value (a search), or the values of their grid.
    """

    all: tuple[Choice, ...]
    free: bool = False

    def grid(self) -> list[Design]:
        """All combinations, those of one structure side by side.

        Raises
        ------
        InputError
            More than `MAX_DESIGNS`.
        """
        sizes = [len(choice.options) for choice in self.all]
        count = math.prod(sizes)
        if count > MAX_DESIGNS:
            raise InputError(
                f"variables: found {' x '.join(map(str, sizes))} = {count} designs, expected at most "
                f"{MAX_DESIGNS} in a grid; give fewer values, or search: {{method: swarm}} or nsga2"
            )
        return [
            tuple(map(float, combination))
            for combination in itertools.product(*(range(size) for size in sizes))
        ]

    def options(self, design: Design) -> list[Option]:
        """What a design has chosen."""
        return [
            choice.option(chosen, free=self.free) for choice, chosen in zip(self.all, design, strict=True)
        ]

    def labels(self, designs: Sequence[Design]) -> dict[str, list[str]]:
        """What each design has chosen, by variable."""
        rows = [[option.label for option in self.options(design)] for design in designs]
        return {choice.name: [row[k] for row in rows] for k, choice in enumerate(self.all)}

    def samples(self, building: Building, designs: Sequence[Design]) -> dict[str, list[Any]]:
        """Columns of an ensemble: parameters and parts by path, a row for each design.

        A path that a design does not touch has what the building has there.
        """
        rows = [self.options(design) for design in designs]
        numbers = dict.fromkeys(path for options in rows for option in options for path in option.numbers)
        parts = dict.fromkeys(path for options in rows for option in options for path in option.parts)
        plain = building.to_dict()
        columns: dict[str, list[Any]] = {}
        for path in parts:
            described = _value_at(plain, path)
            columns[path] = [
                next((o.parts[path] for o in options if path in o.parts), described) for options in rows
            ]
        for path in numbers:
            base = building.parameter(path).value
            columns[path] = [
                float(next((o.numbers[path] for o in options if path in o.numbers), base)) for options in rows
            ]
        return columns

    def ranges(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of every parameter: one mesh serves all designs. [unit of each]"""
        by_path: dict[str, list[float]] = {}
        for choice in self.all:
            for option in choice.options:
                for path, value in option.numbers.items():
                    by_path.setdefault(path, []).append(value)
            for path in choice.paths if choice.range else ():
                by_path[path] += choice.range or ()
        return {path: (min(values), max(values)) for path, values in by_path.items()}

    def structures(self) -> Iterator[dict[str, Any]]:
        """The parts of every structure."""
        structural = [choice for choice in self.all if choice.structural]
        for options in itertools.product(*(choice.options for choice in structural)):
            yield {path: part for option in options for path, part in option.parts.items()}


def read_choices(file: DesignFile, building: Building, locations: Places, faults: Faults) -> Choices:
    """Variables of a design file, each option checked with the building.

    Parameters
    ----------
    file : DesignFile
        The file.
    building : Building
        The building that all designs begin with.
    locations : Places
        Lines of the file, for errors.
    faults : Faults
        Collects the errors.
    """
    choices = []
    for name, variable in file.variables.items():
        with locations.noting(faults, "variables", name):
            choices.append(_choice(name, variable, building, locations, faults))
    _require_apart(choices, building, locations, faults)
    ordered = sorted(choices, key=lambda choice: not choice.structural)  # stable: else as in the file
    return Choices(tuple(ordered), free=file.search.method != "grid")


def number_option(value: float, paths: Sequence[str]) -> Option:
    """One number at some paths."""
    return Option(f"{value:.6g}", float(value), {path: float(value) for path in paths})


def _choice(name: str, variable: Variable, building: Building, locations: Places, faults: Faults) -> Choice:
    if variable.path is not None:
        return _numbers(name, variable, building, locations)
    if variable.material is not None:
        return _products(name, variable, building, locations, faults)
    options = []
    for label, changes in variable.variants.items():
        with locations.noting(faults, "variables", name, "variants", label):
            building.replace(changes)
            each = spread(building, changes)
            numbers = {path: float(value) for path, value in each.items() if _is_plain(building, path, value)}
            parts = {path: value for path, value in each.items() if path not in numbers}
            options.append(Option(label, None, numbers, parts))
    return Choice(name, "", tuple(options), structural=any(option.parts for option in options))


def _is_plain(building: Building, path: str, value: Any) -> bool:
    """Whether a change sets a number without changing the shape of the building."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return not building.parameter(path).structural


def _numbers(name: str, variable: Variable, building: Building, locations: Places) -> Choice:
    patterns = [variable.path] if isinstance(variable.path, str) else list(variable.path or ())
    with locations.blame("variables", name, "path"):
        parameters = [
            building.parameter(path)
            for path in expanded(building, [_in_layers(building, p) for p in patterns])
        ]
        for parameter in parameters:
            if parameter.structural:
                raise InputError(
                    f"{parameter.path} changes the shape of the building; expected a number that may vary "
                    f"in a "
                    "run. Write variants: instead, such as {short: {PATH: 1}, long: {PATH: 2}}"
                )
    bounds = variable.range
    values = variable.values if bounds is None else np.linspace(*bounds, variable.steps).tolist()
    with locations.blame("variables", name, "values" if bounds is None else "range"):
        for parameter in parameters:
            for value in values:
                if not parameter.lower <= value <= parameter.upper:
                    raise InputError(
                        f"found {value:g} {parameter.unit} for {parameter.path}, expected "
                        f"{parameter.allowed}; check its unit"
                    )
        for parameter in parameters:
            _require_thin(building, parameter.path, max(values))
    paths = tuple(parameter.path for parameter in parameters)
    return Choice(
        name, parameters[0].unit, tuple(number_option(value, paths) for value in values), paths, bounds
    )


def _require_thin(building: Building, path: str, value: float) -> None:
    """Refuse a phase-change layer that no construction of a building has room for."""
    parts = path.split(".")
    if parts[0] != "constructions" or parts[-1] != "thickness" or value <= MAX_PHASE_CHANGE_THICKNESS:
        return
    layers = building.constructions[parts[1]].layers
    material = next((layer.material for layer in layers if layer.name == parts[3]), None)
    if material is not None and building.materials[material].kind == "pcm":
        raise InputError(
            f"found {value:g} m for {path}, expected at most {MAX_PHASE_CHANGE_THICKNESS:g} m of a "
            "phase-change material, which is what a construction has room for; check its unit: 10 mm is 0.01"
        )


def _in_layers(building: Building, path: str) -> str:
    """A path of a layer must be that of a layer of its construction; the error names those that there are."""
    parts = path.split(".")
    if (
        parts[0] == "constructions"
        and len(parts) > 3
        and parts[1] in building.constructions
        and "*" not in path
    ):
        names = [str(layer.name) for layer in building.constructions[parts[1]].layers]
        if parts[2] == "layers" and parts[3] not in names:
            raise InputError(
                f"found layer '{parts[3]}', but construction '{parts[1]}' has the layers "
                f"{', '.join(names)} from "
                "outside to inside; expected one of them. Correct the path, or add the layer to the building"
            )
    return path


def _products(name: str, variable: Variable, building: Building, locations: Places, faults: Faults) -> Choice:
    material = str(variable.material)
    with locations.blame("variables", name, "material"):
        if material not in building.materials or building.materials[material].kind != "pcm":
            those = [key for key, entry in building.materials.items() if entry.kind == "pcm"]
            raise InputError(
                f"found '{material}', expected a phase-change material of the building: "
                f"{', '.join(those) or 'there is none'}"
            )
    with locations.blame("variables", name, "products"):
        chosen = (
            list(products().values())
            if variable.products == "all"
            else [product(p) for p in variable.products]
        )
    if variable.melting is not None:
        low, high = variable.melting
        chosen = [
            candidate
            for candidate in chosen
            if at_least(candidate.melting_temperature or math.nan, low)
            and at_most(candidate.melting_temperature or math.nan, high)
        ]
    if not chosen:
        raise InputError(f"found no product that melts between {variable.melting} degC; expected one or more")
    options = []
    for candidate in sorted(chosen, key=lambda candidate: candidate.melting_temperature or math.nan):
        parts = {f"materials.{material}.product": candidate.name}
        with locations.noting(faults, "variables", name, "products"):
            building.replace(parts)  # a property that neither product nor building give
            options.append(Option(candidate.name, candidate.melting_temperature, {}, parts))
    return Choice(name, "degC", tuple(options), structural=True)


def _require_apart(choices: Sequence[Choice], building: Building, locations: Places, faults: Faults) -> None:
    """Refuse two variables of the same number, and a number that a variant leaves out."""
    for first, second in itertools.combinations(choices, 2):
        for a, b in itertools.product(_touched(first), _touched(second)):
            if a == b:
                with locations.noting(faults, "variables", second.name):
                    raise InputError(
                        f"sets {b}, which variable '{first.name}' sets too; expected each in one variable. "
                        f"Join them "
                        "in one variable with variants"
                    )
    for first, second in itertools.permutations(choices, 2):
        for option in first.options:
            inside = [b for b in _numbers_of(second) if any(b.startswith(f"{a}.") for a in option.parts)]
            changed = building.replace(option.parts) if inside else building
            for path in inside:
                with locations.noting(faults, "variables", first.name, "variants", option.label):
                    _in_layers(changed, path)
                    changed.parameter(path)


def _numbers_of(choice: Choice) -> list[str]:
    return list(dict.fromkeys(path for option in choice.options for path in option.numbers))


def _touched(choice: Choice) -> list[str]:
    return list(dict.fromkeys(path for o in choice.options for path in (*o.numbers, *o.parts)))


def _value_at(plain: Any, path: str) -> Any:
    """What a description has at a path; None where there is nothing."""
    for step in path.split("."):
        if isinstance(plain, list):
            named = {
                str(entry.get("name", entry.get("material"))): entry
                for entry in plain
                if isinstance(entry, dict)
            }
            plain = named.get(step)
        elif isinstance(plain, Mapping):
            plain = plain.get(step)
        else:
            return None
    return plain
