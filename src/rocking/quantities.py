"""Every result once: its name, unit and meaning, and what its codes stand for; tables, files, answers read it here."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from rocking.outcome import UNCOUNTED, ContactMode, Outcome, Regime, Status, mode_words


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
    label: str = ""  # heading of a column or a line for readers; the name, if empty
    digits: str = ".4g"  # how a number is written for readers; % in percent, with as many digits as a reader needs
    spelled: dict[str, str] = field(default_factory=dict)  # words for readers in place of short ones
    words: Callable[[int], str] | None = None  # of numbers that readers see as words

    @property
    def heading(self) -> str:
        """Label for readers."""
        return self.label or self.name.replace("_", " ")

    @property
    def is_text(self) -> bool:
        """Whether readers see words."""
        return not self.unit or bool(self.codes)

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


def with_units(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return attributes of a file with the units of quantities beside them.

    >>> with_units({"mass": 2.0, "engine": "fast", "semi_diagonal_left": 1.0})
    {'mass': 2.0, 'engine': 'fast', 'semi_diagonal_left': 1.0, 'mass_units': 'kg', 'semi_diagonal_left_units': 'm'}
    """
    entries = {name: quantity(name) for name, value in values.items() if not isinstance(value, str)}
    units = {f"{name}_units": entry.unit for name, entry in entries.items() if entry and entry.unit not in {"", "1"}}
    return {**values, **units}


_ENDS = {
    "_low": "lower end of the 95 % interval", "_high": "upper end of the 95 % interval", "_left": "left foot",
    "_right": "right foot",
}  # fmt: skip


