"""What a question puts together: bodies, motions, restitutions and settings, made from its tables."""

import json
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.bodies import Body
from rocking.bodies.formats.body_file import body_from_toml
from rocking.conventions import FEET
from rocking.dynamics.impact_laws import RandomRestitution
from rocking.dynamics.parameters import cut_of, cut_words
from rocking.dynamics.response import Motion
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, MissingExtraError, RockingError
from rocking.motions.formats.reader import read_motion
from rocking.motions.pulses import pulse
from rocking.restitution import RestitutionModel, model
from rocking.restitution.from_file import file_of, model_in_file
from rocking.spec.reading import InputFiles, located
from rocking.studies.motion_sets import MotionList, MotionSet, SyntheticSet

if TYPE_CHECKING:
    from rocking.spec.document import CampaignDocument, MotionTable, RandomTable, RestitutionTable

MOST_IN_MEMORY = 100_000
"""Synthetic motions that may be put into a list with others; a set of one family alone is made piece by piece."""

_INLINE = "table"
_OUTSIDE = ("units", "name", "note")


def choices_of(
    table: "RestitutionTable", seed: int, bodies: Sequence[Body] = (), inputs: InputFiles | None = None
) -> dict[str, Any]:
    """Return the restitutions that a table describes.

    Returns Models, coefficients, pairs by side or laws, as `simulate` takes them, by label.
    """
    with located("restitution"):
        words = [*([table.model] if table.model else []), *(table.models or [])]
        models = [_model(word, inputs) for word in words]
        pairs: list[tuple[str, Any]] = [(each.label, each) for each in models]
        numbers = [*([] if table.value is None else [table.value]), *(table.values or [])]
        pairs += [(f"{value!r}", value) for value in numbers]
        if table.left is not None:
            pairs.append((f"left {table.left!r}, right {table.right!r}", {"left": table.left, "right": table.right}))
        if table.distribution is not None:
            pairs.append(_drawn(table.distribution, seed, bodies, inputs))
        labels = [label for label, _ in pairs]
        twice = [label for label in labels if labels.count(label) > 1]
        if twice:
            raise InvalidValueError(f"{twice[0]} is given twice")
        return dict(pairs)


def _model(word: str, inputs: InputFiles | None) -> RestitutionModel:
    """Return a model by name, or one of the user's own, whose file is then an input of the job."""
    name = file_of(word) if inputs is not None else None
    return model(word) if inputs is None or name is None else model_in_file(word, inputs.file(name))


def _drawn(
    table: "RandomTable", seed: int, bodies: Sequence[Body], inputs: InputFiles | None
) -> tuple[str, Any]:  # fmt: skip
    from rocking.studies.sensitivity.restitutions import SampledRestitution

    times = _model(table.times, inputs) if isinstance(table.times, str) else table.times
    law = SampledRestitution if table.each == "history" else RandomRestitution
    seed = seed if table.seed is None else table.seed
    how: dict[str, Any] = {"seed": seed, "times": times}
    if table.posterior:
        drawn, words = _posterior(table, seed, bodies)
    elif table.values is not None:
        drawn, words = law.of_sample(table.values, **how), f"{len(table.values)} values"
        words += f" from {min(table.values):g} to {max(table.values):g}"
    else:
        mean, deviation = table.mean or 0.0, table.deviation or 0.0  # both are there: checked by the table
        drawn, words = law.normal(mean, deviation, **how), f"{mean:g} +- {deviation:g}"
    # of many bodies, the one of which most is cut off
    cuts = [cut_of(drawn, body) for body in bodies]
    most = {foot: max((cut[foot] for cut in cuts), default=0.0) for foot in FEET}
    return f"drawn per {table.each}: {words}, seed {seed}{cut_words(most)}", drawn


def _posterior(table: "RandomTable", seed: int, bodies: Sequence[Body]) -> tuple[Any, str]:
    """Return the law that the measurements make of the body: all quantiles, or a sample of so many values."""
    from rocking.evidence._restitution_distribution import restitution_distribution

    if len(bodies) != 1:
        told = f"{len(bodies)} bodies: make a job of each" if bodies else "no [body]; give values instead"
        raise InvalidValueError(f"distribution.posterior is of one body, and the job has {told}")
    found = restitution_distribution(bodies[0])
    words = "posterior of the measurements"
    if found.extrapolated:
        words += " (extrapolated in slenderness)"
    law = found.per_history(seed) if table.each == "history" else found.per_impact(seed)
    if table.count is None:
        return law, words
    values = {foot: found.sample(table.count, seed, foot) for foot in FEET}
    return replace(type(law).of_sample(values, seed=seed), cut=law.cut), f"{table.count} values of the {words}"


@dataclass(frozen=True)
class Parts:
    """What the histories of a job are made of."""

    document: "CampaignDocument"  # the tables of the job
    bodies: list[Body]  # the bodies; none for spectra
    motions: MotionSet
    choices: dict[str, Any]  # restitutions by label
    settings: Settings  # how to integrate
    inputs: InputFiles  # the files that were read

    @classmethod
    def of(cls, document: "CampaignDocument", folder: Path) -> "Parts":
        """Return the parts that tables describe."""
        inputs = InputFiles(folder)
        with located("settings"):
            told = document.settings.model_dump(exclude={"engine"}, exclude_none=True)
            settings = Settings(**told)
        bodies = _bodies(document.body or [], inputs)
        return cls(
            document,
            bodies,
            motions_of(document.motions, inputs),
            choices_of(document.restitution, document.campaign.seed, bodies, inputs),
            settings,
            inputs,
        )

    @property
    def options(self) -> dict[str, Any]:
        """Settings and engine, as the studies take them."""
        return {**self.settings.stated, "engine": self.document.settings.engine}

    @property
    def only_choice(self) -> Any:
        """The restitution, where there is one."""
        return next(iter(self.choices.values()))


