"""The indices of comfort by name: what each needs, its limits, its validity and its source."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

from mascarin.comfort import adaptive, givoni, heat_balance
from mascarin.comfort.conditions import Conditions
from mascarin.comfort.evaluation import Evaluation
from mascarin.errors import InputError, did_you_mean
from mascarin.physics import KELVIN

Band = tuple[float, float]
Need = Literal["humidity", "outdoor temperature"]


@dataclass(frozen=True)
class Index:
    """A comfort index.

    Attributes
    ----------
    name, title : str
        Name in files and arguments; name for people.
    unit, excess_unit : str
        Unit of the values, and of degree-hours.
    needs : tuple of str
        What must be known beside the temperatures of air and surfaces.
    validity : str
        Where the index may be used.
    source : str
        Where it is published.
    categories : tuple of str
        Names of its limits; empty where the limits are a band of values.
    usual : str or (float, float) or None
        Category or band that is used where none is given; None: one must be given.
    rate : callable or None
        Conditions and category -> values with limits.
    rate_band : callable or None
        Conditions and band -> values with limits.

    Examples
    --------
    >>> INDICES["pmv"].categories
    ('A', 'B', 'C')
    """

    name: str
    title: str
    unit: str
    excess_unit: str
    needs: tuple[Need, ...]
    validity: str
    source: str
    categories: tuple[str, ...] = ()
    usual: str | Band | None = None
    rate: Callable[[Conditions, str], Evaluation] | None = field(default=None, repr=False)
    rate_band: Callable[[Conditions, Band], Evaluation] | None = field(default=None, repr=False)

    def evaluate(self, conditions: Conditions, limits: str | Band | None = None) -> Evaluation:
        """Values of the index, NaN where it is not valid, with the limits of comfort.

        Parameters
        ----------
        conditions : Conditions
            Air, radiation, humidity and the person.
        limits : str or (float, float), optional
            Category, or lowest and highest value of comfort. Default: `usual`.

        Returns
        -------
        Evaluation
            Values and limits.

        Raises
        ------
        InputError
            The limits are no category of the index, a band is missing, or something that it needs is not
            known.
        """
        chosen = self.usual if limits is None else limits
        require_limits(self, chosen)
        if "humidity" in self.needs and conditions.relative_humidity is None:
            raise InputError(f"{self.name}: the relative humidity is not known, and {self.title} needs it")
        if (
            "outdoor temperature" in self.needs
            and conditions.running_mean is None
            and conditions.prevailing_mean is None
        ):
            raise InputError(f"{self.name}: the outdoor temperature is not known, and {self.title} needs it")
        if isinstance(chosen, str):
            assert self.rate is not None  # noqa: S101 (require_limits)
            return self.rate(conditions, chosen)
        assert self.rate_band is not None  # noqa: S101
        assert chosen is not None  # noqa: S101
        return self.rate_band(conditions, chosen)


def require_limits(index: Index, limits: str | Band | None, where: str = "") -> None:
    """Refuse limits that an index does not have.

    Parameters
    ----------
    index : Index
        The index.
    limits : str or (float, float) or None
        Category or band.
    where : str
        In front of the message.

    Raises
    ------
    InputError
        The text names what was expected.

    Examples
    --------
    >>> require_limits(INDICES["pmv"], "B")
    """
    if index.categories:
        if limits not in index.categories:
            categories = ", ".join(index.categories)
            raise InputError(
                f"{where}category: found {limits!r}; expected one of {index.title}: {categories}"
            )
        return
    if isinstance(limits, str) or limits is None or not limits[0] < limits[1]:
        stated = "none" if limits is None else repr(limits)
        raise InputError(
            f"{where}band: found {stated}; expected the lowest and the highest comfortable value of "
            f"{index.title} [{index.unit}], such as [20, 26]"
        )


def _operative(conditions: Conditions, band: Band) -> Evaluation:
    return Evaluation(conditions.operative_temperature, *band)


_ALL: Final = (
    Index(
        "operative", "the operative temperature", "degC", "K h", (),
        "any room", "ISO 7726:1998",
        rate_band=_operative,
    ),
    Index(
        "adaptive-en", "the adaptive model of EN 16798-1", "degC", "K h", ("outdoor temperature",),
        "rooms with windows that people open, without mechanical cooling; running mean of the outdoor "
        "temperature from 10 to 30 degC",
        "EN 16798-1:2019, annex B.2.2", tuple(adaptive.EN_CATEGORIES), "II", rate=adaptive.adaptive_en,
    ),
    Index(
        "adaptive-ashrae", "the adaptive model of ASHRAE 55", "degC", "K h", ("outdoor temperature",),
        "rooms with windows that people open, without mechanical cooling; prevailing mean outdoor "
        "temperature from 10 to 33.5 degC; 1.0 to 1.5 met",
        "ANSI/ASHRAE Standard 55-2020, section 5.4", tuple(adaptive.ASHRAE_CATEGORIES), "80",
        rate=adaptive.adaptive_ashrae,
    ),
    Index(
        "pmv", "the PMV", "-", "PMV h", ("humidity",),
        "air 10 to 30 degC, radiant 10 to 40 degC, relative air speed up to 1 m/s, vapour pressure up to "
        "2700 Pa, 0.8 to 4 met, up to 2 clo, PMV from -2 to 2",
        "ISO 7730:2005, clause 4.1", tuple(heat_balance.PMV_CATEGORIES), "B", rate=heat_balance.pmv,
    ),
    Index(
        "set", "the SET", "degC", "K h", ("humidity",),
        "air and radiant 10 to 40 degC, air speed up to 2 m/s, 1 to 4 met, up to 1.5 clo",
        "ANSI/ASHRAE Standard 55-2020, appendix D", rate_band=heat_balance.standard_effective_temperature,
    ),
    Index(
        "heat-index", "the heat index", "degC", "K h", ("humidity",),
        "air from 26.7 to 45 degC with a relative humidity from 40 %; people in the shade in light wind",
        "Rothfusz 1990, NWS SR 90-23; above 32.2 degC: extreme caution",
        usual=(-KELVIN, 32.2), rate_band=heat_balance.heat_index,
    ),
    Index(
        "utci", "the UTCI", "degC", "K h", ("humidity",),
        "outdoors: wind 0.5 to 17 m/s at 10 m, air -50 to 50 degC, vapour pressure up to 5 kPa",
        "Bröde et al. 2012, doi:10.1007/s00484-011-0454-1; 9 to 26 degC: no thermal stress",
        usual=(9.0, 26.0), rate_band=heat_balance.utci,
    ),
    Index(
        "givoni", "Givoni's zone", "degC", "K h", ("humidity",),
        "people used to a hot climate; air with at least 4 g/kg of vapour; above 2 m/s the zone of 2 m/s",
        "Givoni 1992, doi:10.1016/0378-7788(92)90047-K", ("hot climate",), "hot climate",
        rate=givoni.givoni,
    ),
)  # fmt: skip

INDICES: Final[Mapping[str, Index]] = {entry.name: entry for entry in _ALL}
"""The indices by name."""


def index_named(name: str) -> Index:
    """An index by its name.

    Parameters
    ----------
    name : str
        One of `INDICES`.

    Returns
    -------
    Index
        The index.

    Raises
    ------
    InputError
        There is no such index; the text names the nearest ones.

    Examples
    --------
    >>> index_named("givoni").source
    'Givoni 1992, doi:10.1016/0378-7788(92)90047-K'
    """
    if name not in INDICES:
        raise InputError(
            f"index: found {name!r}; expected a comfort index. {did_you_mean(name, INDICES)}".rstrip()
        )
    return INDICES[name]
