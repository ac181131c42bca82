"""Results of a step kept in the folder of the study as plain arrays and texts, so that it is not repeated.

Dataclasses of `CLASSES` are kept field by field. What was known before (a calibration problem with its
model) is kept as a reference. Nothing that is read can run code: there are only arrays, texts and names of
this list. A file that is damaged, of another version, or whose classes have changed is computed again.
"""

from __future__ import annotations

import hashlib
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from mascarin._io.sealed import own_files
from mascarin.simulation.checks.warning_kinds import RunWarning, WarningKind

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.measurements.observation import Observation
    from mascarin.simulation.simulation import Simulation
    from mascarin.study.context.context import StudyContext
    from mascarin.study.context.storage import Workspace

    Array = npt.NDArray[np.float64]

_T = TypeVar("_T")

#: Results are dropped when the study is done.
NAME: Final = "kept"
#: Dataclasses that are kept: modules and their classes. A name of a file is looked up here, never imported.
CLASSES: Final[Mapping[str, tuple[str, ...]]] = {
    "mascarin.calibration.errors.discrepancy": ("Discrepancy",),
    "mascarin.calibration.base.evaluations": ("Trace",),
    "mascarin.calibration.errors.joint_posterior": ("JointPosterior",),
    "mascarin.calibration.base.problem": ("FitParameter",),
    "mascarin.calibration.base.result": ("Calibration", "Minimum"),
    "mascarin.calibration.sampling.posterior_sample": ("PosteriorSample",),
    "mascarin.calibration.base.uncertainty": ("Uncertainty",),
    "mascarin.diagnosis.error_sources": ("Correction", "ErrorSources"),
    "mascarin.diagnosis.hypotheses": ("Cause", "Diagnosis"),
    "mascarin.sensitivity.base.factors": ("Factor",),
    "mascarin.sensitivity.base.result": ("Sensitivity",),
    "mascarin.sensitivity.salib.collection": ("MorrisSensitivity",),
    "mascarin.sensitivity.spectral.designs": ("Design",),
    "mascarin.sensitivity.spectral.result": ("SpectralSensitivity",),
    "mascarin.simulation.checks.energy": ("EnergyLedger",),
    "mascarin.simulation.single_precision": ("Difference",),
    "mascarin.study.steps.derived_quantities": ("DerivedQuantity",),
    "mascarin.study.steps.error_model": ("Unknown", "Unknowns"),
    "mascarin.study.steps.findings": ("PredictionIntervals",),
    "mascarin.validation.days": ("DayChoice", "DriverRange"),
    "mascarin.validation.residuals": ("DailyCycle", "DriverCorrelation", "ResidualAnalysis"),
}
#: Runs after which the series are kept.
_RUNS: Final = 16


def kept(
    workspace: Workspace | None, key: object, make: Callable[[], _T], known: Sequence[object] = ()
) -> _T:
    """A result of the folder, or a new one, which is kept.

    Parameters
    ----------
    workspace : Workspace or None
        The folder; None: nothing is kept.
    key : object
        All that the result depends on beside the inputs of the study; its ``repr`` counts.
    make : callable
        Computes the result.
    known : sequence of object
        Objects that may be part of the result and are not written.
    """
    if workspace is None:
        return make()
    try:
        result: _T = _read(workspace, key, known)
    except (OSError, *_UNUSABLE):
        pass  # there is none, of another version, or damaged: computed again
    else:
        return result
    made = make()
    _write(workspace, key, made, known)
    return made


def _name(key: object) -> str:
    """Name of the content of a key."""
    return f"{NAME}-{hashlib.sha256(repr(key).encode()).hexdigest()[:24]}"


def _read(workspace: Workspace, key: object, known: Sequence[object] = ()) -> Any:
    """The result of a key; raises OSError or one of `_UNUSABLE` where there is none."""
    name = _name(key)
    # The ending is that of former versions, whose files are replaced.
    notes, arrays = own_files.unpacked(own_files.read(workspace.path(f"{name}.npz"), name))
    return _decoded(notes, arrays, known)


def _write(workspace: Workspace, key: object, made: object, known: Sequence[object] = ()) -> None:
    """Keep the result of a key."""
    name, plain = _name(key), dict[str, Any]()
    tree = _encoded(made, plain, known)
    own_files.write(workspace.path(f"{name}.npz"), name, own_files.packed(tree, plain))


def written_once(workspace: Workspace, key: object, write: Callable[[], Sequence[Path]]) -> list[Path]:
    """Files that a function writes, unless they were written with the same key before.

    Parameters
    ----------
    workspace : Workspace
        The folder.
    key : object
        All that the files depend on beside the inputs of the study.
    write : callable
        Writes them.
    """
    out = workspace.out
    names = kept(workspace, ("files", key), lambda: [path.relative_to(out).as_posix() for path in write()])
    paths = [own_files.inside(out, name) for name in names]
    present = [path for path in paths if path is not None and path.is_file()]
    return present if len(present) == len(paths) else list(write())


