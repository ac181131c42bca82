"""Objects that no part of the conversion reads, with what their absence does to the results."""

from __future__ import annotations

from typing import Final

from mascarin.energyplus.model.context import Context
from mascarin.energyplus.model.handlers import reads

#: Beginnings of classes without effect on heat, with the reason.
_IDLE: Final = {
    "output": "a report",
    "meter": "a report",
    "timestep": "the step of a run is an option here",
    "simulationcontrol": "what is simulated is an option here",
    "runperiod": "the period is an option of a run here",
    "scheduletype": "a check of schedules",
    "sizing": "nothing is sized here",
    "sizingperiod": "nothing is sized here",
    "scheduletypelimits": "a check of schedules",
    "shadowcalculation": "shadows are calculated at every step here",
    "convergencelimits": "a control of the solver",
    "heatbalancesettings": "a control of the solver",
    "zoneairheatbalancealgorithm": "a control of the solver",
    "performanceprecisiontradeoffs": "a control of the solver",
    "programcontrol": "a control of the program",
    "lifecyclecost": "costs",
    "utilitycost": "costs",
    "componentcost": "costs",
    "compliance": "a report",
    "currencytype": "costs",
    "environmentalimpactfactors": "a report",
    "fuelfactors": "a report",
    "exterior:": "energy outside of the zones",
    "nodelist": "connections of systems",
    "outdoorair:node": "connections of systems",
    "branch": "connections of systems",
    "connector": "connections of systems",
    "surfaceconvectionalgorithm": "settings of an algorithm that is not carried over",
    "site:groundtemperature": "ground that no surface of the file touches",
    "site:watermainstemperature": "water",
    "wateruse:": "connections of systems",
    "fluidproperties": "properties of fluids in systems",
    "demandmanager": "a control of systems",
    "faultmodel": "faults of systems",
    "hvacsystemroot": "a control of the solver",
    "electricloadcenter": "generation of electricity",
    "generator": "generation of electricity",
    "photovoltaic": "generation of electricity",
    "zonehvac:equipment": "connections of systems",
    "zonegroup": "a report",
    "designspecification:zonehvac": "nothing is sized here",
}
#: Beginnings of classes that change the results, with the effect.
_MISSING: Final = {
    "daylighting": "lights are not dimmed by daylight: more heat from lights",
    "airflownetwork": "part of the air flow network, which is left out",
    "zoneairbalance": "infiltration and ventilation are added, not combined: more outdoor air",
    "zoneairmassflowconservation": "no outdoor air makes up what zones give to others: in an example file "
    "0.9 K and half of the heating",
    "zonecontaminant": "no contaminants are simulated",
    "roomair": "the air of a zone is well mixed: no stratification",
    "runperiodcontrol:daylightsavingtime": "schedules do not move in summer: an hour later than there",
    "site:groundreflectance:snowmodifier": "the ground reflects the same with snow: less sun in winter",
    "site:precipitation": "rain has no effect: surfaces stay dry",
    "roofirrigation": "no water on roofs",
    "zonethermalchimney": "no flow through chimneys",
    "zonecooltower": "no cooling by towers",
    "zoneearthtube": "no air through earth tubes",
    "zonebaseboard": "no heat from baseboards",
    "indoorlivingwall": "no plants indoors",
    "materialproperty:heatandmoisturetransfer": "moisture is left out: heat alone is conducted",
    "materialproperty:moisturepenetrationdepth": "moisture is left out: heat alone is conducted",
    "materialproperty:": "this property of the material is left out",
    "surfacecontamination": "no contaminants are simulated",
    "surfaceproperty:localenvironment": "the surroundings of a surface are those of the site",
    "surfaceproperty:exteriornaturalventedcavity": "no vented cavity in front of a surface",
    "surfaceproperty:": "this property of surfaces is left out",
    "windowproperty:airflowcontrol": "no air flow between panes",
    "windowproperty:stormwindow": "no storm windows in winter",
    "zonecontrol:humidistat": "no moisture is simulated: no latent loads",
    "zonecontrol:": "this control of a zone is left out",
    "airloophvac:returnplenum": "return air does not flow through the plenum: other temperatures there",
    "airloophvac:supplyplenum": "supply air does not flow through the plenum: other temperatures there",
    "energymanagementsystem": "what this program changes during a run stays as described",
    "pythonplugin": "what this program changes during a run stays as described",
    "externalinterface": "what this program changes during a run stays as described",
    "parametric": "the values of its first run are used: the other runs are other buildings",
    "complexfenestration": "see the windows that use it",
    "swimmingpool": "no pool",
    "surfaceproperty:solarincidentinside": "the sun that enters falls where it would, not by this schedule",
    "complexfenestrationproperty:solarabsorbed": "panes absorb what falls on them, not by this schedule",
    "electricequipment:ite": "no heat of these computers",
    "geometrytransform": "the building has the shape of the file, not the new aspect ratio",
    "surfacecontrol:movableinsulation": "no movable insulation: more sun is absorbed, more heat is lost",
    "site:spectrumdata": "the spectrum of the sun is the usual one: some per cent of the sun through glass",
    "site:solarandvisiblespectrum": "the spectrum of the sun is the usual one",
    "site:grounddomain": "see the surfaces that use it",
    "windowthermalmodel": "see the windows that use it",
    "zoneproperty:userviewfactors": "view factors are those of the corners: some tenths of a kelvin",
    "surfaceproperty:surroundingsurfaces": "surroundings have the temperature of the air and the sky",
    "surfaceproperty:groundsurfaces": "the ground has the temperature of the air",
    "surfaceproperty:incidentsolarmultiplier": "all of the sun falls on the surface",
    "foundation": "see the surfaces that use it",
    "site:groundtemperature:undisturbed": "see the surfaces that use it",
}
#: Objects that others name: without effect where nothing that is carried over does.
_NAMED: Final = (
    "material", "construction", "windowmaterial", "schedule", "thermostat", "designspecification",
    "spacelist", "space", "zonelist", "matrix", "table", "curve", "windowproperty:frameanddivider", "ground",
)  # fmt: skip
_SYSTEM_GROUPS: Final = (
    "hvac", "air", "plant", "coil", "fan", "heat", "pump", "boiler", "chiller", "refrigeration", "zonehvac",
    "water heater", "node", "controller", "setpoint", "availability", "evaporative", "humidif", "unitary",
    "condenser", "solar collector", "variable refrigerant", "non-zone", "system",
)  # fmt: skip


