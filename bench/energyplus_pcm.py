"""Phase change in Mascarin and EnergyPlus, compared for the same ceiling in the same cell.

Four questions: Do both programs give the same melting along an enthalpy table? Is heat conserved in a
ceiling with hysteresis? What is the result for a steel sheet of 1 mm? What is the effect of the default
grid on a thin layer of phase-change material? The cell and its weather are those of `cell.py`. EnergyPlus
25.2 runs with steps of a minute and finite differences in the ceiling.

    python bench/energyplus_pcm.py --energyplus PATH [--days 92]

writes the numbers to `bench/energyplus_pcm.json` and the tables of `docs/pcm-energyplus.md` between its
marks.
"""

from __future__ import annotations

import argparse
import json
import re
import tempfile
from pathlib import Path
from typing import Any

import cell
import numpy as np
import numpy.typing as npt
import page
import pandas as pd

import energyplus
from mascarin.building import Building
from mascarin.building.engine_input.mesh import choose
from mascarin.building.parts.materials.material import PhaseChangeMaterial
from mascarin.simulation.results import Results
from mascarin.simulation.simulation import Simulation
from mascarin.weather import Climate

Array = npt.NDArray[np.float64]
Numbers = dict[str, Any]

ROOT = Path(__file__).resolve().parent.parent
NUMBERS = ROOT / "bench" / "energyplus_pcm.json"
PAGE = ROOT / "docs" / "pcm-energyplus.md"
STEP = 60.0
SETTLING = 10  # days left out of comparisons: the programs start from different states
MELTS, FREEZES, WIDTH = 22.0, 18.5, 0.8
"""Hysteresis as the product shows it, freezing 3.5 K below where it melts; half-width taken [degC, K]."""
NAMES = {
    **cell.OUTPUTS,
    "flux into the PCM": "ceiling.outside_flux",
    "flux out of the plasterboard": "ceiling.inside_flux",
}
FINE = energyplus.Scheme(60, ("ceiling",), 0.3, 5e-5)
DEFAULT = energyplus.Scheme(60, ("ceiling",))
MANY = energyplus.Scheme(60, ("ceiling",), 0.03)
EVERYWHERE = energyplus.Scheme(20, None)
ABOVE = energyplus.face_name("ceiling", "outside")
THEIRS = {
    "ceiling.outside_temperature": f"{ABOVE}.inside_temperature",
    "ceiling.outside_flux": f"{ABOVE}.inside_flux",
}


class Bench:
    """The cell, its weather, and both programs.

    Parameters
    ----------
    program : Path
        EnergyPlus.
    folder : Path
        Where it may write.
    days : int
        Length of the run.
    """

    def __init__(self, program: Path, folder: Path, days: int) -> None:
        self.program, self.folder, self.days = program, folder, days
        self.end = f"{pd.Timestamp(cell.START) + pd.Timedelta(days=days):%Y-%m-%d}"
        self.climate: Climate = cell.climate(cell.table())

    def ours(self, building: Building) -> tuple[pd.DataFrame, Results]:
        """Hourly means of the outputs of Mascarin, and the run."""
        run = Simulation(
            building,
            self.climate,
            step=STEP,
            start=cell.START,
            end=self.end,
            outputs=list(NAMES.values()),
            scheme="backward-euler",
        ).run()
        hours = run.records[1:].reshape(24 * self.days, -1, len(NAMES)).mean(axis=1)
        return pd.DataFrame(hours, columns=list(NAMES)), run

    def theirs(
        self,
        building: Building,
        scheme: energyplus.Scheme,
        phase_change: energyplus.Objects | None = None,
        specific_heat: float | None = None,
    ) -> tuple[pd.DataFrame, energyplus.Run]:
        """Hourly means of the outputs of EnergyPlus, fluxes positive towards the inside, and the run."""
        weather = self.folder / f"{scheme.per_hour}.epw"
        if not weather.exists():
            energyplus.write_weather(weather, self.climate, building, cell.START, self.end, scheme.per_hour)
        outputs = [
            *(THEIRS.get(name, name) for name in NAMES.values()),
            "roof.inside_flux",
            "roof.outside_flux",
        ]
        model = energyplus.write_model(
            building, scheme, cell.START, self.end, outputs, phase_change=phase_change
        )
        if specific_heat is not None:
            model["Material"]["ceiling energain"]["specific_heat"] = specific_heat
        run = energyplus.run(self.program, self.folder / "run", model, weather)
        frame = pd.DataFrame({label: run.records[THEIRS.get(name, name)] for label, name in NAMES.items()})
        # EnergyPlus counts a flux out of the wall as positive; at the gap that is away from the inside.
        frame["flux into the PCM"] *= -1.0
        return frame, run


def apart(theirs: pd.DataFrame, ours: pd.DataFrame) -> dict[str, float]:
    """Root mean square of the difference by output [K, W/m2]."""
    late = slice(24 * SETTLING, None)
    return {
        name: float(np.sqrt(np.mean((theirs[name].to_numpy()[late] - ours[name].to_numpy()[late]) ** 2)))
        for name in NAMES
    }


