"""Worker program of `foreign`. It loads a reader once, and reads files.

On Linux, every file is read in a separate process, forked from the process with the loaded reader, with limits of time
and memory. On other systems, one process reads all files and ends after the first error. The program imports no module
of this package.
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
"""True if every file has its own process. On systems other than Linux, a fork with loaded libraries is not safe."""


def send(channel: BinaryIO, parts: Sequence[bytes]) -> None:
    """Write parts of a message."""
    channel.write(struct.pack("<I", len(parts)))
    for data in parts:
        channel.write(struct.pack("<Q", len(data)))
        channel.write(data)
    channel.flush()


def receive(channel: BinaryIO) -> list[bytes]:
    """Read the parts of a message."""

    def exactly(count: int) -> bytes:
        data = channel.read(count)
        if len(data) != count:
            raise EOFError
        return data

    (count,) = struct.unpack("<I", exactly(4))
    return [exactly(struct.unpack("<Q", exactly(8))[0]) for _ in range(count)]


def _answered(answer: Answer, parts: list[bytes]) -> list[bytes]:
    """Return the result as parts: a description and arrays in NumPy format, or an error."""
    request, *files = parts
    try:
        description, arrays = answer(json.loads(request), *files)
        rows = [io.BytesIO() for _ in arrays]
        for row, values in zip(rows, arrays, strict=True):
            np.save(row, values, allow_pickle=False)
        return [json.dumps(description).encode(), *(row.getvalue() for row in rows)]
    except MemoryError:
        return [json.dumps({"memory": True}).encode()]
    except Exception as error:  # noqa: BLE001 - foreign code raises nearly any class
        return [json.dumps({"error": type(error).__name__, "message": str(error)[:300]}).encode()]


def _apart(
    answer: Answer, parts: list[bytes], seconds: float, memory: int, channels: tuple[BinaryIO, BinaryIO]
) -> list[bytes]:
    """Return the result of a forked process, or the signal that ended it."""
    back, forth = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            # copies of the pipes of this process: with them, the pipes stay open until the child process ends
            for number in (back, *(pipe.fileno() for pipe in channels)):
                os.close(number)
            _limit(seconds, memory)
            with os.fdopen(forth, "wb") as channel:
                send(channel, _answered(answer, parts))
            code = 0
        finally:
            os._exit(code)
    os.close(forth)
    with os.fdopen(back, "rb") as channel:
        message = channel.read()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return receive(io.BytesIO(message)) if status == 0 else [json.dumps({"died": -status}).encode()]


def _limit(seconds: float, memory: int) -> None:
    import resource

    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGALRM})  # a parent process may have blocked the signal
    signal.setitimer(signal.ITIMER_REAL, seconds)
    loaded = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (loaded + memory, loaded + memory))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def main(script: str, seconds: float, memory: int) -> None:
    """Process messages to the end of input.

    The limits are time [s] and memory in addition to the loaded reader [bytes].
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # the output of libraries must not mix with the messages
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
