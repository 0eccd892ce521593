"""Processes of runs. A process ends with the server, because its standard input is a pipe from the server."""

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

GRACE = 0.4  # time between the request to stop and the forced end of a process [s]
STOPPED = 3  # exit code of a stopped process
LOG = "log.txt"  # file name in the folder of a run


class RunProcess:
    """A process group that runs a module with arguments. If a folder is given, errors are written to its log."""

    def __init__(
        self, *command: str, nice: int, grace: float = GRACE, folder: Path | None = None, **environment: str
    ) -> None:
        self.environment, self._grace = dict(os.environ), grace
        with (Path(os.devnull) if folder is None else folder / LOG).open("ab") as log:
            self.log_start = log.tell()
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", *command], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=log,
                cwd=folder, start_new_session=True, env={**os.environ, "PYTHONUNBUFFERED": "1", **environment},
            )  # fmt: skip
        with suppress(OSError, AttributeError):  # some systems have no priorities of processes
            os.setpriority(os.PRIO_PROCESS, self._process.pid, os.getpriority(os.PRIO_PROCESS, 0) + nice)

    @property
    def code(self) -> int | None:
        """Exit code; None while the process runs, negative after a signal."""
        return self._process.poll()

    def send(self, line: bytes) -> None:
        """Write to the standard input. An ended process causes no error here, and is detected by its exit code."""
        with suppress(OSError):
            self._process.stdin.write(line + b"\n")  # type: ignore[union-attr]
            self._process.stdin.flush()  # type: ignore[union-attr]

    def stop(self) -> int:
        """Interrupt the process, kill its group after the grace time, and return the exit code."""
        if self.code is None and self._grace:
            with suppress(OSError, ValueError):  # some systems do not support this signal
                self._process.send_signal(signal.SIGINT)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(self._grace)
        if self.code is None:
            with suppress(OSError):
                self._process.kill() if sys.platform == "win32" else os.killpg(self._process.pid, signal.SIGKILL)
        code = self._process.wait()
        with suppress(OSError):
            self._process.stdin.close()  # type: ignore[union-attr]
        return code


def end_with_the_server() -> None:
    """Wait for the end of the server, then end this process group."""
    with suppress(OSError):
        while os.read(0, 1):
            pass
    with suppress(OSError):
        os.kill(os.getpid(), signal.SIGINT)
    time.sleep(GRACE)
    if sys.platform == "win32":
        os._exit(STOPPED)
    else:
        # the group contains only this process and its workers
        os.killpg(os.getpgrp(), signal.SIGKILL) if os.getpgrp() == os.getpid() else os._exit(STOPPED)
