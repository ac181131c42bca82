"""The LGI cell as a careful user would write it with numpy, scipy and pvlib, without optimization for speed.

Finite differences with nodes on the surfaces and interfaces of every layer, the apparent heat capacity of
the phase-change layer, radiosity between the surfaces of each zone, and `solve_ivp` with its stiff method
BDF. The numbers are read from the building, so that it is the same cell; the engine of Mascarin is not
used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
from pvlib import irradiance, location
from scipy.integrate import solve_ivp
from scipy.sparse import lil_matrix

from mascarin.building import Building
from mascarin.building.geometry import view_factors
from mascarin.building.parts.defaults import enclosure
from mascarin.building.parts.materials.material import PhaseChangeMaterial, Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.building.parts.site_air import density
from mascarin.physics import AIR_SPECIFIC_HEAT

Array = npt.NDArray[np.float64]
SIGMA = 5.670374419e-8
SKIN = 500.0  # heat capacity behind a bare resistance: a sheet of paper [J/(m2 K)]


@dataclass
class Face:
    """One side of a wall: its node, and what it exchanges heat with."""

    node: int
    area: float
    film: float
    emissivity: float
    zone: str | None
    sun: Array | None  # absorbed at each row of the weather [W/m2]
    sky: float  # view factor of the sky


class NaiveCell:
    """The cell as a system of ordinary differential equations.

    Parameters
    ----------
    building : Building
        Constant films and air changes, tanh law, infrared of the sky from the weather.
    weather : pandas.DataFrame
        `outdoor_air` [degC], `infrared`, `global_horizontal`, `diffuse_horizontal` [W/m2] over local times.
    cells : int
        Intervals in each layer.
    """

    def __init__(self, building: Building, weather: pd.DataFrame, cells: int = 4) -> None:
        self.building, self.weather = building, weather
        self.seconds = (weather.index - weather.index[0]).total_seconds().to_numpy()
        self.outdoor = weather["outdoor_air"].to_numpy()
        self.infrared = weather["infrared"].to_numpy()
        self.links: list[tuple[int, int, float]] = []  # node, node, conductance [W/K]
        self.capacity: list[float] = []
        self.melting: list[tuple[int, float]] = []  # node, mass [kg]
        self.held: list[tuple[int, float]] = []  # node, temperature
        self.faces: dict[tuple[str, str], Face] = {}
        for name, surface in building.surfaces.items():
            self._wall(name, surface, cells)
        self.zones = {name: len(self.capacity) + k for k, name in enumerate(building.zones)}
        air = density(building.site)
        for zone in building.zones.values():
            self.capacity.append(air * AIR_SPECIFIC_HEAT * float(zone.volume) * float(zone.capacity_factor))
        self.exchange = {name: self._radiosity(name) for name in building.zones}
        self.heat = np.array(self.capacity)
        self.i, self.j = (np.array([link[k] for link in self.links], dtype=int) for k in (0, 1))
        self.conductance = np.array([link[2] for link in self.links])

    def _node(self) -> int:
        self.capacity.append(0.0)
        return len(self.capacity) - 1

    def _wall(self, name: str, surface: Any, cells: int) -> None:
        area = float(surface.area)
        first = last = self._node()
        for layer in self.building.constructions[surface.construction].layers:
            material = self.building.materials[layer.material]
            if isinstance(material, Resistance):
                following = self._node()
                self.capacity[following] += SKIN * area  # every node of the system needs a heat capacity
                self.links.append((last, following, area / float(material.resistance)))
                last = following
                continue
            dx = float(layer.thickness) / cells
            rho, k = phase(material.density, "solid"), phase(material.conductivity, "solid")
            for _ in range(cells):
                following = self._node()
                self.links.append((last, following, k * area / dx))
                for node in (last, following):
                    if isinstance(material, PhaseChangeMaterial):
                        self.melting.append((node, 0.5 * rho * dx * area))
                    else:
                        self.capacity[node] += 0.5 * rho * dx * area * phase(material.specific_heat, "solid")
                last = following
        for side, node in (("outside", first), ("inside", last)):
            face = getattr(surface, side)
            if face.ground is not None:
                self.held.append((node, float(face.ground.mean)))
                continue
            sun = float(face.absorptance or 0.0) * self._irradiance(surface) if face.outdoors else None
            tilt = np.radians(float(surface.tilt))
            film, emissivity = float(face.convection.coefficient), float(face.emissivity)
            view = 0.5 * (1.0 + np.cos(tilt))
            self.faces[name, side] = Face(node, area, film, emissivity, face.zone, sun, view)

    def _irradiance(self, surface: Any) -> Array:
        """Irradiance of a plane by the Perez model, with the sun in the middle of each interval."""
        site, table = self.building.site, self.weather
        middle = table.index + (table.index[1] - table.index[0]) / 2
        place = location.Location(float(site.latitude), float(site.longitude), altitude=float(site.altitude))
        sun = place.get_solarposition(middle)
        sun.index = table.index
        ghi, dhi = table["global_horizontal"], table["diffuse_horizontal"]
        up = np.cos(np.radians(sun["zenith"]))
        dni = ((ghi - dhi) / up).where(up > 0.03, 0.0).clip(0.0, 1300.0)
        extra = pd.Series(irradiance.get_extra_radiation(middle.day_of_year.to_numpy()), table.index)
        total = irradiance.get_total_irradiance(
            float(surface.tilt), float(surface.azimuth), sun["zenith"], sun["azimuth"], dni, ghi, dhi,
            dni_extra=extra, albedo=float(site.ground_reflectance), model="perez",
        )  # fmt: skip
        return np.asarray(total["poa_global"].fillna(0.0), dtype=np.float64)

    def _radiosity(self, zone: str) -> tuple[list[Face], Array]:
        """Net long-wave heat of the faces of a zone is the matrix times sigma T^4 [m2]."""
        polygons = enclosure(self.building.connections.sides(zone), self.building.surfaces)
        assert polygons is not None
        faces = [self.faces[key] for key in self.building.connections.sides(zone) if key in self.faces]
        emissivity = np.array([face.emissivity for face in faces])
        reflected = np.eye(len(faces)) - (1.0 - emissivity)[:, None] * view_factors(polygons)
        leaving = np.linalg.solve(reflected, np.diag(emissivity))  # radiosity per sigma T^4
        area = np.array([face.area for face in faces])
        return faces, area[:, None] * (view_factors(polygons) @ leaving - leaving)

    def _capacities(self, y: Array) -> Array:
        """Heat capacity of each node [J/K]; the apparent one where something melts."""
        heat = self.heat.copy()
        for name in self.building.materials:
            material = self.building.materials[name]
            if not isinstance(material, PhaseChangeMaterial):
                continue
            solid, liquid = (phase(material.specific_heat, one) for one in ("solid", "liquid"))
            above = y - float(material.melting_temperature or 0.0)
            width = material.law.half_width  # type: ignore[union-attr]
            f = 0.5 + 0.5 * np.tanh(above / width)
            slope = 2.0 * f * (1.0 - f) / width
            apparent = (
                solid
                + (liquid - solid) * f
                + slope * (float(material.latent_heat or 0.0) + (liquid - solid) * above)
            )
            for node, mass in self.melting:
                heat[node] += mass * apparent[node]
        return heat

    def slope(self, t: float, y: Array) -> Array:
        """dT/dt of every node."""
        q = np.zeros_like(y)
        flow = self.conductance * (y[self.j] - y[self.i])
        np.add.at(q, self.i, flow)
        np.add.at(q, self.j, -flow)
        air = np.interp(t, self.seconds, self.outdoor)
        sky = np.interp(t, self.seconds, self.infrared)
        around = SIGMA * (air + 273.15) ** 4
        step = self.seconds[1] - self.seconds[0]
        for face in self.faces.values():
            if face.zone is not None:
                heat = face.film * face.area * (y[self.zones[face.zone]] - y[face.node])
                q[self.zones[face.zone]] -= heat
                q[face.node] += heat
                continue
            own = SIGMA * (y[face.node] + 273.15) ** 4
            seen = face.sky**1.5 * sky + (1.0 - face.sky**1.5) * around
            absorbed = np.interp(t, self.seconds + 0.5 * step, face.sun)  # type: ignore[arg-type]
            q[face.node] += face.area * (
                face.film * (air - y[face.node]) + face.emissivity * (seen - own) + absorbed
            )
        for name, (faces, matrix) in self.exchange.items():
            nodes = np.array([face.node for face in faces])
            q[nodes] += matrix @ (SIGMA * (y[nodes] + 273.15) ** 4)
            zone, at = self.building.zones[name], self.zones[name]
            changes = float(zone.infiltration.constant) / 3600.0
            q[at] += changes * self.heat[at] / float(zone.capacity_factor) * (air - y[at])
        rate = q / self._capacities(y)
        for node, _ in self.held:
            rate[node] = 0.0
        return rate

    def _pattern(self) -> Any:
        """Which node depends on which, for the solver's sparse Jacobian."""
        n = len(self.capacity)
        pattern = lil_matrix((n, n))
        pattern.setdiag(1.0)
        for i, j in zip(self.i, self.j, strict=True):
            pattern[i, j] = pattern[j, i] = 1.0
        for name, (faces, _) in self.exchange.items():
            together = [face.node for face in faces] + [self.zones[name]]
            pattern[np.ix_(together, together)] = 1.0
        return pattern

    def run(self, start: float, times: Array, tolerance: float = 1e-4) -> Array:
        """Integrate from one temperature; those of all nodes at the times, shape (times, nodes). [degC]"""
        y = np.full(len(self.capacity), start)
        for node, temperature in self.held:
            y[node] = temperature
        done = solve_ivp(
            self.slope, (times[0], times[-1]), y, "BDF", times, rtol=tolerance, atol=tolerance,
            max_step=900.0, jac_sparsity=self._pattern(),
        )  # fmt: skip
        if not done.success:
            raise RuntimeError(done.message)
        return np.asarray(done.y.T, dtype=np.float64)

    def read(self, states: Array, output: str) -> Array:
        """One output by its name in Mascarin, from the states."""
        key, quantity = output.split(".")
        if quantity == "air_temperature":
            return np.asarray(states[:, self.zones[key]])
        return np.asarray(states[:, self.faces[key, quantity.removesuffix("_temperature")].node])
