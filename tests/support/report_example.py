"""A study and its series as the report gets them: made up, but shaped like those of the cell and the wall."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from mascarin.building import load
from mascarin.pages.study.data.series import Column, Series

if TYPE_CHECKING:
    from mascarin.building import Building

Array = npt.NDArray[np.float64]
LGI = Path(__file__).resolve().parents[2] / "python" / "mascarin" / "examples" / "lgi"
SENSORS = {
    "room_air": ("Room air", "room.air_temperature"),
    "plasterboard_face": ("Plasterboard face", "ceiling.inside_temperature"),
    "pcm_plasterboard": ("PCM/plasterboard", "ceiling.energain_plasterboard_temperature"),
    "pcm_top": ("PCM top", "ceiling.outside_temperature"),
    "gap_air": ("Gap air", "air_gap.air_temperature"),
    "steel_sheet": ("Steel sheet", "roof.inside_temperature"),
}
FITTED = {
    "surfaces.roof.outside.absorptance": (0.85, 0.731, 0.60, 0.95, "-", 0.85, 0.76),
    "surfaces.roof.outside.convection.factor": (1.0, 1.137, 0.5, 1.6, "-", None, None),
    "surfaces.ceiling.outside.convection.factor": (1.0, 1.62, 0.4, 2.5, "-", None, None),
    "surfaces.roof.inside.convection.factor": (1.0, 0.88, 0.4, 2.5, "-", None, None),
    "surfaces.ceiling.inside.convection.factor": (1.0, 1.21, 0.4, 2.5, "-", None, None),
    "materials.energain.law.width": (1.0, 2.37, 0.4, 6.0, "K", 1.0, 4.0),
    "materials.energain.melting_temperature": (23.4, 22.6, 20.5, 25.0, "degC", None, None),
    "site.sky.a": (0.758, 0.7434, 0.70, 0.82, "-", None, None),
    "materials.mask.resistance": (0.15, 0.5, 0.01, 0.5, "m2 K/W", None, None),
}
PAPER = {
    "identification": [(0.2, -0.5, 6.2, 2.1), (0.4, -1.1, 8.9, 2.9), (0.4, -1.3, 8.8, 3.1),
                       (0.5, -1.7, 9.8, 2.3), (1.0, -2.6, 9.4, 3.1), (1.3, 3.5, 9.4, 3.2)],
    "corroboration": [(0.2, 0.6, 5.6, 2.1), (0.5, 1.5, 9.2, 3.4), (0.5, 1.7, 8.9, 3.6),
                      (0.5, 1.7, 9.9, 2.8), (1.3, 3.4, 8.9, 3.2), (1.6, 4.7, 9.8, 3.3)],
}  # fmt: skip
PERIODS = {
    "identification": [["2010-09-20T00:00", "2010-09-25T00:00"]],
    "corroboration": [["2010-10-02T00:00", "2010-10-06T00:00"]],
    "blind": [["2010-08-01T00:00", "2010-09-13T00:00"], ["2010-09-25T00:00", "2010-10-02T00:00"],
              ["2010-10-06T00:00", "2010-11-01T00:00"]],
}  # fmt: skip


def lgi() -> tuple[dict[str, Any], Series]:
    """A study of the LGI cell with made-up models."""
    series = _lgi_series()
    building = load(LGI / "building.yaml")
    study: dict[str, Any] = {
        "title": "The LGI cell: a phase-change ceiling under a dark steel roof",
        "intro": [
            "A closed cell on Reunion Island carries a dark blue steel roof. Below it lies an air gap, "
            "and below the gap a ceiling of plasterboard backed by a sheet that melts near 23 °C. This page "
            "follows one model of the cell from its first comparison with the data to days it never saw.",
            "The model is first compared as described, then the parameters that matter are found, "
            "identified on five days, frozen, and judged on all the others.",
        ],
        "observed": {
            "label": "virtual experiment",
            "note": "The campaign's measurements are not public. What stands in for them is a virtual "
            "experiment: an independent program with sealed parameters made the temperatures, and sensor "
            "errors were added. Numbers from the paper are a scale to read ours by.",
        },
        "mascarin_version": "0.1.0",
        "created": "2026-11-21T11:30:00",
        "seed": 20120920,
        "timezone": "UTC+4",
        "run_time": 84.2,
        "command": ["pip install mascarin==0.1.0", "mascarin study lgi -o out/"],
        "inputs": [
            {"name": "building.yaml", "sha256": "5f1d" * 16, "note": "the cell"},
            {"name": "lgi_virtual.csv", "sha256": "09ac" * 16, "note": "the virtual experiment"},
        ],
        "versions": {
            "mascarin": "0.1.0",
            "numpy": "2.4.6",
            "scipy": "1.17.1",
            "pvlib": "0.16.1",
            "Python": "3.11.7",
        },
        "sources": [
            {"text": "Guichard et al., Energies 9(1), 2016.", "doi": "10.3390/en9010009"},
            {"text": "Li, Jiang, Coimbra, Solar Energy 144, 2017.", "doi": "10.1016/j.solener.2017.01.006"},
            {"text": "Walton, Thermal Analysis Research Program Reference Manual, NBSIR 83-2655, 1983."},
        ],
        "sensor_info": {
            key: {"label": label, "output": output, "unit": "degC", "uncertainty": 0.3}
            for key, (label, output) in SENSORS.items()
        },
        "periods": {
            "identification": {"label": "Identification", "note": "parameters are fitted here"},
            "corroboration": {"label": "Corroboration", "note": "frozen parameters"},
            "blind": {"label": "All other days", "note": "never looked at while fitting"},
        },
        "models": {
            "fitted": {"label": "fitted", "note": "nine parameters identified"},
            "nominal": {"label": "nominal", "note": "as described, before identification"},
            "paper": {"label": "paper's constants", "note": "constant films, 5.7 V + 11.4 outside"},
        },
        "reference": {
            "label": "paper",
            "note": "they come from measurements on the real cell, ours from a virtual experiment.",
            "sensors": {
                key: {
                    period: dict(
                        zip(
                            ("sd", "max_error", "max_error_percent", "mean_error_percent"),
                            rows[n],
                            strict=True,
                        )
                    )
                    for period, rows in PAPER.items()
                }
                for n, key in enumerate(SENSORS)
            },
        },
        "building": _building(building),
        "assumptions": [
            {
                "path": p.path,
                "value": p.value,
                "unit": p.unit,
                "low": p.low,
                "high": p.high,
                "source": p.source,
            }
            for p in building.parameters()
            if p.assumed
        ],
        "quality": [],
        "identification": [
            ["Method", "gradient least squares, 12 starts"],
            ["Evaluations", "148"],
            ["Same minimum reached by", "10 of 12 starts, cost within 0.1 %"],
            ["Cost", "2.31 K (sum over sensors), before 7.94 K"],
        ],
        "notes": [
            {
                "title": "The steel sheet errs most when the wind turns",
                "text": "Its error follows the wind, not the sun: the film outside decides it.\n\nThe gap "
                "inherits half of that error, the room almost nothing.",
            }
        ],
    }
    for period, spans in PERIODS.items():
        study["periods"][period]["spans"] = spans
    study["sensors"] = _metrics(study, series)
    study["criteria"] = _criteria(study)
    study["parameters"] = _parameters()
    study["correlation"] = _correlation(list(FITTED))
    seven = {path: study["parameters"][path] for path in list(FITTED)[:1]}
    study["models"].setdefault("the paper's seven", {"label": "the paper's seven", "note": "alone"})
    study["variant_parameters"] = {"the paper's seven": seven}
    _add_sensitivity(study)
    _add_residuals(study, series)
    study["reference"] |= {
        "tables": {"influential": "table 3", "identification": "table 5"},
        "influential": [
            {"frequency": 218, "symbol": "alpha_CI", "parameter": "surfaces.roof.outside.absorptance"}
        ],
    }
    study["frequencies"] = {"surfaces.roof.outside.absorptance": 24}
    _add_shortfall(study)
    _add_energy(study)
    return study, series


def _add_shortfall(study: dict[str, Any]) -> None:
    """Aims, some missed, and the parameters that would lead to them."""
    sd = {s: study["sensors"][s]["blind"]["fitted"]["sd"] for s in study["sensors"]}
    study["aims"] = [
        {"name": "standard deviation", "sensor": s, "period": "blind", "metric": "sd", "value": value,
         "limit": 0.2, "unit": "degC", "passed": value <= 0.2, "model": "fitted"}
        for s, value in sd.items()
    ]  # fmt: skip
    first, second = "constructions.roof.layers.steel.thickness", "site.cloud.c3"
    study["shortfall"] = {
        "period": "blind",
        "sd": sd,
        "steps": [
            {"path": first, "changes": {first: 0.3}, "sd": {s: 0.9 * value for s, value in sd.items()}},
            {
                "path": second,
                "changes": {first: 0.33, second: -0.125},
                "sd": {s: 0.8 * value for s, value in sd.items()},
            },
        ],
        "all_parameters": {"parameters": 173, "sd": {s: 0.7 * value for s, value in sd.items()}},
    }


def _building(building: Building) -> dict[str, Any]:
    """The cell's description in the words of the payload."""

    def layer(one: Any) -> dict[str, Any]:
        material = building.materials[one.material]
        entry: dict[str, Any] = {"name": one.name, "material": one.material, "kind": material.kind}
        if one.thickness is not None:
            entry["thickness"] = float(one.thickness)
        for key in ("conductivity", "density", "resistance"):
            value = getattr(material, key, None)
            if value is not None:
                pair = hasattr(value, "solid")
                entry[key] = [float(value.solid), float(value.liquid)] if pair else float(value)
        return entry

    def facing(side: Any) -> str:
        return "outdoors" if side.outdoors else side.zone or f"measured {side.measured}"

    return {
        "name": building.name,
        "site": [["Latitude", "−21.34°"], ["Altitude", "55 m"]],
        "zones": [{"name": name, "volume": float(zone.volume or 0)} for name, zone in building.zones.items()],
        "constructions": [
            {"name": name, "layers": [layer(one) for one in construction.layers]}
            for name, construction in building.constructions.items()
        ],
        "surfaces": [
            {
                "name": name,
                "construction": s.construction,
                "area": float(s.area or 0),
                "tilt": float(s.tilt or 0),
                "azimuth": float(s.azimuth or 0),
                "outside": facing(s.outside),
                "inside": facing(s.inside),
                "film_outside": s.outside.convection.kind if s.outside.convection else "",
                "film_inside": s.inside.convection.kind if s.inside.convection else "",
                "vertices": [[float(c) for c in vertex] for vertex in s.vertices or ()],
            }
            for name, s in building.surfaces.items()
        ],
        "choices": [["sky", building.site.sky.kind], ["long-wave in room", "radiosity"]],
    }


