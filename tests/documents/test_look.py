"""Pages to look at: a building in three dimensions, a run, and sliders; in a browser and by their numbers."""

from __future__ import annotations

import base64
import hashlib
import json
import math
import os
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from http.client import HTTPConnection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import mascarin as mc
from mascarin import cli, examples
from mascarin.building.geometry import Polygon
from mascarin.building.rooms import rooms
from mascarin.errors import InputError
from mascarin.examples import box, box_climate
from mascarin.pages.explore import Server, Session, choice
from mascarin.pages.explore.page import render as explore_page
from mascarin.pages.explore.server import TOKEN
from mascarin.pages.frame.template import asset
from mascarin.pages.run.page import Notes
from mascarin.pages.run.page import render as run_page
from mascarin.pages.view import render, write
from mascarin.pages.view.layers import constructions
from mascarin.pages.view.panels import panels, window_panels
from mascarin.pages.view.scene import scene
from mascarin.pages.view.sun import positions
from mascarin.verification.bestest.catalogue import CASES

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

HOSTILE = "</script><script>document.title='broken'</script><img src=x onerror=\"document.title='broken'\">"
ABSORPTANCE = "surfaces.facade.outside.absorptance"
HOUSE = examples.FOLDER / "reunion_house" / "building.yaml"
COLORS = """() => {
  const seen = document.getElementById('canvas'), copy = document.createElement('canvas');
  copy.width = seen.width; copy.height = seen.height;
  const context = copy.getContext('2d');
  context.drawImage(seen, 0, 0);
  return new Set(new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)).size;
}"""

PICTURE = "() => document.getElementById('canvas').toDataURL()"

# Waits in the page itself: the page forbids `eval`, which Playwright's own waiting needs.
OTHER_PICTURE = """async (before) => {
  for (let frame = 0; frame < 600; frame += 1) {
    await new Promise(requestAnimationFrame);
    if (document.getElementById('canvas').toDataURL() !== before) return true;
  }
  return false;
}"""


# --- the building -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("file", [CASES["960"].file, examples.FOLDER / "twin_house" / "building.yaml"])
def test_rectangles_have_the_area_and_the_direction_of_their_surfaces(file: Path) -> None:
    building = mc.load(file)
    placed = panels(building)
    assert set(placed) == {name for name, one in building.surfaces.items() if one.vertices is None}
    for name, corners in placed.items():
        surface, drawn = building.surfaces[name], Polygon.of(name, corners.tolist())
        assert drawn.area == pytest.approx(float(surface.area or 0.0), rel=1e-9)
        tilt, azimuth = (math.radians(float(x or 0.0)) for x in (surface.tilt, surface.azimuth))
        east, north = math.sin(tilt) * math.sin(azimuth), math.sin(tilt) * math.cos(azimuth)
        normal = np.cross(corners[1] - corners[0], corners[3] - corners[0])
        expected = [east, north, math.cos(tilt)]
        np.testing.assert_allclose(normal / np.linalg.norm(normal), expected, atol=1e-9)
        own = {key: one for key, one in building.windows.items() if one.surface == name}
        for key, outline in window_panels(corners, own, drawn.area).items():
            assert Polygon.of(key, outline.tolist()).area == pytest.approx(float(own[key].area or 0.0))


def test_the_sun_culminates_where_geometry_says() -> None:
    site = mc.load(HOUSE).site
    found = positions(site)
    raw = np.frombuffer(base64.b64decode(found["data"]), dtype="<i2").astype(float) / found["levels"]
    height = np.degrees(np.arcsin(raw.reshape(found["days"], found["times"], 3)[..., 2]))
    # 90 degrees less the distance of latitude and declination: 23.44 degrees north on 21 June.
    assert height[171].max() == pytest.approx(90.0 - abs(float(site.latitude) - 23.44), abs=0.1)
    # Local noon at 55.5 degrees east by the clock of 60 degrees east is at about 12:20.
    assert np.argmax(height[171]) in (24, 25)


def test_layers_are_drawn_to_scale() -> None:
    building = mc.load(examples.FOLDER / "lgi" / "building.yaml")
    scales = set()
    for one in constructions(building):
        widths = [
            float(w) for w in re.findall(r'<rect [^>]*?width="([\d.]+)"[^>]*class="layer', one["drawing"])
        ]
        layers = building.constructions[one["name"]].layers
        assert len(widths) == len(layers)
        thick = [float(layer.thickness or 0.02) for layer in layers]
        scales |= {round(w / t / 50.0) for w, t in zip(widths, thick, strict=True) if w > 20.0}
    assert len(scales) == 1  # one scale for all
    assert any(row["melting"] for one in constructions(building) for row in one["layers"])


