"""Shades, blinds and screens of windows, and what closes them."""

from __future__ import annotations

from typing import Final

from mascarin.energyplus.envelope.glazings import construction_of
from mascarin.energyplus.envelope.materials import layers_of
from mascarin.energyplus.envelope.slats import slats
from mascarin.energyplus.model.context import Context, Section
from mascarin.energyplus.model.handlers import reads
from mascarin.energyplus.model.idf import IdfObject
from mascarin.energyplus.model.schedules import fraction, year

_DEVICES: Final = ("WindowMaterial:Shade", "WindowMaterial:Blind", "WindowMaterial:Screen")
CONTROLS: Final = ("WindowShadingControl", "WindowProperty:ShadingControl")
#: Additional resistance of a blind with open edges, and its part of the resistance of the device where the
#: edges are closed (EN ISO 10077-1, classes "very high" and "high or average") [m2 K/W, m2 K/W, -].
_OPEN, _CLOSED, _OF_DEVICE = 0.08, 0.11, 0.55
#: Sum of the opening multipliers at the edges above which they are open [-].
_OPEN_EDGES: Final = 0.2
#: Controls by the irradiance of the window, or by nothing but a schedule.
_BY_SUN: Final = ("onifhighsolaronwindow",)
_BY_SCHEDULE: Final = ("alwayson", "onifscheduleallows")


@reads(*CONTROLS)
def describe_blinds(context: Context) -> None:
    """Enter the blinds of all windows that a control names, and of constructions that contain one.

    Raises
    ------
    InputError
        A device, construction or schedule does not exist.
    """
    for item in context.model.of(*CONTROLS):
        windows = _windows(context, item)
        if item.word("shading_control_type") == "alwaysoff":
            context.findings.no_effect([item], "a device that is always open", "nothing shades")
            continue
        blind = _controlled(context, item)
        if blind is None:
            continue
        for name in windows:
            _enter(context, item, name, blind)


def _windows(context: Context, item: IdfObject) -> list[str]:
    """Names of the windows of a control."""
    if item.kind == "WindowShadingControl":
        return [str(row.get("fenestration_surface_name", "")) for row in item.rows("fenestration_surfaces")]
    return [
        window.name
        for kind in ("FenestrationSurface:Detailed", "Window", "GlazedDoor")
        for window in context.model.of(kind)
        if window.word("shading_control_name") == item.name.casefold()
    ]


def _controlled(context: Context, item: IdfObject) -> Section | None:
    """The blind of a control, None where it cannot be carried over."""
    device, kind = _device(context, item), item.word("shading_control_type")
    shading = item.word("shading_type")
    inside, outside = shading.startswith("interior"), shading.startswith("exterior")
    effect = "the windows stay unshaded: more sun enters, and at night the glass alone insulates"
    if device is None or not (inside or outside) or kind not in (*_BY_SUN, *_BY_SCHEDULE):
        device_words, control_words = item.text("shading_type"), item.text("shading_control_type")
        context.findings.left_out(item, f"{device_words or 'a device'}, {control_words}", effect)
        return None
    blind: Section = {"position": "inside" if inside else "outside"} | device_values(context, device)
    if inside:
        # EnergyPlus computes the flow of this air. Its example files fit 0.2 to 0.5: none is taken.
        blind["to_air"] = 0.0
    if kind in _BY_SUN:
        blind["radiation"] = item.number("setpoint") or 0.0
    if item.word("shading_control_is_scheduled") == "yes" or kind == "onifscheduleallows":
        schedule, most = fraction(context, f"{item.name} closed", year(context, item, "schedule_name"))
        if schedule is None and most <= 0.0:
            return None
        blind |= {} if schedule is None else {"schedule": schedule}
    if inside:
        context.findings.approximated(
            item,
            "a device in the room",
            "the air between it and the glass carries no heat into the room: 10 to 15 % less cooling load; "
            "to_air of the blind can state a part",
        )
    slat_control = item.word("type_of_slat_angle_control_for_blinds")
    if device.kind.endswith("Blind") and slat_control not in ("", "fixedslatangle"):
        context.findings.approximated(item, f"slats by {slat_control}", "at the angle of the blind's object")
    if item.word("glare_control_is_active") == "yes":
        context.findings.left_out(item, "a control by glare", "the blind closes by its other condition alone")
    return blind


