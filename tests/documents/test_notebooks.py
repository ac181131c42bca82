"""The notebooks of the documentation run from the first cell to the last."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def test_there_are_three() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["1-run", "2-sensitivity", "3-study"]


@pytest.mark.filterwarnings("ignore")
def test_a_notebook_shows_each_figure_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the last value of a cell, with a semicolon behind it, and in the middle of a cell."""
    monkeypatch.delenv("MPLBACKEND")  # that of the other tests
    cells = [
        "import mascarin as mc\nfrom mascarin.examples import box, box_climate\n"
        "run = mc.simulate(box(), box_climate(), step='1h')",
        "run.plot('room.air_temperature')",
        "run.plot('room.air_temperature');",
        "figure = run.plot('room.air_temperature')\n1 + 1",
        "import matplotlib.pyplot as plt\nplt.get_fignums()",
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])  # type: ignore[no-untyped-call]
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    pictures = [
        sum("image/png" in output.get("data", {}) for output in cell.outputs) for cell in notebook.cells
    ]
    assert pictures == [0, 1, 1, 1, 0]
    assert notebook.cells[-1].outputs[0]["data"]["text/plain"] == "[]"


@pytest.mark.filterwarnings("ignore")  # those of the notebook's own process and of its messages
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    assert all(not cell.get("outputs") for cell in notebook.cells), "commit notebooks without outputs"
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [
        output.get("data", {})
        for cell in notebook.cells
        if cell.cell_type == "code"
        for output in cell.outputs
    ]
    assert any("text/html" in data for data in shown)
    assert not [data for data in shown if "Traceback" in data.get("text/plain", "")]
