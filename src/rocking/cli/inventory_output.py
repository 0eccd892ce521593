"""What `rocking inventory` computes, prints and writes."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rocking.cli.simulate_question import restitution_from
from rocking.studies.inventory.assessment import assess
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.lights import Light
from rocking.studies.inventory.reading import read_inventory
from rocking.studies.inventory.verdict import Assessment
from rocking.studies.inventory.words import SLIDING, advice, model_note, sentence

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
    from rocking.report.inventory_folder import write_inventory

    return write_inventory(assessment, folder)


def as_json(assessment: Assessment) -> str:
    """Return everything as JSON.

    Returns one object; SI units, named in the keys.
    """
    from rocking.report.inventory_folder import inventory_json

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
