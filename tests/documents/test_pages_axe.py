"""Every kind of page: names of controls, contrast, order of headings, landmarks, and no width that scrolls.

The report, the page of Standard 140, the live page and the comparison with EnergyPlus have the same check in
their own files.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest
from axe_playwright_python.sync_playwright import Axe

import design_support
import mascarin as mc
from mascarin import cli
from mascarin.examples import FOLDER, box, box_climate
from mascarin.pages.explore import Server, Session
from mascarin.pages.explore.page import render as explore_page
from mascarin.pages.run.page import Notes
from mascarin.pages.run.page import render as run_page
from mascarin.pages.view import write as write_view

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

HOUSE: Final = FOLDER / "reunion_house" / "building.yaml"
#: Width [px] and colors.
LOOKS: Final = [(1280, "light"), (1280, "dark"), (390, "light"), (390, "dark")]


#: Names of the parts that have to be scrolled sideways.
CUT: Final = """[...document.querySelectorAll('.scroll')]
  .filter(e => e.offsetParent && e.scrollWidth > e.clientWidth + 1).map(e => e.getAttribute('aria-label'))"""


def accessible(page: Page, width: int, scheme: Any) -> list[str]:
    """What axe finds in an open page, and a page that is wider than the screen."""
    page.emulate_media(color_scheme=scheme)
    page.set_viewport_size({"width": width, "height": 800})
    page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    response = Axe().run(page).response
    assert response["passes"]
    faults = [f"{fault['id']}: {fault['nodes'][0]['target']}" for fault in response["violations"]]
    wide = page.evaluate("document.documentElement.scrollWidth")
    return faults if wide <= width else [*faults, f"{wide} px wide on {width} px"]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A page of each kind that is a file."""
    folder = tmp_path_factory.mktemp("pages")
    write_view(mc.load(HOUSE), folder / "view.html")
    notes = Notes(rooms=["room"], warnings=["zones.room: a warning"])
    (folder / "run.html").write_text(run_page(mc.simulate(box(), box_climate(), step="1h"), notes), "utf-8")
    study = folder / "study"
    study.mkdir()
    assert cli.main(["design", str(design_support.written(study)), "-o", str(folder / "designs")]) == 0
    return {
        "view": folder / "view.html",
        "run": folder / "run.html",
        "design": folder / "designs" / "report.html",
    }


@pytest.mark.parametrize(("width", "scheme"), LOOKS)
@pytest.mark.parametrize("kind", ["view", "run", "design"])
def test_axe_finds_nothing(page: Page, files: dict[str, Path], kind: str, width: int, scheme: str) -> None:
    page.goto(files[kind].as_uri())
    page.wait_for_load_state("load")
    assert accessible(page, width, scheme) == []
    # On a telephone nothing is out of sight but what has as many columns as a study has variables.
    cut = [name for name in page.evaluate(CUT) if name != "All designs"]
    assert cut == [] or width > 400


#: Texts of a drawing that cover each other or leave it.
COVERED: Final = """[...document.querySelectorAll('.series svg')].flatMap(svg => {
  const frame = svg.getBoundingClientRect();
  const boxes = [...svg.querySelectorAll('text')].map(e => [e.textContent, e.getBoundingClientRect()]);
  const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top + 1
    || b.bottom <= a.top + 1;
  return boxes.flatMap(([name, a], i) => [
    ...(a.top < frame.top - 2 || a.right > frame.right + 2 ? [`${name} leaves the drawing`] : []),
    ...boxes.slice(i + 1).filter(([, b]) => !apart(a, b)).map(([other]) => `${name} covers ${other}`)]);
})"""


#: Names of marks that leave their drawing, where a telephone cuts them.
CUT_NAMES: Final = """[...document.querySelectorAll('svg')].flatMap(svg => {
  const edge = svg.getBoundingClientRect().right;
  return [...svg.querySelectorAll('text.tick')].filter(e => e.getBoundingClientRect().right > edge + 1.5)
    .map(e => e.textContent);
})"""


@pytest.mark.parametrize("kind", ["run", "design"])
def test_no_name_of_a_mark_is_cut(page: Page, files: dict[str, Path], kind: str) -> None:
    page.set_viewport_size({"width": 390, "height": 800})
    page.goto(files[kind].as_uri())
    assert page.evaluate("document.querySelectorAll('svg text.tick').length") > 5
    assert page.evaluate(CUT_NAMES) == []


@pytest.mark.parametrize("width", [1280, 390])
def test_no_text_of_a_run_covers_another(page: Page, files: dict[str, Path], width: int) -> None:
    page.set_viewport_size({"width": width, "height": 800})
    page.goto(files["run"].as_uri())
    assert page.locator(".series svg .axis-label").count() > 0
    assert page.evaluate(COVERED) == []


