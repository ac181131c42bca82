"""Each file holds the numbers of its slab, then the temperature of the inside surface at each hour."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from mascarin.verification.suites.case_data import CaseData, CasePlace, Tree, simulated
from mascarin.verification.suites.verdict import VerdictLine, around

if TYPE_CHECKING:
    import numpy.typing as npt

#: Largest deviation. [K]
_TOLERANCE: Final = 0.1
_STEP: Final = "10min"


@dataclass(frozen=True)
class BlandSlab:
    """A slab, its film outside, its start, the step of the air, and the temperature inside at each hour."""

    thickness: float
    conductivity: float
    specific_heat: float
    density: float
    film: float
    initial: float
    jump: float
    inside: npt.NDArray[np.float64]

    @classmethod
    def of_text(cls, text: str) -> BlandSlab:
        """Read what a file says."""
        before, _, after = text.partition("IOSTEP Output Data")
        _, _, inputs = before.partition("Input Data")
        numbers = [
            float(line.split(",")[0])
            for line in inputs.splitlines()[2:]
            if line.strip() and not line.strip().startswith("*")
        ]
        # The number of steps, and how many of them a printed value is apart.
        count = int(numbers[9] / numbers[10])
        _, _, table = after.partition("Temperature (K)")
        rows = re.findall(r"^\s*(-?\d[\d.E+-]*)\s*,\s*-?\d", table, flags=re.MULTILINE)
        thickness, conductivity, specific_heat, density, film, initial, jump = numbers[:7]
        inside = np.array(rows[:count], dtype=np.float64)
        return cls(thickness, conductivity, specific_heat, density, film, initial, jump, inside)

    def tree(self) -> Tree:
        """Describe the slab; a second wall gives the zone a surface."""
        closed = {"adiabatic": True}
        air = {
            "outdoors": True,
            "convection": self.film,
            "emissivity": 0.9,
            "absorptance": 0,
            "longwave": "none",
        }
        vertical = {"construction": "slab", "area": 1, "tilt": 90, "azimuth": 0}
        inside = {"zone": "room", "convection": 1, "emissivity": 0.9}
        return {
            "name": "slab",
            "site": {"latitude": 52.383, "longitude": 13.067, "altitude": 0, "timezone": "UTC+1"},
            "materials": {
                "slab": {
                    "conductivity": self.conductivity,
                    "density": self.density,
                    "specific_heat": self.specific_heat,
                }
            },
            "constructions": {"slab": {"layers": [{"material": "slab", "thickness": self.thickness}]}},
            "zones": {"room": {"volume": 1, "longwave": "none"}},
            "surfaces": {
                "slab": {**vertical, "outside": air, "inside": closed},
                "other": {**vertical, "outside": closed, "inside": inside},
            },
        }


def lines(data: CaseData) -> Iterator[VerdictLine]:
    """The largest deviation of each slab."""
    paths = sorted(data.folder.glob("Test_*_Analytical.csv.gz"), key=lambda path: _number(path.name))
    for path in paths:
        slab = BlandSlab.of_text(data.text(path.name.removesuffix(".gz")))
        outdoor = np.full(len(slab.inside) + 2, slab.initial + slab.jump)
        climate = CasePlace().climate({"air_temperature": outdoor})
        building = data.building(slab.tree())
        hours, table = simulated(building, climate, ["slab.inside_temperature"], _STEP, slab.initial)
        hour = np.arange(1, len(slab.inside) + 1)
        values = np.interp(hour, hours, table["slab.inside_temperature"].to_numpy())
        worst = int(np.abs(values - slab.inside).argmax())
        yield VerdictLine(
            "-".join(map(str, _number(path.name))),
            f"inside surface, worst of {len(hour)} h",
            "degC",
            float(values[worst]),
            float(slab.inside[worst]),
            around(float(slab.inside[worst]), _TOLERANCE),
            note=f"at hour {hour[worst]}; {slab.thickness:g} m, conductivity {slab.conductivity:g} W/(m K)",
        )


def _number(name: str) -> tuple[int, int]:
    first, second = re.findall(r"(\d+)-(\d+)", name)[0]
    return int(first), int(second)
