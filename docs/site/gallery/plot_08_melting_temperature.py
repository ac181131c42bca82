"""
Which melting temperature?
==========================

A sweep over the melting temperature: the highest air temperature has a minimum where the board melts in
the day and freezes at night. Members of a sweep run side by side in the lanes of the processor.
"""

import matplotlib.pyplot as plt
import numpy as np

import mascarin as mc
from mascarin.examples import box, clear_days

b = mc.building
board = b.PhaseChangeMaterial(
    density=855,
    conductivity=0.2,
    specific_heat=3000,
    latent_heat=100000,
    melting_temperature=26,
    law=b.TanhLaw(width=0.8),
)
lined = box().replace(
    {
        "materials.board": board,
        "materials.foam": b.Solid(conductivity=0.035, density=30, specific_heat=1400),
        "constructions.wall": b.Construction(
            layers=[b.Layer(material="foam", thickness=0.08), b.Layer(material="board", thickness=0.015)]
        ),
    }
)
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-07-01", days=6, mean=25, swing=7, altitude=1650
)
temperatures = np.linspace(20, 34, 29)
found = mc.sweep(
    lined,
    climate,
    {"materials.board.melting_temperature": temperatures},
    objectives={"highest": lambda run: run["room.air_temperature"].max("time")},
    start="2024-07-03",
)
figure, axes = plt.subplots(layout="constrained")
axes.plot(temperatures, found["highest"], "o-")
axes.set(xlabel="melting temperature [°C]", ylabel="highest air temperature [°C]")
