"""Results of a step kept in the folder of the study as plain arrays and texts, so that it is not repeated.

Dataclasses of this package are kept field by field. What was known before (a calibration problem with its
model) is kept as a reference. Nothing that is read can run code: there are only arrays, texts and names of
dataclasses.
"""

from __future__ import annotations

import hashlib
import importlib
import io
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar
from zipfile import BadZipFile

import numpy as np

from mascarin._io import atomic

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.simulation.simulation import Simulation
    from mascarin.study.setup import Setup
    from mascarin.study.storage import Workspace
    from mascarin.validation.observation import Observation

    Array = npt.NDArray[np.float64]

_T = TypeVar("_T")

#: Results are dropped when the study is done.
NAME: Final = "kept"
_PACKAGE: Final = "mascarin."
#: Runs of which the series are kept together.
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
    path = workspace.path(f"{NAME}-{hashlib.sha256(repr(key).encode()).hexdigest()[:24]}.npz")
    if path.exists():
        try:
            with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as stored:
                arrays = {name: stored[name] for name in stored.files}
            tree = json.loads(bytes(arrays.pop("tree")).decode())
            found: _T = _decoded(tree, arrays, known)
        except (ValueError, OSError, KeyError, TypeError, AttributeError, EOFError, BadZipFile):
            path.unlink()  # of another version, or incomplete
        else:
            return found
    made = make()
    arrays = {}
    text = json.dumps(_encoded(made, arrays, known))
    buffer = io.BytesIO()
    np.savez(buffer, tree=np.frombuffer(text.encode(), dtype=np.uint8), **arrays)
    atomic.write(path, buffer.getvalue())
    return made


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
    names = kept(workspace, ("files", key), lambda: [str(path) for path in write()])
    paths = [Path(name) for name in names]
    return paths if all(path.is_file() for path in paths) else list(write())


def kept_series(
    study: Setup, simulation: Simulation, vectors: Array, observation: Observation | None = None
) -> Array:
    """Simulated series of parameter vectors at the instants of the comparison, kept in pieces.

    Parameters
    ----------
    study : Setup
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
    seen = study.observation if observation is None else observation
    sensors, parts = len(seen.names), []
    for first in range(0, len(vectors), _RUNS):
        chosen = np.ascontiguousarray(vectors[first : first + _RUNS])

        def make(chosen: Array = chosen) -> Array:
            records, _, _ = simulation.ensemble(chosen)
            return seen.simulated(simulation.index, records[..., :sensors])

        times = (str(seen.times[0]), str(seen.times[-1]), len(seen.times))
        key = ("series", simulation.identity, times, hashlib.sha256(chosen.tobytes()).hexdigest())
        parts.append(kept(study.workspace, key, make))
    return np.concatenate(parts)


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
        own = {f.name: _encoded(getattr(value, f.name), arrays, known) for f in fields(value) if f.init}
        return {"class": f"{kind.__module__}:{kind.__qualname__}", "fields": own}
    if isinstance(value, Mapping):
        pairs = [[_encoded(k, arrays, known), _encoded(v, arrays, known)] for k, v in value.items()]
        return {"mapping": pairs}
    if isinstance(value, tuple | list):
        word = "tuple" if isinstance(value, tuple) else "list"
        return {word: [_encoded(one, arrays, known) for one in value]}
    if value is None or isinstance(value, str | bool | int | float):
        return {"value": value}
    raise TypeError(f"cannot keep {type(value).__name__}")


def _decoded(tree: Any, arrays: Mapping[str, Any], known: Sequence[object]) -> Any:
    """What `_encoded` made plain."""
    match tree:
        case {"known": k}:
            return known[k]
        case {"array": name, "scalar": True}:
            return arrays[name][()]
        case {"array": name}:
            return arrays[name]
        case {"class": where, "fields": own}:
            return _class(where)(**{name: _decoded(one, arrays, known) for name, one in own.items()})
        case {"mapping": pairs}:
            return {_decoded(k, arrays, known): _decoded(v, arrays, known) for k, v in pairs}
        case {"tuple": items}:
            return tuple(_decoded(one, arrays, known) for one in items)
        case {"list": items}:
            return [_decoded(one, arrays, known) for one in items]
        case {"value": value}:
            return value
    raise ValueError(f"found {tree!r}")


def _class(where: str) -> Any:
    """A dataclass of this package by its name."""
    module, _, name = where.partition(":")
    if not module.startswith(_PACKAGE):
        raise ValueError(f"found {where}")
    kind = getattr(importlib.import_module(module), name)
    if not (isinstance(kind, type) and is_dataclass(kind)):
        raise TypeError(f"found {where}")
    return kind
