from .files.loading import load as load
from .files.project import Project as Project
from .run import Options as Options
from .run import Outcome as Outcome
from .run import optimize as optimize

__all__: list[str]
