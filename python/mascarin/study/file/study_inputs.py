"""What a study reads before anything is run, and what its plan says of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from mascarin.errors import InputError
from mascarin.study.file.description import StudyFile
from mascarin.study.file.locations import Places

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from mascarin.building import Building
    from mascarin.study.file.description import IdentificationPlan, StudyPlan
    from mascarin.tables.quality import Stretch
    from mascarin.weather import Climate, Measurements


@dataclass(frozen=True, eq=False)
class StudyInputs:
    """Everything that a study needs, read and with its names checked.

    Attributes
    ----------
    plan : StudyPlan
        What is done.
    building : Building
        The building as described.
    climate : Climate
        The weather.
    measurements : Measurements
        The measured columns to compare with, masked by the plan.
    driving : Measurements
        The measured columns as inputs of the model: never masked, so that a column may be both.
    quality : list of Stretch
        Suspicious values of the measured columns.
    places : Places
        Lines of the study, for errors.
    hashes : dict of str to str
        SHA-256 of the study, the building, the measurements and the weather.
    path : Path or None
        The study file; None for a study made of objects.
    transfer : mapping of str to StudyInputs
        Other houses, seasons and phases, on which the calibrated building is validated.
    experiment : str
        Name of the experiment; empty where the study has no experiments.
    together : mapping of str to StudyInputs
        Other experiments that are identified together with this one.
    """

    plan: StudyPlan
    building: Building
    climate: Climate
    measurements: Measurements
    driving: Measurements
    quality: list[Stretch]
    places: Places
    hashes: dict[str, str]
    path: Path | None = None
    transfer: Mapping[str, StudyInputs] = field(default_factory=dict)
    experiment: str = ""
    together: Mapping[str, StudyInputs] = field(default_factory=dict)

    def require_alone(self, what: str, *, validated: bool = True) -> None:
        """Refuse what is made of one data set in a study of several experiments.

        Parameters
        ----------
        what : str
            Why, in words.
        validated : bool
            Whether those that are only validated count, too.

        Raises
        ------
        InputError
            The study has several.
        """
        if self.experiment if validated else self.together:
            raise InputError(
                f"{self.places.file}: experiments: found several data sets, expected a study of one: {what}. "
                "Write a study file of one experiment, which extends this one or its base"
            )

    @property
    def file_places(self) -> Places:
        """Lines of the whole study file, those of its experiments included."""
        return Places(self.path) if self.experiment else self.places

    @property
    def others(self) -> dict[str, StudyInputs]:
        """All other experiments of the study, those that are identified first."""
        return {**self.together, **self.transfer} if self.experiment else {}

    @property
    def measured_columns(self) -> set[str]:
        """Columns of the table of measurements that sensors are compared with, by their names there."""
        columns = {column for sensor in self.plan.sensors.values() for column in sensor.columns}
        if not isinstance(self.plan, StudyFile):
            return columns
        entries = (self.plan.measurements.column_of(column) for column in columns)
        return {entry if isinstance(entry, str) else str(entry.get("column", "")) for entry in entries}

    @property
    def own_paths(self) -> set[str]:
        """Parameters of which every experiment has its own value, by their paths in the building."""
        plan = self.plan.identification
        return {
            self.building.parameter(path).path
            for path, free in ({} if plan is None else plan.parameters).items()
            if free is not None and free.per_experiment
        }

    @property
    def source_file(self) -> Path:
        """The study file.

        Raises
        ------
        InputError
            The study was made of objects.
        """
        if self.path is None:
            raise InputError(
                f"study '{self.plan.name}': made of objects, expected one of a file; write it with "
                "to_yaml('study.yaml') and open it with Study.from_yaml('study.yaml')"
            )
        return self.path

    @property
    def file_plan(self) -> StudyFile:
        """Plan of the study.

        Raises
        ------
        InputError
            The study was made of objects.
        """
        _ = self.source_file
        assert isinstance(self.plan, StudyFile)  # noqa: S101 (what comes from a file is one)
        return self.plan

    def leaves_out(self, stretch: Stretch) -> bool:
        """Whether suspicious values are left out of all comparisons: of sensors, of the masked kinds."""
        sensors = {column for sensor in self.plan.sensors.values() for column in sensor.columns}
        return stretch.kind in self.plan.quality.mask and stretch.channel in sensors

    @property
    def calibration_plan(self) -> IdentificationPlan:
        """The identification of the study.

        Raises
        ------
        InputError
            The study has none.
        """
        if self.plan.identification is None:
            raise InputError(
                f"{self.places.at('identification')}: found nothing, expected parameters to identify: "
                "add identification: {parameters: {...}}, or use 'mascarin validate' for the comparison "
                "alone, or 'mascarin sensitivity' for the sensitivity analysis"
            )
        return self.plan.identification

    @property
    def candidates(self) -> list[str | None]:
        """What may become the fitted model; None is the building as described."""
        return [None, *(name for name, variant in self.plan.variants.items() if variant.candidate)]
