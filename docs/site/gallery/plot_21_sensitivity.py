"""
Which parameters matter
=======================

The spectral method varies all parameters at once and gives the part of the variance of an output that
each causes alone, with its interval.
"""

import mascarin as mc
from mascarin.examples import box, box_climate

found = mc.sensitivity_analysis(
    box(), box_climate(), outputs=["room.air_temperature"], step="1h", replicates=6, seed=1
)
print(found)

# %%
# First-order indices with 95 % intervals; open markers are not significant.

found.plot("indices", top=8)

# %%
# Over the hours of the day.

found.plot("day", top=5)
