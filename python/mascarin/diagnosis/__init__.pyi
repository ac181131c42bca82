from .causes import diagnose as diagnose
from .error_covariance import ErrorCovariance as ErrorCovariance
from .error_covariance import estimate_error_covariance as estimate_error_covariance
from .error_sources import ErrorSources as ErrorSources
from .error_sources import explain_missed_aims as explain_missed_aims
from .error_sources import find_error_sources as find_error_sources
from .hypotheses import Candidate as Candidate
from .hypotheses import Cause as Cause
from .hypotheses import Diagnosis as Diagnosis
from .hypotheses import DiagnosisInput as DiagnosisInput
from .sensor_faults import sensor_candidates as sensor_candidates
from .step_changes import Hypotheses as Hypotheses

__all__: list[str]
