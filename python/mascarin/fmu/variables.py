"""The variables of a unit: inputs, outputs and parameters by name."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any, Final, Literal

from mascarin.errors import InputError, did_you_mean
from mascarin.simulation.preparation.weather_inputs import is_of_weather

if TYPE_CHECKING:
    from mascarin.fmu.inputs import Channel
    from mascarin.simulation import Simulation

_CONTROL: Final = re.compile(r"[\x00-\x1f]")


@dataclass(frozen=True)
class Variable:
    """A variable of a unit.

    Attributes
    ----------
    name : str
        Its name.
    causality : str
        ``input``, ``output`` or ``parameter``.
    unit : str
        Its unit.
    description : str
        What it is.
    role : dict
        What it is to the library: the channel, the record or the position of the parameter.
    start : float
        Start value; 0 for an output. [unit]
    low, high : float or None
        Limits; None: there is none. [unit]
    """

    name: str
    causality: Literal["input", "output", "parameter"]
    unit: str
    description: str
    role: dict[str, Any]
    start: float = 0.0
    low: float | None = None
    high: float | None = None

    def plain(self) -> dict[str, Any]:
        """What the library reads."""
        return {
            "name": self.name,
            "unit": self.unit,
            "role": self.role,
            "start": self.start,
            "low": self.low,
            "high": self.high,
        }


def variables_of(
    simulation: Simulation, inputs: Sequence[Channel], patterns: Sequence[str] | None
) -> list[Variable]:
    """The variables of a unit; value references count them from 1.

    Parameters
    ----------
    simulation : Simulation
        The run.
    inputs : sequence of Channel
        What is an input.
    patterns : sequence of str or None
        Patterns of paths of parameters; None: all.

    Raises
    ------
    InputError
        A pattern that fits no parameter, or a name that occurs twice.
    """
    variables = [
        *(_input(simulation, channel) for channel in inputs),
        *_outputs(simulation),
        *_parameters(simulation, patterns),
    ]
    _require_names(variables)
    return variables


def _input(simulation: Simulation, channel: Channel) -> Variable:
    first = float(simulation.compiled.forcing[0, 0, channel.position])
    return Variable(
        channel.name, "input", channel.unit, channel.description, {"input": channel.position},
        start=min(max(first, channel.low), channel.high), low=channel.low, high=channel.high,
    )  # fmt: skip


def _outputs(simulation: Simulation) -> list[Variable]:
    columns = simulation.compiled.readings.columns
    return [
        Variable(output.name, "output", output.unit, output.meaning, {"output": column})
        for output, column in zip(simulation.outputs, columns, strict=True)
    ]


def _parameters(simulation: Simulation, patterns: Sequence[str] | None) -> list[Variable]:
    compiled = simulation.compiled
    # Gain, offset and clock of the weather are in the forcing that the unit carries.
    paths = [path for path in compiled.paths if not is_of_weather(path)]
    for pattern in patterns or ():
        if not any(fnmatchcase(path, pattern) for path in paths):
            raise InputError(
                f"--parameter: found '{pattern}', expected the path of a parameter that can vary, or a "
                f"pattern such as 'zones.*'. {did_you_mean(pattern, list(paths))}".rstrip()
            )
    by_path = {parameter.path: parameter for parameter in simulation.building.parameters()}
    variables = []
    for position, (path, value) in enumerate(zip(compiled.paths, compiled.values.tolist(), strict=True)):
        if is_of_weather(path):
            continue
        if patterns is not None and not any(fnmatchcase(path, pattern) for pattern in patterns):
            continue
        parameter = by_path[path]
        low, high = (limit if math.isfinite(limit) else None for limit in (parameter.lower, parameter.upper))
        variables.append(
            Variable(
                path, "parameter", parameter.unit, parameter.description, {"parameter": position},
                start=value, low=low, high=high,
            )
        )  # fmt: skip
    return variables


def _require_names(variables: Sequence[Variable]) -> None:
    names: set[str] = {"time"}
    for variable in variables:
        if variable.name in names:
            raise InputError(
                f"{variable.name}: found this name twice among the variables of the unit, expected each "
                "once; give the zone, surface or column another name"
            )
        if _CONTROL.search(variable.name):
            raise InputError(
                f"{variable.name!r}: found a sign in the name that a unit cannot have, such as a line break; "
                "give the column another name"
            )
        names.add(variable.name)
