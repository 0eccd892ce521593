"""Identity of a campaign: a readable description, and a fingerprint of the engine."""

import hashlib
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from rocking.campaigns import disk
from rocking.campaigns.chunks import DEFAULT_CHUNK, FORMAT, REFERENCE_CHUNK, Plan
from rocking.campaigns.disk import CampaignDamagedError, CampaignMismatchError
from rocking.conventions import FloatArray
from rocking.dynamics.batch import Batch
from rocking.dynamics.mechanics import mechanics_of
from rocking.dynamics.mechanics_base import Mechanics
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError
from rocking.motions.segments import Segments
from rocking.studies.histories import Histories

LAST_DIGITS = "another processor, build or ROCKING_ISA"  # possible causes of results with other last digits
_EACH = 16
_OF_REFERENCE = 4
NAME = "campaign.json"
SHARDS = "shards"
_SHOWN = 5


def engine_of(histories: Histories) -> str:
    """Return the engine with a fingerprint, such as ``fast, 0123456789abcdef``; equal texts mean equal results."""
    engine = fast_engine.chosen(histories.engine, histories.law)
    mechanics = dict.fromkeys(mechanics_of(block.settings) for block in histories.parts)
    return f"{engine}, {'-'.join(_fingerprint(engine, _isa(engine, kind), kind) for kind in mechanics)}"


def _isa(engine: str, mechanics: Mechanics) -> str:
    return mechanics.instruction_set() if engine == "fast" else ""


def kind_of(name: str) -> str:
    """Return the kind of engine, without its fingerprint."""
    return name.partition(", ")[0]


@cache
def _fingerprint(engine: str, instruction_set: str, mechanics: Mechanics) -> str:
    """Hash the results of a few histories; the cache distinguishes engines by the instruction set."""
    digest = hashlib.sha256()
    count = _EACH if engine == "fast" else _OF_REFERENCE
    for motions, law, settings in mechanics.samples(*_motions()):
        rows = _rows(count, mechanics)
        results = Batch(motions, law, settings, 1, engine).run(count, rows.part)[0]
        for name, kind in RESULTS.items():
            digest.update(np.ascontiguousarray(results[name], np.dtype(kind).newbyteorder("<")).tobytes())
    return digest.hexdigest()[:16]


def _motions() -> tuple[list[Segments], list[Segments], list[Segments]]:
    """Return pulses, and records without and with a vertical component."""
    # parabolic waves, four segments up and four segments down, of exact binary fractions
    bump = np.array([0.0, 4.0, -4.0, 0.5, -0.5, 0.0, 0.25, -0.25])
    waves = np.array([1.0, -1.0, 1.0, -1.0])[:, None] * bump
    pulses = [Segments(step, size * waves) for size, step in ((2.0, 0.25), (6.0, 0.25), (12.0, 0.5), (3.0, 0.75))]
    flat, upright = [
        [
            Segments.between_samples(0.03125, _noise(37 + k, size), _noise(91 + k, 0.25 * size) if vertical else None)
            for k, size in enumerate((2.0, 6.0, 12.0, 3.0))
        ]
        for vertical in (False, True)
    ]
    return pulses, flat, upright


def _noise(factor: int, size: float) -> FloatArray:
    """Return noise from remainders of integers, equal on all machines."""
    number = np.arange(96)
    return np.asarray(size * ((number * number * factor + 11 * number) % 101 - 50) / 64.0, np.float64)


def _rows(count: int, mechanics: Mechanics) -> Rows:
    """Return bodies from squat to slender; the last body is invalid for all engines."""
    k = np.arange(_EACH)[-count:]
    alpha = 0.0625 + 0.03125 * (k * 5 % 13)
    values = {
        "alpha_right": alpha, "alpha_left": 0.75 * alpha + 0.03125, "p_right": 1.0 + 0.25 * (k * 7 % 16),
        "p_left": 1.125 + 0.25 * (k * 7 % 16), "r_right": 0.75 + k / 128.0, "r_left": 0.875 - k / 128.0,
        "q_right": 0.5 + k / 128.0, "q_left": 0.75 - k / 128.0,
        "share_right": 1.0 - k / 64.0, "share_left": 0.5 + k / 64.0,
        "scale": np.where(k == _EACH - 1, np.nan, 0.5 + k / 16.0), "rotation": np.where(k % 5 == 4, 0.03125, 0.0),
    }  # fmt: skip
    return Rows.of(count, k % 4, k, **mechanics.sample_rows(values))


