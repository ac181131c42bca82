"""Compiled part of mascarin: the engine behind numpy arrays."""

from collections.abc import Callable
from typing import Any, Final, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "AIR_GAS_CONSTANT",
    "AIR_SPECIFIC_HEAT",
    "CLIMATE_CHANNELS",
    "GRAVITY",
    "KELVIN",
    "LATENT_HEAT",
    "SEA_LEVEL_PRESSURE",
    "STEFAN_BOLTZMANN",
    "VAPOUR_GAS_CONSTANT",
    "VAPOUR_SPECIFIC_HEAT",
    "EngineDefect",
    "EngineInputError",
    "EngineSolverError",
    "Plan",
    "Trajectory",
    "_panic",
    "check_derived",
    "check_formula",
    "check_fraction",
    "check_function",
    "condensing_pressure",
    "dew_point",
    "fmu_library",
    "formula_values",
    "fraction_values",
    "function_values",
    "globe_temperature",
    "humidity_ratio",
    "imposed",
    "interrupt",
    "law_table",
    "leakage_air_changes",
    "liquid_fraction",
    "melting_reach",
    "moist_air",
    "output_table",
    "saturation_pressure",
    "standard_density",
    "standard_pressure",
    "vapour_pressure",
    "wet_bulb",
]

_Array = npt.NDArray[np.float64]

CLIMATE_CHANNELS: Final[int]
"""Number of climate channels at the head of every forcing row."""

STEFAN_BOLTZMANN: Final[float]
"""Stefan-Boltzmann constant [W/(m2 K4)]."""
KELVIN: Final[float]
"""0 degC [K]."""
GRAVITY: Final[float]
"""Standard gravity [m/s2]."""
AIR_GAS_CONSTANT: Final[float]
"""Gas constant of dry air [J/(kg K)]."""
AIR_SPECIFIC_HEAT: Final[float]
"""Specific heat of dry air [J/(kg K)]."""
VAPOUR_SPECIFIC_HEAT: Final[float]
"""Specific heat of water vapour [J/(kg K)]."""
VAPOUR_GAS_CONSTANT: Final[float]
"""Gas constant of water vapour [J/(kg K)]."""
LATENT_HEAT: Final[float]
"""Latent heat of vapour in the air of rooms [J/kg]."""
SEA_LEVEL_PRESSURE: Final[float]
"""Pressure of the standard atmosphere at sea level [Pa]."""

class EngineInputError(Exception):
    """Arrays, options or descriptions the engine refuses."""

class EngineSolverError(Exception):
    """A step or a warm-up that did not converge."""

class EngineDefect(Exception):
    """An internal error of the engine (a panic)."""

def interrupt() -> None:
    """Stop all calls that are running now, on whatever thread, with KeyboardInterrupt."""

def fmu_library() -> tuple[bytes, str, str, str]:
    """The library of an FMU: bytes, ending, and the architecture and system it is for."""

def saturation_pressure(temperature: _Array) -> _Array:
    """Saturation pressure over water, also below 0 degC, at temperatures [degC]: [Pa]."""

def condensing_pressure(temperature: _Array) -> _Array:
    """Pressure from which vapour condenses at temperatures [degC]: over ice below 0.01 degC [Pa]."""

def humidity_ratio(vapour: _Array, pressure: _Array) -> _Array:
    """Humidity ratios at pressures of vapour and of the air [Pa]: [kg/kg]."""

def vapour_pressure(ratio: _Array, pressure: _Array) -> _Array:
    """Vapour pressures at humidity ratios [kg/kg] and pressures of the air [Pa]: [Pa]."""

def dew_point(vapour: _Array) -> _Array:
    """Dew points of vapour pressures [Pa]: over water, also below 0 degC [degC]."""

def wet_bulb(temperature: _Array, ratio: _Array, pressure: _Array) -> _Array:
    """Wet-bulb temperatures [degC] at temperatures [degC], humidity ratios [kg/kg] and pressures [Pa]."""

