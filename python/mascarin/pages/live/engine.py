"""The engine as a module for browsers (WebAssembly), which `make build` puts beside this file."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Final

from mascarin.errors import InputError

FILE: Final = "engine.wasm"
"""Its name. It is compiled, and no part of the repository."""
_REMEDY: Final = "rustup target add wasm32-unknown-unknown && make build"


def read() -> bytes:
    """The module, from its file.

    Returns
    -------
    bytes
        WebAssembly.

    Raises
    ------
    InputError
        This installation was built without it.
    """
    file = files("mascarin").joinpath("pages", "live", FILE)
    if not file.is_file():
        raise InputError(
            f"mascarin/pages/live/{FILE}: found no engine for browsers in this installation, expected the "
            f"one of a wheel from PyPI; install a wheel, or in a copy of the repository: {_REMEDY}"
        )
    return file.read_bytes()


module = cache(read)
"""The same, read once."""
