"""Memory of this process: what is left, and refusals before anything large is allocated."""

from __future__ import annotations

import contextlib
import gc
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from mascarin.errors import InputError

#: Part of the free memory that one calculation may plan to take; the rest is for what cannot be estimated.
SHARE: Final = 0.8
#: Files of Linux that state the limit and the use of a group of processes, in the order of versions 2 and 1.
_GROUPS: Final = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
    ("/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes"),
)


def available() -> int | None:
    """Memory that this process can still take; None where the system does not say.

    Returns
    -------
    int or None
        The least of the free memory of the machine, of what is left of the limit of a group of processes
        (containers), and of what is left of the limit of the process (``ulimit -v``). [B]
    """
    limits = [
        limit
        for limit in (_machine(), *(_group(*files) for files in _GROUPS), _process())
        if limit is not None
    ]
    return min(limits, default=None)


def require(size: float, what: str, advice: str) -> None:
    """Refuse a calculation that would take more memory than there is.

    Parameters
    ----------
    size : float
        What it would take. [B]
    what : str
        What takes it, with its numbers: the beginning of the message.
    advice : str
        What to change.

    Raises
    ------
    InputError
        With what it would take, what there is, and what to change.
    """
    # Small ones are not worth reading files of the system.
    if size < 64 * 2**20:
        return
    free = available()
    if free is not None and size > SHARE * free:
        raise InputError(
            f"{what} would take {amount(size)} of memory, but {amount(free)} are free, of which one "
            f"calculation may take {SHARE * 100:.0f} %; {advice}"
        )


def amount(size: float) -> str:
    """A size in words, such as ``7.3 GB``."""
    for unit, factor in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if size >= factor:
            return f"{size / factor:.3g} {unit}" if size < 1000 * factor else f"{size / factor:.0f} {unit}"
    return f"{size / 1e3:.0f} kB"


@contextlib.contextmanager
def uncollected() -> Iterator[None]:
    """Keep Python from looking for circles of objects meanwhile; a decorator of functions, too.

    A description becomes hundreds of thousands of objects that all stay. Each search for circles among them
    goes through all again, which takes as long as what is done with them.
    """
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()


def _machine() -> int | None:
    with contextlib.suppress(OSError, ValueError):
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    if sys.platform != "win32":
        # Without /proc (macOS) only the whole memory is known.
        with contextlib.suppress(OSError, ValueError):
            return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return None


def _group(limit: str, use: str) -> int | None:
    try:
        most = int(Path(limit).read_text(encoding="ascii"))
        return max(most - int(Path(use).read_text(encoding="ascii")), 0)
    except (OSError, ValueError):  # no such group, or the limit is "max"
        return None


def _process() -> int | None:
    if sys.platform == "win32":
        return None
    import resource

    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    if most == resource.RLIM_INFINITY:
        return None
    used = 0
    with contextlib.suppress(OSError, ValueError):
        used = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * os.sysconf(
            "SC_PAGE_SIZE"
        )
    return max(most - used, 0)
