"""
Sun through a window
====================

What reaches the glass of the south windows of case 600, what they transmit, and what leaves the room
again through them.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

case = mc.load(Path(mc.__file__).parent / "verification" / "bestest" / "buildings" / "600.yaml")
window = next(iter(case.windows))
names = [
    f"{window}.incident_solar",
    f"{window}.solar_transmittance",
    "room.transmitted_solar",
    "room.lost_solar",
]

figure, axes = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
for month, label in (("2024-12-21", "December"), ("2024-06-21", "June")):
    climate = clear_days(39.83, -104.65, timezone="UTC-7", start=month, days=2, mean=10, altitude=1650)
    run = mc.simulate(case, climate, outputs=names, end=climate.index[24])
    hours = run[names[0]].local_time.dt.hour + run[names[0]].local_time.dt.minute / 60
    axes[0].plot(hours, run[names[0]], label=f"{label}, incident")
    axes[1].plot(hours, run[names[1]], label=label)
    share = run.heat("room.lost_solar") / run.heat("room.transmitted_solar")
    print(
        f"{label}: {run.heat('room.transmitted_solar') / 3.6e6:.1f} kWh transmitted, {share:.1%} lost again"
    )
axes[0].set(xlabel="hour", ylabel="solar radiation on the glass [W/m²]")
axes[1].set(xlabel="hour", ylabel="solar transmittance [-]")
for ax in axes:
    ax.legend()
