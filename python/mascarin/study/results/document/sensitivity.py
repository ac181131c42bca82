"""The sensitivity analysis of a study, as the report shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.sensitivity.spectral import SpectralSensitivity
from mascarin.study_document.document import StudyDocument
from mascarin.study_document.estimates import DaySharesEntry, PeakEntry, SpectrumEntry

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.sensitivity import Sensitivity
    from mascarin.study.context.context import StudyContext


#: Parameters named in the spectra and indices over the day.
_SHOWN: Final = 8


def importance(study: StudyContext, analysis: Sensitivity) -> StudyDocument:
    """Sensitivity indices; for the spectral method also the spectra and the indices over the day."""
    rows = [
        ["method", analysis.method],
        ["index", analysis.measure],
        ["parameters", str(len(analysis.names))],
        ["runs", str(analysis.runs)],
        ["seed", str(analysis.seed)],
    ]
    spectral: dict[str, Any] = {}
    if isinstance(analysis, SpectralSensitivity):
        hours = _hours(study, analysis.index_t.shape[1])
        rows += [
            ["replicates", str(analysis.design.replicates)],
            ["harmonics counted", str(analysis.design.order)],
        ]
        spectral = {
            "frequencies": _frequencies(analysis),
            "spectra": {output: _spectrum(analysis, output) for output in analysis.outputs},
            "day_shares": {output: _day_shares(analysis, output, hours) for output in analysis.outputs},
        }
    return StudyDocument.model_validate(
        {
            "sensitivity": analysis.to_dict(),
            **spectral,
            "sensitivity_design": [*rows, *(["warning", text] for text in analysis.warnings)],
        }
    )


def _frequencies(analysis: SpectralSensitivity) -> dict[str, int]:
    """Frequency of each parameter or group in the first replicate, which the spectra show."""
    return {
        name: int(line)
        for name, line in zip(analysis.design.groups, analysis.design.frequencies[0], strict=True)
    }


def analyzed_hours(study: StudyContext, analysis: Sensitivity) -> npt.NDArray[np.float64] | None:
    """Hour of the day of each analyzed time, local; None for methods that keep no times. [h]"""
    times = getattr(analysis, "variance_t", None)
    return None if times is None or len(times) < 2 else _hours(study, len(times))


def _hours(study: StudyContext, count: int) -> npt.NDArray[np.float64]:
    """Hour of the day of each analyzed time, local."""
    import pandas as pd

    step = pd.Timedelta(
        seconds=(study.periods.identification[1] - study.periods.identification[0]).total_seconds()
        / max(count - 1, 1)
    )
    times = pd.date_range(study.periods.identification[0], periods=count, freq=step).tz_localize(None)
    return np.asarray(times.hour + times.minute / 60.0, dtype=np.float64)


def _spectrum(analysis: SpectralSensitivity, output: str) -> SpectrumEntry:
    spectrum = analysis.spectrum(output)
    return SpectrumEntry(
        frequencies=list(range(1, len(spectrum.power) + 1)),
        power=[float(p) for p in spectrum.power],
        threshold=float(spectrum.threshold),
        peaks=[
            PeakEntry(frequency=peak.line, power=peak.power, path=peak.label or "unnamed", harmonic=1)
            # The strongest first, because a report may show only some of them.
            for peak in sorted(spectrum.peaks, key=lambda peak: -peak.power)
        ],
    )


def _day_shares(analysis: SpectralSensitivity, output: str, hours: npt.NDArray[np.float64]) -> DaySharesEntry:
    """First-order indices of the most influential parameters by hour of the day, summed over the days."""
    s = analysis.output_index(output)
    names = analysis.ranking(output, _SHOWN)
    rows = [list(analysis.names).index(name) for name in names]
    unique = np.unique(hours)
    variance = np.nan_to_num(analysis.variance_t[:, s])
    power = np.nan_to_num(analysis.index_t[rows, :, s]) * variance
    share = [
        [float(p[hours == hour].sum() / max(variance[hours == hour].sum(), 1e-300)) for hour in unique]
        for p in power
    ]
    return DaySharesEntry(hours=unique.tolist(), paths=names, share=share)
