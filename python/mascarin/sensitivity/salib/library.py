"""SALib, imported when it is first used."""

from __future__ import annotations

import importlib
from typing import Any

from mascarin.errors import InputError


def salib(module: str) -> Any:
    """Import a module of SALib.

    Parameters
    ----------
    module : str
        Its name without ``SALib.``.

    Returns
    -------
    module
        The module.

    Raises
    ------
    InputError
        SALib is not installed.
    """
    try:
        return importlib.import_module(f"SALib.{module}")
    except ImportError as error:
        msg = "this method needs the package SALib: pip install 'mascarin[sensitivity]'"
        raise InputError(msg) from error
