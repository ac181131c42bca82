"""
Melting laws
============

A melting law gives the liquid fraction as a function of temperature. All laws here have the melting
temperature 24 °C and about the same width.
"""

import matplotlib.pyplot as plt
import numpy as np

import mascarin as mc

b = mc.building
laws = {
    "tanh, width 1 K": b.TanhLaw(width=1),
    "smooth step, ± 2 K": b.SmoothStepLaw(width=2, continuity=1),
    "gaussian, 0.8 K": b.GaussianLaw(width=0.8),
    "gumbel, long tail below": b.GumbelLaw(width=0.8, tail="low"),
    "linear, ± 2 K": b.LinearLaw(width=2),
    "triangle, 3 K below, 1 K above": b.TriangleLaw(below=3, above=1),
}

temperature = np.linspace(19, 29, 401)
figure, axes = plt.subplots(layout="constrained")
for name, law in laws.items():
    axes.plot(temperature, [law.fraction(t - 24) for t in temperature], label=name)
axes.set(xlabel="temperature [°C]", ylabel="liquid fraction [-]")
axes.legend()
