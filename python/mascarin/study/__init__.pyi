from .file.description import Sensor as Sensor
from .results.results import StudyResults as StudyResults
from .study import Study as Study

__all__: list[str]
