"""Objectives and executors that can travel to other processes."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import xarray as xr

from mascarin import _engine

JOINT = "wall.interface_1_temperature"


def warmest(run: xr.Dataset) -> xr.DataArray:
    return run[JOINT].max("time")


def coldest(run: xr.Dataset) -> xr.DataArray:
    return run[JOINT].min("time")


def deadly(run: xr.Dataset) -> xr.DataArray:
    """Kills its process, once."""
    mark = Path(os.environ["MASCARIN_TEST_MARK"])
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return warmest(run)


def always_deadly(run: xr.Dataset) -> xr.DataArray:
    os.kill(os.getpid(), signal.SIGKILL)
    return warmest(run)


class Forgetful(Executor):
    """Runs each chunk at once, and loses every third one."""

    def __init__(self) -> None:
        self.given = 0

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given += 1
        future: Future[Any] = Future()
        if self.given % 3 == 0:
            future.set_exception(BrokenProcessPool("a worker is gone"))
        else:
            try:
                future.set_result(fn(*args, **kwargs))
            except Exception as error:
                future.set_exception(error)
        return future


def panicking(run: xr.Dataset) -> xr.DataArray:
    """Fails as a panic of the engine does."""
    _engine._panic("a defect of the engine")
    return run["room.air_temperature"].max("time")
