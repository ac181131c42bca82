"""Known data files: in a folder of the user, in the cache, or from their public source.

A file is looked for in the folder that `MASCARIN_DATA` names, where it is taken as it is, then in the cache
folder of the user, then it is downloaded to the cache. Files in the cache have the SHA-256 that is written
here; pooch checks it.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from mascarin._io.sealed.cache import cache_folder
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import pooch

FOLDER: Final = "MASCARIN_DATA"
"""Environment variable with the folder to look in first."""


@dataclass(frozen=True)
class DataFile:
    """A file that is known by name.

    Attributes
    ----------
    path : str
        Where it lies inside a data folder.
    sha256 : str
        Hash of its bytes.
    origin : str
        Who made it, and under which license.
    url : str or None
        Where it can be downloaded; None for tables that were derived from several sources.
    """

    path: str
    sha256: str
    origin: str
    url: str | None = None

    @property
    def name(self) -> str:
        """Name without the folder."""
        return self.path.rsplit("/", 1)[-1]


_RAW: Final = "https://raw.githubusercontent.com"

FILES: Final = (
    DataFile(
        "wall_bench/wall_bench_2024.csv",
        "9c70f6f21b1b7b56656df60946e837c9fc956e9f00b6a88aef3935fef4f63e93",
        "Wall test setup at Anglet (France), September 2024, 1 min; corrai, BSD-3-Clause type licence",
        f"{_RAW}/BuildingEnergySimulationTools/corrai/741ac972c8e3a1d62b3c713389f5c530486dd42e"
        "/tutorials/resources/tuto_data_SA.csv",
    ),
    DataFile(
        "twinhouse/twinhouse_O5_exp1.csv",
        "814f6756eb567b2277cd2ec3529cc1978996f71c963dc7172669e199b40cb69c",
        "Twin House O5 at Holzkirchen (Germany), August and September 2013, 10 min; Fraunhofer IBP, "
        "doi:10.15129/8a86bbbb-7be8-4a87-be76-0372985ea228, carried by open-ideas/IDEAS (BSD-3-Clause), as "
        "one table",
    ),
    DataFile(
        "twinhouse/twinhouse_N2_exp1.csv",
        "e20c9a96fcac166ad053e34bb4a1d86e4e9c62faca711954e84ac9b8e67dc565",
        "Twin House N2 at Holzkirchen (Germany), August and September 2013, 10 min; Fraunhofer IBP, "
        "doi:10.15129/8a86bbbb-7be8-4a87-be76-0372985ea228, carried by open-ideas/IDEAS (BSD-3-Clause), as "
        "one table",
    ),
    DataFile(
        "weather/gillot_2023_meteo_france.csv",
        "4bc1d1e3dace763a92590536ecc5c39e27362187139d58153eaea5a360b56f8c",
        "Gillot airport (Reunion Island), hourly, 2023; Meteo-France open data",
        f"{_RAW}/MeteoR-OI/bd-climato/a637e5b76383e4df4b25db36ee8b0f102a4aec8c/doc/meteoFR/gilot-sample.csv",
    ),
    DataFile(
        "bestest/725650TYCST.epw",
        "1d0402144460a26265555a18a9cdfe4f0f7d9b4f57d6194847af7959b518571f",
        "Denver, weather of ASHRAE 140-2020; NREL/BESTEST-GSR",
        f"{_RAW}/NREL/BESTEST-GSR/c82e3718e256e18e404629807b4398b42b7e1639/shared_resources/725650TYCST.epw",
    ),
    DataFile(
        "weather/REU_Saint-Denis-Gillot_2023_AMY.epw",
        "57123dd3e18e650db813e955f0880541f71d52adb94ac7c2a770037a505cb8be",
        "Gillot airport, 2023, as EPW; derived from the Meteo-France record, diffuse part and infrared "
        "estimated",
    ),
    DataFile(
        "bestest/std140_2020_reference.csv",
        "5ea2f4328316fcae36061234854ec055947ba00b90c4740009c1b025fd26ca21",
        "Example results of ASHRAE 140-2020; derived from RESULTS5-2A of NREL/BESTEST-GSR",
    ),
    DataFile(
        "pcm/pcm_products.csv",
        "5da6370a5951b3779893067b188f2cb6f878563b55c9ea60f56284f031fd8a92",
        "Commercial PCM; evaluated from slPCMlib (AIT-TES), BSD-3-Clause",
    ),
    DataFile(
        "pcm/pcm_curves_8_60C.csv",
        "b64160973fed85b53aa42052a6c18b703908c53e63d76acec2b4d26c5b2f3962",
        "Curves of commercial PCM, 8 to 60 degC; evaluated from slPCMlib (AIT-TES), BSD-3-Clause",
    ),
)
"""The files known by name."""


def data_file(name: str) -> Path:
    """Path of a known data file, downloaded if need be.

    Parameters
    ----------
    name : str
        File name, with or without its folder: `wall_bench_2024.csv`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        The name is not known, or the file was not found and cannot be downloaded.
    """
    entry = _entry_of(name)
    folder = os.environ.get(FOLDER)
    if folder:
        for candidate in (Path(folder) / entry.path, Path(folder) / entry.name):
            if candidate.is_file():
                return candidate
    cache, looked = registry(), f"{FOLDER}={folder}" if folder else f"{FOLDER} is not set"
    remedy = f"set {FOLDER} to a folder that holds {entry.path}"
    if entry.url is None:
        cached = cache_folder() / entry.path
        if cached.is_file() and _hash(cached) == entry.sha256:
            return cached
        raise InputError(
            f"data:{entry.name}: not found ({looked}; cache {cache_folder()}), and it cannot be downloaded "
            f"({entry.origin}); {remedy}."
        )
    try:
        return Path(cache.fetch(entry.path))
    except (OSError, ValueError) as error:
        raise InputError(
            f"data:{entry.name}: cannot be downloaded from {entry.url} ({error}); {remedy}."
        ) from error


def registry() -> pooch.Pooch:
    """The known files as a registry of pooch, in the cache folder of the user."""
    import pooch

    return pooch.create(
        path=cache_folder(),
        base_url="",
        registry={entry.path: f"sha256:{entry.sha256}" for entry in FILES},
        urls={entry.path: entry.url for entry in FILES if entry.url is not None},
    )


def _entry_of(name: str) -> DataFile:
    path = name.replace("\\", "/")
    for entry in FILES:
        if path in (entry.path, entry.name):
            return entry
    hint = did_you_mean(path.rsplit("/", 1)[-1], [entry.name for entry in FILES])
    raise InputError(f"data:{name}: no such data set. {hint}".rstrip())


def _hash(path: Path) -> str:
    import pooch

    return str(pooch.file_hash(str(path)))