def _bodies(tables: list[dict[str, Any]], inputs: InputFiles) -> list[Body]:
    many = len(tables) > 1
    made = []
    for k, table in enumerate(tables):
        with located(f"body[{k}]" if many else "body"):
            made.append(body_of(table, inputs))
    return made


def body_of(table: dict[str, Any], inputs: InputFiles | None) -> Body:
    """Return the body that a table describes."""
    if "file" in table:
        return _body_in_file(table, inputs)
    if {"width", "height"} & set(table):
        own = {key: value for key, value in table.items() if key not in _OUTSIDE}
        table = {**{key: value for key, value in table.items() if key in _OUTSIDE}, "block": own}
    text = "\n".join(f"{_quoted(key)} = {_as_toml(value)}" for key, value in table.items() if value is not None)
    if inputs is not None:
        _note_outlines(text, ".", inputs)
    try:
        return body_from_toml(text, name=_INLINE, folder=None if inputs is None else inputs.folder)
    except MissingExtraError:
        raise
    except RockingError as error:
        raise InvalidValueError(str(error).removeprefix(f"{_INLINE}: ")) from error


def _body_in_file(table: dict[str, Any], inputs: InputFiles | None) -> Body:
    odd = sorted(set(table) - {"file"})
    if odd:
        raise InvalidValueError(f"file stands alone, without {', '.join(odd)}")
    if not isinstance(table["file"], str):
        raise InvalidValueError(f"file must be text, got {table['file']!r:.60}")
    if inputs is None:
        raise InvalidValueError(f"names the file {table['file']!r:.60}, but a body cannot name files here")
    path = inputs.file(table["file"])
    text, name, folder = path.read_text(encoding="utf-8-sig", errors="replace"), table["file"], path.parent
    _note_outlines(text, str(Path(table["file"]).parent), inputs)
    return body_from_toml(text, name=name, folder=folder)


def _note_outlines(text: str, folder: str, inputs: InputFiles) -> None:
    """Note the files of outlines that a body file names; what is wrong with it is said when it is read."""
    try:
        regions = tomllib.loads(text).get("section", {}).get("region", [])
        names = [region[key] for region in regions for key in ("geojson", "dxf") if key in region]
    except (ValueError, AttributeError, TypeError):
        return
    for name in names:
        if isinstance(name, str):
            inputs.file((Path(folder) / name).as_posix())


def _quoted(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)  # the halves of a pair would be no TOML


def _as_toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_quoted(k)} = {_as_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_as_toml(item) for item in value) + "]"
    if isinstance(value, float):
        return repr(value)
    try:
        return _quoted(value)
    except TypeError:
        return str(value)  # dates: the body reader refuses them by name


def motions_of(tables: "list[MotionTable]", inputs: InputFiles) -> MotionSet:
    """Return the motions that tables describe.

    Returns A `SyntheticSet` where there is one family and nothing else; otherwise a `MotionList`.
    """
    sets: list[list[Motion] | SyntheticSet] = []
    for k, table in enumerate(tables):
        with located(f"motions[{k}]"):
            sets.append(_some(table, inputs))
    if len(sets) == 1 and isinstance(sets[0], SyntheticSet):
        return sets[0]
    count = sum(len(each) for each in sets)
    if count > MOST_IN_MEMORY:
        raise InvalidValueError(f"motions: a set of several sources may have up to {MOST_IN_MEMORY}, got {count}")
    with located("motions"):
        return MotionList([motion for each in sets for motion in _all(each)])


def _all(motions: list[Motion] | SyntheticSet) -> Iterator[Motion]:
    return (motions[k] for k in range(len(motions)))


def _some(table: "MotionTable", inputs: InputFiles) -> list[Motion] | SyntheticSet:
    if table.synthetic is not None:
        assert table.count is not None  # the table refuses to be without
        levels = {"pga": table.pga, "pgv": table.pgv, "time_step": table.time_step}
        return SyntheticSet(table.synthetic, table.count, table.seed or 0, **levels)
    made: list[Motion] = [pulse(word) for word in table.pulse] if table.pulse is not None else _records(table, inputs)
    return made if table.scale == 1.0 else [motion.scaled(table.scale) for motion in made]


def _records(table: "MotionTable", inputs: InputFiles) -> list[Motion]:
    names = [name for pattern in table.records or [] for name in inputs.named(pattern)]
    twice = sorted({name for name in names if names.count(name) > 1}) if len(names) < 1000 else []
    if twice:
        raise InvalidValueError(f"records: {twice[0]} is named twice")
    found: list[Motion] = []
    for name in names:
        path = inputs.file(name)
        with located(f"records: {name}"):
            found.append(read_motion(path, table.format, table.units, table.time_step, table.component, table.vertical))
    return found
