"""Plain products as campaigns: every motion with every body, scale and restitution."""

import numpy as np

from rocking.campaigns.jobs.kinds.spectrum import sides_of_choices
from rocking.campaigns.jobs.kinds.words import along, of_motions, of_words
from rocking.campaigns.jobs.study import Study
from rocking.errors import InvalidValueError
from rocking.spec.document import HistoriesTable
from rocking.spec.parts import Parts
from rocking.spec.reading import located
from rocking.studies.histories import Product
from rocking.studies.sensitivity.restitutions import sampled


def product_study(parts: Parts) -> Study:
    """Return the study of every motion with every body, scale and restitution."""
    scales = (parts.document.histories or HistoriesTable()).scales.numbers()
    bad = np.flatnonzero(np.abs(scales) > 1e6)
    if bad.size:
        raise InvalidValueError(f"histories.scales must be within 1e6, got {scales[bad[0]]:g} at index {bad[0]}")
    with located("body"):
        sides, law = sides_of_choices(parts.bodies, parts)
    engine = parts.document.settings.engine
    histories = Product(parts.motions, sides, scales, law=law, settings=parts.settings, engine=engine)
    sizes = (len(parts.motions), len(parts.bodies), scales.size, len(parts.choices))
    coordinates = {
        "motion": of_motions(parts.motions),
        "body": along("body", np.arange(len(parts.bodies)), "1", "number of the body in the job"),
        "scale": along("scale", scales, "1", "factor on the motion"),
        "restitution": of_words("restitution", parts.choices, "restitution"),
        "slenderness_angle": along("body", sides["alpha_right"][:, 0], "rad", "slenderness angle of the right side"),
        "frequency_parameter": along("body", sides["p_right"][:, 0], "rad/s", "frequency parameter of the right side"),
    }
    dims = dict(zip(("motion", "body", "scale", "restitution"), sizes, strict=True))
    return Study(
        sampled(histories), dims, coordinates, {"bodies": "; ".join(repr(body) for body in parts.bodies)[:4000]}
    )
