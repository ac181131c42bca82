"""
Exact derivatives
=================

One run and one pass backward give the derivative of a result by every parameter, through phase change,
convection and radiation. Here the mean air temperature: its derivative times a tenth of each range.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import box, box_climate
from mascarin.simulation import Mean

room = box()
found = mc.gradient(
    room, box_climate(), Mean("room.air_temperature"), outputs=["room.air_temperature"], step="1h"
)
effects = {
    path: slope * (room.parameter(path).high - room.parameter(path).low) / 10
    for path, slope in found.slopes.items()
}
largest = sorted(effects, key=lambda path: -abs(effects[path]))[:10]

figure, axes = plt.subplots(layout="constrained")
axes.barh(largest, [effects[path] for path in largest])
axes.set(
    xlabel="effect on the mean air temperature of a tenth of the range [K]",
    title=f"mean {found.value:.2f} °C",
)
axes.invert_yaxis()
