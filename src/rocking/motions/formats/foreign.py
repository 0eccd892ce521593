"""Readers from other packages in separate processes. Crashes and exceeded limits of time and memory become errors."""

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

TO_START = 60.0  # allowed time for the start of the reader [s]
_MOST_IDLE = 2
_TROUBLE = {"missing", "error", "memory", "died"}


class ForeignReader:
    """A reader in another process for several files, with a limit of time [s] and, on Linux, of memory [bytes]."""

    def __init__(
        self, script: Path, needs: str, module: str, *, seconds: float = 30.0, memory: int = 4 * 2**30
    ) -> None:
        self.script, self.needs, self.module = script, needs, module
        self.seconds, self.memory = seconds, memory
        # by process id, because a forked process must not use the reader of its parent
        self._idle: dict[int, list[subprocess.Popen[bytes]]] = {}
        self._lock = threading.Lock()
        atexit.register(self.close)

    def answer(self, source: Source, request: dict[str, Any], *files: bytes) -> tuple[dict[str, Any], list[Any]]:
        """Return the result of the reader for a file: a description and arrays."""
        message = [json.dumps(request).encode(), *files]
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
                foreign_worker.send(worker.stdin, message)  # type: ignore[arg-type]
                header, *arrays = foreign_worker.receive(worker.stdout)  # type: ignore[arg-type]
            except (OSError, EOFError) as error:
                _end(worker)
                # earlier files may have damaged a worker that is not new; it is then replaced
                if fresh or slow.is_set():
                    raise self._refusal(source, {"slow": True} if slow.is_set() else {"died": 0}) from error
            except BaseException:
                _end(worker)
                raise
            else:
                self._give_back(worker)
                answer = json.loads(header)
                if answer.keys() & _TROUBLE:
                    raise self._refusal(source, answer)
                return answer, [np.load(BytesIO(array), allow_pickle=False) for array in arrays]
            finally:
                timer.cancel()

    def close(self) -> None:
        """End idle processes."""
        with self._lock:
            waiting = self._idle.pop(os.getpid(), [])
        for worker in waiting:
            _end(worker)

    def _taken(self) -> tuple[subprocess.Popen[bytes], bool]:
        with self._lock:
            waiting = self._idle.setdefault(os.getpid(), [])
            if waiting:
                return waiting.pop(), False
        # -P is required, because the folder of the worker contains modules with names of the standard library
        command = [sys.executable, "-P", foreign_worker.__file__, str(self.script)]
        command += [str(self.seconds), str(self.memory)]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "OPENBLAS_NUM_THREADS": "1"}
        quiet = getattr(subprocess, "CREATE_NO_WINDOW", 0)
        try:
            worker = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment,
                creationflags=quiet,
            )  # fmt: skip
        except OSError as error:
            raise RecordError(
                "cannot start a process for {format}: {reason}", format=self.needs, reason=str(error)
            ) from error
        return worker, True

    def _give_back(self, worker: subprocess.Popen[bytes]) -> None:
        with self._lock:
            waiting = self._idle.setdefault(os.getpid(), [])
            if len(waiting) < _MOST_IDLE and worker.poll() is None:
                waiting.append(worker)
                return
        _end(worker)

    def _refusal(self, source: Source, trouble: dict[str, Any]) -> Exception:
        if "missing" in trouble:
            return MissingExtraError(how_to_install(source.name, self.module, ImportError(name=trouble["missing"])))
        if "error" in trouble:
            return source.error(
                None, "{format} cannot read the file: {reason:.180}", format=self.needs,
                reason=trouble["message"] or trouble["error"],
            )  # fmt: skip
        if "memory" in trouble:
            return source.error(
                None, "{format} requires more than {memory:g} GiB for the file", format=self.needs,
                memory=self.memory / 2**30, hint="the file may be damaged",
            )  # fmt: skip
        died = trouble.get("died")
        if "slow" in trouble or died == getattr(signal, "SIGALRM", None):
            return source.error(
                None, "{format} requires more than {time:g} s for the file", format=self.needs, time=self.seconds,
                hint="the file may be damaged",
            )  # fmt: skip
        name = signal.Signals(died).name if died in set(signal.Signals) else "the process ended"
        return source.error(None, "{format} crashes ({signal}): the file is damaged", format=self.needs, signal=name)


def _end(worker: subprocess.Popen[bytes]) -> None:
    worker.kill()
    worker.communicate()
