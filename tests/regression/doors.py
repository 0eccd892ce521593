"""The doors that the cases go through: when one moves or is renamed, this file alone follows; the answers must not."""

import contextlib
import io
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import rocking as rk
from rocking.cli import main, page
from rocking.dynamics.rolling import SpatialStart
from rocking.dynamics.rolling.batch import batch_in_space

simulate = rk.simulate
simulate_many = rk.simulate_many
free_rocking = rk.free_rocking


def with_contact(body, motion, friction, **how):
    """Return what slides and hops, impacts by complementarity."""
    return rk.simulate(body, motion, None, friction=friction, **how)


def in_space(body, x, y, z, law, **how):
    """Return a response in space."""
    return rk.simulate(body, {"x": x, "y": y, "z": z}, law, **how)


def free_in_space(body, tilt, azimuth, law, **how):
    """Return a response in space on ground at rest."""
    return rk.free_rocking(body, restitution=law, start=SpatialStart(tilt, azimuth), **how)


many_in_space = batch_in_space
overturning_map = rk.overturning_map
rocking_spectrum = rk.rocking_spectrum
minimum = rk.minimum_overturning_acceleration


def response_tree(response: Any) -> dict[str, Any]:
    """Return what a response of any mechanics says."""
    names = (
        "outcome", "status", "still_rocking", "overturning_time", "peak_rotation", "peak_tilt", "error_estimate",
        "impacts", "uplifts", "least_force", "lost_contact", "unfinished", "doubts", "sliding_distance", "cut_impacts",
        "near_flat_passages", "overturned_over", "overturning_direction", "summary",
    )  # fmt: skip
    said = {name: getattr(response, name) for name in names if hasattr(response, name)}
    data = response.to_xarray()
    if "random_stream" in data.attrs:  # random_key before
        data.attrs["random_key"] = data.attrs.pop("random_stream")
    return said | {"data": data}


def command(words: list[str], folder: Path) -> dict[str, Any]:
    """Return exit code, output and errors of `rocking WORDS`, in a folder."""
    out, err, before = io.StringIO(), io.StringIO(), Path.cwd()
    code: Any = None
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), _without_progress():
            main(words)
    except SystemExit as stop:
        code = stop.code or 0
    finally:
        os.chdir(before)
    return {"code": code, "out": out.getvalue(), "err": err.getvalue()}


@contextlib.contextmanager
def _without_progress() -> Iterator[None]:
    """Print no line of progress, which only a slow machine prints."""
    interval, page.SECONDS = page.SECONDS, 1e6  # [s]
    try:
        yield
    finally:
        page.SECONDS = interval


@contextlib.contextmanager
def application(folder: Path) -> Iterator[Any]:
    """Give a client of the web application that may do everything."""
    import warnings

    from rocking_workbench.application import create_app
    from rocking_workbench.settings import ServerSettings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from fastapi.testclient import TestClient
    settings = ServerSettings(folder=folder, workers=1)
    app = create_app(settings)
    head = {"Authorization": f"Bearer {app.state.rocking.sessions.key}", "Origin": settings.origin}
    with TestClient(app, base_url=settings.origin, headers=head) as client:
        yield client
