from __future__ import annotations

import gc
import os
import random
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import hypothesis.core
import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

ROOT = Path(__file__).resolve().parent.parent

os.environ["MPLBACKEND"] = "Agg"  # no window opens in a test
os.environ["MASCARIN_CACHE"] = "off"  # weather files are read, not what an earlier test kept of them

# Where this is set, each process of a test compiles the package anew, and pytest rewrites all asserts.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# What a test writes need not outlast a failure of the power.
os.fsync = lambda fd: None

# What is collected stays: looking for garbage among it takes a quarter of the time of the collection.
gc.disable()


SEED = "MASCARIN_TEST_SEED"


def pytest_configure(config: pytest.Config) -> None:
    """Give all workers one seed for random examples, so that a failure can be repeated."""
    given = config.getoption("--hypothesis-seed", default=None)
    seed = os.environ.setdefault(SEED, str(given or random.SystemRandom().randrange(2**32)))
    hypothesis.core.global_force_seed = int(seed)  # type: ignore[assignment]


def pytest_report_header() -> str:
    """Print the seed at the head of the report."""
    return f"seed of random examples: {os.environ[SEED]} (repeat with {SEED}={os.environ[SEED]})"


#: Files that take long: they begin first, so that no process waits for one of them at the end.
LONG = (
    "test_docs_engine.py", "test_crossing.py", "test_study.py", "test_report.py", "test_fuzz.py",
    "test_calibration_coverage.py", "test_docs.py", "test_calibration_sampled.py", "test_notebooks.py",
    "test_odd_inputs.py", "test_energyplus_small.py",
)  # fmt: skip


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Long files first; with ``--dist=loadfile --no-loadscope-reorder`` files are given out in this order."""
    rank = {name: number for number, name in enumerate(LONG)}
    items.sort(key=lambda item: rank.get(item.path.name, len(LONG)))


@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop() -> None:
    """Look for garbage again, but not among what was collected, and less often than in a small program."""
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)
    gc.enable()


DATA = "MASCARIN_DATA"
BROWSER = "MASCARIN_BROWSER"


def unavailable(reason: str, demanded_by: str) -> NoReturn:
    """Skip a test for something that is missing, or fail it where the environment variable demands it."""
    if os.environ.get(demanded_by):
        pytest.fail(f"{reason} ({demanded_by} is set: nothing may be skipped)", pytrace=False)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def repository() -> Path:
    """Root of the repository."""
    return ROOT


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of measured and reference data: MASCARIN_DATA, or shared/data beside the repository.

    Where MASCARIN_DATA is set, nothing is skipped: what is missing fails. Where it is not, as on a fork, the
    tests that read measured data are skipped, continuous integration included.
    """
    folder = Path(os.environ.get(DATA) or ROOT.parent / "shared" / "data")
    if not folder.is_dir():
        unavailable(f"no folder of measured data at {folder}: set {DATA}", DATA)
    return folder


WASM = "MASCARIN_WASM"


@pytest.fixture(scope="session")
def wasm() -> Path:
    """The engine for browsers, which `make build` compiles where Rust has the target."""
    file = ROOT / "python" / "mascarin" / "pages" / "live" / "engine.wasm"
    if not file.is_file():
        unavailable("no engine for browsers: rustup target add wasm32-unknown-unknown, make build", WASM)
    return file


#: Files that read the same weather and tables many times, and judge what comes after.
AFTER_READING = (
    "test_crossing.py", "test_design.py", "test_docs.py", "test_odd_inputs.py", "test_study.py",
    "test_study_carried.py", "test_study_experiments.py", "test_study_forms_used.py",
    "test_study_objects.py", "test_templates.py",
)  # fmt: skip


@pytest.fixture(autouse=True, scope="module")
def _kept_weather(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """What reading and checking a file gave is kept, as for a user, in a folder of this process."""
    with pytest.MonkeyPatch.context() as patch:
        if request.path.name in AFTER_READING:
            patch.setenv("MASCARIN_CACHE", str(tmp_path_factory.getbasetemp() / "cache"))
        yield


@pytest.fixture(autouse=True, scope="session")
def _engine_for_browsers() -> None:
    """Let tests that write a page in which the model runs, and do not open it, do without its engine."""
    if not (ROOT / "python" / "mascarin" / "pages" / "live" / "engine.wasm").is_file():
        from mascarin.pages.live import engine

        vars(engine)["module"] = lambda: b"\0asm"


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A headless Chromium. It ends with its file of tests: its event loop would be in the way of others."""
    from playwright.sync_api import sync_playwright

    program = os.environ.get(BROWSER) or shutil.which("chromium") or shutil.which("google-chrome")
    if program is None or not Path(program).is_file():
        unavailable(f"no Chromium: set {BROWSER} to the program", BROWSER)
    flags = ["--no-sandbox", "--disable-background-networking", "--disable-sync"]
    flags += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]  # WebGL drawn by the processor
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=flags)
        try:
            yield browser
        finally:
            browser.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """An empty page that reaches nothing but local files."""
    context = browser.new_context(offline=True)
    context.set_default_timeout(180_000)  # curves are drawn by the processor, which may be busy
    yield context.new_page()
    context.close()


@pytest.fixture(autouse=True)
def _figures() -> Iterator[None]:
    """Figures of pyplot that a test has left open are closed: matplotlib warns of more than 20."""
    yield
    if (pyplot := sys.modules.get("matplotlib.pyplot")) is not None:
        pyplot.close("all")
