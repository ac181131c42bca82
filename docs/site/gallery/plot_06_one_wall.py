"""
One wall between outdoors and a room
====================================

The same insulation inside or outside of the same concrete: the U value is equal, the temperature of the
inner surface is not. The wall needs no zone: its inner side faces air of a scheduled temperature.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

b = mc.building
concrete, foam = b.Layer(material="concrete", thickness=0.15), b.Layer(material="foam", thickness=0.08)


def wall(layers):
    """A west wall of these layers, from outside to inside."""
    return mc.Building(
        name="wall",
        site=b.Site(latitude=45, longitude=5, altitude=200, timezone="UTC+1"),
        materials={
            "concrete": b.Solid(conductivity=1.75, density=2240, specific_heat=900),
            "foam": b.Solid(conductivity=0.035, density=30, specific_heat=1400),
        },
        constructions={"wall": b.Construction(layers=layers)},
        schedules={"room": b.TemperatureSchedule(value=24)},
        surfaces={
            "wall": b.Surface(
                construction="wall", area=10, tilt=90, azimuth=270,
                outside=b.Side(outdoors=True, convection="doe2", emissivity=0.9, absorptance=0.7),
                inside=b.Side(scheduled="room", convection=7.7),
            )
        },
    )  # fmt: skip


climate = clear_days(45, 5, timezone="UTC+1", start="2024-07-01", days=4, mean=24, swing=7)
figure, axes = plt.subplots(layout="constrained")
for name, layers in {"insulation outside": [foam, concrete], "insulation inside": [concrete, foam]}.items():
    run = mc.simulate(wall(layers), climate, start="2024-07-02")

    axes.plot(run["wall.inside_temperature"].local_time, run["wall.inside_temperature"], label=name)
axes.set(ylabel="inner surface [°C]")
axes.legend()
figure.autofmt_xdate()
