from .base.factors import Factor as Factor
from .base.result import Sensitivity as Sensitivity
from .building_analysis import factors_of as factors_of
from .building_analysis import sensitivity_analysis as sensitivity_analysis
from .methods import METHODS as METHODS
from .methods import MethodName as MethodName
from .methods import collector as collector
from .methods import plan as plan
from .methods import run as run

__all__: list[str]