@reads(*_DEVICES)
def _device(context: Context, item: IdfObject) -> IdfObject | None:
    """Material of the shading device."""
    if item.text("shading_device_material_name"):
        return context.model.named(item.text("shading_device_material_name"), *_DEVICES)
    if not item.text("construction_with_shading_name"):
        return None
    shaded = construction_of(context, item, name=item.text("construction_with_shading_name"))
    return next((layer for layer in layers_of(context, shaded) if layer.kind in _DEVICES), None)


def device_values(context: Context, item: IdfObject) -> Section:
    """Optics, emissivity and resistance of a shade, a blind of slats or a screen.

    Parameters
    ----------
    context : Context
        The conversion.
    item : IdfObject
        The material.
    """
    edges = ("top", "bottom", "left_side", "right_side")
    keys = [f"{kind}{edge}_opening_multiplier" for kind in ("", "blind_") for edge in edges]
    free = sum(item.number(key) or 0.0 for key in keys) > _OPEN_EDGES
    gap = _OPEN if free or item.kind.endswith("Blind") else _CLOSED
    if item.kind.endswith("Shade"):
        through, reflected = item.needed("solar_transmittance"), item.needed("solar_reflectance")
        emissivity = item.number("infrared_hemispherical_emissivity") or 0.9
        if not free:
            gap += _OF_DEVICE * item.needed("thickness") / item.needed("conductivity")
    elif item.kind.endswith("Screen"):
        wires = item.needed("screen_material_diameter") / item.needed("screen_material_spacing")
        open_share = (1.0 - wires) ** 2
        # Hemispherical: wires hide more of what comes from the side.
        through, reflected = 0.93 * open_share, item.needed("diffuse_solar_reflectance") * (1.0 - open_share)
        emissivity = item.number("thermal_hemispherical_emissivity") or 0.9
    else:
        through, reflected = slats(
            item.needed("slat_width"),
            item.needed("slat_separation"),
            _angle(item),
            item.number("front_side_slat_beam_solar_reflectance") or 0.0,
            item.number("back_side_slat_beam_solar_reflectance") or 0.0,
        )
        emissivity = item.number("front_side_slat_infrared_hemispherical_emissivity") or 0.9
        if (item.number("slat_beam_solar_transmittance") or 0.0) > 0.0:
            context.findings.approximated(item, "slats that transmit", "opaque slats: a little less sun")
        # The finding speaks of all that is left of the slats.
        item.fields.pass_over("*slat_*")
        context.findings.approximated(
            item,
            "a blind of slats",
            f"the mean over the heights of the sun: {through:.2f} transmitted, {reflected:.2f} reflected",
        )
    return {
        "transmittance": round(through, 5),
        "reflectance": round(min(reflected, 1.0 - through), 5),
        "resistance": round(gap, 5),
        "emissivity": emissivity,
    }


def _angle(item: IdfObject) -> float:
    angle = item.number("slat_angle")
    return 45.0 if angle is None else angle


def _enter(context: Context, item: IdfObject, name: str, blind: Section) -> None:
    entered = context.names.entered("windows", name)
    window = context.section("windows").get(entered) if entered is not None else None
    if window is None:
        context.findings.left_out(item, f"a device of '{name}'", "no such window is carried over")
        return
    wall = context.section("surfaces")[window["surface"]]
    if not wall["outside"].get("outdoors"):
        context.findings.left_out(item, f"a blind of '{name}' between zones", "the window stays unshaded")
        return
    window["blind"] = dict(blind)
