"""Files of ``tests/support/idf_flows.py`` for EnergyPlus, and the table of its results that the tests read.

    python bench/energyplus_flows.py write FOLDER      # FOLDER/NAME.idf; run EnergyPlus 25.2 on each
    python bench/energyplus_flows.py read FOLDER       # FOLDER/NAME/eplusout.csv of each run

The weather is Chicago O'Hare TMY3 of the data folder. The table holds hourly means of the air temperature.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pandas as pd

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "support"))
from idf_flows import FLOWS  # noqa: E402

TABLE = ROOT / "tests" / "data" / "energyplus_flows.csv"


def write(folder: Path) -> None:
    """Write all files."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (text, _) in FLOWS.items():
        (folder / f"{name}.idf").write_text(text, encoding="utf-8")


def read(folder: Path) -> None:
    """Make the table from the runs."""
    columns = {}
    for name in FLOWS:
        results = pd.read_csv(folder / name / "eplusout.csv")
        columns[name] = results.filter(like="Zone Mean Air Temperature").iloc[:, 0].round(3)
    text = pd.DataFrame(columns).to_csv(index=False)
    TABLE.write_text(f"# EnergyPlus 25.2, bench/energyplus_flows.py [degC]\n{text}", encoding="utf-8")


if __name__ == "__main__":
    {"write": write, "read": read}[sys.argv[1]](Path(sys.argv[2]))