def balance(frame: pd.DataFrame) -> float:
    """Heat that entered the ceiling through both surfaces minus the heat that left it [MJ/m2]."""
    net = frame["flux into the PCM"] - frame["flux out of the plasterboard"]
    return float(net.iloc[24 * SETTLING :].sum() * 3600.0 / 1e6)


def capacity(building: Building, ours: pd.DataFrame) -> float:
    """Largest heat that the ceiling stores: complete melting, and its largest temperature change [MJ/m2]."""
    warmest = max(float(ours[name].max()) for name in ("PCM top", "plasterboard"))
    coldest = min(float(ours[name].min()) for name in ("PCM top", "plasterboard"))
    stored = 0.0
    for layer in building.constructions["ceiling"].layers:
        material = building.materials[layer.material]
        mass = energyplus.phase(material.density, "solid") * float(layer.thickness or 0.0)
        stored += mass * energyplus.phase(material.specific_heat, "solid") * (warmest - coldest)
        stored += mass * float(getattr(material, "latent_heat", None) or 0.0)
    return stored / 1e6


def nodes_in_pcm(listing: str) -> int:
    """Finite-difference nodes of the PCM layer, as the program lists them."""
    found = re.search(
        r"Material CondFD Summary,\s*ceiling energain\s*,[^,]*,\s*(\d+)", listing, re.IGNORECASE
    )
    if found is None:
        raise RuntimeError("EnergyPlus lists no nodes of the layer 'ceiling energain'")
    return int(found[1])


def tabulated(bench: Bench) -> Numbers:
    """Case 1: the same enthalpy curve in both; and what the default grid and tolerance do (case 4)."""
    building = cell.building()
    ours, _ = bench.ours(building)
    solid = energyplus.phase(building.materials["energain"].specific_heat, "solid")  # type: ignore[union-attr]
    ways = {"fine": (FINE, None), "default": (DEFAULT, None), "many": (MANY, None), "own heat": (FINE, solid)}
    found: Numbers = {}
    for key, (scheme, heat) in ways.items():
        frame, run = bench.theirs(building, scheme, None, heat)
        found[key] = {
            "nodes": nodes_in_pcm(run.listing),
            "apart": apart(frame, ours),
            "balance": balance(frame),
        }
    return found | {
        "capacity": capacity(building, ours),
        "ours": {"nodes": _own_nodes(building), "balance": balance(ours)},
    }


def _own_nodes(building: Building) -> int:
    return choose(building, STEP).nodes["ceiling", "energain"]


def hysteresis(bench: Bench) -> Numbers:
    """Case 2: different curves for heating and cooling."""
    plain = cell.building().replace(
        {
            "materials.energain.melting_temperature": MELTS,
            "materials.energain.law": {"kind": "tanh", "width": WIDTH},
        }
    )
    building = plain.replace(
        {"materials.energain.hysteresis": {"model": "curve_switch", "freezing_temperature": FREEZES}}
    )
    ours, run = bench.ours(building)
    material = building.materials["energain"]
    assert isinstance(material, PhaseChangeMaterial)
    described: dict[str, float] = {
        "latent_heat_during_the_entire_phase_change_process": float(material.latent_heat or 0.0),
        "peak_melting_temperature": MELTS,
        "peak_freezing_temperature": FREEZES,
    }
    for state in ("liquid", "solid"):
        described[f"{state}_state_thermal_conductivity"] = energyplus.phase(material.conductivity, state)
        described[f"{state}_state_density"] = energyplus.phase(material.density, state)
        described[f"{state}_state_specific_heat"] = energyplus.phase(material.specific_heat, state)
    for curve in ("melting", "freezing"):
        for side in ("high", "low"):
            described[f"{side}_temperature_difference_of_{curve}_curve"] = WIDTH
    objects = {"MaterialProperty:PhaseChangeHysteresis": {"energain": described}}
    theirs, _ = bench.theirs(plain, FINE, objects)
    default, _ = bench.theirs(plain, DEFAULT, objects)
    together = {"MaterialProperty:PhaseChangeHysteresis": {"energain": described | {
        "peak_freezing_temperature": MELTS}}}  # fmt: skip
    same, _ = bench.theirs(plain, FINE, together)
    return {
        "balance": {
            "ours": balance(ours),
            "fine": balance(theirs),
            "default": balance(default),
            "one curve": balance(same),
        },
        "capacity": capacity(building, ours),
        "closure": float(run.energy.closure),
        "apart": apart(theirs, ours),
    }


