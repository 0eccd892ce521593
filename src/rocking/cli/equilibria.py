"""`rocking equilibria`: stable poses of a body, energy barriers between poses, and tolerance of the base."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rocking import checks
from rocking.answers import Answer, AnswerRows, Display
from rocking.bodies import Block, Body, Section, Solid
from rocking.bodies.equilibria import TOLERANCES, BaseTolerance, Equilibria, StablePose, base_tolerances
from rocking.bodies.formats.mesh import SMALL_ROTATION
from rocking.bodies.solid import RoundBase
from rocking.cli import options
from rocking.cli.arguments import Arguments
from rocking.cli.exports import DRAWN, Export, Exports, write_records
from rocking.cli.page import Page, deliver
from rocking.cli.restitution import named_body
from rocking.cli.solids import show_body
from rocking.cli.spelling import UsageError
from rocking.conventions import LENGTH_UNITS
from rocking.spec.bodies import without_restraints

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DIRECTIONS = 12  # number of printed azimuths, from x towards y
_POSES = 8  # number of printed poses without --details

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
    min_barrier: Annotated[
        str | None,
        typer.Option(
            help=r"Smallest energy barrier of a listed pose, as a rise of the centre of mass such as 2mm \[m, "
            r"or --units]."
        ),
    ] = None,
    sets: options.Set = None,
    output: Annotated[list[str] | None, options.output(EXPORTS)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking equilibria`."""
    exports = Exports.of(output, EXPORTS)
    arguments = Arguments(context, "body")
    subject = without_restraints(named_body(arguments, quiet=as_json)[0])
    if isinstance(subject, (Block, Section)):
        subject = Solid.from_section(subject)
        subject.name = Path(body or "").name
    if isinstance(subject, Body):
        raise UsageError(
            "a 3D body is needed: give a mesh, a file with [[solid.part]], or a block or a section with depth"
        )
    length = arguments.length or "m"
    result = subject.equilibria(min_barrier=None if min_barrier is None else _barrier(min_barrier, length))
    deliver(EquilibriaAnswer(subject, result, length, details), exports, as_json=as_json)


def _barrier(text: str, length: str) -> float:
    """Return a barrier [m]. A number without unit is in the unit of lengths of the command."""
    value, unit = checks.quantity("--min-barrier", text, "m")
    return value if unit else value * LENGTH_UNITS[length]


@dataclass(frozen=True)
class EquilibriaAnswer:
    """All stable poses of a solid, and its present pose."""

    solid: Solid
    equilibria: Equilibria
    length: str  # unit of lengths
    details: bool = False

    @cached_property
    def pose(self) -> StablePose:
        """The present pose, into which the solid settles."""
        return self.equilibria.settling((0.0, 0.0, -1.0))

    @property
    def settling_rotation(self) -> float:
        """Rotation from the pose as placed into the present pose [rad]."""
        return self.solid.settling_rotation or math.atan2(math.hypot(*self.pose.down[:2]), -self.pose.down[2])

    @cached_property
    def bases(self) -> tuple[BaseTolerance, ...]:
        """Base, uplift and energy barrier for tolerances of the contact points."""
        return base_tolerances(self.equilibria, self.pose, [t for t in TOLERANCES if t < self.pose.height])

    @cached_property
    def directions(self) -> AnswerRows:
        """Rise of the centre of mass to overturning, and uplift acceleration, by azimuth."""
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
        """Return every stable pose, the energy barriers of the present pose, and the tolerance of its base."""
        equilibria, stable = self.equilibria, self.equilibria.stable
        passes, tilts = equilibria.neighbours(self.pose), self.pose.overturning_tilts
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
            "settling_rotation": self.settling_rotation,
            "smallest_overturning_tilt": tilts[0],
            "largest_overturning_tilt": tilts[1],
            "passes": AnswerRows({
                "topples_into": [saddle.end for saddle in passes],
                **{
                    name: [getattr(saddle, name) for saddle in passes]
                    for name in ("rise", "energy", "tilt", "azimuth")
                },
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
        page.line(self._verdict(display), "bold")
        show_body(page, answer["body"], display)
        page.line()
        count = len(equilibria.stable)
        page.line(f"The body has {count} stable pose{'s' * (count != 1)}. The present pose is {number}.", "bold")
        page.values(self._weakest(display))
        for ring in answer["rings"]:
            tilt, height = display.text("tilt", ring["tilt"]), display.text("centre_height", ring["centre_height"])
            page.line(
                f"Ring of equilibria ({ring['kind']}): axis {tilt} from the vertical, centre of mass {height} high."
            )
        page.line()
        names = ("pose", "centre_height", "energy", "nearest_edge", "barrier")
        page.rows(answer["stable"], names, display, bold={number}, most=count if self.details else _POSES)
        page.warn(equilibria.notes)
        if self.details:
            self._show_details(page, display)
        else:
            page.line("Directions and tolerance of the base: --details    Files: -o poses.csv, -o poses.png")

    def _verdict(self, display: Display) -> str:
        if self.settling_rotation < math.radians(SMALL_ROTATION):
            return "The body stands."
        rotation = display.text("settling_rotation", self.settling_rotation)
        return f"The body does not stand as placed: it rotates by {rotation} into pose {self.pose.number}."

    def _weakest(self, display: Display) -> list[tuple[str, str]]:
        """Return labels and texts of the tilt to overturning, the smallest uplift acceleration and the barrier."""
        nearest, farthest = (display.text("smallest_overturning_tilt", tilt) for tilt in self.pose.overturning_tilts)
        lines = [("tilt to overturning", f"{nearest} over the nearest edge, {farthest} over the farthest corner")]
        for base in self.bases[:1]:  # the first base has no tolerance
            uplift = f"from {display.text('uplift_acceleration', base.uplift_acceleration)}"
            if not isinstance(self.solid.base, RoundBase):
                uplift += f", azimuth {display.text('azimuth', base.azimuth)} (from x towards y)"
            rise = f"{display.text('barrier', base.barrier)} rise of the centre of mass"
            lines += [("uplift", uplift), ("energy barrier", rise)]
        saddles, summits = len(self.equilibria.saddles), len(self.equilibria.summits)
        return [*lines, ("unstable equilibria", f"{saddles} saddles, {summits} summits")]

    def _show_details(self, page: Page, display: Display) -> None:
        page.line("\nRise of the centre of mass to overturning, by azimuth from x towards y", "bold")
        page.rows(self.directions, (), display)
        page.line("\nBase with all points within this distance from the ground", "bold")
        page.rows(
            self.answer()["base_tolerances"],
            ("tolerance", "touching", "corners", "nearest_edge", "azimuth", "uplift_acceleration", "barrier"),
            display,
        )
