from .comparison import METRICS as METRICS
from .comparison import Metrics as Metrics
from .comparison import metrics as metrics
from .criteria import Criterion as Criterion
from .criteria import Verdict as Verdict
from .criteria import judge as judge
from .criteria import parse_criteria as parse_criteria
from .days import DayChoice as DayChoice
from .days import choose_days as choose_days
from .residuals import DriverCorrelation as DriverCorrelation
from .residuals import ResidualAnalysis as ResidualAnalysis
from .residuals import analyze_residuals as analyze_residuals

__all__: list[str]
