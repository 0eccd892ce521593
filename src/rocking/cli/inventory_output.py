"""What `rocking inventory` computes, prints and writes."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rocking.cli.simulate_question import restitution_from
from rocking.errors import InvalidValueError
from rocking.studies.inventory.assessment import Assessment, assess
from rocking.studies.inventory.hazard import COUNT, FAMILY, SEED, Hazard, IntensityLevel
from rocking.studies.inventory.lights import Light
from rocking.studies.inventory.reading import read_inventory
from rocking.studies.inventory.table import SLIDING, advice, model_note, sentence

_STYLES = {Light.GREEN: "bold green", Light.AMBER: "bold yellow", Light.RED: "bold red"}
Progress = Callable[[int], None]


def answer(objects: Path, encoding: str, hazard: Callable[[Progress], Hazard], restitution: str) -> Assessment:
    """Read a list, make the motions and assess every object."""
    # a slip in the list shows before the motions are made
    inventory, law = read_inventory(objects, encoding), restitution_from(restitution)
    with _progress("motions") as made:
        motions = hazard(made)
    return assess(inventory, motions, restitution=law)


def write(assessment: Assessment, folder: Path | None) -> tuple[list[Path], list[str]]:
    """Write the report, if a folder was named.

    Returns the files, and what was left out for want of a library.
    """
    if folder is None:
        return [], []
    from rocking.reports.inventory_folder import write_inventory

    return write_inventory(assessment, folder)


def as_json(assessment: Assessment) -> str:
    """Return everything as JSON.

    Returns one object; SI units, named in the keys.
    """
    from rocking.reports.inventory_folder import inventory_json

    return inventory_json(assessment)


def show(assessment: Assessment) -> None:
    """Print the ranking."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False, soft_wrap=True)
    console.print(f"{assessment.source}: {assessment.hazard.words()}, {assessment.hazard.source}", markup=False)
    for rank, verdict in enumerate(assessment.verdicts, start=1):
        line = Text(f"{rank:3}  ")
        line.append(f"{verdict.light.value} {verdict.light.name:<5}", style=_STYLES[verdict.light])
        line.append(f"  {verdict.item.name}: {sentence(verdict, assessment)}")
        console.print(line)
        console.print(
            Text(f"{'':12} {advice(verdict, assessment)} {model_note(verdict, assessment)}".rstrip(), style="dim")
        )
    for refused in assessment.not_assessed:
        console.print(Text(f"     not assessed: {refused.name or 'no name'}, line {refused.row}: {refused.reason}"))
    console.print(
        Text("\n" + "\n".join(f"{light.name}: {t}" for light, t in assessment.thresholds.sentences().items()))
    )
    if assessment.ignored:
        console.print(Text(f"Columns that were not read: {', '.join(assessment.ignored)}"))
    console.print(Text(SLIDING))


@contextmanager
def _progress(what: str) -> Iterator[Progress]:
    """Show on a terminal how far it is."""
    import sys

    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done: bar.update(task, advance=done)


def hazard_from(
    records: Sequence[str] | None,
    synthetic: str | None,
    pga: str | None,
    pgv: str | None,
    *,
    count: int | None,
    seed: int | None,
    told: dict[str, Any],
    progress: Callable[[int], None] | None = None,
) -> Hazard:
    """Return the hazard that a command was given.

    count, seed: of the synthetic motions [-].
    """
    if pga is not None and pgv is not None:
        raise InvalidValueError("give --pga or --pgv, not both: motions are scaled to one of them")
    level = None
    if pga is not None or pgv is not None:
        level = IntensityLevel.of("PGA", pga) if pga is not None else IntensityLevel.of("PGV", str(pgv))
    if records:
        alone = {"--synthetic": synthetic, "--count": count, "--seed": seed}
        odd = [name for name, value in alone.items() if value is not None]
        if odd:
            raise InvalidValueError(f"{', '.join(odd)} is for synthetic motions: leave it out beside --record")
        return Hazard.of_records([_record(word, told) for word in records], level)
    odd = ["--" + name.replace("_", "-") for name, value in told.items() if value is not None]
    if odd:
        raise InvalidValueError(f"{', '.join(odd)} is for record files: leave it out, or give --record")
    if level is None:
        raise InvalidValueError("how strong is the shaking? Give --pga 0.3g or --pgv 25cm/s, or --record FILE")
    number, start = COUNT if count is None else count, SEED if seed is None else seed
    return Hazard.of_family(synthetic or FAMILY, level, count=number, seed=start, progress=progress)


def _record(word: str, told: dict[str, Any]) -> Any:
    from rocking.cli.inputs import motion_from
    from rocking.motions.pulse import Pulse

    motion = motion_from(word, **told)
    if isinstance(motion, Pulse):
        raise InvalidValueError(f"--record takes record files, got the pulse {word[:80]!r}")
    return motion
