"""
A material from a calorimeter
=============================

A differential scanning calorimeter (DSC) measures the heat flow into a sample that is heated at a
constant rate. From its file :func:`mascarin.from_dsc` makes a material: specific heats, latent heat,
onset, peak and end, and a law.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import mascarin as mc

# %%
# A file as an instrument writes it: 150 kJ/kg about 24 °C, heated with 0.25 K/min.

temperature = np.arange(10, 38, 0.05)
fraction = 0.5 + 0.5 * np.tanh((temperature - 24) / 0.8)
heat = np.gradient(2000 * (temperature - 24) + fraction * (150000 + 400 * (temperature - 24)), temperature)
rows = [
    f"{t:.2f};{(t - 10) / 0.25:.2f};{h * 0.25 / 60 / 1000:.6f}"
    for t, h in zip(temperature, heat, strict=True)
]
file = Path(tempfile.mkdtemp()) / "wax.csv"
file.write_text("##Temp./°C;Time/min;DSC/(mW/mg)\n" + "\n".join(rows), encoding="utf-8")

wax = mc.from_dsc(file)
print(wax.report())

# %%
# The measured curves, and the law that fits best.

figure, axes = plt.subplots(2, sharex=True, layout="constrained")
wax.plot(ax=axes)
