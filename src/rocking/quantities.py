"""Every result once: its name, unit and meaning, and what its codes stand for; tables, files and pages read it here."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from rocking.outcome import UNCOUNTED, ContactMode, Outcome, Regime, Status


@dataclass(frozen=True, slots=True)
class Quantity:
    """What a number or word among the results is.

    >>> QUANTITIES["peak_rotation"].attributes
    {'units': 'rad', 'long_name': 'rotation of largest size; a quarter turn if it overturned'}
    """

    name: str  # what it is called in arrays, tables and files
    unit: str  # its unit, of the SI; 1 for numbers without one, empty for words
    meaning: str
    codes: dict[int, str] = field(default_factory=dict)  # what whole numbers stand for
    standard_name: str = ""  # its name in the table of the CF conventions, which knows nothing that rocks

    @property
    def attributes(self) -> dict[str, Any]:
        """Unit, meaning and codes, as xarray and the CF conventions name them."""
        made: dict[str, Any] = {"units": self.unit, "long_name": self.meaning, "standard_name": self.standard_name}
        made = {key: value for key, value in made.items() if value}
        if self.codes:
            made["flag_values"] = list(self.codes)
            made["flag_meanings"] = " ".join(word.replace(" ", "_") for word in self.codes.values())
        return made


def attributes(name: str) -> dict[str, Any]:
    """Return what the files say of a result: unit, meaning and codes, as xarray and the CF conventions name them."""
    return QUANTITIES[name].attributes


def _words(members: Iterable[Any]) -> dict[int, str]:
    return {member.code: member.name.lower() for member in members}


def _spelled(codes: dict[int, str]) -> str:
    return ", ".join(f"{code} {word}" for code, word in codes.items())


_OUTCOMES, _CONTACTS = _words(Outcome), _words(ContactMode)
_REGIMES = {regime.code: regime.value for regime in Regime}
_SIDES = {1: "right", -1: "left"}
_HISTORY = (
    Quantity("outcome", "1", _spelled(_OUTCOMES), _OUTCOMES),
    Quantity(
        "status", "1", ", ".join(f"{status.code} {status.value}" for status in Status), _words(Status), "status_flag"
    ),
    Quantity("overturned", "1", "1 it overturned, 0 it did not, NaN where there is no result: neither"),
    Quantity(
        "mode", "1", "-3 failed, -2 not lifted, -1 rocked and stayed standing, n >= 0 overturned after n impacts, "
        f"{UNCOUNTED} overturned in space, where they are not counted",
    ),
    Quantity("side", "1", "side to which it overturned: 1 right, -1 left, 0 it did not"),
    Quantity("peak_rotation", "rad", "rotation of largest size; a quarter turn if it overturned"),
    Quantity("peak_ratio", "1", "peak rotation over the slenderness angle of its side; beyond 1 is not overturning"),
    Quantity("peak_time", "s", "time of the peak rotation; the end of the motion if it comes later"),
    Quantity(
        "peak_velocity", "rad/s", "largest angular velocity at samples and impacts, the first after the motion included"
    ),
    Quantity(
        "overturning_time", "s",
        "when the centre of mass passed over the foot for good; the end of the motion if it is later",
    ),
    Quantity("first_uplift", "s", "first uplift"),
    Quantity(
        "impacts", "1",
        "number of impacts; of those after the end of the motion only the ones that end in overturning count",
    ),
    Quantity("uplifts", "1", "number of uplifts from rest"),
    Quantity(
        "still_rocking", "1",
        "1 where it stands, but did not yet rest at the end, after which no impact counts; NaN without a result",
    ),
    Quantity("truncation", "rad", "sum of what the series of the steps leave out; no measure of accuracy"),
    Quantity("twin_change", "rad", "change of the size of the peak rotation if every step is halved"),
    Quantity("twin_flips", "1", "1 where only one of history and twin overturns, 0 not, NaN where one has no result"),
    Quantity(
        "least_force", "1", "smallest normal force of the ground while rocking, over the weight; below 0 it would pull"
    ),
    Quantity(
        "friction_demand", "1", "largest horizontal over normal force while rocking; infinite where contact is lost"
    ),
    Quantity(
        "lost_contact", "1",
        "1 where the ground would have to pull, so that the verdict assumes contact; NaN no result",
    ),
)  # fmt: skip
_HISTORY_WITH_FRICTION = (
    Quantity("residual_displacement", "m", "displacement of the centre of mass at the end, relative to the ground"),
    Quantity("friction_usage", "1", "largest horizontal force over friction times the vertical one; 1 where it slides"),
    Quantity(
        "impacts_replaced", "1", "impacts in which Stronge's law stood in for one that has no solution or gains energy"
    ),
    Quantity("shocks", "1", "impacts without collision: of a foot that slides where no contact force is possible"),
)
_HISTORY_IN_SPACE = (
    Quantity("over_contact", "1", f"{_spelled(_CONTACTS)} over which it fell, -1 none"),
    Quantity("over_number", "1", "number of that edge or vertex; -1 where there is none"),
    Quantity(
        "peak_tilt",
        "rad",
        "largest angle from the vertical; a quarter turn if it overturned; with friction from the pose at the start",
    ),
    Quantity("peak_spin", "rad/s", "largest angular velocity at ends of steps and at impacts"),
    Quantity("direction", "rad", "direction in which it lies, from x towards y"),
    Quantity("end_time", "s", "end of the history"),
    Quantity(
        "held", "s", "for how long a corner, or a rim that is nearly flat, was held down though it should slip or hop"
    ),
    Quantity("lost", "J", "energy lost at impacts"),
    Quantity("events", "1", "number of impacts, uplifts and changes of contact"),
    Quantity("steps", "1", "number of steps of the engine"),
)
_HISTORY_ON_THE_HULL = (
    Quantity("pose", "1", "number of the stable pose in which it ends; 0 has the lowest centre, -1 there is no result"),
    Quantity("contacts_held", "1", "impacts and changes where no contact obeyed every law, and what touched was held"),
    Quantity("landings_replaced", "1", "impacts in which Housner's law stood in for one without a solution"),
)  # fmt: skip
_SAMPLES = (
    Quantity("time", "s", "time"),
    Quantity("rotation", "rad", "rotation theta, positive clockwise"),
    Quantity("angular_velocity", "rad/s", "angular velocity"),
    Quantity("displacement", "m", "displacement of the centre of mass to the right, relative to the ground"),
    Quantity("rise", "m", "height of the centre of mass above its place at rest"),
    Quantity("horizontal_velocity", "m/s", "velocity of the centre of mass to the right, relative to the ground"),
    Quantity("vertical_velocity", "m/s", "velocity of the centre of mass upwards, relative to the ground"),
    Quantity("regime", "1", "; ".join(f"{code} {word}" for code, word in _REGIMES.items()), _REGIMES),
    Quantity("sliding_distance", "m", "path of the feet along the ground since the start"),
    Quantity("ground_acceleration", "m/s2", "horizontal acceleration of the ground"),
    Quantity("vertical_ground_acceleration", "m/s2", "vertical acceleration of the ground, upwards"),
    Quantity("horizontal_force", "N", "force of the ground on the body, to the right"),
    Quantity("vertical_force", "N", "force of the ground on the body, upwards"),
    Quantity("vertical_force_left", "N", "force of the ground on the left foot, upwards"),
    Quantity("vertical_force_right", "N", "force of the ground on the right foot, upwards"),
    Quantity("kinetic_energy", "J", "kinetic energy relative to the ground"),
    Quantity("potential_energy", "J", "potential energy above rest"),
    Quantity("work_of_ground", "J", "work done by the ground since the start"),
    Quantity("energy_lost", "J", "energy lost at impacts since the start"),
    Quantity("lost_in_friction", "J", "energy lost in friction since the start"),
    *(
        Quantity(f"quaternion_{axis}", "1", f"attitude, component {axis} of the unit quaternion")
        for axis in ("s", "x", "y", "z")
    ),
    *(Quantity(f"angular_velocity_{axis}", "rad/s", f"angular velocity about {axis}") for axis in "xyz"),
    *(Quantity(f"centre_{axis}", "m", f"centre of mass, {axis}") for axis in "xyz"),
    *(Quantity(f"ground_acceleration_{axis}", "m/s2", f"acceleration of the ground, {axis}") for axis in "xyz"),
    Quantity("tilt", "rad", "angle between the axis of the body and the vertical"),
    Quantity("azimuth", "rad", "direction in which the body leans, from x towards y"),
    Quantity("contact", "1", _spelled(_CONTACTS), _CONTACTS),
    Quantity("touching", "1", "number of vertices on the ground"),
    Quantity("sliding", "1", "number of vertices that slide on the ground"),
)
_IMPACTS_AND_INTERVALS = (
    Quantity("velocity_before", "rad/s", "angular velocity before the impact"),
    Quantity("velocity_after", "rad/s", "angular velocity after the impact"),
    Quantity("coefficient", "1", "coefficient of restitution, a ratio of velocities"),
    Quantity("onto", "1", "foot landed on: 1 right, -1 left", _SIDES),
    *(Quantity(f"normal_{foot}", "N s", f"vertical impulse on the {foot} foot") for foot in ("left", "right")),
    *(Quantity(f"tangential_{foot}", "N s", f"horizontal impulse on the {foot} foot") for foot in ("left", "right")),
    Quantity("energy_before", "J", "kinetic energy before the impact"),
    Quantity("energy_after", "J", "kinetic energy after the impact"),
    Quantity("impulse", "N s", "vertical impulse of the impact"),
    Quantity("pull", "N s", "part of the impulse with which the ground would have to pull"),
    Quantity("slips", "1", "whether the feet slid in the impact: 1 yes, 0 no"),
    Quantity("feet", "", "feet that touch the ground"),
    Quantity("vertices", "", "vertices on the ground"),
    Quantity("sliding_vertices", "", "vertices that slide on the ground"),
    Quantity("start", "s", "start of the interval"),
    Quantity("end", "s", "end of the interval"),
    Quantity("distance", "m", "path of the feet along the ground in the interval"),
)
QUANTITIES: dict[str, Quantity] = {
    each.name: each
    for each in (
        *_HISTORY,
        *_HISTORY_WITH_FRICTION,
        *_HISTORY_IN_SPACE,
        *_HISTORY_ON_THE_HULL,
        *_SAMPLES,
        *_IMPACTS_AND_INTERVALS,
    )
}
"""All of them, by name."""
TIMES = tuple(each.name for each in _HISTORY if each.unit == "s")
"""Those of a history that are times, which a motion that is stretched stretches."""
HISTORY = tuple(each.name for each in _HISTORY if not each.name.startswith("twin"))
"""What is known of every history of a study in the plane, in the order of its tables."""
