"""The series of a run by name, with their units, times, energy balance and provenance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from mascarin._io import display
from mascarin._io.durations import seconds_of
from mascarin._io.sealed.own_files import json_of, require
from mascarin.errors import InputError, did_you_mean
from mascarin.simulation.checks.energy import EnergyLedger
from mascarin.simulation.checks.judgement import Judgement
from mascarin.simulation.checks.vapour import VapourLedger
from mascarin.simulation.checks.warning_kinds import RunWarning, warnings_of
from mascarin.simulation.records import files, labels
from mascarin.simulation.records.provenance import Provenance
from mascarin.simulation.records.resample import means, state_means
from mascarin.simulation.records.times import Times
from mascarin.simulation.run_summary import Finished

if TYPE_CHECKING:
    import numpy.typing as npt
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mascarin.building import Building, Output
    from mascarin.comfort import Comfort, ComfortSettings
    from mascarin.weather import Climate

    Array = npt.NDArray[np.float64]

Default = TypeVar("Default")

#: Series that the figure in a notebook shows.
_MAX_CURVES: Final = 8


@dataclass(frozen=True, eq=False, repr=False)
class Results(Mapping[str, "xr.DataArray"]):
    """The series of a run, a mapping from the names of outputs to series.

    ``results["room.air_temperature"]`` is an xarray.DataArray over ``time`` (UTC) with the coordinate
    ``local_time``; its `sel` takes times with an offset. Names and aliases of outputs are keys.

    Parameters
    ----------
    outputs : sequence of Output
        What was recorded.
    times : Times
        Times of the records: the state at the start, then at the end of every step.
    records : ndarray, shape (rows, outputs)
        Values. [unit of each output]
    energy : EnergyLedger
        The energy balance.
    provenance : Provenance
        Version, inputs and options.
    warnings : tuple of RunWarning
        Texts with their `kind`: a balance of heat or vapour that does not close; temperatures without a
        cause; phase-change layers that neither melted nor froze; a time step that is too long.
    vapour : VapourLedger or None
        The vapour balance of a building with humidity.
    judgement : Judgement or None
        Temperatures against their causes; None for a run of an earlier version.

    Examples
    --------
    >>> import mascarin as mc
    >>> from mascarin.examples import box, box_climate
    >>> run = mc.simulate(box(), box_climate(), step="1h")
    >>> "room.air_temperature" in run
    True
    >>> run.to_dataframe().columns[0]
    'room.air_temperature'
    """

    outputs: Sequence[Output]
    times: Times
    records: Array
    energy: EnergyLedger
    provenance: Provenance
    warnings: tuple[RunWarning, ...] = ()
    vapour: VapourLedger | None = None
    judgement: Judgement | None = None

    @property
    def sound(self) -> bool:
        """Whether the balances of heat and vapour close and temperatures have causes; see `warnings`."""
        return self._finished.sound

    @property
    def _finished(self) -> Finished:
        return Finished(self.energy, self.provenance, self.warnings, self.vapour, self.judgement)

    @property
    def index(self) -> pd.DatetimeIndex:
        """Local times with their zone, shape (rows,)."""
        return self.times.index

    def __getitem__(self, name: str) -> xr.DataArray:
        """One series by the name or alias of its output.

        Raises
        ------
        InputError
            It was not recorded; the text names the nearest ones.
        """
        from mascarin.simulation.records.series import RunSeries

        position = self._position(name)
        output = self.outputs[position]
        return RunSeries(
            self.records[:, position],
            coords=labels.time_coordinates(self.index),
            dims="time",
            name=output.name,
            attrs={"units": output.unit, "long_name": output.name, "timezone": str(self.index.tz)},
        )

    def __iter__(self) -> Iterator[str]:
        return (output.name for output in self.outputs)

    def __len__(self) -> int:
        return len(self.outputs)

    def __contains__(self, name: object) -> bool:
        return any(name == output.name or name in output.aliases for output in self.outputs)

    def get(self, name: str, default: Default | None = None) -> xr.DataArray | Default | None:  # type: ignore[override]
        """One series, or the default where it was not recorded.

        Parameters
        ----------
        name : str
            Name or alias of the output.
        default : object, optional
            What to return where it was not recorded.
        """
        return self[name] if name in self else default  # noqa: SIM401 (this is get itself)

    def __eq__(self, other: object) -> bool:
        """Whether two results hold the same values, times, units, energy balance, provenance and warnings."""
        if not isinstance(other, Results):
            return NotImplemented
        return (
            tuple(self.outputs) == tuple(other.outputs)
            and self.index.equals(other.index)
            and str(self.index.tz) == str(other.index.tz)
            and self.records.shape == other.records.shape
            and self.records.tobytes() == other.records.tobytes()
            and self.energy == other.energy
            and self.vapour == other.vapour
            and self.judgement == other.judgement
            and self.provenance.to_dict() == other.provenance.to_dict()
            and self.warnings == other.warnings
        )

    __hash__ = None  # type: ignore[assignment]

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
        import pandas as pd

        elapsed = self.times.since_start
        times = np.arange(0.0, elapsed[-1] + 1e-6, seconds_of(interval, "interval"))
        if len(times) < 2:
            raise InputError(f"interval: found {interval!r}; expected a time shorter than the run")
        columns = [
            means(elapsed, self.records[:, k], times)
            if output.mean
            else np.interp(times, elapsed, self.records[:, k])
            for k, output in enumerate(self.outputs)
        ]
        index = Times.of(self.index[0] + pd.to_timedelta(times, unit="s"))
        return replace(self, times=index, records=np.stack(columns, axis=-1))

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
        import pandas as pd

        position = self._position(name)
        output, values = self.outputs[position], self.records[:, position]
        elapsed = self.times.since_start
        first = self.index[0].ceil("h", ambiguous=True, nonexistent="shift_forward")
        early = (first - self.index[0]).total_seconds()
        times = np.arange(early, elapsed[-1] + 1e-6, 3600.0)
        if len(times) < 2:
            raise InputError(
                f"{name}: the run covers no whole hour; expected one from full hour to full hour"
            )
        hourly = (means if output.mean else state_means)(elapsed, values, times)[1:]
        return pd.Series(hourly, first + pd.to_timedelta(times[:-1] - early, unit="s"), name=output.name)

    def heat(self, name: str) -> float:
        """Heat of a load over the run. [J]

        Parameters
        ----------
        name : str
            Output in W, such as ``room.heating_load``.

        Raises
        ------
        InputError
            It was not recorded, or is no load in W.
        """
        position = self._position(name)
        if self.outputs[position].unit != "W":
            raise InputError(
                f"{name}: found a quantity in {self.outputs[position].unit}; expected a load in W, such as "
                "a zone's heating_load"
            )
        return float(np.sum(self.records[1:, position] * np.diff(self.times.since_start)))

    def to_dataframe(self) -> pd.DataFrame:
        """All series as a table over local time, one column an output.

        Examples
        --------
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> mc.simulate(box(), box_climate(), step="1h").to_dataframe().index.tz is not None
        True
        """
        import pandas as pd

        names = [output.name for output in self.outputs]
        return pd.DataFrame(self.records, index=self.index.rename("time"), columns=names)

    def to_xarray(self) -> xr.Dataset:
        """All series as an xarray data set, with provenance and energy balance among its attributes.

        Returns
        -------
        xarray.Dataset
            Each output over ``time`` (UTC), with the coordinate ``local_time`` (local clock) and the
            attribute ``timezone``. Its `sel`, and that of its series, takes times with an offset.

        Examples
        --------
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> sorted(mc.simulate(box(), box_climate(), step="1h").to_xarray().coords)
        ['local_time', 'time']
        """
        from mascarin.simulation.records.series import RunDataset

        return RunDataset({name: self[name] for name in self}, attrs=self._attributes())

    def _attributes(self) -> dict[str, Any]:
        """Version, provenance, energy balance and outputs, as files hold them."""
        return self._finished.attributes(self.outputs, self.times.timezone)

    def to_netcdf(self, path: str | Path) -> None:
        """Write everything to a NetCDF file, which appears when it is complete.

        Parameters
        ----------
        path : str or Path
            The file; one that exists is replaced.

        Raises
        ------
        OSError
            The file cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> run = mc.simulate(box(), box_climate(), step="1h")
        >>> file = Path(tempfile.mkdtemp()) / "run.nc"
        >>> run.to_netcdf(file)
        >>> mc.Results.open(file) == run
        True
        """
        self._write(Path(path), ".nc")

    def write(self, path: str | Path) -> None:
        """Write everything to a file, which appears when it is complete; `open` reads it again.

        Parameters
        ----------
        path : str or Path
            NetCDF (.nc), or in local time CSV (.csv; units and provenance in a file beside it) or .parquet.

        Raises
        ------
        InputError
            Another ending, or pyarrow is not installed.

        Examples
        --------
        >>> import tempfile
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> run = mc.simulate(box(), box_climate(), step="1h")
        >>> file = Path(tempfile.mkdtemp()) / "run.csv"
        >>> run.write(file)
        >>> mc.Results.open(file) == run
        True
        """
        target = Path(path)
        files.require_ending(target, str(target))
        self._write(target, target.suffix.lower())

    def _write(self, path: Path, ending: str) -> None:
        with files.drafted(path, self.outputs, self.times, ending) as draft:
            draft.take(self.records)
            draft.finish(self._attributes())

    @classmethod
    def open(cls, path: str | Path) -> Results:
        """Read what `write` or `to_netcdf` wrote.

        Parameters
        ----------
        path : str or Path
            The file: NetCDF, CSV with the file beside it, or Parquet.

        Returns
        -------
        Results
            Equal to those that were written.

        Raises
        ------
        InputError
            There is no such file, or it was not written by a run.
        """
        records, index, attributes = files.read(Path(path))
        try:
            return cls(
                outputs=[_output(fields) for fields in json_of(attributes["outputs"])],
                times=Times.of(index),
                records=records,
                energy=EnergyLedger.from_dict(json_of(attributes["energy"])),
                provenance=Provenance.from_dict(json_of(attributes["provenance"])),
                warnings=tuple(warnings_of(attributes)),
                vapour=VapourLedger.from_json(attributes.get("vapour")),
                judgement=Judgement.from_json(attributes.get("judgement")),
            )
        except (LookupError, ValueError, TypeError, AttributeError, RecursionError) as error:
            text = f"found a damaged description of a run ({error}); expected what was written. Run it again"
            raise InputError(f"{path}: {text}") from None

    def plot(
        self, names: Sequence[str] | str | None = None, ax: Axes | Sequence[Axes] | None = None
    ) -> Figure:
        """Draw series over local time.

        Parameters
        ----------
        names : sequence of str, optional
            Default: all.
        ax : matplotlib.axes.Axes or sequence of them, optional
            Where to draw: one for each unit, or one for all. Default: a new figure with one for each unit.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            A name that was not recorded, or a number of axes that is neither one nor that of the units.

        Examples
        --------
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> figure = mc.simulate(box(), box_climate(), step="1h").plot(["room.air_temperature"])
        >>> figure.axes[0].get_ylabel()
        '[°C]'
        """
        from mascarin.figures.series import draw  # matplotlib

        chosen = [names] if isinstance(names, str) else list(self) if names is None else names
        positions = [self._position(name) for name in chosen]
        series = [(self.outputs[p].name, self.outputs[p].unit, self.records[:, p]) for p in positions]
        return draw(series, self.index, ax)

    def comfort(
        self,
        zone: str | None = None,
        climate: Climate | None = None,
        settings: ComfortSettings | None = None,
        building: Building | None = None,
        **keys: Any,
    ) -> Comfort:
        """Assess the thermal comfort in a zone.

        Parameters
        ----------
        zone : str, optional
            The zone. Default: the only one whose temperatures were recorded.
        climate : Climate, optional
            The weather of the run, for adaptive comfort and for ``humidity="outdoor"``.
        settings : ComfortSettings, optional
            How comfort is assessed.
        building : Building, optional
            The building of the run, for the view from a ``seat``.
        **keys : object
            In place of `settings`, its keys: index, category, band, humidity, air_speed, ...

        Returns
        -------
        Comfort
            Hours and degree-hours of discomfort, tables and figures.

        Raises
        ------
        InputError
            A series that is needed was not recorded, or something that the index needs is not known.

        Examples
        --------
        >>> import mascarin as mc
        >>> from mascarin.examples import box, box_climate
        >>> run = mc.simulate(box(), box_climate(), step="1h", outputs=["room.operative_temperature"])
        >>> run.comfort(index="operative", band=[18, 28]).zone
        'room'
        """
        from mascarin.comfort import ComfortSettings
        from mascarin.simulation.comfort import comfort_of

        chosen = settings or ComfortSettings(**keys)
        return comfort_of(self.outputs, self.records, self.index, zone, climate, chosen, building)

    def __repr__(self) -> str:
        return display.text(f"Results of '{self.provenance.building}'", self._rows())

    def _repr_html_(self) -> str:
        return display.page(
            f"Results of '{self.provenance.building}'",
            self._rows(),
            tables={"Statistics": self.to_dataframe().describe().T} if len(self) else {},
            figures={"Plot": self.plot(list(self)[:_MAX_CURVES])} if len(self) else {},
        )

    def _rows(self) -> list[tuple[str, str]]:
        return labels.rows([*self], self.index, self.provenance, self.energy.relative_residual, self.warnings)

    def _position(self, name: str) -> int:
        for position, output in enumerate(self.outputs):
            if name == output.name or name in output.aliases:
                return position
        hint = did_you_mean(name, list(self))
        raise InputError(f"{name}: not recorded in this run; name it in outputs=. {hint}".rstrip())


def _output(fields: Mapping[str, Any]) -> Output:
    from mascarin.building import Output  # pydantic, which an evaluation for GenOpt does without

    require(fields, {"name": str, "unit": str, "kind": str, "aliases": list})
    return Output(**{**fields, "aliases": tuple(fields["aliases"])})
