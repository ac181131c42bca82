"""Several calorimeter files as one material, rates compared, supercooling in numbers, further exports."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import dsc_samples as samples
from mascarin import cli
from mascarin.errors import InputError
from mascarin.materials import from_dsc, from_dsc_files
from mascarin.materials.dsc_several import spread_of


def run_file(folder: Path, name: str, centre: float, rate: float) -> Path:
    """A heat flow per mass of a sample that melts about a centre, at a rate [K/min]."""
    t = samples.temperatures()
    flow = samples.heat(t, centre) * rate / 60.0 / 1000.0  # mW/mg
    seconds = (t - t[0]) / rate * 60.0
    columns = {"time [s]": seconds, "temperature [degC]": t, "DSC [mW/mg]": flow}
    return samples.write(folder / f"{name}.csv", columns)


def test_runs_of_one_rate_have_a_mean_and_a_spread(tmp_path: Path) -> None:
    shifts = (-0.3, 0.0, 0.3)
    files = [run_file(tmp_path, f"run{k}", samples.CENTRE + s, 0.2) for k, s in enumerate(shifts)]
    one, both = from_dsc(files[1]), from_dsc_files(files)
    assert both.main.half == pytest.approx(one.main.half, abs=0.01)
    assert both.main.latent_heat == pytest.approx(one.main.latent_heat, rel=1e-3)
    # Averaged at equal fraction: the mean is not broader than a run.
    width = [
        np.subtract(*np.interp([0.9, 0.1], run.fraction, run.temperature)) for run in (one.main, both.main)
    ]
    assert width[1] == pytest.approx(width[0], rel=0.01)
    spread = spread_of([from_dsc(file).main for file in files])["half liquid at"]
    assert spread.count == 3
    assert spread.deviation == pytest.approx(0.3, abs=0.005)
    assert any("mean of 3 of 3 runs at 0.2 K/min" in text and "+- 0.3 degC" in text for text in both.warnings)
    assert both.description(conductivity=0.2, density=800.0)["law"]["kind"] == "table"


def test_slower_runs_are_used_and_the_lag_is_extrapolated(tmp_path: Path) -> None:
    rates = (0.2, 1.0, 5.0)
    files = [
        run_file(tmp_path, f"rate{k}", samples.CENTRE + 0.4 * rate, rate) for k, rate in enumerate(rates)
    ]
    material = from_dsc_files(files)
    assert material.main.rate == pytest.approx(0.2, rel=1e-6)
    assert material.main.peak == pytest.approx(samples.CENTRE + 0.08, abs=0.06)
    [said] = [text for text in material.warnings if "without lag" in text]
    found = re.search(r"moves by \+([\d.]+) K for each K/min, to ([\d.]+) degC without lag", said)
    assert found is not None
    # The peak is a row of the file, every 0.05 K or so.
    assert float(found[1]) == pytest.approx(0.4, abs=0.02)
    assert float(found[2]) == pytest.approx(samples.CENTRE, abs=0.05)


def test_supercooling_in_numbers(tmp_path: Path) -> None:
    heating = samples.temperatures()
    cooling = np.concatenate(
        [np.linspace(heating[-1], 18.0, 400), np.linspace(18.0, 21.5, 40), np.linspace(21.5, heating[0], 300)]
    )
    t = np.concatenate([heating, cooling[1:]])
    flow = np.concatenate([samples.heat(heating), samples.heat(cooling[1:])])
    path = samples.write(
        tmp_path / "cold.csv",
        {
            "temperature [degC]": t,
            "cp [J/(kg K)]": flow,
            "direction": np.r_[np.zeros(len(heating)), np.ones(len(cooling) - 1)],
        },
    )
    text = path.read_text(encoding="utf-8").splitlines()
    names = ["heating", "cooling"]
    rows = [",".join([*row.split(",")[:2], names[int(float(row.split(",")[2]))]]) for row in text[1:]]
    path.write_text("\n".join([text[0], *rows]) + "\n", encoding="utf-8")
    material = from_dsc(path)
    cold = next(run for run in material.runs if run.direction == "cooling")
    assert cold.freezing is not None
    assert list(cold.freezing) == pytest.approx([18.0, 3.5])
    [said] = [text for text in material.warnings if "recalescence" in text]
    assert f"{material.main.onset - 18.0:.2f} K below the onset" in said
    assert material.to_dict()["runs"]["cooling"]["freezing"]["rise"] == pytest.approx(3.5)


@pytest.mark.parametrize("maker", ["PerkinElmer", "Setaram"])
def test_exports_with_the_temperature_of_the_furnace(maker: str, tmp_path: Path) -> None:
    t = samples.temperatures()
    rate, mass = 1.0, 12.5
    flow = samples.heat(t) * rate / 60.0 * mass * 1e-3  # mW
    minutes = (t - t[0]) / rate
    if maker == "PerkinElmer":
        columns = {
            "Time (min)": minutes,
            "Unsubtracted Heat Flow (mW)": flow,
            "Baseline Heat Flow (mW)": 0.0 * t,
            "Program Temperature (°C)": t + 0.4,
            "Sample Temperature (°C)": t,
        }
        head, separator = "Sample Weight: 12.5 mg\n", "\t"
    else:
        columns = {
            "Time (s)": 60.0 * minutes,
            "Furnace Temperature (°C)": t + 0.4,
            "Sample Temperature (°C)": t,
            "HeatFlow (mW)": flow,
        }
        head, separator = "Sample mass: 12.5 mg\n", ";"
    path = samples.write(tmp_path / "export.txt", columns, separator=separator, head=head)
    made = from_dsc(path, mass=mass)
    true = from_dsc(
        samples.write(tmp_path / "cp.csv", {"temperature [degC]": t, "cp [J/(kg K)]": samples.heat(t)})
    )
    assert made.main.latent_heat == pytest.approx(true.main.latent_heat, rel=1e-4)
    assert made.main.peak == pytest.approx(true.main.peak, abs=0.02)


def test_perkin_elmer_with_names_in_two_lines(tmp_path: Path) -> None:
    t = samples.temperatures()
    flow = samples.heat(t) * 1.0 / 60.0 * 12.5 * 1e-3  # mW at 1 K/min
    rows = [
        f"{k})\t{(a - t[0]):.4f}\t{b:.6f}\t0.0\t{a + 0.4:.4f}\t{a:.4f}"
        for k, (a, b) in enumerate(zip(t, flow, strict=True))
    ]
    head = (
        "Sample ID: wax\nSample Weight: 12.5 mg\n\tTime\tUnsubtracted\tBaseline\tProgram\tSample\n"
        "\t\tHeat Flow\tHeat Flow\tTemperature\tTemperature\n\tmin\tmW\tmW\t°C\t°C\n"
    )
    path = tmp_path / "pyris.txt"
    path.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    read = from_dsc(path)
    true = from_dsc(
        samples.write(tmp_path / "cp.csv", {"temperature [degC]": t, "cp [J/(kg K)]": samples.heat(t)})
    )
    assert read.main.latent_heat == pytest.approx(true.main.latent_heat, rel=1e-4)
    assert read.main.peak == pytest.approx(true.main.peak, abs=0.02)


def test_the_voltage_of_a_sensor_is_no_heat_flow(tmp_path: Path) -> None:
    t = samples.temperatures()
    path = samples.write(tmp_path / "raw.csv", {"Temp./°C": t, "DSC/(µV/mg)": samples.heat(t)})
    with pytest.raises(InputError, match=r"voltage of the sensor.*export mW/mg"):
        from_dsc(path)


def test_several_files_on_the_command_line_and_what_was_done_in_the_figure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [str(run_file(tmp_path, f"run{k}", samples.CENTRE + 0.1 * k, 0.2)) for k in range(2)]
    assert cli.main(["dsc", *files, "--plot", str(tmp_path / "curve.svg")]) == 0
    assert "mean of 2 of 2 runs" in capsys.readouterr().out
    axes = from_dsc(files[0]).plot().axes[1]
    assert "baseline; onset, end" in [line.get_label() for line in axes.lines]
    assert len([line for line in axes.lines if len(line.get_xdata()) == 2]) == 2  # type: ignore[arg-type]
