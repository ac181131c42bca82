"""Results of a design study: tables of all designs, and the ranking of the best."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin import __version__
from mascarin._io import atomic
from mascarin.design.evaluation.objective import column_of_part
from mascarin.design.variants.ranking import pareto, ranked
from mascarin.errors import SolverError

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd

    from mascarin.design.variants.inputs import DesignInputs
    from mascarin.design.variants.ranking import Ranking
    from mascarin.design.variants.variables import Design
    from mascarin.simulation.checks.warning_kinds import RunWarning

    Array = npt.NDArray[np.float64]

#: Files of a result folder.
FILES: Final = ("designs.csv", "ranking.csv", "samples.csv", "designs.parquet", "design.json", "report.html")
#: Climate of a ranking over all of them.
ALL: Final = "all climates"


@dataclass(frozen=True)
class DesignResults:
    """Results of a design study.

    Attributes
    ----------
    inputs : DesignInputs
        The study.
    designs : list of Design
        All that were run.
    nominal : pandas.DataFrame
        A row for each climate and design: objectives with the building as described.
    best : list of int
        Designs that were compared over samples, the best nominal ones first.
    sampled : pandas.DataFrame
        A row for each climate, design of `best` and sample.
    rankings : mapping of str to Ranking
        By climate, and over `ALL`; designs are places in `best`.
    reference : mapping of str to mapping of str to float
        Objectives of the reference, by climate.
    warnings : tuple of RunWarning
        Warnings about the runs, with their climate; see `mascarin.sweep`.
    """

    inputs: DesignInputs
    designs: list[Design]
    nominal: pd.DataFrame
    best: list[int]
    sampled: pd.DataFrame
    rankings: Mapping[str, Ranking]
    reference: Mapping[str, Mapping[str, float]]
    warnings: tuple[RunWarning, ...] = ()

    @property
    def ranked_by(self) -> str:
        """The objective of the ranking."""
        return self.inputs.file.ranked_by

    @property
    def columns(self) -> dict[str, str]:
        """Columns of the objectives, each followed by its parts, and the objective that they belong to."""
        columns: dict[str, str] = {}
        for name, objective in self.inputs.file.objectives.items():
            parts = [column_of_part(name, part) for part in objective.PARTS]
            columns |= dict.fromkeys([name, *(column for column in parts if column in self.nominal)], name)
        return columns

    def values(self, objective: str, climate: str = ALL) -> Array:
        """An objective, or another column, of all designs in a climate or as the mean: shape (designs,)."""
        return by_climate(self.nominal, objective, len(self.designs))[climate]

    def label(self, design: int) -> str:
        """What a design has chosen, in words."""
        labels = self.inputs.choices.labels([self.designs[design]])
        return ", ".join(f"{name} {values[0]}" for name, values in labels.items())

    def front(self, objectives: Sequence[str], climate: str = ALL) -> npt.NDArray[np.bool_]:
        """Designs that no other one beats in all of some objectives, shape (designs,)."""
        return pareto(np.column_stack([self.cost(name, climate) for name in objectives]))

    def cost(self, objective: str, climate: str = ALL) -> Array:
        """An objective to be minimized, shape (designs,)."""
        values = self.values(objective, climate)
        return values if self.inputs.objective(objective).least else -values

    def verdict(self, ranking: Ranking, k: int) -> str:
        """Whether a compared design is worse than the best one and the one before it, in words."""
        if k == ranking.order[0]:
            return "best"
        if ranking.tied[k]:
            return "tied with the best"
        if ranking.tied_before[k]:
            return f"tied with rank {list(ranking.order).index(k)}"
        return "worse" if ranking.samples > 1 else "worse as described"

    def winners(self, climate: str = ALL) -> list[int]:
        """The best design and those tied with it, in the order of their means."""
        ranking = self.rankings[climate]
        return [self.best[k] for k in ranking.order if ranking.tied[k]]

    def to_dataframe(self) -> pd.DataFrame:
        """All designs in all climates: what was chosen, numbers, objectives, failures."""
        import pandas as pd

        labels = pd.DataFrame(self.inputs.choices.labels(self.designs))
        chosen = labels.iloc[self.nominal["design"].to_numpy()].reset_index(drop=True)
        nominal = self.nominal.drop(columns=["sample"]).reset_index(drop=True)
        return pd.concat(
            [nominal[["climate", "design"]], chosen, nominal.drop(columns=["climate", "design"])], axis=1
        )

    def ranking_table(self) -> pd.DataFrame:
        """The compared designs in order, by climate, with differences from the best and ties."""
        import pandas as pd

        tables = []
        for climate, ranking in self.rankings.items():
            table = ranking.to_dataframe()
            table["design"] = [self.best[k] for k in table["design"]]
            table.insert(0, "rank", np.arange(1, len(table) + 1))
            table.insert(0, "climate", climate)
            labels = self.inputs.choices.labels([self.designs[k] for k in table["design"]])
            for position, (name, column) in enumerate(labels.items(), start=3):
                table.insert(position, name, column)
            tables.append(table)
        return pd.concat(tables, ignore_index=True)

    def summary(self) -> dict[str, Any]:
        """The most important numbers, for JSON."""
        name = self.ranked_by
        summary: dict[str, Any] = {
            "name": self.inputs.file.name,
            "mascarin_version": __version__,
            "designs": len(self.designs),
            "climates": [site.name for site in self.inputs.sites],
            "failed": int(self.nominal["failure"].notna().sum() + self.sampled["failure"].notna().sum()),
            "closure": float(np.nanmax(np.append(self.nominal["closure"], self.sampled["closure"]))),
            "ranked_by": name,
            "unit": self.inputs.objective(name).unit,
            "samples": self.rankings[ALL].samples,
            "ranking": {},
        }
        for climate, ranking in self.rankings.items():
            summary["ranking"][climate] = [
                {
                    "design": self.best[k],
                    "chosen": self.label(self.best[k]),
                    "mean": float(ranking.mean[k]),
                    "spread": float(ranking.spread[k]),
                    "low": float(ranking.low[k]),
                    "high": float(ranking.high[k]),
                    "tied": bool(ranking.tied[k]),
                    "tied_before": bool(ranking.tied_before[k]),
                    "verdict": self.verdict(ranking, int(k)),
                }
                for k in ranking.order
            ]
        summary["warnings"] = list(self.warnings)
        summary["reference"] = {climate: dict(values) for climate, values in self.reference.items()}
        return summary

    def write(self, out: Path) -> list[Path]:
        """Write all tables and the summary; the files have the same bytes whenever the study is run.

        Parameters
        ----------
        out : Path
            The folder.
        """
        tables = {"designs": self.to_dataframe(), "ranking": self.ranking_table(), "samples": self._samples()}
        for name in FILES:
            atomic.remove_drafts_of(out / name)
        written = [
            atomic.write(out / f"{name}.csv", table.to_csv(index=False, lineterminator="\n"))
            for name, table in tables.items()
        ]
        target = out / "designs.parquet"
        with atomic.replacing(target) as file:
            tables["designs"].to_parquet(file, index=False)
        text = json.dumps(self.summary(), indent=1, ensure_ascii=False)
        return [*written, target, atomic.write(out / "design.json", text + "\n")]

    def _samples(self) -> pd.DataFrame:
        """The compared designs with every sample."""
        table = self.sampled.copy()
        table["design"] = np.asarray(self.best)[table["design"].to_numpy()]
        return table


def by_climate(table: pd.DataFrame, objective: str, designs: int) -> dict[str, Array]:
    """An objective by climate, and its mean over them: (designs, samples), or (designs,) without."""
    rows_of: dict[str, Array] = {}
    for climate, part in table.groupby("climate", sort=False):
        values = part[objective].to_numpy(dtype=np.float64)
        failed = part["failure"].notna().to_numpy()
        rows = np.where(failed, np.nan, values).reshape(designs, -1)
        rows_of[str(climate)] = rows[:, 0] if rows.shape[1] == 1 else rows
    rows_of[ALL] = np.mean(list(rows_of.values()), axis=0)
    return rows_of


def shortlist(nominal: pd.DataFrame, objective: str, designs: int, count: int, *, least: bool) -> list[int]:
    """The best nominal designs over all climates and in each of them, the former first.

    Parameters
    ----------
    nominal : pandas.DataFrame
        Objectives by climate and design.
    objective : str
        The objective of the ranking.
    designs, count : int
        Number of designs, and how many of them are wanted.
    least : bool
        Whether small values are good.
    """
    values = by_climate(nominal, objective, designs)
    orders = []
    for climate in (ALL, *[name for name in values if name != ALL]):
        cost = values[climate] if least else -values[climate]
        good = np.flatnonzero(np.isfinite(cost))
        orders.append(good[np.argsort(cost[good], kind="stable")].tolist())
    if not orders[0]:
        reason = nominal["failure"].dropna()
        raise SolverError(
            f"all {designs} designs failed in at least one climate; the first: "
            f"{next(iter(reason), 'no number')}"
        )
    # The best three of each climate are compared too.
    chosen = dict.fromkeys(orders[0][:count])
    for order in orders[1:]:
        chosen |= dict.fromkeys(order[:3])
    return [int(k) for k in chosen]


def rank_all(
    sampled: pd.DataFrame, objective: str, designs: int, *, least: bool, negligible: float
) -> dict[str, Ranking]:
    """Rankings over the samples, of all climates together and of each."""
    values = by_climate(sampled, objective, designs)
    names = [ALL, *[name for name in values if name != ALL]]
    return {
        name: ranked(values[name].reshape(designs, -1), least=least, negligible=negligible) for name in names
    }
