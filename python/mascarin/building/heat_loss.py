"""Heat loss coefficient of a described building by destination, effective heat capacity, time constant.

The zones have one temperature and all else that they lose heat to another. Surface resistances are those that
are described (see `mascarin.building.checks.u_values`): laws by wind at 4 m/s, correlations as in ISO 6946.
Infiltration, with that of pressure tests, is taken at the same wind and a temperature difference of 10 K.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from mascarin.building.checks.conductances import infiltration_rate, opaque_area, window_conductance
from mascarin.building.checks.u_values import described_films, described_u_value, layer_resistance
from mascarin.building.engine_input.ratings import window_ratings
from mascarin.building.parts.materials.material import Resistance
from mascarin.building.parts.materials.phases import phase
from mascarin.building.parts.site_air import heat_capacity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mascarin.building.engine_input.ratings import WindowRating
    from mascarin.building.parts.description import Description
    from mascarin.building.parts.envelope.surface import Surface


@dataclass(frozen=True, slots=True)
class HeatLoss:
    """Steady heat loss and storage of all zones together.

    Attributes
    ----------
    destinations : dict of str to float
        Heat per degree to ``outdoors`` (through surfaces), ``ground``, ``measured`` temperatures, by
        ``infiltration`` and through ``thermal bridges``. [W/K]
    u_values : dict of str to float
        Of each surface that loses heat. [W/(m2 K)]
    capacity : float
        Heat that is stored for a degree of the zones, in the steady state. Latent heat is left out. [Wh/K]
    apertures : dict of str to float
        Solar heat of the zones for an irradiance of 1 W/m2 on all outer surfaces: through ``windows`` at
        normal incidence, and of ``opaque`` surfaces, which absorb it outside. Shading is left out. [m2]

    Examples
    --------
    >>> HeatLoss({"outdoors": 80.0, "infiltration": 20.0}, {}, 5000.0).time_constant
    50.0
    """

    destinations: dict[str, float]
    u_values: dict[str, float]
    capacity: float
    apertures: dict[str, float] = field(default_factory=dict)

    @property
    def total(self) -> float:
        """Heat loss coefficient. [W/K]"""
        return sum(self.destinations.values())

    @property
    def time_constant(self) -> float:
        """Capacity over the heat loss coefficient; infinite without any loss. [h]"""
        return self.capacity / self.total if self.total > 0.0 else float("inf")


def heat_loss(building: Description, ratings: Mapping[str, WindowRating] | None = None) -> HeatLoss:
    """Compute heat loss coefficient, solar apertures and effective heat capacity from a description.

    Parameters
    ----------
    building : Building
        The building. Ventilation and openings are left out.
    ratings : mapping of str to WindowRating, optional
        Rated values of the glass of its windows, where they are known already.

    Returns
    -------
    HeatLoss

    References
    ----------
    ISO 13789:2017 (heat transfer coefficients of transmission and ventilation).
    ISO 52016-1:2017 (solar heat of windows and opaque surfaces).

    Examples
    --------
    >>> from mascarin.examples import box
    >>> loss = heat_loss(box())
    >>> sorted(loss.destinations), round(loss.u_values["facade"], 2)
    (['infiltration', 'outdoors'], 3.6)
    """
    destinations: dict[str, float] = defaultdict(float)
    u_values: dict[str, float] = {}
    capacity = 0.0
    for name, surface in building.surfaces.items():
        opaque = opaque_area(building, name)
        capacity += opaque * _areal_capacity(building, surface) / 3600.0
        destination = _destination(surface)
        if destination is None:
            continue
        u_values[name] = described_u_value(building, surface)
        destinations[destination] += u_values[name] * opaque
        for window in building.connections.windows_in(name).values():
            destinations[destination] += window_conductance(building, window)
    air = heat_capacity(building.site)
    for zone in building.zones.values():
        volume = float(zone.volume or 0.0)
        destinations["infiltration"] += air * volume * infiltration_rate(zone) / 3600.0
        capacity += air * volume * float(zone.capacity_factor) / 3600.0
        for bridge in zone.thermal_bridges.values():
            if bridge.zone is None:
                destinations["thermal bridges"] += bridge.conductance
    lost = {destination: value for destination, value in destinations.items() if value > 0.0}
    return HeatLoss(lost, u_values, capacity, _apertures(building, u_values, ratings))


def _apertures(
    building: Description, u_values: Mapping[str, float], ratings: Mapping[str, WindowRating] | None
) -> dict[str, float]:
    """Solar apertures of windows and opaque surfaces (as in ISO 52016-1:2017). [m2]"""
    apertures: dict[str, float] = defaultdict(float)
    for name, rating in (window_ratings(building) if ratings is None else ratings).items():
        window = building.windows[name]
        if building.surfaces[window.surface].outside.outdoors:
            glass = 1.0 - (float(window.frame.fraction) if window.frame is not None else 0.0)
            apertures["windows"] += rating.solar_heat_gain * glass * float(window.area or 0.0)
    for name, u_value in u_values.items():
        surface = building.surfaces[name]
        side = surface.outside
        if not (side.outdoors and side.sunlit) or side.absorptance is None:
            continue
        film, _ = described_films(building, surface)
        apertures["opaque"] += float(side.absorptance) * u_value * film * opaque_area(building, name)
    return {part: value for part, value in apertures.items() if value > 0.0}


def _destination(surface: Surface) -> str | None:
    """What a surface loses heat to; None within the zones and where a side is adiabatic."""
    if surface.outside.zone is not None or surface.outside.closed or surface.inside.closed:
        return None
    faces = surface.outside.faces
    if surface.outside.imposed is not None:
        row = surface.outside.imposed.row
        # A heated side loses no heat to what heats it.
        return None if row.gives_heat or row.gives_coefficient else "ground"
    return faces if faces in ("outdoors", "ground") else "measured"


def _areal_capacity(building: Description, surface: Surface) -> float:
    """Heat that a surface stores for a degree of the zones. [J/(m2 K)]

    In the steady state the temperature rises from outdoors to the zone in proportion to the resistance that
    is passed; a surface that loses no heat has that of the zone.
    """
    layers = building.constructions[surface.construction].layers
    inner = [layer_resistance(building.materials[layer.material], layer.thickness) for layer in layers]
    lost = _destination(surface) is not None
    passed, film = described_films(building, surface) if lost else (0.0, 0.0)
    total = passed + sum(inner) + film if lost else 0.0
    stored = 0.0
    for layer, resistance in zip(layers, inner, strict=True):
        material = building.materials[layer.material]
        share = (passed + 0.5 * resistance) / total if total > 0.0 else 1.0
        passed += resistance
        if not isinstance(material, Resistance):
            heat = phase(material.density, "solid") * phase(material.specific_heat, "solid")
            stored += share * heat * float(layer.thickness or 0.0)
    return stored
