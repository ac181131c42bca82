"""The comparison of a building with measurements, without a calibration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.study_document.comparison import BandEntry
    from mascarin.study_document.document import StudyDocument


@dataclass(frozen=True, eq=False)
class Validation:
    """What ``mascarin validate`` finds.

    Attributes
    ----------
    content : StudyDocument
        The content of ``validation.json``.
    series : pandas.DataFrame
        The content of ``series.csv``.
    """

    content: StudyDocument
    series: pd.DataFrame

    @property
    def remarks(self) -> list[str]:
        """Where the posterior extrapolates, and what contradicts the study; read them first."""
        return [entry.text for entry in self.content.contradictions]

    @property
    def bands(self) -> dict[str, BandEntry]:
        """Half-width of the bands of each sensor, and the part of the values inside, by period.

        Empty for a building without a posterior.
        """
        return self.content.band

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for a JSON file."""
        return self.content.to_dict()

    def to_dataframe(self) -> pd.DataFrame:
        """Return measured and predicted series, with their bands."""
        return self.series
