"""The command that shows and checks a weather file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from mascarin._io.locks import writing
from mascarin.commands.options.inputs import AsJson, CheckSun, Shift, read_weather
from mascarin.commands.options.output import print_json, print_table
from mascarin.errors import InputError

if TYPE_CHECKING:
    from mascarin.weather import Climate, Overview

#: Suspicious parts that are printed; the others are counted.
_MOST = 12


def weather(
    file: Path | None = None,
    /,
    *,
    morph: Path | None = None,
    epw: Path | None = None,
    out: Annotated[Path | None, Parameter(name=("--out", "-o"))] = None,
    heating_base: float = 18.0,
    cooling_base: float = 24.0,
    check_sun: CheckSun = True,
    shift: Shift = None,
    as_json: AsJson = False,
) -> None:
    """Show and check a weather file.

    Prints gaps and suspicious values, a table of months, degree days, sunshine, and the hours of the outdoor
    air in Givoni's zones of comfort. Without a file it lists the climates that come with Mascarin.

    Parameters
    ----------
    file : Path
        EPW file, TMY3 as CSV, or shipped:NAME of a climate that comes with Mascarin, such as shipped:tampa.
    morph : Path
        CSV table of monthly changes (month; temperature [K]; daily_maximum and daily_minimum [K];
        relative_humidity [percentage points]; radiation and wind_speed [%]): the climate is shifted and
        stretched by them first (Belcher et al. 2005).
    epw : Path
        EPW file to write, such as that of the changed climate.
    out : Path
        Folder for figures (SVG) and the table of months (CSV).
    heating_base : float
        Daily mean below which a heating degree day counts. [degC]
    cooling_base : float
        Daily mean above which a cooling degree day counts. [degC]
    """
    if file is None:
        if morph is not None or epw is not None or out is not None:
            raise InputError("weather: found no weather file; expected one, such as shipped:tampa")
        _list(as_json)
        return
    if epw is not None and epw.suffix.lower() != ".epw":
        raise InputError(f"--epw: found '{epw}'; expected a file ending in .epw")
    from mascarin.weather import MonthlyChanges, morphed, overview, write_epw

    changes = None if morph is None else MonthlyChanges.read(morph)
    climate = _checked(file, check_sun, shift)
    if changes is not None:
        climate = morphed(climate, changes)
    summary = overview(climate, heating_base=heating_base, cooling_base=cooling_base)
    result = _result(climate, summary)
    with writing(epw):
        if epw is not None:
            write_epw(climate, epw)
            print(f"wrote {epw}", file=sys.stderr)
    if out is not None:
        for path in _figures(climate, summary, out):
            print(f"wrote {path}", file=sys.stderr)
    if as_json:
        print_json(result)
    else:
        _show(climate, summary, result)


def _checked(file: Path, check_sun: bool, shift: str | None) -> Climate:
    """The climate, after a check that its radiation follows the sun."""
    from mascarin.errors import did_you_mean
    from mascarin.weather import SHIPPED

    if not file.exists() and str(file) in SHIPPED:
        raise InputError(f"{file}: found no such file; expected shipped:{file}, a climate of Mascarin")
    if not file.suffix and not str(file).startswith("shipped:") and not file.exists():
        hint = did_you_mean(str(file), SHIPPED)
        raise InputError(
            f"{file}: no such file; give the path from the folder you work in, or shipped:NAME. {hint}"
        )
    try:
        climate = read_weather(file, check_sun=check_sun, shift=shift)
    except InputError as error:
        from mascarin.building.files.recognition import described

        file_kind = described(file)
        # A damaged EPW or TMY3 is still one.
        if file_kind is None or (
            file.suffix.lower() in (".epw", ".csv", ".tm2") and "seven fields" not in str(error)
        ):
            raise
        raise InputError(
            f"{file}: found {file_kind.what}; expected an EPW file, TMY3 as CSV, or shipped:NAME. "
            f"{file_kind.remedy}"
        ) from None
    if climate.site is None:
        return climate
    completed = climate.completed()
    return climate if "direct_normal" in climate.data else completed


def _list(as_json: bool) -> None:
    from mascarin.weather import SHIPPED

    if as_json:
        print_json([{"name": f"shipped:{shipped.name}", "climate": shipped.climate, "file": shipped.file,
                     "sha256": shipped.sha256} for shipped in SHIPPED.values()])  # fmt: skip
        return
    rows = [(f"shipped:{shipped.name}", shipped.climate, shipped.file) for shipped in SHIPPED.values()]
    print_table(("name", "climate", "file"), rows)
    print("\nTypical years of the U.S. government (NREL TMY3, 2008), in the public domain.")


def _result(climate: Climate, overall: Overview) -> dict[str, Any]:
    from mascarin.comfort.outdoors import hours_in_givoni_zones
    from mascarin.weather import summary
    from mascarin.weather.checks.missing_infrared import sky_of_runs

    zones = hours_in_givoni_zones(climate) if "dew_point" in climate.data else {}
    months = {str(month): row.to_dict() for month, row in overall.months.iterrows()}
    return {
        **summary(climate),
        "sky": sky_of_runs(climate.record),
        "quality": [
            {"column": defect.channel, "kind": defect.kind, "start": str(defect.start),
             "end": str(defect.end), "count": defect.count, "detail": defect.detail}
            for defect in climate.quality()
        ],
        "months": months,
        "heating_degree_days": {"base": overall.heating_base, "sum": overall.heating_degree_days},
        "cooling_degree_days": {"base": overall.cooling_base, "sum": overall.cooling_degree_days},
        "sunshine_hours": overall.sunshine,
        "outdoor_hours_in_givoni_zones": zones,
    }  # fmt: skip


def _show(climate: Climate, summary: Overview, result: dict[str, Any]) -> None:
    site = climate.site
    if site is not None:
        print(f"{site.name}: {site.latitude:g} deg north, {site.longitude:g} deg east, {site.altitude:g} m")
    kind = "a typical year" if climate.grid.periodic else climate.grid.span()
    print(f"{kind}, every {climate.grid.interval:g} s, {climate.timezone}")
    print(f"sky of a run: {result['sky']}")
    print(*(f"warning: {note}" for note in _warnings(climate)), "", sep="\n")
    _show_quality(result["quality"])
    table = summary.months.round(1)
    header = ["month", *(name.replace(", horizontal", "").replace(" [", "\n[") for name in table.columns)]
    units = [name.rpartition(" ")[2] for name in table.columns]
    names = [_SHORT.get(name.rpartition(" ")[0], name.rpartition(" ")[0]) for name in table.columns]
    header = ["month", *(f"{name} {unit}" for name, unit in zip(names, units, strict=True))]
    rows = [
        (str(month)[5:], *(f"{x:.1f}" for x in row))
        for month, row in zip(table.index, table.to_numpy(), strict=True)
    ]
    print_table(header, rows)
    print(f"\nheating degree days {summary.heating_degree_days:.0f} K d (daily mean below "
          f"{summary.heating_base:g} degC), cooling degree days {summary.cooling_degree_days:.0f} K d (above "
          f"{summary.cooling_base:g} degC)")  # fmt: skip
    print(f"sunshine {summary.sunshine:.0f} h (direct irradiance of 120 W/m2 and more)")
    if result["outdoor_hours_in_givoni_zones"]:
        print("\nOutdoor air in the shade, hours in Givoni's zones of comfort for hot climates:")
        zones = result["outdoor_hours_in_givoni_zones"]
        keys = list(next(iter(zones.values())))
        print_table(("air speed", *keys), [(speed, *hours.values()) for speed, hours in zones.items()])


def _warnings(climate: Climate) -> list[str]:
    """Warnings of the file and of its clock."""
    used = climate.used.record
    clock = [note.replace(": warning: ", ": ", 1) for note in used.provenance if ": warning: " in note]
    return list(dict.fromkeys([*clock, *climate.record.warnings]))


_SHORT = {
    "air, mean": "air", "air, daily maximum": "max", "air, daily minimum": "min", "air, lowest": "lowest",
    "air, highest": "highest", "relative humidity": "RH", "global, horizontal": "global",
    "direct, normal": "direct", "diffuse, horizontal": "diffuse",
}  # fmt: skip


def _show_quality(quality: list[dict[str, Any]]) -> None:
    if not quality:
        print("quality: no gaps, no impossible and no suspicious values\n")
        return
    print(f"quality: {len(quality)} suspicious parts")
    rows = [
        (defect["column"], defect["kind"], defect["start"][:16], defect["count"], defect["detail"])
        for defect in quality
    ]
    print_table(("column", "kind", "from", "rows", "found"), rows[:_MOST])
    print(f"... {len(rows) - _MOST} more (--json lists all)\n" if len(rows) > _MOST else "")


def _figures(climate: Climate, summary: Overview, folder: Path) -> list[Path]:
    """Figures of the climate and the table of months."""
    from matplotlib.figure import Figure

    from mascarin._io import atomic
    from mascarin.comfort.plots import psychrometric
    from mascarin.figures import comfort as figures
    from mascarin.figures.files import save
    from mascarin.physics import STANDARD_PRESSURE, humidity_of_dew_point

    data, times = climate.data, climate.index
    written = []

    def add(name: str, draw: Any, height: float = 3.2) -> None:
        figure = Figure(figsize=(9.0, height), layout="constrained")
        draw(figure.subplots())
        written.append(save(figure, folder / f"{name}.svg"))

    for name, label, unit in (
        ("air_temperature", "outdoor temperature", "degC"),
        ("global_horizontal", "global radiation", "W/m2"),
        ("wind_speed", "wind speed", "m/s"),
    ):
        if name in data:
            series = figures.ComfortSeries(times, data[name].to_numpy(dtype=float), label, unit)
            add(f"{name}_carpet", lambda ax, series=series: figures.carpet(ax, series))
            add(f"{name}_days", lambda ax, series=series: figures.daily_profile(ax, series))
    if "dew_point" in data:
        air = data["air_temperature"].to_numpy(dtype=float)
        humid = humidity_of_dew_point(air, data["dew_point"].to_numpy(dtype=float))
        pressure = data["pressure"].to_numpy(dtype=float) if "pressure" in data else STANDARD_PRESSURE
        add("comfort_chart", lambda ax: psychrometric(ax, air, humid, pressure), 5.0)
    written.append(atomic.write(folder / "months.csv", summary.months.round(3).to_csv()))
    return written
