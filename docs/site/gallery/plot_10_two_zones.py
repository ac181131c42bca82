"""
A sunspace beside a room
========================

Case 960 of Standard 140: a sunspace with windows, and behind a common wall a room that is kept between
20 and 27 °C.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

case = mc.load(Path(mc.__file__).parent / "verification" / "bestest" / "buildings" / "960.yaml")
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-01-10", days=6, mean=0, swing=8, altitude=1650
)
zones = list(case.zones)
loads = [output.name for output in case.outputs() if output.kind == "heating_load"]
run = mc.simulate(
    case, climate, start="2024-01-12", outputs=[*(f"{zone}.air_temperature" for zone in zones), *loads]
)

figure, (top, bottom) = plt.subplots(2, sharex=True, layout="constrained")
for zone in zones:
    air = run[f"{zone}.air_temperature"]
    top.plot(air.local_time, air, label=zone)
top.set_ylabel("air [°C]")
top.legend()
for name in loads:
    bottom.plot(run[name].local_time, run[name], label=name)
bottom.set_ylabel("load [W]")
bottom.legend()
figure.autofmt_xdate()
