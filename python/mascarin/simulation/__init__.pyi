from .compiled import CompiledRun as CompiledRun
from .compiled import Failure as Failure
from .derivatives import gradient as gradient
from .derivatives import jacobian as jacobian
from .energy import EnergyLedger as EnergyLedger
from .inactive import inactive_parameters as inactive_parameters
from .initial import MeasuredStart as MeasuredStart
from .linear_model import StateSpace as StateSpace
from .linear_model import state_space as state_space
from .objectives import Gradient as Gradient
from .objectives import Mean as Mean
from .objectives import SquaredResiduals as SquaredResiduals
from .options import RunOptions as RunOptions
from .provenance import Provenance as Provenance
from .results import Results as Results
from .run import simulate as simulate
from .simulation import Simulation as Simulation

__all__: list[str]
