"""Construction of motions and restitutions from their tables."""

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import plausibility
from rocking.bodies import Body
from rocking.bodies.frame import is_frame
from rocking.bodies.solid import Solid
from rocking.conventions import DEFAULT_RESTITUTION, FEET, FRAME_RESTITUTION
from rocking.dynamics.mechanics import mechanics_for_all
from rocking.dynamics.mechanics_base import Mechanics
from rocking.errors import InvalidValueError, located
from rocking.motions.components import Components
from rocking.motions.formats.file_options import by_path
from rocking.motions.formats.reader import read_motion
from rocking.motions.integrals import integral_doubts
from rocking.motions.pipeline import processed
from rocking.motions.pulses import pulse
from rocking.restitution import RestitutionModel, model
from rocking.restitution.from_file import file_of, model_in_file
from rocking.spec.reading import InputFiles
from rocking.spec.record_sets import is_one_set, motions_of_set, stations_of, with_files
from rocking.studies.motion_sets import MotionList, MotionSet, SyntheticSet

if TYPE_CHECKING:
    from rocking.motions.pulse import Motion
    from rocking.spec.motion_tables import ComponentsTable, MotionKeys, MotionTable, OneMotionTable
    from rocking.spec.restitution_tables import RandomTable, RestitutionTable

MOST_IN_MEMORY = 100_000
"""Largest number of motions from several sources. A single synthetic family has no limit: it is computed in chunks."""

COMPLEMENTARITY = "complementarity"
"""Restitution of a body that slides and hops. The complementarity problem computes all impacts."""


def restitutions_of(
    table: "RestitutionTable",
    seed: int,
    bodies: Sequence[Body | Solid] = (),
    inputs: InputFiles | None = None,
    *,
    mechanics: Mechanics | None = None,
) -> dict[str, Any]:
    """Return the restitutions by label: models, coefficients, pairs by side, or laws; None for complementarity."""
    chosen_mechanics = mechanics or mechanics_for_all(bodies, None)
    with located("restitution"):
        if not chosen_mechanics.in_plane and (table.distribution is not None or table.left is not None):
            raise InvalidValueError("A 3D body accepts model, models, value or values.")
        laws_by_label: list[tuple[str, Any]] = []
        for text in table.models or ([table.model] if table.model else []):
            if text == COMPLEMENTARITY and chosen_mechanics.slides:
                laws_by_label.append((text, None))
                continue
            try:
                laws_by_label.append((text, float(text)))
            except ValueError:
                law = _model(text, inputs) if chosen_mechanics.in_plane else text
                laws_by_label.append((law if isinstance(law, str) else law.label, law))
        laws_by_label += [
            (f"{value!r}", value) for value in [*([] if table.value is None else [table.value]), *(table.values or [])]
        ]
        if table.left is not None:
            laws_by_label.append(
                (f"left {table.left!r}, right {table.right!r}", {"left": table.left, "right": table.right})
            )
        if table.distribution is not None:
            laws_by_label.append(_sampled_restitution(table.distribution, seed, bodies, inputs))
        if any(map(is_frame, bodies)) and [label for label, _ in laws_by_label] == [DEFAULT_RESTITUTION]:
            laws_by_label = [(FRAME_RESTITUTION, DEFAULT_RESTITUTION)]
        labels = [label for label, _ in laws_by_label]
        if twice := next((label for label in labels if labels.count(label) > 1), None):
            raise InvalidValueError("{names} appears twice. Remove one.", names=twice)
        return dict(laws_by_label)


def _model(word: str, inputs: InputFiles | None) -> RestitutionModel:
    """Return a model by name, or a model of the user. The file of the user becomes an input file of the job."""
    name = file_of(word) if inputs is not None else None
    return model(word) if inputs is None or name is None else model_in_file(word, inputs.file(name))


