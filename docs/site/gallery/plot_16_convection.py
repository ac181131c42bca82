"""
Convection outside
==================

Laws for the convective heat transfer coefficient differ by a factor of two. The roof of a box under a
clear sky with each of them.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import box, clear_days

laws = {"constant 15": 15, "DOE-2": "doe2", "MoWiTT": "mowitt", "TARP": "tarp"}
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-07-01", days=3, mean=22, wind=3, altitude=1650
)
figure, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
for name, law in laws.items():
    one = box().replace({"surfaces.facade.outside.convection": law})
    run = mc.simulate(
        one, climate, start="2024-07-02", outputs=["facade.outside_convection", "facade.outside_temperature"]
    )
    h, surface = run["facade.outside_convection"], run["facade.outside_temperature"]
    top.plot(h.local_time, h, label=name)
    bottom.plot(surface.local_time, surface)
top.set_ylabel("h [W/(m² K)]")
bottom.set_ylabel("outer surface [°C]")
top.legend(ncols=2)
figure.autofmt_xdate()
