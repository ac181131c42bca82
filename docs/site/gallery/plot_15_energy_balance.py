"""
Energy balance
==============

Every run adds up the heat that enters by each way, and reports what is missing, divided by all heat
exchanged.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

case = mc.load(Path(mc.__file__).parent / "verification" / "bestest" / "buildings" / "900.yaml")
climate = clear_days(
    39.83, -104.65, timezone="UTC-7", start="2024-01-10", days=7, mean=0, swing=8, altitude=1650
)
energy = mc.simulate(case, climate).energy
print(energy)

flows = {name: heat / 3.6e6 for name, heat in energy.into.items() if abs(heat) > 1e3}
flows["stored"] = energy.stored / 3.6e6
figure, axes = plt.subplots(layout="constrained")
axes.barh(list(flows), list(flows.values()))
axes.axvline(0, color="black", linewidth=0.8)
axes.set(
    xlabel="net heat into the building in a week [kWh]", title=f"residual {energy.relative_residual:.0e}"
)
axes.invert_yaxis()
