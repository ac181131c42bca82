"""The models of a study: each compiled when it is first used, and only once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from mascarin.simulation.preparation.initial import Initial, MeasuredStart
from mascarin.simulation.simulation import Simulation
from mascarin.study.context.phase_change import melting_layers

if TYPE_CHECKING:
    from mascarin.building import Building
    from mascarin.measurements.time_fields import Duration
    from mascarin.simulation.preparation.options import TimeLike
    from mascarin.study.context.periods import StudyPeriods
    from mascarin.study.context.variants import Variants
    from mascarin.study.file.study_inputs import StudyInputs


class StudyModels:
    """Simulations of the buildings of a study.

    Parameters
    ----------
    inputs : StudyInputs
        What was read.
    periods : StudyPeriods
        When they run.
    variants : Variants
        The buildings.
    """

    def __init__(self, inputs: StudyInputs, periods: StudyPeriods, variants: Variants) -> None:
        self._inputs, self._plan = inputs, inputs.plan
        self._periods, self._variants = periods, variants
        self._simulations: dict[tuple[str, str | None], Simulation] = {}

    @property
    def nominal(self) -> Simulation:
        """The building as described over the whole record."""
        return self.over_record()

    def over_record(self, variant: str | None = None) -> Simulation:
        """A model over the whole record, with the state of its phase-change layers."""
        building = self._variants.building_of(variant)
        sensed = {building.output(sensor.output).name for sensor in self._plan.sensors.values()}
        states = [name for layer in melting_layers(building) for name in layer.outputs if name not in sensed]
        return self._once(("record", variant), lambda: self.of_building(building, states))

    def for_calibration(self, variant: str | None = None) -> Simulation:
        """A model over the warm-up and the identification period."""
        import pandas as pd

        building, periods = self._variants.building_of(variant), self._periods
        first, last = periods.identification
        start = first - pd.Timedelta(seconds=periods.lead_seconds)
        end = start + periods.whole_steps((min(last, periods.end) - start).total_seconds())
        return self._once(("calibration", variant), lambda: self._simulate(building, start, end))

    def for_sensitivity(self) -> tuple[Simulation, float]:
        """A model over warm-up and identification with the step of many runs; length of the warm-up. [s]"""
        periods, step = self._periods, self._periods.step_of_many
        first, last = periods.identification
        lead = periods.whole_steps(periods.lead_seconds, step)
        end = first + periods.whole_steps((min(last, periods.end) - first).total_seconds(), step)
        if step == self._plan.step:
            return self.for_calibration(), lead.total_seconds()
        start = first - lead
        simulation = self._once(
            ("sensitivity", None), lambda: self._simulate(self._inputs.building, start, end, step=step)
        )
        return simulation, lead.total_seconds()

    def with_coarse_step(self, simulation: Simulation) -> Simulation:
        """The model of a simulation over the whole record with the step of many runs."""
        step, start = self._periods.step_of_many, self._periods.start
        if step == self._plan.step:
            return simulation
        end = start + self._periods.whole_steps((self._periods.end - start).total_seconds(), step)
        return self._once(
            ("coarse step", simulation.identity),
            lambda: self._simulate(simulation.building, start, end, step=step),
        )

    def of_building(self, building: Building, outputs: Sequence[str] = ()) -> Simulation:
        """A model of any building over the whole record, with the outputs of the sensors and further ones."""
        return self._simulate(building, self._periods.start, self._periods.end, outputs)

    @cached_property
    def initial(self) -> Initial:
        """Initial state of the runs; sensors with `use: false` are not used for it."""
        if self._plan.initial != "measured":
            return self._plan.initial
        columns: dict[str, list[str]] = {}
        for sensor in self._plan.sensors.values():
            if sensor.use:
                columns.setdefault(self._inputs.building.output(sensor.output).name, []).extend(
                    sensor.columns
                )
        return MeasuredStart(self._inputs.measurements, columns)

    def _once(self, key: tuple[str, str | None], make: Callable[[], Simulation]) -> Simulation:
        if key not in self._simulations:
            self._simulations[key] = make()
        return self._simulations[key]

    def _simulate(
        self,
        building: Building,
        start: TimeLike,
        end: TimeLike,
        outputs: Sequence[str] = (),
        step: Duration | None = None,
    ) -> Simulation:
        """A model that records the outputs of the sensors, then further outputs."""
        return Simulation(
            building,
            self._inputs.climate,
            step=step or self._plan.step,
            start=start,
            end=end,
            outputs=[*(building.output(s.output).name for s in self._plan.sensors.values()), *outputs],
            scheme=self._plan.scheme,
            initial=self.initial,
            measurements=self._inputs.driving,
            ranges=self._variants.ranges(building),
        )
