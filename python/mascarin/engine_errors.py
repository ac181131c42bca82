"""Descriptions compiled by the engine, and its errors as errors of Mascarin."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache

from mascarin import _engine
from mascarin.errors import InputError, SolverError


@contextmanager
def translated(dated: Callable[[str], str] = str) -> Iterator[None]:
    """Turn errors of the engine into `InputError` and `SolverError`.

    Parameters
    ----------
    dated : callable, optional
        Adds the time to a message that names a step.

    Raises
    ------
    InputError
        The engine refuses what it was given.
    SolverError
        The engine found no solution.
    """
    try:
        yield
    except _engine.EngineInputError as error:
        raise InputError(str(error)) from None
    except _engine.EngineSolverError as error:
        raise SolverError(dated(str(error))) from None


@lru_cache(maxsize=2)
def plan_of(description: str) -> _engine.Plan:
    """The engine's form of a description; check and run of a building use the same one.

    Parameters
    ----------
    description : str
        The building as the engine reads it, JSON.

    Raises
    ------
    InputError
        The engine refuses it.
    """
    with translated():
        return _engine.Plan(description)
