"""`rocking equilibria`: in which ways a body can stand, what lies between them, and how sure its base is."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking.answers import Answer, AnswerRows, Display
from rocking.bodies import Block, Body, Section, Solid
from rocking.bodies.equilibria import TOLERANCES, BaseTolerance, Equilibria, StablePose, base_tolerances
from rocking.cli import options
from rocking.cli.arguments import Arguments
from rocking.cli.exports import DRAWN, Export, Exports, write_records
from rocking.cli.page import Page, deliver
from rocking.cli.restitution import named_body
from rocking.cli.solids import show_body
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DIRECTIONS = 12  # azimuths towards which barriers are printed, from x towards y

EXPORTS = {
    "picture": DRAWN,
    "space": Export((".glb",), lambda answer, path: answer.write_glb(path)),
    "csv": Export((".csv",), lambda answer, path: write_records(path, answer.answer()["stable"].records)),
}


def equilibria(
    context: typer.Context,
    body: options.BodyFile = None,
    density: options.Density = None,
    units: options.Units = None,
    min_barrier: Annotated[float | None, typer.Option(help=r"Lowest energy barrier of a pose \[m].")] = None,
    sets: options.Set = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking equilibria`."""
    exports = Exports.of(output, EXPORTS)
    arguments = Arguments(context, "body")
    subject, _ = named_body(arguments, quiet=as_json)
    if isinstance(subject, (Block, Section)):
        subject = Solid.from_section(subject)
        subject.name = Path(body or "").name
    if isinstance(subject, Body):
        raise InvalidValueError(
            "equilibria are those of a body in space: give a mesh, a file with [[solid.part]], or a block or a section"
        )
    result = subject.equilibria(min_barrier=min_barrier)
    deliver(EquilibriaAnswer(subject, result, arguments.length or "m"), exports, as_json=as_json)


@dataclass(frozen=True)
class EquilibriaAnswer:
    """All ways in which a solid can stand, and the one in which it does."""

    solid: Solid
    equilibria: Equilibria
    length: str  # unit of lengths

    @cached_property
    def pose(self) -> StablePose:
        """The pose into which it settles from its way up."""
        return self.equilibria.settling((0.0, 0.0, -1.0))

    @cached_property
    def bases(self) -> tuple[BaseTolerance, ...]:
        """What it stands on by tolerance."""
        return base_tolerances(self.equilibria, self.pose, [t for t in TOLERANCES if t < self.pose.height])

    @cached_property
    def directions(self) -> AnswerRows:
        """What it takes to lift and to topple it, by azimuth."""
        turns = [2.0 * math.pi * k / DIRECTIONS for k in range(DIRECTIONS)]
        ends = [self.equilibria.toppled(self.pose, turn) for turn in turns]
        return AnswerRows({
            "azimuth": turns,
            "straight_rise": [float(self.equilibria.barrier(self.pose, turn)) for turn in turns],
            "lowest_rise": [float(self.equilibria.barrier(self.pose, turn, path="lowest")) for turn in turns],
            "uplift_acceleration": [float(self.pose.uplift_acceleration(turn)) for turn in turns],
            "topples_into": [None if end is None else end.number for end in ends],
        })  # fmt: skip

    def answer(self) -> Answer:
        """Return every way to stand, what leaves the pose that it has, and how sure its base is."""
        equilibria, stable = self.equilibria, self.equilibria.stable
        passes = equilibria.neighbours(self.pose)
        return Answer({
            "body": self.solid.answer(),
            "stable": AnswerRows({
                "pose": [pose.number for pose in stable],
                "centre_height": [pose.height for pose in stable],
                "energy": [pose.energy for pose in stable],
                "nearest_edge": [float(pose.edge_distances.min()) for pose in stable],
                "barrier": [pose.barrier for pose in stable],
                "down": [pose.down.tolist() for pose in stable],
            }),
            "saddles": len(equilibria.saddles),
            "summits": len(equilibria.summits),
            "rings": [{"kind": r.kind, "tilt": r.tilt, "centre_height": r.height} for r in equilibria.rings],
            "stands_in": self.pose.number,
            "passes": AnswerRows({
                "topples_into": [saddle.end for saddle in passes],
                **{name: [getattr(saddle, name) for saddle in passes] for name in ("rise", "energy", "tilt", "azimuth")},
            }),
            "directions": self.directions,
            "base_tolerances": AnswerRows({
                "tolerance": [row.tolerance for row in self.bases],
                "touching": [row.points for row in self.bases],
                "corners": [len(row.support) for row in self.bases],
                "nearest_edge": [row.edge_distance for row in self.bases],
                **{
                    name: [getattr(row, name) for row in self.bases]
                    for name in ("azimuth", "uplift_acceleration", "barrier", "energy")
                },
            }),
            "notes": equilibria.notes,
        })  # fmt: skip

    def draw(self) -> "Figure":
        from rocking.plots import equilibria_picture

        return equilibria_picture(self.solid, self.pose, equilibria=self.equilibria)

    def write_glb(self, path: Path) -> None:
        from rocking.plots.space_glb import GltfFile

        file = GltfFile(self.solid)
        file.add_equilibria(self.equilibria, self.pose)
        file.write(path)

    def show(self, page: Page) -> None:
        equilibria, number = self.equilibria, self.pose.number
        answer, display = self.answer(), Display(self.length)
        show_body(page, answer["body"], display)
        page.line()
        ways = "one way" if len(equilibria.stable) == 1 else f"{len(equilibria.stable)} ways"
        page.line(
            f"It can stand in {ways}; between them lie {len(equilibria.saddles)} saddles and {len(equilibria.summits)} summits."
            if equilibria.saddles
            else f"It can stand in {ways}."
        )
        for ring in answer["rings"]:
            what = "rolls" if ring["kind"] == "stable" else "can be balanced"
            lean, height = display.text("tilt", ring["tilt"]), display.text("centre_height", ring["centre_height"])
            page.line(f"It {what} all the way round with its axis {lean} from the vertical, centre {height} high.")
        names = ("pose", "centre_height", "energy", "nearest_edge", "barrier")
        page.rows(answer["stable"], names, display, bold={number}, most=len(equilibria.stable))
        page.line()
        page.line(f"It stands in pose {number}. To topple it towards a direction its centre must rise", "bold")
        page.rows(self.directions, (), display)
        page.line("azimuth: from x towards y.")
        page.line()
        page.line("What it stands on, if points of it that are this close to the ground touch it too", "bold")
        page.rows(
            answer["base_tolerances"],
            ("tolerance", "touching", "corners", "nearest_edge", "azimuth", "uplift_acceleration", "barrier"),
            display,
        )
        page.warn(equilibria.notes)
