"""
Models of the sky
=================

At night a roof loses heat to the sky. Models estimate the emission of the clear sky from the dew point.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import box, clear_days

climate = clear_days(39.83, -104.65, timezone="UTC-7", start="2024-07-01", days=3, mean=22, altitude=1650)
figure, axes = plt.subplots(layout="constrained")
for kind in ("martin_berdahl", "clark_allen", "brunt", "offset"):
    run = mc.simulate(
        box().replace({"site.sky": {"kind": kind}}), climate, start="2024-07-02", outputs=["sky_temperature"]
    )
    axes.plot(run["sky_temperature"].local_time, run["sky_temperature"], label=kind)
air = climate.to_dataframe()["air_temperature"].iloc[24:]
axes.plot(air.index.tz_localize(None), air, "k--", label="air")
axes.set_ylabel("sky temperature [°C]")
axes.legend()
figure.autofmt_xdate()
