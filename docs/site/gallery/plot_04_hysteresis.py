"""
Hysteresis
==========

Many products freeze some kelvins below their melting temperature. Three models say what happens where
the temperature turns back within the melting range. The enthalpy depends on temperature and liquid
fraction alone, so that a closed cycle returns all heat.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import box_climate

b = mc.building


def board(model):
    """A board whose two surfaces follow a schedule: it melts, freezes in part, melts again, and freezes."""
    corners = ("00:00", 14), ("08:00", 30), ("13:00", 20.5), ("17:00", 25), ("23:00", 14)
    ends = [value for _, value in corners[1:]] + [14]
    day = [
        b.TemperaturePoint(at=at, value=value, ramp_to=to)
        for (at, value), to in zip(corners, ends, strict=True)
    ]
    return mc.Building(
        name="board",
        site=b.Site(latitude=39.83, longitude=-104.65, altitude=1650, timezone="UTC-7"),
        materials={
            "wax": b.PhaseChangeMaterial(
                density=855, conductivity=0.2, specific_heat=3000, latent_heat=71000,
                melting_temperature=23.4,
                law=b.TanhLaw(width=1), hysteresis=b.Hysteresis(model=model, freezing_temperature=19.9),
            )
        },
        constructions={"board": b.Construction(layers=[b.Layer(material="wax", thickness=0.005)])},
        schedules={"oven": b.TemperatureSchedule(days=b.TemperatureDays(all=day))},
        surfaces={
            "board": b.Surface(
                construction="board", area=1, tilt=0,
                outside=b.Side(scheduled="oven"), inside=b.Side(scheduled="oven"),
            )
        },
    )  # fmt: skip


models = ("curve_track", "curve_switch", "curve_scale")
names = ["board.wax_temperature", "board.wax_liquid_fraction"]
figure, axes = plt.subplots(1, 3, figsize=(9, 3.4), sharey=True, layout="constrained")
for ax, model in zip(axes, models, strict=True):
    run = mc.simulate(board(model), box_climate(), step="5min", outputs=names, start="2001-07-02")
    ax.plot(run[names[0]], run[names[1]], linewidth=1)
    ax.set(
        title=f"{model}\nenergy-balance residual {run.energy.relative_residual:.0e}",
        xlabel="temperature [°C]",
    )
axes[0].set_ylabel("liquid fraction [-]")
