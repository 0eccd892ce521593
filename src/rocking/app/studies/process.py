"""The process that computes a study, as the server sees it: begun, asked to stop, made to stop."""

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

from rocking.app.studies.child import GRACE
from rocking.app.studies.study_folder import LOG, StudyFolder

_LONGEST_SENTENCE = 1000


class StudyProcess:
    """A process, and the group of its workers, that computes a study."""

    def __init__(self, folder: StudyFolder, workers: int) -> None:
        self.folder = folder
        command = [sys.executable, "-P", "-m", "rocking.app.studies.child", str(folder.path), str(workers)]
        with (folder.path / LOG).open("ab") as log:
            self._begin = log.tell()
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=log, cwd=folder.path,
                start_new_session=True, env={**os.environ, "PYTHONUNBUFFERED": "1"},
            )  # fmt: skip

    @property
    def code(self) -> int | None:
        """Exit code; None while it runs, negative where a signal ended it."""
        return self._process.poll()

    def stop(self, patience: float = GRACE) -> int:
        """Ask it to stop, and make it stop if it does not: what is finished is safe either way.

        patience: how long to wait for it [s].
        """
        if self._process.poll() is None:
            with contextlib.suppress(OSError, ValueError):  # some systems have no such signal
                self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(patience)
            except subprocess.TimeoutExpired:
                self.kill()
        self.kill()
        return self._process.wait()

    def kill(self) -> None:
        """End it and all its workers at once."""
        with contextlib.suppress(OSError):
            if sys.platform == "win32":
                self._process.kill()
            elif self._process.poll() is None:
                os.killpg(self._process.pid, signal.SIGKILL)

    def close(self) -> None:
        """Let go of the pipe, once it has ended."""
        if self._process.stdin is not None:
            self._process.stdin.close()

    def refusal(self) -> str:
        """Return why it ended, in words that a user may see.

        Returns its own sentence, or where to look for more.
        """
        try:
            with (self.folder.path / LOG).open("rb") as log:
                log.seek(self._begin)
                lines = log.read(1 << 20).decode(errors="replace").splitlines()
        except OSError:
            lines = []
        told = [line.removeprefix("refused: ") for line in lines if line.startswith("refused: ")]
        if told:
            return self.folder.without_paths(told[-1])[:_LONGEST_SENTENCE]
        how = "was ended by the system" if (self.code or 0) < 0 else "ended unexpectedly"
        return f"the computation {how}; what was finished is safe, and its log is {Path(self.folder.id) / LOG}"


def processors() -> int:
    """Return how many processors this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1
