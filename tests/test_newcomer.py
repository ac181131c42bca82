"""What a new user of the Python package tries first: wrong types, wrong units, notebooks, figures."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import mascarin as mc
from mascarin.examples import box, box_climate

PATH = "materials.concrete.density"
RUN: dict[str, Any] = {"step": "1h", "outputs": ["room.air_temperature"]}


def frame(**columns: Any) -> pd.DataFrame:
    """Three days as pvlib gives them, with a bright sky."""
    index = pd.date_range("2024-06-01", periods=72, freq="1h", tz="Europe/Paris")
    sun = np.maximum(np.sin((index.hour - 8.0) * np.pi / 12.0), 0.0)
    table = {"temp_air": 15.0, "relative_humidity": 60.0, "wind_speed": 2.0, "wind_direction": 180.0}
    return pd.DataFrame({**table, "ghi": 800.0 * sun, **columns}, index=index)


def taken(table: Any, **options: Any) -> mc.Climate:
    place = {"latitude": 45.8, "longitude": 4.8, "altitude": 200.0, "stamps": "end"}
    return mc.Climate.from_pvlib(table, **{**place, **options})


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"temp_air": 288.0}, r"air_temperature \(temp_air\).*288.*expected degC.*273\.15"),
        ({"relative_humidity": 0.6}, "relative_humidity.*0.6, expected percent"),
        ({"pressure": 99.0}, "pressure.*expected Pa"),
        ({"ghi": frame()["ghi"] / 1000.0}, r"global_horizontal \(ghi\).*multiply kW/m2 by 1000"),
        ({"wind_speed": -1.0}, "wind_speed.*expected m/s, from 0"),
        ({"wind_speed": "calm"}, "column 'wind_speed': expected numbers"),
    ],
)
def test_a_frame_in_other_units_is_refused_when_it_is_read(columns: dict[str, Any], words: str) -> None:
    with pytest.raises(mc.InputError, match=words):
        taken(frame(**columns))


def test_pressure_in_hectopascal_is_converted() -> None:
    assert taken(frame(pressure=990.0)).to_dataframe()["pressure"].iloc[0] == 99000.0


def test_one_wrong_value_of_a_frame_is_left_to_the_period_of_the_run() -> None:
    temperature = np.full(72, 15.0)
    temperature[70] = 288.0
    assert len(taken(frame(temp_air=temperature)).index) == 72


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"latitude": 120.0}, "latitude: found 120.0, expected a number from -90 to 90 deg"),
        ({"latitude": "north"}, "latitude: found 'north'"),
        ({"longitude": float("nan")}, "longitude: found nan"),
        ({"altitude": 1e6}, "altitude"),
        ({"absent": "infrared"}, r"absent: found the text 'infrared', expected a list: \['infrared'\]"),
    ],
)
def test_a_place_and_channels_that_cannot_be_are_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(mc.InputError, match=words):
        taken(frame(), **options)


def test_a_frame_in_reverse_order_is_no_typical_year() -> None:
    with pytest.raises(mc.InputError, match=r"do not increase.*sort_index"):
        taken(frame().iloc[::-1])


@pytest.mark.parametrize("wrong", [None, "building.yaml", {"site": {}}, 3])
def test_what_is_no_building_or_climate_is_named(wrong: Any) -> None:
    samples = {PATH: [2200.0]}
    logger = mc.Measurements.from_table(frame()[["temp_air"]])
    sensors = {"room.air_temperature": "temp_air"}
    for building, climate, name in [(wrong, box_climate(), "building"), (box(), wrong, "climate")]:
        for call in (
            lambda b, c: mc.simulate(b, c, **RUN),
            lambda b, c: mc.sweep(b, c, samples, **RUN),
            lambda b, c: mc.jacobian(b, c, vary=[PATH], **RUN),
            lambda b, c: mc.sensitivity_analysis(b, c, vary={PATH: (2000.0, 2400.0)}, **RUN),
            lambda b, c: mc.calibrate(b, c, logger, sensors=sensors, vary={PATH: (2000.0, 2400.0)}),
        ):
            with pytest.raises(mc.InputError, match=f"^{name}: found .*expected a mascarin"):
                call(building, climate)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"scheme": None}, "scheme: found 'None'"),
        ({"outputs": [3]}, "outputs: found 3, expected names as texts"),
        ({"outputs": 3}, "outputs: found 3, expected a list"),
        ({"outputs": ["room.air_temperature"] * 2}, "listed twice"),
        ({"start": 3}, "start: found the number 3, expected a date"),
        ({"measurements": "logger.csv"}, "measurements: found 'logger.csv'"),
        ({"progress": "yes"}, "progress: found 'yes', expected True, False, None"),
        ({"parameters": {3: 3.0}}, "parameters: key 3"),
    ],
)
def test_options_of_another_type_are_refused_by_name(options: dict[str, Any], words: str) -> None:
    with pytest.raises(mc.InputError, match=words):
        mc.simulate(box(), box_climate(), **{**RUN, **options})


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"vary": {PATH: (1.0, 2.0, 3.0)}}, r"expected two numbers \(low, high\)"),
        ({"vary": {PATH: 3.0}}, r"found 3.0, expected two numbers"),
        ({"vary": {PATH: ("low", "high")}}, "expected two numbers"),
        ({"vary": [3]}, "vary: found 3, expected names"),
        ({"leave_out": PATH}, "leave_out: found the text"),
        ({"groups": {"mass": PATH}}, "groups: mass: found the text"),
        ({"distributions": "normal"}, "distributions: found 'normal'"),
        ({"replicates": "many"}, "replicates: found 'many', expected a whole number"),
        ({"samples": "many"}, "samples: found 'many'"),
        ({"seed": -1}, "seed: found -1, expected a whole number from 0 on"),
        ({"method": None}, "method: found 'None'"),
    ],
)
def test_options_of_a_sensitivity_analysis_are_refused_by_name(options: dict[str, Any], words: str) -> None:
    with pytest.raises(mc.InputError, match=words):
        mc.sensitivity_analysis(box(), box_climate(), **{"vary": {PATH: (2000.0, 2400.0)}, **RUN, **options})


def test_a_confidence_in_percent_is_refused_before_the_runs() -> None:
    seen: list[tuple[int, int]] = []
    with pytest.raises(mc.InputError, match="confidence: found 95"):
        mc.sensitivity_analysis(
            box(),
            box_climate(),
            vary={PATH: (2000.0, 2400.0)},
            confidence=95,
            progress=lambda done, total: seen.append((done, total)),
            **RUN,
        )
    assert not seen


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"sensors": ["T"]}, "sensors: found list"),
        ({"sensors": {}}, "sensors: found none"),
        ({"sensors": {"room.air_temperature": 3}}, "sensors: room.air_temperature: found 3"),
        ({"vary": PATH}, f"vary: found '{PATH}', expected a list of paths"),
        ({"vary": None}, "vary: found None"),
        ({"vary": {PATH: 3.0}}, "expected two numbers"),
        ({"options": "strict"}, "options: found 'strict'"),
        ({"seed": "x"}, "seed: found 'x'"),
        ({"record": 3}, "record: found 3"),
        ({"method": None}, "method: found 'None'"),
    ],
)
def test_options_of_a_calibration_are_refused_by_name(options: dict[str, Any], words: str) -> None:
    climate = box_climate()
    run = mc.simulate(box(), climate, **RUN)
    logger = mc.Measurements.from_table(
        pd.DataFrame({"T": run.records[:, 0]}, index=run.index), timezone="UTC"
    )
    usual = {
        "sensors": {"room.air_temperature": "T"},
        "vary": {PATH: (2000.0, 2400.0)},
        "step": "1h",
        "warm_up": "1h",
    }
    with pytest.raises(mc.InputError, match=words):
        mc.calibrate(box(), climate, logger, **{**usual, **options})


def test_samples_and_objectives_that_are_no_mappings_are_refused() -> None:
    for samples in (None, [1.0, 2.0]):
        with pytest.raises(mc.InputError, match=r"samples: found .*expected values by path"):
            mc.sweep(box(), box_climate(), samples, **RUN)  # type: ignore[arg-type]
    with pytest.raises(mc.InputError, match="objectives: found function"):
        mc.sweep(box(), box_climate(), {PATH: [2200.0]}, objectives=max_of, **RUN)  # type: ignore[arg-type]
    with pytest.raises(mc.InputError, match="workers: found 'two'"):
        mc.sweep(box(), box_climate(), {PATH: [2200.0]}, workers="two", **RUN)  # type: ignore[arg-type]


def max_of(run: Any) -> Any:
    return run["room.air_temperature"].max("time")


@pytest.mark.parametrize("objective", [None, lambda _run: 3.0])
def test_an_objective_of_a_gradient_gives_value_and_derivatives(objective: Any) -> None:
    with pytest.raises(mc.InputError, match=r"objective: found .*returns"):
        mc.gradient(box(), box_climate(), objective, **RUN)


def test_a_key_that_is_no_text_is_named() -> None:
    run = mc.simulate(box(), box_climate(), **RUN)
    with pytest.raises(mc.InputError, match="0: not recorded"):
        run[0]  # type: ignore[index]


def test_a_part_cannot_be_assigned_to() -> None:
    with pytest.raises(mc.InputError, match=r"Zone\.volume: .*immutable"):
        mc.building.Zone(volume=40).volume = 30  # type: ignore[misc, assignment]


def test_a_fault_in_a_part_given_as_an_object_is_named_down_to_its_field() -> None:
    b = mc.building
    with pytest.raises(mc.InputError, match=r"constructions\.wall\.layers\.wol\.material"):
        mc.Building(
            site=b.Site(latitude=48, longitude=2, altitude=100, timezone="Europe/Paris"),
            materials={"wool": b.Solid(conductivity=0.04, density=30, specific_heat=1000)},
            constructions={"wall": b.Construction(layers=[b.Layer(material="wol", thickness=0.1)])},
        )


@pytest.mark.parametrize("wrong", [None, 3, ["a"]])
def test_changes_and_files_of_another_type_are_refused(wrong: Any) -> None:
    if wrong is not None:
        with pytest.raises(mc.InputError, match="values: found"):
            box().replace(wrong)
        with pytest.raises(mc.InputError, match="values: found"):
            box().with_values(wrong)
    for read in (mc.load, mc.Building.from_yaml, mc.Climate.from_epw, mc.Climate.from_tmy):
        with pytest.raises(mc.InputError, match="path: found"):
            read(wrong)
    with pytest.raises(mc.InputError, match="table: found"):
        mc.Measurements.from_table(wrong)


def test_a_missing_folder_is_named_and_not_a_temporary_file(tmp_path: Any) -> None:
    run = mc.simulate(box(), box_climate(), **RUN)
    for write in (box().to_yaml, run.to_netcdf):
        with pytest.raises(FileNotFoundError, match="no such folder") as caught:
            write(tmp_path / "absent" / "file.nc")
        assert ".part" not in str(caught.value)


def test_plots_refuse_what_are_no_axes_and_take_a_grid_of_axes() -> None:
    run = mc.simulate(box(), box_climate(), step="1h")
    names = ["room.air_temperature"]
    for plot in (lambda ax: run.plot(names, ax=ax), lambda ax: box_climate().plot("air_temperature", ax=ax)):
        with pytest.raises(mc.InputError, match="ax: found 3, expected axes"):
            plot(3)
    with pytest.raises(mc.InputError, match="names: found none"):
        run.plot([])
    figure, grid = plt.subplots(1, 1, squeeze=False)
    assert run.plot(names, ax=grid) is figure  # type: ignore[arg-type]
    assert grid[0, 0].get_ylabel() == "[°C]"
    plt.close(figure)


def test_a_run_without_outputs_has_a_page() -> None:
    run = mc.simulate(box(), box_climate(), step="1h", outputs=[])
    assert "energy balance" in run._repr_html_()


def test_the_table_of_a_run_names_its_index_as_that_of_the_weather() -> None:
    climate = box_climate()
    run = mc.simulate(box(), climate, **RUN)
    assert run.to_dataframe().index.name == climate.to_dataframe().index.name == "time"


def test_the_energy_balance_shows_kilowatt_hours() -> None:
    energy = mc.simulate(box(), box_climate(), **RUN).energy
    assert repr(energy) == str(energy)
    assert "kWh" in repr(energy)
    assert len(repr(energy).splitlines()) <= 15


def test_the_first_figure_and_bar_of_a_notebook_appear_without_a_warning(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("MPLBACKEND", raising=False)  # the kernel chooses its own
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    cells = [
        "import mascarin as mc\nfrom mascarin.examples import box, box_climate\n"
        "run = mc.simulate(box(), box_climate(), step='1h')",
        "run.plot(['room.air_temperature'])",
    ]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in cells])
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3").execute()
    assert book.cells[0].outputs == []
    assert "image/png" in book.cells[1].outputs[0]["data"]
