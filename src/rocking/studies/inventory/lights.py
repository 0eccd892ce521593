"""Traffic lights: what counts as safe, in numbers that stand in every report."""

import math
from dataclasses import dataclass, replace
from enum import Enum

from rocking import checks
from rocking.language import language
from rocking.messages import Message
from rocking.statistics.counts import share_interval

# 0.07 * 100 is 7.000000000000001: seven of a hundred must reach it
_ROUNDING = 1e-9
_MOST = 0.99  # no larger share is green, whatever the consequence


class Light(Enum):
    """What a light says; the value is the letter that stands beside the colour."""

    GREEN = "G"
    AMBER = "A"
    RED = "R"

    @property
    def word(self) -> str:
        """The light in a word."""
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
"""Names, marks and letters of the lights: they are for eyes that do not see colours."""

_MEANINGS = {
    Light.RED: Message("At least {red:.10g}% of the motions overturn the object."),
    Light.AMBER: Message(
        "Neither red nor green: it rocks notably, overturns now and then, slides often, or there are too few motions "
        "to rule overturning out."
    ),
    Light.GREEN: Message(
        "No motion lifts it; or none overturns it, the upper end of the {level:.10g}% interval of the overturning "
        "share is at most {green:.10g}% (which takes at least {needed} motions), and 84 % of the motions turn it by "
        "less than {rocking:g} of its slenderness angle. Nor do {red:.10g}% of the motions make it slide."
    ),
}


@dataclass(frozen=True)
class Thresholds:
    """Where one light ends and the next begins.

    They are a convention of this package, not of a code: change them where another one is agreed.

    Parameters
    ----------
    rocking : float
        Green needs the 84 % quantile of the peak rotation over the slenderness angle below this [-].
    overturning_green : float
        Green needs the upper end of the interval of the overturning share at or below this [-].
    overturning_red : float
        Red from this share of motions that overturn [-].
    level : float
        Confidence of the interval [-].
    low_consequence, high_consequence : float
        What both shares are multiplied by for an object whose fall is of low or of high consequence [-].

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
        """Return by what the shares of a consequence are multiplied; how much a fall weighs is its inverse.

        Parameters
        ----------
        consequence : {"low", "medium", "high"}
            How bad it is if the object falls.

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
            How bad it is if the object falls.

        Returns
        -------
        Thresholds
            With its shares.

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
        """Return the light of what was counted.

        Parameters
        ----------
        lifted, overturned : int
            How many motions lift the object, how many overturn it [-].
        count : int
            How many motions there are that could be computed, at least one [-].
        high_rotation : float or None
            The 84 % quantile of the peak rotation over the slenderness angle, None if it overturns there [-].
        failed : int
            How many motions could not be computed: with any there is no green [-].
        slid : int
            How many motions make it slide, whose way is not computed: from the share of red on there is no green [-].

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
        """Return what each light means.

        Parameters
        ----------
        code : str
            Language of the sentences.

        Returns
        -------
        dict of Light to str
            One sentence each, with the numbers.
        """
        say = language(code)
        numbers = {
            "red": 100.0 * self.overturning_red, "green": 100.0 * self.overturning_green, "level": 100.0 * self.level,
            "needed": self.needed, "rocking": self.rocking,
        }  # fmt: skip
        return {light: say(meaning.text, **numbers) for light, meaning in _MEANINGS.items()}

    def conventions(self, code: str = "en") -> list[str]:
        """Return how the shares depend on the consequence of a fall, and that all of this is a convention.

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
            f"{colour}_{name}": 100.0 * getattr(each, f"overturning_{colour}")
            for name, each in (("low", low), ("high", high)) for colour in ("green", "red")
        }  # fmt: skip
        return [
            say(
                "The shares are those of a fall of medium consequence. Of low consequence they are "
                "{green_low:.10g}% and {red_low:.10g}%, of high consequence {green_high:.10g}% and "
                "{red_high:.10g}%; that takes at least {needed_high} motions.",
                needed_high=high.needed,
                **shares,
            ),
            say("These thresholds are a convention of this report, not of a code of practice."),
        ]

    @property
    def needed(self) -> int:
        """How many motions, none of which overturns an object that they lift, can make it green at best [-]."""
        return math.ceil(math.log(0.5 * (1.0 - self.level)) / math.log(1.0 - self.overturning_green))  # Eq. 187
