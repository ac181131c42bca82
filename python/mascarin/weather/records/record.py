"""Records of the weather: columns on a grid, their place, and what was assumed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mascarin.tables.record import Record
from mascarin.weather.records.channels import RADIATION, Basis
from mascarin.weather.records.site import Place


def plain_warning(note: str) -> str:
    """A note of a provenance that begins with the file and the word ``warning``, without this word."""
    return note.replace(": warning: ", ": ", 1)


@dataclass(frozen=True, eq=False)
class WeatherRecord(Record):
    """A record of the weather.

    Attributes
    ----------
    site : Place or None
        Where the weather was measured, if known.
    check_sun : bool
        Refuse radiation that does not follow the sun.
    elsewhere : bool
        May be used for a building at another place than where it was measured.
    basis : str or None
        The two irradiances from which a third was derived; None before anything was derived.
    assumed : frozenset of str
        Channels that were not measured, for which a value is assumed or was stated.
    """

    name_sets: ClassVar[tuple[str, ...]] = ("assumed",)

    site: Place | None = None
    check_sun: bool = True
    elsewhere: bool = False
    basis: Basis | None = None
    assumed: frozenset[str] = frozenset()

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about the weather, which every run with it has."""
        said = [note for note in self.provenance if self.of_year and ": warning: " in note]
        infrared = self.columns.get("infrared", np.zeros(0))
        gaps = int(np.isnan(infrared).sum())
        if self.of_year and 0 < gaps < len(infrared):
            said.append(
                f"{self.file}: infrared has no value in {gaps} of {len(infrared)} rows: in these a "
                f"run takes the "
                "model of the sky of Martin & Berdahl (1984), unless the building gives site.sky."
            )
        return tuple(plain_warning(note) for note in said)

    def measured(self, name: str) -> bool:
        """Whether a channel of a measured table was measured; a weather file of a year fills it somehow."""
        return name in self.columns and name not in self.assumed and not self.of_year

    @property
    def radiation_basis(self) -> Basis:
        """The irradiances whose means are kept; one that is not given follows from two and the sun."""
        if self.basis is not None:
            return self.basis
        if all(name in self.columns for name in RADIATION):
            return "all"
        return "direct+diffuse" if "direct_normal" in self.columns else "global+diffuse"