def test_warnings_are_with_the_part_that_they_name() -> None:
    odd = mc.load(HOUSE).replace({"surfaces.partition.area": 50.0})
    name, drawn = "surfaces.partition", [line for line in odd.check() if "surfaces.partition: 50.00" in line]
    assert drawn, "the check finds the area"
    line = drawn[0].removeprefix("warning: ")
    marked = [part["name"] for part in scene(odd, [line])["parts"] if part["marked"]]
    assert marked == [name.partition(".")[2]]


@pytest.mark.browser
def test_the_building_is_drawn_without_network_and_names_stay_text(page: Page, tmp_path: Path) -> None:
    house = mc.Building.from_dict(mc.load(HOUSE).to_dict() | {"name": HOSTILE})
    messages: list[str] = []
    requests: list[str] = []
    page.on("console", lambda one: messages.append(one.text) if one.type == "error" else None)
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("request", lambda one: requests.append(one.url))
    file = write(house, tmp_path / "page.html")
    page.set_viewport_size({"width": 640, "height": 480})
    page.goto(file.as_uri())
    page.wait_for_selector("#canvas[data-drawn]")
    assert page.title() == page.locator("h1").inner_text() == HOSTILE
    assert page.evaluate(COLORS) > 20
    page.locator(".pick", has_text="living_ceiling").first.click()
    assert "PCM" in page.locator("#selected").inner_text() or page.locator("#selected .droplet").count() > 0
    page.locator("#canvas").press("n")
    before = page.locator("#selected > h3").inner_text()
    page.locator("#canvas").press("n")
    assert page.locator("#selected > h3").inner_text() != before
    outside = page.evaluate(PICTURE)
    page.locator("#show-inside").check()
    assert page.evaluate(OTHER_PICTURE, outside)  # the roof no longer hides the rooms
    page.locator("#show-inside").uncheck()
    page.locator("#color-by").select_option("u")
    assert "W/(m² K)" in page.locator("#keys").inner_text()
    page.evaluate(
        "const e = document.getElementById('hour'); e.value = 0; e.dispatchEvent(new Event('input'))"
    )
    assert "below the horizon" in page.locator("#sun-text").inner_text()
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert messages == []
    assert requests == [file.as_uri()]


def test_a_building_without_vertices_is_called_schematic() -> None:
    assert "Schematic." in render(box())
    assert "Schematic." not in render(mc.load(HOUSE))


def test_the_vendored_library_is_the_pinned_one(repository: Path) -> None:
    pinned, name = (repository / "packaging" / "three" / "three.sha256").read_text().split()
    vendored = repository / "python" / "mascarin" / "pages" / "view" / "vendor" / name
    assert hashlib.sha256(vendored.read_bytes()).hexdigest() == pinned


def test_every_name_of_the_library_that_the_page_uses_is_in_it(repository: Path) -> None:
    used = set(re.findall(r"\bTHREE\.(\w+)", asset("pages/view/view.js")))
    listed = (repository / "packaging" / "three" / "entry.js").read_text(encoding="utf-8")
    assert used == set(re.findall(r"\w+", " ".join(re.findall(r"{(.*?)}", listed, re.DOTALL))))


