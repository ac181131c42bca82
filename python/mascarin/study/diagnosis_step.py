"""The diagnosis of a study: faults of data first, then parameters and forms of the model.

Every step compares causes with each other, names the one that explains most, removes it, and goes on with
what is left. Faults of data are fitted together with all parameters of the model, calibrated or not, so that
a wrong parameter is not taken for a fault of a sensor. A form of the model that explains more than a fault is
tried first: the fault must remain with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.errors import SolverError
from mascarin.linear_algebra import one_thread
from mascarin.progress import reporting
from mascarin.study import diagnosis_words as words
from mascarin.study.corrections import Corrections, Found
from mascarin.study.diagnosis_candidates import Candidate, OtherForm, name_of
from mascarin.study.diagnosis_model import Model, Store
from mascarin.study.other_laws import forms
from mascarin.validation.hypotheses import Cause, Diagnosis
from mascarin.validation.likelihood_ratio import SquareSums, p_value, step_change_p_value
from mascarin.validation.sensor_faults import Fault, Series, sensor_faults, white_noise
from mascarin.validation.step_changes import step_changes
from mascarin.validation.whitened_regression import Solution, WhitenedRegression, Whitening

if TYPE_CHECKING:
    import numpy.typing as npt

    from mascarin.calibration import Calibration
    from mascarin.progress import ProgressOption
    from mascarin.study.findings import ModelRun
    from mascarin.study.setup import Setup
    from mascarin.study.storage import Workspace

    Array = npt.NDArray[np.float64]

#: Largest number of causes of each stage.
_MOST: Final = 5
#: A cause is named when the probability of chance is below this, for all causes that were compared. [-]
_LEVEL: Final = 0.01
#: It takes away at least this part of the sum of squares of some sensor.
_LEAST: Final = 0.05
#: A fault of data keeps at least this part of its evidence with the best form of the model.
_KEPT: Final = 0.5
#: Noise is named when it exceeds the stated uncertainty by this factor.
_NOISY: Final = 1.1
#: Quantile of the normal distribution for a probability of 99.5 %.
_SURE: Final = 2.58
#: Causes that explain at least this part of what the best one does are named with it.
_SAME: Final = 0.9
#: Shorter delays than this, or than half a sample, are none of a clock. [s]
_SHORTEST: Final = 300.0
_ITERATIONS: Final = 6
#: The parameters are derived by again where one moved by more than this part of its range.
_FAR: Final = 0.25
#: A series with fewer values is not diagnosed.
_FEWEST: Final = 48


@one_thread()
def diagnosis(
    setup: Setup,
    run: ModelRun,
    fit: Calibration,
    workspace: Workspace,
    *,
    missed: bool,
    progress: ProgressOption = None,
) -> Diagnosis:
    """Find the causes of the difference between the fitted model and the measurements.

    Parameters
    ----------
    setup : Setup
        The study.
    run : ModelRun
        The fitted model.
    fit : Calibration
        Its calibration.
    workspace : Workspace
        Folder of the intermediate results.
    missed : bool
        Whether a criterion or an aim is missed: parameters and forms are then tried as well.
    progress : bool, callable or None
        Where progress is shown.

    Returns
    -------
    Diagnosis
        Without causes where nothing is significant.
    """
    found = list(words.of_table(setup))
    model = Model(setup, run.simulation, fit, Store(workspace), progress)
    if np.isfinite(model.measured).sum(axis=0).max(initial=0) < _FEWEST:
        return Diagnosis(tuple(found), {}, 1.0)
    with reporting(progress, "diagnosis") as report:
        search = _Search(setup, model, run.simulation.vector(fit.values))
        report(0, 3)
        suspicious = search.suspicious()
        report(1, 3)
        if suspicious or missed:
            search.whole()
            found += search.data_faults()
        report(2, 3)
        noise, noisy = search.noise()
        found += noisy
        found = _ordered(found)
        if missed:
            found += search.physics()
        report(3, 3)
    return Diagnosis(tuple(found), noise, search.remaining())


def _ordered(causes: Sequence[Cause]) -> list[Cause]:
    """Findings in the table first, then faults by the part that they take away."""
    return sorted(causes, key=lambda cause: -cause.share if math.isfinite(cause.share) else -math.inf)


class _Search:
    """Measured series, the parameters, and corrections of sensors found so far."""

    def __init__(self, setup: Setup, model: Model, vector: Array) -> None:
        self.setup, self.model, self.vector = setup, model, vector
        self.names = setup.observation.names
        self.measured = model.measured.copy()
        few = np.isfinite(self.measured).sum(axis=0) < _FEWEST
        self.measured[:, few] = np.nan
        self.u = np.array([max(setup.plan.sensors[n].uncertainty, 1e-9) / 1.96 for n in self.names])
        self.units = tuple(output.unit for output in model.simulation.outputs[: len(self.names)])
        self.fixes = Corrections(len(self.measured))
        self.fine = setup.observation.measured.copy()
        self.paths = list(model.fitted)
        self.slopes = model.slopes(vector, every=False)
        self.slopes_at = vector
        self.whitening: Whitening | None = None
        self._key = (model.simulation.identity, vector.tobytes(), setup.inputs()["measurements"])
        self._joint: tuple[tuple[object, ...], WhitenedRegression] | None = None
        self.first: float | None = None
        self.last: float | None = None

    def corrected(self, series: Array) -> Array:
        """Simulated series as the sensors show them, with the faults found so far."""
        return self.fixes.shown(series, self.model.interval)

    def _effects(self) -> Array:
        """Effects of the parameters and of the offsets of the sensors, shape (K, n, S)."""
        slopes = self.fixes.effects(self.slopes, self.model.interval)
        sensors, n = len(self.names), len(self.measured)
        offsets = np.zeros((sensors, n, sensors))
        for s in range(sensors):
            offsets[s, :, s] = 1.0
        return np.concatenate([slopes, offsets])

    def joint(self) -> WhitenedRegression:
        """The problem at the present parameters; whitened as the errors of its richest form."""
        key = (
            id(self.slopes),
            id(self.vector),
            id(self.whitening),
            tuple(self.fixes.faults),
            self.measured.tobytes(),
        )
        if self._joint is None or self._joint[0] != key or self.whitening is None:
            made = self._made()
            key = (*key[:2], id(self.whitening), *key[3:])
            self._joint = (key, made)
        return self._joint[1]

    def _made(self) -> WhitenedRegression:
        simulated = self.corrected(self.model.series(self.vector))
        center, precision, limits = self.model.priors(self.paths, self.vector)
        free = np.tile([-np.inf, np.inf], (len(self.names), 1))
        args = (
            self.measured - simulated,
            self._effects(),
            np.concatenate([center, np.zeros(len(self.names))]),
            np.concatenate([precision, self.u**-2]),
            np.concatenate([limits, free]),
        )
        if self.whitening is None:
            plain = WhitenedRegression(*args, Whitening(tuple(np.empty(0) for _ in self.names)))
            best = plain.solve(range(len(plain.columns)))
            self.whitening = Whitening.of(args[0] - np.tensordot(best.values, args[1], 1))
        return WhitenedRegression(*args, self.whitening)

    def _refit(self) -> None:
        """Adjust the calibrated parameters to all days, so that a faulty sensor has little influence."""
        self.whitening = None
        paths = list(self.model.fitted)
        best = (math.inf, self.vector)
        vector, kept = self.vector, (self.paths, self.slopes)
        for _ in range(_ITERATIONS):
            try:
                self.paths, self.slopes = paths, self.model.slopes(vector, every=False)
                self.vector = vector
                problem = self.joint()
            except SolverError:
                break
            offsets = range(len(paths), len(problem.columns))
            prior = float(np.sum((problem.precision * problem.center**2)[: len(paths)]))
            here = problem.solve(list(offsets)).deviance + prior
            solution = problem.solve(range(len(problem.columns)))
            worse = here > best[0] - 2.0
            if here < best[0]:
                best = (here, vector)
            if worse or here - solution.deviance < 2.0:
                break
            vector = self.model.moved(vector, paths, solution.values[: len(paths)])
        self.vector, (self.paths, self.slopes) = best[1], kept
        self.whitening = None

    def whole(self) -> None:
        """Refit, and derive by all parameters."""
        self._refit()
        far = self.model.distance(self.vector, self.slopes_at) > _FAR
        if far:
            self.slopes_at = self.vector
        if far or len(self.paths) != len(self.model.paths):
            self.paths, self.slopes = self.model.paths, self.model.slopes(self.slopes_at, every=True)
        self.whitening = None

    def _series(self, near: bool) -> Series:
        simulated = self.corrected(self.model.series(self.vector))
        shortest = max(_SHORTEST, 0.5 * self.setup.observation.interval)
        places = self.model.neighbours(self.vector) if near else {}
        return Series(self.measured, simulated, self.u, self.model.interval, shortest, self.units, places)

    def _best_fault(
        self, near: bool
    ) -> tuple[Fault, float, float, WhitenedRegression, Solution, list[int]] | None:
        """The most important fault, its p and its part of the sum of squares; None where there is none."""
        problem = self.joint().in_directions(range(len(self.model.fitted)))  # a house has hundreds of columns
        active = list(range(len(problem.columns)))
        null = problem.solve(active)
        series = self._series(near)
        faults = [*sensor_faults(problem, active, null, series), *step_changes(problem, active, null, series)]
        faults.sort(key=lambda fault: -fault.deviance)
        # What is taken away is counted with the calibrated parameters alone.
        first = len(problem.columns) - len(self.names)
        adjusted = [*range(len(self.model.fitted)), *range(first, len(problem.columns))]
        squares = SquareSums(problem, adjusted, self.u)
        if self.first is None:
            self.first = float(squares.before.sum())
        self.last = float(squares.before.sum())
        found: list[tuple[float, Fault, float]] = []
        seen: set[int] = set()
        for fault in faults:
            # Of the faults of one sensor only the best one counts.
            if seen & set(fault.sensors):
                continue
            whole_offset = fault.what == "offset" and fault.rows is None
            p = self._chance(problem, null, active, fault)
            residual = None if fault.residual is None else dict(fault.residual)
            gone = fault.sensors[0] if whole_offset else None
            share, of_sensor = squares.share(squares.after(extra=fault.extra, residual=residual, offset=gone))
            if p < _LEVEL and of_sensor >= _LEAST and share > 0.0:
                seen |= set(fault.sensors)
                found.append((share, fault, p))
        if not found:
            return None
        share, fault, p = max(found, key=lambda item: item[0])
        return fault, p, share, problem, null, active

    def _chance(self, problem: WhitenedRegression, null: Solution, active: list[int], fault: Fault) -> float:
        """Probability of a fault by chance. [-]"""
        from scipy import stats

        assert fault.solution is not None  # noqa: S101 (every fault has been fitted)
        tried, interval = 30 * len(self.names), self.model.interval
        if fault.what == "offset":
            # Whitened, an offset that begins is a pulse; one of the whole record is told by the stated
            # uncertainty alone.
            ratio = tried * float(stats.chi2.sf(max(fault.deviance, 0.0), 1))
            if fault.rows is None:
                return min(1.0, ratio)
            s, values = fault.sensors[0], fault.solution.values[: len(active)]
            left = problem.residual[:, s] - values @ problem.columns[active, :, s]
            return min(1.0, max(ratio, step_change_p_value(left, fault.rows, interval=interval)))
        after = problem if fault.residual is None else problem.with_residual(dict(fault.residual))
        return p_value(
            (problem, null, active), (after, fault.solution, active, fault.extra),
            interval=interval, tried=tried, deviance=fault.deviance,
        )  # fmt: skip

    def suspicious(self) -> bool:
        """Whether a sensor shows a fault that the calibrated parameters do not explain, or too much noise."""
        found = self._stored(("suspicious",), lambda: self._best_fault(near=False) is not None)
        return bool(found) or bool(self.noise()[1])

    def _stored(self, key: tuple[object, ...], make: Callable[[], Any]) -> Any:
        """A result of the folder or a new one, with the sums of squares that it leaves."""
        stored = self.model.store.value((*self._key, *key), lambda: [make(), self.first, self.last])
        found, self.first, self.last = stored
        return found

    def data_faults(self) -> list[Cause]:
        """Faults of sensors, one after the other."""
        causes: list[Cause] = []
        while len(causes) < _MOST:
            step = self._stored(("data", len(causes)), self._next_fault)
            if step is None:
                break
            causes.append(Cause.from_dict(step["cause"]))
            self._remove(step)
            self.whole()
        return causes

    def _next_fault(self) -> dict[str, Any] | None:
        """The next fault with its evidence as plain values; None where there is none."""
        best = self._best_fault(near=True)
        if best is None or not self._remains(*best):
            return None
        fault, p, share, *_ = best
        cause = words.of_fault(self.setup, self.names, self.units, fault, p, share, self.model.group)
        return {
            "what": fault.what, "sensors": list(fault.sensors), "value": fault.value,
            "neighbour": fault.neighbour, "rows": fault.rows, "cause": cause.to_dict(),
        }  # fmt: skip

    def _remains(
        self,
        fault: Fault,
        _p: float,
        _share: float,
        problem: WhitenedRegression,
        null: Solution,
        active: list[int],
    ) -> bool:
        """Whether a fault keeps its evidence with the form of the model that explains most."""
        best, form = 0.0, None
        for one in self._forms():
            changed_problem = self._with(problem, one)
            gain = null.deviance - changed_problem.solve(active, start=null).deviance
            if gain > best:
                best, form = gain, one
        if form is None:
            return True
        changed_problem = self._with(problem, form)
        base = changed_problem.solve(active, start=null)
        simulated = self.corrected(form.series)
        series = replace(self._series(near=True), simulated=simulated)
        find = sensor_faults if fault.rows is None else step_changes
        again = find(changed_problem, active, base, series)
        left = [one.deviance for one in again if one.what == fault.what and one.sensors == fault.sensors]
        return bool(left) and left[0] >= _KEPT * fault.deviance

    def _remove(self, fault: Mapping[str, Any]) -> None:
        """Correct what is compared for a fault."""
        what, sensors, value = fault["what"], list(fault["sensors"]), fault["value"]
        rows = None if fault["rows"] is None else (int(fault["rows"][0]), int(fault["rows"][1]))
        found = Found(sensors[0], what, value, rows=rows)
        s = sensors[0]
        if what == "swapped":
            for table in (self.measured, self.fine):
                part = found.part(len(table), len(self.measured))
                table[part, sensors] = table[part, sensors[::-1]]
            return
        simulated = self.corrected(self.model.series(self.vector))[:, s]
        if what == "place":
            # A part of the neighbour's temperature: as a column of the difference, which has no parameter.
            other = self.model.neighbours(self.vector)[s][fault["neighbour"]]
            self.measured[:, s] -= value * (other - simulated)
            return
        about = float(simulated.mean()) if what == "scale" else 0.0
        self.fixes.faults.append(replace(found, about=about))

    def noise(self) -> tuple[dict[str, float], list[Cause]]:
        """White noise of each sensor, and a cause where it exceeds the stated uncertainty."""
        key = (*self._key, "noise", self.vector.tobytes(), len(self.paths), len(self.fixes.faults))
        found, excess, share = self.model.store.value(key, self._noise)
        sds = {name: math.nan if sd is None else sd for name, sd in found.items()}
        return sds, [words.of_noise(excess, share)] if excess else []

    def _noise(self) -> tuple[dict[str, float | None], list[tuple[str, float, float, str]], float]:
        # At every sample: slow errors of the model vanish in the second differences.
        interval = self.setup.observation.interval
        errors = self.fine - self.fixes.shown(self.model.fine(self.vector), interval)
        found: dict[str, float | None] = {}
        excess, squares, whole = [], 0.0, 0.0
        for s, name in enumerate(self.names):
            sd, error = white_noise(errors[:, s], interval)
            found[name] = sd if math.isfinite(sd) else None
            count = float(np.isfinite(errors[:, s]).sum())
            whole += float(np.nansum((errors[:, s] / self.u[s]) ** 2)) if count else 0.0
            if math.isfinite(sd) and sd - _SURE * error > _NOISY * self.u[s]:
                excess.append((name, sd, error, self.units[s]))
                squares += count * (sd / self.u[s]) ** 2
        return found, excess, min(1.0, squares / max(whole, 1e-300))

    def _with(self, problem: WhitenedRegression, form: OtherForm) -> WhitenedRegression:
        shown = self.corrected(form.series)
        return problem.with_residual({s: self.measured[:, s] - shown[:, s] for s in range(len(self.names))})

    def _forms(self) -> list[OtherForm]:
        """Series of the model with other forms, at the present parameters."""
        building = self.model.simulation.building
        surfaces = list(building.surfaces)
        outputs = self.model.simulation.outputs[: len(self.names)]
        seen = {surfaces[o.surface] for o in outputs if o.surface is not None and o.surface < len(surfaces)}
        found = []
        for part, kind, replaced in forms(building, seen):
            series = self.model.of_form((part, kind), replaced, self.vector)
            if np.isfinite(series).all():
                found.append(OtherForm(part, kind, series))
        return found

    def physics(self) -> list[Cause]:
        """Values of fixed parameters and one other form of the model, one after the other."""
        if len(self.paths) != len(self.model.paths):
            return []
        causes: list[Cause] = []
        chosen: list[str] = []
        while len(causes) < _MOST:
            key = (*self._key, "physics", self.vector.tobytes(), len(self.fixes.faults), tuple(chosen))
            step = self.model.store.value(key, partial(self._next_physics, chosen))
            self.first = self.first or step["before"]
            self.last = step["after"]
            if step["cause"] is None:
                break
            causes.append(Cause.from_dict(step["cause"]))
            chosen = [*chosen, step["name"]]
        return causes

    def _next_physics(self, chosen: Sequence[str]) -> dict[str, Any]:
        """The next parameter or form with its evidence, beside those that are chosen already."""
        problem, others = self.joint(), self._forms()
        first = len(problem.columns) - len(self.names)
        active = [*range(len(self.model.fitted)), *range(first, len(problem.columns))]
        active += [self.paths.index(name) for name in chosen if name in self.paths]
        for form in [form for form in others if name_of(self.paths, form) in chosen]:
            problem, others = self._with(problem, form), []
        null = problem.solve(active)
        squares = SquareSums(problem, active, self.u)
        candidates: list[Candidate] = []
        for k in range(first):
            if k not in active:
                fit = problem.solve([*active, k], start=null)
                candidates.append(Candidate(k, problem, [*active, k], fit))
        for form in others:
            other = self._with(problem, form)
            candidates.append(Candidate(form, other, active, other.solve(active, start=null)))
        before = float(squares.before.sum())
        nothing = {"cause": None, "before": before, "after": before}
        if not candidates:
            return nothing
        candidates.sort(key=lambda one: one.fit.deviance)
        most = null.deviance - candidates[0].fit.deviance
        alike = [one for one in candidates if null.deviance - one.fit.deviance >= _SAME * most]
        # Of causes that explain the same the smallest change is named; never one with which the sum rises.
        taken = {id(one): self._taken(squares, one) for one in alike}
        alike = [one for one in alike if squares.share(taken[id(one)])[0] > 0.0]
        if not alike:
            return nothing
        best = min(alike, key=lambda one: one.size)
        gain = null.deviance - best.fit.deviance
        p = p_value(
            (problem, null, active), (best.problem, best.fit, best.active, ()),
            interval=self.model.interval, tried=len(candidates), deviance=gain,
        )  # fmt: skip
        after = taken[id(best)]
        share, of_sensor = squares.share(after)
        if p >= _LEVEL or of_sensor < _LEAST:
            return nothing
        same = [name_of(self.paths, one.what) for one in alike if one is not best]
        cause = self._cause(best, p, share, gain, same)
        name = name_of(self.paths, best.what)
        return {"cause": cause.to_dict(), "name": name, "before": before, "after": float(after.sum())}

    def _taken(self, squares: SquareSums, one: Candidate) -> Array:
        """Sums of squares with a candidate, shape (S,). [-]"""
        if isinstance(one.what, OtherForm):
            return squares.after(residual={s: one.problem.residual[:, s] for s in range(len(self.names))})
        return squares.after(column=one.what)

    def _cause(self, best: Candidate, p: float, share: float, gain: float, same: Sequence[str]) -> Cause:
        if isinstance(best.what, OtherForm):
            return words.of_form(best.what.part, best.what.kind, p, share, gain, same)
        value, at = float(best.fit.values[-1]), best.fit.values.size - 1
        change = (value, best.fit.standard_error(at), not best.fit.free[-1])
        return words.of_parameter(
            self.model, self.paths[best.what], self.vector, change, p, share, gain, same
        )

    def remaining(self) -> float:
        """Part of the sum of squares that is left."""
        if not self.first or self.last is None:
            return 1.0
        return float(min(1.0, self.last / self.first))
