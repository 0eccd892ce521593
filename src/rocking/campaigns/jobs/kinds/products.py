"""Rocking spectra, and every motion with every body, scale and restitution, as campaigns."""

from collections.abc import Sequence

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body
from rocking.campaigns.jobs.study import Study, along, labels_along, motions_along
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.errors import InvalidValueError
from rocking.spec.document import HistoriesTable
from rocking.spec.fields import Values
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.histories import Histories, Product
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column

_LONGEST = 1e100


def spectrum_study(problem: StudyProblem) -> Study:
    """Return the study of rocking spectra: over motion, slenderness angle and period, and several restitutions."""
    table = problem.document.spectrum
    assert table is not None  # the document refuses to be without
    angles = _row("spectrum.slenderness_angles", table.slenderness_angles, "rad")
    times = _row("spectrum.periods", table.periods, "s")
    scale = checks.within("spectrum.scale", table.scale, -1e6, 1e6)
    if times.max() > _LONGEST:  # its square would be beyond all numbers
        raise InvalidValueError(f"spectrum.periods must be up to {_LONGEST:g} s, got {times.max():g}")
    sizes = 0.75 * problem.settings.gravity * (0.5 * times / np.pi) ** 2
    with located("spectrum"):
        blocks = [Block.from_angle(float(alpha), float(size)) for alpha in angles for size in sizes]
        sides, law = _sides(blocks, problem)
    dims = {"motion": len(problem.motions), "slenderness_angle": angles.size, "period": times.size}
    # a law changes it from impact to impact: there is no one coefficient to tell
    coefficient = np.where(isinstance(law, ConstantRestitution), sides["r_right"], np.nan)
    coefficient = coefficient.reshape(angles.size, times.size, len(problem.restitutions))
    coordinates = {
        "motion": motions_along(problem.motions),
        "slenderness_angle": along("slenderness_angle", angles, "rad", "slenderness angle"),
        "period": along("period", times, "s", "2 pi / p"),
        "semi_diagonal": along("period", sizes, "m", "semi-diagonal R of the block"),
    }
    if len(problem.restitutions) > 1:
        dims["restitution"] = len(problem.restitutions)
        coordinates["restitution"] = labels_along("restitution", problem.restitutions, "restitution")
    else:
        coefficient = coefficient[..., 0]
    coordinates["coefficient"] = Column(coefficient, "1", "coefficient of restitution", dims=tuple(dims)[1:])
    return Study(_product(problem, sides, np.array([scale]), law), dims, coordinates, {"scale": scale})


def product_study(problem: StudyProblem) -> Study:
    """Return the study of every motion with every body, scale and restitution."""
    scales = (problem.document.histories or HistoriesTable()).scales.numbers()
    bad = np.flatnonzero(np.abs(scales) > 1e6)
    if bad.size:
        raise InvalidValueError(f"histories.scales must be within 1e6, got {scales[bad[0]]:g} at index {bad[0]}")
    with located("body"):
        sides, law = _sides(problem.bodies, problem)
    coordinates = {
        "motion": motions_along(problem.motions),
        "body": along("body", np.arange(len(problem.bodies)), "1", "number of the body in the job"),
        "scale": along("scale", scales, "1", "factor on the motion"),
        "restitution": labels_along("restitution", problem.restitutions, "restitution"),
        "slenderness_angle": along("body", sides["alpha_right"][:, 0], "rad", "slenderness angle of the right side"),
        "frequency_parameter": along("body", sides["p_right"][:, 0], "rad/s", "frequency parameter of the right side"),
    }
    sizes = (len(problem.motions), len(problem.bodies), scales.size, len(problem.restitutions))
    dims = dict(zip(("motion", "body", "scale", "restitution"), sizes, strict=True))
    attributes = {"bodies": "; ".join(repr(body) for body in problem.bodies)[:4000]}
    return Study(_product(problem, sides, scales, law), dims, coordinates, attributes)


def _product(problem: StudyProblem, sides: dict[str, FloatArray], scales: FloatArray, law: ImpactLaw) -> Histories:
    engine = problem.document.settings.engine
    return sampled(Product(problem.motions, sides, scales, law=law, settings=problem.settings, engine=engine))


def _sides(bodies: Sequence[Body], problem: StudyProblem) -> tuple[dict[str, FloatArray], ImpactLaw]:
    """Return the sides of bodies with every restitution, shape (bodies, restitutions), and the law of impacts."""
    gravity = problem.settings.gravity
    parameters = [
        [RockingParameters.of_body(body, restitution, gravity) for body in bodies]
        for restitution in problem.restitutions.values()
    ]
    columns = [sides_of(row) for row in parameters]
    return {name: np.stack([column[name] for column in columns], axis=-1) for name in columns[0]}, parameters[0][0].law


def _row(where: str, table: Values, unit: str) -> FloatArray:
    values = checks.positive_array(where, table.numbers(), unit)
    if np.any(np.diff(values) <= 0.0):
        raise InvalidValueError(f"{where} must increase from value to value")
    return values
