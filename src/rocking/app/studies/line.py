"""The line of studies: one after another is computed, watched, and told of."""

import threading
from collections.abc import Callable
from typing import Any

from rocking.app.problems import Busy, NotFound
from rocking.app.studies.study import Study
from rocking.app.studies.study_folder import FAILED, INTERRUPTED, WAITING

LOOK = 0.2
"""Time between looks at what runs [s]."""


class Line:
    """Studies of which a few run, some wait and the others do neither; safe to use from several threads.

    Parameters
    ----------
    studies : dict of str to Study
        Those that are there already, by name in addresses.
    workers : int
        Threads or processes for a study.
    at_once : int
        Studies that run at the same time [-].
    longest : int
        Studies that may wait [-].
    """

    def __init__(self, studies: dict[str, Study], workers: int, at_once: int, longest: int) -> None:
        self.lock = threading.RLock()
        self.published: dict[str, dict[str, Any]] = {}
        self.closed = False
        self._studies, self._workers, self._at_once, self._longest = studies, workers, at_once, longest
        self._wake = threading.Event()
        self._listeners: set[Callable[[], None]] = set()
        self._entering = 0
        self._thread: threading.Thread | None = None
        self.publish()

    def study(self, name: str) -> Study:
        """Return a study.

        Parameters
        ----------
        name : str
            Its name in addresses.

        Returns
        -------
        Study
            The study.

        Raises
        ------
        NotFound
            If there is none.
        """
        found = self._studies.get(name)
        if found is None:
            raise NotFound("there is no such study; it may have been deleted")
        return found

    def enter(self, make: Callable[[], Study]) -> Study:
        """Put a study in line; its place is kept while it is made.

        Parameters
        ----------
        make : callable
            Returns the study, which waits.

        Returns
        -------
        Study
            The study.

        Raises
        ------
        Busy
            If too many wait.
        """
        with self.lock:
            waiting = self._entering + sum(each.meta.state == WAITING for each in self._studies.values())
            if waiting >= self._longest:
                raise Busy(f"{waiting} studies wait already; try again when one is done", seconds=30)
            self._entering += 1
        try:
            study = make()
            with self.lock:
                self._studies[study.folder.id] = study
        finally:
            with self.lock:
                self._entering -= 1
        self.changed()
        return study

    def leave(self, name: str) -> Study:
        """Take a study out for good.

        Parameters
        ----------
        name : str
            Its name in addresses.

        Returns
        -------
        Study
            The study; its process, if it has one, still runs.
        """
        with self.lock:
            found = self.study(name)
            found.cancelled = True
            return self._studies.pop(name)

    def end(self, study: Study) -> None:
        """Note how a study ended, once its process has.

        Parameters
        ----------
        study : Study
            The study.
        """
        with self.lock:
            study.end(closed=self.closed)

    def subscribe(self, tell: Callable[[], None]) -> Callable[[], None]:
        """Be told of every change, from whatever thread.

        Parameters
        ----------
        tell : callable
            Called without arguments; it must return at once.

        Returns
        -------
        callable
            Ends it.
        """
        with self.lock:
            self._listeners.add(tell)
        return lambda: self._listeners.discard(tell)

    @property
    def watchers(self) -> int:
        """How many are told of changes."""
        return len(self._listeners)

    def changed(self) -> None:
        """Look at the line at once."""
        with self.lock:
            if self._thread is None and not self.closed:
                self._thread = threading.Thread(target=self._watch, name="studies", daemon=True)
                self._thread.start()
        self.publish()
        self._wake.set()

    def publish(self) -> None:
        """Tell of what has changed since it was told."""
        with self.lock:
            studies = sorted(self._studies.values(), key=lambda each: (each.meta.created, each.folder.id), reverse=True)
            now = {each.folder.id: each.facts for each in studies}
            if now == self.published:
                return
            self.published = now
            listeners = list(self._listeners)
        for tell in listeners:
            tell()

    def close(self) -> None:
        """Stop what runs, so that it can be resumed, and watch no longer."""
        self.closed = True
        self._wake.set()
        if self._thread is not None:
            self._thread.join()
        for found in list(self._studies.values()):
            if found.process is not None:
                found.process.stop()
                self.end(found)
            elif found.meta.state == WAITING:
                found.become(INTERRUPTED, "the server was closed before it began; resume it")
        self.publish()

    def _watch(self) -> None:
        while not self.closed:
            for each in self._running():
                each.look()
                if each.process is not None and each.process.code is not None and not each.cancelled:
                    self.end(each)
            self._begin_next()
            self.publish()
            self._wake.wait(LOOK if self._running() else None)
            self._wake.clear()

    def _running(self) -> list[Study]:
        with self.lock:
            return [each for each in self._studies.values() if each.process is not None]

    def _begin_next(self) -> None:
        with self.lock:
            waiting = [each for each in self._studies.values() if each.meta.state == WAITING]
            room = max(0, self._at_once - len(self._running()))
            for each in sorted(waiting, key=lambda one: one.meta.created)[:room]:
                try:
                    each.begin(self._workers)
                except OSError as error:
                    each.become(FAILED, f"its process could not be started ({error.strerror or error}); resume it")
