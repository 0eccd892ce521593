"""A campaign: very many histories, computed once, whatever happens on the way."""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking import checks
from rocking.campaigns import disk, ledger
from rocking.campaigns.chunks import Plan
from rocking.campaigns.disk import NAME as LOCK
from rocking.campaigns.disk import FolderLock, holder
from rocking.campaigns.executors import Executor
from rocking.campaigns.forecast import Forecast, forecast
from rocking.campaigns.identity import NAME, SHARDS, Identity
from rocking.campaigns.ledger import NAME as LEDGER
from rocking.campaigns.ledger import Ledger
from rocking.campaigns.processes import chosen
from rocking.campaigns.running import run
from rocking.campaigns.status import CampaignStatus, Progress, Summary
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.errors import InvalidValueError
from rocking.studies.histories import Histories


@dataclass(frozen=True)
class Campaign:
    """Very many histories in a folder: interrupted, killed or damaged, it goes on where it stood.

    Make one with `create`, or go on with `open`; the results are the same to the last bit whatever the workers, the
    size of the chunks, the order and the interruptions.

    Parameters
    ----------
    folder : Path
        Where it is kept.
    histories : Histories
        What is computed.
    identity : Identity
        What was written when it was created.
    """

    folder: Path
    histories: Histories
    identity: Identity

    @classmethod
    def create(cls, folder: str | os.PathLike[str], histories: Histories, chunk: int | None = None) -> "Campaign":
        """Begin a campaign.

        Parameters
        ----------
        folder : path
            Where to keep it: a new folder, or an empty one.
        histories : Histories
            What to compute.
        chunk : int, optional
            Histories of a file of results, a chunk; what suits the engine, if not given. One that takes longer than a
            second is computed in pieces.

        Returns
        -------
        Campaign
            It is on disk; nothing is computed yet.

        Raises
        ------
        CampaignMismatchError
            If the folder holds something already.
        """
        path = Path(folder)
        identity = Identity.of(_histories(histories), chunk)
        with disk.guarded(path, lambda: "nothing was written"):
            disk.make_folder(path)
            with FolderLock(path):
                disk.refuse_used(path, NAME, {LOCK, SHARDS}, "open it, or take a new folder")
                disk.make_folder(path / SHARDS)
                identity.write(path)
        return cls(path, histories, identity)

    @classmethod
    def open(cls, folder: str | os.PathLike[str], histories: Histories) -> "Campaign":
        """Go on with a campaign.

        Parameters
        ----------
        folder : path
            Where it is kept.
        histories : Histories
            The same as when it was created: they must describe themselves alike.

        Returns
        -------
        Campaign
            With all that is finished.
        """
        path = Path(folder)
        with disk.guarded(path):
            identity = Identity.read(path)
        identity.refuse_other(path, _histories(histories))
        return cls(path, histories, identity)

    @staticmethod
    def status_of(folder: str | os.PathLike[str], *, verify: bool = True) -> CampaignStatus:
        """Return how far a campaign is, without its histories and while another process may run it.

        Parameters
        ----------
        folder : path
            Where it is kept; nothing is written there.
        verify : bool
            Whether to read all results: what is damaged does not count. Without it the ledger is believed.

        Returns
        -------
        CampaignStatus
            As recorded at this instant.
        """
        path = Path(folder)
        with disk.guarded(path):
            plan = Identity.read(path).plan
            running = holder(path)
            nothing = CampaignStatus(path, plan.count, 0, plan.chunks, 0, running, 0.0, 0, (), plan.software, None)
            if not (path / LEDGER).exists():
                return nothing
            with Ledger(path) as book, book.instant():
                if not book.begun:
                    return nothing
                chunks, histories = book.finished()
                effort, damaged = book.effort(), tuple(book.events("damaged"))
                work = book.costs(plan.count).left()
            broken: tuple[str, ...] = ()
            if verify:
                read = ledger.verified(path)
                chunks, histories, broken = read.chunks, read.verified, read.damaged
            done = (plan.count, histories, plan.chunks, chunks)
            return CampaignStatus(path, *done, running, *effort, damaged, plan.software, work, broken)

    @property
    def plan(self) -> Plan:
        """How it is cut."""
        return self.identity.plan

    def status(self, *, verify: bool = True) -> CampaignStatus:
        """Return how far it is.

        Parameters
        ----------
        verify : bool
            Whether to read all results: what is damaged does not count. Without it the ledger is believed.

        Returns
        -------
        CampaignStatus
            As recorded at this instant.
        """
        return self.status_of(self.folder, verify=verify)

    def check(self) -> Forecast:
        """Look ahead: compute a sample of the histories and compare the room on the disk with what is needed.

        Returns
        -------
        Forecast
            What remains to be done will take this.
        """
        return forecast(self.status(verify=False), self.plan, self.histories)

    def run(
        self,
        executor: str | Executor = "serial",
        *,
        workers: int | None = None,
        start_method: str | None = None,
        order_seed: int | None = None,
        progress: Callable[[Progress], object] | None = None,
    ) -> Summary:
        """Compute what is missing or damaged; a damaged ledger is set aside, and made anew from the shards.

        Parameters
        ----------
        executor : {"serial", "processes"} or Executor
            Who computes: this process, processes of this machine, or what was made before, as a `DaskExecutor`.
        workers : int, optional
            Threads, or processes; as many as the processor has, if not given.
        start_method : {"spawn", "fork", "forkserver"}, optional
            How processes start; "spawn" if not given.
        order_seed : int, optional
            Seed of the order of the chunks; that of the histories in every part, if not given. The results do not
            depend on it.
        progress : callable, optional
            Called with a `Progress` at the start and after every recorded chunk, while the next ones are computed.

        Returns
        -------
        Summary
            What was done, and what was found damaged.

        Raises
        ------
        InvalidValueError
            If an argument is out of range.
        CampaignMismatchError
            If the histories have changed since the campaign was opened, or this machine computes other last digits.
        CampaignBusyError
            If another process runs this campaign.
        CampaignStorageError
            If the disk is full or cannot be written.
        CampaignDamagedError
            If a file changes while it runs.
        CampaignWorkerError
            If a chunk cannot be computed.
        CampaignInterrupted
            If Ctrl-C or SIGTERM asked it to stop.
        """
        if progress is not None and not callable(progress):
            raise InvalidValueError(parameter="progress", allowed="a function of a Progress, or None", value=progress)
        if order_seed is not None:
            checks.whole("order_seed", order_seed)
        who = chosen(executor, workers, start_method)
        self.identity.refuse_other(self.folder, self.histories)
        return run(self.folder, self.identity, self.histories, who, order_seed, progress)

    def pieces(self) -> Iterator[ledger.HistoryRange]:
        """Return the results in the order of the histories, one chunk in memory at a time.

        Yields
        ------
        HistoryRange
            First history, last one (not included), and their results.
        """
        with disk.guarded(self.folder):
            yield from ledger.pieces(self.folder, self.plan)

    def results(self, *names: str) -> Arrays:
        """Return results of all histories at once: 83 bytes a history, less if only some are wanted.

        Parameters
        ----------
        *names : str
            Names of results; all of them if none is given.

        Returns
        -------
        dict of str to ndarray
            Those keys, one entry a history.
        """
        types = self.histories.columns
        wanted = [checks.one_of("column", name, types) for name in names or types]
        whole = {name: np.empty(self.plan.count, types[name]) for name in wanted}
        for piece in self.pieces():
            for name, values in whole.items():
                values[piece.first : piece.last] = piece.results[name]
        return whole

    def sha256(self) -> str:
        """Return the hash of all results; it does not depend on the size of the chunks.

        Returns
        -------
        str
            64 hexadecimal digits.
        """
        return ledger.digest(self.pieces())

    def verify(self) -> ledger.Verification:
        """Read every result, and see that all are there once, and are what was written.

        Returns
        -------
        Verification
            What is damaged or missing; a run computes that.
        """
        return ledger.verified(self.folder)


def _histories(value: object) -> Histories:
    if not isinstance(value, Histories):
        raise InvalidValueError(parameter="histories", allowed="a Table, a Product or another Histories", value=value)
    return value
