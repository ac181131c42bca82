"""
Ventilation at night
====================

Case 650 of Standard 140: a fan brings outdoor air from 18:00 to 07:00; the room is cooled in the day.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

case = mc.load(Path(mc.__file__).parent / "verification" / "bestest" / "buildings" / "650.yaml")
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-07-10", days=5, mean=22, swing=8, altitude=1650
)
names = ["room.air_temperature", "room.air_changes", "room.cooling_load"]
run = mc.simulate(case, climate, start="2024-07-12", outputs=names)

figure, axes = plt.subplots(3, sharex=True, layout="constrained")
run.plot(names, ax=axes)