def test_view_names_a_missing_file(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert cli.main(["view", str(tmp_path / "none.yaml"), "--no-open"]) == 2
    assert "none.yaml" in capsys.readouterr().err
    assert cli.main(["view", str(HOUSE), "-o", str(tmp_path / "page.txt")]) == 2
    assert "ends with .html" in capsys.readouterr().err


# --- a run --------------------------------------------------------------------------------------------------


def test_the_page_of_a_run_has_its_numbers(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "run.html"
    words = ["run", str(CASES["600"].file), "--weather", "shipped:golden", "--step", "1h"]
    words += ["--start", "2001-01-04", "--end", "2001-01-06", "--json"]
    assert cli.main(words) == 0
    alone = json.loads(capsys.readouterr().out)
    assert cli.main([*words, "--report", str(file)]) == 0
    assert json.loads(capsys.readouterr().out) == alone  # the page changes no result
    text = file.read_text(encoding="utf-8")
    heating = alone["energy"]["heating_joule"] / 3.6e6
    found = re.search(r"<td>heating</td><td class=\"n\">([\d.\u202f]+)</td>", text)
    assert found is not None
    assert float(found[1].replace("\u202f", "")) == pytest.approx(heating, rel=1e-3)
    assert alone["building_sha256"] in text
    assert "<script" not in text


def test_rooms_are_shown_apart_from_cavities() -> None:
    cell = mc.new_room(
        "4x3x2.8", roof="steel", gap="ventilated", ceiling="plasterboard 12.5mm", place="golden"
    )
    cavities = set(cell.zones) - set(rooms(cell))
    assert len(cavities) == 1
    assert rooms(mc.load(HOUSE)) == list(mc.load(HOUSE).zones)
    climate = mc.Climate.from_epw("shipped:golden")
    run = mc.simulate(cell, climate, start="2001-07-01", end="2001-07-03", step="1h")
    text = run_page(run, Notes(rooms=rooms(cell)))
    assert "Air temperature of cavities" in text
    [room] = rooms(cell)
    highest = float(run[f"{room}.air_temperature"].max())
    assert f"to {highest:.1f}" in text.partition("lowest and highest of all rooms")[0]
    assert "Air temperature of cavities" not in run_page(run, Notes())


def test_names_on_the_page_of_a_run_stay_text() -> None:
    building = mc.Building.from_dict(box().to_dict() | {"name": HOSTILE})
    text = run_page(mc.simulate(building, box_climate(), step="1h"), Notes(warnings=[HOSTILE]))
    assert "<script" not in text
    assert "<img" not in text


# --- sliders ------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """File of a building, and one that the page may write."""
    folder = tmp_path_factory.mktemp("explore")
    return Path(box_file(folder)), folder / "new" / "saved.yaml"


def box_file(folder: Path) -> Path:
    file = folder / "box.yaml"
    box().to_yaml(file)
    (folder / "new").mkdir()
    return file


@pytest.fixture(scope="module")
def session() -> Session:
    return Session(
        box(), box_climate(), parameters=["surfaces.*.outside.absorptance"], options={"step": "1h"}
    )


def test_a_slider_gives_the_run_of_the_saved_building(session: Session, saved: tuple[Path, Path]) -> None:
    base, target = saved
    shown = session.run({ABSORPTANCE: 0.9})["series"]["room.operative_temperature"]
    session.save(target, base, {ABSORPTANCE: 0.9}, {"zones.room.volume": 31.0})
    building = mc.load(target)
    assert float(building.parameter("zones.room.volume").value) == 31.0
    again = building.replace({"zones.room.volume": box().parameter("zones.room.volume").value})
    run = mc.simulate(again, box_climate(), step="1h", outputs=["room.operative_temperature"])
    np.testing.assert_array_equal(np.round(run.records[:, 0], 4), shown)
    assert "extends: ../box.yaml" in target.read_text(encoding="utf-8")


def test_comfort_and_heat_are_those_of_the_run(session: Session) -> None:
    found = session.run({}, [18.0, 24.0])
    series = np.array(found["series"]["room.operative_temperature"])
    middle = 0.5 * (series[1:] + series[:-1])
    hot = np.maximum(series - 24.0, 0.0)
    rough = float((0.5 * (hot[1:] + hot[:-1])).sum())  # trapezoids, but for hours that cross the limit
    assert found["comfort"][0]["hot_degree_hours"] == pytest.approx(rough, rel=0.1, abs=1.0)
    assert abs(found["comfort"][0]["hot"] - float((middle > 24.0).sum())) <= 6.0
    *flows, stored = (heat for _, heat in found["energy"])
    assert sum(flows) == pytest.approx(stored, abs=1e-3)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({ABSORPTANCE: 1.4}, f"{ABSORPTANCE}: found 1.4; expected 0 to 1"),
        ({ABSORPTANCE: "x"}, "expected a number"),
        ({"zones.room.volume": 30.0}, "no slider"),
    ],
)
def test_what_a_slider_cannot_be_is_said(session: Session, values: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        session.run(values)


def test_sliders_where_the_sky_is_that_of_the_weather() -> None:
    """Infrared radiation of the weather replaces the model of the sky, whose parameters have no slider."""
    plain = box().to_dict()
    del plain["site"]["sky"]
    options = {"start": "2001-07-01", "end": "2001-07-03", "step": "1h"}
    session = Session(mc.Building.from_dict(plain), mc.Climate.from_epw("shipped:golden"), options=options)
    paths = [one.path for one in session.sliders]
    assert len(paths) == choice.DEFAULT_SLIDERS
    assert not any(path.startswith(("site.sky", "site.cloud")) for path in paths)
    run = session.simulation.building
    assert "site.sky.scale" in [one.path for one in run.parameters()]  # that of the weather


def test_the_page_of_a_building_shows_blinds_and_counts_what_is_assumed() -> None:
    house = mc.load(HOUSE)
    blind = {
        "position": "outside",
        "transmittance": 0.05,
        "reflectance": 0.6,
        "resistance": 0.17,
        "radiation": 150,
    }
    shaded = house.replace({"windows.jalousie_living_north.blind": blind})
    words = "outside, closed above 150 W/m2 on the window, transmits 5 % and reflects 60 % of the sun"
    facts = {part["name"]: dict(part["facts"]) for part in scene(shaded, [])["parts"]}
    assert facts["jalousie_living_north"]["Blind"] == words
    assert "Blind" not in facts["jalousie_living_south"]
    page = render(shaded)
    assumed = sum(number.assumed for number in shaded.parameters())
    assert f"{assumed} assumed values, with the reason of each" in page
    assert any(f"blind {words}; U of the glass" in line for line in shaded.check())


def test_curves_without_a_choice_are_those_of_rooms() -> None:
    """No attic and no ventilated gap, as in the sums of comfort; ideal loads after temperatures."""
    house = mc.load(HOUSE)
    assert choice.curves(house) == ["living.operative_temperature", "bedroom.operative_temperature"]
    cell = mc.new_room("4x3x2.8", gap="ventilated", ceiling="plasterboard 12.5mm")
    assert any(output.name == "gap.operative_temperature" for output in cell.outputs())
    assert choice.curves(cell) == ["room.operative_temperature"]
    cooled = house.replace(
        {"zones.bedroom": {**house.to_dict()["zones"]["bedroom"], "cooling": {"setpoint": 26}}}
    )
    assert choice.curves(cooled)[2:] == ["bedroom.cooling_load"]


def test_parameters_that_do_not_exist_or_cannot_vary_are_named() -> None:
    with pytest.raises(InputError, match="absorptance"):
        Session(box(), box_climate(), parameters=["surfaces.facade.outside.absorptanc"])
    with pytest.raises(InputError, match="nothing in the building that matches"):
        Session(box(), box_climate(), parameters=["surfaces.*.nothing"])
    with pytest.raises(InputError, match="structural"):
        Session(mc.load(HOUSE), box_climate(), parameters=["site.latitude"])
    with pytest.raises(InputError, match="lower one first"):
        Session(box(), box_climate(), parameters=[ABSORPTANCE]).run({}, [26.0, 20.0])


def test_tied_parameters_have_one_slider() -> None:
    plain = box().to_dict()
    plain["materials"]["other"] = plain["materials"]["concrete"]
    plain["constructions"]["wall"]["layers"].append({"material": "other", "thickness": 0.1})
    building = mc.Building.from_dict(plain | {"ties": {"materials.*.density": "factor"}})
    assert [one.path for one in choice.named(building, ["materials.*.dens*"])] == ["materials.*.density"]
    assert [one.path for one in choice.named(building, ["materials.*.density"])] == ["materials.*.density"]
    one = "materials.concrete.density"
    assert [one.path for one in choice.named(building, [one])] == [one]


@pytest.fixture(scope="module")
def server(session: Session, saved: tuple[Path, Path]) -> Iterator[Server]:
    base, target = saved

    def save(content: Any) -> dict[str, str]:
        session.save(target, base, content["values"], {})
        return {"file": str(target)}

    made = Server(
        lambda token: explore_page(session, token, target),
        {"/run": lambda content: session.run(content["values"], content["band"]), "/save": save},
    )
    thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield made
    made.shutdown()
    made.server_close()
    thread.join()


def ask(server: Server, method: str, path: str, **headers: str) -> tuple[int, str]:
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=10)
    body = b'{"values": {}, "band": [20, 26]}' if method == "POST" else None
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body=body, headers=named)
    answer = connection.getresponse()
    found = answer.status, answer.read().decode()
    connection.close()
    return found


