"""
A phase-change board in a room
==============================

A light room with plain boards, and the same room with boards that melt about 23.5 °C. The board takes heat
in the afternoon and gives it back at night.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

b = mc.building
plain = mc.Building(
    name="light room",
    site=b.Site(latitude=45, longitude=5, altitude=200, timezone="UTC+1"),
    materials={
        "foam": b.Solid(conductivity=0.035, density=30, specific_heat=1400),
        "board": b.Solid(conductivity=0.2, density=855, specific_heat=3000),
    },
    constructions={
        "shell": b.Construction(
            layers=[b.Layer(material="foam", thickness=0.12), b.Layer(material="board", thickness=0.015)]
        )
    },
    zones={"room": b.Zone(volume=50, infiltration=0.5, gains={"people": b.Gain(power=80, radiative=0.5)})},
    surfaces={
        name: b.Surface(
            construction="shell", area=area, tilt=tilt, azimuth=azimuth,
            outside=b.Side(outdoors=True, convection="doe2", emissivity=0.9, absorptance=0.6),
            inside=b.Side(zone="room", convection="tarp", emissivity=0.9),
        )
        for name, area, tilt, azimuth in (
            ("roof", 20, 0, 0), ("south", 12.5, 90, 180), ("north", 12.5, 90, 0),
            ("east", 10, 90, 90), ("west", 10, 90, 270),
        )
    },
)  # fmt: skip
melting = b.PhaseChangeMaterial(
    density=855,
    conductivity=(0.22, 0.18),
    specific_heat=(3134, 2833),
    latent_heat=71000,
    melting_temperature=23.5,
    law=b.TanhLaw(width=1),
)
with_pcm = plain.replace({"materials.board": melting})

climate = clear_days(45, 5, timezone="UTC+1", start="2024-07-01", days=6, mean=17, swing=7)
runs = {
    name: mc.simulate(one, climate, start="2024-07-03") for name, one in (("plain", plain), ("PCM", with_pcm))
}

figure, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
for name, run in runs.items():
    air = run["room.air_temperature"]
    top.plot(air.local_time, air, label=f"{name}, at most {air.max().item():.1f} °C")
top.set_ylabel("air [°C]")
top.legend()
fraction = runs["PCM"]["roof.board_liquid_fraction"]
bottom.plot(fraction.local_time, fraction)
bottom.set(ylabel="liquid fraction of the roof [-]", ylim=(0, 1))
figure.autofmt_xdate()
