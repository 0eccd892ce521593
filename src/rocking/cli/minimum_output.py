"""What `rocking minimum` computes, prints, writes and draws.

Keys of the JSON
----------------
- ``body``, ``assumed`` (sentences),
  ``motion`` (kind, name, duration_s, peak_acceleration_m_s2), ``restitution``, ``gravity_m_s2``, ``linear``.
- ``crossings``: in order, each with acceleration_m_s2, acceleration_g (standard gravity), ratio (over what lifts the
  body), scale (factor on the motion), width_m_s2 (of its bracket), mode_below, mode_above (-2 not lifted, -1 survives,
  n >= 0 overturns after n impacts).
- ``minimum_m_s2``, ``certain_m_s2`` (null where there is none), ``overturning_intervals_m_s2``,
  ``safe_intervals_m_s2``, ``lowest_m_s2``, ``highest_m_s2``, ``uplift_acceleration_m_s2``, ``resolution``,
  ``resolution_below`` (the first crossing), ``starts_overturned``, ``samples``, ``failed``, ``sentence``.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rocking.bodies import Body
from rocking.cli import output
from rocking.cli.options import beside_g, in_unit
from rocking.cli.output import write_csv
from rocking.cli.simulate_question import restitution_from
from rocking.conventions import ACCELERATION_UNITS, g, percent
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.studies.minimum_acceleration import Transitions

_SPOKEN = 4
"""Stretches of overturning that a sentence names."""


@dataclass(frozen=True)
class MinimumAnswer:
    """All crossings of a body under a motion."""

    body: Body
    motion: Motion
    restitution: Any
    settings: dict[str, Any]  # as of `rocking.cli.output.settings_from`
    found: Transitions  # what was found

    @classmethod
    def of(
        cls,
        body: Body,
        motion: Motion,
        restitution: str,
        search: dict[str, Any],
        settings: dict[str, Any],
        *,
        quiet: bool = False,
    ) -> "MinimumAnswer":
        """Search.

        search: lowest, highest [m/s2], points, levels, as `minimum_overturning_acceleration` takes them.
        """
        from rocking.studies.minimum_acceleration import minimum_overturning_acceleration

        law = restitution_from(restitution)
        with output.bar("histories", quiet=quiet) as tell:
            found = minimum_overturning_acceleration(body, motion, law, progress=tell, **search, **settings)
        return cls(body, motion, law, settings, found)

    @property
    def label(self) -> str:
        """The restitution in words."""
        return str(getattr(self.restitution, "label", self.restitution))


def search_from(lowest: str | None, highest: str | None) -> dict[str, float | None]:
    """Return the range of accelerations that a command was given.

    Returns lowest and highest, None where not given [m/s2].
    """
    words = {"lowest": lowest, "highest": highest}
    found = {
        name: None if word is None else output.quantity(f"--{name}", word, "m/s2")[0] for name, word in words.items()
    }
    least, most = found.values()
    if least is not None and most is not None and not least < most:
        raise InvalidValueError(f"--lowest must be below --highest, got {lowest} and {highest}")
    return found


def sentence(found: Transitions) -> str:
    """Return all crossings in words.

    Returns one sentence; with many crossings the first and the last.
    """
    falls = found.overturning_intervals
    scanned = f"scanned from {_g(found.lowest)} to {_g(found.highest)}, resolution {percent(found.resolution)}"
    if found.minimum is not None and found.resolution_below < 0.5 * found.resolution:
        scanned += f" ({percent(found.resolution_below)} below the first crossing); thinner stretches may exist"
    if not falls:
        return f"survives everything; {scanned}"
    if falls == ((found.lowest, found.highest),):
        return f"overturns at every acceleration; {scanned}"
    parts = [_stretch(found, falls, k) for k in range(len(falls))]
    if len(parts) > _SPOKEN:
        left_out = len(parts) - _SPOKEN
        last = _stretch(found, falls[-1:], 0)  # it names its own beginning
        parts = [*parts[: _SPOKEN - 1], f"{left_out} more such stretches follow", last]
    return f"{', '.join(parts)}; {scanned}"


def _stretch(found: Transitions, falls: tuple[tuple[float, float], ...], k: int) -> str:
    """Return one stretch of overturning in words, and how far it then survives."""
    low, high = falls[k]
    if k == len(falls) - 1 and high == found.highest:
        return "overturns above" if k else f"overturns above {_g(low)}"
    words = f"overturns from {_g(low)} to {_g(high)}"
    return words + (", survives above" if k == len(falls) - 1 else f", survives to {_g(falls[k + 1][0])}")


def _g(acceleration: float) -> str:
    return f"{acceleration / g:.4g} g"


def as_json(answer: MinimumAnswer) -> str:
    """Return everything as JSON."""
    found = answer.found
    facts = {
        "body": repr(answer.body),
        "assumed": list(answer.body.assumed),
        "motion": output.motion_facts(answer.motion),
        "restitution": answer.label,
        "gravity_m_s2": answer.settings["gravity"],
        "linear": answer.settings["linear"],
        "crossings": crossings(found),
        "minimum_m_s2": found.minimum,
        "certain_m_s2": found.certain,
        "overturning_intervals_m_s2": found.overturning_intervals,
        "safe_intervals_m_s2": found.safe_intervals,
        "lowest_m_s2": found.lowest,
        "highest_m_s2": found.highest,
        "uplift_acceleration_m_s2": found.uplift_acceleration,
        "resolution": found.resolution,
        "resolution_below": found.resolution_below if found.minimum is not None else None,
        "starts_overturned": found.starts_overturned,
        "samples": found.samples,
        "failed": found.failed,
        "contact": found.contact,
        "sentence": sentence(found),
    }
    return json.dumps(facts, indent=1, allow_nan=False)


def crossings(found: Transitions) -> list[dict[str, float | int]]:
    """Return every crossing as plain values.

    Returns as the key ``crossings`` of the JSON.
    """
    return [
        {
            "acceleration_m_s2": float(found.acceleration[k]),
            "acceleration_g": float(found.acceleration[k]) / g,
            "ratio": float(found.ratio[k]),
            "scale": float(found.scale[k]),
            "width_m_s2": float(found.width[k]),
            "mode_below": int(found.modes[k, 0]),
            "mode_above": int(found.modes[k, 1]),
        }
        for k in range(len(found))
    ]


def write(answer: MinimumAnswer, picture: Path | None, csv: Path | None) -> list[Path]:
    """Write what was asked for."""
    found = answer.found
    if picture is not None:
        from rocking.plots.style import write as write_picture
        from rocking.plots.transitions import transitions_picture

        drawn = transitions_picture(found, answer.body, answer.motion, answer.restitution, **answer.settings)
        write_picture(drawn, picture)
    if csv is not None:
        columns = {
            "acceleration [m/s2]": found.acceleration, "acceleration [g]": found.acceleration / g,
            "ratio [1]": found.ratio, "scale [1]": found.scale, "width [m/s2]": found.width,
            "mode below [1]": found.modes[:, 0], "mode above [1]": found.modes[:, 1],
        }  # fmt: skip
        write_csv(csv, {name: (values, "") for name, values in columns.items()})
    return [path for path in (picture, csv) if path is not None]


def show(answer: MinimumAnswer, length: str = "m", acceleration: str = "m/s2") -> None:
    """Print all crossings."""
    from rich.console import Console

    console, found = Console(highlight=False, soft_wrap=True), answer.found
    unit, lifts = beside_g(acceleration), found.uplift_acceleration
    for name, words in output.body_lines(answer.body, answer.settings["gravity"], length):
        console.print(f"{name + ':':13} {words}", markup=False)
    console.print(f"motion:       {answer.motion.name}, scaled", markup=False)
    console.print(f"restitution:  {answer.label}", markup=False)
    console.print(f"lifts it:     {_g(lifts)}, {in_unit(lifts, unit, '.6g')}", markup=False)
    console.print()
    words = sentence(found)
    console.print(f"{words[:1].upper()}{words[1:]}.", style="bold", markup=False)
    if len(found):
        head = ("PGA [g]", f"[{unit}]", "/ uplift", "below", "above")
        rows: list[tuple[str, ...]] = [
            (
                f"{one['acceleration_g']:.6f}",
                f"{one['acceleration_m_s2'] / ACCELERATION_UNITS[unit]:.6f}",
                f"{one['ratio']:.6f}",
                _short(int(one["mode_below"])),
                _short(int(one["mode_above"])),
            )
            for one in crossings(found)
        ]
        console.print()
        console.print(output.table(head, rows, left=0))
    if found.failed:
        console.print(f"! {found.failed} of {found.samples} histories could not be computed", style="yellow")
    if found.contact:
        console.print(f"! {found.contact}", style="yellow", markup=False)


def _short(mode: int) -> str:
    if mode < 0:
        return "stays standing" if mode == -1 else "not lifted"
    return "falls, no impact" if mode == 0 else f"falls, {mode} impact{'s' if mode > 1 else ''}"