def note_unsupported(context: Context) -> None:
    """Note every object that no handler has read, and that nothing else says something about.

    Parameters
    ----------
    context : Context
        The conversion.
    """
    _beside(context)
    for kind, all_items in context.model.unread():
        items = [item for item in all_items if not context.findings.about(item)]
        low = kind.casefold()
        missing = _longest(low, _MISSING)
        idle = _longest(low, _IDLE)
        if missing and len(missing) >= len(idle):
            for item in items:
                context.findings.left_out(item, "not carried over", _MISSING[missing])
        elif idle:
            context.findings.no_effect(items, "not needed", _IDLE[idle])
        elif low.startswith(_NAMED):
            context.findings.no_effect(items, "not needed", "nothing that is carried over uses it")
        elif any(word in context.model.groups.get(kind, "").casefold() for word in _SYSTEM_GROUPS):
            for item in items:
                context.findings.left_out(
                    item, "not carried over", "part of a system: the loads here are ideal"
                )
        else:
            for item in items:
                context.findings.left_out(item, "not carried over", "its effect is missing in the results")


def _longest(kind: str, table: dict[str, str]) -> str:
    return max((start for start in table if kind.startswith(start)), key=len, default="")


@reads("Site:HeightVariation", "RunPeriod")
def _beside(context: Context) -> None:
    """What is read, and acts on more than what is carried over."""
    heights = context.model.one("Site:HeightVariation")
    if heights is not None and heights.fields.get("air_temperature_gradient_coefficient"):
        context.findings.approximated(
            heights, "air that is colder high up", "the same air at all heights: 0.065 K for 10 m"
        )
    days = context.model.one("RunPeriod")
    if days is not None:
        for key, what in (
            ("use_weather_file_daylight_saving_period", "daylight saving"),
            ("use_weather_file_holidays_and_special_days", "holidays"),
        ):
            asked = days.word(key) == "yes" and days.fields.get(key)
            if asked and context.special_days.get(what, True):
                context.findings.approximated(
                    days, key.replace("_", " "), "those of the weather file have no effect, if it has any"
                )
        if days.word("use_weather_file_rain_indicators") in ("", "yes"):
            context.findings.approximated(
                days, "rain", "surfaces outdoors stay dry, where EnergyPlus wets them while it rains"
            )
