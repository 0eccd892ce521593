"""What a campaign is: written once, when it is created, in words that a person can read."""

import hashlib
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rocking.dynamics import engine
from rocking.errors import InvalidValueError
from rocking.studies.campaign import disk
from rocking.studies.campaign.chunks import FORMAT, Plan, default_chunk
from rocking.studies.campaign.errors import CampaignDamagedError, CampaignMismatchError
from rocking.studies.campaign.fingerprint import LAST_DIGITS, engine_of, kind_of
from rocking.studies.histories import Histories

NAME = "campaign.json"
SHARDS = "shards"
_SHOWN = 5


@dataclass(frozen=True)
class Identity:
    """Plan of a campaign, and what its histories are."""

    plan: Plan  # how it is cut
    histories: dict[str, Any]  # what they say of themselves

    @classmethod
    def of(cls, histories: Histories, size: int | None = None) -> "Identity":
        """Return the identity of a new campaign.

        Returns the same wherever it is made with this version of the package by an engine of the same last digits.
        """
        chosen = engine_of(histories)
        pieces = usual_chunk(histories) if size is None else size
        told = histories.description()
        return cls(Plan(histories.key(told), histories.count, pieces, chosen, software()), _plain(told))

    @classmethod
    def read(cls, folder: Path) -> "Identity":
        """Return the identity of a campaign on disk."""
        path = folder / NAME
        try:
            text = path.read_bytes()
        except (FileNotFoundError, NotADirectoryError) as error:
            raise CampaignMismatchError(f"{folder}: no campaign here ({NAME} is missing)") from error
        try:
            content = _decoded(text)
            if content["plan"]["format"] != FORMAT:
                raise CampaignMismatchError(f"{path}: format {content['plan']['format']}, this is {FORMAT}")
            return cls(Plan(**content["plan"]), content["histories"])
        except (ValueError, KeyError, TypeError, InvalidValueError) as error:
            raise CampaignDamagedError(
                f"{path} is damaged ({error}); the shards are intact: create a campaign of the same histories and "
                "chunk size elsewhere, copy them into its folder shards, and run it"
            ) from error

    def write(self, folder: Path) -> None:
        """Write it; a folder becomes a campaign by this."""
        content = {"plan": asdict(self.plan), "histories": self.histories}
        disk.write_new(folder / NAME, _encoded(content, _sum(content)))

    def refuse_other(self, folder: Path, histories: Histories) -> None:
        """Refuse histories, or a version of this package, that the campaign was not created with."""
        given = Identity.of(histories, self.plan.size)
        if given.plan.key != self.plan.key:
            differences = _differences(self.histories, given.histories, "")
            found = sorted(differences, key=lambda text: "..." in text)  # what a person can read comes first
            shown = "; ".join(found[:_SHOWN]) + (f"; and {len(found) - _SHOWN} more" if len(found) > _SHOWN else "")
            raise CampaignMismatchError(f"{folder}: this campaign is of other histories: {shown or 'their key'}")
        if given.plan.software != self.plan.software:
            raise CampaignMismatchError(_other(folder, "software", self.plan.software, given.plan.software))
        was, now = self.plan.engine, given.plan.engine
        if was != now and kind_of(was) == kind_of(now):
            raise CampaignMismatchError(
                f"{folder}: this machine computes other last digits: begun with engine {was}, here it is {now} "
                f"({LAST_DIGITS}); finish it where it was begun, or create a new campaign"
            )
        if was != now:
            raise CampaignMismatchError(_other(folder, "engine", was, now))


def usual_chunk(histories: Histories) -> int:
    """Return how many histories make a chunk, unless somebody wants another number.

    Returns Histories; where motions are made for them, those of one motion are in one chunk.
    """
    together = 1 if histories.motions.in_memory else histories.together
    return default_chunk(engine.chosen(histories.engine, histories.law), together)


def software() -> str:
    """Return the version of this package."""
    from rocking import __version__

    return str(__version__)


def _decoded(text: bytes) -> Any:
    outer = json.loads(text)
    content, stated = outer["campaign"], outer["sha256"]
    if _encoded(content, stated) != text or _sum(content) != stated:
        raise ValueError("its checksum does not fit")
    return content


def _plain(described: dict[str, Any]) -> dict[str, Any]:
    return dict(json.loads(json.dumps(described, allow_nan=False)))


def _sum(content: Any) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _encoded(content: Any, stated: str) -> bytes:
    return (json.dumps({"campaign": content, "sha256": stated}, sort_keys=True, indent=1) + "\n").encode()


def _other(folder: Path, what: str, was: str, now: str) -> str:
    return (
        f"{folder}: begun with {what} {was}, this is {now}, whose results may differ in their last bits; "
        f"finish it with {was}, or create a new campaign"
    )


def _differences(was: Any, now: Any, where: str) -> Iterator[str]:
    if isinstance(was, dict) and isinstance(now, dict):
        for name in sorted(was.keys() | now.keys()):
            yield from _differences(was.get(name), now.get(name), f"{where}.{name}" if where else str(name))
    elif isinstance(was, list) and isinstance(now, list) and len(was) == len(now):
        for k, (one, other) in enumerate(zip(was, now, strict=True)):
            yield from _differences(one, other, f"{where}[{k}]")
    elif was != now:
        yield f"{where} was {_short(was)}, is {_short(now)}"


def _short(value: Any) -> str:
    text = f"a list of {len(value)}" if isinstance(value, list) else str(value)
    return text if len(text) <= 24 else text[:12] + "..."