def test_the_server_answers_its_own_page_alone(server: Server) -> None:
    assert server.server_address[0] == "127.0.0.1"
    own, token = f"/?token={server.token}", {TOKEN: server.token}
    assert ask(server, "GET", own)[0] == 200
    assert ask(server, "POST", "/run", **token)[0] == 200
    refused = [
        ask(server, "GET", "/"),
        ask(server, "GET", "/?token=x"),
        ask(server, "GET", own, Host="evil.example"),  # another name for this computer
        ask(server, "GET", own, Host=f"evil.example:{server.server_port}"),
        ask(server, "POST", "/run"),
        ask(server, "POST", "/run", **{TOKEN: "x"}),
        ask(server, "POST", "/run", Host="evil.example", **token),
        ask(server, "POST", "/run", Origin="http://evil.example", **token),
    ]
    assert [status for status, _ in refused] == [403] * len(refused)
    assert all(server.token not in text for _, text in refused)
    assert ask(server, "POST", "/other", **token)[0] == 404


def test_a_port_in_use_is_named(
    server: Server, saved: tuple[Path, Path], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    words = ["explore", str(saved[0]), "--weather", "shipped:golden", "--parameters", ABSORPTANCE]
    words += ["--no-open", "--step", "1h", "-o", str(tmp_path / "x.yaml"), "--port", str(server.server_port)]
    assert cli.main(words) == 2
    assert f"--port: found {server.server_port}, which another program uses" in capsys.readouterr().err


@pytest.mark.browser
def test_a_slider_moves_the_curve(
    browser: Browser, server: Server, session: Session, saved: tuple[Path, Path]
) -> None:
    context = browser.new_context()
    page = context.new_page()
    messages: list[str] = []
    requests: list[str] = []
    page.on("console", lambda one: messages.append(one.text) if one.type == "error" else None)
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("request", lambda one: requests.append(one.url))
    page.goto(server.address)
    page.wait_for_selector("body[data-ready]")
    picture = "document.querySelector('#plots canvas').toDataURL()"
    before, table = page.evaluate(picture), page.locator("#comfort tbody").inner_text()
    slider = page.locator(f".slider[data-path='{ABSORPTANCE}']")
    slider.locator("input[type=range]").press("End")
    page.wait_for_selector("body[data-runs='1']")
    moved = page.evaluate(picture)
    assert moved != before
    highest = float(slider.locator("input[type=number]").input_value())
    hours = session.run({ABSORPTANCE: highest}, [20.0, 26.0])["comfort"][0]["hot_degree_hours"]
    assert hours > 1.0
    assert f"{hours:.1f}" in page.locator("#comfort tbody").inner_text() != table
    slider.locator("input[type=number]").fill("7")
    slider.locator("input[type=number]").press("Enter")
    slider.locator(".message:not([hidden])").wait_for()
    assert "expected 0 to 1" in slider.locator(".message").inner_text()
    slider.locator("input[type=number]").fill("0.25")
    slider.locator("input[type=number]").press("Enter")
    page.wait_for_selector("body[data-runs='2']")
    assert page.evaluate(picture) not in (before, moved)
    page.locator("#save").click()
    page.locator("#saved", has_text="Wrote ").wait_for()
    assert "saved.yaml" in page.locator("#saved code").inner_text()
    assert mc.load(saved[1]).parameter(ABSORPTANCE).value == 0.25
    assert messages == []
    assert {url.split("/")[2] for url in requests} == {f"127.0.0.1:{server.server_port}"}
    context.close()


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_ends_the_page_with_130(saved: tuple[Path, Path], tmp_path: Path) -> None:
    words = ["explore", str(saved[0]), "--weather", "shipped:golden", "--parameters", ABSORPTANCE]
    with subprocess.Popen(
        [sys.executable, "-m", "mascarin.cli", *words, "--no-open", "--step", "1h"],
        stderr=subprocess.PIPE, text=True, cwd=tmp_path,
    ) as process:  # fmt: skip
        guard = threading.Timer(100.0, process.kill)  # a command that hangs fails here
        guard.start()
        try:
            assert process.stderr is not None
            lines: list[str] = []
            while not (lines and lines[-1].startswith("Ctrl-C")):
                lines.append(process.stderr.readline())
                assert lines[-1], f"ended early: {lines}"
            assert lines[-2].startswith("http://127.0.0.1:")
            process.send_signal(signal.SIGINT)
            assert "interrupted" in process.stderr.read()
            assert process.wait() == 130
        finally:
            guard.cancel()
            process.kill()


def test_an_attic_is_shown_apart_from_the_rooms(tmp_path: Path) -> None:
    """It is no cavity, and 20 K warmer than the rooms: a common axis would hide what people feel."""
    file = tmp_path / "run.html"
    arguments = ["--weather", "shipped:saint-denis", "--start", "01-08", "--end", "01-09", "--step", "30min"]
    assert cli.main(["run", str(HOUSE), *arguments, "--report", str(file)]) == 0
    text = file.read_text(encoding="utf-8")
    rooms_first, _, others = text.partition("Air temperature of zones without windows, gains and loads")
    assert others
    assert 'class="swatch-line s0" aria-hidden="true"></span>attic' in others
    assert "</span>attic" not in rooms_first
    # Sentences about the weather follow each other; they are no list with commas.
    assert ".," not in text
    assert "step seconds" not in text
