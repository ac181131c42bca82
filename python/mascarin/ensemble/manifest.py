"""The manifest of an ensemble, read with its types: it may be damaged, or come from someone else.

It has no seal, because people and their scripts read it as JSON. It holds names, units and hashes; a store
whose hashes differ is not continued, the numbers of the members are in sealed pieces and checked pages.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from mascarin._io.sealed import own_files
from mascarin.errors import InputError
from mascarin.simulation.checks.warning_kinds import with_kinds

_TYPES: Final[dict[str, type | tuple[type, ...]]] = {
    "mascarin_version": str,
    "building": str,
    "identity": str,
    "samples": str,
    "members": int,
    "paths": list,
    "sample_units": dict,
    "outputs": list,
    "objectives": list,
    "kept": dict,
    "step_seconds": (int, float),
    "scheme": str,
    "precision": str,
    "timezone": str,
    "time": list,
    "complete": bool,
    "single_precision": dict,
    "warnings": list,
    "warning_kinds": list,
}
#: Keys that former versions did not write, or that are written at the end.
_FURTHER: Final = ("sample_units", "precision", "single_precision", "warnings", "warning_kinds")
_LISTS: Final = ("paths", "outputs", "objectives", "time", "warnings", "warning_kinds")
_DIFFERENCE: Final[dict[str, type | tuple[type, ...]]] = {
    "unit": str, "rms": (int, float), "largest": (int, float), "members": int,
}  # fmt: skip
#: Most members that a manifest may claim.
_MOST: Final = 2**40


def read(file: Path) -> dict[str, Any]:
    """Read a manifest.

    Parameters
    ----------
    file : Path
        The file.

    Returns
    -------
    dict
        Its entries.

    Raises
    ------
    InputError
        There is none, or it is damaged.
    """
    try:
        manifest = own_files.read_json(file)
        _check(manifest)
    except (OSError, own_files.DamagedError) as error:
        raise InputError(
            f"{file}: found no readable manifest ({error}); expected the folder of an ensemble, as "
            "sweep_into() or 'mascarin sweep --out' makes it. If it was one, remove it and run it again"
        ) from None
    return manifest


def _check(manifest: dict[str, Any]) -> None:
    own_files.require(manifest, _TYPES, further=_FURTHER)
    if not 1 <= manifest["members"] <= _MOST:
        raise own_files.DamagedError(f"members: found {manifest['members']}")
    for key in _LISTS:
        if not all(isinstance(text, str) for text in manifest.get(key, [])):
            raise own_files.DamagedError(f"{key}: found something else than texts")
    try:
        with_kinds(manifest.get("warnings", ()), manifest.get("warning_kinds"))
    except ValueError as error:
        raise own_files.DamagedError(f"warning_kinds: {error}") from None
    for key in ("kept", "sample_units"):
        if not all(isinstance(text, str) for text in manifest.get(key, {}).values()):
            raise own_files.DamagedError(f"{key}: found something else than texts")
    for values in manifest.get("single_precision", {}).values():
        own_files.require(values if isinstance(values, dict) else {}, _DIFFERENCE)
        if set(values) != set(_DIFFERENCE):
            raise own_files.DamagedError("single_precision: found other keys")
