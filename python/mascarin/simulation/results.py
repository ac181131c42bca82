"""What a run leaves behind: labelled series, the energy ledger, and where it all came from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from mascarin import __version__
from mascarin.errors import InputError, did_you_mean

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr

    from mascarin.building import Output

    Array = npt.NDArray[np.float64]

FLOWS: Final = (
    "solar",
    "convection",
    "longwave",
    "boundary",
    "infiltration",
    "ventilation",
    "interzone",
    "gains",
    "heating",
    "cooling",
    "transmitted",
    "glass",
)
"""Ways in which heat enters a building; cooling takes it out, as a negative number."""


@dataclass(frozen=True)
class EnergyLedger:
    """Where heat came from over a run, and whether the books close.

    Attributes
    ----------
    into : mapping of str to float
        Net heat into the building by flow. [J]
    stored : float
        Rise of the heat stored in walls and air. [J]
    turnover : float
        Sum of the magnitudes of all flows. [J]
    closure : float
        Sum over steps of |stored - into|, over the turnover. [-]
    """

    into: Mapping[str, float]
    stored: float
    turnover: float
    closure: float

    @classmethod
    def read(cls, raw: Mapping[str, Any]) -> Self:
        """From what the engine returns."""
        into = {flow: float(raw[flow]) for flow in FLOWS}
        return cls(into, float(raw["stored"]), float(raw["turnover"]), float(raw["closure"]))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON."""
        into = {f"{flow}_joule": value for flow, value in self.into.items()}
        return {
            "closure": self.closure,
            "stored_joule": self.stored,
            "turnover_joule": self.turnover,
            **into,
        }

    def __str__(self) -> str:
        lines = [f"{flow:<14}{value / 3.6e6:>12.3f} kWh" for flow, value in self.into.items()]
        return "\n".join(
            [*lines, f"{'stored':<14}{self.stored / 3.6e6:>12.3f} kWh", f"closure {self.closure:.1e}"]
        )


@dataclass(frozen=True)
class Provenance:
    """Everything that made a run.

    Attributes
    ----------
    building : str
        Name of the building.
    building_hash : str
        SHA-256 of the description the engine got.
    climate : dict
        File, hash, period and conversions of the climate.
    step_seconds : float
        Time step. [s]
    scheme : str
        Time-stepping scheme.
    start : str
        How the run was started.
    changed : mapping of str to float
        Parameters that differ from the description. [unit of each]
    newton_iterations : int
        Newton iterations over all stages.
    nested_stages : int
        Stages that only the nested iteration of Casulli & Zanolli solved.
    halved_steps : int
        Steps, or parts of steps, that had to be halved.
    reversals : int
        How often a phase-change cell with hysteresis melted and froze within one step: its memory, which
        changes at the end of a step, saw only the sum. A shorter step makes it smaller.
    version : str
        Version of Mascarin.
    """

    building: str
    building_hash: str
    climate: Mapping[str, Any]
    step_seconds: float
    scheme: str
    start: str
    changed: Mapping[str, float]
    newton_iterations: int
    nested_stages: int = 0
    halved_steps: int = 0
    reversals: int = 0
    version: str = field(default=__version__)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "mascarin_version": self.version,
            "building": self.building,
            "building_sha256": self.building_hash,
            "climate": dict(self.climate),
            "step_seconds": self.step_seconds,
            "scheme": self.scheme,
            "start": self.start,
            "changed": dict(self.changed),
            "newton_iterations": self.newton_iterations,
            "nested_stages": self.nested_stages,
            "halved_steps": self.halved_steps,
            "reversals": self.reversals,
        }


