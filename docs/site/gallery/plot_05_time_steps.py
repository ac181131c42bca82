"""
Heat that is lost with an apparent heat capacity
================================================

A common scheme multiplies temperature differences by the slope of the enthalpy at the old temperature.
Where a step jumps over the melting range, latent heat is lost. The default scheme solves for the
enthalpy: its energy balance closes at any step. The scheme of the literature is there to show the
difference.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

b = mc.building
room = mc.Building(
    name="room under a board",
    site=b.Site(latitude=43.6, longitude=3.9, altitude=50, timezone="UTC+1"),
    materials={
        "board": b.PhaseChangeMaterial(
            density=855, conductivity=(0.22, 0.18), specific_heat=(3134, 2833), latent_heat=71000,
            melting_temperature=25, law=b.TanhLaw(width=0.3),
        ),
        "wood": b.Solid(conductivity=0.13, density=500, specific_heat=1600),
    },
    constructions={
        "roof": b.Construction(
            layers=[b.Layer(material="wood", thickness=0.06), b.Layer(material="board", thickness=0.01)]
        )
    },
    zones={"room": b.Zone(volume=27, infiltration=0.5)},
    surfaces={
        "roof": b.Surface(
            construction="roof", area=9, tilt=0,
            outside=b.Side(outdoors=True, convection=15, emissivity=0.9, absorptance=0.7),
            inside=b.Side(zone="room", convection=3, emissivity=0.9),
        )
    },
)  # fmt: skip
climate = clear_days(43.6, 3.9, timezone="UTC+1", start="2024-07-01", days=5, mean=23, swing=7)

minutes = [5, 10, 15, 30, 60]
figure, axes = plt.subplots(layout="constrained")
for scheme in ("apparent-capacity", "backward-euler", "sdirk2"):
    lost = [
        mc.simulate(room, climate, step=60 * m, scheme=scheme, initial=24).energy.relative_residual
        for m in minutes
    ]
    axes.loglog(minutes, lost, "o-", label=scheme)
axes.set(
    xlabel="time step [min]",
    ylabel="relative energy-balance residual [-]",
    xticks=minutes,
    xticklabels=minutes,
)
axes.minorticks_off()
axes.legend()
