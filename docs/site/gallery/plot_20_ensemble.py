"""
An ensemble
===========

Every number of a description has a plausible range. A Latin hypercube of 256 members gives the band of
the air temperature that follows from all ranges together.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.ensemble import latin_hypercube
from mascarin.examples import box, clear_days

climate = clear_days(39.83, -104.65, timezone="UTC-7", start="2024-07-01", days=4, mean=22, altitude=1650)
found = mc.sweep(
    box(),
    climate,
    latin_hypercube(box(), 256, seed=1),
    outputs=["room.air_temperature"],
    start="2024-07-02",
    step="30min",
)
air = found["room.air_temperature"]
figure, axes = plt.subplots(layout="constrained")
for low, high in ((0.025, 0.975), (0.25, 0.75)):
    ends = air.quantile([low, high], "member")
    axes.fill_between(air.local_time, *ends, alpha=0.3, color="C0", label=f"{high - low:.0%} of the members")
axes.plot(air.local_time, air.median("member"), color="C0", label="median")
axes.set_ylabel("air [°C]")
axes.legend()
figure.autofmt_xdate()
