from .inputs import DesignInputs as DesignInputs
from .inputs import read_design as read_design
from .results import DesignResults as DesignResults
from .study import planned_runs as planned_runs
from .study import run_design as run_design

__all__: list[str]
