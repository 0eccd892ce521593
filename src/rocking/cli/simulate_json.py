"""The JSON of `rocking simulate`: what `rocking.report.facts.response` says, and what other models say.

``other_models`` has by model either ``error`` or outcome, summary, times, peaks, ``impact_count`` and ``coefficients``.
"""

import json

from rocking.cli.simulate_output import ResponseComparison
from rocking.report.facts.response import other_facts, response_facts


def as_json(answer: ResponseComparison) -> str:
    """Return everything as JSON.

    Returns one object; SI units, null where something does not exist.
    """
    facts = response_facts(answer.response, answer.friction)
    facts["other_models"] = {name: other_facts(found) for name, found in answer.others.items()}
    return json.dumps(facts, indent=2, allow_nan=False)
