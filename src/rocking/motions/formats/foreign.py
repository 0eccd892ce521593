"""Readers of foreign code in a program of their own: what crashes, hangs or eats memory there is a refusal here."""

import atexit
import json
import os
import signal
import subprocess
import sys
import threading
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from rocking.errors import MissingExtraError, RecordError, how_to_install
from rocking.motions.formats import foreign_worker
from rocking.motions.formats.record import Source

TO_START = 60.0  # time to start and to load the reader, on a busy machine [s]
_MOST_IDLE = 2
_TROUBLE = {"missing", "error", "memory", "died"}


class ForeignReader:
    """A reader in another process, kept for the next file; with limits of time [s] and, on Linux, memory [bytes]."""

    def __init__(
        self, script: Path, needs: str, module: str, *, seconds: float = 30.0, memory: int = 4 * 2**30
    ) -> None:
        self.script, self.needs, self.module = script, needs, module
        self.seconds, self.memory = seconds, memory
        # by process: one that was forked must not talk to its parent's reader
        self._idle: dict[int, list[subprocess.Popen[bytes]]] = {}
        self._lock = threading.Lock()
        atexit.register(self.close)

    def answer(self, source: Source, request: dict[str, Any], *files: bytes) -> tuple[dict[str, Any], list[Any]]:
        """Return what the reader says of a file."""
        parts = [json.dumps(request).encode(), *files]
        while True:
            worker, fresh = self._taken()
            slow = threading.Event()

            def stop(worker: subprocess.Popen[bytes] = worker, slow: threading.Event = slow) -> None:
                slow.set()
                worker.kill()

            timer = threading.Timer(self.seconds + TO_START, stop)
            timer.daemon = True
            timer.start()
            try:
                foreign_worker.send(worker.stdin, parts)  # type: ignore[arg-type]
                said, *arrays = foreign_worker.receive(worker.stdout)  # type: ignore[arg-type]
            except (OSError, EOFError) as error:
                _end(worker)
                # one that has read other files before may have been damaged by these
                if fresh or slow.is_set():
                    raise self._refusal(source, {"slow": True} if slow.is_set() else {"died": 0}) from error
            except BaseException:
                _end(worker)
                raise
            else:
                self._give_back(worker)
                found = json.loads(said)
                if found.keys() & _TROUBLE:
                    raise self._refusal(source, found)
                return found, [np.load(BytesIO(part), allow_pickle=False) for part in arrays]
            finally:
                timer.cancel()

    def close(self) -> None:
        """End the processes that wait for files."""
        with self._lock:
            waiting = self._idle.pop(os.getpid(), [])
        for worker in waiting:
            _end(worker)

    def _taken(self) -> tuple[subprocess.Popen[bytes], bool]:
        with self._lock:
            waiting = self._idle.setdefault(os.getpid(), [])
            if waiting:
                return waiting.pop(), False
        # -P: the folder of the worker holds modules of the names of Python's own
        command = [sys.executable, "-P", foreign_worker.__file__, str(self.script)]
        command += [str(self.seconds), str(self.memory)]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "OPENBLAS_NUM_THREADS": "1"}
        quiet = getattr(subprocess, "CREATE_NO_WINDOW", 0)
        try:
            made = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment,
                creationflags=quiet,
            )  # fmt: skip
        except OSError as error:
            raise RecordError(
                "no process for {format} can be started: {reason}", format=self.needs, reason=str(error)
            ) from error
        return made, True

    def _give_back(self, worker: subprocess.Popen[bytes]) -> None:
        with self._lock:
            waiting = self._idle.setdefault(os.getpid(), [])
            if len(waiting) < _MOST_IDLE and worker.poll() is None:
                waiting.append(worker)
                return
        _end(worker)

    def _refusal(self, source: Source, said: dict[str, Any]) -> Exception:
        if "missing" in said:
            return MissingExtraError(how_to_install(source.name, self.module, ImportError(name=said["missing"])))
        if "error" in said:
            return source.error(
                None, "{format} cannot read it: {reason:.180}", format=self.needs,
                reason=said["message"] or said["error"],
            )  # fmt: skip
        if "memory" in said:
            return source.error(
                None, "{format} needs more than {memory:g} GiB for it", format=self.needs, memory=self.memory / 2**30,
                hint="damaged?",
            )  # fmt: skip
        died = said.get("died")
        if "slow" in said or died == getattr(signal, "SIGALRM", None):
            return source.error(
                None, "{format} takes more than {time:g} s for it", format=self.needs, time=self.seconds,
                hint="damaged?",
            )  # fmt: skip
        name = signal.Signals(died).name if died in set(signal.Signals) else "its process ended"
        return source.error(
            None, "{format} crashes on it ({signal}): the file is damaged", format=self.needs, signal=name
        )


def _end(worker: subprocess.Popen[bytes]) -> None:
    worker.kill()
    worker.communicate()
