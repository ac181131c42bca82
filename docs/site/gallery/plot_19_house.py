"""
A house with mechanical ventilation
===================================

Three rooms: a ventilation unit with heat recovery supplies the living room and extracts from the bath,
which is held at 24 °C; air moves through the corridor. Rooms of real test houses are described in this
way, with measured columns in place of numbers.
"""

import matplotlib.pyplot as plt

import mascarin as mc
from mascarin.examples import clear_days

b = mc.building


def side(zone):
    """The side of a wall that faces a zone."""
    return b.Side(zone=zone, convection="tarp", emissivity=0.9)


outdoors = b.Side(outdoors=True, convection="mowitt", emissivity=0.9, absorptance=0.23)
house = mc.Building(
    name="house",
    site=b.Site(latitude=47.9, longitude=11.7, altitude=680, timezone="UTC+1"),
    materials={
        "brick": b.Solid(conductivity=0.22, density=800, specific_heat=1000),
        "wool": b.Solid(conductivity=0.035, density=80, specific_heat=840),
    },
    constructions={
        "facade": b.Construction(
            layers=[b.Layer(material="wool", thickness=0.12), b.Layer(material="brick", thickness=0.24)]
        ),
        "partition": b.Construction(layers=[b.Layer(material="brick", thickness=0.115)]),
    },
    zones={
        "living": b.Zone(volume=82, infiltration=0.1, gains={"heater": b.Gain(power=350, radiative=0.3)}),
        "corridor": b.Zone(volume=14, infiltration=0.05),
        "bath": b.Zone(volume=17, infiltration=0.05, held=24),
    },
    air_paths={
        "to_corridor": b.AirPath(between=("living", "corridor"), flow=0.02, one_way=True),
        "to_bath": b.AirPath(between=("corridor", "bath"), flow=0.02, one_way=True),
    },
    ventilation_units={
        "unit": b.VentilationUnit(supply={"living": 0.02}, exhaust={"bath": 0.02}, recovery=0.8)
    },
    surfaces={
        "south": b.Surface(
            construction="facade", area=50, tilt=90, azimuth=180, outside=outdoors, inside=side("living")
        ),
        "north": b.Surface(
            construction="facade", area=20, tilt=90, azimuth=0, outside=outdoors, inside=side("bath")
        ),
        "living_wall": b.Surface(
            construction="partition",
            area=12,
            tilt=90,
            azimuth=0,
            outside=side("corridor"),
            inside=side("living"),
        ),
        "bath_wall": b.Surface(
            construction="partition",
            area=8,
            tilt=90,
            azimuth=0,
            outside=side("corridor"),
            inside=side("bath"),
        ),
    },
)
climate = clear_days(47.9, 11.7, timezone="UTC+1", start="2024-01-10", days=8, mean=0, swing=4, altitude=680)
names = [*(f"{zone}.air_temperature" for zone in house.zones), "bath.heating_load"]
figure, axes = plt.subplots(layout="constrained")
for recovery in (0.8, 0.0):
    run = mc.simulate(
        house,
        climate,
        parameters={"ventilation_units.unit.recovery": recovery},
        outputs=names,
        start="2024-01-14",
    )
    for zone in house.zones:
        air = run[f"{zone}.air_temperature"]
        axes.plot(air.local_time, air, "-" if recovery else "--", label=f"{zone}, recovery {recovery:.0%}")
axes.set_ylabel("air [°C]")
axes.legend(fontsize="small")
figure.autofmt_xdate()