def _sampled_restitution(
    table: "RandomTable", seed: int, bodies: Sequence[Any], inputs: InputFiles | None
) -> tuple[str, Any]:  # fmt: skip
    from rocking.dynamics.impact_laws import RandomRestitution
    from rocking.dynamics.parameters import cut_of, cut_words
    from rocking.studies.sensitivity.restitutions import SampledRestitution

    times = _model(table.times, inputs) if isinstance(table.times, str) else table.times
    law = SampledRestitution if table.each == "history" else RandomRestitution
    seed = seed if table.seed is None else table.seed
    options: dict[str, Any] = {"seed": seed, "times": times}
    if table.posterior:
        sampled, label = _posterior(table, seed, bodies)
    elif table.values is not None:
        sampled, label = law.of_sample(table.values, **options), f"{len(table.values)} values"
        label += f" from {min(table.values):g} to {max(table.values):g}"
    else:
        mean, deviation = table.mean or 0.0, table.deviation or 0.0  # the table ensures that both are stated
        sampled, label = law.normal(mean, deviation, **options), f"{mean:g} +- {deviation:g}"
    # largest truncated probability over all bodies
    cuts = [cut_of(sampled, body) for body in bodies]
    largest_cuts = {foot: max((cut[foot] for cut in cuts), default=0.0) for foot in FEET}
    return f"drawn per {table.each}: {label}, seed {seed}{cut_words(largest_cuts)}", sampled


def _posterior(table: "RandomTable", seed: int, bodies: Sequence[Any]) -> tuple[Any, str]:
    """Return the restitution law from the measurements for the body: all quantiles, or a sample of `count` values."""
    from rocking.evidence._restitution_distribution import restitution_distribution

    if len(bodies) != 1:
        count = f"{len(bodies)} bodies: use one job per body" if bodies else "no [body]: use values"
        raise InvalidValueError(
            "distribution.posterior needs one body, and the job has {count}.", parameter="distribution.posterior",
            count=count,
        )  # fmt: skip
    distribution = restitution_distribution(bodies[0])
    label = "posterior of the measurements"
    if distribution.extrapolated:
        label += " (extrapolated in slenderness)"
    law = distribution.per_history(seed) if table.each == "history" else distribution.per_impact(seed)
    if table.count is None:
        return law, label
    values = {foot: distribution.sample(table.count, seed, foot) for foot in FEET}
    return replace(type(law).of_sample(values, seed=seed), cut=law.cut), f"{table.count} values of the {label}"


def motions_of(
    tables: "list[MotionTable]", inputs: InputFiles, *, paired: bool = False, plane: bool = False
) -> MotionSet:  # fmt: skip
    """Return the motions of the tables: a `SyntheticSet` for a single family, otherwise a `MotionList`."""
    # paired: both horizontal components of a record are one motion; plane: only components along x and z are allowed
    sets: list[list[Motion] | SyntheticSet] = []
    for k, table in enumerate(tables):
        with located(f"motions[{k}]"):
            sets.append(_motions(table, inputs, paired, alone=len(tables) == 1))
    if len(sets) == 1 and isinstance(sets[0], SyntheticSet):
        return sets[0]
    count = sum(len(motion_set) for motion_set in sets)
    if count > MOST_IN_MEMORY:
        raise InvalidValueError(
            "At most {limit} motions from several sources are allowed, got {count}.", parameter="motions",
            limit=MOST_IN_MEMORY, count=count,
        )  # fmt: skip
    if not count:
        raise InvalidValueError("No record has a horizontal component with motion.")
    with located("motions"):
        return MotionList([motion_set[k] for motion_set in sets for k in range(len(motion_set))], plane=plane)


def _motions(
    table: "MotionTable", inputs: InputFiles, paired: bool, *, alone: bool = True
) -> "list[Motion] | SyntheticSet":
    if table.synthetic is not None:
        assert table.count is not None  # checked by the table
        return _family(table, table.count)
    if table.components:
        return [components_of(table, inputs, table.scale)]
    if table.records and (table.target or table.mirrored or is_one_set(table.records, inputs)):
        if not (table.component or table.vertical or table.vertical_file):
            return motions_of_set(table, inputs, paired=paired, alone=alone)
        if table.target or table.mirrored:
            raise InvalidValueError("component, vertical and vertical_file are not allowed with target or mirrored.")
    motions: list[Motion] = [pulse(text) for text in table.pulse or ()] or _records(table, inputs)
    return motions if table.scale == 1.0 else [motion.scaled(table.scale) for motion in motions]


