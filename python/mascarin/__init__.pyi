from .building import load as load
from .calibration import calibrate as calibrate
from .ensemble import sweep as sweep
from .materials.dsc import from_dsc as from_dsc
from .sensitivity import screen as screen
from .simulation.derivatives import gradient as gradient
from .simulation.derivatives import jacobian as jacobian
from .simulation.initial import MeasuredStart as MeasuredStart
from .simulation.linear_model import state_space as state_space
from .simulation.simulation import simulate as simulate
from .study import Study as Study
from .weather import Climate as Climate

__version__: str
__all__: list[str]
