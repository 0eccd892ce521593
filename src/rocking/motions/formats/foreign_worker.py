"""The other side of `foreign`: a program of its own, which keeps a reader loaded and lets it loose on files.

On Linux each file has a process of its own, forked from the one that has loaded the reader, with limits of time and
memory; elsewhere the files share one, which ends after the first that it refuses. Nothing of this package is imported.
"""

import io
import json
import os
import runpy
import signal
import struct
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

Answer = Callable[..., tuple[dict[str, Any], Sequence[Any]]]

FORKS = sys.platform == "linux"
"""Whether each file has a process of its own; elsewhere a fork after libraries have been loaded is not safe."""


def send(channel: BinaryIO, parts: Sequence[bytes]) -> None:
    """Write parts of a message."""
    channel.write(struct.pack("<I", len(parts)))
    for part in parts:
        channel.write(struct.pack("<Q", len(part)))
        channel.write(part)
    channel.flush()


def receive(channel: BinaryIO) -> list[bytes]:
    """Read the parts of a message."""

    def exactly(count: int) -> bytes:
        found = channel.read(count)
        if len(found) != count:
            raise EOFError
        return found

    (count,) = struct.unpack("<I", exactly(4))
    return [exactly(struct.unpack("<Q", exactly(8))[0]) for _ in range(count)]


def _answered(answer: Answer, parts: list[bytes]) -> list[bytes]:
    """Return the answer as parts: a description, arrays in NumPy's format; or what went wrong."""
    request, *files = parts
    try:
        said, arrays = answer(json.loads(request), *files)
        rows = [io.BytesIO() for _ in arrays]
        for row, values in zip(rows, arrays, strict=True):
            np.save(row, values, allow_pickle=False)
        return [json.dumps(said).encode(), *(row.getvalue() for row in rows)]
    except MemoryError:
        return [json.dumps({"memory": True}).encode()]
    except Exception as error:  # noqa: BLE001 - foreign code raises nearly any class
        return [json.dumps({"error": type(error).__name__, "message": str(error)[:300]}).encode()]


def _apart(
    answer: Answer, parts: list[bytes], seconds: float, memory: int, channels: tuple[BinaryIO, BinaryIO]
) -> list[bytes]:
    """Return the answer of a process of its own, or which signal ended it."""
    back, forth = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            # a child that outlives this process must not keep its pipes open
            for number in (back, *(each.fileno() for each in channels)):
                os.close(number)
            _limit(seconds, memory)
            with os.fdopen(forth, "wb") as channel:
                send(channel, _answered(answer, parts))
            code = 0
        finally:
            os._exit(code)
    os.close(forth)
    with os.fdopen(back, "rb") as channel:
        whole = channel.read()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return receive(io.BytesIO(whole)) if status == 0 else [json.dumps({"died": -status}).encode()]


def _limit(seconds: float, memory: int) -> None:
    import resource

    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGALRM})  # a parent may have held it back
    signal.setitimer(signal.ITIMER_REAL, seconds)
    loaded = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (loaded + memory, loaded + memory))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def main(script: str, seconds: float, memory: int) -> None:
    """Answer messages until there are no more; limits of time [s] and of memory beyond the loaded reader's [bytes]."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # what libraries print must not come between the messages
    channels = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(nothing, number)
    missing, answer = "", None
    try:
        reader = runpy.run_path(script)
        reader.get("prepare", lambda: None)()
        answer = reader["answer"]
    except ImportError as error:
        missing = error.name or str(error)
    while True:
        try:
            parts = receive(channels[0])
        except EOFError:
            return
        if answer is None:
            reply = [json.dumps({"missing": missing}).encode()]
        else:
            reply = _apart(answer, parts, seconds, memory, channels) if FORKS else _answered(answer, parts)
        send(channels[1], reply)
        if not FORKS and json.loads(reply[0]).keys() & {"error", "memory"}:
            return


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), int(sys.argv[3]))
