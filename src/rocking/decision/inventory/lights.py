"""Traffic lights of an inventory, with the thresholds that every report lists."""

import math
from dataclasses import dataclass, replace
from enum import Enum

from rocking import checks
from rocking.language import language
from rocking.messages import Message
from rocking.statistics.counts import share_interval

# 0.07 * 100 is 7.000000000000001, but 7 of 100 must reach the threshold 0.07
_ROUNDING = 1e-9
_MOST = 0.99  # largest allowed limit of green for every consequence


class Light(Enum):
    """Light of an object; the value is the letter of the colour."""

    GREEN = "G"
    AMBER = "A"
    RED = "R"

    @property
    def word(self) -> str:
        """The light as a word."""
        return self.name.lower()

    @property
    def severity(self) -> int:
        """0 for green, 1 for amber, 2 for red [-]."""
        return list(Light).index(self)


LIGHT_NAMES = {Light.GREEN: Message("green"), Light.AMBER: Message("amber"), Light.RED: Message("red")}
LIGHT_MARKS = {Light.GREEN: Message("GREEN"), Light.AMBER: Message("AMBER"), Light.RED: Message("RED")}
LIGHT_LETTERS = {
    Light.GREEN: Message("G", context="light"),
    Light.AMBER: Message("A", context="light"),
    Light.RED: Message("R", context="light"),
}
"""Names, marks and letters of the lights, for readers with colour blindness."""

_MEANINGS = {
    Light.RED: Message("At least {red:.10g}% of the motions overturn the object."),
    Light.AMBER: Message(
        "Neither red nor green: the object rocks clearly, overturns under some motions or slides often, or the number "
        "of "
        "motions is too small to exclude overturning."
    ),
    Light.GREEN: Message(
        "Two conditions must hold. (1) No motion causes uplift; or no motion overturns the object, the upper end of "
        "the "
        "{level:.10g}% interval of the overturning fraction is at most {green:.10g}% (at least {needed} motions), and "
        "the peak rotation is below {rocking:g} of the slenderness angle in 84 % of the motions. (2) The object slides "
        "in fewer than {red:.10g}% of the motions."
    ),
}


