"""
An overhang over a window
=========================

Case 610 is case 600 with an overhang. In June, when the sun is high, it shades the windows; in December
hardly.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import mascarin as mc
from mascarin.examples import clear_days

cases = Path(mc.__file__).parent / "verification" / "bestest" / "buildings"
months = np.arange(1, 13)
figure, axes = plt.subplots(layout="constrained")
for name, label in (("600", "no shade"), ("610", "overhang of 1 m")):
    case = mc.load(cases / f"{name}.yaml")
    entered = []
    for month in months:
        climate = clear_days(
            39.83, -104.65, timezone="UTC-7", start=f"2024-{month:02d}-21", days=2, altitude=1650
        )
        run = mc.simulate(
            case, climate, outputs=["room.transmitted_solar"], end=climate.index[24], step="30min"
        )
        entered.append(run.heat("room.transmitted_solar") / 3.6e6)
    axes.plot(months, entered, "o-", label=label)
axes.set(
    xlabel="month, a clear day about the 21st", ylabel="solar radiation that enters [kWh/d]", ylim=(0, None)
)
axes.legend()
