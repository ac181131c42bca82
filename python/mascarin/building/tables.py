"""The table of parameters of a building."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from mascarin.building.building import Building


def parameter_table(building: Building) -> list[dict[str, Any]]:
    """Parameters of a building as rows.

    Parameters
    ----------
    building : Building
        The building.

    Returns
    -------
    list of dict
        One entry for each attribute of `Parameter`.

    Examples
    --------
    >>> from mascarin import examples
    >>> import mascarin as mc
    >>> rows = parameter_table(mc.load(examples.FOLDER / "lgi" / "building.yaml"))
    >>> rows[0]["path"]
    'site.latitude'
    """
    return [asdict(parameter) for parameter in building.parameters()]
