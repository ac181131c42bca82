from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from bestest_support import wave, year, years
from mascarin.errors import InputError
from mascarin.verification.bestest import writing
from mascarin.verification.bestest.catalogue import CASES, FOLDER, IN_DEPTH, MAIN, chosen
from mascarin.verification.bestest.quantities import (
    HOURS,
    BestestQuantity,
    BestestYear,
    bins,
    hours_of,
    months,
    partners,
    quantities,
    quantities_of,
    when,
)
from mascarin.verification.bestest.reference import PROGRAMS, ranges
from mascarin.verification.bestest.running import run
from mascarin.verification.bestest.weather import FINGERPRINT, fingerprint, read

# --- the table of cases ---


def test_there_are_seventeen_main_and_twenty_two_in_depth_cases() -> None:
    assert (len(MAIN), len(IN_DEPTH), len(CASES)) == (17, 22, 39)
    assert {case for case, _ in ranges()} == set(CASES)


# The absolute values of the in-depth cases: opening, gain, infiltration, thermostat, emissivity in and out,
# absorptance in (where sun enters) and out.
IN_DEPTH_TABLE = """
195 none      0   0   20,20 0.1 0.1 -   0.1
200 panels    0   0   20,20 0.1 0.1 -   0.1
210 panels    0   0   20,20 0.1 0.9 -   0.1
215 panels    0   0   20,20 0.9 0.1 -   0.1
220 panels    0   0   20,20 0.9 0.9 -   0.1
230 panels    0   1   20,20 0.9 0.9 -   0.1
240 panels    200 0   20,20 0.9 0.9 -   0.1
250 panels    0   0   20,20 0.9 0.9 -   0.9
270 south     0   0   20,20 0.9 0.9 0.9 0.1
280 south     0   0   20,20 0.9 0.9 0.1 0.1
290 south     0   0   20,20 0.9 0.9 0.9 0.1 shaded
300 east_west 0   0   20,20 0.9 0.9 0.9 0.1
310 east_west 0   0   20,20 0.9 0.9 0.9 0.1 shaded
320 south     0   0   20,27 0.9 0.9 0.9 0.1
395 none      0   0   20,27 0.9 0.9 -   0.1
400 panels    0   0   20,27 0.9 0.9 -   0.1
410 panels    0   0.5 20,27 0.9 0.9 -   0.1
420 panels    200 0.5 20,27 0.9 0.9 -   0.1
430 panels    200 0.5 20,27 0.9 0.9 -   0.6
440 south     200 0.5 20,27 0.9 0.9 0.1 0.6
800 panels    200 0.5 20,27 0.9 0.9 -   0.6 heavy
810 south     200 0.5 20,27 0.9 0.9 0.1 0.6 heavy
"""


@pytest.mark.parametrize("row", IN_DEPTH_TABLE.strip().splitlines(), ids=lambda row: row.split()[0])
def test_each_in_depth_case_has_its_row(row: str) -> None:
    name, opening, gain, air, thermostat, eps_in, eps_out, alpha_in, alpha_out, *more = row.split()
    case = CASES[name]
    assert (case.opening, case.thermostat) == (opening, thermostat)
    assert (case.gain, case.air_changes) == (float(gain), float(air))
    assert (case.emissivity_inside, case.emissivity_outside) == (float(eps_in), float(eps_out))
    assert alpha_in == "-" or case.absorptance_inside == float(alpha_in)
    assert case.absorptance_outside == float(alpha_out)
    assert (case.shaded, case.heavy) == ("shaded" in more, "heavy" in more)
    assert not case.fan
    assert not case.sunspace


def test_cases_are_chosen_by_name_in_their_order() -> None:
    assert [case.name for case in chosen(["900ff", "600"])] == ["600", "900FF"]
    assert len(chosen(list(CASES))) == 39
    with pytest.raises(InputError, match="found '601'"):
        chosen(["601"])


@pytest.mark.parametrize("name", CASES)
def test_the_building_file_agrees_with_the_catalogue(name: str) -> None:
    assert CASES[name].file.read_text(encoding="utf-8") == writing.text(CASES[name])


def test_there_is_a_file_for_each_case_and_no_other() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == set(CASES)


# --- results of six programs ---


