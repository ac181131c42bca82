"""
Set points by schedule
======================

Case 640 of Standard 140: heating to 10 °C at night and 20 °C in the day. A load is the mean over a time
step that brings the air to the set point at the end of the step.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

cases = Path(mc.__file__).parent / "verification" / "bestest" / "buildings"
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-01-10", days=4, mean=-4, swing=6, altitude=1650
)
figure, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
for name, label in (("600", "20 °C always"), ("640", "10 °C at night")):
    case = mc.load(cases / f"{name}.yaml")
    run = mc.simulate(
        case, climate, start="2024-01-12", outputs=["room.air_temperature", "room.heating_load"]
    )
    air, load = run["room.air_temperature"], run["room.heating_load"]
    heat = run.heat("room.heating_load") / 3.6e6
    top.plot(air.local_time, air, label=label)
    bottom.step(load.local_time, load / 1000, where="pre", label=f"{label}: {heat:.0f} kWh")
top.set_ylabel("air [°C]")
bottom.set_ylabel("heating load [kW]")
top.legend()
bottom.legend()
figure.autofmt_xdate()