def thin_sheet(bench: Bench) -> Numbers:
    """Case 3: the steel sheet of 1 mm with finite differences, at a conductivity that EnergyPlus accepts."""
    building = cell.building().replace({"materials.steel.conductivity": 35.0})
    ours, _ = bench.ours(building)
    theirs, run = bench.theirs(building, EVERYWHERE)
    _, transfer = bench.theirs(building, DEFAULT)
    late = slice(24 * SETTLING, None)
    gap = theirs["gap air"].to_numpy()[late] - ours["gap air"].to_numpy()[late]
    return {
        "severe": len(re.findall(r"\*\* Severe", run.errors)),
        "kept": _kept(run),
        "kept by transfer functions": _kept(transfer),
        "apart": apart(theirs, ours),
        "largest_gap": float(np.abs(gap).max()),
    }


def _kept(run: energyplus.Run) -> float:
    """Heat flow into the sheet minus heat flow out of it, rms of hourly means: storage and errors. [W/m2]"""
    net = run.records["roof.inside_flux"] + run.records["roof.outside_flux"]
    return float(np.sqrt(np.mean(net.to_numpy()[24 * SETTLING :] ** 2)))


# --- The page -----------------------------------------------------------------------------------------------


def tables(numbers: Numbers) -> dict[str, str]:
    """Tables of the page by the name of their mark."""
    return {
        "tabulated": _tabulated(numbers["tabulated"]),
        "hysteresis": _hysteresis(numbers["hysteresis"]),
        "thin sheet": _thin_sheet(numbers["thin_sheet"]),
        "grid": _grid(numbers["tabulated"]),
    }


def _tabulated(case: Numbers) -> str:
    ways = {
        "fine": "space constant 0.3, tolerance 5e-5",
        "default": "as it comes",
        "own heat": "as the first, but given the specific heat of the solid",
    }
    rows = [
        [
            label,
            *(f"{case[way]['apart'][name]:.3f} K" for name in cell.OUTPUTS),
            f"{case[way]['apart']['flux into the PCM']:.2f} W/m2",
        ]
        for way, label in ways.items()
    ]
    return page.table(["rms of the difference", *cell.OUTPUTS, "flux into the PCM"], rows)


def _hysteresis(case: Numbers) -> str:
    ways = {
        "ours": "Mascarin",
        "fine": "EnergyPlus, space constant 0.3, tolerance 5e-5",
        "default": "EnergyPlus, as it comes",
        "one curve": "EnergyPlus, as the first, both curves at one place",
    }
    rows = [[label, f"{case['balance'][way]:+.3f} MJ/m2"] for way, label in ways.items()]
    most = ["at most stored between two states", f"{case['capacity']:.3f} MJ/m2"]
    return page.table(["program", "heat that went in and did not come out"], [*rows, most])


def _thin_sheet(case: Numbers) -> str:
    stays = "heat that enters the sheet and does not leave it, rms of hourly means"
    rows = [
        ["severe errors reported", str(case["severe"])],
        [stays, f"{case['kept']:.1f} W/m2"],
        [
            "the same by transfer functions: what the sheet stores",
            f"{case['kept by transfer functions']:.1f} W/m2",
        ],
        ["air of the gap against Mascarin, rms", f"{case['apart']['gap air']:.2f} K"],
        ["air of the gap against Mascarin, largest hourly mean", f"{case['largest_gap']:.1f} K"],
    ]
    return page.table(["quantity", "EnergyPlus, finite differences everywhere, 3 min"], rows)


def _grid(case: Numbers) -> str:
    ways = {
        "default": "EnergyPlus, as it comes",
        "fine": "EnergyPlus, space constant 0.3, tolerance 5e-5",
        "many": "EnergyPlus, space constant 0.03, tolerance as it comes",
    }
    rows = [
        [
            label,
            str(case[way]["nodes"]),
            f"{case[way]['apart']['PCM top']:.3f} K",
            f"{case[way]['balance']:+.3f} MJ/m2",
        ]
        for way, label in ways.items()
    ]
    own = ["Mascarin", str(case["ours"]["nodes"]), "", f"{case['ours']['balance']:+.3f} MJ/m2"]
    return page.table(
        ["program", "nodes in 5.26 mm of PCM", "PCM top, rms", "went in and did not come out"], [own, *rows]
    )


def filled(text: str, numbers: Numbers) -> str:
    """The page with its tables.

    Raises
    ------
    ValueError
        The page has no place for one of them.
    """
    for name, table in tables(numbers).items():
        text = page.filled(text, name, table)
    return text


def main() -> None:
    """Run the cases, write the numbers and the page."""
    options = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument("--energyplus", help="the program")
    options.add_argument("--days", type=int, default=92)
    given = options.parse_args()
    program = energyplus.program_of(given.energyplus)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(program, Path(folder), given.days)
        numbers: Numbers = {"days": given.days, "energyplus": "25.2"}
        for case in (tabulated, hysteresis, thin_sheet):
            numbers[case.__name__] = case(bench)
            print(case.__name__, json.dumps(numbers[case.__name__], indent=1))
    NUMBERS.write_text(json.dumps(numbers, indent=2) + "\n", encoding="utf-8")
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), numbers), encoding="utf-8")


if __name__ == "__main__":
    main()
