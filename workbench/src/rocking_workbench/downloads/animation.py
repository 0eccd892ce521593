"""The animation as a web page, or as a GIF from a separate process."""

import pickle
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rocking import Response
from rocking.errors import RockingError
from rocking.reports.response_facts import restitution_words
from rocking_workbench.errors import Busy, Refused

_FRAME, _MOST_FRAMES = 0.08, 150
_LONGEST = 90.0
_REFUSED = 3


def page_of(response: Response) -> bytes:
    """Return the animation as a web page."""
    from rocking.plots.animation import page

    label = response.parameters.label
    return page(response).replace(f"restitution {label};", f"restitution {restitution_words(label)};", 1).encode()


def gif_of(response: Response) -> bytes:
    """Return the animation as a GIF with at most 150 frames."""
    with TemporaryDirectory(prefix="rocking-film-") as folder:
        path = Path(folder) / "animation.gif"
        command = [sys.executable, "-m", "rocking_workbench.downloads.animation", str(path)]
        try:
            done = subprocess.run(
                command, input=pickle.dumps(response), capture_output=True, timeout=_LONGEST, check=False
            )
        except subprocess.TimeoutExpired as error:
            raise Busy("drawing the frames takes too long; export the page (html), or try again", seconds=60) from error
        if done.returncode == _REFUSED:
            raise Refused(done.stderr.decode("utf-8", "replace").strip())
        if done.returncode:
            raise RuntimeError(done.stderr.decode("utf-8", "replace"))
        return path.read_bytes()


def _main() -> int:
    from rocking.plots import animate_gif
    from rocking.plots.response import shown_until

    # safe to unpickle: the pipe contains only data of the parent process
    response = pickle.loads(sys.stdin.buffer.read())
    try:
        speed = max(1.0, float(np.ceil(100.0 * shown_until(response) / (_FRAME * (_MOST_FRAMES - 2)))) / 100.0)
        animate_gif(response, Path(sys.argv[1]), fps=1.0 / _FRAME, speed=speed)
    except RockingError as error:
        sys.stderr.write(str(error))
        return _REFUSED
    return 0


if __name__ == "__main__":
    sys.exit(_main())
