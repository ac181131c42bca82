"""Runs of single designs with their series, for the report: why a design works."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.building.parts import site_air
from mascarin.simulation import Simulation

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.building import Building
    from mascarin.design.variants.inputs import DesignInputs, DesignSite
    from mascarin.design.variants.variables import Design

    Array = npt.NDArray[np.float64]

#: Name of the design that all are compared with.
REFERENCE: Final = "reference"


@dataclass(frozen=True)
class Detail:
    """A design in a climate, as described (free-floating unless the building is cooled).

    Attributes
    ----------
    climate, label : str
        Where, and which design.
    hours : ndarray, shape (24,)
        Hours of the day. [h]
    temperature : mapping of str to ndarray, each of shape (24,)
        Mean operative temperature of each zone at each hour. [degC]
    outdoors : ndarray, shape (24,)
        Mean outdoor temperature. [degC]
    gains : mapping of str to ndarray, each of shape (24,)
        Mean heat that the zone of interest gains at each hour: by the air that is exchanged with outdoors,
        and through
        each surface. [W]
    fractions : mapping of str to ndarray, each of shape (2, days)
        Smallest and largest liquid fraction of each layer on each day. [-]
    days : ndarray of datetime64, shape (days,)
        The days.
    flows : mapping of str to float
        Heat into the building over the period, by flow. [J]
    closure : float
        Relative energy-balance residual. [-]
    """

    climate: str
    label: str
    hours: Array
    temperature: Mapping[str, Array]
    outdoors: Array
    gains: Mapping[str, Array]
    fractions: Mapping[str, Array]
    days: npt.NDArray[np.datetime64]
    flows: Mapping[str, float]
    closure: float


def detail(inputs: DesignInputs, site: DesignSite, design: Design | None, label: str) -> Detail:
    """Run one design, or the reference, in one climate.

    Parameters
    ----------
    inputs : DesignInputs
        The study.
    site : DesignSite
        The climate.
    design : Design or None
        The design; None is the reference.
    label : str
        Its name.
    """
    building, numbers = _building(inputs, site, design)
    zones, layers = zones_of(inputs), layers_of(building)
    names = [f"{zone}.operative_temperature" for zone in zones]
    names += [f"{layer}_liquid_fraction" for layer in layers]
    faces = _faces(building, zones[0])
    names += [f"{surface}.{side}_flux" for surface, side, _ in faces]
    names += [f"{zones[0]}.air_temperature", f"{zones[0]}.air_changes"]
    simulation = Simulation(
        building,
        site.climate,
        outputs=list(dict.fromkeys(names)),
        start=site.start,
        end=site.end,
        step=inputs.file.step,
        scheme=inputs.file.scheme,
        ranges={path: span for path, span in inputs.choices.ranges().items() if _varies(building, path)},
    )
    run = simulation.run(numbers)
    series = {name: np.asarray(run[name], dtype=np.float64) for name in dict.fromkeys(names)}
    outdoors = simulation.weather("air_temperature")
    seconds = simulation.step_seconds
    middles = simulation.index[1:].tz_localize(None).to_numpy() - np.timedelta64(int(seconds * 500), "ms")
    hour = ((middles - middles.astype("datetime64[D]")) / np.timedelta64(1, "h")).astype(np.int64)
    gains = {
        "air from outdoors": _volume(building, zones[0])
        / 3600.0
        * site_air.heat_capacity(building.site)
        * series[f"{zones[0]}.air_changes"]
        * (outdoors - series[f"{zones[0]}.air_temperature"])
    }
    for surface, side, sign in faces:
        area = float(building.surfaces[surface].area or 0.0)
        gains[surface] = sign * area * series[f"{surface}.{side}_flux"]
    dates = middles.astype("datetime64[D]")
    return Detail(
        climate=site.name,
        label=label,
        hours=np.arange(24, dtype=np.float64) + 0.5,
        temperature={zone: _by_hour(series[f"{zone}.operative_temperature"], hour) for zone in zones},
        outdoors=_by_hour(outdoors, hour),
        gains={name: _by_hour(values, hour) for name, values in gains.items()},
        fractions={layer: _by_day(series[f"{layer}_liquid_fraction"], dates) for layer in layers},
        days=np.unique(dates),
        flows=dict(run.energy.into),
        closure=run.energy.closure,
    )


def zones_of(inputs: DesignInputs) -> list[str]:
    """Zones of the objectives, that of the ranking first; else the first of the building."""
    names = [inputs.file.ranked_by, *inputs.file.objectives]
    zones = [zone for name in names for zone in getattr(inputs.objective(name), "zones", ())]
    return list(dict.fromkeys(zones)) or [next(iter(inputs.building.zones))]


def layers_of(building: Building) -> list[str]:
    """Phase-change layers, as SURFACE.LAYER."""
    return [
        f"{name}.{layer.name}"
        for name, surface in building.surfaces.items()
        for layer in building.constructions[surface.construction].layers
        if building.materials[layer.material].kind == "pcm"
    ]


def _building(
    inputs: DesignInputs, site: DesignSite, design: Design | None
) -> tuple[Building, dict[str, float]]:
    """Building and parameters of a design."""
    if design is None:
        return (site.building.replace(inputs.file.reference) if inputs.file.reference else site.building), {}
    options = inputs.choices.options(design)
    parts = {path: part for option in options for path, part in option.parts.items()}
    numbers = {path: value for option in options for path, value in option.numbers.items()}
    return (site.building.replace(parts) if parts else site.building), numbers


def _volume(building: Building, zone: str) -> float:
    """Volume of a zone, which every building has when it is checked. [m3]"""
    return float(building.zones[zone].volume or 0.0)


def _varies(building: Building, path: str) -> bool:
    """Whether a building has a parameter; the reference may be without a layer."""
    return any(parameter.path == path for parameter in building.parameters())


def _faces(building: Building, zone: str) -> list[tuple[str, str, float]]:
    """Surfaces that bound a zone, with the side that faces it, and the sign of its flux into the zone."""
    faces = []
    for name, surface in building.surfaces.items():
        if surface.internal_mass:
            continue
        if surface.inside.zone == zone:
            faces.append((name, "inside", 1.0))
        elif surface.outside.zone == zone:
            faces.append((name, "outside", -1.0))
    return faces


def _by_hour(values: Array, hour: npt.NDArray[np.int64]) -> Array:
    """Mean at each hour of the day, shape (24,), of records at the end of steps."""
    sums = np.bincount(hour, weights=values[1:], minlength=24)
    return np.asarray(sums / np.maximum(np.bincount(hour, minlength=24), 1), dtype=np.float64)


def _by_day(values: Array, dates: Any) -> Array:
    """Smallest and largest value of each day, shape (2, days)."""
    starts = np.flatnonzero(np.concatenate([[True], dates[1:] != dates[:-1]]))
    return np.stack([np.minimum.reduceat(values[1:], starts), np.maximum.reduceat(values[1:], starts)])


def grouped_gains(detail: Detail, layers: Sequence[str]) -> dict[str, Array]:
    """Heat gains of the zone: through surfaces with a phase-change layer, others, and by air. [W]"""
    with_pcm = {layer.partition(".")[0] for layer in layers}
    other_gains = [
        values
        for name, values in detail.gains.items()
        if name not in with_pcm and name != "air from outdoors"
    ]
    pcm_gains = [values for name, values in detail.gains.items() if name in with_pcm]
    none = np.zeros(24)
    return {
        "surfaces with phase change": np.sum(pcm_gains, axis=0) if pcm_gains else none,
        "other surfaces": np.sum(other_gains, axis=0) if other_gains else none,
        "air from outdoors": detail.gains["air from outdoors"],
    }