def _family(table: "MotionKeys", count: int) -> SyntheticSet:
    assert table.synthetic is not None  # checked by the table
    levels = {"pga": table.pga, "pgv": table.pgv, "time_step": table.time_step}
    return SyntheticSet(table.synthetic, count, table.seed or 0, **levels)


def _records(table: "MotionTable", inputs: InputFiles) -> "list[Motion]":
    names = [name for pattern in table.records or [] for name in inputs.named(pattern)]
    twice = sorted({name for name in names if names.count(name) > 1}) if len(names) < 1000 else []
    if twice:
        raise InvalidValueError("{name} appears twice in records. Remove one.", parameter="records", name=twice[0])
    motions: list[Motion] = []
    own = by_path(table.file_options, [inputs.folder / name for name in names])
    for name in names:
        path = inputs.file(name)
        with located("records"), located(name, "file"):
            motions.append(_record(path, table.model_copy(update=own.get(path, {})), inputs))
    return motions


def _record(path: Path, table: "MotionKeys", inputs: InputFiles) -> "Motion":
    """Return a record after its processing steps."""
    steps = with_files(table, inputs)
    if not steps:
        return _unprocessed(path, table, inputs)
    return doubted_once(lambda: processed(_unprocessed(path, table, inputs), steps), path.name)  # type: ignore[no-any-return]


def doubted_once(read: Callable[[], Any], name: str) -> Any:
    """Return a record after its processing steps. Warnings about values refer to the processed record."""
    with plausibility.before_processing():
        motion = read()
    plausibility.warn(f"{name}: {doubt}" for doubt in (*motion.doubts, *integral_doubts(motion)))
    return motion


def _unprocessed(path: Path, table: "MotionKeys", inputs: InputFiles) -> "Motion":
    upright = None if table.vertical_file is None else inputs.file(table.vertical_file)
    keys = (table.format, table.units, table.time_step, table.component, table.vertical)
    stations = stations_of(with_files(table, inputs))
    return read_motion(path, *keys, vertical_path=upright, stations=stations, skip=table.skip or 0)


def components_of(table: "ComponentsTable | MotionTable", inputs: InputFiles | None, scale: float = 1.0) -> Any:
    """Return the motions along x, y and z by axis. They are scaled by their own factors and a common factor."""
    motions: dict[str, Any] = {}
    tables = table.components
    # if all components have the same steps, the steps are applied to all components together
    chains = {tuple(axis_table.process or ()) for axis_table in tables.values()}
    is_joint = len(tables) > 1 and len(chains) == 1 and chains != {()}
    for axis, axis_table in tables.items():
        with located(axis), plausibility.before_processing() if is_joint else nullcontext():
            motions[axis] = motion_of(axis_table, inputs, raw=is_joint)
    if is_joint and inputs is not None:
        components = Components(*(motions.get(axis) for axis in "xyz"))
        steps = with_files(next(iter(tables.values())), inputs)
        with plausibility.before_processing():
            parts = processed(components, steps).parts
        motions = {axis: motion for axis, motion in zip("xyz", parts, strict=True) if motion is not None}
        plausibility.warn(
            f"{axis}: {doubt}"
            for axis, motion in motions.items()
            for doubt in (*motion.doubts, *integral_doubts(motion))
        )
    factors = {axis: axis_table.scale * scale for axis, axis_table in tables.items()}
    return {axis: motion if factors[axis] == 1.0 else motion.scaled(factors[axis]) for axis, motion in motions.items()}


def motion_of(table: "OneMotionTable", inputs: InputFiles | None = None, *, raw: bool = False) -> "Motion":
    """Return one motion, scaled to `pga` or `pgv`, without the factor `scale`. With `raw`, without processing steps."""
    if table.pulse is not None:
        return pulse(table.pulse)
    if table.record is not None:
        if inputs is None:
            raise InvalidValueError("Record files are not allowed here. Use a pulse or a synthetic motion.")
        if (inputs.folder / table.record).is_dir():
            raise InvalidValueError(
                "{folder} is a folder; one record file is needed", folder=table.record,
                hint="assess, code-checks, fragility, inventory, record batch, predict and simulate accept folders",
            )  # fmt: skip
        return (_unprocessed if raw else _record)(inputs.file(table.record), table, inputs)
    member = table.member or 0
    return _family(table, member + 1)[member]
