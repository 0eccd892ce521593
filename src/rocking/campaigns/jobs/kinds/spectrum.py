"""Rocking spectra as campaigns."""

from collections.abc import Sequence

import numpy as np

from rocking import checks
from rocking.bodies import Block, Body
from rocking.campaigns.jobs.kinds.words import along, of_motions, of_words
from rocking.campaigns.jobs.study import Study
from rocking.conventions import FloatArray
from rocking.dynamics.impact_laws import ConstantRestitution, ImpactLaw
from rocking.dynamics.parameters import RockingParameters
from rocking.errors import InvalidValueError
from rocking.spec.fields import Values
from rocking.spec.reading import located
from rocking.spec.study import StudyProblem
from rocking.studies.histories import Product
from rocking.studies.question import sides_of
from rocking.studies.sensitivity.restitutions import sampled
from rocking.tables import Column

_LONGEST = 1e100


def spectrum_study(problem: StudyProblem) -> Study:
    """Return the study of rocking spectra.

    Returns over motion, slenderness angle and period, and the restitution where there are several.
    """
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
        sides, law = sides_of_choices(blocks, problem)
    engine = problem.document.settings.engine
    histories = Product(problem.motions, sides, np.array([scale]), law=law, settings=problem.settings, engine=engine)
    dims = {"motion": len(problem.motions), "slenderness_angle": angles.size, "period": times.size}
    shape = (angles.size, times.size, len(problem.restitutions))
    # a law changes it from impact to impact: there is no one coefficient to tell
    coefficient = np.where(isinstance(law, ConstantRestitution), sides["r_right"], np.nan).reshape(shape)
    coordinates = {
        "motion": of_motions(problem.motions),
        "slenderness_angle": along("slenderness_angle", angles, "rad", "slenderness angle"),
        "period": along("period", times, "s", "2 pi / p"),
        "semi_diagonal": along("period", sizes, "m", "semi-diagonal R of the block"),
    }
    over: tuple[str, ...] = ("slenderness_angle", "period")
    if len(problem.restitutions) > 1:
        dims["restitution"] = len(problem.restitutions)
        coordinates["restitution"] = of_words("restitution", problem.restitutions, "restitution")
        over = (*over, "restitution")
    else:
        coefficient = coefficient[..., 0]
    coordinates["coefficient"] = Column(coefficient, "1", "coefficient of restitution", dims=tuple(over))
    return Study(sampled(histories), dims, coordinates, {"scale": scale})


def sides_of_choices(bodies: Sequence[Body], problem: StudyProblem) -> tuple[dict[str, FloatArray], ImpactLaw]:
    """Return the sides of bodies with every restitution.

    Returns sides: as `Product` takes them (shape (bodies, choices)); law: how the coefficient changes from impact to
    impact.
    """
    gravity = problem.settings.gravity
    all_parameters = [
        [RockingParameters.of_body(body, choice, gravity) for body in bodies]
        for choice in problem.restitutions.values()
    ]
    columns = [sides_of(row) for row in all_parameters]
    return {name: np.stack([column[name] for column in columns], axis=-1) for name in columns[0]}, all_parameters[0][
        0
    ].law


def _row(where: str, table: Values, unit: str) -> FloatArray:
    values = checks.positive_array(where, table.numbers(), unit)
    if np.any(np.diff(values) <= 0.0):
        raise InvalidValueError(f"{where} must increase from value to value")
    return values
