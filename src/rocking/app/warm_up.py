"""What all users share, computed while the first one still looks at the first page."""

import contextlib
import threading
import time
from collections.abc import Callable
from typing import Any

from rocking.errors import RockingError

Step = Callable[[], Any]

_FIRST_PAGE_SECONDS = 0.5
_BREATH_SECONDS = 0.02
_BLOCK = {"units": "m", "width": 1.0, "height": 4.0}


def warm_up_later(*more: Step) -> None:
    """Start to warm up in a thread, once the first page has had its time."""
    timer = threading.Timer(_FIRST_PAGE_SECONDS, warm_up, more)
    timer.daemon = True
    timer.start()


def warm_up(*more: Step) -> None:
    """Fit the calibration, answer one question of each kind and draw one picture.

    What cannot be had, such as pictures without their extra, is left for the request that asks for it.
    """
    for step in (_impact, _response, _picture, *more):
        with contextlib.suppress(ImportError, RockingError):
            step()
        time.sleep(_BREATH_SECONDS)


def _impact() -> None:
    from rocking.app.api.impact import warm_up as first_impact

    first_impact()


def _response() -> None:
    from rocking.app.api.answers import ResponseAnswers
    from rocking.app.question import body_from
    from rocking.app.schemas.inputs import ResponseAsked
    from rocking.motions.pulses import pulse
    from rocking.motions.spectrum import response_spectrum
    from rocking.plots.traces import fine_samples
    from rocking.studies.job.response import question_from

    moved = "sine:amplitude=3,period=0.8"
    asked = ResponseAsked.model_validate({"body": _BLOCK, "motion": {"pulse": moved}})
    motion = pulse(moved)
    ResponseAnswers.of(question_from(asked, body_from(asked.body), motion)).facts(10)
    response_spectrum(fine_samples(motion), [1.0], 0.05)


def _picture() -> None:
    from rocking.app.takeaway.drawing import drawn
    from rocking.bodies import Block
    from rocking.plots._body_picture import body_picture

    for kind in ("svg", "png"):
        drawn(lambda: body_picture(Block(width=1.0, height=4.0)), kind)