def globe_temperature(air: _Array, radiant: _Array, diameter: _Array, emissivity: _Array) -> _Array:
    """Globe temperatures [degC] at air and mean radiant temperatures, by diameter [m] and emissivity."""

def standard_pressure(altitude: _Array) -> _Array:
    """Pressures of the standard atmosphere at altitudes [m]: [Pa]."""

def standard_density(altitude: float) -> float:
    """Density of dry air of 15 degC at an altitude [m]: [kg/m3]."""

def moist_air(temperature: float, humidity: float, pressure: float) -> tuple[float, float]:
    """Density [kg/m3] and specific heat [J/(kg K)] at [degC], humidity [-] and [Pa]."""

def liquid_fraction(curve: str, values: _Array, temperature: _Array) -> _Array:
    """Liquid fractions of a melting curve (JSON; its parameters are positions in `values`) [-]."""

def melting_reach(curve: str, values: _Array) -> tuple[float, float]:
    """Temperatures where melting starts and is complete, without tails [degC]."""

def imposed(
    kind: str, numbers: list[tuple[str, float]], day: float, outdoor_air: float
) -> tuple[float, float | None, float | None]:
    """Temperature of a law of what a side is in contact with. [degC]"""

def leakage_air_changes(kind: str, numbers: list[tuple[str, float]], wind: float, difference: float) -> float:
    """Air changes of a law of infiltration by a pressure test. [1/h]"""

def law_table() -> str:
    """The table of published laws, JSON lists of rows by what they are laws of."""

def output_table() -> str:
    """The table of outputs, a JSON list of rows."""

def check_formula(
    formula: str,
    valid: str | None,
    given: list[tuple[str, float, tuple[float, float] | None, str | None]],
    side: tuple[tuple[bool, bool, bool], tuple[float, float, float, float | None]],
) -> tuple[str, int, int, str, str, str] | None:
    """Key, line, column, found, expected, remedy of the first fault of a coefficient as text; None: a law."""

def check_fraction(
    formula: str,
    given: list[tuple[str, float, None, str | None]],
    melting_temperature: float,
    range: tuple[float, float],
) -> tuple[str, int, int, str, str, str] | None:
    """First fault of a curve of the liquid fraction as text, as `check_formula` has it; None: a curve."""

def fraction_values(
    formula: str,
    given: list[tuple[str, float, None, str | None]],
    melting_temperature: float,
    range: tuple[float, float],
    temperatures: _Array,
) -> _Array:
    """Liquid fractions of a curve as text at temperatures [degC]: [-]."""

def check_function(
    kind: str,
    formula: str,
    valid: str | None,
    given: list[tuple[str, float, tuple[float, float] | None, str | None]],
) -> tuple[str, int, int, str, str, str] | None:
    """First fault of a conductivity, infiltration or sky as text, as `check_formula` has it; None: a law."""

def check_derived(
    formula: str,
    outputs: list[tuple[str, str]],
    given: list[tuple[str, float, tuple[float, float] | None, str | None]],
    unit: str | None,
    absent: list[tuple[str, str]],
) -> tuple[str, int, int, str, str, str] | None:
    """First fault of a derived output, as `check_formula` has it; None: there is none."""

def function_values(
    kind: str,
    formula: str,
    given: list[tuple[str, float, tuple[float, float] | None, str | None]],
    points: list[_Array],
) -> _Array:
    """Values of such a law, as written; points: the values of each name that changes."""

def formula_values(
    formula: str,
    given: list[tuple[str, float, tuple[float, float] | None, str | None]],
    side: tuple[float, float, float, float | None],
    points: list[_Array],
) -> _Array:
    """Coefficients of a law as text, as written [W/(m2 K)].

    Points: differences [K], winds [m/s], airs [degC], angles [deg], irradiances [W/m2] and air changes [1/h].
    """

def _panic(message: str, border: bool = False) -> None:
    """Panic on purpose, in the engine or at its border, to test how an internal error is handled."""

