"""
Products of the library
=======================

The library has phase-change products with their measured curves. The freezing curve of a product lies
below its melting curve: the material has hysteresis.
"""

import matplotlib.pyplot as plt

from mascarin.materials import search
from mascarin.materials.plots import plot

found = [one for one in search(melting=(21, 24), kind="organic") if one.freezing_temperature][:3]
for one in found:
    print(
        f"{one.name}: melts at {one.melting_temperature:.1f} °C, freezes at {one.freezing_temperature:.1f} °C"
    )

# %%
# Enthalpy above, apparent specific heat below.

figure, axes = plt.subplots(2, sharex=True, layout="constrained")
plot(found, axes)
