"""Flows of outdoor air into a zone: what drives them, their schedules and conditions."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Final

from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year
from mascarin.energyplus.model.year import Year, combined, constant
from mascarin.energyplus.zones.zones import Zone
from mascarin.physics import standard_density

#: Temperature of standard air in EnergyPlus (20 degC) and in the engine (15 degC, ISO 2533). [K]
_STANDARD_TEMPERATURE, _STANDARD_AIR = 293.15, 288.15
#: Temperature difference [K] and wind at the mast [m/s] at which a flow that cannot be a law is taken.
_USUAL_DIFFERENCE, _USUAL_WIND = 10.0, 4.0
#: Conditions of ventilation: key of the control, field of EnergyPlus, limit beyond which it never acts.
_CONDITIONS: Final = (
    ("indoor", "minimum_indoor_temperature", -60.0),
    ("indoor_below", "maximum_indoor_temperature", 90.0),
    ("difference", "delta_temperature", -60.0),
    ("outdoor", "minimum_outdoor_temperature", -60.0),
    ("outdoor_below", "maximum_outdoor_temperature", 60.0),
    ("wind", "maximum_wind_speed", 40.0),
)
#: Sets of scheduled limits that are carried over; of more, each would hold for a few hours alone.
_MOST_SETS: Final = 12


@dataclass(frozen=True)
class Draught:
    """A flow of outdoor air ``flow schedule (a + b |dT| + c V + d V^2)``, or by a law.

    Attributes
    ----------
    item : IdfObject
        The object.
    flow : float
        At a factor of 1. [m3/s]
    terms : tuple of float
        a [-], b [1/K], c [s/m], d [s2/m2], by the wind at the mast.
    values : Year
        Its schedule.
    control : str or None
        Control that lets it flow.
    density : str or float
        Air that it is a volume of, as in the description.
    law : str
        A formula in place of the terms [-]; empty without.
    opening : dict
        An opening that has about the same flow, for a second law of a zone.
    """

    item: IdfObject
    flow: float
    terms: tuple[float, float, float, float]
    values: Year
    control: str | None = None
    density: str | float = "outdoors"
    law: str = ""
    opening: Section = field(default_factory=dict)

    @property
    def driven(self) -> bool:
        """Whether temperature or wind drive it."""
        return bool(self.law) or any(self.terms[1:])

    @property
    def factor(self) -> str:
        """What its flow is multiplied by, as a formula."""
        if self.law:
            return self.law
        names = ("", "*abs(dT)", "*V", "*V^2")
        text = " + ".join(f"{term:.9g}{name}" for term, name in zip(self.terms, names, strict=True) if term)
        return f"max({text}, 0)" if min(self.terms) < 0.0 else text


def density_of(context: Context, item: IdfObject, *, usual: str = "outdoors") -> str | float:
    """Air that EnergyPlus takes a flow as a volume of: outdoor air, that of the zone, or standard air."""
    word = item.word("density_basis") or usual
    if word == "indoor":
        return "zone"
    if word != "standard":
        return "outdoors"
    altitude = float(context.section("site").get("altitude", 0.0))
    # Standard air of EnergyPlus has 20 degC; that of the engine 15 degC at the same pressure.
    return round(standard_density(altitude) * _STANDARD_AIR / _STANDARD_TEMPERATURE, 5)


def conditioned(context: Context, zone: Zone, draught: Draught) -> Iterator[Draught]:
    """A flow with the conditions on which EnergyPlus lets it in: one for each set of its limits.

    EnergyPlus compares the air of the zone at the beginning of a step, as a control does.
    """
    item = draught.item
    limits: list[tuple[str, Year]] = []
    for key, name, idle in _CONDITIONS:
        scheduled = item.text(f"{name}_schedule_name")
        value = item.number(name)
        if not scheduled and value is None:
            continue
        values = year(context, item, f"{name}_schedule_name") if scheduled else constant(float(value or 0.0))
        if all(limit <= idle if idle < 0.0 else limit >= idle for limit in values.values):
            continue
        limits.append((key, values))
    yield from limited(context, zone, draught, limits)


def limited(
    context: Context, zone: Zone, draught: Draught, limits: list[tuple[str, Year]]
) -> Iterator[Draught]:
    """A flow that limits let in: one for each set of their values, with a control.

    Parameters
    ----------
    context : Context
        The conversion.
    zone : Zone
        The zone.
    draught : Draught
        The flow without limits.
    limits : list of (str, Year)
        Keys of a control, such as ``indoor``, with the value at which it opens and closes.
    """
    item = draught.item
    sets = list(itertools.product(*(sorted(values.values) for _, values in limits)))
    if not limits or (draught.values.constant == 0.0):
        yield draught
        return
    if len(sets) > _MOST_SETS:
        context.findings.approximated(item, "limits that change in many steps", "their means are used")
        limits = [(key, constant(values.mean())) for key, values in limits]
        sets = [tuple(values.mean() for _, values in limits)]
    for limit_set in sets:
        active = combined(
            lambda share, *now, limit_set=limit_set: share if tuple(now) == limit_set else 0.0,
            draught.values,
            *(values for _, values in limits),
        )
        if active.constant == 0.0:
            continue
        bands = {key: limit for (key, _), limit in zip(limits, limit_set, strict=True)}
        yield replace(draught, values=active, control=_control(context, zone, item, bands))


def _control(context: Context, zone: Zone, item: IdfObject, limits: dict[str, float]) -> str:
    """Name of the control with these limits; one that is there already, if it is equal."""
    limits = {key: max(min(limit, 90.0), -60.0) for key, limit in limits.items()}
    if "wind" in limits:
        limits["wind"] = min(limits["wind"] / zone.wind, 100.0)
    bands = {key: {"open": round(limit, 6), "close": round(limit, 6)} for key, limit in limits.items()}
    control: Section = {"zone": zone.name} | bands
    held = context.section("controls")
    for name, other in held.items():
        if other == control:
            return str(name)
    name = context.names.new("controls", f"{item.name} of {zone.name}")
    held[name] = control
    return name


def enter_draughts(context: Context, zone: Zone, draughts: list[Draught]) -> None:
    """Enter all flows of a zone.

    A zone has one infiltration, with a law, a schedule, a control and a density: the largest of what is
    driven by temperature or wind and has the same of them is entered there. Constant flows are ventilation.
    """
    driven: dict[tuple[Any, ...], list[Draught]] = {}
    for draught in draughts:
        if draught.flow <= 0.0 or draught.values.constant == 0.0:
            continue
        if draught.driven:
            key = (draught.values, draught.control, draught.density)
            driven.setdefault(key, []).append(draught)
    groups = sorted(driven.values(), key=lambda group: sum(map(_usual, group)), reverse=True)
    law = groups[0] if groups else []
    for draught in draughts:
        if draught.driven or draught.flow * draught.terms[0] <= 0.0 or draught.values.constant == 0.0:
            continue
        if not _as_leak(context, zone, draught, law):
            ventilate(context, zone, draught, draught.flow * draught.terms[0])
    if law:
        _enter_law(context, zone, law)
    for group in groups[1:]:
        for draught in group:
            _enter_other(context, zone, draught)


def _usual(draught: Draught) -> float:
    """A usual flow. [m3/s]"""
    share = draught.values.mean()
    if draught.law:
        # A law is the only form of such a flow, but for openings.
        return draught.flow * share * (1.0 if draught.opening else 1e3)
    constant_part, stack, wind, squared = draught.terms
    return draught.flow * share * (
        constant_part + stack * _USUAL_DIFFERENCE + wind * _USUAL_WIND + squared * _USUAL_WIND**2
    )  # fmt: skip


def _as_leak(context: Context, zone: Zone, draught: Draught, law: list[Draught]) -> bool:
    """Enter a constant flow as infiltration where the file says so and nothing else needs the section."""
    if law or draught.control or draught.values.constant is None or "Infiltration" not in draught.item.kind:
        return False
    held = context.section("zones")[zone.name].setdefault("infiltration", {"density": draught.density})
    if held["density"] != draught.density:
        return False
    changes = draught.flow * draught.terms[0] * draught.values.constant * 3600.0 / zone.volume
    held["constant"] = round(held.get("constant", 0.0) + changes, 8)
    return True


def _enter_law(context: Context, zone: Zone, group: list[Draught]) -> None:
    first = group[0]
    schedule, most = fraction(context, f"{first.item.name} flow", first.values)
    hourly = [draught.flow * most * 3600.0 / zone.volume for draught in group]
    if any(draught.law or draught.terms[3] or min(draught.terms) < 0.0 for draught in group):
        text = " + ".join(
            f"{share:.9g}*({draught.factor})" for share, draught in zip(hourly, group, strict=True)
        )
        held: Section = {
            "formula": text,
            "source": ", ".join(dict.fromkeys(f"EnergyPlus {draught.item.label}" for draught in group)),
        }
    else:
        keys = ("constant", "temperature", "wind")
        sums = [
            sum(share * draught.terms[k] for share, draught in zip(hourly, group, strict=True))
            for k in range(3)
        ]
        held = {key: round(value, 9) for key, value in zip(keys, sums, strict=True) if value}
    held["density"] = first.density
    held |= {} if schedule is None else {"schedule": schedule}
    held |= {} if first.control is None else {"control": first.control}
    context.section("zones")[zone.name]["infiltration"] = held


def enter_beside(context: Context, zone: Zone, draught: Draught) -> bool:
    """Enter a flow with a law in a zone that has its other flows already.

    Parameters
    ----------
    context : Context
        The conversion.
    zone : Zone
        The zone.
    draught : Draught
        The flow.

    Returns
    -------
    bool
        False where the infiltration of the zone has terms by temperature or wind, a schedule or a control, so
        that one law cannot have both; nothing is entered then.
    """
    description = context.section("zones")[zone.name]
    leaks = description.get("infiltration", {})
    if leaks.keys() - {"constant", "density"}:
        return False
    if leaks.get("constant"):
        # A constant flow is the same as ventilation: the law and its schedule have the section alone.
        held = description.setdefault("ventilation", {})
        held[context.names.new(f"ventilation of {zone.name}", "infiltration")] = {
            "air_changes": leaks["constant"],
            "density": leaks["density"],
        }
    _enter_law(context, zone, [draught])
    return True


def _enter_other(context: Context, zone: Zone, draught: Draught) -> None:
    """Enter a second flow that is driven: as an opening, or with its flow at a usual difference and wind."""
    schedule, most = fraction(context, f"{draught.item.name} flow", draught.values)
    opening = dict(draught.opening)
    if not draught.law and not any(draught.terms[k] for k in (0, 1, 3)):
        opening = {"area": draught.flow * draught.terms[2], "height": 0.0, "wind_coefficient": 1.0}
    if opening:
        context.findings.approximated(
            draught.item, "a second flow by wind or buoyancy in its zone", "at the density of the site: 5 %"
        )
        name = context.names.of("openings", f"{draught.item.name} {zone.name}")
        opening["area"] = round(opening["area"] * most, 8)
        opening |= {} if schedule is None else {"schedule": schedule}
        opening |= {} if draught.control is None else {"control": draught.control}
        context.section("openings")[name] = {"zone": zone.name} | opening
        return
    context.findings.approximated(
        draught.item,
        "a second flow by wind or buoyancy in its zone",
        f"a flow as at {_USUAL_DIFFERENCE:g} K and {_USUAL_WIND:g} m/s at all times",
    )
    ventilate(context, zone, draught, _usual(replace(draught, values=constant(1.0))))


def ventilate(context: Context, zone: Zone, draught: Draught, flow: float) -> None:
    """Enter a flow as ventilation with outdoor air.

    Parameters
    ----------
    context : Context
        The conversion.
    zone : Zone
        The zone.
    draught : Draught
        Its schedule, control and density.
    flow : float
        Flow at a schedule of 1. [m3/s]
    """
    schedule, most = fraction(context, f"{draught.item.name} flow", draught.values)
    if flow * most <= 0.0:
        return
    held = context.section("zones")[zone.name].setdefault("ventilation", {})
    key = context.names.new(f"ventilation of {zone.name}", draught.item.name or zone.item.name)
    held[key] = {"flow": round(flow * most, 9), "density": draught.density}
    held[key] |= {} if schedule is None else {"schedule": schedule}
    held[key] |= {} if draught.control is None else {"control": draught.control}
