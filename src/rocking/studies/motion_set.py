"""The motions of a study, by number: held in memory, or made from a seed when they are needed."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse


class MotionSet(ABC):
    """Motions by number. The same number is the same motion, to the last bit, whoever asks and when."""

    @abstractmethod
    def __len__(self) -> int:
        """Return how many there are."""

    @abstractmethod
    def __getitem__(self, index: int) -> Motion:
        """Return one of them."""

    @abstractmethod
    def description(self) -> dict[str, Any]:
        """Return what makes these motions these, as plain values: kinds, parameters, seeds, hashes of samples.

        Returns
        -------
        dict
            For provenance; two sets that describe themselves alike hold the same motions.
        """

    @property
    def in_memory(self) -> bool:
        """Whether the motions are all at hand, so that laying them out once pays."""
        return False


class MotionList(MotionSet):
    """Motions that are all at hand.

    Parameters
    ----------
    motions : GroundMotion or Pulse, or a sequence of them
        All records or all pulses.

    Raises
    ------
    InvalidValueError
        If there is none, or they are of different kinds.

    Examples
    --------
    >>> import rocking as rk
    >>> len(MotionList([rk.pulses.sine(2.0, 0.5), rk.pulses.sine(3.0, 0.5)]))
    2
    """

    def __init__(self, motions: Motion | Sequence[Motion]) -> None:
        given: object = motions
        found = [motions] if isinstance(given, (GroundMotion, Pulse)) else list(motions)  # type: ignore[arg-type]
        wanted = "motions must be ground motions or pulses"
        if not found:
            raise InvalidValueError(f"{wanted}, got none")
        for k, item in enumerate(found):
            if not isinstance(item, (GroundMotion, Pulse)):
                raise InvalidValueError(f"{wanted}, got {item!r:.60} at index {k}")
        if len({isinstance(item, Pulse) for item in found}) > 1:
            raise InvalidValueError("motions of a study must be all records or all pulses; sample the pulses")
        self._motions: list[Motion] = found  # type: ignore[assignment]

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._motions)

    def __getitem__(self, index: int) -> Motion:
        """Return one of them."""
        return self._motions[index]

    @property
    def in_memory(self) -> bool:
        """True."""
        return True

    def description(self) -> dict[str, Any]:
        """Return names and hashes.

        Returns
        -------
        dict
            Kind, and for each motion its name and the SHA-256 of its coefficients and step.
        """
        return {
            "kind": "list",
            "motions": [{"name": motion.name, "sha256": digest(motion)} for motion in self._motions],
        }


def digest(motion: Motion) -> str:
    """Return the SHA-256 of what an engine sees of a motion.

    Returns 64 hexadecimal digits: of the step, and the coefficients of the horizontal and vertical accelerations.
    """
    import hashlib

    import numpy as np

    segments = motion.segments()
    made = hashlib.sha256(np.array([segments.step, segments.degree], "<f8").tobytes())
    for part in (segments.horizontal, segments.vertical):
        made.update(b"none" if part is None else np.ascontiguousarray(part, "<f8").tobytes())
    return made.hexdigest()
