"""Public names of a package, imported when they are first used."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import lazy_loader  # type: ignore[import-untyped]

from mascarin._io.memory import uncollected


def attached(package: str, file: str) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """``__getattr__``, ``__dir__`` and ``__all__`` of a package, from the stub beside its file.

    Imported modules stay in memory: Python does not look for circles among their objects meanwhile.

    Parameters
    ----------
    package : str
        Its name.
    file : str
        Its ``__init__.py``.
    """
    attribute, names, public = lazy_loader.attach_stub(package, file)
    return uncollected()(attribute), names, public
