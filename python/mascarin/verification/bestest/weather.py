"""The weather of Standard 140: reading the file and recognizing it."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin.errors import InputError
from mascarin.weather.reading.data import data_file

if TYPE_CHECKING:
    from mascarin.weather import Climate

FINGERPRINT: Final = "33dade78c566d0930e6b9e92b76bdb279853a01277d0d326ee77ab6df47fcf8a"
"""SHA-256 of the numbers of 8760 hours. Files that differ only in their header have the same one."""
NAME: Final = "725650TYCST.epw"
WHERE: Final = (
    "It is 725650TYCST.epw: Denver International Airport, TMY3, station 725650. It comes with the standard's "
    "accompanying files and with NREL's BESTEST-GSR (github.com/NREL/BESTEST-GSR)"
)
"""Where to get the file."""
_FIRST, _LAST = 6, 23  # dry bulb to opaque sky cover
_HEADER: Final = 8


def read(file: Path | None) -> Climate:
    """Read the weather, and refuse other files than that of the standard.

    Parameters
    ----------
    file : Path or None
        The EPW file; None: that of the data folder or the cache, else it is downloaded.

    Returns
    -------
    Climate

    Raises
    ------
    InputError
        It cannot be read or downloaded, or it has other weather.
    """
    from mascarin.weather import Climate

    if file is None:
        try:
            file = data_file(NAME)
        except InputError as error:
            raise InputError(
                f"--weather: not given; expected the standard's weather file. {WHERE}. {error}"
            ) from None
    if not file.is_file():
        raise InputError(f"--weather: found no file '{file}'; expected the standard's weather file. {WHERE}.")
    climate = Climate.from_epw(file, typical=True)
    digest = fingerprint(file)
    if digest != FINGERPRINT:
        location = climate.site.name if climate.site is not None else "an unknown place"
        raise InputError(
            f"--weather: found '{file}', weather of {location} (fingerprint {digest[:12]}); expected that of "
            f"the standard (fingerprint {FINGERPRINT[:12]}), for which the programs were run. {WHERE}."
        )
    return climate


def fingerprint(file: Path) -> str:
    """Compute SHA-256 of the numbers of an EPW file, hour by hour, without header, years and flags."""
    digest = hashlib.sha256()
    for line in file.read_text(encoding="latin-1").splitlines()[_HEADER:]:
        fields = line.split(",")
        digest.update(",".join(f"{float(field):.6g}" for field in fields[_FIRST : _LAST + 1]).encode())
        digest.update(b"\n")
    return digest.hexdigest()
