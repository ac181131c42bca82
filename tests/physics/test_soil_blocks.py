"""Blocks of soil: closed solutions of finite volumes and ladders, and runs of buildings on them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.special import ellipk

import mascarin as mc
from mascarin.building import Building
from mascarin.building.soil.courses import soil_of
from mascarin.building.soil.finite_volumes import FiniteVolumes, SoilGeometry
from mascarin.building.soil.ladder import SoilLadder, ladder_of
from mascarin.errors import InputError
from mascarin.weather import CHANNELS

K, C = 1.9, 1490.0 * 1800.0
YEAR = 365.0 * 86400.0


def geometry(**changes: Any) -> SoilGeometry:
    numbers: dict[str, Any] = {
        "length": np.inf, "width": 8.0, "wall": 0.3, "basement": 0.0, "far": 15.0, "depth": 15.0,
        "conductivity": K, "capacity": C, "inside": 5.0, "outside": 20.0, "deep": True,
    }  # fmt: skip
    return SoilGeometry(**(numbers | changes))


def column(depth: float, **changes: Any) -> SoilGeometry:
    """Next to one dimension: nothing beside the floor."""
    return geometry(width=20.0, wall=1e-6, far=1e-6, depth=depth, outside=1e-6, **changes)


def admittance(ladder: SoilLadder, rate: complex, film: float = np.inf, cut: bool = False) -> complex:
    """Heat into a ladder for a degree behind a film, growing at a rate [W/(m2 K)]."""
    resistances, capacities = ladder.without_last if cut else (ladder.resistances, ladder.capacities)
    value = 0.0 + 0.0j
    impedance = complex(resistances[-1])
    for resistance, capacity in zip(resistances[-2::-1], capacities[::-1], strict=True):
        value = rate * capacity + 1.0 / impedance
        impedance = resistance + 1.0 / value
    return 1.0 / (impedance + 1.0 / film)


def test_a_strip_by_conformal_mapping() -> None:
    """A warm strip, insulated soil below its walls, cold ground: ``2 k K(a/b)/K'(a/b)`` for each metre and
    degree.

    The upper half-plane is mapped to a rectangle by an elliptic integral; a the half-width inside, b outside.
    """
    half, wall = 4.0, 0.5
    size: dict[str, Any] = {"width": 2 * half, "wall": wall, "far": 400.0, "depth": 400.0}
    block = geometry(**size, inside=1e6, outside=1e6, deep=False)
    ratio = (half / (half + wall)) ** 2
    exact = 2.0 * K * ellipk(ratio) / ellipk(1.0 - ratio)
    assert ladder_of(block).loss * block.area == pytest.approx(exact, rel=0.012)


@pytest.mark.parametrize("rate", [0.0, 1.0 / YEAR, 1e-6, 1e-5])
def test_one_dimension(rate: float) -> None:
    """A layer over a given temperature: ``k m coth(m d)`` with ``m = sqrt(rate C/k)``, behind a film."""
    ladder = ladder_of(column(3.0))
    m = np.sqrt(rate * C / K)
    layer = K / 3.0 if rate == 0.0 else K * m / np.tanh(m * 3.0)
    exact = 1.0 / (1.0 / layer + 1.0 / 5.0)
    assert admittance(ladder, rate, 5.0).real == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize(("period", "tolerance"), [(YEAR, 3e-3), (30 * 86400.0, 3e-3), (86400.0, 2e-2)])
def test_a_wave_in_a_half_space(period: float, tolerance: float) -> None:
    """A periodic zone over soil without an end: ``sqrt(i w k C)``, the ladder without its last cells."""
    ladder = ladder_of(column(60.0))
    speed = 2j * np.pi / period
    exact = 1.0 / (1.0 / np.sqrt(speed * K * C) + 1.0 / 5.0)
    assert abs(admittance(ladder, speed, 5.0, cut=True) / exact - 1.0) < tolerance


def test_the_ladder_has_the_response_of_the_finite_volumes() -> None:
    """Of a rectangle, to zone and outdoors, at rates between those that it was made for."""
    block = geometry(length=9.0)
    volumes, ladder = FiniteVolumes(block), ladder_of(block)
    shares = np.array(ladder.shares)
    for rate in (0.0, 2.0 / YEAR, 3e-6):
        field = volumes.solve(volumes.inside, rate)
        to_zone = (volumes.inside.sum() - volumes.inside @ field) / block.area
        assert admittance(ladder, rate, block.inside).real == pytest.approx(to_zone, rel=1e-5)
        resistances = np.array(ladder.resistances) + np.eye(len(ladder.resistances))[0] / block.inside
        links = 1.0 / resistances
        matrix = np.diag(links[:-1] + links[1:] + rate * np.array(ladder.capacities))
        matrix -= np.diag(links[1:-1], 1) + np.diag(links[1:-1], -1)
        from_zone = np.linalg.solve(matrix, np.eye(len(matrix))[0] * links[0])
        outdoors = volumes.outside @ field / block.area
        assert shares @ from_zone == pytest.approx(outdoors, rel=3e-3)


def test_all_resistances_and_capacities_are_positive() -> None:
    for block in (geometry(), geometry(length=9.0, basement=2.0), geometry(vertical=(1.0, 2.0))):
        ladder = ladder_of(block)
        assert min(ladder.resistances) > 0.0
        assert min(ladder.capacities) > 0.0


def test_insulation_and_basement() -> None:
    """Edge insulation keeps heat in, more of it more. A basement by ISO 13370:2017, 7.4.4, within 3 %."""
    bare, thin, thick = (
        ladder_of(geometry(horizontal=(1.0, resistance))).loss for resistance in (0.0, 0.5, 3.0)
    )
    assert thick < thin < bare
    vertical = [ladder_of(geometry(vertical=(depth, 2.0))).loss for depth in (0.5, 1.5)]
    assert vertical[1] < vertical[0] < bare
    deep, size, films = 2.5, 8.0, 1.0 / 5.0 + 1.0 / 20.0
    floor, walls = 0.3 + K * films, K * films
    thick = floor + 0.5 * deep
    u_floor = 2.0 * K / (np.pi * size + thick) * np.log(np.pi * size / thick + 1.0)
    u_walls = 2.0 * K / (np.pi * deep) * (1.0 + 0.5 * walls / (walls + deep)) * np.log(deep / walls + 1.0)
    mean = (size * u_floor + 2.0 * deep * u_walls) / (size + 2.0 * deep)
    assert ladder_of(geometry(basement=deep)).loss == pytest.approx(mean, rel=0.03)


def test_floor_and_walls_of_a_basement_alone() -> None:
    """A floor with soil below it alone, in one dimension; walls by their perimeter; both lose less than the
    sum of each alone.
    """
    floor = column(12.0, basement=3.0, contact="floor")
    assert ladder_of(floor).loss == pytest.approx(1.0 / (1.0 / 5.0 + 9.0 / K), rel=1e-6)
    strip = geometry(width=30.0, basement=2.0, contact="walls")
    square = geometry(width=30.0, length=30.0, basement=2.0, contact="walls")
    assert (strip.area, square.area) == (4.0, 240.0)
    assert ladder_of(square).loss == pytest.approx(ladder_of(strip).loss, rel=0.03)
    blocks = {name: geometry(basement=2.0, contact=name) for name in ("both", "floor", "walls")}
    heat = {name: ladder_of(block).loss * block.area for name, block in blocks.items()}
    assert max(heat["floor"], heat["walls"]) < heat["both"] < heat["floor"] + heat["walls"]


# --- buildings ----------------------------------------------------------------------------------------------


def tree(**changes: Any) -> dict[str, Any]:
    block: dict[str, Any] = {
        "width": 8.0, "wall_thickness": 0.3, "conductivity": K, "heat_capacity": C, "inside_film": 5.0,
        "outdoor_film": 20.0, "deep_temperature": 10.0, "before": {"mean": 10.0},
    }  # fmt: skip
    floor = {
        "construction": "floor", "area": 64.0, "tilt": 180, "outside": {"soil": "below"},
        "inside": {"zone": "room", "convection": 5.0, "emissivity": 0.9},
    }  # fmt: skip
    return {
        "name": "on soil",
        "site": {"latitude": 48, "longitude": 2, "altitude": 0, "timezone": "UTC+1"},
        "materials": {"concrete": {"conductivity": 2.0, "density": 2300, "specific_heat": 900}},
        "constructions": {"floor": {"layers": [{"material": "concrete", "thickness": 0.1}]}},
        "zones": {"room": {"volume": 160.0, "longwave": "none", "infiltration": 0.5}},
        "soil_blocks": {"below": block | changes},
        "surfaces": {"floor": floor},
    }


def building(**changes: Any) -> Building:
    return Building.from_dict(tree(**changes))


def climate(air: Any) -> mc.Climate:
    index = pd.date_range("2001-01-01", periods=len(air), freq="1h", tz="Etc/GMT-1")
    absent = ["radiation", "dew_point", "wind_speed", "wind_direction"]
    table = pd.DataFrame({"T": air}, index=index)
    return mc.Climate.from_table(table, columns={"air_temperature": "T"}, absent=absent)


def held(description: dict[str, Any], temperature: float = 20.0) -> dict[str, Any]:
    description["zones"]["room"] = {"volume": 160.0, "longwave": "none", "held": temperature}
    return description


def test_steady_heat_of_a_building() -> None:
    """The heat of a held zone is that of the finite volumes, film and concrete included."""
    house = Building.from_dict(held(tree(before={"mean": 4.0})))
    state = mc.steady(house, climate(np.full(48, 4.0)), outputs=["room.net_load"], step="1h")
    soil = soil_of(house, "floor")
    assert soil is not None
    ladder = soil.ladder
    to_outdoors = ladder.loss - ladder.loss_to_deep
    expected = 64.0 * (ladder.loss_to_deep * (20.0 - 10.0) + to_outdoors * (20.0 - 4.0))
    assert state["room.net_load"] == pytest.approx(expected, rel=1e-5)


def test_uniform_temperature_stays() -> None:
    """Everything as warm as the deep soil: no heat flows."""
    house = Building.from_dict(held(tree(), 10.0))
    result = mc.simulate(house, climate(np.full(96, 10.0)), step="1h", outputs=["room.net_load"])
    assert result.to_dataframe().abs().max().item() < 1e-4


FLOORS: dict[str, list[tuple[str, float]]] = {
    "concrete": [("concrete", 0.1)],
    "insulation below": [("insulation", 0.1), ("concrete", 0.15)],
    "insulation above": [("concrete", 0.15), ("insulation", 0.1)],
    "screed": [("concrete", 0.2), ("insulation", 0.1), ("screed", 0.06)],
    "foundation": [("concrete", 0.6), ("insulation", 0.2), ("wood", 0.02)],
}
"""Layers of floors from the soil to the room, with their thickness [m]."""


FREE_ERRORS = {
    "concrete": 0.003,
    "insulation below": 0.04,
    "insulation above": 0.005,
    "screed": 0.02,
    "foundation": 0.001,
}
"""Largest error of the air of a free room [K].

