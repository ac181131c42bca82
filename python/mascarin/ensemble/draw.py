"""Members drawn from the ranges of the parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mascarin._io import memory
from mascarin.building.parameters.set_point_pairs import tied_set_points
from mascarin.building.parameters.ties import expanded
from mascarin.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building


def latin_hypercube(
    building: Building, members: int, *, seed: int, vary: Sequence[str] | None = None
) -> pd.DataFrame:
    """Draw members evenly over the ranges of parameters (Latin hypercube).

    Parameters
    ----------
    building : Building
        The building.
    members : int
        Number of members.
    seed : int
        Seed: the same one gives the same members.
    vary : sequence of str, optional
        Paths of the parameters to draw, ``*`` for any name between two dots; default
        all that are not structural and whose range is not empty.

    Returns
    -------
    pandas.DataFrame
        A row for each member, a column for each path. [unit of each]

    Raises
    ------
    InputError
        Unknown or structural path, no members.

    References
    ----------
    McKay, Beckman & Conover (1979), Technometrics 21(2), doi:10.1080/00401706.1979.10489755.

    Examples
    --------
    >>> from mascarin.examples import box
    >>> latin_hypercube(box(), 4, seed=1, vary=["zones.room.volume"]).shape
    (4, 1)
    """
    import pandas as pd
    from scipy.stats import qmc

    if members < 1:
        raise InputError(f"members: found {members}; expected 1 or more")
    all_parameters = building.parameters()
    following = {path for candidate in all_parameters for path in candidate.members}
    chosen = (
        [building.parameter(path) for path in expanded(building, vary)]
        if vary
        else [candidate for candidate in all_parameters if candidate.path not in following]
    )
    for parameter in chosen if vary else ():
        if parameter.structural:
            raise InputError(f"{parameter.path}: is structural and not drawn; give it in a table of samples")
    tied = tied_set_points(building)
    listed = [p.path for p in chosen]
    # Equal set points are drawn once; the second one gets the values of the first.
    second = {path for path in listed if tied.get(path) in listed[: listed.index(path)]}
    free = [p for p in chosen if not p.structural and p.low < p.high and p.path not in second]
    if not free:
        raise InputError("no parameter to draw: all ranges are empty")
    memory.require(
        4.0 * 8.0 * members * len(free),  # the draw, its scrambled ranks, the table, and a copy
        f"members: {members} members of {len(free)} parameters",
        "draw fewer members, or vary fewer parameters",
    )
    unit = qmc.LatinHypercube(len(free), seed=seed).random(members)
    samples = {p.path: p.low + (p.high - p.low) * unit[:, k] for k, p in enumerate(free)}
    second_values = {tied[path]: values for path, values in samples.items() if path in tied}
    return pd.DataFrame(samples | second_values)