@dataclass(frozen=True)
class Thresholds:
    """Limits between the lights.

    The limits are a convention of this package, not of a code. Change them if another convention is agreed.

    Parameters
    ----------
    rocking : float
        Limit of green for the 84 % quantile of the peak rotation / slenderness angle [-].
    overturning_green : float
        Limit of green for the upper end of the interval of the overturning fraction [-].
    overturning_red : float
        Smallest overturning fraction of red [-].
    level : float
        Confidence of the interval [-].
    low_consequence, high_consequence : float
        Factor on both fractions for an object with low or high consequence of a fall [-].

    Raises
    ------
    InvalidValueError
        If a number is outside its range.

    Examples
    --------
    >>> Thresholds().light(lifted=0, overturned=0, count=20, high_rotation=0.0).word
    'green'
    >>> Thresholds().light(lifted=20, overturned=0, count=20, high_rotation=0.1).word
    'amber'
    """

    rocking: float = 0.2
    overturning_green: float = 0.05
    overturning_red: float = 0.20
    level: float = 0.95
    low_consequence: float = 2.0
    high_consequence: float = 0.4

    def __post_init__(self) -> None:
        checks.within("rocking", self.rocking, 0.0, 1.0, open_low=True)
        checks.within("overturning_green", self.overturning_green, 0.0, 1.0, open_low=True, open_high=True)
        low = self.overturning_green
        checks.within("overturning_red", self.overturning_red, low, 1.0, hint="not below overturning_green")
        checks.within("level", self.level, 0.5, 1.0, open_high=True)
        checks.within("low_consequence", self.low_consequence, 1.0, 100.0)
        checks.within("high_consequence", self.high_consequence, 0.0, 1.0, open_low=True)

    def factor(self, consequence: str) -> float:
        """Return the factor on the limits of the overturning fraction. The inverse factor is the weight of a fall.

        Parameters
        ----------
        consequence : {"low", "medium", "high"}
            Consequence of a fall of the object.

        Returns
        -------
        float
            The factor [-].
        """
        return {"low": self.low_consequence, "medium": 1.0, "high": self.high_consequence}[consequence]

    def of(self, consequence: str) -> "Thresholds":
        """Return the thresholds of a consequence.

        Parameters
        ----------
        consequence : {"low", "medium", "high"}
            Consequence of a fall of the object.

        Returns
        -------
        Thresholds
            Thresholds with the fractions of the consequence.

        Examples
        --------
        >>> Thresholds().of("high").overturning_green
        0.02
        """
        if consequence == "medium":
            return self
        factor = self.factor(consequence)
        green, red = round(min(factor * self.overturning_green, _MOST), 12), min(factor * self.overturning_red, 1.0)
        return replace(self, overturning_green=green, overturning_red=red, low_consequence=1.0, high_consequence=1.0)

    def light(
        self, *, lifted: int, overturned: int, count: int, high_rotation: float | None, failed: int = 0, slid: int = 0
    ) -> Light:
        """Return the rating from the numbers of motions with uplift and with overturning.

        Parameters
        ----------
        lifted, overturned : int
            Number of motions that lift the object, and that overturn it [-].
        count : int
            Number of computed motions, at least one [-].
        high_rotation : float or None
            The 84 % quantile of the peak rotation / slenderness angle, None if overturned [-].
        failed : int
            Number of motions that could not be computed; green requires 0 [-].
        slid : int
            Number of motions with sliding; green requires a fraction below that of red [-].

        Returns
        -------
        Light
            The light.
        """
        if overturned >= self.overturning_red * count - _ROUNDING:
            return Light.RED
        if slid and slid >= self.overturning_red * count - _ROUNDING:
            return Light.AMBER
        if lifted == 0 and failed == 0:
            return Light.GREEN
        small = high_rotation is not None and high_rotation < self.rocking
        sure = share_interval(overturned, count, self.level)[1] <= self.overturning_green
        return Light.GREEN if small and overturned == 0 and sure and failed == 0 else Light.AMBER

    def sentences(self, code: str = "en") -> dict[Light, str]:
        """Return the meaning of each light.

        Parameters
        ----------
        code : str
            Language of the sentences.

        Returns
        -------
        dict of Light to str
            One sentence per light, with the limits.
        """
        say = language(code)
        numbers = {
            "red": 100.0 * self.overturning_red, "green": 100.0 * self.overturning_green, "level": 100.0 * self.level,
            "needed": self.needed, "rocking": self.rocking,
        }  # fmt: skip
        return {light: say(meaning.text, **numbers) for light, meaning in _MEANINGS.items()}

    def conventions(self, code: str = "en") -> list[str]:
        """Return sentences on the fractions by consequence of a fall, and on the convention.

        Parameters
        ----------
        code : str
            Language of the sentences.

        Returns
        -------
        list of str
            Two sentences.
        """
        say, low, high = language(code), self.of("low"), self.of("high")
        shares = {
            f"{colour}_{name}": 100.0 * getattr(thresholds, f"overturning_{colour}")
            for name, thresholds in (("low", low), ("high", high)) for colour in ("green", "red")
        }  # fmt: skip
        return [
            say(
                "These limits for green and red apply to a medium consequence of a fall. For a low consequence the "
                "limits are {green_low:.10g}% and {red_low:.10g}%. For a high consequence the limits are "
                "{green_high:.10g}% and {red_high:.10g}%, and green requires at least {needed_high} motions.",
                needed_high=high.needed,
                **shares,
            ),
            say("These thresholds are a convention of this report, not of a code of practice."),
        ]

    @property
    def needed(self) -> int:
        """Smallest number of motions for a green rating if all motions cause uplift and no motion overturns [-]."""
        return math.ceil(math.log(0.5 * (1.0 - self.level)) / math.log(1.0 - self.overturning_green))  # Eq. 187
