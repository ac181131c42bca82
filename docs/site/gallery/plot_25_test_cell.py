"""
A test cell with a phase-change ceiling
=======================================

The LGI cell on Reunion Island: a room, an air gap and a steel roof, with a phase-change board on the
ceiling. Its description and a virtual experiment of 92 days are shipped. Here the uncalibrated model
beside the virtual measurements.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import STUDIES

study = mc.Study.from_yaml(STUDIES["lgi"])
names = {"room.air_temperature": "room_air", "ceiling.inside_temperature": "plasterboard_face"}
run = mc.simulate(
    study.building,
    study.climate,
    start="2010-08-10",
    end="2010-08-15",
    outputs=list(names),
    measurements=study.measurements,
)
measured = study.measurements.to_dataframe().loc["2010-08-10":"2010-08-14"]

figure, axes = plt.subplots(2, sharex=True, layout="constrained")
for ax, (output, column) in zip(axes, names.items(), strict=True):
    ax.plot(
        measured.index.tz_localize(None), measured[column], ".", color="black", markersize=2, label="measured"
    )
    ax.plot(run[output].local_time, run[output], label=output)
    ax.set_ylabel("[°C]")
    ax.legend()
figure.autofmt_xdate()
