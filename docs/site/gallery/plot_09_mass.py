"""
Light and heavy rooms
=====================

Two free-floating cases of ANSI/ASHRAE Standard 140, shipped with Mascarin: 600FF of light, 900FF of
heavy construction. All else is equal.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

cases = Path(mc.__file__).parent / "verification" / "bestest" / "buildings"
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-01-10", days=6, mean=0, swing=8, altitude=1650
)

figure, axes = plt.subplots(layout="constrained")
for name in ("600FF", "900FF"):
    run = mc.simulate(mc.load(cases / f"{name}.yaml"), climate, start="2024-01-12")
    air = run["room.air_temperature"]
    axes.plot(air.local_time, air, label=f"case {name}: {air.min().item():.0f} to {air.max().item():.0f} °C")
axes.set_ylabel("air [°C]")
axes.legend()
figure.autofmt_xdate()
