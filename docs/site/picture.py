"""The picture of the README: ``python docs/site/picture.py [FILE]`` writes docs/picture.svg, or FILE."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

import mascarin as mc
from mascarin.examples import STUDIES

OUT = Path(__file__).resolve().parents[1] / "picture.svg"
NAMES = ["room.air_temperature", "ceiling.inside_temperature", "ceiling.energain_liquid_fraction"]
PERIOD = {"start": "2010-08-10", "end": "2010-08-15"}


def main(file: Path = OUT) -> None:
    """Draw five days of the test cell, with and without latent heat, and its liquid fraction."""
    mpl.use("agg")
    mpl.rcParams["svg.hashsalt"] = "mascarin"  # the same file at each call
    from matplotlib import pyplot as plt

    study = mc.Study.from_yaml(STUDIES["lgi"])
    options = {**PERIOD, "measurements": study.measurements, "outputs": NAMES}
    cell = mc.simulate(study.building, study.climate, **options)
    dry = mc.simulate(
        study.building, study.climate, parameters={"materials.energain.latent_heat": 0.0}, **options
    )
    figure, (top, bottom) = plt.subplots(
        2, figsize=(8, 4.2), sharex=True, layout="constrained", height_ratios=[2, 1]
    )
    figure.patch.set_facecolor("white")
    for run, color, label in ((dry, "#a33a00", "no latent heat"), (cell, "#00578f", "phase-change ceiling")):
        air = run[NAMES[0]]
        top.plot(air.local_time, air, color=color, label=label)
    top.set_ylabel("room air [°C]")
    top.legend(frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1, 1))
    liquid = cell[NAMES[2]]
    bottom.fill_between(liquid.local_time, liquid, color="#00578f", alpha=0.3)
    bottom.plot(liquid.local_time, liquid, color="#00578f")
    bottom.set(ylabel="liquid fraction [-]", ylim=(0, 1))
    for ax in (top, bottom):
        ax.spines[["top", "right"]].set_visible(False)
    bottom.xaxis.set_major_formatter(mpl.dates.DateFormatter("%d %b"))
    metadata = {"Date": None} if file.suffix == ".svg" else None
    figure.savefig(file, metadata=metadata, dpi=200)
    print(file)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
