"""Hypothesis strategies for descriptions: schedules, materials, constructions, whole buildings."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

Json = dict[str, Any]
Strategy = st.SearchStrategy

NAMES = st.from_regex(r"\A[a-z][a-z0-9_]{0,7}\Z").filter(lambda name: name not in ("outside", "inside"))


def numbers(low: float, high: float) -> Strategy[Any]:
    """Numbers in an interval: plain, or with a range, a source, and whether they are assumed."""
    plain = st.floats(low, high, allow_subnormal=False)
    return st.one_of(plain, plain.flatmap(lambda value: _noted(value, low, high)))


def _noted(value: float, low: float, high: float) -> Strategy[Any]:
    spans = st.tuples(st.floats(low, value), st.floats(value, high)).filter(lambda span: span[0] < span[1])
    notes: dict[str, Strategy[Any]] = {
        "source": st.sampled_from(["a table", "ISO 10456:2007", "data sheet: page 3", "#4, 'quoted'"]),
        "assumed": st.booleans(),
    }
    if low < high:
        notes["range"] = spans.map(list)
    return st.fixed_dictionaries({"value": st.just(value)}, optional=notes)


def times() -> Strategy[list[str]]:
    """Times of a day in order, the first of them midnight."""
    minutes = st.sets(st.integers(1, 1439), max_size=4)
    return minutes.map(lambda some: ["00:00", *(f"{m // 60:02d}:{m % 60:02d}" for m in sorted(some))])


@st.composite
def profiles(draw: st.DrawFn, low: float, high: float) -> list[Json]:
    """Points of a day, some with a ramp to the next."""
    points: list[Json] = []
    for at in draw(times()):
        point: Json = {"at": at, "value": draw(st.floats(low, high))}
        if draw(st.booleans()):
            point["ramp_to"] = draw(st.floats(low, high))
        points.append(point)
    return points


@st.composite
def schedules(draw: st.DrawFn, kind: str = "fraction") -> Json:
    """A schedule of a kind: one value, profiles of days with or without holidays, or a measured column."""
    low, high = (0.0, 1.0) if kind == "fraction" else (15.0, 19.0)
    way = draw(st.sampled_from(["value", "all", "week", "holidays", "column"]))
    if way == "value":
        return {"kind": kind, "value": draw(st.floats(low, high))}
    if way == "column":
        return {"kind": kind, "column": draw(NAMES)}
    days = ["all"] if way == "all" else ["weekdays", "weekends"]
    profile = {day: draw(profiles(low, high)) for day in days}
    if way != "holidays":
        return {"kind": kind, "days": profile}
    profile["holidays"] = draw(profiles(low, high))
    return {"kind": kind, "days": profile, "holidays": ["12-25", "2024-05-20"]}


def solids() -> Strategy[Json]:
    """Materials with constant properties."""
    return st.fixed_dictionaries(
        {
            "conductivity": numbers(0.02, 3.0),
            "density": numbers(20.0, 3000.0),
            "specific_heat": numbers(500.0, 2500.0),
        },
        optional={"source": st.just("a handbook")},
    )


def resistances() -> Strategy[Json]:
    """Layers without heat capacity."""
    return st.fixed_dictionaries({"kind": st.just("resistance"), "resistance": numbers(0.01, 1.0)})


def phase_change_materials() -> Strategy[Json]:
    """Materials that melt: described in full, or taken from the library with other values."""
    by_phase = st.sampled_from([880.0, [880.0, 770.0], {"solid": 900.0, "liquid": 800.0}])
    described = st.fixed_dictionaries(
        {
            "kind": st.just("pcm"),
            "conductivity": st.sampled_from([0.2, [0.22, 0.18]]),
            "density": by_phase,
            "specific_heat": st.sampled_from([2000.0, [2100.0, 2000.0]]),
            "latent_heat": numbers(1e5, 2.5e5),
            "melting_temperature": numbers(18.0, 30.0),
            "law": st.one_of(
                st.fixed_dictionaries({"kind": st.just("tanh"), "width": numbers(0.5, 2.0)}),
                st.fixed_dictionaries({"kind": st.just("gaussian"), "width": numbers(0.5, 2.0)}),
            ),
        }
    )
    product = st.fixed_dictionaries(
        {"product": st.sampled_from(["RT25HC", "RT21HC", "Energain"])},
        optional={"conductivity": numbers(0.1, 0.5), "density": st.just({"solid": 850.0})},
    )
    curve = st.fixed_dictionaries(
        {
            "product": st.just("RT25HC"),
            "law": st.one_of(
                st.sampled_from(["heating", "cooling"]),
                st.fixed_dictionaries(
                    {"temperature_shift": numbers(-2.0, 2.0)},
                    optional={"curve": st.sampled_from(["heating", "cooling"])},
                ),
            ),
        }
    )
    return st.one_of(described, product, curve)


_CHOICES: list[Json] = [{}, {"sky": "brunt"}, {"wind": {"terrain": "city"}}, {"diffuse": "isotropic"}]


def coefficients() -> Strategy[Any]:
    """Surface heat transfer coefficients that suit an outside and an inside."""
    return st.one_of(
        numbers(1.0, 30.0),
        st.sampled_from(["tarp", {"kind": "tarp", "factor": 1.2}]),
        st.fixed_dictionaries(
            {"kind": st.just("linear_wind"), "constant": numbers(1, 9), "wind": numbers(0, 5)}
        ),
        st.just({"kind": "power", "upward": {"b": 1.5}, "downward": {"a": 0.2, "b": 0.6, "n": 0.25}}),
    )


@st.composite
def descriptions(draw: st.DrawFn) -> Json:
    """A closed room of six sides with random materials, schedules, gains and ideal loads."""
    materials = {"base": draw(solids()), "air": draw(resistances()), "pcm": draw(phase_change_materials())}
    layers: list[Json] = [{"material": "base", "thickness": draw(numbers(0.05, 0.3))}]
    if draw(st.booleans()):
        layers.append({"material": "air"})
    if draw(st.booleans()):
        layers.append(
            {"name": "lining", "material": "pcm", "thickness": 0.01, "nodes": draw(st.integers(4, 9))}
        )
    zone: Json = {"infiltration": draw(numbers(0.0, 2.0)), "capacity_factor": draw(numbers(1.0, 5.0))}
    if draw(st.booleans()):
        zone["gains"] = {"people": {"power": draw(numbers(0, 500)), "schedule": "presence"}}
    if draw(st.booleans()):
        zone["heating"] = {"setpoint": draw(st.sampled_from([20, {"schedule": "warm"}]))}
    return {
        "name": draw(st.sampled_from(["room", "cell 3", "Zelle: Süd", "12"])),
        "site": {
            "latitude": draw(numbers(-60, 60)),
            "longitude": draw(numbers(-180, 180)),
            "altitude": draw(numbers(0, 2000)),
            "timezone": draw(st.sampled_from(["UTC", "UTC+4", "Europe/Paris"])),
            **draw(
                st.sampled_from(
                    [{}, {"sky": "brunt"}, {"wind": {"terrain": "city"}}, {"diffuse": "isotropic"}]
                )
            ),
        },
        "materials": materials,
        "constructions": {"wall": {"layers": layers}},
        "schedules": {"presence": draw(schedules()), "warm": draw(schedules("temperature"))},
        "zones": {"room": zone},
        "surfaces": {
            name: {
                "construction": "wall",
                "vertices": vertices,
                "outside": {
                    "outdoors": True,
                    "convection": draw(coefficients()),
                    "emissivity": draw(numbers(0.1, 0.95)),
                    "absorptance": draw(numbers(0.1, 0.9)),
                },
                "inside": {"zone": "room", "convection": draw(coefficients()), "emissivity": 0.9},
            }
            for name, vertices in BOX.items()
        },
    }


#: Corners of a box of 4 m by 3 m by 2.5 m, counter-clockwise seen from outside. [m]
BOX = {
    "floor": [[0, 0, 0], [0, 3, 0], [4, 3, 0], [4, 0, 0]],
    "roof": [[0, 0, 2.5], [4, 0, 2.5], [4, 3, 2.5], [0, 3, 2.5]],
    "south": [[0, 0, 0], [4, 0, 0], [4, 0, 2.5], [0, 0, 2.5]],
    "north": [[4, 3, 0], [0, 3, 0], [0, 3, 2.5], [4, 3, 2.5]],
    "west": [[0, 3, 0], [0, 0, 0], [0, 0, 2.5], [0, 3, 2.5]],
    "east": [[4, 0, 0], [4, 3, 0], [4, 3, 2.5], [4, 0, 2.5]],
}