@dataclass(frozen=True)
class Identity:
    """Plan of a campaign, and the description of its histories."""

    plan: Plan
    histories: dict[str, Any]  # description of the histories

    @classmethod
    def of(cls, histories: Histories, size: int | None = None) -> "Identity":
        """Return the identity of a new campaign. Engines with equal last digits of results have equal identities."""
        size = usual_chunk(histories) if size is None else size
        content = histories.description()
        plan = Plan(histories.key(content), histories.count, size, engine_of(histories), software())
        return cls(plan, dict(json.loads(json.dumps(content, allow_nan=False))))

    @classmethod
    def read(cls, folder: Path) -> "Identity":
        """Return the identity of a campaign on disk."""
        path = folder / NAME
        try:
            text = path.read_bytes()
        except (FileNotFoundError, NotADirectoryError) as error:
            raise CampaignMismatchError("the folder contains no campaign ({file} is missing)", file=NAME).at(
                str(folder)
            ) from error
        try:
            outer = json.loads(text)
            content, stated = outer["campaign"], outer["sha256"]
            if _encoded(content, stated) != text or _sum(content) != stated:
                raise ValueError("the checksum does not match the content")
            if content["plan"]["format"] != FORMAT:
                raise CampaignMismatchError(
                    "the campaign has format {number}, but format {expected} is required",
                    number=content["plan"]["format"],
                    expected=FORMAT,
                ).at(str(path))
            return cls(Plan(**content["plan"]), content["histories"])
        except (ValueError, KeyError, TypeError, InvalidValueError) as error:
            hint = (
                "the shards are intact: create a campaign of the same histories and chunk size elsewhere, copy them "
                "into its folder shards, and run it"
            )
            raise CampaignDamagedError("the file is damaged ({reason})", reason=str(error), hint=hint).at(
                str(path)
            ) from error

    def write(self, folder: Path) -> None:
        """Write the file of the identity. A folder with this file is a campaign."""
        content = {"plan": asdict(self.plan), "histories": self.histories}
        disk.write_new(folder / NAME, _encoded(content, _sum(content)))

    def refuse_other(self, folder: Path, histories: Histories) -> None:
        """Refuse other histories or another version of this package."""
        other = Identity.of(histories, self.plan.size)
        was, now = self.plan, other.plan
        if was.key != now.key:
            differences = list(_differences(self.histories, other.histories, ""))
            differences.sort(key=lambda text: "..." in text)  # sort readable differences first
            more = f"; and {len(differences) - _SHOWN} more" if len(differences) > _SHOWN else ""
            shown = "; ".join(differences[:_SHOWN]) + more
            raise CampaignMismatchError(
                "this campaign has other histories: {differences}", differences=shown or "their key"
            ).at(str(folder))
        for kind, before, here in (("software", was.software, now.software), ("engine", was.engine, now.engine)):
            if before == here:
                continue
            if kind == "engine" and kind_of(before) == kind_of(here):
                raise CampaignMismatchError(
                    "results of this machine differ in the last digits: the campaign started with engine {expected}, "
                    "this machine has engine {engine} ({reason})", expected=before, engine=here, reason=LAST_DIGITS,
                    hint="finish it where it was begun, or create a new campaign",
                ).at(str(folder))  # fmt: skip
            raise CampaignMismatchError(
                "The campaign was begun with {software} {expected}. Results of {version}, installed here, may differ "
                "in the last bits",
                software=kind, expected=before, version=here,
                hint=f"finish it with {before}, or create a new campaign",
            ).at(str(folder))  # fmt: skip


def usual_chunk(histories: Histories) -> int:
    """Return the default number of histories per chunk; histories of one synthetic motion remain together."""
    together = 1 if histories.motions.in_memory else histories.together
    engine = fast_engine.chosen(histories.engine, histories.law)
    usual = DEFAULT_CHUNK if engine.startswith("fast") else REFERENCE_CHUNK
    return max(usual - usual % together, usual if together > usual else 1)


def software() -> str:
    """Return the version of this package."""
    from rocking.version import __version__

    return __version__


def _sum(content: Any) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _encoded(content: Any, stated: str) -> bytes:
    return (json.dumps({"campaign": content, "sha256": stated}, sort_keys=True, indent=1) + "\n").encode()


def _differences(was: Any, now: Any, where: str) -> Iterator[str]:
    if isinstance(was, dict) and isinstance(now, dict):
        for name in sorted(was.keys() | now.keys()):
            yield from _differences(was.get(name), now.get(name), f"{where}.{name}" if where else str(name))
    elif isinstance(was, list) and isinstance(now, list) and len(was) == len(now):
        for k, (before, after) in enumerate(zip(was, now, strict=True)):
            yield from _differences(before, after, f"{where}[{k}]")
    elif was != now:
        yield f"{where} was {_short(was)}, is {_short(now)}"


def _short(value: Any) -> str:
    text = f"a list of {len(value)}" if isinstance(value, list) else str(value)
    return text if len(text) <= 24 else text[:12] + "..."
