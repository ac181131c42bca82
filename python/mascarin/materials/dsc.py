"""A material from a calorimeter file: its curve as a table, fitted laws, heating and cooling compared."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from mascarin.errors import InputError
from mascarin.materials.dsc_course import crystallisation_time
from mascarin.materials.dsc_file import DscSettings, read
from mascarin.materials.dsc_melting import MeasuredMelting, melting_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy.typing as npt
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mascarin.figures.melting import Analysis, CapacityCurve
    from mascarin.materials.laws import LawFit

    Array = npt.NDArray[np.float64]

MOST_POINTS: Final = 60
"""Points of the curve in a description."""


@dataclass(frozen=True)
class DscMaterial:
    """A material as measured by a calorimeter.

    Attributes
    ----------
    name : str
        Name of the file, without its ending.
    runs : tuple of MeasuredMelting
        Heating first.
    warnings : tuple of str
        Warnings, and decisions that were made for the user.

    Examples
    --------
    >>> DscMaterial("wax", runs=(), warnings=()).name
    'wax'
    """

    name: str
    runs: tuple[MeasuredMelting, ...]
    warnings: tuple[str, ...]

    @property
    def main(self) -> MeasuredMelting:
        """The run whose curve the material uses: heating where there is one."""
        return self.runs[0]

    def description(
        self,
        law: str = "table",
        *,
        conductivity: float | tuple[float, float] | None = None,
        density: float | tuple[float, float] | None = None,
        supercooling: bool = False,
    ) -> dict[str, Any]:
        """The material as in a building file.

        Parameters
        ----------
        law : str
            ``table`` (the curve as measured) or the name of a fitted law.
        conductivity, density : float or pair, optional
            A calorimeter does not measure them; without them the description is not complete.
            [W/(m K), kg/m3]
        supercooling : bool
            Whether it freezes as the cooling run shows: late, and with a speed of its own. The law is then
            the best of the fitted ones where ``law`` is ``table``.

        Raises
        ------
        InputError
            There is no such law, or the runs do not show how the sample freezes.
        """
        from mascarin.errors import did_you_mean

        run = self.main
        if supercooling and law == "table":
            law = run.fits[0].law.name  # a law with a state needs a formula
        stated = {"conductivity": conductivity, "density": density}
        plain: dict[str, Any] = {"kind": "pcm"}
        plain |= {key: _listed(value) for key, value in stated.items() if value is not None}
        plain["specific_heat"] = [round(heat, 1) for heat in run.specific_heat]
        if law == "table":
            temperatures, enthalpies = table(run)
            start, end = (round(x, 3) for x in run.melting_range)
            plain["law"] = {
                "kind": "table",
                "temperatures": temperatures,
                "enthalpies": enthalpies,
                "melting_range": [start, end],
            }
        else:
            fits_by_law = {law_fit.law.name: law_fit for law_fit in run.fits}
            if law not in fits_by_law:
                laws = ("table", *fits_by_law)
                raise InputError(f"law: found '{law}'; expected a law. {did_you_mean(law, laws)}")
            plain["latent_heat"] = round(run.latent_heat)
            plain["melting_temperature"] = round(fits_by_law[law].melting_temperature, 3)
            plain["law"] = fits_by_law[law].description()
            if supercooling:
                plain["hysteresis"] = self._supercooling(fits_by_law[law])
        plain["source"] = f"DSC, {run.direction}" + (f" at {run.rate:g} K/min" if run.rate else "")
        return plain

    def _supercooling(self, law_fit: LawFit) -> dict[str, Any]:
        """The law of freezing by the cooling run, beside the melting curve of the heating run."""
        cooling = next((run for run in self.runs if run.direction == "cooling"), None)
        if self.main.direction != "heating" or cooling is None or cooling.course is None:
            raise InputError(
                f"supercooling: found {' and '.join(run.direction for run in self.runs)}"
                f"{'' if cooling is None else ', cooling without a heat flow over time'}; expected a heating "
                "run, and a cooling run with columns of heat flow and time, in one file. Export both with "
                "their times"
            )
        if cooling.freezing is None:
            raise InputError(
                "supercooling: found a cooling run in which the temperature does not rise; expected a sample "
                "that supercools. Leave the option out"
            )
        course, nucleation = cooling.course, cooling.freezing[0]
        melting = law_fit.melting_temperature
        # The heating run is nearer to equilibrium: its heats say what is liquid.
        fraction = course.liquid_fraction(self.main.specific_heat, self.main.latent_heat, self.main.half)
        seconds = crystallisation_time(
            course, fraction, nucleation, lambda t: law_fit.law.fraction(t, melting, law_fit.widths)
        )
        return {
            "model": "supercooling",
            "degree": round(melting - nucleation, 3),
            "time_constant": float(f"{seconds:.3g}"),
        }

    def report(self) -> str:
        """Results and residuals of each law, as text."""
        lines = [line for run in self.runs for line in _lines(run)]
        return "\n".join([*lines, *(f"warning: {text}" for text in self.warnings)])

    def to_dict(self) -> dict[str, Any]:
        """Results as mappings and lists, in SI units."""
        return {
            "runs": {run.direction: _summary(run) for run in self.runs},
            "warnings": list(self.warnings),
        }

    def plot(self, *, ax: Sequence[Axes] | None = None) -> Figure:
        """Plot the runs and the best law: enthalpy above, apparent specific heat below.

        Below also the sensible heat that was taken as the baseline, and onset and end.

        Parameters
        ----------
        ax : sequence of two matplotlib.axes.Axes, optional
            Where to draw; a new figure when absent.

        Returns
        -------
        matplotlib.figure.Figure
            The figure of the axes; ``savefig`` writes it to a file.
        """
        from mascarin.figures import melting

        figure = melting.draw([curve for n, run in enumerate(self.runs) for curve in _curves(n, run)], ax)
        below = figure.axes[1] if ax is None else ax[1]  # an array of `subplots` has no truth value
        melting.draw_analysis(below, [_analysis(n, run) for n, run in enumerate(self.runs)])
        return figure


def from_dsc(
    path: str | Path,
    *,
    unit: str | None = None,
    rate: float | None = None,
    mass: float | None = None,
    specific_heat: tuple[float, float] | None = None,
    melting_range: tuple[float, float] | None = None,
    segments: Sequence[str | int] = (),
) -> DscMaterial:
    r"""Make a material from a calorimeter file.

    The file is an export of a calorimeter (NETZSCH Proteus, Mettler STARe, TA Universal Analysis, TRIOS), or
    CSV with named columns: a temperature, and a heat flow, an apparent specific heat or an enthalpy, units in
    the names (``temperature [degC]``, ``DSC/(mW/mg)``, ``cp heating [J/(g K)]``).
    Heating and cooling are in different columns, or one after the other, or distinguished by a column
    ``direction``.

    Parameters
    ----------
    path : str or Path
        The file.
    unit : str, optional
        Unit of the signal, where the file has none or a wrong one.
    rate : float, optional
        Heating rate, for a heat flow without a column of time. [K/min]
    mass : float, optional
        Mass of the sample, for the heat flow of the whole sample. [mg]
    specific_heat : tuple of float, optional
        Of solid and liquid, where the baseline was subtracted. [J/(kg K)]
    melting_range : tuple of float, optional
        First and last temperature of melting; outside there is only sensible heat. [degC]
    segments : sequence of str or int, optional
        Segments of the file that are used, such as that of the second heating; default: all that heat or
        cool.

    Returns
    -------
    DscMaterial
        Curves, latent heat, onset, peak and end, laws with their residuals, warnings.

    Raises
    ------
    InputError
        Columns, units or rows are not plausible.

    Examples
    --------
    >>> import math, tempfile
    >>> rows = ["temperature [degC],cp [J/(g K)]"]
    >>> for k in range(281):  # 150 kJ/kg about 24 degC, 2.0 J/(g K)
    ...     t = 10 + 0.1 * k
    ...     rows.append(f"{t:.1f},{2 + 150 * 0.5 / 0.8 / math.cosh((t - 24) / 0.8) ** 2:.4f}")
    >>> file = Path(tempfile.mkdtemp()) / "wax.csv"
    >>> size = file.write_text("\n".join(rows))
    >>> wax = from_dsc(file)
    >>> round(wax.main.latent_heat, -3), wax.main.fits[0].law.name
    (150000.0, 'tanh')
    """
    file = Path(path)
    for name, value in (("rate", rate), ("mass", mass)):
        if value is not None and not value > 0.0:
            raise InputError(f"{name}: found {value:g}; expected a positive number")
    scans = read(file, DscSettings(unit, rate, mass, tuple(map(str, segments))))
    evaluated = [melting_of(scan, specific_heat, melting_range, scan.location) for scan in scans]
    runs = tuple(sorted((run for run, _ in evaluated), key=lambda run: run.direction != "heating"))
    remarks = [remark for scan in scans for remark in scan.remarks]
    remarks += [remark for _, notes in evaluated for remark in notes]
    return DscMaterial(file.stem, runs, (*dict.fromkeys(remarks), *_compared(runs)))


def table(run: MeasuredMelting) -> tuple[list[float], list[float]]:
    """Enthalpy over temperature as a law of a building file: rising, with at most `MOST_POINTS` points.

    Parameters
    ----------
    run : MeasuredMelting
        The run.

    Returns
    -------
    tuple of lists
        Temperatures [degC] and enthalpies above the first [J/kg].
    """
    low, high = run.melting_range
    t, fraction = run.temperature, run.fraction
    levels = np.interp(np.linspace(0.0, 1.0, MOST_POINTS // 2), fraction, t)
    even = np.linspace(max(low - 1.0, t[0]), min(high + 1.0, t[-1]), MOST_POINTS // 2)
    points = np.unique(np.round(np.concatenate([levels, even]), 2))
    points = points[(points >= even[0]) & (points <= even[-1])]
    xi = np.interp(points, t, fraction)
    solid, liquid = run.specific_heat
    above = points - run.half
    values = solid * above + xi * (run.latent_heat + (liquid - solid) * above)
    return [round(float(x), 2) for x in points], [round(float(x - values[0]), 1) for x in values]


def _compared(runs: Sequence[MeasuredMelting]) -> list[str]:
    """Warnings from the comparison of heating and cooling."""
    if len(runs) < 2:
        return []
    heating, cooling = runs
    lines = []
    apart = abs(heating.latent_heat - cooling.latent_heat) / heating.latent_heat
    if apart > 0.05:
        lines.append(
            f"latent heat on heating and cooling differ by {apart:.0%}: different integration limits, or "
            "a run that did not melt or freeze everything"
        )
    if cooling.freezing is not None:
        begins, rise = cooling.freezing
        lines.append(
            f"supercooling: freezing begins at {begins:.2f} degC, {heating.onset - begins:.2f} K "
            f"below the onset of "
            f"melting ({heating.onset:.2f} degC), and the sample warms by {rise:.2f} K (recalescence)"
        )
    gap = heating.half - cooling.half
    if gap > 0.5:
        lines.append(
            f"freezes {gap:.1f} K below where it melts: hysteresis, supercooling, or the lag of the runs"
        )
    if gap < 0.0:
        lines.append(
            f"freezes {-gap:.1f} K above where it melts, which is not possible: check temperatures and lag"
        )
    return lines


def _lines(run: MeasuredMelting) -> list[str]:
    rate = f" at {run.rate:g} K/min" if run.rate else ""
    low, high = run.melting_range
    return [
        f"{run.direction}{rate}",
        f"  latent heat    {run.latent_heat / 1000.0:.1f} kJ/kg",
        f"  specific heat  {run.specific_heat[0]:.0f} solid, {run.specific_heat[1]:.0f} liquid J/(kg K)",
        f"  onset, peak, end  {run.onset:.2f}, {run.peak:.2f}, {run.end:.2f} degC; half at {run.half:.2f} "
        "degC",
        f"  range          {low:.2f} to {high:.2f} degC",
        "  law                 rms of liquid fraction  largest  melting temperature, width",
        *(
            f"  {law_fit.law.name:18}  {law_fit.residual:22.4f}  {law_fit.largest:7.4f}  "
            f"{law_fit.melting_temperature:.2f} degC, {', '.join(f'{w:.2f} K' for w in law_fit.widths)}"
            for law_fit in run.fits
        ),
    ]


def _summary(run: MeasuredMelting) -> dict[str, Any]:
    return {
        "latent_heat": run.latent_heat,
        "specific_heat": list(run.specific_heat),
        "onset": run.onset,
        "peak": run.peak,
        "end": run.end,
        "half": run.half,
        "melting_range": list(run.melting_range),
        "rate": run.rate,
        "freezing": None if run.freezing is None else {"begins": run.freezing[0], "rise": run.freezing[1]},
        "fits": {
            law_fit.law.name: {
                "rms": law_fit.residual,
                "largest": law_fit.largest,
                "melting_temperature": law_fit.melting_temperature,
                "law": law_fit.description(),
            }
            for law_fit in run.fits
        },
    }


def _listed(value: float | tuple[float, float]) -> float | list[float]:
    return [float(x) for x in value] if isinstance(value, tuple | list) else float(value)


def _analysis(number: int, run: MeasuredMelting) -> Analysis:
    """What was done to the signal of a run."""
    from mascarin.figures import melting

    solid, liquid = run.specific_heat
    baseline = solid + (liquid - solid) * run.fraction
    return melting.Analysis(number, run.temperature, baseline, (run.onset, run.end))


def _curves(number: int, run: MeasuredMelting) -> Iterator[CapacityCurve]:
    """The measured curve of a run, and that of its best law."""
    from mascarin.figures import melting

    best = run.fits[0]
    for fraction, style, label in (
        (run.fraction, "-", run.direction),
        (best.law.fraction(run.temperature, best.melting_temperature, best.widths), ":", best.law.name),
    ):
        solid, liquid = run.specific_heat
        over = run.temperature - run.half
        h = solid * over + fraction * (run.latent_heat + (liquid - solid) * over)
        heat = run.heat if style == "-" else np.gradient(h, run.temperature)
        yield melting.CapacityCurve(label, number, style, run.temperature, h - h[0], run.temperature, heat)