It follows its floor in days, and a repeated day changes it by less than 0.01 K before it has come to the end.
"""


@pytest.mark.parametrize("layers", list(FLOORS))
@pytest.mark.parametrize(("heated", "deep"), [(False, 10.0), (True, 10.0), (True, None)])
def test_the_start_of_weather_that_does_not_change(layers: str, heated: bool, deep: float | None) -> None:
    """Repeated days end, after a few, in the steady state: years of slow soil are not waited for, and a heavy
    layer between soil and insulation goes with the soil.
    """
    description = tree(before={"mean": 4.0}, deep_temperature=deep)
    if deep is None:
        del description["soil_blocks"]["below"]["deep_temperature"]
    description["materials"] |= {
        "insulation": {"conductivity": 0.035, "density": 30, "specific_heat": 1400},
        "screed": {"conductivity": 1.4, "density": 2000, "specific_heat": 1000},
        "wood": {"conductivity": 0.13, "density": 500, "specific_heat": 1600},
    }
    description["constructions"]["floor"]["layers"] = [
        {"material": material, "thickness": thickness} for material, thickness in FLOORS[layers]
    ]
    output = "room.air_temperature"
    if heated:
        description["zones"]["room"]["heating"] = {"setpoint": 20.0}
        output = "room.net_load"
    house, weather = Building.from_dict(description), climate(np.full(48, 4.0))
    result = mc.simulate(house, weather, step="1h", outputs=[output])
    steady = mc.steady(house, weather, outputs=[output], step="1h")[output]
    values = result.to_dataframe()[output].to_numpy()
    assert np.abs(values - steady).max() < (0.5 if heated else FREE_ERRORS[layers])
    assert steady > (550.0 if heated else 4.3)
    repetitions = re.search(r"repeated (\d+) times", result.provenance.start)
    assert repetitions is not None
    assert int(repetitions[1]) < 15


MATERIALS: dict[str, tuple[float, float, float]] = {
    "concrete": (2.0, 2300, 900),
    "insulation": (0.035, 30, 1400),
    "screed": (1.4, 2000, 1000),
    "stone": (3.0, 2700, 850),
    "wood": (0.13, 500, 1600),
}
"""Conductivity [W/(m K)], density [kg/m3], specific heat [J/(kg K)]."""


@pytest.mark.parametrize("seed", range(20))
def test_any_floor_on_soil_begins_as_it_goes_on(seed: int) -> None:
    """Layers of any order and thickness: repeated days converge, and the first day ends as it began."""
    rng = np.random.default_rng(seed)
    description = tree(before={"mean": 6.0}, conductivity=rng.choice([0.5, 1.5, 3.5]))
    description["materials"] = {
        name: dict(zip(("conductivity", "density", "specific_heat"), numbers, strict=True))
        for name, numbers in MATERIALS.items()
    }
    description["constructions"]["floor"]["layers"] = [
        {
            "name": f"layer_{k}",
            "material": str(rng.choice(list(MATERIALS))),
            "thickness": 10 ** rng.uniform(-2, -0.2),
        }
        for k in range(rng.integers(1, 6))
    ]
    room = description["zones"]["room"]
    room["infiltration"] = rng.choice([0.5, 3.0])
    if rng.random() < 0.5:
        room["heating"] = {"setpoint": 20.0}
    swing = 6.0 + 5.0 * np.sin(2.0 * np.pi * np.arange(72) / 24.0)
    outputs = ["room.air_temperature", "floor.inside_temperature"]
    run = mc.simulate(Building.from_dict(description), climate(swing), step="1h", outputs=outputs)
    repetitions = re.search(r"repeated (\d+) times", run.provenance.start)
    assert repetitions is not None
    assert int(repetitions[1]) <= 60
    values = run.to_dataframe().to_numpy()
    assert np.abs(values[24] - values[0]).max() < 0.02


def test_the_outdoor_year() -> None:
    """Amplitude and delay of the heat by a yearly swing outdoors are those of the finite volumes."""
    from scipy.sparse import diags
    from scipy.sparse.linalg import spsolve

    speed = 2.0 * np.pi / YEAR
    hours = np.arange(1, 8760 + 25)
    year = climate(10.0 - 8.0 * np.cos(speed * 3600.0 * hours))
    house = Building.from_dict(held(tree(before=None)))
    result = mc.simulate(house, year, step="1h", outputs=["room.net_load"], end="2002-01-01")
    load = result.to_dataframe()["room.net_load"].to_numpy()[-8760:]
    soil = soil_of(house, "floor")
    assert soil is not None
    volumes = FiniteVolumes(soil.geometry)
    matrix = diags(1j * speed * volumes.capacities).tocsc() + volumes.matrix.tocsc()
    through = volumes.inside @ spsolve(matrix, volumes.outside.astype(complex)) / volumes.block.area
    steady = volumes.inside.sum() - volumes.inside @ volumes.solve(volumes.inside)
    angle = speed * 3600.0 * np.arange(8760)
    exact = 64.0 * (10.0 * steady / volumes.block.area + 8.0 * np.real(through * np.exp(1j * angle)))
    # The start is that of a zone held for ever within some hundredths of a kelvin of the soil: 1.8 W.
    assert np.abs(load - exact).max() < 0.02 * 64.0 * 8.0 * abs(through)
    assert result.energy.relative_residual < 1e-10


def test_a_layered_floor_in_one_dimension() -> None:
    """Wide soil is the layered floor that the engine has: a step of the zone over a month."""
    numbers: dict[str, Any] = {
        "width": 500.0,
        "wall_thickness": 0.05,
        "outdoor_film": 0.5,
        "far": 1.0,
        "depth": 2.0,
    }
    on_block = Building.from_dict(held(tree(**numbers)))
    plain = held(tree())
    plain["materials"]["soil"] = {"conductivity": K, "density": 1490, "specific_heat": 1800}
    plain["constructions"]["floor"]["layers"].insert(0, {"material": "soil", "thickness": 2.0})
    plain["surfaces"]["floor"]["outside"] = {"ground": {"mean": 10.0}}
    del plain["soil_blocks"]
    weather = climate(np.full(24 * 30, 10.0))
    options: Any = {"step": "1h", "outputs": ["room.net_load"], "initial": 10.0}
    by_block, by_layers = (
        mc.simulate(each, weather, **options).to_dataframe()["room.net_load"].to_numpy()[24:]
        for each in (on_block, Building.from_dict(plain))
    )
    assert np.abs(by_block / by_layers - 1.0).max() < 0.02
    assert abs(by_block[-1] / by_layers[-1] - 1.0) < 0.01


@pytest.mark.parametrize(
    ("path", "step", "tolerance"),
    [
        ("zones.room.infiltration.constant", 1e-3, 1e-5),
        # The block is reduced again for another construction, whose derivative it does not have.
        ("materials.concrete.conductivity", 1e-2, 0.05),
    ],
)
def test_derivatives(path: str, step: float, tolerance: float) -> None:
    """Slopes by other parameters are those of two runs."""
    house = building()
    weather = climate(10.0 + 5.0 * np.sin(2 * np.pi * np.arange(96) / 24.0))
    options: Any = {"step": "1h", "outputs": ["room.air_temperature"], "initial": 15.0}
    slopes = mc.jacobian(house, weather, vary=[path], **options)
    value = house.parameter(path).value
    ends = [
        mc.simulate(house, weather, parameters={path: other}, **options).to_dataframe().to_numpy()[-1, 0]
        for other in (value - step, value + step)
    ]
    derivatives = next(variable for variable in slopes.data_vars.values() if "parameter" in variable.dims)
    slope = float(derivatives.isel(parameter=0, time=-1).squeeze())
    assert slope == pytest.approx((ends[1] - ends[0]) / (2.0 * step), rel=tolerance, abs=1e-4)


def test_members_are_runs() -> None:
    """Eight members in lanes have the air of a run each."""
    house = building()
    weather = climate(10.0 + 5.0 * np.sin(2 * np.pi * np.arange(48) / 24.0))
    options: Any = {"step": "1h", "outputs": ["room.air_temperature"], "initial": 15.0}
    path = "zones.room.infiltration.constant"
    values = np.linspace(0.2, 1.6, 8)
    members = mc.sweep(house, weather, {path: values}, **options)
    air = next(variable for variable in members.data_vars.values() if "time" in variable.dims)
    for value, member in zip(values, np.asarray(air).reshape(-1, air.sizes["time"]), strict=True):
        alone = mc.simulate(house, weather, parameters={path: float(value)}, **options)
        assert member[-1] == pytest.approx(alone.to_dataframe().to_numpy()[-1, 0], abs=1e-9)


def test_the_linear_model_marches_as_a_run() -> None:
    """Both from 15 degC: matrices with the heat of the outdoor air as inputs, and a run."""
    from scipy.signal import cont2discrete

    house = building()
    weather = climate(10.0 + 5.0 * np.sin(2 * np.pi * np.arange(97) / 24.0))
    run = mc.Simulation(house, weather, step="15min", outputs=["room.air_temperature"], initial=15.0)
    air = run.run().to_dataframe()["room.air_temperature"].to_numpy()
    model = mc.state_space(house)
    channels = [*CHANNELS, *house.to_engine(900.0, {}).channels]
    names = {"outdoor_air_temperature": "air_temperature"}
    inputs = run.compiled.forcing[:, :, [channels.index(names.get(name, name)) for name in model.inputs]]
    assert {"schedule soil below cell 1", "schedule soil below cell 2"} <= set(model.inputs)
    assert {"floor.soil_1_temperature", "floor.soil_2_temperature"} < set(model.states)
    # Means of the inputs over each step, as the scheme weighs its stages.
    first = np.sqrt(0.5)
    means = first * inputs[:, 0] + (1.0 - first) * inputs[:, 1]
    matrix, drive, *_ = cont2discrete((model.a, model.b, model.c, model.d), 900.0)
    state, marched = np.full(len(model.states), 15.0), []
    for mean in means:
        state = matrix @ state + drive @ mean
        marched.append(state[-1])
    assert np.abs(np.array(marched) - air[-len(marched) :])[24:].max() < 0.01


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda t: t["soil_blocks"]["below"].update(length=9.0), "72 m2 within 1 %: floor of block 'below'"),
        (lambda t: t["surfaces"].update(other=dict(t["surfaces"]["floor"])), "one surface on a block"),
        (
            lambda t: t["surfaces"]["floor"].update(outside={"soil": "under"}),
            "a block of soil under 'soil_blocks:'",
        ),
        (lambda t: t["soil_blocks"].update(more=dict(t["soil_blocks"]["below"])), "no surface is on"),
        (lambda t: t["soil_blocks"]["below"].update(basement_depth=14.0), "a floor that is on the block"),
        (
            lambda t: t["soil_blocks"]["below"].update(contact="walls"),
            "a basement, whose walls touch the soil",
        ),
        (
            lambda t: t.update(weather={"columns": {"air_temperature": {"offset": 1.0}}}),
            "a corrected air temperature beside a block of soil",
        ),
        (
            lambda t: t["surfaces"]["floor"].update(outside={"soil": "below", "convection": 8}),
            "'convection' on a side facing soil",
        ),
    ],
)
def test_what_does_not_fit_is_named(change: Callable[[dict[str, Any]], None], words: str) -> None:
    description = tree()
    change(description)
    with pytest.raises(InputError, match=words):
        Building.from_dict(description)


def test_floors_that_overlap() -> None:
    description = tree(length=8.0)
    square = [[0, 0, 0], [0, 8, 0], [8, 8, 0], [8, 0, 0]]
    floor = description["surfaces"]["floor"]
    del floor["area"], floor["tilt"]
    floor["vertices"] = square
    description["zones"]["next"] = dict(description["zones"]["room"])
    moved = [[x + 6, y, z] for x, y, z in square]
    inside = floor["inside"] | {"zone": "next"}
    description["surfaces"]["second"] = floor | {
        "vertices": moved,
        "inside": inside,
        "outside": {"soil": "beside"},
    }
    description["soil_blocks"]["beside"] = dict(description["soil_blocks"]["below"])
    with pytest.raises(InputError, match="a floor that overlaps that of block 'below' in plan"):
        Building.from_dict(description)


def test_a_short_weather_needs_what_was_before() -> None:
    with pytest.raises(InputError, match=r"soil_blocks.below.before: found 2 days of weather"):
        mc.simulate(building(before=None), climate(np.full(48, 5.0)), step="1h")


def test_numbers_of_a_block_do_not_vary_in_a_compiled_run() -> None:
    parameter = building().parameter("soil_blocks.below.conductivity")
    assert parameter.structural
    assert "reduced once" in (parameter.reason or "")
    with pytest.raises(InputError, match="reduced once"):
        mc.jacobian(building(), climate(np.full(48, 5.0)), vary=["soil_blocks.below.conductivity"], step="1h")


# --- sun and sky on the ground ------------------------------------------------------------------------------


def sunny_climate(air: Any, sun: Any, infrared: Any) -> mc.Climate:
    index = pd.date_range("2001-01-01", periods=len(air), freq="1h", tz="Etc/GMT-1")
    absent = ["dew_point", "wind_speed", "wind_direction"]
    table = pd.DataFrame({"T": air, "G": sun, "D": sun, "B": np.zeros(len(sun)), "L": infrared}, index=index)
    columns = {
        "air_temperature": "T",
        "global_horizontal": "G",
        "diffuse_horizontal": "D",
        "direct_normal": "B",
        "infrared": "L",
    }
    return mc.Climate.from_table(table, columns=columns, absent=absent)


def test_sun_and_sky_on_the_ground_act_as_warmer_air() -> None:
    """Sol-air temperature, typed here: T + (a G + e (L - sigma T^4))/h. The mean of a year and its course."""
    hours = np.arange(8760)
    swing = -np.cos(2.0 * np.pi * hours / 8760.0)
    air = 8.0 + 10.0 * swing + 3.0 * np.sin(2.0 * np.pi * hours / 24.0)
    sun = np.where((hours % 24 >= 11) & (hours % 24 < 14), 300.0 + 200.0 * swing, 0.0)
    infrared = 290.0 + 50.0 * swing
    # The film of the block is 20; air at the end of an hour, radiation as the mean of it.
    excess = (0.7 * sun + 0.95 * (infrared - 5.670374419e-8 * (air + 273.15) ** 4)) / 20.0
    assert abs(excess.mean()) > 1.0
    house = Building.from_dict(held(tree(before=None, absorptance=0.7, emissivity=0.95)))
    plain = Building.from_dict(held(tree(before=None)))
    loads = [
        mc.simulate(case, weather, step="1h", outputs=["room.net_load"]).to_dataframe()["room.net_load"]
        for case, weather in (
            (house, sunny_climate(air, sun, infrared)),
            (plain, climate(air + excess)),
            (plain, climate(air)),
        )
    ]
    assert (loads[0] - loads[1]).abs().max() < 0.02 * (loads[0] - loads[2]).abs().max()
    assert loads[0].mean() == pytest.approx(loads[1].mean(), abs=1e-3 * abs(loads[2].mean()))


def test_sun_on_the_ground_from_its_parts() -> None:
    """A weather with the diffuse and the direct sun in place of the global one: the same loads."""
    hours = np.arange(8760)
    air = 8.0 - 10.0 * np.cos(2.0 * np.pi * hours / 8760.0)
    sun = np.where((hours % 24 >= 11) & (hours % 24 < 14), 300.0, 0.0)
    whole = sunny_climate(air, sun, np.full(8760, 300.0))
    house = Building.from_dict(held(tree(before=None, absorptance=0.7)))
    parts = whole.data.rename(columns={"air_temperature": "T"})[
        ["T", "diffuse_horizontal", "direct_normal", "infrared"]
    ]
    columns = {"air_temperature": "T"} | {name: name for name in parts.columns[1:]}
    absent = ["dew_point", "wind_speed", "wind_direction"]
    alone = mc.Climate.from_table(parts, columns=columns, absent=absent)
    assert "global_horizontal" not in alone.record.columns
    loads = [
        mc.simulate(house, weather, step="1h", outputs=["room.net_load"]).to_dataframe()["room.net_load"]
        for weather in (whole, alone)
    ]
    assert (loads[0] - loads[1]).abs().max() < 1e-9 * loads[0].abs().max()


def test_what_sun_on_the_ground_needs() -> None:
    description = tree(absorptance=0.8)
    description["weather"] = {"columns": {"infrared": {"offset": 5.0}}}
    with pytest.raises(InputError, match="a corrected infrared beside a block of soil"):
        Building.from_dict(description)
    with pytest.raises(InputError, match="absorptance"):
        building(absorptance=1.2)
    assert building(absorptance=0.8).soil_blocks["below"].radiation == (0.8, 0.9, 20.0)
    assert building().soil_blocks["below"].radiation is None


def test_floors_beside_each_other_that_are_no_rectangles() -> None:
    """Bounding boxes of two trapezoids overlap, the floors do not."""
    description = tree()
    floor = description["surfaces"]["floor"]
    del floor["area"], floor["tilt"]
    floor["vertices"] = [[0, 0, 0], [2, 2, 0], [8, 2, 0], [10, 0, 0]]
    description["zones"]["next"] = dict(description["zones"]["room"])
    description["surfaces"]["second"] = floor | {
        "vertices": [[0, 0, 0], [0, 10, 0], [2, 8, 0], [2, 2, 0]],
        "inside": floor["inside"] | {"zone": "next"},
        "outside": {"soil": "beside"},
    }
    description["soil_blocks"]["beside"] = dict(description["soil_blocks"]["below"])
    assert len(Building.from_dict(description).soil_blocks) == 2


def test_a_year_as_the_first_period_is_repeated_until_it_stays() -> None:
    """Soil that is moved between repetitions comes back to the same end of a year: no circle, but the end."""
    hours = np.arange(8760)
    year = climate(8.0 - 10.0 * np.cos(2.0 * np.pi * hours / 8760.0))
    house = building(before=None, deep_temperature=10.0)
    run = mc.simulate(house, year, step="2h", outputs=["room.air_temperature"], first_period="365d")
    repetitions = re.search(r"repeated (\d+) times", run.provenance.start)
    assert repetitions is not None
    assert int(repetitions[1]) <= 5
    air = run.to_dataframe()["room.air_temperature"].to_numpy()
    assert air[0] == pytest.approx(air[-1], abs=0.02)


def test_sun_on_the_ground_without_the_sky_is_refused() -> None:
    year = climate(np.full(8760, 5.0))
    with pytest.raises(InputError, match="no infrared radiation of the sky in all hours"):
        mc.simulate(building(before=None, absorptance=0.8), year, step="1h")