def quantity(name: str, own: Mapping[str, Quantity] = MappingProxyType({})) -> Quantity | None:
    """Return the entry of a name; own: entries of one answer, which take precedence.

    A name with _low, _high, _left or _right after it is that of an end of the interval, or of one foot.

    >>> quantity("scatter_low").meaning
    'logarithmic scatter, lower end of the 95 % interval'
    """
    if entry := own.get(name) or QUANTITIES.get(name):
        return entry
    end = next((each for each in _ENDS if name.endswith(each)), "")
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
    Quantity("overturned", "1", "1 it overturned, 0 it did not, NaN where there is no result: neither"),
    Quantity(
        "mode", "1", "-3 failed, -2 not lifted, -1 rocked and stayed standing, n >= 0 overturned after n impacts, "
        f"{UNCOUNTED} overturned in space, where they are not counted", label="outcome", words=mode_words,
    ),
    Quantity("side", "1", "side to which it overturned: 1 right, -1 left, 0 it did not"),
    Quantity("peak_rotation", "rad", "rotation of largest size; a quarter turn if it overturned"),
    Quantity(
        "peak_ratio", "1", "peak rotation over the slenderness angle of its side; beyond 1 is not overturning",
        label="peak / alpha",
    ),
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
        "least_force", "1", "smallest normal force of the ground while rocking, over the weight; below 0 it would pull",
        label="smallest normal force / weight",
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
    Quantity("events", "1", "number of impacts, uplifts and changes of contact"),
    Quantity("steps", "1", "number of steps of the engine"),
)
_HISTORY_ON_THE_HULL = (
    Quantity("pose", "1", "number of the stable pose in which it ends; 0 has the lowest centre, -1 there is no result"),
    Quantity("contacts_held", "1", "impacts and changes where no contact obeyed every law, and what touched was held"),
    Quantity("landings_replaced", "1", "impacts in which Housner's law stood in for one without a solution"),
)  # fmt: skip
_SAMPLES = (
    Quantity("time", "s", "time", digits=".6f"),
    Quantity("rotation", "rad", "rotation theta, positive clockwise"),
    Quantity("angular_velocity", "rad/s", "angular velocity"),
    Quantity("displacement", "m", "displacement of the centre of mass to the right, relative to the ground"),
    Quantity("rise", "m", "height of the centre of mass above its place at rest"),
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
    Quantity("azimuth", "rad", "direction in which the body leans, from x towards y"),
    Quantity(
        "contact",
        "1",
        _spelled(_CONTACTS),
        _CONTACTS,
        spelled={contact.name.lower(): contact.value for contact in ContactMode},
    ),
    Quantity("touching", "1", "number of vertices on the ground"),
    Quantity("sliding", "1", "number of vertices that slide on the ground"),
)
_BODY = (
    Quantity("kind", "", "kind of the body, motion or base"),
    Quantity("name", "", "name"),
    Quantity("assumed", "", "assumed values that no input gave, a sentence each"),
    Quantity("warnings", "", "doubts about the input or the result, a sentence each; none if all is well"),
    Quantity("repairs", "", "changes of the mesh, a sentence each"),
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
    Quantity("base_contact", "m", "stretches of the base that touch the ground, from x to x"),
    Quantity("base_centre", "m", "centre x, y of a round base", digits=".5g"),
    Quantity("base_radius", "m", "radius of a round base", digits=".5g"),
    Quantity("gravity", "m/s2", "acceleration of gravity", digits=".6g"),
    Quantity("slenderness_ratio", "1", "slenderness h/b", label="h/b"),
    Quantity("slenderness_angle", "rad", "slenderness angle alpha = atan(b/h)"),
    Quantity("semi_diagonal", "m", "distance R of the centre of mass from the foot", label="R", digits=".5g"),
    Quantity("frequency_parameter", "rad/s", "frequency parameter p", label="p", digits=".5g"),
    Quantity("uplift_acceleration", "m/s2", "ground acceleration at uplift, g tan(alpha)", label="uplift at"),
)
_IMPACT_MODELS = (
    Quantity("impulse_ratio", "1", "distance of the impulse over the lever of the new foot", label="k"),
    Quantity("impulse_position", "m", "x of the impulse on the ground"),
    Quantity("energy_loss", "1", "fraction of the kinetic energy that is lost at the impact", digits=".2%"),
    Quantity("admissible", "1", "1 if one impulse on the base can cause the impact without creating energy, 0 if not"),
    Quantity("energy_ratio", "1", "kinetic energy after over before the impact"),
    Quantity("energy", "J", "energy"),
    Quantity("share", "1", "fraction", digits=".2%"),
    Quantity("ked_energy_shares", "1", "kinetic energy after each stage of KED over the energy before the impact"),
    Quantity("velocity", "m/s", "velocity x, y at points"),
    Quantity("energy_left", "1", "fraction of the energy after an impact on each foot"),
    Quantity("impacts_to_half", "1", "number of impacts that halve the energy"),
    Quantity("bias", "1", "bias: mean of model minus measurement", digits="+.4f"),
    Quantity("within", "1", "whether a value is within the 95 % interval", label="within 95 %"),
    Quantity("rmse", "1", "root mean square error of the coefficient", label="RMSE", digits=".4f"),
    Quantity("loss_rmse", "1", "root mean square error of the energy loss", label="loss", digits=".4f"),
    Quantity("behind_closest", "1", "error beyond that of the closest model: value, low, high"),
    Quantity("measurements", "1", "number of measurements"),
    Quantity("rounding", "1", "half of the last printed digit of the measurements"),
    Quantity("edge_start", "m", "first corner x, y of the edge", label="from", digits=".5g"),
    Quantity("edge_end", "m", "second corner x, y of the edge", label="to", digits=".5g"),
    Quantity("nearest_edge", "m", "distance of the plumb line from the nearest edge of the support polygon"),
    Quantity("barrier", "m", "rise of the centre of mass that leaves the pose", label="energy barrier"),
    Quantity("down", "1", "direction of gravity in axes of the body"),
    Quantity("saddles", "1", "number of saddles: balanced on an edge"),
    Quantity("summits", "1", "number of summits: balanced on a corner"),
    Quantity("stands_in", "1", "number of the pose in which the body stands"),
    Quantity("straight_rise", "m", "rise of the centre of mass if the body is toppled in one direction"),
    Quantity("lowest_rise", "m", "smallest rise of the centre of mass of all ways to topple there"),
    Quantity("topples_into", "1", "number of the pose into which the body topples", label="into pose"),
    Quantity("tolerance", "m", "distance from the ground up to which points touch it", label="within"),
    Quantity("corners", "1", "number of corners of the support polygon"),
    Quantity("edges_left_out", "1", "number of less slender edges, which are not computed"),
)
_STUDIES = (
    Quantity("uplift_ratio", "1", "PGA over that of uplift", label="/ uplift", digits=".6f"),
    Quantity("bracket_width", "m/s2", "width of the bracket of a crossing"),
    Quantity("mode_below", "1", "mode below a crossing", label="below", words=mode_words),
    Quantity("mode_above", "1", "mode above a crossing", label="above", words=mode_words),
    Quantity("minimum_acceleration", "m/s2", "smallest PGA with overturning"),
    Quantity("certain_acceleration", "m/s2", "PGA above which every history overturns"),
    Quantity("overturning_intervals", "m/s2", "intervals of PGA with overturning"),
    Quantity("safe_intervals", "m/s2", "intervals of PGA without overturning above the first with overturning"),
    Quantity("min_pga", "m/s2", "smallest PGA that is computed"),
    Quantity("max_pga", "m/s2", "largest PGA that is computed"),
    Quantity("resolution", "1", "resolution of the samples, over the PGA"),
    Quantity("resolution_below", "1", "resolution below the first crossing"),
    Quantity("failed", "1", "number of histories without a result"),
    Quantity("histories", "1", "number of histories"),
    Quantity("count", "1", "number"),
    Quantity("cells", "1", "number of cells"),
    Quantity("area", "1", "area of an island over that of the map"),
    Quantity("refined_points", "1", "number of points along boundaries"),
    Quantity("only_first", "1", "number of histories that overturn only with the first"),
    Quantity("only_second", "1", "number of histories that overturn only with the second"),
    Quantity("compared", "1", "number of histories that are compared"),
    Quantity("unknown", "1", "number of histories without a result in one of both"),
    Quantity("not_lifted", "1", "number of histories without uplift"),
    Quantity("rocked", "1", "number of histories with rocking and without overturning"),
    Quantity("largest_peak_ratio", "1", "largest peak ratio without overturning", label="peak / alpha"),
    Quantity("largest_overturned_period", "s", "largest 2 pi / p of a block that overturns", label="overturns up to"),
    Quantity("seed", "1", "random seed"),
    Quantity("limit_states", "1", "limit states: peak rotation over the slenderness angle"),
    Quantity("trials", "1", "number of histories at each level"),
    Quantity("reached", "1", "number of histories that reach a state"),
    Quantity("dispersion", "1", "logarithmic standard deviation", digits=".3g"),
    Quantity("dispersion_95", "1", "95 % interval of the dispersion"),
    Quantity("failures", "1", "number of failures"),
    Quantity("observations", "1", "number of observations"),
    Quantity("log_likelihood", "1", "logarithm of the likelihood"),
    Quantity("resurrected_motions", "1", "number of motions with an interval without overturning above overturning"),
    Quantity("resurrected_motions_over_1_percent", "1", "number of these whose interval is wider than 1 %"),
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
    Quantity("sliding_beyond", "m", "sliding distance of which the probability is given"),
    Quantity("per_motion", "1", "probability under each motion", digits="%"),
    Quantity("first", "1", "first-order index of the variance of overturning", label="alone", digits=".2f"),
    Quantity("total", "1", "total index of the variance of overturning", label="with the others", digits=".2f"),
    Quantity("input_low", "1", "mean of the input in the lowest fifth of its samples, in the unit of the input"),
    Quantity("input_high", "1", "mean of the input in the highest fifth of its samples, in the unit of the input"),
    Quantity("probability_low", "1", "probability of overturning there, lowest fifth"),
    Quantity("probability_high", "1", "probability of overturning there, highest fifth"),
    Quantity("pairs", "1", "number of pairs of histories under each motion"),
    Quantity("pairs_rocking", "1", "number of pairs that rock"),
    Quantity("pairs_apart", "1", "number of pairs that end differently, or whose peaks differ by more than 1 %"),
    Quantity("relative_change", "1", "relative change of the peak over that of the motion, median"),
    Quantity("motions", "1", "number of motions"),
    Quantity("record_index", "1", "index of the record of each motion"),
    Quantity("uplift_factors", "1", "scale factor of each motion at uplift", label="uplift factor"),
    Quantity("factors", "1", "smallest scale factor of each motion with overturning, for both polarities"),
    Quantity("min_factor", "1", "smallest scale factor with overturning", label="smallest factor", digits=".3g"),
    Quantity("min_factor_in_plane", "1", "smallest scale factor with overturning of the plane body"),
    Quantity("plane_azimuth", "rad", "direction of the plane body, from x towards y"),
    Quantity("barrier_energy", "J", "energy that topples the body"),
    Quantity("barrier_azimuth", "rad", "direction of the smallest energy barrier, from x towards y"),
    Quantity("code_methods", "1", "scale factor that a code method allows", label="up to factor", digits=".3g"),
    Quantity("margin", "1", "margin that is required"),
    Quantity("tension", "N", "tension of anchors on each edge"),
    Quantity("shear", "N", "shear of anchors"),
    Quantity("no_overturning", "m", "length that prevents overturning"),
    Quantity("no_uplift", "m", "length that prevents uplift"),
    Quantity("isolation_period", "s", "shortest period of isolation"),
    Quantity("isolation_displacement", "m", "displacement of that isolation"),
    Quantity("levels", "1", "levels of the motions"),
    Quantity("safe", "1", "number of histories that are called safe", label="rated safe"),
    Quantity("histories_known", "1", "number of histories with a result"),
    Quantity("limit_ratio", "1", "level over that which the method allows", label="D/C", digits=".3g"),
    Quantity("share_95", "1", "95 % interval of the share"),
    Quantity("median", "1", "median"),
    Quantity("median_95", "1", "95 % interval of the median"),
    Quantity("censored", "1", "number of histories without overturning at any level"),
    Quantity("worse_side_counts", "1", "whether only the worse side is rated"),
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
    Quantity("overturned_share", "1", "fraction of the histories with overturning"),
    Quantity("overturned_interval", "1", "95 % interval of that fraction"),
    Quantity("median_rotation_over_angle", "1", "median of the peak ratio; infinite if it overturns"),
    Quantity("high_rotation_over_angle", "1", "84 % quantile of the peak ratio; infinite if it overturns"),
    Quantity("approximate", "m", "dimensions that are approximate"),
    Quantity("pieces_spared", "1", "number of falls prevented"),
    Quantity("gain", "1", "falls prevented, weighted by the consequence"),
    Quantity("base_wider_each_side", "m", "widening of the base on each side"),
    Quantity("centre_lower", "m", "lowering of the centre of mass"),
    Quantity("ballast", "kg", "ballast at the base"),
    Quantity("anchors_of_one_edge", "N", "tension of the anchors of one edge"),
    Quantity("anchors_of_one_edge_over_weight", "1", "tension of the anchors of one edge over the weight"),
    Quantity("anchors_across_over_weight", "1", "shear of the anchors over the weight"),
    Quantity("moved_to_share_of_shaking", "1", "intensity at another place over that here"),
)
_MOTION = (
    Quantity("support", "", "what moves: the ground, or a floor of a building"),
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
    Quantity("error", "", "why there is no result, in a sentence"),
    Quantity("engine", "", "engine and its options"),
    Quantity("linear", "1", "whether the equations are linearised"),
    Quantity("summary", "", "outcome in a sentence"),
    Quantity("initial_rotation", "rad", "rotation at the start"),
    Quantity("initial_tilt", "rad", "tilt at the start"),
    Quantity("initial_azimuth", "rad", "direction of the tilt at the start, from x towards y"),
    Quantity("start_height", "m", "height of the lowest point above the ground at the start"),
    Quantity("start_velocity", "m/s", "velocity at the start, upwards last"),
    Quantity("friction", "1", "coefficient of friction between body and ground"),
    Quantity("friction_assumed", "1", "whether the coefficient of friction is assumed"),
    Quantity("friction_of_motion", "1", "friction demand while rocking", label="friction while rocking", digits=".3f"),
    Quantity("friction_of_impacts", "1", "friction demand at impacts", label="friction at impacts", digits=".3f"),
    Quantity("normal_restitution", "1", "coefficient of normal restitution"),
    Quantity("normal_restitution_law", "", "law of the coefficient of normal restitution"),
    Quantity("uplift_times", "s", "times of the uplifts from rest"),
    Quantity(
        "energy_closure", "1", "energy balance error over the largest energy", label="energy balance error",
        digits=".1e",
    ),
    Quantity(
        "error_estimate", "rad", "largest change of the rotation if every step is halved; infinite if the outcome "
        "changes", label="numerical error", digits=".1e",
    ),
    Quantity("overturned_over", "", "edge, vertex or rim over which the body overturned"),
    Quantity("unfinished", "", "how the body moves when the computation ends, in a sentence"),
    Quantity("ends_early", "1", "whether the computation ends before the body rests, since impacts lose no energy"),
    Quantity("quaternion", "1", "attitude: unit quaternion (s, x, y, z)"),
    Quantity("ground_displacement", "m", "displacement of the ground"),
    Quantity("history", "1", "number of the history"),
    Quantity("difference", "rad", "difference of peak rotations"),
    Quantity("lying", "rad", "rotation of a body that lies on its left and on its right side"),
    Quantity("samples", "1", "number of samples"),
    Quantity("samples_shown", "1", "number of samples in the answer"),
)  # fmt: skip
_IMPACTS_AND_INTERVALS = (
    Quantity("velocity_before", "rad/s", "angular velocity before the impact", digits="+.6f"),
    Quantity("velocity_after", "rad/s", "angular velocity after the impact", digits="+.6f"),
    Quantity("coefficient", "1", "coefficient of restitution, a ratio of velocities", label="r", digits=".4f"),
    Quantity("foot", "1", "foot landed on: 1 right, -1 left", _SIDES),
    *(Quantity(f"normal_{foot}", "N s", f"vertical impulse on the {foot} foot") for foot in ("left", "right")),
    *(Quantity(f"tangential_{foot}", "N s", f"horizontal impulse on the {foot} foot") for foot in ("left", "right")),
    Quantity("energy_before", "J", "kinetic energy before the impact"),
    Quantity("energy_after", "J", "kinetic energy after the impact"),
    Quantity("impulse", "N s", "vertical impulse of the impact"),
    Quantity("pull", "N s", "part of the impulse with which the ground would have to pull"),
    Quantity("slips", "1", "whether the feet slid in the impact: 1 yes, 0 no", label="feet slide"),
    Quantity("feet", "", "feet that touch the ground"),
    Quantity("slip", "1", "direction in which the feet slide: 1 right, -1 left, 0 they stick"),
    Quantity("vertices", "", "numbers of the vertices on the ground"),
    Quantity("sliding_vertices", "", "numbers of the vertices that slide on the ground", label="sliding"),
    Quantity("start", "s", "start of the interval", label="from", digits=".6f"),
    Quantity("end", "s", "end of the interval", label="to", digits=".6f"),
    Quantity("distance", "m", "path of the feet along the ground in the interval", label="sliding distance"),
)
_IDENTIFICATION = (
    Quantity("no_scatter", "1", "probability that the coefficient does not scatter", digits=".3g"),
    Quantity("trend", "1", "slope of the logarithm of the coefficient over that of the speed"),
    Quantity("independent", "1", "number of independent measured values"),
    Quantity("advantage", "1", "logarithm of the likelihood over that of times with a constant mean interval"),
    Quantity("residual_times", "s", "times of the residuals"),
    Quantity("number", "1", "number of the impact, from zero", label="no."),
    Quantity("speed", "rad/s", "angular velocity before the impact, without sign"),
    Quantity("release_ratio", "1", "initial rotation over the slenderness angle", digits="g"),
    Quantity("timing_noise", "s", "standard deviation of a measured time", digits=".2g"),
    Quantity("deviation", "1", "standard deviation of the mean coefficient", digits=".2g"),
    Quantity("clock", "s", "lead of the clock of the measurement over that of the motion"),
    Quantity("gain", "1", "measured over true rotation"),
    Quantity("stretches", "1", "number of measured states at which half cycles begin anew"),
    Quantity("half_cycles_left_out", "1", "number of half cycles that rocking alone does not explain"),
    Quantity("used", "s", "duration of the half cycles that are used"),
    Quantity("measured", "s", "duration of the measurement"),
    Quantity("predictable", "s", "time up to which the rotation can be predicted from rest"),
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
    Quantity("ahead_of_ked", "1", "error of KED beyond that of the model: value, low, high"),
    Quantity("fitted", "1", "fitted parameters of a model"),
    Quantity("shares", "1", "shares of the scatter"),
    Quantity("inside", "1", "number of measurements within their intervals"),
    Quantity("interval_width", "1", "mean width of the intervals", digits=".3f"),
    Quantity("covered", "1", "number of measurements within their intervals, and of all"),
    Quantity("printed", "1", "values that the paper prints"),
    Quantity("recomputed", "1", "values that are recomputed"),
)
_CAMPAIGN = (
    Quantity("histories_done", "1", "number of histories that are recorded"),
    Quantity("all_histories", "1", "number of histories of all rounds"),
    Quantity("verified", "1", "number of histories that were read and are what was written"),
    Quantity("missing", "1", "first and last number of histories that are missing"),
    Quantity("later", "1", "usual range of the number of histories of later rounds"),
    Quantity("chunk", "1", "number of histories of a chunk"),
    Quantity("chunks", "1", "number of chunks"),
    *(Quantity(f"{done}_chunks", "1", f"number of chunks {done}") for done in ("computed", "resumed", "adopted")),
    Quantity("chunks_done", "1", "number of chunks that are recorded"),
    Quantity("rounds", "1", "number of rounds"),
    Quantity("rounds_begun", "1", "number of rounds that have begun"),
    Quantity("retried", "1", "number of chunks that were computed again"),
    Quantity("worker_seconds", "s", "computing time of all workers"),
    Quantity("run_seconds", "s", "duration of the run"),
    Quantity("seconds", "s", "estimated duration"),
    Quantity("between", "s", "range of the estimated duration"),
    Quantity("rate", "1/s", "histories per second of one worker"),
    *(Quantity(name, "B", f"{name} that is needed") for name in ("memory", "disk")),
    Quantity("free", "B", "disk that is free"),
    Quantity("bytes", "B", "size of the file"),
)
QUANTITIES: dict[str, Quantity] = {
    each.name: each
    for each in (
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
        *_SAMPLES,
        *_IMPACTS_AND_INTERVALS,
    )
}
"""All of them, by name."""


