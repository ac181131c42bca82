"""
A floor on the ground
=====================

The ground has an annual mean and an amplitude. A slab on it, a year with steps of one hour: the floor
loses heat in winter and takes some in summer.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

b = mc.building
slab = mc.Building(
    name="slab",
    site=b.Site(latitude=48, longitude=11, altitude=500, timezone="UTC+1"),
    materials={
        "concrete": b.Solid(conductivity=1.75, density=2240, specific_heat=900),
        "foam": b.Solid(conductivity=0.035, density=30, specific_heat=1400),
    },
    constructions={
        "bare": b.Construction(layers=[b.Layer(material="concrete", thickness=0.2)]),
        "insulated": b.Construction(
            layers=[b.Layer(material="foam", thickness=0.1), b.Layer(material="concrete", thickness=0.2)]
        ),
    },
    schedules={"room": b.TemperatureSchedule(value=20)},
    surfaces={
        name: b.Surface(
            construction=name, area=10, tilt=180,
            outside=b.Side(ground=b.Ground(mean=10, amplitude=7, coldest_day=50)),
            inside=b.Side(scheduled="room", convection=5.9),
        )
        for name in ("bare", "insulated")
    },
)  # fmt: skip
climate = clear_days(48, 11, timezone="UTC+1", start="2023-01-01", days=365, mean=9)
run = mc.simulate(slab, climate, step="1h", outputs=["bare.inside_flux", "insulated.inside_flux"]).every("1d")

figure, axes = plt.subplots(layout="constrained")
for name in run:
    axes.plot(run[name].local_time, run[name], label=name)
axes.set_ylabel("heat flux into the room [W/m²]")
axes.legend()
figure.autofmt_xdate()
