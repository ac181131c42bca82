from .study import planned_runs as planned_runs
from .study import run_design as run_design
from .variants.inputs import DesignInputs as DesignInputs
from .variants.inputs import read_design as read_design
from .variants.results import DesignResults as DesignResults

__all__: list[str]
