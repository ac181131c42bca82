from .checks.energy import EnergyLedger as EnergyLedger
from .derivatives import gradient as gradient
from .derivatives import jacobian as jacobian
from .linear_model import StateSpace as StateSpace
from .linear_model import state_space as state_space
from .preparation.engine_run import CompiledRun as CompiledRun
from .preparation.initial import MeasuredStart as MeasuredStart
from .preparation.objectives import Gradient as Gradient
from .preparation.objectives import Mean as Mean
from .preparation.objectives import SquaredResiduals as SquaredResiduals
from .preparation.options import RunOptions as RunOptions
from .preparation.run_results import Failure as Failure
from .records.provenance import Provenance as Provenance
from .results import Results as Results
from .run import simulate as simulate
from .simulation import Simulation as Simulation
from .steady import SteadyState as SteadyState
from .steady import steady as steady
from .unused_parameters import inactive_parameters as inactive_parameters

__all__: list[str]
