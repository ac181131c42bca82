from .observation import Observation as Observation
from .observation import observe as observe
from .sensor import Sensor as Sensor
from .sensor import SensorPeriods as SensorPeriods
from .uncertainty import SensorUncertainty as SensorUncertainty

__all__: list[str]
