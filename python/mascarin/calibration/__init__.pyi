from .base.building_problem import fit_parameter as fit_parameter
from .base.cost import Cost as Cost
from .base.evaluations import Evaluator as Evaluator
from .base.evaluations import Trace as Trace
from .base.problem import CalibrationProblem as CalibrationProblem
from .base.problem import FitParameter as FitParameter
from .base.problem import FitSensor as FitSensor
from .base.result import Calibration as Calibration
from .base.result import Minimum as Minimum
from .base.search_options import METHODS as METHODS
from .base.search_options import MethodName as MethodName
from .base.search_options import SearchOptions as SearchOptions
from .base.uncertainty import Uncertainty as Uncertainty
from .building_calibration import calibrate as calibrate
from .methods.search import solve as solve
from .profile import Profile as Profile
from .profile import plot_profiles as plot_profiles
from .profile import profiles as profiles

__all__: list[str]
