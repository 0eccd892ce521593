"""`rocking equilibria`: in which ways a body can stand, what lies between them, and how sure its base is."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.bodies import Block, Body, Section, Solid
from rocking.bodies.equilibria import TOLERANCES, BaseTolerance, Equilibria, StablePose, base_tolerances
from rocking.cli import options
from rocking.cli.arguments import Arguments
from rocking.cli.cor import named_body
from rocking.cli.exports import DRAWN, Export, Exports, write_records
from rocking.cli.numbers import in_unit
from rocking.cli.page import Page, deliver
from rocking.cli.solids import body_facts, show_body
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DIRECTIONS = 12  # azimuths towards which barriers are printed, from x towards y

EXPORTS = {
    "picture": DRAWN,
    "space": Export((".glb",), lambda answer, path: answer.write_glb(path)),
    "csv": Export((".csv",), lambda answer, path: write_records(path, answer.facts()["stable"])),
}


def equilibria(
    context: typer.Context,
    body: options.BodyFile = None,
    density: options.Density = None,
    units: options.Units = None,
    least_barrier: Annotated[
        float | None, typer.Option(help="Poses that a smaller rise of the centre leaves, in m, do not count.")
    ] = None,
    sets: options.Set = None,
    out: Annotated[list[str] | None, options.out(EXPORTS)] = None,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking equilibria`."""
    exports = Exports.of(out, EXPORTS)
    arguments = Arguments(context, "body")
    subject, _ = named_body(arguments, quiet=as_json)
    if isinstance(subject, (Block, Section)):
        subject = Solid.from_section(subject)
        subject.name = Path(body or "").name
    if isinstance(subject, Body):
        raise InvalidValueError(
            "equilibria are those of a body in space: give a mesh, a file with [[solid.part]], or a block or a section"
        )
    found = subject.equilibria(least_barrier=least_barrier)
    deliver(EquilibriaAnswer(subject, found, arguments.length or "m"), exports, as_json=as_json)


@dataclass(frozen=True)
class EquilibriaAnswer:
    """All ways in which a solid can stand, and the one in which it does."""

    solid: Solid
    found: Equilibria
    length: str  # unit of lengths

    @cached_property
    def pose(self) -> StablePose:
        """The pose into which it settles from its way up."""
        return self.found.settling((0.0, 0.0, -1.0))

    @cached_property
    def bases(self) -> tuple[BaseTolerance, ...]:
        """What it stands on by tolerance."""
        return base_tolerances(self.found, self.pose, [t for t in TOLERANCES if t < self.pose.height])

    @cached_property
    def directions(self) -> list[dict[str, Any]]:
        """What it takes to lift and to topple it, by azimuth."""
        turns = [2.0 * math.pi * k / DIRECTIONS for k in range(DIRECTIONS)]
        return [
            {
                "azimuth_rad": turn,
                "uplift_acceleration_m_s2": float(self.pose.uplift_acceleration(turn)),
                "straight_rise_m": float(self.found.barrier(self.pose, turn)),
                "lowest_rise_m": float(self.found.barrier(self.pose, turn, path="lowest")),
                "topples_into": None if (end := self.found.toppled(self.pose, turn)) is None else end.number,
            }
            for turn in turns
        ]

    def facts(self) -> dict[str, Any]:
        found = self.found
        return {
            "body": body_facts(self.solid),
            "stable": [
                {
                    "pose": pose.number,
                    "height_m": pose.height,
                    "energy_J": pose.energy,
                    "down": pose.down.tolist(),
                    "nearest_edge_m": float(pose.edge_distances.min()),
                    "barrier_m": pose.barrier,
                }
                for pose in found.stable
            ],
            "saddles": len(found.saddles),
            "summits": len(found.summits),
            "rings": [{"kind": r.kind, "tilt_rad": r.tilt, "height_m": r.height} for r in found.rings],
            "stands_in": self.pose.number,
            "passes": [
                {
                    "to": each.end, "rise_m": each.rise, "energy_J": each.energy, "tilt_rad": each.tilt,
                    "azimuth_rad": each.azimuth,
                }
                for each in found.neighbours(self.pose)
            ],
            "directions": self.directions,
            "base_tolerances": [
                {
                    "tolerance_m": row.tolerance, "points": row.points, "corners": len(row.support),
                    "nearest_edge_m": row.edge_distance, "azimuth_rad": row.azimuth,
                    "uplift_acceleration_m_s2": row.uplift_acceleration, "barrier_m": row.barrier,
                    "energy_J": row.energy,
                }
                for row in self.bases
            ],
            "repairs": list(self.solid.repairs),
            "notes": list(found.notes),
        }  # fmt: skip

    def draw(self) -> "Figure":
        from rocking.plots import equilibria_picture

        return equilibria_picture(self.solid, self.pose, found=self.found)

    def write_glb(self, path: Path) -> None:
        from rocking.plots.space_glb import GltfFile

        file = GltfFile(self.solid)
        file.stands(self.found, self.pose)
        file.write(path)

    def show(self, page: Page) -> None:
        found, number = self.found, self.pose.number
        show_body(page, self.solid, self.length)
        page.line()
        ways = "one way" if len(found.stable) == 1 else f"{len(found.stable)} ways"
        page.line(
            f"It can stand in {ways}; between them lie {len(found.saddles)} saddles and {len(found.summits)} summits."
            if found.saddles
            else f"It can stand in {ways}."
        )
        for ring in found.rings:
            what = "rolls" if ring.kind == "stable" else "can be balanced"
            lean, height = f"{math.degrees(ring.tilt):.3g} deg", in_unit(ring.height, self.length)
            page.line(f"It {what} all the way round with its axis {lean} from the vertical, centre {height} high.")
        poses = [
            (
                f"{pose.number}", self._long(pose.height), f"{pose.energy:.4g}",
                self._long(float(pose.edge_distances.min())), self._long(pose.barrier),
            )
            for pose in found.stable
        ]  # fmt: skip
        head = (f"centre {self.length}", "energy J", f"nearest edge {self.length}", f"rise to leave {self.length}")
        page.table(("pose", *head), poses, bold={number})
        page.line()
        page.line(f"It stands in pose {number}. To topple it towards a direction its centre must rise", "bold")
        sides = [
            (
                f"{math.degrees(row['azimuth_rad']):.0f}", self._long(row["straight_rise_m"]),
                self._long(row["lowest_rise_m"]), f"{row['uplift_acceleration_m_s2']:.3g}",
                "-" if row["topples_into"] is None else f"{row['topples_into']}",
            )
            for row in self.directions
        ]  # fmt: skip
        page.table(("deg", f"straight {self.length}", f"lowest way {self.length}", "lifts at m/s2", "into pose"), sides)
        page.line("deg: from x towards y; lifts at: the steady acceleration of the ground that lifts it that way.")
        page.line()
        page.line("What it stands on, if points of it that are this close to the ground touch it too", "bold")
        bases = [
            (
                f"{1e3 * row.tolerance:g}", f"{row.points}", f"{len(row.support)}", self._long(row.edge_distance),
                f"{math.degrees(row.azimuth):.0f}", f"{row.uplift_acceleration:.3g}", self._long(row.barrier),
            )
            for row in self.bases
        ]  # fmt: skip
        near, leave = f"nearest edge {self.length}", f"rise to leave {self.length}"
        page.table(("within mm", "points", "corners", near, "deg", "lifts at m/s2", leave), bases)
        page.warn(found.notes)

    def _long(self, value: float) -> str:
        return in_unit(value, self.length).partition(" ")[0] if math.isfinite(value) else "-"
