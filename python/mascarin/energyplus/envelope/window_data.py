"""Reports of the program WINDOW 5 in the form that EnergyPlus reads (Construction:WindowDataFile)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from mascarin._io.regular import require_regular
from mascarin.energyplus.model.idf import IdfObject

#: Surface resistances that a conductance of the file does not contain (EN 673) [m2 K/W].
_FILMS: Final = 0.17
_MM: Final = 1e-3
_GASES: Final = ("air", "argon", "krypton", "xenon")


@dataclass(frozen=True)
class DataFile:
    """The first glazing system of a data file.

    Attributes
    ----------
    file : str
        Name of the file.
    systems : int
        Number of glazing systems of the window.
    panes : list of dict
        As in a description, without optics.
    gaps : list of (float, str)
        Thickness and gas. [m]
    angular : dict
        Optics of the whole glazing by angle.
    frame : tuple of float or None
        Width [m], U value [W/(m2 K)], solar absorptance and emissivity [-].
    dividers : bool
        Whether it has dividers.
    """

    file: str
    systems: int
    panes: list[dict[str, Any]]
    gaps: list[tuple[float, str]]
    angular: dict[str, Any]
    frame: tuple[float, float, float, float] | None
    dividers: bool


def read_data_file(item: IdfObject, folder: Path) -> DataFile:
    """Read the window of a ``Construction:WindowDataFile``.

    Parameters
    ----------
    item : IdfObject
        The construction; it names the file and the window.
    folder : Path
        Folder of the model, in which a relative path is looked up.

    Raises
    ------
    InputError
        The file or the window is missing, or cannot be read.
    """
    named = item.text("file_name") or "Window5DataFile.dat"
    path = Path(named.replace("\\", "/"))
    report = next(
        (candidate for candidate in (folder / path, folder / path.name) if candidate.is_file()), None
    )
    if report is None:
        raise item.error(
            f"file_name: found no file '{named}'", f"a report of WINDOW in {folder}", "Put it there"
        )
    require_regular(report)
    lines = report.read_text(encoding="latin-1").splitlines()
    windows = [k for k, line in enumerate(lines) if line.startswith("Window name")]
    window_name = item.name.casefold()
    start = next((k for k in windows if lines[k].partition(":")[2].strip().casefold() == window_name), None)
    if start is None:
        window_names = ", ".join(lines[k].partition(":")[2].strip() for k in windows)
        raise item.error(
            f"no window '{item.name}' in {report.name}", f"one of {window_names}", "Correct the name"
        )
    end = next((k for k in windows if k > start), len(lines))
    try:
        return _window(report.name, lines[start:end])
    except (StopIteration, IndexError, ValueError):
        raise item.error(
            f"{report.name}: a window that cannot be read", "a report of WINDOW 5", "Export it again"
        ) from None


def _window(file: str, lines: list[str]) -> DataFile:
    systems = int(_value(lines, "# Glazing Systems").split()[0])
    count = int(_row(lines, "GLAZING SYSTEM DATA")[2])
    panes = list(_panes(lines, count))
    gaps = list(_gaps(lines, count - 1))
    frame = next((line for line in lines if line.strip().startswith("Average frame")), None)
    divider = _row(lines, "DIVIDER DATA") if any(row.startswith("DIVIDER DATA") for row in lines) else []
    return DataFile(
        file,
        systems,
        panes,
        gaps,
        _angular(lines, count),
        _frame(frame),
        bool(divider) and float(divider[0]) > 0.0,
    )


def _value(lines: list[str], key: str) -> str:
    return next(line.partition(":")[2].strip() for line in lines if line.startswith(key))


def _after(lines: list[str], key: str) -> int:
    return next(k for k, line in enumerate(lines) if line.startswith(key)) + 1


def _row(lines: list[str], key: str) -> list[str]:
    return lines[_after(lines, key)].partition(":")[2].split()


def _panes(lines: list[str], count: int) -> Iterator[dict[str, Any]]:
    first = _after(lines, "GLASS DATA")
    for line in lines[first : first + count]:
        cells = line.rpartition(":")[2].split()
        thickness, conductivity, front, back = (float(cells[k]) for k in (1, 2, 10, 11))
        yield {
            "thickness": round(thickness * _MM, 6),
            "conductivity": conductivity,
            "emissivity": front if front == back else [front, back],
        }


def _gaps(lines: list[str], count: int) -> Iterator[tuple[float, str]]:
    if count == 0:
        return
    first, gas = _after(lines, "GAP DATA"), _after(lines, "GAS DATA")
    widths = [float(line.rpartition(":")[2].split()[1]) * _MM for line in lines[first : first + count]]
    gases = [line.partition(":")[2].split()[0].casefold() for line in lines[gas:] if "Gap" in line[:20]]
    for k, width in enumerate(widths):
        name = gases[k] if k < len(gases) else "air"
        yield round(width, 6), name if name in _GASES else "air"


def _angular(lines: list[str], count: int) -> dict[str, Any]:
    first = _after(lines, "GLAZING SYSTEM OPTICAL DATA")
    angles = [float(cell) for cell in lines[first].split()[1:-1]]
    rows = {}
    for line in lines[first + 2 :]:
        cells = line.split()
        if not cells or cells[0] in rows:
            break
        rows[cells[0]] = [float(cell) for cell in cells[1:]]
    absorbed = [rows[f"Abs{k}"] for k in range(1, count + 1)]
    return {
        "angles": angles,
        "transmittance": rows["Tsol"][:-1],
        "absorptance": [row[:-1] for row in absorbed],
        "diffuse": {"transmittance": rows["Tsol"][-1], "absorptance": [row[-1] for row in absorbed]},
    }


def _frame(line: str | None) -> tuple[float, float, float, float] | None:
    if line is None:
        return None
    cells = [float(cell) for cell in line.partition(":")[2].split()[:8]]
    width, conductance, absorptance, emissivity = cells[0] * _MM, cells[3], cells[5], cells[7]
    if width <= 0.0:
        return None
    return width, 1.0 / (1.0 / conductance + _FILMS), absorptance, emissivity
