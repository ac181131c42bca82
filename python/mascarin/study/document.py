"""The content of ``study.json``: everything a study found, in plain numbers and words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin.examples import STUDIES
from mascarin.study.phase_change import law_curve, melting_layers, path
from mascarin.study.pipeline import scores_of
from mascarin.study.prediction_intervals import band_entry, band_table
from mascarin.validation.error_sources import words
from mascarin.validation.observation import PERIODS

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.building import Building
    from mascarin.calibration import Fit, Profile
    from mascarin.sensitivity import Sensitivity
    from mascarin.sensitivity.spectral import SpectralSensitivity
    from mascarin.study.description import IdentificationPlan, StudyFile
    from mascarin.study.phase_change import MeltingLayer
    from mascarin.study.pipeline import Findings, ModelRun, Study
    from mascarin.study.prediction_intervals import Band
    from mascarin.validation.criteria import Verdict

#: Parameters named in the spectra and shares over the day.
_SHOWN: Final = 8
_COSTS: Final = {
    "nll": "negative log-likelihood",
    "sd": "sum of the standard deviations",
    "rmse": "sum of the root mean squares",
    "cv_rmse": "sum of the root mean squares over the means",
}
_WORDS: Final = {
    "identification": ("Identification", "the parameters were found on these days"),
    "corroboration": ("Corroboration", "held back: the fit has not seen these days"),
    "blind": ("Blind days", "every other day that the fit has not seen"),
}
_FLOW_LABELS: Final = {
    "solar": "sun absorbed",
    "convection": "convection from outdoor air",
    "longwave": "long-wave exchange with sky and surroundings",
    "boundary": "imposed boundaries (ground, measured temperatures)",
    "infiltration": "outdoor air entering",
    "ventilation": "outdoor air let in",
    "interzone": "air between zones",
    "gains": "people, light, machines",
    "heating": "heating",
    "cooling": "cooling",
}


def document(study: Study, findings: Findings) -> dict[str, Any]:
    """Everything but the curves.

    Parameters
    ----------
    study : Study
        The inputs.
    findings : Findings
        What was found.

    Returns
    -------
    dict
        Ready for JSON. In ``sensors`` the metrics at the level of a period are those of the fitted model;
        those of every model stand beside them under its name.
    """
    models = {"nominal": findings.nominal, "fitted": findings.fitted, **findings.variants}
    content = {
        **header(study, "study"),
        **comparison(models, findings.verdicts),
        **estimates(study, findings.fit),
        **profile_entries(findings.profiles),
        **foreseen(study, findings.band),
        "residuals": {
            name: {**found.to_dict(), "period": "blind"} for name, found in findings.examinations.items()
        },
        "notes": [
            *({"title": "The estimates", "text": text} for text in findings.fit.warnings),
            *({"title": "The estimates", "text": p.words} for p in findings.profiles if p.words),
            *({"title": "What is left", "text": text} for text in findings.diagnosis),
            *({"title": "Where an aim is missed", "text": text} for text in _missed(findings)),
        ],
        "aims": [{**verdict.to_dict(), "model": "fitted"} for verdict in findings.aims],
        **({} if findings.rest is None else {"shortfall": {**findings.rest.to_dict(), "period": "blind"}}),
        "phase_change": _phase_change(study, findings.fitted),
        "variant_parameters": {
            name: _parameters(study, run.fit, study.plan_of(name if name in study.file.variants else None))
            for name, run in findings.variants.items()
            if run.fit is not None
        },
    }
    if findings.sensitivity is not None:
        content |= importance(study, findings.sensitivity)
    return content


def _missed(findings: Findings) -> list[str]:
    if findings.rest is None:
        return []
    return words(findings.aims, findings.rest, "blind")


def header(study: Study, command: str) -> dict[str, Any]:
    """What every result says of its inputs.

    Parameters
    ----------
    study : Study
        The inputs.
    command : str
        What was asked for.
    """
    file = study.file
    return {
        "mascarin_version": __version__,
        "title": file.name,
        "intro": [part.strip() for part in file.about.split("\n\n") if part.strip()],
        "observed": {"label": file.observed, "note": file.observed_note},
        "seed": _seed(file),
        "timezone": study.climate.timezone,
        "command": [f"mascarin {command} {_called(study)} -o out/"],
        "inputs": _inputs(study),
        "versions": _versions(),
        "sources": [{"text": text} for text in study.building.sources()],
        "sensor_info": _sensor_info(study),
        "periods": _periods(study),
        **({} if file.reference is None else {"reference": file.reference.model_dump()}),
        "building": _building(study.building),
        "assumptions": _assumptions(study.building),
        "quality": _quality(study),
    }


def comparison(models: Mapping[str, ModelRun], verdicts: Mapping[str, list[Verdict]]) -> dict[str, Any]:
    """Models against measurements; the ledger is that of the fitted one, where there is one.

    Parameters
    ----------
    models : mapping of str to ModelRun
        ``nominal``, perhaps ``fitted`` and variants.
    verdicts : mapping of str to list of Verdict
        Criteria by model.
    """
    main = "fitted" if "fitted" in models else "nominal"
    return {
        "models": {name: {"label": run.label, "note": run.note} for name, run in models.items()},
        "sensors": _scores(models, main),
        "criteria": _criteria(verdicts),
        "start": models[main].results.provenance.start,
        "ledger": _ledger(models[main]),
    }


def estimates(study: Study, fit: Fit) -> dict[str, Any]:
    """Parameters with their uncertainty, and how they were found."""
    return {
        "parameters": _parameters(study, fit, study.sought),
        "correlation": {"paths": list(fit.problem.paths), "matrix": _plain(fit.correlation)},
        "identification": _identification(fit),
    }


def profile_entries(found: Sequence[Profile]) -> dict[str, Any]:
    """Profile likelihoods: path -> values, rise, limit, low, high; nothing where there are none."""
    entries = {
        profile.path: {
            "unit": profile.unit,
            "values": _plain(profile.values),
            "rise": _plain(profile.rise),
            "limit": profile.limit,
            "low": profile.low,
            "high": profile.high,
            "bounded": [not profile.open_low, not profile.open_high],
        }
        for profile in found
    }
    return {"profiles": entries} if entries else {}


def foreseen(study: Study, found: Band) -> dict[str, Any]:
    """The band about the fitted model, in numbers and as a table of the report."""
    return {"band": band_entry(study, found), "tables": [band_table(study, found)]}


def for_report(content: Mapping[str, Any]) -> dict[str, Any]:
    """The same with the metrics as the report takes them: sensor, period, model."""
    sensors = {
        sensor: {
            period: {model: entry[model] for model in content["models"] if entry[model]["n"]}
            for period, entry in periods.items()
        }
        for sensor, periods in content["sensors"].items()
    }
    return {**content, "sensors": sensors}


def _called(study: Study) -> str:
    """What to call the study by: its name where it comes with Mascarin, else its file."""
    shipped = (name for name, path in STUDIES.items() if path.resolve() == study.path.resolve())
    return next(shipped, study.path.name)


def _seed(file: StudyFile) -> int | None:
    """Where the random numbers start: those of the identification, else of the sensitivity."""
    return next((plan.seed for plan in (file.identification, file.sensitivity) if plan is not None), None)


def _plain(values: Any) -> Any:
    """Arrays as nested lists, numbers that are none as null."""
    if isinstance(values, np.ndarray):
        return [_plain(value) for value in values]
    number = float(values)
    return number if math.isfinite(number) else None


def _inputs(study: Study) -> list[dict[str, str]]:
    named = [
        ("study", study.path.name, study.inputs()["study"]),
        ("building", study.file.building, study.building_hash),
        ("climate", study.climate.file, study.climate.sha256),
        ("measurements", study.measurements.file, study.measurements.sha256),
    ]
    said = {"climate": study.climate.provenance, "measurements": study.measurements.provenance}
    return [
        {"name": f"{role}: {name}", "sha256": digest or "", "note": " ".join(said.get(role, ()))}
        for role, name, digest in named
    ]


def _versions() -> dict[str, str]:
    import platform
    from importlib.metadata import version

    packages = ("numpy", "scipy", "pandas", "pvlib", "pydantic")
    return {
        "mascarin": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in packages},
    }


def _sensor_info(study: Study) -> dict[str, dict[str, Any]]:
    return {
        name: {
            "label": sensor.label or name.replace("_", " "),
            "output": sensor.output,
            "unit": study.building.output(sensor.output).unit,
            "uncertainty": sensor.uncertainty,
        }
        for name, sensor in study.file.sensors.items()
    }


def _periods(study: Study) -> dict[str, dict[str, Any]]:
    return {
        name: {
            "label": _WORDS[name][0],
            "note": _WORDS[name][1],
            "spans": _spans(study.observation.times, study.during[name], study.observation.interval),
        }
        for name in PERIODS
    }


def _spans(times: pd.DatetimeIndex, use: npt.NDArray[np.bool_], interval: float) -> list[list[str]]:
    """Runs of True as pairs of local times."""
    import pandas as pd

    edges = np.flatnonzero(np.diff(np.concatenate([[False], use, [False]]).astype(np.int8)))
    local = times.tz_localize(None)
    step = pd.Timedelta(seconds=interval)
    return [
        [local[first].isoformat(), (local[last - 1] + step).isoformat()]
        for first, last in zip(edges[::2], edges[1::2], strict=True)
    ]


def _scores(models: Mapping[str, ModelRun], main: str) -> dict[str, dict[str, dict[str, Any]]]:
    return {
        sensor: {
            period: {**by_model[main].to_dict(), **{m: found.to_dict() for m, found in by_model.items()}}
            for period, by_model in periods.items()
        }
        for sensor, periods in scores_of(models).items()
    }


def _parameters(study: Study, fit: Fit, plan: IdentificationPlan) -> dict[str, dict[str, Any]]:
    known = {parameter.path for parameter in study.building.parameters()}
    given = {
        study.building.parameter(path).path if path in known else path: free
        for path, free in plan.parameters.items()
    }
    # A candidate may have parameters that the building as described has not.
    sources = {parameter.path: parameter.source for parameter in study.building.parameters()}
    entries = {}
    for parameter, entry in zip(fit.problem.parameters, fit.to_dict().values(), strict=True):
        free, path = given.get(parameter.path), parameter.path
        more: dict[str, Any] = {
            "interval": [entry["low"], entry["high"]],
            "range": [parameter.lower, parameter.upper],
        }
        if path in fit.on_bound:
            reason = free.at_bound if free is not None and free.at_bound else fit.on_bound[path]
            more |= {"at_bound": True, "reason": reason}
        if free is not None and free.reference is not None:
            more |= {"reference_nominal": free.reference[0], "reference_fitted": free.reference[1]}
        source = sources.get(path)
        entries[path] = {**entry, **more, **({"source": source} if source else {})}
    return entries


def _identification(fit: Fit) -> list[list[str]]:
    return [
        ["method", fit.method.replace("_", " ")],
        ["cost", _COSTS.get(fit.cost_name, fit.cost_name)],
        ["searches", str(len(fit.minima))],
        ["distinct minima", str(len(fit.distinct_minima()))],
        ["evaluations", str(len(fit.trace.cost))],
        ["ended", fit.reason],
        ["uncertainty", fit.uncertainty_method],
        ["effective samples", ", ".join(f"{n:.0f}" for n in fit.uncertainty.effective_samples)],
        ["seed", str(fit.seed)],
    ]


def _criteria(judged: Mapping[str, list[Verdict]]) -> list[dict[str, Any]]:
    return [
        {**verdict.to_dict(), "model": model} for model, verdicts in judged.items() for verdict in verdicts
    ]


def _phase_change(study: Study, run: ModelRun) -> list[dict[str, Any]]:
    """What each phase-change layer did over the record."""
    building = run.simulation.building.replace(run.results.provenance.changed)
    return [_melting(study, run, building, layer) for layer in melting_layers(building)]


def _melting(study: Study, run: ModelRun, building: Building, layer: MeltingLayer) -> dict[str, Any]:
    names = [output.name for output in run.results.outputs]
    fraction = run.results.records[:, names.index(layer.liquid_fraction)]
    temperature, enthalpy = path(run.results, building, layer)
    margin = 0.05 * float(np.ptp(temperature))
    ends = float(temperature.min()) - margin, float(temperature.max()) + margin
    law = law_curve(layer.of(building), *ends)
    every = max(1, round(3600.0 / run.simulation.step_seconds))
    days = _telling_days(run, study, enthalpy)
    moved = max((float(np.ptp(enthalpy[rows])) for _, _, rows in days), default=0.0)
    return {
        "label": f"{layer.surface}: {layer.layer}",
        "column": f"state/{layer.liquid_fraction}",
        "temperature": _rounded(temperature[::every]),
        "enthalpy": _rounded(enthalpy[::every]),
        "days": [
            {
                "label": f"{what}, {day}",
                "temperature": _rounded(temperature[rows]),
                "enthalpy": _rounded(enthalpy[rows]),
            }
            for what, day, rows in days
        ],
        **({} if law is None else {"law_temperature": _rounded(law[0]), "law_enthalpy": _rounded(law[1])}),
        "rows": [
            ["liquid fraction at the start", f"{fraction[0]:.3f}"],
            ["smallest liquid fraction", f"{fraction.min():.3f}"],
            ["largest liquid fraction", f"{fraction.max():.3f}"],
            ["mean liquid fraction", f"{fraction.mean():.3f}"],
            ["most heat taken up within a day", f"{moved:.0f} kJ/kg"],
        ],
    }


def _telling_days(
    run: ModelRun, study: Study, enthalpy: npt.NDArray[np.float64]
) -> list[tuple[str, str, npt.NDArray[np.intp]]]:
    """The coldest and the warmest whole day that are compared, and the one that moves most heat."""
    index = run.results.index
    day = index.tz_localize(None).normalize()
    whole = round(86400.0 / run.simulation.step_seconds)
    rows = {date: np.flatnonzero((day == date) & (index >= study.compared_from)) for date in day.unique()}
    rows = {date: at for date, at in rows.items() if at.size >= whole}
    if len(rows) < 3:
        return []
    mean = {date: float(enthalpy[at].mean()) for date, at in rows.items()}
    swing = {date: float(np.ptp(enthalpy[at])) for date, at in rows.items()}
    chosen = {
        "coldest": min(mean, key=mean.__getitem__),
        "warmest": max(mean, key=mean.__getitem__),
        "most heat moved": max(swing, key=swing.__getitem__),
    }
    return [(what, f"{date:%d %b %Y}", rows[date]) for what, date in chosen.items()]


def _rounded(values: npt.NDArray[np.float64]) -> list[float]:
    return [round(float(value), 4) for value in values]


def _ledger(run: ModelRun) -> dict[str, Any]:
    energy = run.results.energy
    terms = [
        {"label": _FLOW_LABELS[flow], "value": joule / 1e6} for flow, joule in energy.into.items() if joule
    ]
    return {
        **energy.to_dict(),
        "model": run.label,
        "terms": [*terms, {"label": "rise of the stored heat", "value": -energy.stored / 1e6}],
    }


def _quality(study: Study) -> list[dict[str, Any]]:
    masked = set(study.file.quality.mask)
    sensors = {column for sensor in study.file.sensors.values() for column in sensor.columns}
    return [
        {
            "channel": stretch.channel,
            "kind": stretch.kind,
            "start": stretch.start.tz_localize(None).isoformat(),
            "end": stretch.end.tz_localize(None).isoformat(),
            "count": stretch.count,
            "detail": stretch.detail,
            "masked": stretch.kind in masked and stretch.channel in sensors,
        }
        for stretch in study.quality
    ]


def _assumptions(building: Building) -> list[dict[str, Any]]:
    return [
        {
            "path": p.path,
            "value": p.value,
            "unit": p.unit,
            "low": p.low,
            "high": p.high,
            "source": p.source or "",
            "assumed": True,
        }
        for p in building.parameters()
        if p.assumed
    ]


# --- the building -------------------------------------------------------------------------------------------


def _building(building: Building) -> dict[str, Any]:
    site = building.site
    return {
        "name": building.name,
        "site": [
            ["latitude", f"{float(site.latitude):g} deg"],
            ["longitude", f"{float(site.longitude):g} deg"],
            ["altitude", f"{float(site.altitude):g} m"],
            ["time zone", str(site.timezone)],
        ],
        "zones": [
            {"name": name, "volume": float(zone.volume or 0.0)} for name, zone in building.zones.items()
        ],
        "constructions": [
            {"name": name, "layers": [_layer(building, layer) for layer in construction.layers]}
            for name, construction in building.constructions.items()
        ],
        "surfaces": [_surface(name, surface) for name, surface in building.surfaces.items()],
        "probes": [
            {"name": name, "surface": sensor.surface, "depth": float(sensor.depth)}
            for name, sensor in building.sensors.items()
        ],
        "choices": [["sky", site.sky.kind], ["diffuse radiation", site.diffuse]]
        + [[f"long-wave exchange in {name}", zone.longwave.kind] for name, zone in building.zones.items()],
    }


def _layer(building: Building, layer: Any) -> dict[str, Any]:
    material = building.materials[layer.material]
    entry: dict[str, Any] = {"name": layer.name, "material": layer.material, "kind": material.kind}
    if layer.thickness is not None:
        entry["thickness"] = float(layer.thickness)
    for key in (
        "conductivity",
        "density",
        "specific_heat",
        "resistance",
        "latent_heat",
        "melting_temperature",
    ):
        value = getattr(material, key, None)
        if value is not None:
            entry[key] = _one_or_two(value)
    return entry


def _one_or_two(value: Any) -> float | list[float]:
    if hasattr(value, "solid"):
        return [float(value.solid), float(value.liquid)]
    return float(value)


def _surface(name: str, surface: Any) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "name": name,
        "construction": surface.construction,
        "area": float(surface.area),
        "tilt": float(surface.tilt),
        "azimuth": float(surface.azimuth),
        "outside": _facing(surface.outside),
        "inside": _facing(surface.inside),
    }
    if surface.vertices is not None:
        entry["vertices"] = [[float(x) for x in vertex] for vertex in surface.vertices]
    for key, side in (("film_outside", surface.outside), ("film_inside", surface.inside)):
        if side.convection is not None:
            entry[key] = side.convection.kind
    return entry


def _facing(side: Any) -> str:
    if side.zone is not None:
        return str(side.zone)
    if side.measured is not None:
        return str(side.measured)
    return "ground" if side.ground is not None else str(side.faces)


# --- sensitivity --------------------------------------------------------------------------------------------


def importance(study: Study, found: Sensitivity) -> dict[str, Any]:
    """Which parameters matter: shares, and of the spectral method the spectra and shares over the day."""
    from mascarin.sensitivity.spectral import SpectralSensitivity

    rows = [
        ["method", found.method],
        ["what a share is", found.measure],
        ["parameters", str(len(found.names))],
        ["runs", str(found.runs)],
        ["seed", str(found.seed)],
    ]
    content: dict[str, Any] = {"sensitivity": found.to_dict()}
    if isinstance(found, SpectralSensitivity):
        hours = _hours(study, found.index_t.shape[1])
        rows += [
            ["replicates", str(found.design.replicates)],
            ["harmonics counted", str(found.design.order)],
        ]
        content["frequencies"] = _frequencies(found)
        content["spectra"] = {output: _spectrum(found, output) for output in found.outputs}
        content["day_shares"] = {output: _day_shares(found, output, hours) for output in found.outputs}
    return {**content, "sensitivity_design": [*rows, *(["warning", text] for text in found.warnings)]}


def _frequencies(found: SpectralSensitivity) -> dict[str, int]:
    """At which frequency each parameter swings in the first replicate, which the spectra show."""
    lines = found.design.frequencies[0][found.design.group_of]
    return {name: int(line) for name, line in zip(found.names, lines, strict=False)}


def analysed_hours(study: Study, found: Sensitivity) -> npt.NDArray[np.float64] | None:
    """Hour of the day of each analysed time, local; None for methods that keep no times. [h]"""
    times = getattr(found, "variance_t", None)
    return None if times is None or len(times) < 2 else _hours(study, len(times))


def _hours(study: Study, count: int) -> npt.NDArray[np.float64]:
    """Hour of the day of each analysed time, local."""
    import pandas as pd

    step = pd.Timedelta(
        seconds=(study.identification[1] - study.identification[0]).total_seconds() / max(count - 1, 1)
    )
    times = pd.date_range(study.identification[0], periods=count, freq=step).tz_localize(None)
    return np.asarray(times.hour + times.minute / 60.0, dtype=np.float64)


def _spectrum(found: SpectralSensitivity, output: str) -> dict[str, Any]:
    spectrum = found.spectrum(output)
    return {
        "frequencies": list(range(1, len(spectrum.power) + 1)),
        "power": [float(p) for p in spectrum.power],
        "threshold": float(spectrum.threshold),
        "peaks": [
            {"frequency": peak.line, "power": peak.power, "path": peak.label or "unnamed", "harmonic": 1}
            # The strongest first: a report that shows only some shows these.
            for peak in sorted(spectrum.peaks, key=lambda peak: -peak.power)
        ],
    }


def _day_shares(found: SpectralSensitivity, output: str, hours: npt.NDArray[np.float64]) -> dict[str, Any]:
    """Shares by hour of the day of the parameters that matter most, variances added up over the days."""
    s = found.output_index(output)
    names = found.ranking(output, _SHOWN)
    rows = [list(found.names).index(name) for name in names]
    unique = np.unique(hours)
    variance = np.nan_to_num(found.variance_t[:, s])
    power = np.nan_to_num(found.index_t[rows, :, s]) * variance
    share = [
        [float(p[hours == hour].sum() / max(variance[hours == hour].sum(), 1e-300)) for hour in unique]
        for p in power
    ]
    return {"hours": unique.tolist(), "paths": names, "share": share}
