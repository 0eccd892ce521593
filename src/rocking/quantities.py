"""All quantities of results: name, unit, meaning and codes, for tables, files and answers."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from rocking.outcome import UNCOUNTED, ContactMode, Outcome, Regime, Status, mode_words


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity of the results: number or text.

    >>> QUANTITIES["peak_rotation"].attributes
    {'units': 'rad', 'long_name': 'rotation of largest magnitude; pi/2 if overturned'}
    """

    name: str  # name in arrays, tables and files
    unit: str  # SI unit; 1 if dimensionless, empty for text
    meaning: str
    codes: dict[int, str] = field(default_factory=dict)  # meanings of integer codes
    standard_name: str = ""  # name in the table of the CF conventions, if any
    label: str = ""  # heading for readers; if empty, the name
    digits: str = ".4g"  # number format for readers; "%" means percent with about three digits
    spelled: dict[str, str] = field(default_factory=dict)  # longer texts for readers, by short word
    text_of: Callable[[int], str] | None = None  # function from numbers to texts for readers

    @property
    def heading(self) -> str:
        """Label for readers."""
        return self.label or self.name.replace("_", " ")

    @property
    def is_text(self) -> bool:
        """True if readers see text."""
        return not self.unit or bool(self.codes)

    @property
    def attributes(self) -> dict[str, Any]:
        """Unit, meaning and codes as attributes of xarray and the CF conventions."""
        values: dict[str, Any] = {"units": self.unit, "long_name": self.meaning, "standard_name": self.standard_name}
        values = {key: value for key, value in values.items() if value}
        if self.codes:
            values["flag_values"] = list(self.codes)
            values["flag_meanings"] = " ".join(word.replace(" ", "_") for word in self.codes.values())
        return values


def attributes(name: str) -> dict[str, Any]:
    """Return unit, meaning and codes of a quantity as file attributes of xarray and the CF conventions."""
    return QUANTITIES[name].attributes


