"""A study of many histories: its tables, what they describe, and its answer."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.bodies import Body
from rocking.conventions import g
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, located
from rocking.spec.bodies import body_moved
from rocking.spec.construction import motions_of, restitutions_of
from rocking.spec.reading import InputFiles
from rocking.studies.axis import Axis, axis_of, friction_beside
from rocking.studies.motion_sets import MotionList, MotionSet

if TYPE_CHECKING:
    from rocking.spec.document import CampaignDocument
    from rocking.spec.questions.fragility import FragilityTable
    from rocking.spec.questions.overturning_map import MapTable
    from rocking.studies.fragility.question import FragilityQuestion
    from rocking.studies.inventory import Inventory, Thresholds
    from rocking.studies.inventory.hazard import Hazard


@dataclass(frozen=True)
class StudyProblem:
    """What the histories of a study are made of."""

    document: "CampaignDocument"  # its tables
    bodies: list[Any]  # plane ones, or solids; none for spectra
    motions: MotionSet
    restitutions: dict[str, Any]  # by label
    settings: Settings  # how to integrate
    inputs: InputFiles  # the files that were read

    @classmethod
    def of(cls, document: "CampaignDocument", files: Path | InputFiles) -> "StudyProblem":
        """Return what tables describe; files: those that they may name, or the folder of them."""
        inputs = files if isinstance(files, InputFiles) else InputFiles(files)
        with located("settings"):
            stated = document.settings.stated()
            axes = axes_of(document.map) if document.map is not None else ()
            stated |= friction_beside(axes, stated.get("friction"))
        turned = any(table.y is not None for table in document.motions) or any(axis.name == "azimuth" for axis in axes)
        if turned and document.spectrum is not None:
            from rocking.spec.questions.rocking_spectrum import OWN_BLOCKS

            raise InvalidValueError(f"motions: its blocks move along x and z, not along y; {OWN_BLOCKS}")
        bodies = []
        for k, table in enumerate(document.body or []):
            with located("body" if len(document.body or []) == 1 else f"body[{k}]"):
                bodies.append(body_moved(table, inputs, turned=turned))
        with located("settings"):
            kinds = {isinstance(body, Body) for body in bodies}
            if len(kinds) > 1:
                raise InvalidValueError("bodies of a study are all plane or all in space")
            settings = study_settings(next(iter(bodies), None), stated, stated.pop("gravity", g))
        plane = document.spectrum is not None or kinds == {True}
        motions = motions_of(document.motions, inputs, paired=kinds == {False}, plane=plane)
        seed, mechanics = document.campaign.seed, mechanics_of(settings)
        restitutions = restitutions_of(document.restitution, seed, bodies, inputs, mechanics=mechanics)
        return cls(document, bodies, motions, restitutions, settings, inputs)

    @property
    def options(self) -> dict[str, Any]:
        """Settings and engine, as the studies take them."""
        return {**self.settings.stated, "engine": self.document.settings.engine}

    @property
    def stated(self) -> dict[str, Any]:
        """Settings that the document states, and engine."""
        return {**self.document.settings.stated(), "engine": self.document.settings.engine}

    @property
    def fragility_table(self) -> "FragilityTable":
        """What is asked of fragility; the usual where nothing is."""
        from rocking.spec.questions.fragility import FragilityTable

        return self.document.fragility or FragilityTable()

    @property
    def restitution(self) -> Any:
        """The first restitution."""
        return next(iter(self.restitutions.values()))

    def answer(self, progress: Callable[[int], None] | None = None, threads: int | None = None) -> Any:
        """Compute the study in memory."""
        # returns what its function in `rocking.studies` does, a map as `MapArrays`; of several restitutions a
        # comparison
        from rocking.spec.document import NEEDS

        compute = _ANSWERS[NEEDS[self.document.campaign.kind]]
        return compute(self, {**self.stated, "threads": threads, "progress": progress})

    def only(self, things: str) -> Any:
        """Return the one body, motion or restitution of a study that takes no more."""
        held: Any = getattr(self, things)
        if len(held) != 1:
            raise InvalidValueError(f"{things}: in memory this is computed with one, got {len(held)}; "
                                    "rocking campaign takes several")  # fmt: skip
        return self.restitution if things == "restitutions" else held[0]


def axes_of(table: "MapTable") -> tuple[Axis, Axis]:
    """Return the axes x and y of a map."""
    axes = []
    for name, one in (("x", table.x), ("y", table.y)):
        with located(f"map.{name}"):
            axes.append(axis_of((one.axis, one.numbers())))
    return axes[0], axes[1]


def _map(problem: StudyProblem, options: dict[str, Any]) -> Any:
    from rocking.studies._overturning_map import map_arrays

    table = problem.document.map
    assert table is not None  # the document refuses to be without
    subject = (problem.only("bodies"), problem.only("motions"), *axes_of(table))
    if len(problem.restitutions) == 1:
        return map_arrays(*subject, problem.restitution, refine=table.refine, **options)
    if table.refine is not None:
        raise InvalidValueError("map.refine is for one restitution: several are compared cell by cell")
    from rocking.studies.sensitivity import map_sensitivity

    return map_sensitivity(*subject, problem.restitutions, **options)


def _minimum(problem: StudyProblem, options: dict[str, Any]) -> Any:
    from rocking.spec.questions.minimum_acceleration import MinimumTable
    from rocking.studies import minimum_overturning_acceleration

    search = vars(problem.document.minimum or MinimumTable())
    subject = (problem.only("bodies"), problem.only("motions"), problem.only("restitutions"))
    return minimum_overturning_acceleration(*subject, **{**options, **search})


def _spectrum(problem: StudyProblem, options: dict[str, Any]) -> Any:
    from rocking.studies import rocking_spectrum

    table = problem.document.spectrum
    assert table is not None  # the document refuses to be without
    motions = [problem.motions[k] for k in range(len(problem.motions))]
    blocks = (table.slenderness_angles.numbers(), table.periods.numbers())
    return rocking_spectrum(motions, *blocks, problem.only("restitutions"), scale=table.scale, **options)


def _fragility(problem: StudyProblem, options: dict[str, Any]) -> Any:
    from rocking.studies.sensitivity import fragility_sensitivity

    table, kind = problem.fragility_table, problem.document.campaign.kind
    motions = MotionList([problem.motions[k] for k in range(len(problem.motions))])  # made once, for every level
    body = problem.only("bodies")
    if kind != "cloud" and len(problem.restitutions) > 1:
        if kind != "stripes":
            raise InvalidValueError(f"several restitutions are compared by stripes, not by {kind}")
        assert table.levels is not None  # the document refuses to be without
        options = {**options, "measure": table.measure, "states": tuple(table.states)}
        return fragility_sensitivity(body, motions, table.levels.numbers(), problem.restitutions, **options)
    question = fragility_question(problem, problem.only("restitutions"), motions)
    return question.computed(options["threads"], options["progress"])


def fragility_question(
    problem: StudyProblem, restitution: Any, motions: MotionSet | None = None
) -> "FragilityQuestion":
    """Return what is asked of the fragility of the body with one restitution; motions: the same ones, kept."""
    from rocking.studies.fragility.question import FragilityQuestion
    from rocking.studies.fragility.subject import Subject

    table, kind = problem.fragility_table, problem.document.campaign.kind
    # what is in [fragility] is the search's; that of [settings] is the engine's
    if kind == "incremental" and "tolerance" in problem.document.settings.stated():
        raise InvalidValueError("settings.tolerance cannot be changed in an incremental analysis; leave it out")
    shaken = problem.motions if motions is None else motions
    return FragilityQuestion.of(
        Subject.of(problem.bodies[0], shaken, restitution, table.measure, problem.options),
        kind, None if table.levels is None else table.levels.numbers(), tuple(table.states),
        factor=table.factor, tolerance=table.tolerance,
    )  # fmt: skip


def inventory_of(
    problem: StudyProblem,
) -> "tuple[Inventory, Callable[[Callable[[int], None] | None], Hazard], Thresholds, Any]":
    """Return the objects of an inventory, what makes its motions, where its lights change, and the stated model."""
    from rocking.studies.inventory import Thresholds, read_inventory
    from rocking.studies.inventory.hazard import SEED, Hazard, IntensityLevel
    from rocking.studies.motion_sets import SyntheticSet

    table, motions = problem.document.inventory, problem.motions
    assert table is not None  # the document refuses to be without
    if len(problem.restitutions) > 1:
        raise InvalidValueError("restitution: an inventory takes one; that of Housner stands beside it")
    stated = problem.restitution if "restitution" in problem.document.model_fields_set else None
    try:
        limits = Thresholds(**table.thresholds.model_dump(exclude_none=True))
    except InvalidValueError as error:  # which begins with the key
        raise InvalidValueError(f"inventory.thresholds.{error}") from error
    with located("inventory"):
        folder = Path(table.objects).parent
        objects = read_inventory(
            problem.inputs.file(table.objects),
            table.encoding,
            lambda name: problem.inputs.file((folder / name).as_posix()),
            table.columns,
            table.language,
        )
        texts = {"PGA": table.pga, "PGV": table.pgv}
        level = next((IntensityLevel.of(kind, text) for kind, text in texts.items() if text is not None), None)

    def hazard(progress: Callable[[int], None] | None = None) -> Hazard:
        with located("inventory"):
            if isinstance(motions, SyntheticSet):
                assert level is not None  # the document refuses to be without
                own = problem.document.motions[0].seed
                seed = SEED if own is None else own  # as on the command line
                return Hazard.of_family(motions.family, level, count=motions.count, seed=seed, progress=progress)
            records = [motions[k] for k in range(len(motions))]
            return Hazard.of_records(records, level)  # pulses are refused by the document

    return objects, hazard, limits, stated


def _inventory(problem: StudyProblem, options: dict[str, Any]) -> Any:
    from rocking.studies.inventory import assess

    objects, hazard, limits, restitution = inventory_of(problem)
    settings, motions = problem.settings, hazard(options["progress"])
    return assess(
        objects, motions, restitution=restitution, thresholds=limits, gravity=settings.gravity,
        friction=settings.stated.get("friction"), threads=options["threads"],
    )  # fmt: skip


_ANSWERS: dict[str, Callable[[StudyProblem, dict[str, Any]], Any]] = {
    "map": _map, "minimum": _minimum, "spectrum": _spectrum, "fragility": _fragility, "inventory": _inventory,
}  # fmt: skip
"""What computes a study in memory, by the table of its document that is its own."""
