"""Base classes of the studies in `rocking.spec.questions`."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import AfterValidator, BeforeValidator, Field, model_validator
from pydantic_core import PydanticKnownError

from rocking.conventions import DEFAULT_RESTITUTION
from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Seed, Text, in_list, key
from rocking.spec.motion_tables import MotionTable
from rocking.spec.restitution_tables import RestitutionTable
from rocking.spec.settings_tables import StudySettingsTable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.spec.study import StudyProblem
    from rocking.studies.axis import Axis
    from rocking.studies.study_plan import Study

QUESTIONS: "dict[str, type[StudyQuestion]]" = {}
"""The classes of studies by kind. `rocking.spec.questions` fills this dictionary."""

Progress = Callable[[int], None] | None


def _kind_of_a_study(kind: str) -> str:
    if kind not in QUESTIONS:
        raise PydanticKnownError("literal_error", {"expected": ", ".join(map(repr, sorted(QUESTIONS)))})
    return kind


class CampaignTable(JobTable):
    """Name, study and storage of a campaign."""

    name: Text = key("name of the campaign", ...)
    kind: Annotated[str, AfterValidator(_kind_of_a_study)] = key("study", ...)
    note: str | None = key("free text", allowed="any text: not used in computations")
    chunk: int | None = key(
        "number of histories in one stored file", None, usual="a number that suits the engine", ge=1, le=1 << 22
    )
    seed: Seed = key("random seed", 0)


class StudyQuestion(JobTable):
    """A study of many histories: its tables, its problem and its result. There is one subclass per kind of campaign.

    A subclass defines `kind`, its own table as first field, `answer`, `study`, and `plot` if there is a figure.
    """

    kind: ClassVar[str] = ""  # value of campaign.kind
    without_body: ClassVar[str] = ""  # reason why [body] is not allowed; empty if it is allowed
    plane: ClassVar[bool] = False  # True if the bodies move along x and z only
    one_restitution: ClassVar[bool] = False  # True if a figure shows one restitution
    with_restraints: ClassVar[bool] = False  # True if the body may have restraints
    needs_motions: ClassVar[bool] = False  # True if all motions are computed before the first history
    names_files: ClassVar[bool] = False  # True if the table contains file names, which browsers do not send
    of_files: ClassVar[dict[str, set[str]]] = {}  # keys that affect only the files of a campaign, by table

    campaign: CampaignTable
    motions: Annotated[list[MotionTable], Field(min_length=1), BeforeValidator(in_list)]
    restitution: RestitutionTable = Field(default_factory=lambda: RestitutionTable(model=DEFAULT_RESTITUTION))
    settings: StudySettingsTable = Field(default_factory=StudySettingsTable)

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        if "kind" in vars(cls):
            QUESTIONS[cls.kind] = cls

    @classmethod
    def own_table(cls) -> str:
        """Return the name of the table of this study; the command has the same name."""
        return next(name for name in cls.model_fields if name not in BodyQuestion.model_fields)

    @model_validator(mode="before")
    @classmethod
    def _without_nothing(cls, stated: Any) -> Any:
        """Remove null tables of other studies, which browsers send."""
        if not isinstance(stated, dict):
            return stated
        return {name: table for name, table in stated.items() if table is not None or name in cls.model_fields}

    @classmethod
    def _unknown(cls, key: str) -> InvalidValueError:
        if key == "body":
            return InvalidValueError("[body] is not allowed: {reason}", reason=cls.without_body)
        if any(key in question.model_fields for question in QUESTIONS.values()):
            return InvalidValueError(
                'kind = "{kind}" does not accept [{table}]. Use [{expected}].', table=key, kind=cls.kind,
                expected=cls.own_table(),
            )  # fmt: skip
        return super()._unknown(key)

    @classmethod
    def has_motions(cls) -> bool:
        """Return True if the study has a table [motions]."""
        return cls.model_fields["motions"].is_required()

    @property
    def bodies(self) -> list[dict[str, Any]]:
        """Tables of the bodies."""
        return []

    @property
    def axes(self) -> "tuple[Axis, ...]":
        """Axes x and y of a map."""
        return ()

    @property
    def is_adaptive(self) -> bool:
        """True if later histories depend on the results of earlier ones."""
        return False

    @property
    def choices(self) -> int:
        """Number of restitutions."""
        return max(1, len(self.restitution.models or []) + len(self.restitution.values or []))

    @property
    def motion_count(self) -> int:
        """Number of motions."""
        return sum(table.size for table in self.motions)

    @property
    def sizes(self) -> list[int]:
        """Numbers whose product is the number of histories. In an adaptive study, this is the first round."""
        return [self.motion_count, max(1, len(self.bodies)), self.choices]

    @property
    def later_histories(self) -> int:
        """Estimated number of histories of later rounds."""
        return 0

    @property
    def elements(self) -> dict[str, int]:
        """Further numbers, besides the histories, that the web page limits."""
        return {}

    def answer(self, problem: "StudyProblem", progress: Progress = None, threads: int | None = None) -> Any:
        """Compute the study in memory. Return the result, or the comparison of several restitutions."""
        return self.study(problem).computed(progress, threads)

    def study(self, problem: "StudyProblem") -> "Study":
        """Return the histories of the study, their dimensions, and the evaluation of the results."""
        raise NotImplementedError

    def findings(self, problem: "StudyProblem", dataset: Any) -> list[dict[str, Any]]:
        """Return a summary of all results, as records of quantities. If it is empty, the summary is by outcome."""
        return []

    def plot(self, finished: Any, restitution: str | None) -> "Figure":
        """Return the figure of a finished campaign for one restitution. None means the first restitution, or all."""
        raise InvalidValueError(
            'A campaign of kind "{kind}" has no figure', kind=self.kind, hint="export its table as .csv, .xlsx or .nc"
        )


class BodyQuestion(StudyQuestion):
    """A study of one or several bodies."""

    several_bodies: ClassVar[bool] = False

    body: Annotated[list[dict[str, Any]], Field(min_length=1), BeforeValidator(in_list)] | None = None

    @model_validator(mode="after")
    def _bodies_it_takes(self) -> "BodyQuestion":
        if self.body is None:
            raise InvalidValueError("[body] is missing")
        if len(self.body) > 1 and not self.several_bodies:
            raise InvalidValueError(
                'kind = "{kind}" accepts one [[body]], got {count}.', kind=self.kind,

                count=len(self.body),
            )  # fmt: skip
        return self

    @property
    def bodies(self) -> list[dict[str, Any]]:
        """Tables of the bodies."""
        return self.body or []
