"""The JSON of `rocking simulate`: what `rocking.report.facts.response` says, and what other models say.

``still_rocking`` is None where the body rests or has overturned when the computation ends; else it has ``time_s``,
``rotation_rad`` and ``angular_velocity_rad_s`` of that instant, and ``sentence``, the same in words.
``other_models`` has by model either ``error`` or outcome, summary, times, peaks, ``impact_count`` and ``coefficients``.
"""

import json

from rocking.cli.simulate_output import Answer
from rocking.dynamics.response import Response
from rocking.report.facts.response import other_facts, response_facts


def as_json(answer: Answer) -> str:
    """Return everything as JSON.

    Parameters
    ----------
    answer : Answer
        What `Answer.of` computed.

    Returns
    -------
    str
        One object; SI units, null where something does not exist.
    """
    facts = response_facts(answer.response, answer.friction)
    facts["still_rocking"] = _last_state(answer.response)
    facts["other_models"] = {name: other_facts(found) for name, found in answer.others.items()}
    return json.dumps(facts, indent=2, allow_nan=False)


def _last_state(response: Response) -> dict[str, float | str] | None:
    if not response.still_rocking:
        return None
    return {
        "time_s": float(response.time[-1]),
        "rotation_rad": float(response.rotation[-1]),
        "angular_velocity_rad_s": float(response.angular_velocity[-1]),
        "sentence": response.unfinished,
    }
