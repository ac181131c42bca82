from .draw import latin_hypercube as latin_hypercube
from .objectives import Statistic as Statistic
from .run import sweep as sweep
from .run import sweep_into as sweep_into
from .store import Store as Store

__all__: list[str]
