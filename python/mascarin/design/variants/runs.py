"""The runs of a design study: stores of ensembles in its folder, which can be continued at any moment."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin._io.sealed import own_files
from mascarin.building.parameters.ties import spread
from mascarin.design.evaluation.layers import LayerFacts
from mascarin.design.evaluation.objective import column_of_part
from mascarin.design.evaluation.reductions import BINS, DaysInBin
from mascarin.ensemble import sweep_into
from mascarin.ensemble.members import members as read_members
from mascarin.ensemble.work import dataset
from mascarin.errors import InputError
from mascarin.simulation import Simulation

if TYPE_CHECKING:
    import pandas as pd

    from mascarin.building import Building
    from mascarin.design.evaluation.objectives import AnyObjective
    from mascarin.design.variants.inputs import DesignInputs, DesignSite
    from mascarin.design.variants.variables import Design
    from mascarin.simulation.checks.warning_kinds import RunWarning

#: Folder of the stores.
FOLDER: Final = "runs"
#: Ending of a column of hours in which an index has no value.
UNDEFINED: Final = ", hours without a value"
#: Members from which several processes are quicker than the threads of one.
_MIN_PARALLEL_RUNS: Final = 200

Report = Callable[[int, int], object]


@dataclass(frozen=True)
class Mode:
    """Runs that objectives share: the same changes of the building.

    Attributes
    ----------
    changes : mapping of str to object
        What is replaced in the building.
    objectives : tuple of str
        Names of the objectives that read these runs.
    """

    changes: Mapping[str, Any]
    objectives: tuple[str, ...]


@dataclass
class Runs:
    """Runs designs in all climates, and keeps what the objectives need.

    Parameters
    ----------
    inputs : DesignInputs
        The study.
    out : Path
        Its folder, locked by the caller.
    workers : int, optional
        Processes; by default those of the machine where there is much to do.
    report : callable
        Called with the members done and expected.
    expected : int
        Members of the whole study, as far as they are known.
    """

    inputs: DesignInputs
    out: Path
    workers: int | None
    report: Report
    expected: int = 0
    done: int = 0
    used: set[str] = field(default_factory=set)
    warnings: dict[RunWarning, None] = field(default_factory=dict)

    def values(
        self,
        designs: Sequence[Design],
        *,
        samples: Mapping[str, Sequence[float]] | None = None,
        only: Sequence[str] | None = None,
    ) -> pd.DataFrame:
        """Objectives of designs in all climates.

        Parameters
        ----------
        designs : sequence of Design
            The designs.
        samples : mapping of str to sequence of float, optional
            Uncertain parameters; every design is run with each of their rows. [unit of each]
        only : sequence of str, optional
            Objectives that are needed; by default all.

        Returns
        -------
        pandas.DataFrame
            A row for each climate, design and sample: ``climate``, ``design`` (the place in `designs`),
            ``sample``, the objectives, days in the bins of the daily change of the liquid fraction,
            ``closure`` and ``failure``.
        """
        import pandas as pd

        repeats = 1 if samples is None else len(next(iter(samples.values())))
        columns = {
            path: [value for value in column for _ in range(repeats)]
            for path, column in self.inputs.choices.samples(self.inputs.building, designs).items()
        }
        for path, sampled in (samples or {}).items():
            columns[path] = list(sampled) * len(designs)
        labels = {
            name: [label for label in column for _ in range(repeats)]
            for name, column in self.inputs.choices.labels(designs).items()
        }
        facts = facts_of(self.inputs.building, columns, labels)
        tables = []
        for site in self.inputs.sites:
            table = pd.DataFrame(
                {
                    "climate": site.name,
                    "design": np.repeat(np.arange(len(designs)), repeats),
                    "sample": np.tile(np.arange(repeats), len(designs)),
                }
            )
            tables.append(self._of_site(site, columns, facts, table, only))
        return pd.concat(tables, ignore_index=True)

    def reference(self) -> pd.DataFrame:
        """Objectives of the reference by climate; NaN for those of what it does not have."""
        import pandas as pd

        rows = []
        for site in self.inputs.sites:
            row: dict[str, Any] = {"climate": site.name}
            for mode in modes(self.inputs.file.objectives):
                building = site.building.replace({**self.inputs.file.reference, **mode.changes})
                row |= self._of_reference(site, building, mode)
            rows.append(row)
        return pd.DataFrame(rows)

    def _of_reference(self, site: DesignSite, building: Building, mode: Mode) -> dict[str, float]:
        """Objectives of one building that are possible for it."""
        possible: list[str] = []
        for name in mode.objectives:
            with contextlib.suppress(InputError):
                self.inputs.objective(name).check(building)
                possible.append(name)
        outputs = [output for name in possible for output in self.inputs.objective(name).outputs(building)]
        series = None
        if outputs:
            simulation = Simulation(
                building,
                site.climate,
                outputs=list(dict.fromkeys(outputs)),
                start=site.start,
                end=site.end,
                step=self.inputs.file.step,
                scheme=self.inputs.file.scheme,
            )
            records, _, _ = simulation.ensemble(simulation.vector({})[None, :])
            series = dataset(simulation.outputs, simulation.index, records)
        facts = LayerFacts([building], {}, {choice.name: ["reference"] for choice in self.inputs.choices.all})
        results = dict.fromkeys(mode.objectives, float("nan"))
        for name in possible:
            objective = self.inputs.objective(name)
            reductions = objective.reductions(site.climate, building)
            reduced = {key: np.asarray(reduction(series)) for key, reduction in reductions.items()}
            results[name] = float(objective.value(reduced, facts)[0])
            results |= {
                column_of_part(name, part): float(part_values[0])
                for part, part_values in objective.parts(reduced).items()
            }
        return results

    def forget_others(self) -> None:
        """Remove stores of this folder that this study has not used, such as those of other inputs."""
        folder = self.out / FOLDER
        for store in sorted(folder.iterdir()) if folder.is_dir() else ():
            if store.is_dir() and (store / "manifest.json").exists() and store.name not in self.used:
                shutil.rmtree(store, ignore_errors=True)

    def _of_site(
        self,
        site: DesignSite,
        columns: Mapping[str, Sequence[Any]],
        facts: LayerFacts,
        table: pd.DataFrame,
        only: Sequence[str] | None,
    ) -> pd.DataFrame:
        worst, outside = np.zeros(len(table)), np.full(len(table), -np.inf)
        failures: list[str | None] = [None] * len(table)
        for mode in modes(self.inputs.file.objectives, only):
            building = site.building.replace(dict(mode.changes)) if mode.changes else site.building
            reduced = self._reduced(site, building, columns, mode)
            for name in mode.objectives:
                objective = self.inputs.objective(name)
                of_objective = {
                    key: reduced[f"{name}: {key}"] for key in objective.reductions(site.climate, building)
                }
                table[name] = np.asarray(objective.value(of_objective, facts), dtype=np.float64)
                for part, values in objective.parts(of_objective).items():
                    table[column_of_part(name, part)] = values
                if "undefined" in of_objective:
                    table[f"{name}{UNDEFINED}"] = of_objective["undefined"]
            for key in [key for key in reduced if key.startswith("bin ")]:
                table[key] = reduced[key]
            if reduced:
                worst, outside = np.fmax(worst, reduced["closure"]), np.fmax(outside, reduced["outside"])
                failures = [a or b for a, b in zip(failures, reduced["failure"], strict=True)]
        table["closure"], table["outside"], table["failure"] = worst, outside, failures
        return table

    def _reduced(
        self, site: DesignSite, building: Building, columns: Mapping[str, Sequence[Any]], mode: Mode
    ) -> dict[str, Any]:
        """What is kept of each run of a mode; nothing where its objectives need none."""
        functions: dict[str, Callable[[Any], Any]] = {}
        outputs: dict[str, None] = {}
        for name in mode.objectives:
            objective = self.inputs.objective(name)
            reductions = objective.reductions(site.climate, building)
            functions |= {f"{name}: {key}": reduction for key, reduction in reductions.items()}
            outputs |= dict.fromkeys(objective.outputs(building))
        if not functions:
            return {}
        columns = _with_changes(columns, spread(site.building, mode.changes))
        for output in [name for name in outputs if name.endswith("_liquid_fraction")]:
            functions |= {f"bin {k} {output}": DaysInBin(output, k) for k in range(BINS)}
        count, before = len(next(iter(columns.values()))), self.done
        store = sweep_into(
            self._folder(site, functions, columns, mode),
            building,
            site.climate,
            one_each(columns),
            outputs=list(outputs),
            objectives=functions,
            start=site.start,
            end=site.end,
            step=self.inputs.file.step,
            scheme=self.inputs.file.scheme,
            ranges=self.inputs.choices.ranges(),
            workers=self.workers if self.workers is not None else _workers(count),
            progress=lambda done, _: self.report(before + done, max(self.expected, before + count)),
        )
        self.done = before + count
        self.report(self.done, max(self.expected, self.done))
        self.warnings |= dict.fromkeys(line.after(site.name) for line in store.warnings())
        table = store.to_dataframe()
        arrays: dict[str, Any] = {name: table[name].to_numpy(dtype=np.float64) for name in functions}
        return arrays | {
            "closure": table["closure"].to_numpy(),
            "outside": table["outside"].to_numpy(),
            "failure": list(table["failure"].where(table["failure"].notna(), None)),
        }

    def _folder(
        self, site: DesignSite, functions: Mapping[str, object], columns: Mapping[str, Any], mode: Mode
    ) -> Path:
        """Folder of a store, named by all that its values depend on."""
        key = [
            site.name,
            site.hash,
            str(site.start),
            str(site.end),
            repr(sorted(functions.items())),
            self.inputs.file.step,
            self.inputs.file.scheme,
            json.dumps(mode.changes, sort_keys=True, default=str),
            json.dumps(site.building.to_dict(), sort_keys=True, default=str),
            json.dumps(dict(columns), sort_keys=True, default=str),
            repr(self.inputs.choices.ranges()),
        ]
        name = f"{site.name}-{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}"
        self.used.add(name)
        return own_files.require_folder(self.out / FOLDER, name)


def modes(objectives: Mapping[str, AnyObjective], only: Sequence[str] | None = None) -> list[Mode]:
    """Objectives by the changes of the building that they need."""
    by_changes: dict[str, tuple[Mapping[str, Any], list[str]]] = {}
    for name, objective in objectives.items():
        if only is None or name in only:
            changes = objective.changes()
            key = json.dumps(changes, sort_keys=True, default=str)
            by_changes.setdefault(key, (changes, []))[1].append(name)
    return [Mode(changes, tuple(names)) for changes, names in by_changes.values()]


def runs_per_design(inputs: DesignInputs, only: Sequence[str] | None = None) -> int:
    """Runs of one design in all climates."""
    needed = [
        mode
        for mode in modes(inputs.file.objectives, only)
        if any(inputs.objective(name).outputs(inputs.building) for name in mode.objectives)
    ]
    return len(needed) * len(inputs.sites)


def facts_of(
    building: Building, columns: Mapping[str, Sequence[Any]], labels: Mapping[str, Sequence[str]]
) -> LayerFacts:
    """Layers of the members of an ensemble."""
    members = read_members(building, one_each(columns))
    buildings: list[Building] = [building] * members.count
    for structure, rows in members.groups() if members.structures else ():
        changed = building.replace(structure)
        for row in rows:
            buildings[row] = changed
    return LayerFacts(buildings, members.numbers, labels)


def one_each(columns: Mapping[str, Sequence[Any]]) -> dict[str, Any]:
    """Columns in which a part, such as a list of layers, is one value and not a row of a table."""
    cells: dict[str, Any] = {}
    for path, column in columns.items():
        if any(isinstance(value, list | dict) or value is None for value in column):
            cells[path] = np.empty(len(column), dtype=object)
            cells[path][:] = [None] * len(column)
            for k, value in enumerate(column):
                cells[path][k] = value
        else:
            cells[path] = column
    return cells


def _with_changes(columns: Mapping[str, Sequence[Any]], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Columns in which what the objective changes holds for every design, whatever the design has chosen."""
    return {
        path: [changes[path]] * len(column) if path in changes else column for path, column in columns.items()
    }


def _workers(count: int) -> int | None:
    cores = os.cpu_count() or 1
    return cores if count >= _MIN_PARALLEL_RUNS and cores > 1 else None
