"""
A room as a linear model
========================

Where all laws are linear, a building is a model in state space: ``dx/dt = A x + B u``. Its eigenvalues
are the time constants of the room.
"""

import matplotlib.pyplot as plt
import numpy as np

import mascarin as mc
from mascarin.examples import box

linear = {"kind": "linearised", "reference": 20.0}
model = mc.state_space(
    box().replace({"zones.room.longwave": linear, "surfaces.facade.outside.longwave": linear})
)
hours = model.time_constants() / 3600
print(f"{len(model.states)} states; longest time constants: {hours[0]:.1f} h, {hours[1]:.2f} h")

figure, axes = plt.subplots(layout="constrained")
axes.semilogy(np.arange(1, hours.size + 1), hours, "o")
axes.set(xlabel="number", ylabel="time constant [h]")
