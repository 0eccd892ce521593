"""How far the rounds of an adaptive study are, as their folders say."""

import json
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rocking.campaigns import Campaign, CampaignDamagedError, CampaignStatus, Verification
from rocking.campaigns.disk import holder
from rocking.campaigns.identity import NAME
from rocking.campaigns.reading import verified

FINISHED = "finished.json"
"""Written when a study has asked for its last round: how many there were, and of how many histories."""


def round_folder(folder: Path, number: int) -> Path:
    """Return the folder of a round.

    Returns the folder; it may not be there yet.
    """
    return folder / f"round-{number:03}"


def resume(folder: Path) -> str:
    """Return the command that goes on with a campaign.

    >>> resume(Path("my study"))
    "rocking campaign resume 'my study'"
    """
    return f"rocking campaign resume {shlex.quote(str(folder))}"


@contextmanager
def way_out(folder: Path, number: int) -> Iterator[None]:
    """Say of a damaged round what its user can do: rounds are not campaigns that anybody began."""
    try:
        yield
    except CampaignDamagedError as error:
        path = round_folder(folder, number)
        if NAME not in str(error):  # a shard or the ledger: whoever goes on makes it anew
            raise CampaignDamagedError(f"{str(error).split('; run ')[0]}; go on with: {resume(folder)}") from error
        raise CampaignDamagedError(
            f"{path / NAME} is damaged; remove {path} and go on with: {resume(folder)}; the other rounds are kept"
        ) from error


def status_of_rounds(folder: Path, *, verify: bool = True) -> tuple[CampaignStatus | None, int, bool]:
    """Return how far the rounds are that have begun; how many will follow is not known before they do.

    Returns status: of all rounds that have begun; None if none has; finished: whether the last one was asked for, and
    all are complete.
    """
    found: list[CampaignStatus] = []
    while (round_folder(folder, len(found)) / NAME).exists():
        with way_out(folder, len(found)):
            found.append(Campaign.status_of(round_folder(folder, len(found)), verify=verify))
    if not found:
        return None, 0, False
    sums = {
        name: sum(getattr(each, name) for each in found)
        for name in ("histories", "histories_done", "chunks", "chunks_done", "seconds", "retries")
    }
    damaged, broken = (tuple(word for each in found for word in getattr(each, name)) for name in ("damaged", "broken"))
    software = found[0].software
    status = CampaignStatus(folder, running=holder(folder), software=software, damaged=damaged, broken=broken, **sums)
    told = finished_rounds(folder)
    whole = told is not None and told["rounds"] == len(found) and status.complete
    return status, len(found), whole


def verified_rounds(folder: Path) -> list[Verification]:
    """Read everything that the rounds have that have begun."""
    found: list[Verification] = []
    while ((path := round_folder(folder, len(found))) / NAME).exists():
        with way_out(folder, len(found)):
            found.append(verified(path))
    return found


def finished_rounds(folder: Path) -> dict[str, int] | None:
    """Return what was noted when the last round was through.

    Returns rounds and histories; None if nothing was noted yet.
    """
    try:
        told = json.loads((folder / FINISHED).read_bytes())
        return {name: int(told[name]) for name in ("rounds", "histories")}
    except FileNotFoundError:
        return None
    except (ValueError, KeyError, TypeError) as error:
        advice = f"remove it, and go on with: {resume(folder)}"
        raise CampaignDamagedError(f"{folder / FINISHED} is damaged ({error}); {advice}") from error
