"""Plain products as campaigns: every motion with every body, scale and restitution."""

import numpy as np

from rocking.campaigns.jobs.kinds.spectrum import sides_of_choices
from rocking.campaigns.jobs.kinds.words import along, of_motions, of_words
from rocking.campaigns.jobs.study import Study
from rocking.errors import InvalidValueError
from rocking.spec.document import HistoriesTable
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.histories import Product
from rocking.studies.sensitivity.restitutions import sampled


def product_study(problem: StudyProblem) -> Study:
    """Return the study of every motion with every body, scale and restitution."""
    scales = (problem.document.histories or HistoriesTable()).scales.numbers()
    bad = np.flatnonzero(np.abs(scales) > 1e6)
    if bad.size:
        raise InvalidValueError(f"histories.scales must be within 1e6, got {scales[bad[0]]:g} at index {bad[0]}")
    with located("body"):
        sides, law = sides_of_choices(problem.bodies, problem)
    engine = problem.document.settings.engine
    histories = Product(problem.motions, sides, scales, law=law, settings=problem.settings, engine=engine)
    sizes = (len(problem.motions), len(problem.bodies), scales.size, len(problem.restitutions))
    coordinates = {
        "motion": of_motions(problem.motions),
        "body": along("body", np.arange(len(problem.bodies)), "1", "number of the body in the job"),
        "scale": along("scale", scales, "1", "factor on the motion"),
        "restitution": of_words("restitution", problem.restitutions, "restitution"),
        "slenderness_angle": along("body", sides["alpha_right"][:, 0], "rad", "slenderness angle of the right side"),
        "frequency_parameter": along("body", sides["p_right"][:, 0], "rad/s", "frequency parameter of the right side"),
    }
    dims = dict(zip(("motion", "body", "scale", "restitution"), sizes, strict=True))
    return Study(
        sampled(histories), dims, coordinates, {"bodies": "; ".join(repr(body) for body in problem.bodies)[:4000]}
    )
