"""Writes a unit for co-simulation: an archive with library, building, weather and model description."""

from __future__ import annotations

import hashlib
import uuid
import zipfile
from collections.abc import Sequence
from importlib.resources import files as package_files
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

from mascarin import __version__, _engine
from mascarin._io import atomic
from mascarin.errors import InputError
from mascarin.fmu.contents import packed, run_json
from mascarin.fmu.inputs import chosen_inputs, global_follows
from mascarin.fmu.model_description import LIBRARY, Model, fmi2, fmi3
from mascarin.fmu.variables import Variable, variables_of
from mascarin.simulation.preparation.step_sequence import require_equal_steps

if TYPE_CHECKING:
    from mascarin.simulation import Simulation

Version = Literal["3.0", "2.0"]
VERSIONS: Final[tuple[Version, ...]] = ("3.0", "2.0")
"""Versions of the Functional Mock-up Interface."""

#: Folders of the libraries by architecture and system of Rust: that of version 3.0, and that of version 2.0.
_PLATFORMS: Final = {
    ("x86_64", "linux"): ("x86_64-linux", "linux64"),
    ("aarch64", "linux"): ("aarch64-linux", None),
    ("x86_64", "macos"): ("x86_64-darwin", "darwin64"),
    ("aarch64", "macos"): ("aarch64-darwin", None),
    ("x86_64", "windows"): ("x86_64-windows", "win64"),
}
#: Every archive of the same run has the same bytes.
_DATE: Final = (1980, 1, 1, 0, 0, 0)


def export(
    simulation: Simulation,
    path: str | Path,
    *,
    inputs: Sequence[str] = (),
    parameters: Sequence[str] | None = None,
    version: Version = "3.0",
) -> None:
    """Write a run as a unit for co-simulation (FMU), which appears when it is complete.

    The unit contains the engine as a library for the present system. Without inputs it gives the outputs of
    the run, to the bit.

    Parameters
    ----------
    simulation : Simulation
        The run: its outputs are those of the unit, its step is the internal step.
    path : str or Path
        The file; one that exists is replaced.
    inputs : sequence of str
        Names or patterns of what the importing program sets, such as ``weather.air_temperature`` or
        ``schedules.*``. All else is taken from the tables of the run.
    parameters : sequence of str, optional
        Paths or patterns of the parameters that can be set before a run. Default: all.
    version : str
        Version of the Functional Mock-up Interface: ``3.0`` or ``2.0``.

    Raises
    ------
    InputError
        A name that fits nothing, an output or input that a unit cannot have, another version or system.

    Examples
    --------
    >>> import tempfile
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> simulation = mc.Simulation(box(), box_climate(), step="1h", outputs=["room.air_temperature"])
    >>> unit = Path(tempfile.mkdtemp()) / "box.fmu"
    >>> export(simulation, unit, inputs=["weather.air_temperature"])
    >>> sorted(zipfile.ZipFile(unit).namelist())[-1]
    'resources/run.json'
    """
    if version not in VERSIONS:
        raise InputError(f"--fmi: found '{version}', expected one of {', '.join(VERSIONS)}")
    require_equal_steps(simulation.sequence, "a unit for co-simulation: its importing program steps it")
    library = _library(version)
    channels = chosen_inputs(simulation, inputs)
    variables = variables_of(simulation, channels, parameters)
    resources = {
        "resources/building.json": simulation.compiled.description.encode(),
        "resources/forcing.bin": packed(simulation.compiled.forcing),
    }
    token = _token(simulation, resources, variables)
    resources["resources/run.json"] = run_json(
        simulation, variables, token, global_follows=global_follows(channels)
    )
    model = Model(
        name=simulation.building.name,
        description=_words(simulation),
        token=token,
        step=simulation.step_seconds,
        stop=len(simulation.compiled.forcing) * simulation.step_seconds,
        variables=variables,
    )
    described = fmi3(model) if version == "3.0" else fmi2(model)
    licenses = package_files("mascarin").joinpath("LICENSES.txt").read_bytes()
    files = {
        "modelDescription.xml": described,
        **library,
        "documentation/licenses/license.txt": licenses,
        **resources,
    }
    # No seals as in `_io.own_files`: each entry has the checksum of the archive, a unit is a result for
    # programs of others, which unpack it and may set start values in its description, and the library
    # compares its resources with their format, sizes and names (`crates/contents`).
    with atomic.replacing(Path(path)) as target, zipfile.ZipFile(target, "w") as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, _DATE)
            # A library is a program.
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED, compresslevel=9)


def _library(version: Version) -> dict[str, bytes]:
    """The library of this system, by its place in the unit."""
    content, suffix, machine, system = _engine.fmu_library()
    folders = _PLATFORMS.get((machine, system), (None, None))
    folder = folders[VERSIONS.index(version)]
    if folder is None:
        other = " FMI 3.0 has one: leave --fmi out." if folders[0] is not None else ""
        raise InputError(
            f"--fmi: FMI {version} has no place for a library for {machine} and {system}, expected a system "
            f"that it names.{other}"
        )
    if not content:
        raise InputError(
            "mascarin._engine: found no library for units in this build, expected one; build with "
            "'make build' or install a wheel"
        )
    return {f"binaries/{folder}/{LIBRARY}{suffix}": content}


def _token(simulation: Simulation, files: dict[str, bytes], variables: Sequence[Variable]) -> str:
    """A name of the content: equal for equal units, and different for all others."""
    digest = hashlib.sha256(__version__.encode())
    for content in files.values():
        digest.update(content)
    digest.update(repr(simulation.compiled.settings).encode())
    digest.update(repr([variable.plain() for variable in variables]).encode())
    return "{" + str(uuid.UUID(bytes=digest.digest()[:16])) + "}"


def _words(simulation: Simulation) -> str:
    return (
        f"{simulation.building.name}, {simulation.start:%Y-%m-%d %H:%M} to {simulation.end:%Y-%m-%d %H:%M} "
        f"({simulation.compiled.timezone}), internal step {simulation.step_seconds:g} s"
    )
