from .building_calibration import calibrate as calibrate
from .building_problem import fit_parameter as fit_parameter
from .cost import Cost as Cost
from .evaluations import Evaluator as Evaluator
from .evaluations import Trace as Trace
from .problem import CalibrationProblem as CalibrationProblem
from .problem import FitParameter as FitParameter
from .problem import FitSensor as FitSensor
from .problem import require_known as require_known
from .profile import Profile as Profile
from .profile import plot_profiles as plot_profiles
from .profile import profiles as profiles
from .result import Calibration as Calibration
from .result import Minimum as Minimum
from .search import solve as solve
from .search_options import METHODS as METHODS
from .search_options import MethodName as MethodName
from .search_options import SearchOptions as SearchOptions
from .uncertainty import Uncertainty as Uncertainty

__all__: list[str]
