"""A study compiled for single evaluations, each in its own process.

A case contains the compiled run of the identification period, the measured series, and the cost. It is saved
as one file of plain arrays beside the project, so that an evaluation reads neither the weather nor the
description again. It is used as long as no file that it was made from has changed.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from mascarin import __version__
from mascarin._io.regular import require_regular
from mascarin._io.sealed import own_files
from mascarin.calibration.base.cost import Cost, CostName
from mascarin.calibration.base.problem import CalibrationProblem, FitParameter, FitSensor
from mascarin.errors import InputError, SolverError, did_you_mean
from mascarin.measurements.observation import instants, means
from mascarin.simulation.preparation.engine_run import CompiledRun

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

_FORMAT: Final = 3
_PACKAGE: Final = Path(__file__).resolve().parent.parent
_KIND: Final = "compiled case"


@dataclass(frozen=True)
class Costs:
    """Result of one evaluation.

    Attributes
    ----------
    total : float
        The minimized cost: the sum of the others. [unit of the cost]
    parts : dict of str to float
        Cost of each sensor by its name, then that of the priors when there are any. [unit of the cost]
    defaults : tuple of str
        Parameters that were not given and kept the value of the study.
    """

    total: float
    parts: dict[str, float]
    defaults: tuple[str, ...] = ()


@dataclass(frozen=True)
class Observed:
    """How the series of the sensors follow from the outputs of a run.

    Attributes
    ----------
    columns : list of int
        Output of each sensor. [-]
    kinds : list of str
        ``instant`` or ``mean`` for each sensor.
    reach : float
        Interval of means. [steps]
    """

    columns: list[int]
    kinds: list[str]
    reach: float


@dataclass(frozen=True, eq=False)
class Case:
    """A compiled study.

    Attributes
    ----------
    run : CompiledRun
        The building in its climate over the identification period.
    observed : Observed
        How the series of the sensors follow from its outputs.
    positions : ndarray of int, shape (F,)
        Positions of the free parameters in the parameter vector. [-]
    instants : ndarray, shape (n,)
        Positions of the compared instants. [steps]
    parameters : tuple of FitParameter, length F
        The free parameters.
    sensors : tuple of FitSensor
        The measured series at those instants.
    cost : str
        Name of the cost.
    step : float
        Time between the instants. [s]
    inputs : dict
        Files and version that it was made from, see `inputs_of`.
    """

    run: CompiledRun
    observed: Observed
    positions: npt.NDArray[np.int64]
    instants: Array
    parameters: tuple[FitParameter, ...]
    sensors: tuple[FitSensor, ...]
    cost: CostName
    step: float
    inputs: dict[str, Any]

    @property
    def names(self) -> list[str]:
        """Names of the costs in the order in which they are written: the total first."""
        priors = ["priors"] if any(p.prior is not None for p in self.parameters) else []
        return ["cost", *(f"cost_{name}" for name in (*(s.name for s in self.sensors), *priors))]

    @cached_property
    def problem(self) -> CalibrationProblem:
        """The calibration problem."""
        return CalibrationProblem(self.parameters, self.sensors, self._model, step=self.step)

    @cached_property
    def _reasons(self) -> list[str]:
        """Reasons why members of the last batch failed."""
        return []

    def _model(self, x: Array) -> Array:
        vectors = np.tile(self.run.values, (len(x), 1))
        vectors[:, self.positions] = x
        records, _, failures = self.run.ensemble(vectors)
        self._reasons[:] = [failure.reason for failure in failures]
        series = [
            instants(records[..., c], self.instants)
            if kind == "instant"
            else means(records[..., c], self.instants, self.observed.reach)
            for c, kind in zip(self.observed.columns, self.observed.kinds, strict=True)
        ]
        return np.stack(series, axis=-1)

    def vector(self, values: Mapping[str, float]) -> tuple[Array, tuple[str, ...]]:
        """Values of the free parameters, and the paths of those that were not given.

        Raises
        ------
        InputError
            An unknown path, or a value that the parameter cannot have.
        """
        paths = [p.path for p in self.parameters]
        for path in values:
            if path not in paths:
                raise InputError(
                    f"found: parameter '{path}'; expected one that the study identifies. "
                    f"{did_you_mean(path, paths)} Or add it to identification.parameters of the study."
                )
        x = np.empty(len(self.parameters))
        for k, parameter in enumerate(self.parameters):
            x[k] = values.get(parameter.path, self.run.values[self.positions[k]])
            low, high = parameter.limits
            if not low <= x[k] <= high:
                unit = f" {parameter.unit}" if parameter.unit else ""
                raise InputError(
                    f"{parameter.path}: found {x[k]:g}, expected {low:g} .. {high:g}{unit}: "
                    "narrow Min and Max of the command file"
                )
        return x, tuple(path for path in paths if path not in values)

    def evaluate(self, values: Mapping[str, float]) -> Costs:
        """Cost of one set of values.

        Parameters
        ----------
        values : mapping of str to float
            Path -> value; those that are missing keep the value of the study. [unit of each]

        Raises
        ------
        InputError
            A value that cannot be used.
        SolverError
            The building cannot be simulated with these values.
        """
        x, defaults = self.vector(values)
        cost = Cost(self.problem, self.cost)
        of_sensors = cost.of_sensors(self.problem.residuals(x[None]))
        total = float(cost.total(x[None], of_sensors)[0])
        if not np.isfinite(total):
            point = ", ".join(f"{p.path}={v:g}" for p, v in zip(self.parameters, x, strict=True))
            reason = self._reasons[0] if self._reasons else "the model gives no number for a sensor."
            raise SolverError(f"{reason} Parameters: {point}")
        parts = {s.name: float(c) for s, c in zip(self.sensors, of_sensors[0], strict=True)}
        if "cost_priors" in self.names:
            parts["priors"] = 0.5 * float(np.sum(cost.prior_residuals(x[None]) ** 2))
        return Costs(total, parts, defaults)

    # --- the file -----------------------------------------------------------------------------------------

    def save(self, path: Path) -> None:
        """Write the case; the file appears when it is complete, also with several writers."""
        header = {
            "format": _FORMAT,
            "run": self.run.header(),
            "observed": asdict(self.observed),
            "parameters": [asdict(p) for p in self.parameters],
            "sensors": [
                [s.name, s.standard_uncertainty, s.relative_standard_uncertainty, s.unit, s.weight]
                for s in self.sensors
            ],
            "cost": self.cost,
            "step": self.step,
            "inputs": self.inputs,
        }
        arrays = {
            "forcing": self.run.forcing,
            "values": self.run.values,
            "positions": self.positions,
            "instants": self.instants,
            "measured": self.problem.measured,
            "mask": self.problem.mask,
        }
        own_files.write(path, _KIND, own_files.packed(header, arrays))


def open_case(path: Path, study: str) -> Case | None:
    """Read a saved case; None when there is none, or when a file that it was made from has changed.

    Parameters
    ----------
    path : Path
        File of the case.
    study : str
        Absolute path of the file of the study.
    """
    try:
        header, arrays = own_files.unpacked(own_files.read(path, _KIND))
        inputs = header["inputs"]
        if header["format"] != _FORMAT or inputs != inputs_of(study, inputs["files"]):
            return None
        return _case(header, arrays)
    except (OSError, ValueError, LookupError, TypeError, AttributeError, InputError):
        # A file that cannot be read is made again.
        return None


def _case(header: Mapping[str, Any], arrays: Mapping[str, Any]) -> Case:
    sensors = tuple(
        FitSensor(
            name,
            arrays["measured"][:, s],
            uncertainty,
            relative,
            unit,
            use=arrays["mask"][:, s],
            weight=weight,
        )
        for s, (name, uncertainty, relative, unit, weight) in enumerate(header["sensors"])
    )
    return Case(
        run=CompiledRun.read(header["run"], arrays["forcing"], arrays["values"]),
        observed=Observed(**header["observed"]),
        positions=arrays["positions"],
        instants=arrays["instants"],
        parameters=tuple(_parameter(p) for p in header["parameters"]),
        sensors=sensors,
        cost=cast("CostName", header["cost"]),
        step=header["step"],
        inputs=header["inputs"],
    )


def _parameter(fields: Mapping[str, Any]) -> FitParameter:
    limits, prior = tuple(fields["limits"]), fields["prior"]
    return FitParameter(**{**fields, "limits": limits, "prior": None if prior is None else tuple(prior)})


def inputs_of(study: str, files: Sequence[str] | Mapping[str, Any]) -> dict[str, Any]:
    """All that a case depends on.

    Parameters
    ----------
    study : str
        Absolute path of the study file.
    files : sequence of str
        Absolute paths of all files that were read.

    Returns
    -------
    dict
        Version and state of the program, study, folder of the data, and the hash of each file.

    Raises
    ------
    OSError
        A file no longer exists.
    """
    return {
        "version": __version__,
        "program": _program_state(),
        "study": study,
        "data": os.environ.get("MASCARIN_DATA", ""),
        "files": {name: _hash(name) for name in files},
    }


def _hash(name: str) -> str:
    """SHA-256 of an input; a name from a kept case may be that of a device."""
    return hashlib.sha256(require_regular(Path(name)).read_bytes()).hexdigest()


def _program_state() -> str:
    """Hash of sizes and times of all code: a case is made again after every change of the program."""
    digest = hashlib.sha256()
    stack, states = [str(_PACKAGE)], []
    while stack:
        with os.scandir(stack.pop()) as entries:
            for entry in entries:
                if entry.is_dir(follow_symlinks=False):
                    stack.append(entry.path)
                elif entry.name.endswith((".py", ".so", ".pyd")):
                    state = entry.stat()
                    states.append(f"{entry.path[len(str(_PACKAGE)) :]} {state.st_size} {state.st_mtime_ns}")
    digest.update("\n".join(sorted(states)).encode("utf-8", "surrogateescape"))
    return digest.hexdigest()
