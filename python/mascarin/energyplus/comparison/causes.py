"""Why the results of EnergyPlus and Mascarin differ in a model, as far as it is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from mascarin.energyplus.comparison.run_folder import PeerRun
from mascarin.energyplus.conversion import Conversion
from mascarin.energyplus.writing import level_lines

#: Steps in an hour from which switched loads follow closely [1/h].
_FINE: Final = 12


@dataclass(frozen=True)
class Documented:
    """A difference of the programs that is not one of the conversion (docs/energyplus.md).

    Attributes
    ----------
    applies : callable
        Whether a model has it.
    text : str
        What differs, with its size where it was measured, by making the input equal in both programs.
    """

    applies: Callable[[Conversion, PeerRun], bool]
    text: str


def _has_windows(conversion: Conversion, _: PeerRun) -> bool:
    return bool(conversion.building.windows)


def _has_switched_gains(conversion: Conversion, _: PeerRun) -> bool:
    zones = conversion.building.zones.values()
    scheduled = any(gain.schedule is not None for zone in zones for gain in zone.gains.values())
    return scheduled and conversion.steps_per_hour < _FINE


def _has_old_sun(conversion: Conversion, run: PeerRun) -> bool:
    return run.shadow_days > 1 and bool(conversion.building.surfaces)


def _has_hysteresis(conversion: Conversion, _: PeerRun) -> bool:
    return any("PhaseChangeHysteresis" in finding.kind for finding in conversion.findings)


#: Sizes are those of the plain room of ``tests/idf_small``: 0.29 K, 898 kWh of heating, 1975 kWh of cooling.
DOCUMENTED: Final = (
    Documented(
        _has_windows,
        "sun near the disc and light near the horizon pass glass at the angle of the beam here, as "
        "the rest of the sky in EnergyPlus (heating -0.9 %, cooling -0.6 % in a room with one window; the "
        "angle of the beam is nearer to physics)",
    ),
    Documented(
        _has_windows,
        "EnergyPlus makes some heat in glass, whose shares add up to 1.007 to 1.013, and loses up to 1.4 % "
        "of the radiation of an hour between hours (heating -0.4 % in a room with one window)",
    ),
    Documented(
        _has_windows,
        "diffuse sun first hits what a window sees in EnergyPlus, and what the zone states here (heating "
        "+0.1 %, cooling -0.2 % in a room with one window)",
    ),
    Documented(
        lambda *_: True,
        "EnergyPlus repeats the first day at most 25 times, until temperatures change by less than 0.4 K: "
        "the first weeks of zones without heating (1 K in January in a closed plenum). Smaller tolerances "
        "and more days in 'Building' take it away",
    ),
    Documented(
        _has_old_sun,
        "EnergyPlus took the place of the sun and the shadows from the mean of several days (0.03 K in two "
        "rooms with windows): 'ShadowCalculation,PolygonClipping,Periodic,1;' takes each day's",
    ),
    Documented(
        _has_switched_gains,
        "loads that are switched at long steps: 0.39 K at 15 min, 0.12 K at 5 min for 2 kW in a small room. "
        "Both programs agree better with 'Timestep,12;'",
    ),
    Documented(
        _has_hysteresis,
        "EnergyPlus does not conserve heat between its curves of melting and freezing "
        "(docs/pcm-energyplus.md)",
    ),
)  # fmt: skip


def known_causes(conversion: Conversion, run: PeerRun) -> list[str]:
    """Causes of differences: what is not carried over as it is, then the documented ones.

    Parameters
    ----------
    conversion : Conversion
        The converted model.
    run : PeerRun
        Results of EnergyPlus.
    """
    return [
        *(f"left out: {line}" for line in level_lines(conversion, "left out")),
        *(f"in another form: {line}" for line in level_lines(conversion, "approximated")),
        *(cause.text for cause in DOCUMENTED if cause.applies(conversion, run)),
    ]
