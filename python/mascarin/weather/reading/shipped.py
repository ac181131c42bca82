"""Climates that come with Mascarin, compressed: typical years of the U.S. government and one measured year.

Typical meteorological years of the National Solar Radiation Data Base (TMY3), made by the National Renewable
Energy Laboratory from 1976 to 2005, as the EPW files of EnergyPlus and its weather data. They are works of
the U.S. government and in the public domain. Saint-Denis is the year 2023 as Meteo-France measured it at
Gillot, under the Licence Ouverte 2.0 (Etalab); direct and diffuse radiation (Erbs) and infrared radiation
are estimates.

References
----------
Wilcox & Marion 2008, Users Manual for TMY3 Data Sets, NREL/TP-581-43156, doi:10.2172/928611.
"""

from __future__ import annotations

import lzma
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from mascarin.errors import InputError, did_you_mean

FOLDER: Final = Path(__file__).parents[1] / "climates"
PREFIX: Final = "shipped:"
"""What stands before the name of a shipped climate where a weather file is named."""
COMPRESSED: Final = ".xz"
"""Ending of a shipped file: an EPW file that the program ``xz`` compressed."""


@dataclass(frozen=True)
class ShippedClimate:
    """A climate that comes with Mascarin.

    Attributes
    ----------
    name : str
        Its name, such as ``tampa``.
    file : str
        Name of the EPW file.
    climate : str
        Kind of climate, in words, with its class by Koeppen.
    sha256 : str
        SHA-256 of the EPW file, in hexadecimal.

    Examples
    --------
    >>> SHIPPED["tampa"].file
    'USA_FL_Tampa.Intl.AP.722110_TMY3.epw'
    """

    name: str
    file: str
    climate: str
    sha256: str

    @property
    def path(self) -> Path:
        """The compressed file."""
        return FOLDER / f"{self.file}{COMPRESSED}"


_ALL: Final = (
    ShippedClimate(
        "saint-denis", "REU_Saint-Denis-Gillot_2023_AMY.epw",
        "tropical, by the sea, south of the equator (Aw); measured 2023, Meteo-France, Licence Ouverte 2.0",
        "57123dd3e18e650db813e955f0880541f71d52adb94ac7c2a770037a505cb8be",
    ),
    ShippedClimate(
        "tampa", "USA_FL_Tampa.Intl.AP.722110_TMY3.epw", "hot and humid (Cfa, subtropical)",
        "70bfcdf8a79b9df57f062e0ba94cda9b9316ea53e3c1130a24b6c230eec90c45",
    ),
    ShippedClimate(
        "tucson", "USA_AZ_Davis-Monthan.AFB.722745_TMY3.epw", "hot and dry, with rain in late summer (BSh)",
        "157b17debef93ca3e165d428ba8da60aa6f200ca5c5e671b40461d6fb844636d",
    ),
    ShippedClimate(
        "golden", "USA_CO_Golden-NREL.724666_TMY3.epw", "dry, sunny and high, with cold winters (BSk)",
        "65041e11615dac66cfac8b2e3f83ea0297f42f20fc90ef3723a8241153a62e0b",
    ),
    ShippedClimate(
        "san-francisco", "USA_CA_San.Francisco.Intl.AP.724940_TMY3.epw", "temperate by the sea (Csb)",
        "b69e012e7ff8a5d3e610a19acc1ceb84926feae1f4347192b9388459423bf29c",
    ),
    ShippedClimate(
        "washington", "USA_VA_Sterling-Washington.Dulles.Intl.AP.724030_TMY3.epw",
        "temperate, with humid summers (Cfa)",
        "d7d536f2be36311348bc2f888ff8dafbea40591c2d114463240427776ea1fa56",
    ),
    ShippedClimate(
        "chicago", "USA_IL_Chicago-OHare.Intl.AP.725300_TMY3.epw", "continental: cold winters, warm summers "
        "(Dfa)", "3cc3dc0c7bcc93e7203e8d9aab657d384315f5a0c86cdede23f792d437a0309f",
    ),
)  # fmt: skip

SHIPPED: Final = {climate.name: climate for climate in _ALL}
"""The shipped climates by name."""


def found(path: str | Path) -> Path:
    """The file of a path, or of the name of a shipped climate.

    Parameters
    ----------
    path : str or Path
        A path, or ``shipped:NAME``.

    Returns
    -------
    Path
        The path as it is, or the compressed file.

    Raises
    ------
    InputError
        There is no such shipped climate.

    Examples
    --------
    >>> found("shipped:tampa").name
    'USA_FL_Tampa.Intl.AP.722110_TMY3.epw.xz'
    """
    text = str(path)
    if not text.startswith(PREFIX):
        return Path(path)
    name = text.removeprefix(PREFIX)
    if name not in SHIPPED:
        raise InputError(
            f"{text}: found no shipped climate '{name}'; expected a name that 'mascarin weather' lists. "
            f"{did_you_mean(name, SHIPPED)}".rstrip()
        )
    return SHIPPED[name].path


def content(path: Path) -> bytes:
    """The bytes of a weather file, decompressed where its name ends in ``.xz``.

    Parameters
    ----------
    path : Path
        The file, which is there.

    Returns
    -------
    bytes
        Its content.

    Raises
    ------
    InputError
        It is no complete compressed file.

    Examples
    --------
    >>> content(found("shipped:tampa"))[:14]
    b'LOCATION,Tampa'
    """
    if path.suffix.lower() != COMPRESSED:
        return path.read_bytes()
    try:
        return lzma.decompress(path.read_bytes())
    except (lzma.LZMAError, EOFError) as error:
        raise InputError(
            f"{path}: found no complete xz file ({error}); expected a compressed EPW file"
        ) from None
