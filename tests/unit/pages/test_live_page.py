"""Pages in which the model runs: their numbers are those of a run in Python, and bad input is said."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pandas as pd
import pytest
from axe_playwright_python.sync_playwright import Axe

import mascarin as mc
from crossing_entrances import Bench
from crossing_features import FEATURES, VARIED, description
from mascarin.building import Building
from mascarin.errors import InputError
from mascarin.examples import FOLDER, box, box_climate
from mascarin.pages.explore.session import Band
from mascarin.pages.live import Sent, engine, live_page, sliders
from mascarin.pages.live.packing import ALPHABET, planes
from mascarin.simulation import Simulation
from mascarin.study import Study
from mascarin.weather import Measurements

if TYPE_CHECKING:
    from playwright.sync_api import Download, Page

READY: Final = "body[data-ready]"
HOUSE: Final = ("controls", "hysteresis", "loads", "sensors and ties")
FACTOR: Final = "materials.*.density"
SLIDERS: Final = (
    *VARIED, "materials.pcm.melting_temperature", "materials.pcm.latent_heat", "vents.casement.area",
    "zones.room.cooling.setpoint.temperature", "controls.warmth.minimum_open_time", FACTOR,
)  # fmt: skip
CURVES: Final = (
    "room.air_temperature", "room.cooling_load", "roof.pcm_liquid_fraction", "casement.inflow",
    "core.temperature",
)  # fmt: skip


def tree() -> dict[str, Any]:
    """Two rooms with vents that controls open, a layer with hysteresis, heating and cooling, and a tie."""
    whole = description("nothing")
    for feature in HOUSE:
        FEATURES[feature](whole)
    whole["controls"]["warmth"] |= {"minimum_open_time": 10, "indoor": {"open": 24.5, "close": 23.5}}
    return whole


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("live") / "house", tree(), step="15min")


def told_of(page: Path) -> dict[str, Any]:
    """What the script of a page reads."""
    found = re.search(r'id="page-data">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    content: dict[str, Any] = json.loads(found[1])
    return content


# --- without a browser --------------------------------------------------------------------------------------


def test_packed_numbers_come_back_to_the_bit() -> None:
    numbers = np.random.default_rng(1).normal(size=(3, 40))
    numbers[1, 5], numbers[2, :4] = -0.0, [np.nan, 5e-324, 1e300, -1e-300]
    single = np.frombuffer(planes(numbers), np.uint8).reshape(3, 8, 40)
    differences = np.ascontiguousarray(np.moveaxis(single, 1, 2)).view("<u8")[..., 0]
    with np.errstate(over="ignore"):
        bits = np.add.accumulate(differences, axis=1, dtype="<u8")
    assert np.array_equal(bits, numbers.view("<u8"))
    assert len(set(ALPHABET)) == 85
    assert not set(ALPHABET) & set("<'\"\\")


def test_a_page_without_the_engine_for_browsers_is_refused_with_a_remedy(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(engine, "FILE", "missing.wasm")
    monkeypatch.setattr(engine, "module", engine.read)
    with pytest.raises(InputError, match=r"no engine for browsers.*rustup target add wasm32-unknown-unknown"):
        live_page(box(), box_climate(), tmp_path / "box.html", step="1h")
    assert list(tmp_path.iterdir()) == []


def test_what_a_page_cannot_change_is_refused_by_name(house: Bench, tmp_path: Path) -> None:
    def refusal(building: Building, path: str) -> str:
        with pytest.raises(InputError) as refused:
            sliders.chosen(building, house.simulation(), [path])
        return str(refused.value)

    assert "Did you mean 'zones.room.volume'" in refusal(house.building, "zones.room.volum")
    assert "found a structural number" in refusal(house.building, "site.latitude")
    weather = Bench(tmp_path / "weather", description("weather errors")).building
    assert "the weather, which the page has as it is" in refusal(weather, "weather.clock")
    laws = Bench(tmp_path / "laws", description("laws as text")).building
    assert "without a range, within which the law was checked" in refusal(laws, "zones.room.infiltration.c")


def test_set_points_of_humidity_beside_a_schedule_are_refused(house: Bench) -> None:
    damp = description("humidity")
    damp["schedules"] = {"dry": {"kind": "humidity_ratio", "value": 0.012}}
    damp["humidity"]["zones"]["room"] |= {
        "drying": {"humidity_ratio": {"schedule": "dry"}},
        "humidifying": {"humidity_ratio": 0.008},
    }
    building = Building.from_dict(damp)
    path = "humidity.zones.room.humidifying.humidity_ratio.constant"
    with pytest.raises(InputError, match="which Python alone compares at all times"):
        sliders.chosen(building, house.simulation(), [path])


def test_limits_of_a_slider_are_those_of_python(house: Bench) -> None:
    simulation = house.simulation(*CURVES)
    for path in SLIDERS:
        parameter = simulation.building.parameter(path)
        slider = sliders.plain(simulation, parameter)
        assert slider["low"] <= slider["value"] <= slider["high"]
        for bound, outside in zip(slider["limits"], (-np.inf, np.inf), strict=True):
            if bound is None:
                continue
            beyond = float(np.nextafter(bound, outside))
            if path.endswith("_time"):
                assert slider["limits"] == [0.0, 24 * 60.0]
            with pytest.raises(InputError):
                simulation.run({path: beyond})


def test_numbers_of_a_law_stay_within_the_range_in_which_it_was_checked(tmp_path: Path) -> None:
    described = description("laws as text")
    described["zones"]["room"]["infiltration"]["c"] = {"value": 0.8, "range": [0.5, 1.1]}
    bench = Bench(tmp_path / "laws", described)
    simulation = bench.simulation("room.air_temperature")
    parameter = simulation.building.parameter("zones.room.infiltration.c")
    assert sliders.plain(simulation, parameter)["limits"] == [0.5, 1.1]


def test_what_a_study_has_calibrated_has_sliders_with_its_interval(tmp_path: Path) -> None:
    bench = Bench(tmp_path / "calibrated", description("posterior"))
    told = live_page(
        bench.building, bench.climate, tmp_path / "page.html", start="2001-07-02", end="2001-07-03", step="1h"
    )
    assert told.energy.closes
    (slider,) = told_of(tmp_path / "page.html")["sliders"]
    assert slider["path"] == "surfaces.south.outside.absorptance"
    assert slider["interval"] == [0.4, 0.6]
    assert slider["estimate"] == "Estimate 0.5, 95 % interval 0.4 to 0.6"


def test_measured_values_are_in_the_page_only_where_they_are_asked_for(house: Bench, tmp_path: Path) -> None:
    options: dict[str, Any] = {"start": "2001-07-02", "end": "2001-07-03", "step": "1h"}
    air = Measurements.from_table(house.file("logger.csv"), timezone="UTC-05:00", columns=["air"])
    sent = Sent(measurements=air, compared={"room.air_temperature": "air"})
    with_them, without = tmp_path / "with.html", tmp_path / "without.html"
    live_page(
        house.building, house.climate, with_them, outputs=["room.air_temperature"], sent=sent, **options
    )
    live_page(house.building, house.climate, without, outputs=["room.air_temperature"], **options)
    assert told_of(with_them)["sizes"][3] > 100
    assert told_of(without)["sizes"][3] == len("{}")
    assert "Simulated minus measured" not in without.read_text(encoding="utf-8")
    wrong = Sent(measurements=air, compared={"room.air_temperatur": "air"})
    with pytest.raises(InputError, match=r"--compare: found the output 'room\.air_temperatur'"):
        live_page(house.building, house.climate, tmp_path / "x.html", sent=wrong, **options)


def test_a_balance_that_does_not_close_is_said_and_is_the_exit_code(house: Bench, tmp_path: Path) -> None:
    target = tmp_path / "open.html"
    told = house.command(
        "page", house.file("building.yaml"), "--weather", house.file("inputs.yaml"), "-o", target,
        "--start", "2001-07-02", "--end", "2001-07-03", "--scheme", "apparent-capacity",
    )  # fmt: skip
    assert told.code == 1
    assert "warning: the energy balance does not close" in told.text
    assert any("does not close" in line for line in told_of(target)["warnings"]["sent"])


# --- in a browser -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def file(house: Bench, wasm: Path) -> Path:
    """The page of the house over a day."""
    target = house.folder / "live.html"
    words = [word for path in SLIDERS for word in ("--parameter", path)]
    words += [word for name in CURVES for word in ("--output", name)]
    told = house.command(
        "page", house.file("building.yaml"), "--weather", house.file("inputs.yaml"), "-o", target, *words,
        "--start", "2001-07-02", "--end", "2001-07-03", "--measurements", house.file("logger.csv"),
        "--compare", "room.air_temperature=air", "--set", "zones.hall.volume=41",
    )  # fmt: skip
    assert told.code == 0, told.text
    return target


@pytest.fixture(scope="module")
def simulation(house: Bench, file: Path) -> Simulation:
    """The run of the page in Python."""
    building = house.building.replace({"zones.hall.volume": 41.0})
    ranges = {
        parameter.path: (parameter.low, parameter.high)
        for parameter in map(building.parameter, SLIDERS)
        if parameter.low < parameter.high
    }
    names = [output["name"] for output in told_of(file)["outputs"]]
    return Simulation(
        building, house.climate, measurements=house.measurements, start="2001-07-02", end="2001-07-03",
        step="15min", outputs=names, ranges=ranges,
    )  # fmt: skip


def opened(page: Page, file: Path, state: str = "true") -> list[str]:
    """Open a page; what its console says from now on."""
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto(file.as_uri())
    page.wait_for_selector(READY, state="attached")
    assert page.evaluate("document.body.dataset.ready") == state
    return said


def runs_after(page: Page, action: str, argument: object = None) -> None:
    """Do something in a page, and wait until its runs have ended."""
    before = page.evaluate("Number(document.body.dataset.runs || 0)")
    page.evaluate(action, argument)
    page.wait_for_function("(n) => Number(document.body.dataset.runs || 0) > n", arg=before)


MOVE: Final = """([path, value]) => {
  const box = [...document.querySelectorAll(".slider")].find((one) => one.dataset.path === path);
  const exact = box.querySelector("input[type=number]");
  exact.value = String(value);
  exact.dispatchEvent(new Event("change", { bubbles: true }));
}"""


def records_in(page: Page, values: dict[str, float]) -> np.ndarray:
    """Outputs of a run in a page, shape (rows, outputs)."""
    columns = page.evaluate(
        "async (values) => { const result = await mascarin.run(values);"
        " return mascarin.data.outputs.map(({ column }) => [...result.column(column)]); }",
        values,
    )
    return np.array(columns, dtype=np.float64).T


@pytest.mark.browser
def test_runs_in_the_page_have_the_bits_of_runs_in_python(
    file: Path, simulation: Simulation, page: Page
) -> None:
    said = opened(page, file)
    rng = np.random.default_rng(7)
    cases: list[dict[str, float]] = [{}]
    for _ in range(4):
        ends = [(path, simulation.building.parameter(path)) for path in SLIDERS]
        cases.append(
            {path: float(rng.uniform(one.low, one.high)) for path, one in ends if one.low < one.high}
        )
    distinct = set()
    for values in cases:
        expected = simulation.run(values).records
        assert np.array_equal(records_in(page, values), expected), values
        distinct.add(expected.tobytes())
    assert len(distinct) == len(cases)
    load, fraction, inflow = (simulation.run().records[:, k] for k in (1, 2, 3))
    assert load.max() > 0.0
    assert np.ptp(fraction) > 0.05
    assert inflow.min() == 0.0 < inflow.max()
    assert said == []


@pytest.mark.browser
def test_the_cell_with_its_sun_and_boundaries_has_the_bits_of_mascarin_run(
    tmp_path: Path, wasm: Path, page: Page
) -> None:
    study = Study.from_yaml(FOLDER / "lgi" / "study.yaml")
    building, climate = study.building, study.climate
    file, names = tmp_path / "cell.html", ["room.air_temperature", "ceiling.inside_temperature"]
    days: dict[str, Any] = {"start": "2010-09-18", "end": "2010-10-02", "measurements": study.measurements}
    path = "surfaces.roof.outside.absorptance"
    live_page(building, climate, file, parameters=[path], outputs=names, **days)
    assert file.stat().st_size <= 1.4e6
    opened(page, file)
    run = mc.simulate(building, climate, outputs=names, **days)
    assert np.array_equal(records_in(page, {})[:, :2], run.records)
    changed = mc.simulate(building, climate, outputs=names, parameters={path: 0.7}, **days)
    assert np.array_equal(records_in(page, {path: 0.7})[:, :2], changed.records)
    assert "to the bit" in page.inner_text("main") or "to the bit" in file.read_text(encoding="utf-8")


@pytest.mark.browser
def test_tables_follow_and_are_those_of_python(file: Path, simulation: Simulation, page: Page) -> None:
    opened(page, file)
    path = VARIED[1]
    runs_after(page, MOVE, [path, 0.9])
    results = simulation.run({path: 0.9})
    discomfort = results.comfort("room", index="operative", band=[20, 26]).discomfort
    cells = page.locator("#comfort tbody tr").first.locator("td").all_inner_texts()
    shown = [float(text.replace("−", "-")) for text in cells[::2]]
    numbers = [
        discomfort.hot_hours,
        discomfort.hot_degree_hours,
        discomfort.cold_hours,
        discomfort.cold_degree_hours,
    ]
    assert shown == pytest.approx([float(number) for number in numbers], abs=0.051)
    row = page.locator("#energy tr", has_text="Cooling").locator("td").first.inner_text()
    assert float(row.replace("−", "-")) == pytest.approx(results.energy.into["cooling"] / 3.6e6, abs=0.06)
    errors = results.records[:, 0] - measured_air(simulation)
    fit = page.locator("#fit tbody td").all_inner_texts()
    assert float(fit[0].replace("−", "-")) == pytest.approx(float(np.nanmean(errors)), abs=0.006)
    assert float(fit[2]) == pytest.approx(float(np.sqrt(np.nanmean(errors**2))), abs=0.006)


@pytest.mark.browser
def test_the_sum_of_comfort_counts_the_rooms_that_are_ticked(
    file: Path, simulation: Simulation, page: Page
) -> None:
    opened(page, file)
    results = simulation.run()
    zones = told_of(file)["rooms"]
    assert len(zones) == 2
    low, high = told_of(file)["band"]
    of_zone = {zone: results.comfort(zone, index="operative", band=[low, high]).discomfort for zone in zones}

    def sums() -> list[float]:
        cells = page.locator("#comfort tr.sum td").all_inner_texts()
        return [float(text.replace("−", "-")) for text in cells]

    def expected(*counted: str) -> list[float]:
        kinds = ("hot_hours", "hot_degree_hours", "cold_hours", "cold_degree_hours")
        each = [sum(float(getattr(of_zone[zone], kind)) for zone in counted) for kind in kinds]
        return [value for value in each for _ in ("now", "as sent")]

    boxes = {zone: page.locator(f"#comfort input[data-zone='{zone}']") for zone in zones}
    # The hall has neither a window nor gains nor loads: an attic would not count either.
    assert {zone: box.is_checked() for zone, box in boxes.items()} == {"room": True, "hall": False}
    assert sums() == pytest.approx(expected("room"), abs=0.06)
    boxes["hall"].check()
    both = sums()
    assert both == pytest.approx(expected("room", "hall"), abs=0.6)  # whole hours above 99.95
    assert max(abs(a - b) for a, b in zip(both, expected("room"), strict=True)) > 1.0
    assert page.evaluate("document.activeElement.dataset.zone") == "hall"
    page.keyboard.press("Space")
    assert not boxes["hall"].is_checked()
    runs_after(page, MOVE, [VARIED[1], 0.6])
    assert not boxes["hall"].is_checked()  # stays as it was after a run
    assert sums()[1::2] == pytest.approx(expected("room")[1::2], abs=0.06)


def measured_air(simulation: Simulation) -> np.ndarray:
    """The column ``air`` of the logger at the records, which is linear between its stamps."""
    from crossing_features import measured

    column = measured()["air"].tz_localize("UTC-05:00")
    stamps = pd.DatetimeIndex(column.index)
    times, known = (index.as_unit("s").asi8.astype(np.float64) for index in (simulation.index, stamps))
    series: np.ndarray = np.interp(times, known, column.to_numpy())
    return series


@pytest.mark.browser
def test_a_value_outside_its_limits_is_refused_beside_its_slider(file: Path, page: Page) -> None:
    opened(page, file)
    box = page.locator(f'.slider[data-path="{VARIED[1]}"]')
    for value in ("1.5", "-0.1", "1e300"):
        page.evaluate(MOVE, [VARIED[1], value])
        assert "expected a value from 0 to 1" in box.locator(".message").inner_text()
        assert box.locator("input[type=number]").get_attribute("aria-invalid") is not None
    assert page.evaluate("document.body.dataset.runs") is None
    runs_after(page, MOVE, [VARIED[1], 0.6])
    assert box.locator(".message").is_hidden()


@pytest.mark.browser
def test_the_engine_checks_limits_and_set_points_too(file: Path, page: Page) -> None:
    opened(page, file)
    refused = (
        "async (values) => { try { await mascarin.run(values); return ''; } catch (e) { return e.message; } }"
    )
    assert "expected 0 to 1" in page.evaluate(refused, {VARIED[1]: 1.5})
    crossing = "zones.room.cooling.setpoint.temperature"
    assert "found heating to 20 degC above cooling to 18 degC" in page.evaluate(refused, {crossing: 18})
    runs_after(page, MOVE, [crossing, 18])
    assert "No result for these values: zones.room: found heating" in page.inner_text("#message")
    assert page.locator("#csv").is_disabled()
    assert page.inner_text("#state") == "No result for these values."
    runs_after(page, MOVE, [crossing, 25])
    assert page.locator("#message").is_hidden()


@pytest.mark.browser
def test_the_newest_values_are_run_and_older_ones_are_left_out(
    file: Path, simulation: Simulation, page: Page
) -> None:
    opened(page, file)
    page.evaluate(
        f"() => {{ const move = {MOVE}; for (let k = 1; k <= 50; k++) move(['{VARIED[1]}', k / 100]); }}"
    )
    page.wait_for_function("() => Number(document.body.dataset.runs || 0) >= 2")
    page.wait_for_timeout(300)
    assert page.evaluate("Number(document.body.dataset.runs)") == 2  # the first one, and the last one
    energy = simulation.run({VARIED[1]: 0.5}).energy.into["solar"] / 3.6e6
    shown = page.locator("#energy tr", has_text="Solar").locator("td").first.inner_text()
    assert float(shown) == pytest.approx(energy, abs=0.06)


@pytest.mark.browser
def test_another_worker_takes_over_after_a_trap(file: Path, simulation: Simulation, page: Page) -> None:
    """A panic of the engine: it is given a fourth file, for which it has no room."""
    page.add_init_script(
        "const Real = Worker; globalThis.workers = 0; globalThis.Worker = class extends Real {"
        " constructor(...words) { super(...words); globalThis.workers += 1; }"
        " postMessage(content) { if (content.module) this.first = content;"
        " const { module, files } = this.first, more = { module, files: [...files, files[0]] };"
        " super.postMessage(globalThis.broken && content.values ? more : content);"
        " globalThis.broken = false; } };"
    )
    opened(page, file)
    page.evaluate("globalThis.broken = true")
    runs_after(page, MOVE, [VARIED[1], 0.6])
    assert "No result for these values: panicked at" in page.inner_text("#message")
    runs_after(page, MOVE, [VARIED[1], 0.7])
    assert page.locator("#message").is_hidden()
    assert page.evaluate("workers") == 2
    assert np.array_equal(records_in(page, {VARIED[1]: 0.7}), simulation.run({VARIED[1]: 0.7}).records)


@pytest.mark.browser
@pytest.mark.parametrize("missing", ["WebAssembly", "DecompressionStream", "Worker"])
def test_a_browser_that_cannot_run_the_model_says_so(missing: str, file: Path, page: Page) -> None:
    page.add_init_script(f"delete globalThis.{missing};")
    opened(page, file, "failed")
    assert "This browser cannot run the model" in page.inner_text("#unable")
    assert page.locator(".slider input[type=range]").first.is_disabled()


@pytest.mark.browser
def test_saved_files_are_a_building_and_the_series(
    file: Path, simulation: Simulation, page: Page, house: Bench
) -> None:
    opened(page, file)
    runs_after(page, MOVE, [VARIED[1], 0.55])
    runs_after(page, MOVE, [FACTOR, 1.1])

    def saved(button: str) -> Download:
        with page.expect_download() as download:
            page.click(button)
        return download.value

    yaml = house.folder / "changed.yaml"
    saved("#save").save_as(yaml)
    building = mc.load(yaml)
    assert float(building.parameter(VARIED[1]).value) == 0.55
    assert float(building.parameter("zones.hall.volume").value) == 41.0
    assert float(building.parameter("materials.board.density").value) == pytest.approx(880.0)
    table = house.folder / "series.csv"
    saved("#csv").save_as(table)
    frame = pd.read_csv(table, index_col=0, parse_dates=True)
    assert frame.columns[0] == "room.air_temperature [degC]"
    expected = simulation.run({VARIED[1]: 0.55, FACTOR: 1.1}).records
    assert np.array_equal(frame.to_numpy(), expected)
    assert (frame.index == simulation.index.tz_localize(None)).all()


@pytest.mark.browser
def test_keyboard_names_and_contrast(file: Path, page: Page) -> None:
    for scheme, width in (("light", 1280), ("dark", 390)):
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        page.set_viewport_size({"width": width, "height": 800})
        opened(page, file)
        faults = Axe().run(page).response["violations"]
        assert [fault["id"] for fault in faults] == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    slider = page.locator(f'.slider[data-path="{VARIED[1]}"] input[type=range]')
    slider.focus()
    before = page.evaluate("Number(document.body.dataset.runs || 0)")
    page.keyboard.press("ArrowRight")
    page.wait_for_function("(n) => Number(document.body.dataset.runs || 0) > n", arg=before)
    assert slider.get_attribute("aria-valuetext") != f"{0.5} "


@pytest.mark.browser
def test_warnings_of_runs_with_other_values_are_said(tmp_path: Path, wasm: Path, page: Page) -> None:
    """A layer that melts in the run as sent, and stays solid with another melting temperature."""
    described = copy.deepcopy(description("hysteresis"))
    bench = Bench(tmp_path / "wax", described)
    path = "materials.pcm.melting_temperature"
    file = tmp_path / "wax.html"
    live_page(
        bench.building, bench.climate, file, parameters=[path],
        outputs=["room.air_temperature"], start="2001-07-02", end="2001-07-03", step="15min",
        sent=Sent(band=Band(18.0, 30.0)),
    )  # fmt: skip
    opened(page, file)
    assert "stayed" not in page.inner_text("#warnings")
    assert page.input_value("#band-high") == "30"
    high = bench.simulation().building.parameter(path).upper
    runs_after(page, MOVE, [path, min(high, 90.0)])
    assert "its latent heat has no effect in this run" in page.inner_text("#warnings")


@pytest.mark.browser
def test_an_open_balance_is_said_in_the_page(house: Bench, tmp_path: Path, wasm: Path, page: Page) -> None:
    file = tmp_path / "open.html"
    live_page(
        house.building, house.climate, file, parameters=[VARIED[1]], scheme="apparent-capacity",
        start="2001-07-02", end="2001-07-03", measurements=house.measurements,
    )  # fmt: skip
    opened(page, file)
    assert "the energy balance does not close" in page.inner_text("#warnings")
    runs_after(page, MOVE, [VARIED[1], 0.7])
    assert "The energy balance does not close" in page.inner_text("#warnings")
    assert "does not close" in page.inner_text("#closure")