def kept_series(
    study: StudyContext, simulation: Simulation, vectors: Array, observation: Observation | None = None
) -> Array:
    """Simulated series of parameter vectors at the instants of the comparison, each kept.

    Steps that need the same runs, such as the bands and the diagnosis, share them.

    Parameters
    ----------
    study : StudyContext
        Has the folder, if there is one.
    simulation : Simulation
        The model; its first outputs are those of the sensors.
    vectors : ndarray, shape (M, P)
        Parameter vectors. [unit of each]
    observation : Observation, optional
        Other instants than those of the study.

    Returns
    -------
    ndarray, shape (M, n, S)
        NaN for a vector with which the model cannot be run. [unit of each sensor]
    """
    seen, workspace = study.observation if observation is None else observation, study.workspace
    series = np.empty((len(vectors), *seen.measured.shape))
    times = (str(seen.times[0]), str(seen.times[-1]), len(seen.times))
    keys = [
        ("series", simulation.identity, times, hashlib.sha256(vector.tobytes()).hexdigest())
        for vector in np.ascontiguousarray(vectors)
    ]
    missing = list(range(len(keys)))
    if workspace is not None:
        missing = [k for k in missing if not _recalled(workspace, keys[k], series[k])]
    for first in range(0, len(missing), _RUNS):
        chosen = missing[first : first + _RUNS]
        records, _, _ = simulation.ensemble(np.ascontiguousarray(vectors[chosen]))
        series[chosen] = seen.simulated(simulation.index, records[..., : len(seen.names)])
        if workspace is not None:
            for k in chosen:
                _write(workspace, keys[k], series[k])
    return series


def _recalled(workspace: Workspace, key: object, series: Array) -> bool:
    """Copy a kept series into an array, and whether there is one."""
    try:
        series[...] = _read(workspace, key)
    except (OSError, *_UNUSABLE):
        return False
    return True


def _encoded(value: Any, arrays: dict[str, Any], known: Sequence[object]) -> Any:
    """Plain values for JSON; arrays go into ``arrays``."""
    for k, one in enumerate(known):
        if value is one:
            return {"known": k}
    if isinstance(value, np.ndarray):
        name = f"a{len(arrays)}"
        arrays[name] = value
        return {"array": name}
    if isinstance(value, np.generic):
        return _encoded(np.asarray(value), arrays, known) | {"scalar": True}
    if is_dataclass(value) and not isinstance(value, type):
        kind = type(value)
        if kind.__qualname__ not in CLASSES.get(kind.__module__, ()):
            raise TypeError(f"cannot keep {kind.__qualname__}: it is not in CLASSES")
        own = {f.name: _encoded(getattr(value, f.name), arrays, known) for f in fields(value) if f.init}
        return {"class": f"{kind.__module__}:{kind.__qualname__}", "fields": own}
    if isinstance(value, Mapping):
        pairs = [[_encoded(k, arrays, known), _encoded(v, arrays, known)] for k, v in value.items()]
        return {"mapping": pairs}
    if isinstance(value, tuple | list):
        word = "tuple" if isinstance(value, tuple) else "list"
        return {word: [_encoded(one, arrays, known) for one in value]}
    if isinstance(value, RunWarning):
        return {"warning": str(value), "kind": value.kind.value}
    if value is None or isinstance(value, str | bool | int | float):
        return {"value": value}
    raise TypeError(f"cannot keep {type(value).__name__}")


#: What decoding raises where a file holds another structure than that which is written now.
_UNUSABLE: Final = (ValueError, LookupError, TypeError, AttributeError)


def _decoded(tree: Any, arrays: Mapping[str, Any], known: Sequence[object]) -> Any:
    """What `_encoded` made plain."""
    match tree:
        case {"known": int(k)} if 0 <= k < len(known):
            return known[k]
        case {"array": str(name), "scalar": True}:
            return arrays[name][()]
        case {"array": str(name)}:
            return arrays[name]
        case {"class": str(where), "fields": dict(own)}:
            return _class(where)(**{name: _decoded(one, arrays, known) for name, one in own.items()})
        case {"mapping": list(pairs)}:
            return {_decoded(k, arrays, known): _decoded(v, arrays, known) for k, v in pairs}
        case {"tuple": list(items)}:
            return tuple(_decoded(one, arrays, known) for one in items)
        case {"list": list(items)}:
            return [_decoded(one, arrays, known) for one in items]
        case {"warning": str(text), "kind": str(kind)}:
            return RunWarning(text, WarningKind(kind))
        case {"value": None | str() | bool() | int() | float() as value}:
            return value
    raise ValueError("it holds something else than what is kept")


def _class(where: str) -> Any:
    """A dataclass of the list."""
    module, _, name = where.partition(":")
    if not module.startswith("mascarin."):
        raise ValueError(f"found {where}, which is not of this package")
    if name not in CLASSES.get(module, ()):
        raise TypeError(f"found {where}, which is none of the classes that are kept")
    return getattr(importlib.import_module(module), name)