def test_figures_of_a_run_are_printed_with_their_titles(page: Page, files: dict[str, Path]) -> None:
    """A title that may not follow a break ties its figure to the one before, and browsers break anywhere."""
    page.goto(files["run"].as_uri())
    page.emulate_media(media="print")
    rules = """[...document.querySelectorAll('.series')].map(e => [getComputedStyle(e).breakInside,
      getComputedStyle(e.querySelector("figcaption")).breakBefore,
      getComputedStyle(e.querySelector("figcaption")).breakAfter])"""
    assert page.evaluate(rules)
    assert set(map(tuple, page.evaluate(rules))) == {("avoid", "auto", "avoid")}


def test_names_over_a_building_are_in_their_places_on_paper_too(page: Page, files: dict[str, Path]) -> None:
    page.set_viewport_size({"width": 1280, "height": 900})
    page.goto(files["view"].as_uri())
    page.wait_for_selector("#canvas[data-drawn]")
    places = """[...document.querySelectorAll('#labels span:not([hidden])')].map(e => {
      const [a, b] = [e, document.getElementById('canvas')].map(x => x.getBoundingClientRect());
      return [e.textContent, (a.x + a.width/2 - b.x)/b.width, (a.y + a.height/2 - b.y)/b.height];
    })"""
    on_screen = page.evaluate(places)
    assert {"living", "attic"} <= {name for name, _, _ in on_screen}
    page.emulate_media(media="print")
    on_paper = page.evaluate(places)
    for (name, x, y), (same, x_paper, y_paper) in zip(on_screen, on_paper, strict=True):
        assert name == same
        assert (x_paper, y_paper) == pytest.approx((x, y), abs=0.02), name
    ratio = "(e => e.clientWidth / e.clientHeight)(document.getElementById('canvas'))"
    printed = page.evaluate(ratio)
    page.emulate_media(media="screen")
    assert printed == pytest.approx(page.evaluate(ratio), rel=0.02)


def test_axe_finds_nothing_in_suites(page: Page, tmp_path: Path, data_dir: Path) -> None:
    assert data_dir.is_dir()
    assert cli.main(["suites", "etna", "-o", str(tmp_path / "out")]) == 0
    page.goto((tmp_path / "out" / "suites.html").as_uri())
    for width, scheme in LOOKS:
        assert accessible(page, width, scheme) == []


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    """Sliders of a house with a room that does not count at first."""
    climate = mc.Climate.from_epw("shipped:tampa")
    site = {"latitude": 27.97, "longitude": -82.53, "altitude": 6.0, "timezone": "UTC-5"}
    plain = mc.load(HOUSE).to_dict()
    house = mc.Building.from_dict({**plain, "site": {**plain["site"], **site}})
    options = {"start": "07-01", "end": "07-03", "step": "30min"}
    session = Session(house, climate, parameters=["surfaces.roof_*.outside.absorptance"], options=options)
    made = Server(
        lambda token: explore_page(session, token, tmp_path / "saved.yaml"),
        {"/run": lambda content: session.run(content["values"], content["band"])},
    )
    thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield made
    made.shutdown()
    made.server_close()
    thread.join()


def test_axe_finds_nothing_in_explore_and_its_sums_count_what_is_ticked(
    browser: Browser, server: Server
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    page.goto(server.address)
    page.wait_for_selector("body[data-ready]")
    # On paper curves are as wide as their column, which is narrower than on the screen.
    page.emulate_media(media="print")
    page.evaluate("document.body.style.width = '680px'")
    right = "Math.max(...[...document.querySelectorAll('canvas')].map(e => e.getBoundingClientRect().right))"
    assert 600 < page.evaluate(right) <= 680
    page.evaluate("document.body.style.width = ''")
    page.emulate_media(media="screen")
    # Names for readers, and no values in the legend while the cursor is elsewhere.
    legend = page.locator("#plots .u-legend th").all_inner_texts()
    assert {"living", "bedroom", "outdoors", "as described"} <= set(legend)
    assert "attic" not in legend
    values = page.locator("#plots .u-legend .u-value").all()
    assert not any(value.is_visible() for value in values)
    assert not page.locator("#plots .u-legend .u-series").first.is_visible()

    def hours(row: str) -> float:
        cells = page.locator(f"#comfort tr:has-text('{row}') td").all_inner_texts()
        return float(cells[0].replace("−", "-"))

    boxes = {zone: page.locator(f"#comfort input[data-zone='{zone}']") for zone in mc.load(HOUSE).zones}
    ticked = {zone: box.is_checked() for zone, box in boxes.items()}
    assert ticked == {"living": True, "bedroom": True, "attic": False}
    assert hours("sum of the ticked") == pytest.approx(hours("living") + hours("bedroom"), abs=0.11)
    boxes["attic"].check()
    every = hours("living") + hours("bedroom") + hours("attic")
    assert hours("sum of the ticked") == pytest.approx(every, abs=0.6)  # whole hours above 99.95
    for width, scheme in LOOKS:
        assert accessible(page, width, scheme) == []
    assert page.evaluate(CUT) == []
    context.close()
