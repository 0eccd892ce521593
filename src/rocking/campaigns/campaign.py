"""A campaign: a large number of histories, computed once despite interruptions."""

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
    """A large number of histories, stored in a folder. A run continues after an interruption or after damage to files.

    `create` makes a campaign, `open` continues it. The results are equal to the last bit for any number of workers, any
    chunk size, any order of the chunks and any interruptions.

    Parameters
    ----------
    folder : Path
        The folder.
    histories : Histories
        The histories.
    identity : Identity
        Plan and description, stored at creation.
    """

    folder: Path
    histories: Histories
    identity: Identity

    @classmethod
    def create(cls, folder: str | os.PathLike[str], histories: Histories, chunk: int | None = None) -> "Campaign":
        """Create a campaign.

        Parameters
        ----------
        folder : path
            A new or empty folder.
        histories : Histories
            The histories.
        chunk : int, optional
            Histories per file of results (chunk). Default: a number that suits the engine. A chunk that needs more than
            a second is computed in pieces.

        Returns
        -------
        Campaign
            The campaign on disk, without results.

        Raises
        ------
        CampaignMismatchError
            If the folder is not empty.
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
        """Open a campaign to continue it.

        Parameters
        ----------
        folder : path
            The folder.
        histories : Histories
            The histories of the creation, with an equal description.

        Returns
        -------
        Campaign
            The campaign with its finished results.
        """
        path = Path(folder)
        with disk.guarded(path):
            identity = Identity.read(path)
        identity.refuse_other(path, _histories(histories))
        return cls(path, histories, identity)

    @staticmethod
    def status_of(folder: str | os.PathLike[str], *, verify: bool = True) -> CampaignStatus:
        """Return the progress of a campaign without its histories, also during a run of another process.

        Parameters
        ----------
        folder : path
            The folder; nothing is written there.
        verify : bool
            Read all results, and exclude damaged results. Otherwise the ledger is used without a check.

        Returns
        -------
        CampaignStatus
            Recorded progress at the time of the call.
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
        """Division into chunks."""
        return self.identity.plan

    def status(self, *, verify: bool = True) -> CampaignStatus:
        """Return the progress.

        Parameters
        ----------
        verify : bool
            Read all results, and exclude damaged results. Otherwise the ledger is used without a check.

        Returns
        -------
        CampaignStatus
            Recorded progress at the time of the call.
        """
        return self.status_of(self.folder, verify=verify)

    def check(self) -> Forecast:
        """Return a forecast from a sample of the histories, with required and free disk space.

        Returns
        -------
        Forecast
            Remaining time and disk space.
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
        """Compute missing and damaged chunks; a damaged ledger is renamed and rebuilt from the shards.

        Parameters
        ----------
        executor : {"serial", "processes"} or Executor
            This process, processes of this machine, or an object such as a `DaskExecutor`.
        workers : int, optional
            Threads or processes. Default: the number of processor cores.
        start_method : {"spawn", "fork", "forkserver"}, optional
            Start method of processes. Default: "spawn".
        order_seed : int, optional
            Random seed of the order of the chunks. Default: the order of the histories in each segment. The results
            do not depend on this order.
        progress : callable, optional
            Called with a `Progress` at the start and after every recorded chunk, while the next chunks are computed.

        Returns
        -------
        Summary
            Computed and damaged chunks.

        Raises
        ------
        InvalidValueError
            If an argument is out of range.
        CampaignMismatchError
            If the histories changed after the opening, or results of this machine differ in the last digits.
        CampaignBusyError
            If another process runs this campaign.
        CampaignStorageError
            If the disk is full or cannot be written.
        CampaignDamagedError
            If a file changes during the run.
        CampaignWorkerError
            If a chunk cannot be computed.
        CampaignInterrupted
            After Ctrl-C or SIGTERM.
        """
        if progress is not None and not callable(progress):
            raise InvalidValueError(parameter="progress", allowed="a function of a Progress, or None", value=progress)
        if order_seed is not None:
            checks.whole("order_seed", order_seed)
        who = chosen(executor, workers, start_method)
        self.identity.refuse_other(self.folder, self.histories)
        return run(self.folder, self.identity, self.histories, who, order_seed, progress)

    def pieces(self) -> Iterator[ledger.HistoryRange]:
        """Return the results in the order of the histories, with one chunk in memory at a time.

        Yields
        ------
        HistoryRange
            First history, history after the last one, and the results of these histories.
        """
        with disk.guarded(self.folder):
            yield from ledger.pieces(self.folder, self.plan)

    def results(self, *names: str) -> Arrays:
        """Return results of all histories: 83 bytes per history, or less for selected results.

        Parameters
        ----------
        *names : str
            Names of results; all by default.

        Returns
        -------
        dict of str to ndarray
            The keys with one entry per history.
        """
        types = self.histories.columns
        columns = [checks.one_of("column", name, types) for name in names or types]
        results = {name: np.empty(self.plan.count, types[name]) for name in columns}
        for piece in self.pieces():
            for name, values in results.items():
                values[piece.first : piece.last] = piece.results[name]
        return results

    def sha256(self) -> str:
        """Return the hash of all results. This hash does not depend on the chunk size.

        Returns
        -------
        str
            64 hexadecimal digits.
        """
        return ledger.digest(self.pieces())

    def verify(self) -> ledger.Verification:
        """Read all results and check that they are complete and unchanged.

        Returns
        -------
        Verification
            Damaged and missing histories; a run computes them.
        """
        return ledger.verified(self.folder)


def _histories(value: object) -> Histories:
    if not isinstance(value, Histories):
        raise InvalidValueError(parameter="histories", allowed="a Table, a Product or another Histories", value=value)
    return value
