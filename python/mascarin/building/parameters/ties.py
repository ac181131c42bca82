"""Tied parameters: all numbers that a pattern matches vary as one.

A building names them in ``ties``: ``{zones.*.infiltration.constant: factor}``. The pattern is then the path
of one parameter. With ``factor`` it multiplies the values of the building, and its own value is 1; with
``value`` it is the one value of all, which must be equal in the building.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar

from mascarin.building.base.leaves import steps
from mascarin.building.base.part import Part, fault
from mascarin.building.base.wildcards import fits, is_pattern, matching
from mascarin.building.parameters.parameter import Parameter
from mascarin.errors import InputError

if TYPE_CHECKING:
    from pydantic_core import InitErrorDetails

    from mascarin.building.parts.description import Description

How = Literal["factor", "value"]


class Building(Protocol):
    """What is needed of a building, which itself needs this module."""

    @property
    def ties(self) -> Mapping[str, How]:
        """Pattern -> how."""
        ...

    def parameters(self) -> Iterable[Parameter]:
        """All numbers."""
        ...

    def parameter(self, path: str) -> Parameter:
        """One number."""
        ...

    def replace(self, values: Mapping[str, Any]) -> Any:
        """The same building with other parts."""
        ...


AnyBuilding = TypeVar("AnyBuilding", bound=Building)


def with_ties(building: AnyBuilding, ties: Mapping[str, How]) -> AnyBuilding:
    """The building with further tied parameters.

    Parameters
    ----------
    building : Building
        The building.
    ties : mapping of str to str
        Pattern -> ``factor`` or ``value``.

    Raises
    ------
    InputError
        A pattern matches nothing, or its numbers cannot be tied.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import FOLDER
    >>> cell = mc.load(FOLDER / "lgi" / "building.yaml")
    >>> tied = with_ties(cell, {"zones.*.infiltration.constant": "factor"})
    >>> tied.parameter("zones.*.infiltration.constant").members
    ('zones.room.infiltration.constant', 'zones.air_gap.infiltration.constant')
    """
    if all(building.ties.get(path) == how for path, how in ties.items()):
        return building
    _ = tied(ties, _numbers(building))
    changed: AnyBuilding = building.replace({"ties": {**building.ties, **ties}})
    return changed


def with_tied(building: Description, all_parameters: Iterable[Parameter]) -> list[Parameter]:
    """The parameters of a building with its tied ones, after the numbers that follow them."""
    from dataclasses import replace

    listed = list(all_parameters)
    if not building.ties:
        return listed
    together = tied(building.ties, listed)
    follows = {path: parameter.path for parameter in together for path in parameter.members}
    untied = [
        replace(p, reason=p.reason or f"follows {follows[p.path]}") if p.path in follows else p
        for p in listed
    ]
    return [*untied, *together]


def faults(building: Description, all_parameters: Iterable[Parameter]) -> list[InitErrorDetails]:
    """What is wrong with the ties of a building."""
    listed = list(all_parameters)
    try:
        tied(building.ties, listed)
    except InputError:
        return _faults_of_each(building, listed)
    return []


def _faults_of_each(building: Description, listed: list[Parameter]) -> list[InitErrorDetails]:
    """What is wrong with each tie, or with all together."""
    wrong = []
    for pattern, how in building.ties.items():
        try:
            tied({pattern: how}, listed)
        except InputError as error:
            said, _, help_ = str(error).removeprefix(f"{pattern}: ").partition("; expected ")
            expected, _, advice = help_.partition(". ")
            wrong.append(fault(("ties", pattern), said.removeprefix("found "), expected, advice))
    if not wrong:
        try:
            tied(building.ties, listed)
        except InputError as error:
            wrong.append(fault(("ties",), str(error), "each number once", "Take it out of one tie."))
    return wrong


def tied(ties: Mapping[str, How], numbers: Iterable[Parameter]) -> list[Parameter]:
    """One parameter for each tie.

    Raises
    ------
    InputError
        A pattern matches nothing, its numbers cannot be tied, or a number is in two ties.
    """
    by_path = {p.path: p for p in numbers if not p.members}
    tied_parameters: list[Parameter] = []
    tie_of: dict[str, str] = {}
    for pattern, how in ties.items():
        members = [by_path[path] for path in matching(pattern, by_path)]
        tied_parameters.append(_tied(pattern, how, members))
        for path in tied_parameters[-1].members:
            if path in tie_of:
                raise InputError(f"{path}: is in {tie_of[path]} and in {pattern}; expected each number once")
            tie_of[path] = pattern
    return tied_parameters


def spread(building: Building, values: Mapping[str, Any]) -> dict[str, Any]:
    """Values by path with those of tied parameters and patterns given to each of their members.

    Parameters
    ----------
    building : Building
        Has the ties.
    values : mapping of str to any
        By path: a number for a tied parameter; for another pattern what each match gets.
    """
    if not any(is_pattern(str(path)) for path in values):
        return dict(values)
    values_by_path: dict[str, Any] = {}
    for path, value in values.items():
        if path in building.ties:
            by_factor = building.ties[path] == "factor"
            for member in building.parameter(path).members:
                values_by_path[member] = building.parameter(member).value * value if by_factor else value
        elif is_pattern(str(path)):
            paths = [p.path for p in building.parameters() if not p.members]
            paths += _keys(building, path.split("."))  # words, and what is not given so far
            values_by_path |= dict.fromkeys(matching(path, paths, parts=True), value)
        else:
            values_by_path[path] = value
    return values_by_path


def _keys(part: Any, pattern: Sequence[str], above: tuple[str, ...] = ()) -> list[str]:
    """Paths of keys of a description that a pattern stands for; its last step is the name of the key."""
    first, below = pattern[0], pattern[1:]
    if not below and is_pattern(first):
        return []  # a star at the end stands for numbers alone
    keys: Iterable[str] = (
        type(part).model_fields if isinstance(part, Part) and not below else [key for key, _ in steps(part)]
    )
    fitting = [key for key in keys if fits(key, first)]
    if not below:
        return [".".join((*above, key)) for key in fitting]
    pieces = dict(steps(part))
    return [path for key in fitting for path in _keys(pieces[key], below, (*above, key))]


def spread_ranges(
    building: Building, ranges: Mapping[str, tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    """Ranges by path with those of tied parameters given to each of their members."""
    ranges_by_path: dict[str, tuple[float, float]] = {}
    for path, (low, high) in ranges.items():
        if path not in building.ties:
            ranges_by_path[path] = (low, high)
            continue
        for member in building.parameter(path).members:
            value = building.parameter(member).value if building.ties[path] == "factor" else 1.0
            ranges_by_path[member] = (min(low * value, high * value), max(low * value, high * value))
    return ranges_by_path


def expanded(building: Building, paths: Iterable[str]) -> list[str]:
    """Paths with every pattern replaced by the parameters that it matches, unless it is a tied parameter.

    Numbers that cannot vary, or that have no effect in this building, are left out of what a pattern matches.

    Raises
    ------
    InputError
        A pattern matches nothing, or nothing that varies.
    """
    expanded_paths: list[str] = []
    for path in paths:
        if not is_pattern(str(path)) or path in building.ties:
            expanded_paths.append(path)
            continue
        matches = matching(path, (p.path for p in building.parameters() if not p.members))
        active = [match_path for match_path in matches if building.parameter(match_path).varies]
        if not active:
            first = building.parameter(matches[0])
            raise InputError(
                f"{path}: found {len(matches)} numbers, none of which varies ({first.path}: {first.reason}); "
                "expected at least one that has an effect and a range"
            )
        expanded_paths += active
    return list(dict.fromkeys(expanded_paths))


def _numbers(building: Building) -> list[Parameter]:
    return [p for p in building.parameters() if not p.members]


def _tied(pattern: str, how: How, members: list[Parameter]) -> Parameter:
    """One parameter for several numbers."""
    fixed = next((p for p in members if p.structural), None)
    if fixed is not None:
        raise InputError(
            f"{pattern}: found {fixed.path}, which is structural ({fixed.reason}); expected numbers that can "
            "vary within a run. Choose another pattern"
        )
    active = [p for p in members if p.reason is None] or members
    if how == "value":
        return _of_value(pattern, active)
    return _of_factor(pattern, active)


def _of_value(pattern: str, members: list[Parameter]) -> Parameter:
    first = members[0]
    for other in members[1:]:
        if (other.value, other.unit) != (first.value, first.unit):
            raise InputError(
                f"{pattern}: found {first.value:g} {first.unit} ({first.path}) and {other.value:g} "
                f"{other.unit} ({other.path}); expected equal values, which one common value can replace. "
                "Give them the same value, or tie them by a factor"
            )
    lower, upper = max(p.lower for p in members), min(p.upper for p in members)
    span = max(p.low for p in members), min(p.high for p in members)
    return _tied_parameter(pattern, first.value, first.unit, (lower, upper), span, members)


def _of_factor(pattern: str, members: list[Parameter]) -> Parameter:
    scaled = [p for p in members if p.value != 0.0]
    degrees = next((p for p in members if p.unit == "degC"), None)
    if not scaled or degrees is not None:
        what = "only the value 0" if degrees is None else f"a temperature in degC ({degrees.path})"
        raise InputError(
            f"{pattern}: found {what}; expected numbers that a factor changes in proportion. Tie them by "
            "their value"
        )
    lower = max(_inward(min(p.lower / p.value, p.upper / p.value), p) for p in scaled)
    upper = min(_inward(max(p.lower / p.value, p.upper / p.value), p) for p in scaled)
    ranges = [sorted((p.low / p.value, p.high / p.value)) for p in scaled]
    span = (max(lower, *(low for low, _ in ranges)), min(upper, *(high for _, high in ranges)))
    return _tied_parameter(pattern, 1.0, "-", (lower, upper), span, members, "factor of ")


def _inward(factor: float, parameter: Parameter) -> float:
    """A factor at a limit, moved towards 1 until its product with the value is possible."""
    while math.isfinite(factor) and not parameter.lower <= factor * parameter.value <= parameter.upper:
        factor = math.nextafter(factor, 1.0)
    return factor


def _tied_parameter(
    pattern: str,
    value: float,
    unit: str,
    limits: tuple[float, float],
    span: tuple[float, float],
    members: list[Parameter],
    what: str = "",
) -> Parameter:
    if not span[0] < span[1]:
        raise InputError(
            f"{pattern}: found ranges that have nothing in common; expected ranges of {len(members)} numbers "
            "that overlap. Give them ranges in the building"
        )
    first = members[0]
    reason = first.reason if all(p.reason is not None for p in members) else None
    above = next((p.above for p in members if p.above is not None and p.lower == limits[0]), None)
    return Parameter(
        path=pattern, value=value, unit=unit, lower=limits[0], upper=limits[1], low=span[0], high=span[1],
        description=f"{what}{len(members)} numbers together: {first.description}",
        source=None, assumed=False, structural=False, reason=reason,
        range_reason="what the ranges of all have in common", members=tuple(p.path for p in members),
        above=above,
    )  # fmt: skip
