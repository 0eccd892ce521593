"""A spring that comes back stiffer than it went in."""

from dataclasses import dataclass

from rocking import checks
from rocking.restitution.bed.law import ContactLaw, LawKind, LawNumbers


@dataclass(frozen=True)
class PlasticUnloading(ContactLaw):
    """Linear loading, steeper unloading: k while new ground is pressed, k / e^2 on the way back and in again.

    A point that drops alone comes back with the velocity ratio e; each point keeps its own greatest depth. With
    e = 0 nothing comes back (the plastic Winkler bed of docs/theory.md, Section 6), which only an impulsive impact can
    use: a load that stays would make the contact chatter.

    Parameters
    ----------
    stiffness : float
        k of one copy of the law [N/m].
    rebound : float
        e, velocity after over velocity before for a single point [-].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.

    Examples
    --------
    >>> PlasticUnloading(1e7, rebound=0.1).label
    'plastic unloading, k=1e+07 N/m, e=0.1'
    """

    stiffness: float
    rebound: float = 0.1

    def __post_init__(self) -> None:
        checks.within("stiffness", self.stiffness, 0.0, 1e18, unit="N/m", open_low=True)
        checks.within("rebound", self.rebound, 0.0, 1.0)

    def numbers(self, mass: float) -> LawNumbers:
        return LawNumbers(LawKind.PLASTIC, float(self.stiffness), rebound=float(self.rebound))

    @property
    def label(self) -> str:
        return f"plastic unloading, k={self.stiffness:.4g} N/m, e={self.rebound:.4g}"