@dataclass(frozen=True, eq=False)
class Results:
    """Series of a run, by output name.

    Attributes
    ----------
    outputs : sequence of Output
        What was recorded.
    index : pandas.DatetimeIndex
        Times with their zone, shape (rows,): the state at the start, then at the end of every step.
    records : ndarray, shape (rows, outputs)
        Values. [unit of each output]
    energy : EnergyLedger
        The energy ledger.
    provenance : Provenance
        Version, inputs and options.
    warnings : tuple of str
        Phase-change layers that neither melted nor froze.
    """

    outputs: Sequence[Output]
    index: pd.DatetimeIndex
    records: Array
    energy: EnergyLedger
    provenance: Provenance
    warnings: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> xr.DataArray:
        """One series, labelled with UTC times.

        Raises
        ------
        InputError
            It was not recorded; the text names the nearest ones.
        """
        import xarray as xr

        position = self._position(name)
        output = self.outputs[position]
        return xr.DataArray(
            self.records[:, position],
            coords={"time": self._utc()},
            dims="time",
            name=output.name,
            attrs={"units": output.unit, "long_name": output.name, "timezone": str(self.index.tz)},
        )

    def __iter__(self) -> Iterator[str]:
        return (output.name for output in self.outputs)

    def __len__(self) -> int:
        return len(self.outputs)

    def every(self, interval: str | float) -> Results:
        """The same series at another spacing, from the start of the run.

        Parameters
        ----------
        interval : str or float
            Spacing, such as ``1h`` or seconds. [s]

        Returns
        -------
        Results
            States interpolated to the new times. A heat flux or load at a time is its mean over the interval
            that ends there, so that its sum keeps the heat; that of the first time is the first recorded one.

        Raises
        ------
        InputError
            The interval is no positive time or longer than the run.
        """
        import numpy as np
        import pandas as pd

        from mascarin.weather.times import seconds_of

        seconds = seconds_of(interval, "interval")
        place = np.asarray((self.index - self.index[0]).total_seconds(), dtype=np.float64)
        times = np.arange(0.0, place[-1] + 1e-6, seconds)
        if len(times) < 2:
            raise InputError(f"interval: found {interval!r}; expected a time shorter than the run")
        columns = [
            _means(place, self.records[:, k], times)
            if output.mean
            else np.interp(times, place, self.records[:, k])
            for k, output in enumerate(self.outputs)
        ]
        index = self.index[0] + pd.to_timedelta(times, unit="s")
        return replace(self, index=index, records=np.stack(columns, axis=-1))

    def hourly(self, name: str) -> pd.Series[float]:
        """Means of one series over whole hours.

        Parameters
        ----------
        name : str
            Output.

        Returns
        -------
        pandas.Series
            By the start of each hour, in the local time of the climate; hours that the run covers in full. A
            load or flux counts as the mean of its step, a state as a straight line between its records.
            [unit of the output; the mean of a load in W over an hour is its heat in Wh]

        Raises
        ------
        InputError
            It was not recorded, or the run covers no whole hour.
        """
        import numpy as np
        import pandas as pd

        position = self._position(name)
        output, values = self.outputs[position], self.records[:, position]
        place = np.asarray((self.index - self.index[0]).total_seconds(), dtype=np.float64)
        first = self.index[0].ceil("h", ambiguous=True, nonexistent="shift_forward")
        early = (first - self.index[0]).total_seconds()
        times = np.arange(early, place[-1] + 1e-6, 3600.0)
        if len(times) < 2:
            raise InputError(
                f"{name}: the run covers no whole hour; expected one from full hour to full hour"
            )
        means = (_means(place, values, times) if output.mean else _state_means(place, values, times))[1:]
        index = first + pd.to_timedelta(times[:-1] - early, unit="s")
        return pd.Series(means, index=index, name=output.name)

    def heat(self, name: str) -> float:
        """Heat of a load over the run. [J]

        Raises
        ------
        InputError
            It was not recorded, or is no load in W.
        """
        import numpy as np

        position = self._position(name)
        if self.outputs[position].unit != "W":
            raise InputError(
                f"{name}: found a quantity in {self.outputs[position].unit}; expected a load in W, such as "
                "a zone's heating_load"
            )
        seconds = np.diff(np.asarray((self.index - self.index[0]).total_seconds(), dtype=np.float64))
        return float(np.sum(self.records[1:, position] * seconds))

    def frame(self) -> pd.DataFrame:
        """All series as a table in local time, one column an output."""
        import pandas as pd

        return pd.DataFrame(self.records, index=self.index, columns=[output.name for output in self.outputs])

    def dataset(self) -> xr.Dataset:
        """All series as an xarray data set, with provenance and ledger among its attributes."""
        import json

        import xarray as xr

        attributes = {
            "mascarin_version": self.provenance.version,
            "provenance": json.dumps(self.provenance.to_dict()),
            "energy": json.dumps(self.energy.to_dict()),
            "timezone": str(self.index.tz),
        }
        return xr.Dataset({name: self[name] for name in self}, attrs=attributes)

    def to_netcdf(self, path: str | Path) -> None:
        """Write everything to a NetCDF file.

        Raises
        ------
        OSError
            The file cannot be written.
        """
        self.dataset().to_netcdf(path, engine="h5netcdf")

    def plot(self, names: Sequence[str] | None = None) -> Any:
        """Draw series over local time, one axis a unit.

        Parameters
        ----------
        names : sequence of str, optional
            Default: all.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.
        """
        from matplotlib.figure import Figure

        positions = [self._position(name) for name in (names or list(self))]
        units = list(dict.fromkeys(self.outputs[p].unit for p in positions))
        figure = Figure(figsize=(9.0, 2.8 * len(units) + 0.6), layout="constrained")
        axes = figure.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0]
        local = self.index.tz_localize(None)
        for axis, unit in zip(axes, units, strict=True):
            for position in positions:
                if self.outputs[position].unit == unit:
                    axis.plot(local, self.records[:, position], label=self.outputs[position].name, lw=1.1)
            axis.set_ylabel(unit)
            axis.legend(fontsize="small")
            axis.grid(alpha=0.3)
        axes[-1].set_xlabel(f"local time ({self.index.tz})")
        return figure

    def _utc(self) -> pd.DatetimeIndex:
        return self.index.tz_convert("UTC").tz_localize(None)

    def _position(self, name: str) -> int:
        for position, output in enumerate(self.outputs):
            if name == output.name or name in output.aliases:
                return position
        known = [output.name for output in self.outputs]
        raise InputError(
            f"{name}: not recorded in this run; name it in outputs=. {did_you_mean(name, known)}".rstrip()
        )


def _means(place: Array, values: Array, times: Array) -> Array:
    """Means over the intervals that end at the times, of a flux recorded at the end of each step."""
    import numpy as np

    # A recorded flux stands for the step that it ends.
    heat = np.concatenate([[0.0], np.cumsum(values[1:] * np.diff(place))])
    at = np.interp(times, place, heat)
    return np.concatenate([values[:1], np.diff(at) / np.diff(times)])


def _state_means(place: Array, values: Array, times: Array) -> Array:
    """Means over the intervals that end at the times, of a state on straight lines between its records."""
    import numpy as np

    # Two rising runs: a stable sort merges them.
    points = np.sort(np.concatenate([place, times]), kind="stable")
    points = points[np.append(True, np.diff(points) > 0.0)]
    level = np.interp(points, place, values)
    sums = np.concatenate([[0.0], np.cumsum(0.5 * (level[1:] + level[:-1]) * np.diff(points))])
    at = np.interp(times, points, sums)
    return np.concatenate([values[:1], np.diff(at) / np.diff(times)])
