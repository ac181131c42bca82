"""
Calibration
===========

A brick wall with a sensor between insulation and brick. The conductivity of the insulation and the
absorptance are fitted to the measurements; the example is synthetic, so that the true values are known:
0.033 W/(m K) and 0.62.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import synthetic_wall
from mascarin.measurements import Sensor

wall = synthetic_wall()
output = "wall.interface_1_temperature"
vary = ["materials.insulation.conductivity", "surfaces.wall.outside.absorptance"]
found = mc.calibrate(
    wall.building,
    wall.climate,
    wall.measurements,
    sensors={output: Sensor("joint", expanded_uncertainty=0.1)},
    vary=vary,
    start="2023-03-05",
    end="2023-03-08",
    step="1h",
)
print(found.to_dataframe()[["estimate", "low", "high"]] if "estimate" in found.to_dataframe() else found)

# %%
# The wall as described, the calibrated wall, and the measurements, on days that were not used.

options = {"measurements": wall.measurements, "step": "1h", "outputs": [output]}
before = mc.simulate(wall.building, wall.climate, **options)[output]
after = mc.simulate(found.building, wall.climate, **options)[output]
measured = wall.measurements.to_dataframe()["joint"]
figure, axes = plt.subplots(layout="constrained")
axes.plot(measured.index.tz_localize(None), measured, ".", color="black", markersize=3, label="measured")
axes.plot(before.local_time, before, label="as described")
axes.plot(after.local_time, after, label="calibrated")
axes.set_ylabel("between insulation and brick [°C]")
axes.legend()
figure.autofmt_xdate()