def closely(**digits: str) -> dict[str, Quantity]:
    """Return quantities with other digits for readers, for an answer that states them more closely.

    >>> closely(time=".2f")["time"].digits
    '.2f'
    """
    return {name: replace(QUANTITIES[name], digits=each) for name, each in digits.items()}


# what answers have besides: parts, sentences, labels, and numbers whose quantity is of their answer alone
_PARTS = """
    adjusted advice all all_bodies analysis answer answers assumptions base base_tolerances better_by bodies body
    by_data_set called_safe claim claims code_methods_outside coefficients columns_not_read comparison comparisons
    components concerns converged crossing_curves crossings curves decides definition designs died directions doubts
    edges ends envelope errata event evidence examples facets file file_unit files finding first_corner folder forced
    from growth hazard hierarchy identities ignored im im_description inputs intensity interfaces intervals inventory
    islands judged_by label laboratories language last_state league left_out_groups level likelihood likelihood_scale
    lowest lowest_uplift mean messages method methods mirrored models motion motions_apart new not_assessed
    not_objects not_read not_sampled note notes objects one_by_one outside overturning passed_over passes plan
    plane_is_weakest poses prediction progress reason reasons records refused reliability remedies resolved
    restitution_drawn results rigid rings scores section sensitivity sentence sentences sets sides slow software solid
    source sources spacing spectrum stable stages standing starts_overturned stated stored tables target
    target_spectrum test text threads title to too_sure traces unit uplift_threshold values varied verdict whole
    vertical_component with_friction words x y
"""
PARTS = frozenset(_PARTS.split())


def is_named(key: str) -> bool:
    """Return whether a key of an answer is a quantity or a part."""
    return key in PARTS or quantity(key) is not None


TIMES = tuple(each.name for each in _HISTORY if each.unit == "s")
"""Those of a history that are times, which a motion that is stretched stretches."""
HISTORY = tuple(each.name for each in _HISTORY if not each.name.startswith("twin"))
"""What is known of every history of a study in the plane, in the order of its tables."""