@final
class Plan:
    """A building compiled for the engine."""

    def __new__(cls, description: str) -> Plan:
        """Compile a description (JSON)."""

    @property
    def n_parameters(self) -> int:
        """Length of a parameter vector."""

    @property
    def n_channels(self) -> int:
        """Channels a forcing must have."""

    @property
    def n_cells(self) -> int:
        """Finite volumes in all walls."""

    @property
    def stage_bytes(self) -> int:
        """Memory of the weather of one stage, which an ensemble keeps for all members [B]."""

    def window_ratings(self, values: _Array) -> _Array:
        """Windows x (U value [W/(m2 K)], solar heat gain, normal and hemispherical transmittance [-])."""

    def simulate_into(
        self,
        values: _Array,
        forcing: _Array,
        options: dict[str, Any],
        rows: int,
        take: Callable[[_Array], object],
        report: Callable[[int], object] | None = None,
        steps: int | None = None,
        further: Callable[[], _Array | None] | None = None,
    ) -> dict[str, Any]:
        """One run: ledger [J] and counters; the entry `records` is empty.

        `take` gets the records (rows x outputs) in blocks of `rows` rows while the run goes on: the engine
        goes on while `take` works, by one block at most. What `take` raises ends the run and is raised.
        `report` gets the number of steps done. `forcing` may be the first block of `steps` steps: `further`
        then gives the next ones, None after the last, each while the engine goes through the block before. A
        repeated first period lies within the first block.

        `largest_change` is the largest change of a temperature in the last iteration of an accepted stage.
        [K] `largest_residual` is the largest residual of a heat balance in an accepted stage, all laws
        evaluated there; None unless `options["residuals"]` is true, with which a run takes longer. [W]
        `outside` is how far temperatures are outside of their causes, beyond the scheme's overshoot [K], and
        `outlier` the step, place, temperature and bound of the first of them, or None. [degC]
        """

    def ensemble(
        self,
        values: _Array,
        forcing: _Array,
        options: dict[str, Any],
        report: Callable[[int], object] | None = None,
        single: bool = False,
    ) -> tuple[_Array, tuple[_Array, _Array, _Array], list[tuple[int, str]]]:
        """Members (rows of values): records (members, rows, outputs); closures, distances, counts; failures.

        A distance is how far temperatures are outside of their causes, beyond the scheme's overshoot [K]; a
        count is of the steps in which a law written as text did not hold.

        `single`: in single precision; members whose energy balance does not close are run in double.
        """

    def jacobian(
        self,
        values: _Array,
        directions: list[list[tuple[int, float]]],
        forcing: _Array,
        options: dict[str, Any],
        report: Callable[[int], object] | None = None,
    ) -> tuple[_Array, _Array]:
        """Records (rows x outputs) and their slopes (directions x rows x outputs).

        A direction names parameters that change together, and how much each changes.
        """

    def choose_steps(
        self,
        values: _Array,
        forcings: list[_Array],
        options: dict[str, Any],
        tolerance: float,
        most_halvings: int,
    ) -> tuple[npt.NDArray[np.uint8], _Array]:
        """How often the record interval is halved for each step, and the estimated error of each. [K]

        `forcings` has the weather in steps of the record interval, of half of it, and so on.
        """

    def state_space(self, values: _Array) -> dict[str, Any]:
        """Matrices a, b, c, d and names of states, inputs and outputs of a linear building."""

@final
class Trajectory:
    """A run with the stored states that its derivatives in reverse mode need."""

    def __new__(
        cls, plan: Plan, values: _Array, forcing: _Array, options: dict[str, Any], memory: int
    ) -> Trajectory:
        """A run that keeps about `memory` bytes."""

    def run(self) -> dict[str, Any]:
        """The result of `Plan.simulate_into`, with the records."""

    def pull(self, weights: _Array) -> _Array:
        """Slopes by all parameters of the sum of weights (rows x outputs) times records."""
