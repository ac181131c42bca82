from . import building as building
from . import calibration as calibration
from . import comfort as comfort
from . import ensemble as ensemble
from . import materials as materials
from . import optimization as optimization
from . import physics as physics
from . import sensitivity as sensitivity
from . import simulation as simulation
from . import validation as validation
from . import weather as weather
from .building import Building as Building
from .building import load as load
from .calibration import Calibration as Calibration
from .calibration import calibrate as calibrate
from .ensemble import sweep as sweep
from .errors import InputError as InputError
from .errors import MascarinError as MascarinError
from .errors import SolverError as SolverError
from .materials.dsc import from_dsc as from_dsc
from .pages.live import live_page as live_page
from .sensitivity import Sensitivity as Sensitivity
from .sensitivity import sensitivity_analysis as sensitivity_analysis
from .simulation.derivatives import gradient as gradient
from .simulation.derivatives import jacobian as jacobian
from .simulation.linear_model import state_space as state_space
from .simulation.preparation.initial import MeasuredStart as MeasuredStart
from .simulation.results import Results as Results
from .simulation.run import simulate as simulate
from .simulation.simulation import Simulation as Simulation
from .study import Study as Study
from .templates import new_room as new_room
from .weather import Climate as Climate
from .weather import Measurements as Measurements

__version__: str
__all__: list[str]