def test_the_ranges_are_those_of_the_published_table(data_dir: Path) -> None:
    """Every number of the published table, without three cases that are not in the catalogue."""
    with (data_dir / "bestest" / "std140_2020_reference.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["case"] not in ("450", "460", "470")]
    published = sorted(
        (row["unit"], float(row["ref_min"]), float(row["ref_max"]), tuple(row[p] for p in PROGRAMS))
        for row in rows
    )
    ours = sorted(
        (found.unit, found.low, found.high, tuple(_written(found.programs.get(p)) for p in PROGRAMS))
        for found in ranges().values()
    )
    assert ours == [
        (u, low, high, tuple(_written(float(c) if c else None) for c in cells))
        for u, low, high, cells in published
    ]
    means = sorted(float(row["ref_mean"]) for row in rows)
    assert sorted(found.mean for found in ranges().values()) == pytest.approx(means, rel=1e-5)


def _written(value: float | None) -> str:
    return "" if value is None else f"{value:g}"


def test_a_range_by_hand() -> None:
    found = ranges()["600", "peak_heating"]
    assert (found.low, found.high, found.unit) == (3.02023, 3.35889, "kW")
    assert found.mean == pytest.approx(3.18359, abs=1e-5)
    assert found.whens["BSIMAC"] == "Nov 26 8"
    assert found.whens["EnergyPlus"] == "Dec 31 24"
    assert "BSIMAC" not in ranges()["960", "annual_heating"].programs


# --- quantities from hours ---


def test_hours_are_named_by_their_end() -> None:
    assert [when(hour) for hour in (0, 23, 24, 31 * 24, 8759)] == [
        "Jan 1 1", "Jan 1 24", "Jan 2 1", "Feb 1 1", "Dec 31 24",
    ]  # fmt: skip
    assert when(hours_of("Jul", 14).start) == "Jul 14 1"
    assert [month.stop - month.start for month in months()[:2]] == [744, 672]
    assert months()[-1].stop == HOURS


def test_loads_and_peaks() -> None:
    heating = np.zeros(HOURS)
    heating[:1000] = 500.0
    heating[31 * 24 + 7] = heating[31 * 24 + 9] = 3000.0
    cooling = np.zeros(HOURS)
    cooling[-1] = 2500.0
    series = {
        "room.heating_load": heating,
        "room.cooling_load": cooling,
        "room.air_temperature": wave(20, 27),
    }
    found = {
        row.quantity: row for row in quantities({"610": BestestYear(CASES["610"], series, 0.0)}, CASES["610"])
    }
    assert found["annual_heating"].value == pytest.approx((998 * 500.0 + 2 * 3000.0) / 1e6, rel=1e-14)
    # The first of equal peaks.
    assert (found["peak_heating"].value, found["peak_heating"].when) == (3.0, "Feb 1 8")
    assert (found["annual_cooling"].value, found["peak_cooling"].when) == (0.0025, "Dec 31 24")
    assert found["annual_heating"].unit == "MWh"


def test_a_case_without_heating_has_none() -> None:
    found = {row.quantity: row for row in quantities({"650": year(CASES["650"])}, CASES["650"])}
    assert (found["annual_heating"].value, found["peak_heating"].when) == (0.0, "")
    assert found["annual_heating"].passed
    assert not found["annual_cooling"].passed


def test_free_floating_extremes_are_those_of_the_right_zone() -> None:
    floating = wave(10.0, 40.0)
    floating[100], floating[200] = 61.0, -9.0
    series = {"room.air_temperature": floating}
    found = {
        row.quantity: row
        for row in quantities({"600FF": BestestYear(CASES["600FF"], series, 0.0)}, CASES["600FF"])
    }
    assert set(found) == {"max_temperature", "min_temperature", "mean_temperature"}
    assert (found["max_temperature"].value, found["max_temperature"].when) == (61.0, "Jan 5 5")
    assert (found["min_temperature"].value, found["min_temperature"].when) == (-9.0, "Jan 9 9")
    assert found["mean_temperature"].value == pytest.approx(floating.mean())
    both = year(CASES["960"])
    assert {"back.heating_load", "sunspace.air_temperature"} <= set(both.series)
    rows = quantities({"960": both}, CASES["960"])
    assert {row.quantity for row in rows} == {
        "annual_heating", "annual_cooling", "peak_heating", "peak_cooling",
        "max_temperature", "min_temperature", "mean_temperature",
    }  # fmt: skip


def test_solar_radiation_per_area_and_the_shading_coefficient() -> None:
    assert partners(CASES["610"]) == ("600",)
    assert partners(CASES["600"]) == partners(CASES["910"]) == ()
    found = {row.quantity: row for row in quantities(years(), CASES["610"])}
    assert found["transmitted_solar_south"].value == pytest.approx(0.5 * 0.1 * 8760)
    assert found["shading_coefficient_south"].value == pytest.approx(1.0 - 100.0 / 150.0)
    base = {row.quantity: row for row in quantities(years(), CASES["600"])}
    assert base["transmissivity_south"].value == pytest.approx(0.5)
    assert base["incident_solar_east"].value == pytest.approx(0.5 * 0.302 * 8760)


def test_every_published_quantity_is_computed() -> None:
    every = years()
    given = {(row.case, row.quantity) for case in CASES.values() for row in quantities(every, case)}
    assert given == set(ranges())


def test_a_bin_begins_at_its_label() -> None:
    counts = bins(np.array([-60.0, -49.5, -49.0, -0.5, 0.0, 0.999, 1.0, 25.4, 98.7, 120.0]))
    assert counts.sum() == 10
    found = {int(index) - 50: int(counts[index]) for index in np.flatnonzero(counts)}
    assert found == {-50: 2, -49: 1, -1: 1, 0: 2, 1: 1, 25: 1, 98: 2}


def test_a_number_on_the_edge_is_inside() -> None:
    edge = ranges()["600", "annual_heating"]
    assert BestestQuantity("600", "annual_heating", "MWh", edge.high, "", edge).passed
    # By the rule of all limits: 1e-6 of the unit.
    assert BestestQuantity("600", "annual_heating", "MWh", np.nextafter(edge.high, 9.0), "", edge).passed
    assert not BestestQuantity("600", "annual_heating", "MWh", edge.high + 2e-6, "", edge).passed
    assert not BestestQuantity("600", "annual_heating", "MWh", float("nan"), "", edge).passed
    told = BestestQuantity("600", "annual_heating", "MWh", 4.2, "", edge).to_dict()
    assert {"case", "quantity", "unit", "value", "min", "max", "expected", "passed"} <= set(told)
    assert told["expected"] == edge.mean


def test_any_building_has_its_loads_and_temperatures() -> None:
    series = {"hall.heating_load": wave(0.0, 2000.0), "attic.air_temperature": wave(-5.0, 15.0)}
    found = {row.quantity: row for row in quantities_of("mine.yaml", series)}
    assert found["hall.annual_heating"].value == pytest.approx(8.76)
    assert found["hall.peak_heating"].unit == "kW"
    assert found["attic.mean_temperature"].value == pytest.approx(5.0)
    assert found["attic.max_temperature"].when == "Jan 1 12"
    assert {row.passed for row in found.values()} == {None}
    assert found["hall.annual_heating"].to_dict()["min"] is None


def test_half_a_year_is_refused() -> None:
    with pytest.raises(InputError, match="expected 8760"):
        BestestYear(CASES["600FF"], {"room.air_temperature": np.zeros(4380)}, 0.0)


# --- the weather ---


def test_the_weather_is_recognized_by_its_numbers(data_dir: Path, tmp_path: Path) -> None:
    file = data_dir / "bestest" / "725650TYCST.epw"
    assert fingerprint(file) == FINGERPRINT
    lines = file.read_text(encoding="latin-1").splitlines()
    lines[5] = "COMMENTS 1,another header"
    renamed = tmp_path / "denver.epw"
    renamed.write_text("\n".join(lines) + "\n", encoding="latin-1")
    assert fingerprint(renamed) == FINGERPRINT
    fields = lines[100].split(",")
    fields[6] = f"{float(fields[6]) + 0.1:.1f}"
    lines[100] = ",".join(fields)
    renamed.write_text("\n".join(lines) + "\n", encoding="latin-1")
    with pytest.raises(InputError, match=r"expected that of the\s+standard"):
        read(renamed)


def test_without_weather_the_message_names_the_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(name: str) -> Path:
        raise InputError(f"{name}: not downloaded")

    monkeypatch.setattr("mascarin.verification.bestest.weather.data_file", missing)
    with pytest.raises(InputError, match=r"comes with the standard's accompanying files.*not downloaded"):
        read(None)
    with pytest.raises(InputError, match="found no file"):
        read(tmp_path / "nothing.epw")


# --- cases run ---


def test_solar_radiation_and_loads_of_a_shaded_case_and_its_base(data_dir: Path) -> None:
    """With steps of one hour annual sums are inside, and energy is conserved."""
    climate = read(data_dir / "bestest" / "725650TYCST.epw")
    seen: list[tuple[float, float]] = []
    found, own = run(
        [CASES["610"]], climate, step="1h", progress=lambda done, total: seen.append((done, total))
    )
    assert own == {}
    assert set(found) == {"600", "610"}
    assert seen == [(0, 2), (1, 2), (2, 2)]
    for year_ in found.values():
        assert year_.closure < 1e-10
    rows = {(r.case, r.quantity): r for name in found for r in quantities(found, CASES[name])}
    level = rows.pop(("600", "incident_solar_horizontal"))
    # The sum of the weather file for a horizontal plane; the upper end of the range is the same, rounded.
    assert level.value == pytest.approx(1e-3 * climate.data["global_horizontal"].sum(), rel=5e-4)
    assert len(rows) == 2 * 4 + 6 + 2
    outside = [key for key, row in rows.items() if not row.passed]
    assert outside == []
