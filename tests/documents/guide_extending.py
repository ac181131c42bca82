"""The metric and the object that docs/extending.md adds: ``guide_extending.py FOLDER``.

`test_docs_extending.py` runs it with the copy of the package that has them in front of the path.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import mascarin as mc
from mascarin.energyplus.model.handlers import HANDLERS
from mascarin.errors import InputError
from mascarin.study.file.schema import study_schema
from mascarin.validation.comparison import metrics
from mascarin.validation.criteria import judge, parse_criteria
from test_convert import box, converted, left_out

COMPUTERS = (
    "ElectricEquipment:ITE:AirCooled,Servers,Room,FlowFromSystem,Watts/Unit,150,10,,Half,Full,"
    "Curve1,0.4,0.0002,Curve2,Curve3;"
)
SCHEDULES = "Schedule:Constant,Half,,0.5;\nSchedule:Constant,Full,,0.8;"


def metric_is_used() -> None:
    found = metrics([20.0, 21.0, 22.0, 23.0], [20.1, 21.2, 22.3, 28.0])
    assert abs(found.median_error - 0.25) < 1e-12  # type: ignore[attr-defined]
    assert "median_error" in found.to_dict()
    assert "median_error" in repr(found)
    criteria = parse_criteria([{"metric": "median_error", "limit": 0.2}])
    (verdict,) = judge(criteria, {"room": {"blind": found}})
    assert (verdict.name, verdict.unit, verdict.passed) == ("median error <= 0.2 K", "degC", False)
    with pytest.raises(InputError, match="median_error"):
        parse_criteria([{"metric": "median_eror", "limit": 1}])
    assert "median_error" in str(study_schema())


def object_is_read(folder: Path) -> None:
    assert "electricequipment:ite:aircooled" in HANDLERS
    conversion = converted(folder, box(COMPUTERS, SCHEDULES))
    assert not [text for text in left_out(conversion) if "Servers" in text]
    gains = conversion.description["zones"]["Room"]["gains"]
    (gain,) = gains.values()
    assert abs(gain["power"] - 150 * 10 * 0.5 * 0.8) < 1e-9
    (zone,) = conversion.building.zones.values()
    (computers,) = zone.gains.values()
    assert computers.power is not None
    assert abs(float(computers.power) - 600.0) < 1e-9


if __name__ == "__main__":
    metric_is_used()
    object_is_read(Path(sys.argv[1]))
    sys.stdout.write(f"{Path(mc.__file__).parent}\n")