def _lgi_series() -> Series:
    """The series of the cell: each call has its own columns of the same values."""
    columns = {name: Column(c.values.copy(), c.label, c.unit) for name, c in _lgi_columns().items()}
    return Series("2010-08-01T00:00", 900.0, columns)


@cache
def _lgi_columns() -> dict[str, Column]:
    with (LGI / "lgi_virtual.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    table = {key: np.array([float(row[key]) for row in rows]) for key in rows[0] if key != "time"}
    rng = np.random.default_rng(4)
    n = len(rows)
    hour = np.arange(n) * 0.25 % 24.0
    sun = table["global_horizontal"] / 1000.0
    columns: dict[str, Column] = {}
    for number, (key, (label, _)) in enumerate(SENSORS.items()):
        seen = table[key]
        size = (0.12, 0.15, 0.17, 0.17, 0.5, 0.65)[number]
        slow = _red(rng, n, 0.97) * size
        fitted = seen + slow + 0.4 * size * np.cos((hour - 14.0) / 24.0 * 2 * np.pi)
        nominal = seen + 2.0 * slow + (1.0 + 3.0 * sun) * size
        paper = seen + 1.5 * slow - 2.2 * size * sun + 0.8 * size * np.sin(hour / 24.0 * 2 * np.pi)
        for model, values in (("observed", seen), ("fitted", fitted), ("nominal", nominal), ("paper", paper)):
            columns[f"{model}/{key}"] = Column(values, label, "degC")
    fraction = 0.5 + 0.5 * np.tanh((table["pcm_plasterboard"] - 22.6) / 2.37)
    columns["weather/outdoor_air"] = Column(table["outdoor_air"], "Outdoor air", "°C")
    columns["weather/global"] = Column(table["global_horizontal"], "Global radiation", "W/m²")
    columns["weather/wind"] = Column(table["wind_speed"], "Wind", "m/s")
    columns["state/ceiling.energain_liquid_fraction"] = Column(fraction, "Liquid fraction of the ceiling", "")
    return columns


def _red(rng: np.random.Generator, n: int, keep: float) -> Array:
    noise = rng.normal(size=n) * np.sqrt(1.0 - keep * keep)
    values = np.empty(n)
    values[0] = noise[0]
    for i in range(1, n):
        values[i] = keep * values[i - 1] + noise[i]
    return values


def _metrics(study: dict[str, Any], series: Series) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for sensor in study["sensor_info"]:
        for period, entry in study["periods"].items():
            pick = np.concatenate([np.arange(len(series))[series.slice_of(*span)] for span in entry["spans"]])
            seen = series.columns[f"observed/{sensor}"].values[pick]
            extent = float(np.ptp(seen))
            for model in study["models"]:
                error = series.columns[f"{model}/{sensor}"].values[pick] - seen
                worst = float(error[np.argmax(np.abs(error))])
                found.setdefault(sensor, {}).setdefault(period, {})[model] = {
                    "n": len(error),
                    "bias": float(error.mean()),
                    "sd": float(error.std()),
                    "rmse": float(np.sqrt(np.mean(error**2))),
                    "mean_error": float(np.abs(error).mean()),
                    "max_error": worst,
                    "mean_error_percent": 100 * float(np.abs(error).mean()) / extent,
                    "max_error_percent": 100 * abs(worst) / extent,
                }
    return found


def _criteria(study: dict[str, Any]) -> list[dict[str, Any]]:
    limits = {"room_air": 1.0, "plasterboard_face": 2.0, "pcm_top": 2.0}
    found = []
    for model in ("fitted", "nominal"):
        for period in ("identification", "corroboration"):
            for sensor in study["sensor_info"]:
                metrics = study["sensors"][sensor][period][model]
                rules = [("largest error within 10 % of the range", metrics["max_error_percent"], 10.0, "%")]
                if sensor in limits:
                    limit = limits[sensor]
                    rules.append(
                        (f"largest error within {limit:g} K", abs(metrics["max_error"]), limit, "degC")
                    )
                found += [
                    {"name": name, "sensor": sensor, "period": period, "model": model, "value": value,
                     "limit": limit, "unit": unit, "passed": value <= limit}
                    for name, value, limit, unit in rules
                ]  # fmt: skip
    return found


def _parameters() -> dict[str, Any]:
    entries: dict[str, Any] = {}
    for path, (nominal, fitted, low, high, unit, before, after) in FITTED.items():
        half = 0.03 * (high - low)
        entry: dict[str, Any] = {
            "nominal": nominal,
            "fitted": fitted,
            "unit": unit,
            "range": [low, high],
            "low": max(low, fitted - half),
            "high": min(high, fitted + half),
        }
        if before is not None:
            entry |= {"reference_nominal": before, "reference_fitted": after}
        if fitted in (low, high):
            entry |= {"at_bound": True, "reason": "beyond 0.5 m² K/W the mask no longer acts on any sensor"}
        entries[path] = entry
    return entries


def _correlation(paths: list[str]) -> dict[str, Any]:
    factor = np.random.default_rng(2).normal(size=(len(paths), 6))
    matrix = np.corrcoef(factor)
    return {"paths": paths, "matrix": matrix.tolist()}


def _add_sensitivity(study: dict[str, Any]) -> None:
    rng = np.random.default_rng(8)
    idle = [f"surfaces.wall_{side}.outside.absorptance" for side in ("north", "south", "east", "west")]
    paths = [*FITTED, *idle, "zones.room.infiltration.constant", "materials.polyurethane.conductivity"]
    study["sensitivity_design"] = [
        ["Method", "spectral, random phases and assignments"],
        ["Parameters", "318"],
        ["Runs", "8 × 2561"],
        ["Resolution of a share", "0.3 %"],
    ]
    for number, sensor in enumerate(study["sensor_info"]):
        weight = rng.exponential(size=len(paths)) ** 2 + 1e-3
        weight[number % len(FITTED)] += 6.0
        share = 0.96 * weight / weight.sum()
        study.setdefault("sensitivity", {})[sensor] = {
            path: {
                "share": float(s),
                "low": float(0.85 * s),
                "high": float(1.15 * s),
                "effect": float(3 * s**0.5),
            }
            for path, s in zip(paths, share, strict=True)
        }
        frequency = np.arange(1, 1281)
        power = rng.exponential(size=1280) * 2e-5
        order = np.argsort(-share)[:7]
        placed = rng.choice(np.arange(20, 318), size=7, replace=False)
        power[placed - 1] = share[order]
        study.setdefault("spectra", {})[sensor] = {
            "frequencies": frequency.tolist(),
            "power": power.tolist(),
            "threshold": 2.5e-3,
            "peaks": [
                {"frequency": int(f), "power": float(share[k]), "path": paths[k], "harmonic": 1}
                for f, k in zip(placed, order, strict=True)
            ],
        }
        hours = np.arange(0.0, 24.01, 0.5)
        turn = rng.uniform(0, 24, size=6)
        rows = share[order[:6], None] * (1 + 0.8 * np.cos((hours - turn[:, None]) / 12 * np.pi))
        study.setdefault("day_shares", {})[sensor] = {
            "hours": hours.tolist(),
            "paths": [paths[k] for k in order[:6]],
            "share": (0.94 * rows / rows.sum(axis=0)).tolist(),
        }


def _add_residuals(study: dict[str, Any], series: Series) -> None:
    rng = np.random.default_rng(11)
    for sensor in study["sensor_info"]:
        error = series.columns[f"fitted/{sensor}"].values - series.columns[f"observed/{sensor}"].values
        error = error - error.mean()
        lags = np.arange(0, 193, 2)
        acf = [float(np.mean(error[: len(error) - k] * error[k:]) / np.mean(error**2)) for k in lags]
        power = np.abs(np.fft.rfft(error)[1:]) ** 2
        frequency = np.fft.rfftfreq(len(error), 0.25 / 24.0)[1:]
        by_hour = error[: len(error) // 96 * 96].reshape(-1, 24, 4)
        study.setdefault("residuals", {})[sensor] = {
            "period": "blind",
            "acf_lags": (lags * 0.25).tolist(),
            "acf": acf,
            "acf_band": 0.021,
            "periodogram_frequency": frequency.tolist(),
            "periodogram_cumulative": (np.cumsum(power) / power.sum()).tolist(),
            "periodogram_band": 0.05,
            "hour_mean": by_hour.mean(axis=(0, 2)).tolist(),
            "hour_sd": by_hour.std(axis=(0, 2)).tolist(),
            "correlation": dict(
                zip(
                    ("sun", "wind", "outdoor air", "sky"),
                    rng.uniform(-0.9, 0.9, size=4).tolist(),
                    strict=True,
                )
            ),
            "correlation_band": 0.08,
            "correlation_lag": {"sun": 1.5},
            "cross_lags": [0.0, 1.0, 2.0],
            "cross_correlation": {"sun": [0.1, 0.4, None], "wind": [0.0, -0.1, -0.2]},
            "daily_cycle": {
                "measured_amplitude": 3.0,
                "measured_peak": 14.5,
                "simulated_amplitude": 3.1,
                "simulated_peak": 14.75,
                "delay_minutes": 15.0,
            },
            "effective_n": 214.0,
        }


def _add_energy(study: dict[str, Any]) -> None:
    study["ledger"] = {
        "closure": 3.1e-13,
        "model": "fitted",
        "terms": [
            {"label": "Sun absorbed outside", "value": 3480.2},
            {"label": "Long-wave to sky and ground", "value": -1912.4},
            {"label": "Convection outside", "value": -1466.9},
            {"label": "Infiltration", "value": -18.3},
            {"label": "Through the floor", "value": -81.7},
            {"label": "Stored", "value": 0.9},
        ],
    }
    t = np.linspace(15.0, 42.0, 300)
    law = 3.134 * (t - 15.0) + 71.0 * (0.5 + 0.5 * np.tanh((t - 22.6) / 2.37))
    path = 26.0 + 8.0 * np.sin(np.linspace(0, 40, 1200)) * np.linspace(0.4, 1.0, 1200)
    study["phase_change"] = [
        {
            "label": "Energain in the ceiling",
            "temperature": path.tolist(),
            "enthalpy": np.interp(path, t, law).tolist(),
            "law_temperature": t.tolist(),
            "law_enthalpy": law.tolist(),
            "days": [
                {
                    "label": "coldest",
                    "temperature": path[:96].tolist(),
                    "enthalpy": np.interp(path[:96], t, law).tolist(),
                }
            ],
            "column": "state/ceiling.energain_liquid_fraction",
            "rows": [["Melting temperature", "22.6 °C"], ["Half-width", "2.37 K (gamma 0.017)"]],
        }
    ]


def wall() -> tuple[dict[str, Any], Series]:
    """A study of a single wall with two sensors, as short as possible; one sensor is stuck for some time."""
    rng = np.random.default_rng(1)
    n = 10 * 1440
    hour = np.arange(n) / 60.0
    interface = 21.0 + 2.0 * np.sin(hour / 24 * 2 * np.pi) + 0.05 * rng.normal(size=n)
    inside = 24.0 + 6.0 * np.sin((hour - 3) / 24 * 2 * np.pi) + 0.05 * rng.normal(size=n)
    inside[6000:9000] = np.nan
    columns = {
        "observed/interface": Column(interface, "Interface", "degC"),
        "observed/insulation": Column(inside, "Insulation", "degC"),
        "nominal/interface": Column(interface + 0.6, "Interface", "degC"),
        "nominal/insulation": Column(inside - 1.0, "Insulation", "degC"),
        "fitted/interface": Column(interface + 0.1 * np.sin(hour), "Interface", "degC"),
        "fitted/insulation": Column(inside + 0.2 * np.cos(hour), "Insulation", "degC"),
    }
    series = Series("2024-09-04T10:00", 60.0, columns)
    study: dict[str, Any] = {
        "title": "A wall at Anglet",
        "sensor_info": {
            "interface": {"label": "Interface", "output": "wall.interface_1_temperature", "unit": "degC"},
            "insulation": {"label": "Mid insulation", "output": "probe.temperature", "unit": "degC"},
        },
        "periods": {
            "identification": {"label": "First days", "spans": [["2024-09-04T10:00", "2024-09-11T10:00"]]},
            "corroboration": {"label": "Last days", "spans": [["2024-09-11T10:00", "2024-09-14T10:00"]]},
        },
        "models": {"nominal": {"label": "nominal"}, "fitted": {"label": "fitted"}},
        "quality": [
            {"channel": "T_ins_1", "kind": "stuck", "start": "2024-09-07T05:08", "end": "2024-09-14T23:59",
             "count": 11212, "detail": "20.444 all the time", "masked": True}
        ],
        "building": {
            "name": "wall",
            "constructions": [
                {
                    "name": "facade",
                    "layers": [
                        {"name": "insulation", "material": "wool", "thickness": 0.14, "conductivity": 0.031},
                        {"name": "concrete", "material": "concrete", "thickness": 0.2, "conductivity": 1.3},
                    ],
                }
            ],
            "surfaces": [
                {"name": "wall", "construction": "facade", "area": 7.0, "tilt": 90.0, "azimuth": 180.0,
                 "outside": "outdoors", "inside": "measured Tint"}
            ],
            "probes": [{"name": "probe", "surface": "wall", "depth": 0.07}],
        },
    }  # fmt: skip
    return study, series