def with_units(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of a file, with the units of the quantities among them added.

    >>> with_units({"mass": 2.0, "engine": "fast", "semi_diagonal_left": 1.0})
    {'mass': 2.0, 'engine': 'fast', 'semi_diagonal_left': 1.0, 'mass_units': 'kg', 'semi_diagonal_left_units': 'm'}
    """
    entries = {name: quantity(name) for name, value in values.items() if not isinstance(value, str)}
    units = {f"{name}_units": entry.unit for name, entry in entries.items() if entry and entry.unit not in {"", "1"}}
    return {**values, **units}


_ENDS = {
    "_low": "lower bound of the 95 % interval", "_high": "upper bound of the 95 % interval", "_left": "left foot",
    "_right": "right foot",
}  # fmt: skip


def quantity(name: str, own: Mapping[str, Quantity] = MappingProxyType({})) -> Quantity | None:
    """Return the quantity of a name. Quantities in `own`, those of one answer, take precedence.

    The endings _low and _high mean a bound of the 95 % interval, _left and _right mean a foot.

    >>> quantity("scatter_low").meaning
    'logarithmic scatter, lower bound of the 95 % interval'
    """
    if entry := own.get(name) or QUANTITIES.get(name):
        return entry
    end = next((ending for ending in _ENDS if name.endswith(ending)), "")
    entry = quantity(name.removesuffix(end), own) if end else None
    label = f"{entry.heading} {end[1:]}" if entry else ""
    return entry and replace(entry, name=name, meaning=f"{entry.meaning}, {_ENDS[end]}", label=label)


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
    Quantity("overturned", "1", "1 overturned, 0 not overturned, NaN without a result"),
    Quantity(
        "mode", "1", "-3 failed, -2 no uplift, -1 rocked without overturning, n >= 0 overturned after n impacts, "
        f"{UNCOUNTED} overturned in 3D without a count of impacts", label="outcome", text_of=mode_words,
    ),
    Quantity("side", "1", "side of overturning: 1 right, -1 left, 0 not overturned"),
    Quantity("peak_rotation", "rad", "rotation of largest magnitude; pi/2 if overturned"),
    Quantity(
        "peak_ratio", "1", "peak rotation over the slenderness angle of its side; can exceed 1 without overturning",
        label="peak / alpha",
    ),
    Quantity("peak_time", "s", "time of the peak rotation; at most the end of the motion"),
    Quantity(
        "peak_velocity", "rad/s", "largest angular velocity at samples and impacts, and the first later impact"
    ),
    Quantity(
        "overturning_time", "s",
        "last time the centre of mass passed over the foot; at most the end of the motion",
    ),
    Quantity("first_uplift", "s", "time of the first uplift"),
    Quantity(
        "impacts", "1",
        "number of impacts; impacts after the motion count only before overturning",
    ),
    Quantity("uplifts", "1", "number of uplifts from rest"),
    Quantity(
        "still_rocking", "1",
        "1 if not overturned but still rocking at the end of the motion; NaN without a result",
    ),
    Quantity("truncation", "rad", "sum of the truncated terms of the series; no measure of accuracy"),
    Quantity("twin_change", "rad", "change of the peak rotation with half the time step"),
    Quantity("twin_flips", "1", "1 if only one of history and twin overturns, else 0; NaN if either has no result"),
    Quantity(
        "least_force", "1", "smallest normal contact force during rocking, over the weight; tensile below 0",
        label="smallest normal force / weight",
    ),
    Quantity(
        "friction_demand", "1", "largest ratio of horizontal to normal force during rocking; infinite for lost contact"
    ),
    Quantity(
        "lost_contact", "1",
        "1 if the contact force becomes tensile, so that the result assumes contact; NaN without a result",
    ),
)  # fmt: skip
_HISTORY_WITH_FRICTION = (
    Quantity("residual_displacement", "m", "displacement of the centre of mass at the end, relative to the ground"),
    Quantity("friction_usage", "1", "largest ratio of horizontal force to friction capacity; 1 during sliding"),
    Quantity(
        "impacts_replaced",
        "1",
        "number of impacts with the law of Stronge in place of a law without a solution or with energy gain",
    ),
    Quantity("shocks", "1", "number of impacts without collision, of a sliding foot without a possible contact force"),
)
_HISTORY_IN_SPACE = (
    Quantity("over_contact", "1", f"contact of overturning: {_spelled(_CONTACTS)}, -1 none"),
    Quantity("over_number", "1", "number of the edge or vertex of overturning; -1 for none"),
    Quantity(
        "peak_tilt",
        "rad",
        "largest angle from the vertical, with friction from the initial pose; pi/2 if overturned",
    ),
    Quantity("peak_spin", "rad/s", "largest angular velocity at ends of steps and at impacts"),
    Quantity("direction", "rad", "direction of the overturned body, from x towards y"),
    Quantity("end_time", "s", "end of the history"),
    Quantity("held", "s", "time with a fixed corner or nearly flat rim in place of slip or hop"),
    Quantity("events", "1", "number of impacts, uplifts and changes of contact"),
    Quantity("steps", "1", "number of steps of the engine"),
)
_HISTORY_ON_THE_HULL = (
    Quantity("pose", "1", "number of the final stable pose, by increasing height of the centre; -1 without a result"),
    Quantity("contacts_held", "1", "number of impacts and changes with fixed contacts, as no law has a solution"),
    Quantity("landings_replaced", "1", "number of impacts with the law of Housner for lack of a solution"),
)  # fmt: skip
_RESTRAINTS = (
    Quantity("restraint", "", "name of the restraint"),
    Quantity("restraint_kind", "", "kind of the restraint", label="kind"),
    Quantity("restraint_phase", "", "phase of the force law after the event", label="phase"),
    Quantity("force_law", "", "force law of the restraint"),
    Quantity("law_source", "", "source of the force law", label="source"),
    Quantity("law_domain", "", "limits of the force law", label="limits"),
    Quantity("law_constants", "", "constants of the force law, in SI units", label="constants"),
    Quantity("ground_point", "m", "point x, z of the restraint on the ground"),
    Quantity("body_point", "m", "point x, z of the restraint on the upright body"),
    Quantity("elongation", "m", "elongation of the restraint from the upright body"),
    Quantity("restraint_force", "N", "force of the restraint, positive in tension", label="force"),
    Quantity("restraint_work", "J", "work done on the restraint since the start", label="work"),
    Quantity("largest_force", "N", "largest force of the restraint, positive in tension"),
    Quantity("smallest_force", "N", "smallest force of the restraint, negative in compression"),
    Quantity("largest_elongation", "m", "largest elongation of the restraint"),
    Quantity("smallest_elongation", "m", "smallest elongation of the restraint, negative if shorter"),
    Quantity("yield_count", "1", "number of times the restraint begins to yield", label="yields"),
    Quantity("is_broken", "1", "1 if the restraint is broken at the end, else 0", label="broken"),
    Quantity("yielded_restraints", "1", "sum of 2^k over the restraints k (from 0) that yielded"),
    Quantity("broken_restraints", "1", "sum of 2^k over the restraints k (from 0) that are broken at the end"),
    Quantity("plastic_elongation", "m", "plastic elongation at the end"),
    Quantity("residual_force", "N", "force of the restraint at the end in the upright body"),
    Quantity("residual_slack", "m", "elongation from the upright body before a slack restraint has a force"),
    Quantity("dissipated_energy", "J", "energy dissipated by the restraint", label="dissipated"),
    Quantity("rupture_loss", "J", "elastic energy lost at the rupture of the restraint"),
    Quantity("floor_slope", "rad", "slope of the floor, positive if it rises to the right"),
    Quantity("lost_contact_time", "s", "time from which the contact force is tensile", label="contact lost at"),
    Quantity("base_displacement", "m", "displacement of the isolated base relative to the ground"),
    Quantity("base_velocity", "m/s", "velocity of the isolated base relative to the ground"),
    Quantity("base_velocity_before", "m/s", "velocity of the isolated base before the impact"),
    Quantity("base_velocity_after", "m/s", "velocity of the isolated base after the impact"),
    Quantity("base_acceleration", "m/s2", "absolute acceleration of the isolated base, without impacts"),
    Quantity("largest_base_displacement", "m", "largest displacement of the isolated base, the clearance needed"),
    Quantity("residual_base_displacement", "m", "displacement of the isolated base at the end of the response"),
    Quantity("largest_base_acceleration", "m/s2", "largest absolute acceleration of the isolated base at the samples"),
    Quantity("energy_dissipated", "J", "energy lost in the isolators since the start"),
    Quantity("lost_in_isolators", "J", "energy lost in dashpot and friction of the isolators"),
    Quantity("residual_rotation", "rad", "rotation at the end of the response"),
    Quantity("uplift_height", "m", "largest height of the lifted foot above the ground", label="uplift of the foot"),
    Quantity("base_shear", "N", "horizontal force of body and restraints on the foundation"),
    Quantity("overturning_moment", "N m", "moment on the foundation about the middle of the base"),
    Quantity("largest_base_shear", "N", "largest base shear at the samples"),
    Quantity("largest_overturning_moment", "N m", "largest overturning moment at the samples"),
    Quantity("balancing_acceleration", "m/s2", "ground acceleration in equilibrium with the rotation"),
    Quantity("restoring_moment", "N m", "moment of gravity and restraints about the foot, against the rotation"),
)
_STACK = (
    Quantity("joint", "1", "number of the joint below a body; 1 is the joint on the ground"),
    Quantity(
        "joint_state",
        "",
        "monolithic, rocking, sliding, rocking and sliding, in flight, overturned, or slid off",
        label="state",
    ),
    Quantity("joint_event", "", "opens, impact, closes, or turning point (peak)", label="event"),
    Quantity("corners_before", "", "corners in contact before the event, lowest joint first", label="before"),
    Quantity("corners_after", "", "corners in contact after the event, lowest joint first", label="after"),
    Quantity(
        "interpenetration", "1", "largest interpenetration of bodies, over the semi-diagonal of the smallest body"
    ),
    Quantity("lost_in_joints", "J", "energy lost in impacts and friction of the joints since the start"),
    Quantity("energy_created", "J", "sum of the positive works of contact impulses; an error of the time steps"),
    Quantity("joint_height", "m", "height of the joint above the ground", label="height"),
    Quantity("joint_width", "m", "distance of the corners of the joint", label="width"),
    Quantity("opening", "rad", "rotation of the upper body of a joint relative to the lower body"),
    Quantity("peak_opening", "rad", "largest opening of the joint"),
    Quantity("residual_opening", "rad", "opening of the joint at the end of the response"),
    Quantity("joint_displacement", "m", "displacement of the upper body along the joint"),
    Quantity("peak_joint_displacement", "m", "largest displacement along the joint", label="peak displacement"),
    Quantity(
        "residual_joint_displacement", "m", "displacement along the joint at the end", label="residual displacement"
    ),
)
_SAMPLES = (
    Quantity("time", "s", "time", digits=".6f"),
    Quantity("rotation", "rad", "rotation theta, positive clockwise"),
    Quantity("angular_velocity", "rad/s", "angular velocity"),
    Quantity("displacement", "m", "displacement of the centre of mass to the right, relative to the ground"),
    Quantity("rise", "m", "height of the centre of mass above its position at rest"),
    Quantity("horizontal_velocity", "m/s", "velocity of the centre of mass to the right, relative to the ground"),
    Quantity("vertical_velocity", "m/s", "velocity of the centre of mass upwards, relative to the ground"),
    Quantity(
        "regime",
        "1",
        "; ".join(f"{code} {word}" for code, word in _REGIMES.items()),
        _REGIMES,
        spelled={regime.name.lower(): regime.value for regime in Regime},
    ),
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
    Quantity("energy_lost", "J", "energy lost at impacts since the start", label="energy lost in impacts"),
    Quantity("lost_in_friction", "J", "energy lost in friction since the start", label="energy lost in friction"),
    *(
        Quantity(f"quaternion_{axis}", "1", f"attitude, component {axis} of the unit quaternion")
        for axis in ("s", "x", "y", "z")
    ),
    *(Quantity(f"angular_velocity_{axis}", "rad/s", f"angular velocity about {axis}") for axis in "xyz"),
    *(Quantity(f"centre_{axis}", "m", f"centre of mass, {axis}") for axis in "xyz"),
    *(Quantity(f"ground_acceleration_{axis}", "m/s2", f"acceleration of the ground, {axis}") for axis in "xyz"),
    Quantity("tilt", "rad", "angle between the axis of the body and the vertical"),
    Quantity("azimuth", "rad", "direction of the tilt, from x towards y"),
    Quantity(
        "contact",
        "1",
        _spelled(_CONTACTS),
        _CONTACTS,
        spelled={contact.name.lower(): contact.value for contact in ContactMode},
    ),
    Quantity("touching", "1", "number of vertices on the ground"),
    Quantity("sliding", "1", "number of sliding vertices"),
)
_BODY = (
    Quantity("kind", "", "kind of the body, motion or base"),
    Quantity("name", "", "name"),
    Quantity("assumed", "", "assumed values without an input, one sentence each"),
    Quantity("warnings", "", "warnings about the input or the result, one sentence each"),
    Quantity("repairs", "", "changes of the mesh, one sentence each"),
    Quantity("mass", "kg", "mass", digits=".6g"),
    Quantity("half_width", "m", "horizontal distance of the centre of mass from a foot"),
    Quantity("volume", "m3", "volume", digits=".6g"),
    Quantity("size", "m", "sides of the bounding box"),
    Quantity("parts", "1", "number of parts"),
    Quantity("centre", "m", "centre of mass", label="centre of mass", digits=".5g"),
    Quantity("centre_height", "m", "height of the centre of mass above the ground", digits=".5g"),
    Quantity("inertia", "kg m2", "inertia tensor about the centre of mass"),
    Quantity("moment_of_inertia", "kg m2", "moment of inertia about the centre of mass", digits=".5g"),
    Quantity("foot_positions", "m", "x of the left and of the right foot"),
    Quantity("base_vertices", "m", "vertices x, y of the base", digits=".5g"),
    Quantity("outline", "m", "vertices x, y"),
    Quantity("holes", "m", "vertices x, y of every hole"),
    Quantity("density", "kg/m3", "density"),
    Quantity("points", "m", "x, y of points"),
    Quantity("masses", "kg", "masses of the points"),
    Quantity("ground", "m", "height of the ground"),
    Quantity("base_contact", "m", "intervals of the base in contact with the ground, from x to x"),
    Quantity("base_centre", "m", "centre x, y of a round base", digits=".5g"),
    Quantity("base_radius", "m", "radius of a round base", digits=".5g"),
    Quantity("column_count", "1", "number of columns of a frame"),
    Quantity("beam_mass", "kg", "mass of the beam of a frame", digits=".6g"),
    Quantity("beam_on", "", "support of the beam: corner or hinge"),
    Quantity("base_mass", "kg", "mass of the isolated base", digits=".6g"),
    Quantity("stiffness", "N/m", "horizontal stiffness of the isolators", digits=".5g"),
    Quantity("damping", "N s/m", "coefficient of the dashpot of the isolators", digits=".5g"),
    Quantity("base_friction", "1", "coefficient of friction between base and ground"),
    Quantity("gravity", "m/s2", "acceleration of gravity", digits=".6g"),
    Quantity("slenderness_ratio", "1", "slenderness h/b", label="h/b"),
    Quantity("slenderness_angle", "rad", "slenderness angle alpha = atan(b/h)"),
    Quantity("semi_diagonal", "m", "distance R of the centre of mass from the foot", label="R", digits=".5g"),
    Quantity("frequency_parameter", "rad/s", "frequency parameter p", label="p", digits=".5g"),
    Quantity("uplift_acceleration", "m/s2", "ground acceleration at uplift, g tan(alpha)", label="uplift at"),
)
_IMPACT_MODELS = (
    Quantity("impulse_ratio", "1", "distance of the impulse over the lever arm of the new foot", label="k"),
    Quantity("impulse_position", "m", "x of the impulse on the ground"),
    Quantity("energy_loss", "1", "fraction of the kinetic energy lost at the impact", digits=".2%"),
    Quantity("admissible", "1", "1 if one impulse on the base can cause the impact without energy gain, else 0"),
    Quantity("energy_ratio", "1", "kinetic energy after over before the impact"),
    Quantity("energy", "J", "energy"),
    Quantity("fraction", "1", "fraction", label="fraction", digits=".2%"),
    Quantity("share", "1", "fraction", label="fraction", digits=".2%"),
    Quantity("ked_energy_fractions", "1", "kinetic energy after each stage of KED over the energy before the impact"),
    Quantity("velocity", "m/s", "velocity x, y at points"),
    Quantity("energy_left", "1", "fraction of the energy after an impact on each foot"),
    Quantity("impacts_to_half", "1", "number of impacts that halve the energy"),
    Quantity("bias", "1", "bias: mean of model minus measurement", digits="+.4f"),
    Quantity("within", "1", "1 if a value is within the 95 % interval, else 0", label="within 95 %"),
    Quantity("rmse", "1", "root mean square error of the coefficient", label="RMSE", digits=".4f"),
    Quantity("loss_rmse", "1", "root mean square error of the energy loss", label="loss", digits=".4f"),
    Quantity("behind_closest", "1", "additional error compared with the closest model: value, low, high"),
    Quantity("measurements", "1", "number of measurements"),
    Quantity("rounding", "1", "half of the last printed digit of the measurements"),
    Quantity("edge_start", "m", "first corner x, y of the edge", label="from", digits=".5g"),
    Quantity("edge_end", "m", "second corner x, y of the edge", label="to", digits=".5g"),
    Quantity("nearest_edge", "m", "distance of the plumb line from the nearest edge of the support polygon"),
    Quantity("barrier", "m", "rise of the centre of mass required to leave the pose", label="energy barrier"),
    Quantity("down", "1", "direction of gravity in axes of the body"),
    Quantity("saddles", "1", "number of saddles: balanced on an edge"),
    Quantity("summits", "1", "number of summits: balanced on a corner"),
    Quantity("stands_in", "1", "number of the current pose of the body"),
    Quantity("settling_rotation", "rad", "rotation from the pose as placed into the present pose"),
    Quantity("smallest_overturning_tilt", "rad", "tilt with the centre of mass above the nearest edge of the base"),
    Quantity(
        "largest_overturning_tilt",
        "rad",
        "tilt with the centre of mass above the farthest corner of the base",
    ),
    Quantity("straight_rise", "m", "rise of the centre of mass for toppling in one direction"),
    Quantity("lowest_rise", "m", "smallest rise of the centre of mass for toppling into this pose"),
    Quantity("topples_into", "1", "number of the pose after toppling", label="into pose"),
    Quantity("tolerance", "m", "largest distance from the ground of contact points", label="within"),
    Quantity("corners", "1", "number of corners of the support polygon"),
    Quantity("edges_left_out", "1", "number of less slender edges, not computed"),
)
_STUDIES = (
    Quantity("uplift_ratio", "1", "PGA over that of uplift", label="/ uplift", digits=".6f"),
    Quantity("bracket_width", "m/s2", "width of the bracket of a crossing"),
    Quantity("mode_below", "1", "mode below a crossing", label="below", text_of=mode_words),
    Quantity("mode_above", "1", "mode above a crossing", label="above", text_of=mode_words),
    Quantity("minimum_acceleration", "m/s2", "smallest PGA with overturning"),
    Quantity("certain_acceleration", "m/s2", "PGA above which every history overturns"),
    Quantity("overturning_intervals", "m/s2", "intervals of PGA with overturning"),
    Quantity("safe_intervals", "m/s2", "intervals of PGA without overturning above the first with overturning"),
    Quantity("min_pga", "m/s2", "smallest computed PGA"),
    Quantity("max_pga", "m/s2", "largest computed PGA"),
    Quantity("resolution", "1", "resolution of the samples, over the PGA"),
    Quantity("resolution_below", "1", "resolution below the first crossing"),
    Quantity("failed", "1", "number of histories without a result"),
    Quantity("histories", "1", "number of histories"),
    Quantity("count", "1", "number"),
    Quantity("cells", "1", "number of cells"),
    Quantity("area", "1", "area of an island over that of the map"),
    Quantity("refined_points", "1", "number of points along boundaries"),
    Quantity("only_first", "1", "number of histories with overturning only for the first"),
    Quantity("only_second", "1", "number of histories with overturning only for the second"),
    Quantity("compared", "1", "number of compared histories"),
    Quantity("unknown", "1", "number of histories without a result in one of both"),
    Quantity("not_lifted", "1", "number of histories without uplift"),
    Quantity("rocked", "1", "number of histories with rocking and without overturning"),
    Quantity("largest_peak_ratio", "1", "largest peak ratio without overturning", label="peak / alpha"),
    Quantity("largest_overturned_period", "s", "largest 2 pi / p of a block with overturning", label="overturns up to"),
    Quantity("seed", "1", "random seed"),
    Quantity("limit_states", "1", "limit states: peak rotation over the slenderness angle"),
    Quantity("trials", "1", "number of histories at each level"),
    Quantity("reached", "1", "number of histories that reach a limit state"),
    Quantity("dispersion", "1", "logarithmic standard deviation", digits=".3g"),
    Quantity("dispersion_95", "1", "95 % interval of the dispersion"),
    Quantity("failures", "1", "number of failures"),
    Quantity("observations", "1", "number of observations"),
    Quantity("log_likelihood", "1", "logarithm of the likelihood"),
    Quantity("resurrected_motions", "1", "number of motions with an interval without overturning above overturning"),
    Quantity("resurrected_motions_over_1_percent", "1", "number of these motions with an interval wider than 1 %"),
    Quantity("slope", "1", "slope of the regression in logarithms"),
    Quantity("intercept", "1", "intercept of the regression in logarithms"),
    Quantity("scatter", "1", "logarithmic scatter", digits=".4f"),
    Quantity("determination", "1", "R squared of the regression"),
    Quantity("modes", "1", "modes of an island"),
    Quantity("choices", "1", "differences between choices: fractions, ratios and distances of curves"),
    Quantity("slope_error", "1", "standard error of the slope"),
    Quantity("p_value", "1", "p value"),
    Quantity("misfit", "1", "misfit to the target spectrum", digits=".2f"),
    Quantity("misfit_of_mean", "1", "misfit of the mean to the target spectrum"),
    Quantity("least_ratio", "1", "smallest ratio of the mean to the target spectrum"),
    Quantity("motions_with_vertical", "1", "number of motions with a vertical component"),
)
_DECISIONS = (
    Quantity("probability", "1", "probability"),
    Quantity("beside", "1", "probability of overturning with another restitution model"),
    Quantity("sliding_beyond", "m", "sliding distance of the probability"),
    Quantity("per_motion", "1", "probability under each motion", digits="%"),
    Quantity("first", "1", "first-order index of the variance of overturning", label="alone", digits=".2f"),
    Quantity("total", "1", "total index of the variance of overturning", label="with the others", digits=".2f"),
    Quantity("input_low", "1", "mean of the input in the lowest fifth of its samples, in the unit of the input"),
    Quantity("input_high", "1", "mean of the input in the highest fifth of its samples, in the unit of the input"),
    Quantity("probability_low", "1", "probability of overturning in the lowest fifth"),
    Quantity("probability_high", "1", "probability of overturning in the highest fifth"),
    Quantity("pairs", "1", "number of pairs of histories under each motion"),
    Quantity("pairs_rocking", "1", "number of pairs with rocking"),
    Quantity("pairs_apart", "1", "number of pairs with different outcomes"),
    Quantity("motions", "1", "number of motions"),
    Quantity("record_index", "1", "index of the record of each motion"),
    Quantity("uplift_factors", "1", "scale factor of each motion at uplift", label="uplift factor"),
    Quantity("factors", "1", "smallest scale factor of each motion with overturning, for both polarities"),
    Quantity("min_factor", "1", "smallest scale factor with overturning", label="margin", digits=".3g"),
    Quantity("min_factor_in_plane", "1", "smallest scale factor with overturning of the plane body"),
    Quantity("plane_azimuth", "rad", "direction of the plane body, from x towards y"),
    Quantity("barrier_energy", "J", "energy required to topple the body"),
    Quantity("barrier_azimuth", "rad", "direction of the smallest energy barrier, from x towards y"),
    Quantity("code_methods", "1", "largest scale factor allowed by a code method", label="limit factor", digits=".3g"),
    Quantity("margin", "1", "required margin"),
    Quantity("tension", "N", "tension of anchors on each edge"),
    Quantity("shear", "N", "shear of anchors"),
    Quantity("no_overturning", "m", "length that prevents overturning"),
    Quantity("no_uplift", "m", "length that prevents uplift"),
    Quantity("isolation_period", "s", "shortest period of isolation"),
    Quantity("isolation_displacement", "m", "displacement of the isolation"),
    Quantity("levels", "1", "levels of the motions"),
    Quantity("safe", "1", "number of histories rated safe", label="rated safe"),
    Quantity("histories_known", "1", "number of histories with a result"),
    Quantity("limit_ratio", "1", "level over the level allowed by the method", label="D/C", digits=".3g"),
    Quantity("fraction_95", "1", "95 % interval of the fraction"),
    Quantity("median", "1", "median"),
    Quantity("median_95", "1", "95 % interval of the median"),
    Quantity("censored", "1", "number of histories without overturning at any level"),
    Quantity("worse_side_counts", "1", "1 if only the worse side is rated, else 0"),
)
_INVENTORY = (
    Quantity("rank", "1", "rank of the object"),
    Quantity("row", "1", "row of the list"),
    Quantity("header_lines", "1", "lines above the table"),
    Quantity("counts", "1", "number of objects with each rating"),
    Quantity("pieces", "1", "number of pieces with each rating"),
    Quantity("thresholds", "1", "limits of the ratings"),
    Quantity("number_of_motions", "1", "number of motions"),
    Quantity("pgv_range", "m/s", "range of PGV of the motions"),
    Quantity("lifted", "1", "number of histories with uplift"),
    Quantity("slid", "1", "number of histories with sliding"),
    Quantity("overturned_fraction", "1", "fraction of the histories with overturning"),
    Quantity("overturned_interval", "1", "95 % interval of the fraction with overturning"),
    Quantity("median_rotation_over_angle", "1", "median of the peak ratio; infinite if it overturns"),
    Quantity("high_rotation_over_angle", "1", "84 % quantile of the peak ratio; infinite if it overturns"),
    Quantity("approximate", "m", "approximate dimensions"),
    Quantity("pieces_spared", "1", "number of falls prevented"),
    Quantity("gain", "1", "falls prevented, weighted by the consequence"),
    Quantity("base_wider_each_side", "m", "widening of the base on each side"),
    Quantity("centre_lower", "m", "lowering of the centre of mass"),
    Quantity("ballast", "kg", "ballast at the base"),
    Quantity("anchors_of_one_edge", "N", "tension of the anchors of one edge"),
    Quantity("anchors_of_one_edge_over_weight", "1", "tension of the anchors of one edge over the weight"),
    Quantity("anchors_across_over_weight", "1", "shear of the anchors over the weight"),
    Quantity("moved_to_fraction_of_shaking", "1", "intensity at another location over the intensity at this location"),
)
_MOTION = (
    Quantity("support", "", "support of the motion: the ground, or a floor of a building"),
    Quantity("provenance", "", "source of the motion, and each processing step, in order"),
    Quantity("scale", "1", "scale factor of the motion"),
    Quantity("duration", "s", "duration of the motion", digits=".6g"),
    Quantity("peak_ground_acceleration", "m/s2", "largest acceleration of the motion, scaled", label="PGA"),
    Quantity("peak_ground_velocity", "m/s", "largest velocity of the motion from rest, scaled", label="PGV"),
    Quantity("pga", "m/s2", "peak ground acceleration", label="PGA"),
    Quantity("pgv", "m/s", "peak ground velocity", label="PGV"),
    Quantity("peak_ground_displacement", "m", "largest displacement of the motion", label="PGD"),
    Quantity("end_velocity", "m/s", "velocity at the end of the motion"),
    Quantity("peak_vertical_acceleration", "m/s2", "largest vertical acceleration of the motion"),
    Quantity("time_step", "s", "time between samples of the record", digits=".6g"),
    Quantity("acceleration", "m/s2", "acceleration of the motion"),
    Quantity("vertical_acceleration", "m/s2", "vertical acceleration of the motion"),
    Quantity("damping_ratio", "1", "damping ratio of the spectrum"),
    Quantity("period", "s", "undamped natural period"),
    Quantity("pseudo_acceleration", "m/s2", "spectral pseudo-acceleration", label="PSA"),
    Quantity("pseudo_velocity", "m/s", "spectral pseudo-velocity", label="PSV"),
    Quantity("spectral_displacement", "m", "spectral displacement", label="Sd"),
    Quantity("absolute_acceleration", "m/s2", "spectral absolute acceleration"),
)
_RESPONSE = (
    Quantity("restitution", "", "restitution model, or coefficient"),
    Quantity("model", "", "restitution model"),
    Quantity("error", "", "reason for a missing result, as a sentence"),
    Quantity("engine", "", "engine and its options"),
    Quantity("linear", "1", "1 if the equations are linearised, else 0"),
    Quantity("summary", "", "outcome as a sentence"),
    Quantity("initial_rotation", "rad", "rotation at the start"),
    Quantity("initial_tilt", "rad", "tilt at the start"),
    Quantity("initial_azimuth", "rad", "direction of the tilt at the start, from x towards y"),
    Quantity("start_height", "m", "height of the lowest point above the ground at the start"),
    Quantity("start_velocity", "m/s", "velocity at the start, upwards last"),
    Quantity("friction", "1", "coefficient of friction between body and ground"),
    Quantity("friction_assumed", "1", "1 if the coefficient of friction is assumed, else 0"),
    Quantity("friction_of_motion", "1", "friction demand during rocking", label="friction while rocking", digits=".3f"),
    Quantity("friction_of_impacts", "1", "friction demand at impacts", label="friction at impacts", digits=".3f"),
    Quantity("normal_restitution", "1", "coefficient of normal restitution"),
    Quantity("normal_restitution_law", "", "law of the coefficient of normal restitution"),
    Quantity("uplift_times", "s", "times of the uplifts from rest"),
    Quantity(
        "energy_closure", "1", "energy balance error over the largest energy", label="energy balance error",
        digits=".1e",
    ),
    Quantity("growth_rate", "1/s", "logarithm of the largest growth of a difference since the start, over its time"),
    Quantity("growth_time", "s", "time of the largest growth of a difference since the start"),
    Quantity("relative_change", "1", "relative change of the peak rotation / relative change of the motion"),
    Quantity(
        "error_estimate", "rad", "largest change of the rotation with half the time step; infinite if the outcome "
        "changes", label="numerical error", digits=".1e",
    ),
    Quantity("overturned_over", "", "edge, vertex or rim over which the body overturned"),
    Quantity("unfinished", "", "motion of the body at the end of the computation, as a sentence"),
    Quantity("ends_early", "1", "1 if the computation ends before rest because impacts lose no energy, else 0"),
    Quantity("quaternion", "1", "attitude: unit quaternion (s, x, y, z)"),
    Quantity("ground_displacement", "m", "displacement of the ground"),
    Quantity("history", "1", "number of the history"),
    Quantity("difference", "rad", "difference of peak rotations"),
    Quantity("lying", "rad", "rotation of a body lying on its left and on its right side"),
    Quantity("samples", "1", "number of samples"),
    Quantity("samples_shown", "1", "number of samples in the answer"),
)  # fmt: skip
_IMPACTS_AND_INTERVALS = (
    Quantity("velocity_before", "rad/s", "angular velocity before the impact", digits="+.6f"),
    Quantity("velocity_after", "rad/s", "angular velocity after the impact", digits="+.6f"),
    Quantity("coefficient", "1", "coefficient of restitution, a ratio of velocities", label="r", digits=".4f"),
    Quantity("foot", "1", "foot of the landing: 1 right, -1 left", _SIDES),
    *(Quantity(f"normal_{foot}", "N s", f"vertical impulse on the {foot} foot") for foot in ("left", "right")),
    *(Quantity(f"tangential_{foot}", "N s", f"horizontal impulse on the {foot} foot") for foot in ("left", "right")),
    Quantity("energy_before", "J", "kinetic energy before the impact"),
    Quantity("energy_after", "J", "kinetic energy after the impact"),
    Quantity("impulse", "N s", "vertical impulse of the impact"),
    Quantity("pull", "N s", "tensile part of the impulse"),
    Quantity("slips", "1", "1 if the feet slide during the impact, else 0", label="feet slide"),
    Quantity("feet", "", "feet in contact with the ground"),
    Quantity("slip", "1", "direction of sliding: 1 right, -1 left, 0 no sliding"),
    Quantity("vertices", "", "numbers of the vertices on the ground"),
    Quantity("sliding_vertices", "", "numbers of the sliding vertices", label="sliding"),
    Quantity("start", "s", "start of the interval", label="from", digits=".6f"),
    Quantity("end", "s", "end of the interval", label="to", digits=".6f"),
    Quantity("distance", "m", "path of the feet along the ground in the interval", label="sliding distance"),
)
_IDENTIFICATION = (
    Quantity("no_scatter", "1", "probability of a coefficient without scatter", digits=".3g"),
    Quantity("trend", "1", "slope of the logarithm of the coefficient over that of the speed"),
    Quantity("independent", "1", "number of independent measured values"),
    Quantity("advantage", "1", "logarithm of the likelihood ratio to times with a constant mean interval"),
    Quantity("residual_times", "s", "times of the residuals"),
    Quantity("number", "1", "number of the impact, from zero", label="no."),
    Quantity("speed", "rad/s", "angular velocity before the impact, without sign"),
    Quantity("release_ratio", "1", "initial rotation over the slenderness angle", digits="g"),
    Quantity("timing_noise", "s", "standard deviation of a measured time", digits=".2g"),
    Quantity("deviation", "1", "standard deviation of the mean coefficient", digits=".2g"),
    Quantity("clock", "s", "time offset of the measurement ahead of the motion"),
    Quantity("gain", "1", "measured over true rotation"),
    Quantity("stretches", "1", "number of measured states at the start of half cycles"),
    Quantity("excluded_half_cycles", "1", "number of half cycles that pure rocking does not explain"),
    Quantity("used", "s", "duration of the used half cycles"),
    Quantity("measured", "s", "duration of the measurement"),
    Quantity("predictable", "s", "time up to which the rotation from rest is predictable"),
    Quantity("common", "1", "standard deviation of the logarithm of the coefficient, common to all trials"),
)
_SCORES = (
    Quantity("outcomes", "1", "number of outcomes"),
    Quantity("happened", "1", "number of outcomes with the event"),
    Quantity("left_out", "1", "number of outcomes without a probability"),
    Quantity("brier", "1", "Brier score", label="Brier", digits=".3f"),
    Quantity("logarithmic", "1", "logarithmic score", digits=".3f"),
    Quantity("balanced_accuracy", "1", "balanced accuracy", digits=".3f"),
    Quantity("sureness", "1", "overconfidence; positive if overconfident"),
    Quantity("calibration", "1", "fitted parameters of a calibration"),
    Quantity("predicted", "1", "mean of the predicted probabilities", digits=".2f"),
    Quantity("observed", "1", "fraction of the outcomes with the event", digits=".2f"),
)
_LEAGUE = (
    Quantity("correlation", "1", "correlation with the measurements"),
    Quantity("concordance", "1", "concordance with the measurements", label="Lin", digits=".3f"),
    Quantity("log_loss_rmse", "1", "RMSE of the logarithm of the energy loss", label="log loss", digits=".3f"),
    Quantity("leave_one_out", "1", "RMSE of measurements left out one by one", label="LOO", digits=".4f"),
    Quantity("leave_group_out", "1", "RMSE of groups left out one by one", label="LOG", digits=".4f"),
    Quantity("bic", "1", "Bayesian information criterion", label="BIC", digits=".1f"),
    Quantity("by_group", "1", "root mean square error of each group"),
    Quantity("by_band", "1", "root mean square error in each band of h/b", digits=".3f"),
    Quantity("ahead_of_ked", "1", "additional error of KED compared with the model: value, low, high"),
    Quantity("fitted", "1", "fitted parameters of a model"),
    Quantity("shares", "1", "fractions of the scatter"),
    Quantity("inside", "1", "number of measurements within their intervals"),
    Quantity("interval_width", "1", "mean width of the intervals", digits=".3f"),
    Quantity("covered", "1", "number of measurements within their intervals, and of all"),
    Quantity("printed", "1", "values printed in the paper"),
    Quantity("recomputed", "1", "recomputed values"),
)
_CAMPAIGN = (
    Quantity("histories_done", "1", "number of recorded histories"),
    Quantity("all_histories", "1", "number of histories of all rounds"),
    Quantity("verified", "1", "number of histories that are equal when read again"),
    Quantity("missing", "1", "first and last number of missing histories"),
    Quantity("later", "1", "usual range of the number of histories of later rounds"),
    Quantity("chunk", "1", "number of histories of a chunk"),
    Quantity("chunks", "1", "number of chunks"),
    *(Quantity(f"{done}_chunks", "1", f"number of chunks {done}") for done in ("computed", "resumed", "adopted")),
    Quantity("chunks_done", "1", "number of recorded chunks"),
    Quantity("rounds", "1", "number of rounds"),
    Quantity("rounds_begun", "1", "number of started rounds"),
    Quantity("retried", "1", "number of chunks computed again"),
    Quantity("worker_seconds", "s", "computing time of all workers"),
    Quantity("run_seconds", "s", "duration of the run"),
    Quantity("seconds", "s", "estimated duration"),
    Quantity("between", "s", "range of the estimated duration"),
    Quantity("rate", "1/s", "histories per second of one worker"),
    *(Quantity(name, "B", f"required {name}") for name in ("memory", "disk")),
    Quantity("free", "B", "free disk space"),
    Quantity("bytes", "B", "size of the file"),
)


def _coded(*names: str) -> dict[int, str]:
    return dict(enumerate(names))


_ATTRACTORS = _coded("rest", "sticking", "periodic", "irregular", "overturned", "failed")
_FINAL_STATES = _coded("overturned", "small", "settled", "failed")
_BRANCH_POINTS = _coded("none", "fold", "pitchfork", "period doubling", "grazing")
_LONG_RUN = (
    Quantity("amplitude_ratio", "1", "peak ground acceleration over that of uplift", label="amplitude / uplift"),
    Quantity("frequency_ratio", "1", "circular frequency of the ground motion over p", label="frequency / p"),
    Quantity("ground_phase", "rad", "phase of the ground motion at the impact", label="phase"),
    Quantity("speed_ratio", "1", "angular velocity after the impact / (alpha p)", label="speed / (alpha p)"),
    Quantity("rotation_ratio", "1", "rotation at the end of the period / alpha", label="rotation / alpha"),
    Quantity("velocity_ratio", "1", "angular velocity at the end of the period / (alpha p)"),
    Quantity("initial_state", "1", "index of the initial state"),
    Quantity("period_number", "1", "number of the period of the ground motion"),
    Quantity("orbit", "1", "index of the orbit"),
    Quantity("branch", "1", "index of the branch: 0 is the symmetric branch"),
    Quantity("orbit_number", "1", "index of the orbit on the branch; bifurcations first"),
    Quantity(
        "attractor",
        "1",
        "kind of the motion: at rest, with rests, periodic, irregular, overturned, failed",
        _ATTRACTORS,
    ),
    Quantity("periods", "1", "number of periods of the ground motion after which the motion repeats; 0 if none"),
    Quantity("is_symmetric", "1", "1 if the motion is periodic and symmetric, else 0"),
    Quantity("impacts_per_period", "1", "number of impacts per period of the ground motion"),
    Quantity("exponent", "1/s", "largest Lyapunov exponent; minus infinity with rests", digits="+.4g"),
    Quantity("second_exponent", "1/s", "second Lyapunov exponent; minus infinity with rests", digits="+.4g"),
    Quantity("exponent_error", "1/s", "standard error of the mean largest exponent", digits=".2g"),
    Quantity("exponent_over_p", "1", "largest Lyapunov exponent over p", label="exponent / p", digits="+.4g"),
    Quantity("impact_rate", "1/s", "number of impacts per second"),
    Quantity("orbits_counted", "1", "number of orbits in the mean", label="orbits"),
    Quantity("orbits_sticking", "1", "number of orbits with rests", label="with rests"),
    Quantity("orbits_overturned", "1", "number of orbits that overturn", label="overturned"),
    Quantity("final_state", "1", "overturned, small (slow impact), settled (still rocking), failed", _FINAL_STATES),
    Quantity("is_uncertain", "1", "1 if the final state depends on the tolerance of the time integration, else 0"),
    Quantity("stability", "1", "fraction of the initial states that do not overturn", digits=".4f"),
    *(
        Quantity(f"cells_{name}", "1", f"number of initial states: {name}", label=name)
        for name in (*_FINAL_STATES.values(), "uncertain")
    ),
    Quantity("box_dimension", "1", "box-counting dimension of the boundary of overturning", digits=".3f"),
    Quantity("multiplier", "1", "largest modulus of the multipliers of the orbit"),
    Quantity("impacts_of_orbit", "1", "number of impacts until the orbit closes", label="impacts"),
    Quantity("is_stable", "1", "1 if the orbit is stable, else 0"),
    Quantity("branch_point", "1", "kind of the bifurcation", _BRANCH_POINTS, label="bifurcation"),
    *(
        Quantity(f"fraction_{name}", "1", f"fraction of the motions: {name}", label=name, digits=".4f")
        for name in list(_ATTRACTORS.values())[:5]
    ),
    *(
        Quantity(f"lowest_{name}", "1", f"lowest value with a motion that is {name}", label=f"lowest {name}")
        for name in ("multiperiod", "irregular", "overturned")
    ),
)
QUANTITIES: dict[str, Quantity] = {
    entry.name: entry
    for entry in (
        *_BODY,
        *_IMPACT_MODELS,
        *_STUDIES,
        *_DECISIONS,
        *_IDENTIFICATION,
        *_SCORES,
        *_LEAGUE,
        *_CAMPAIGN,
        *_INVENTORY,
        *_MOTION,
        *_RESPONSE,
        *_HISTORY,
        *_HISTORY_WITH_FRICTION,
        *_HISTORY_IN_SPACE,
        *_HISTORY_ON_THE_HULL,
        *_RESTRAINTS,
        *_STACK,
        *_SAMPLES,
        *_LONG_RUN,
        *_IMPACTS_AND_INTERVALS,
    )
}
"""All quantities by name."""


def closely(**digits: str) -> dict[str, Quantity]:
    """Return quantities with other number formats, for answers with higher precision.

    >>> closely(time=".2f")["time"].digits
    '.2f'
    """
    return {name: replace(QUANTITIES[name], digits=format_spec) for name, format_spec in digits.items()}


# other keys of answers: sections, sentences, labels, and numbers whose quantity is defined by the answer
_PARTS = """
    adjusted advice all all_bodies amplitude_step analysis answer answers assumptions base base_tolerances
    basins better_by bodies body by_data_set called_safe cases caution cells_per_basin claim claims code_methods_outside
    coefficients columns_not_read comparison comparisons components concerns contributions converged crossing_curves
    crossings curves decides definition designs died directions doubts edges ends envelope errata event evidence
    examples facets file file_unit files finding findings first_corner folder forced from hazard headline
    hierarchy identities ignored im im_description inputs intensity interfaces intervals inventory is_complete islands
    joint_events joints judged_by
    label laboratories language last_state league left_out_groups level likelihood likelihood_scale lowest
    lowest_uplift mean messages method methods mirrored model_error models motion motions_apart new not_assessed
    not_objects not_read not_sampled note notes objects one_by_one other_models outcome_pairs outside
    overturned_cells overturning passed_over
    passes plan plane_is_weakest poses prediction progress reason reasons records refused reliability remedies
    resolved restitution_sampled restraint_events restraint_laws restraints results
    rigid rings scores section sense sensitivity sentence sentences sets sides
    slow software solid source sources spacing spectrum stable stages standing starts_overturned
    starts_per_amplitude stated statement stored tables target target_spectrum test text threads title to too_sure
    traces unit updated uplift_threshold values varied verdict vertical_component with_friction words x y
"""
PARTS = frozenset(_PARTS.split())


def is_named(key: str) -> bool:
    """Return True if a key of an answer is a quantity or a section."""
    return key in PARTS or quantity(key) is not None


TIMES = tuple(entry.name for entry in _HISTORY if entry.unit == "s")
"""Names of the times of a history. They scale with the time of the motion."""
HISTORY = tuple(entry.name for entry in _HISTORY if not entry.name.startswith("twin"))
"""Quantities of every history of a study of plane bodies, in the order of tables."""
WITH_RESTRAINTS = ("residual_rotation", "yielded_restraints", "broken_restraints")
"""Additional quantities of every history of a body with restraints."""
