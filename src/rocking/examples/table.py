"""The one table of examples: what each is, its files, the commands that show it, and motions to try things with."""

import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

from rocking.conventions import g
from rocking.errors import InvalidValueError
from rocking.motions.filters import highpassed
from rocking.motions.motion import GroundMotion
from rocking.motions.processing import scaled_to
from rocking.motions.pulses import mavroeidis_papageorgiou, ricker
from rocking.motions.synthetic import (
    Envelope,
    KanaiTajimi,
    NonstationaryFilter,
    PointSource,
    kanai_tajimi_motion,
    modulation_from_intensity,
    nonstationary_motion,
    point_source_motion,
    with_pulse,
)

FILTERED = "modulated filtered white noise (Rezaeian & Der Kiureghian 2008)"


def near_fault(seed: int) -> GroundMotion:
    """Return one pulse of velocity, 0.9 m/s in 1.2 s, within shaking of higher frequencies."""
    pulse = mavroeidis_papageorgiou(velocity=0.9, period=1.2, cycles=1.5, phase=0.5)
    return with_pulse(_shaking(seed, length=9.0, frequency=5.0, corner=1.0 / 1.2), pulse, arrival=5.0)


def far_field(seed: int) -> GroundMotion:
    """Return magnitude 6.8 at 40 km, scaled to 0.35 g."""
    return _to(0.35, point_source_motion(PointSource(magnitude=6.8, distance=40e3), seed=seed))


def long(seed: int) -> GroundMotion:
    """Return a minute of strong shaking, scaled to 0.35 g."""
    return _to(0.35, _shaking(seed, length=60.0, frequency=3.0, corner=0.1))


def soft_soil(seed: int) -> GroundMotion:
    """Return a layer that swings at 0.8 Hz, scaled to 0.35 g."""
    layer, envelope = KanaiTajimi(0.01, frequency=0.8, damping=0.25), Envelope(3.0, 12.0, 0.25)
    raw = kanai_tajimi_motion(layer, envelope, seed=seed, time_step=0.02, duration=45.0)
    what = "high-passed by a critically damped oscillator of 0.1 Hz"
    return _to(0.35, raw.changed(what, acceleration=highpassed(raw.acceleration, raw.time_step, 0.1)))


def three_components(seed: int) -> dict[str, GroundMotion]:
    """Return x and y alike, 0.4 g and 0.35 g, and z of higher frequency, 0.2 g."""
    # no seed shares a component with another
    parts = {"x": (0.4, 3.0), "y": (0.35, 3.0), "z": (0.2, 8.0)}
    return {
        axis: _to(peak, _shaking(3 * seed + k, length=12.0, frequency=frequency, corner=0.15))
        for k, (axis, (peak, frequency)) in enumerate(parts.items())
    }


def pulse() -> GroundMotion:
    """Return 0.5 g at the middle of 1 s, nothing else."""
    return ricker(amplitude=0.5 * g, period=1.0).sampled(0.005)


def _shaking(seed: int, length: float, frequency: float, corner: float) -> GroundMotion:
    """Return filtered noise; length: significant duration [s]; frequency: at its middle, corner: of a filter [Hz]."""
    middle = 0.6 * length
    modulation = modulation_from_intensity(1.0, length, middle)
    shaper = NonstationaryFilter(frequency, slope=-0.3 * frequency / length, middle=middle, damping=0.3)
    duration = round(modulation.time_of(0.999) + 2.0 / corner, 1)
    return nonstationary_motion(modulation, shaper, seed=seed, duration=duration, corner=corner)


def _to(share: float, motion: GroundMotion) -> GroundMotion:
    return scaled_to(motion, "pga", share * g)


Kind = Literal["body", "motion", "list", "question", "job"]


@dataclass(frozen=True)
class Example:
    """One example of the package, invented for illustration but for bodies whose file names the source of their size.

    Parameters
    ----------
    name : str
        By which it is asked for.
    kind : {"body", "motion", "list", "question", "job"}
        A body, a ground motion, a list of objects, a question of one response, or a job of many.
    title : str
        What it is, on one line.
    commands : tuple of str
        What to type in a folder with its files, to see it.
    files : tuple of str
        Its files within the package, that of the example itself first; a motion is computed and has none.
    records : tuple of str
        Names of the motions whose records the commands need too.
    options : mapping
        What `read_body` is told beside the file, where that does not state it.
    make : callable, optional
        What makes a motion; takes the seed, or nothing.
    model : str
        By which model a motion is made, with its source.
    seed : int, optional
        Seed of a motion unless asked otherwise; None for one without chance.
    """

    name: str
    kind: Kind
    title: str
    commands: tuple[str, ...]
    files: tuple[str, ...] = ()
    records: tuple[str, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    make: Callable[..., Any] | None = None
    model: str = ""
    seed: int | None = None

    @property
    def writes(self) -> tuple[str, ...]:
        """Its files, and records of its motions, as they are called in a folder of the user."""
        return (*(file.rpartition("/")[2] for file in self.files), *(f"{name}.csv" for name in self.records))

    @property
    def outputs(self) -> tuple[str, ...]:
        """Files and folders that the commands write."""
        words = [word for command in self.commands for word in shlex.split(command)]
        return tuple(after for word, after in pairwise(words) if word == "--output")


def _body(
    name: str, shaking: str, title: str, *, options: Mapping[str, Any] | None = None, ending: str = "toml"
) -> Example:
    """Return a body; shaking: what stands behind it in `rocking simulate`."""
    file, options = f"{name}.{ending}", options or {}
    stated = "".join(f" --{key} {value}" for key, value in options.items())
    commands = f"rocking restitution {file}{stated}", f"rocking simulate {file} {shaking}{stated} --output {name}.png"
    records = tuple(each for each in _MOTIONS if f"{each}.csv" in shaking)
    return Example(name, "body", title, commands, (f"bodies/{file}",), records, options)


def _motion(name: str, make: Callable[..., Any], model: str, title: str, seed: int | None = 1) -> Example:
    commands = (f"rocking record show {name}.csv --output {name}.png",)
    return Example(name, "motion", title, commands, records=(name,), make=make, model=model, seed=seed)


def _question(name: str, title: str) -> Example:
    return Example(
        name, "question", title, (f"rocking simulate {name}.toml --output {name}.png",), (f"questions/{name}.toml",)
    )


def _job(name: str, command: str, title: str) -> Example:
    return Example(name, "job", title, (f"rocking {command} {name}.toml --output {name}.png",), (f"jobs/{name}.toml",))


def _campaign(name: str, ending: str, title: str) -> Example:
    """Return a job of several bodies or restitutions, which takes a folder of its own; ending: of what is exported."""
    commands = (
        f"rocking campaign run {name}.toml --output {name}",
        f"rocking campaign export {name} --output {name}.{ending}",
    )
    return Example(name, "job", title, commands, (f"jobs/{name}.toml",))


_AXES = " ".join(f"--motion {axis}=three-components.csv#{axis}" for axis in "xyz")
_MOTIONS = {
    each.name: each
    for each in (
        _motion(
            "near-fault",
            near_fault,
            f"pulse of Mavroeidis & Papageorgiou (2003) on {FILTERED}",
            "one long pulse of velocity, 0.9 m/s in 1.2 s, within ordinary shaking",
        ),
        _motion(
            "far-field",
            far_field,
            "stochastic point source (Boore 2003)",
            "as of magnitude 6.8 at 40 km on firm ground, scaled to 0.35 g",
        ),
        _motion("long", long, FILTERED, "a minute of strong shaking, scaled to 0.35 g"),
        _motion(
            "soft-soil",
            soft_soil,
            "layer of soil on white noise (Kanai 1957, Tajimi 1960)",
            "a soft layer that swings at 0.8 Hz, scaled to 0.35 g",
        ),
        Example(
            "three-components",
            "motion",
            "motions along x, y and z, scaled to 0.4 g, 0.35 g and 0.2 g upwards",
            (
                "rocking record show x=three-components.csv#x z=three-components.csv#z --output three-components.png",
                "rocking record show three-components.csv#y",
            ),
            records=("three-components",),
            make=three_components,
            model=FILTERED,
            seed=1,
        ),
        _motion("pulse", pulse, "Ricker wavelet", "a symmetric Ricker wavelet of 0.5 g and 1 s alone", None),
    )
}

_ALL = (
    _body(
        "statue",
        "near-fault.csv",
        "a marble figure that leans on a pedestal of brick with its feet set in, 2.55 m high",
    ),
    _body("stele", "far-field.csv", "a tapered stele of limestone that leans to the right, 2.35 m high"),
    _body("pier", "near-fault.csv --scale 1.3", "a masonry pier with a shaft left of its middle, 7.5 m high"),
    _body(
        "cabinet",
        "soft-soil.csv --scale 1.2",
        "a cabinet whose equipment stands on its left, 2.1 m high; in WKT, without a unit",
        options={"units": "mm", "density": 300},
        ending="wkt",
    ),
    _body(
        "transformer",
        "near-fault.csv --scale 1.5",
        "a power transformer: tank, radiators, conservator, bushings; 4.1 m high",
    ),
    _body(
        "rack",
        "near-fault.csv --scale 1.5",
        "a rack of instruments as seven masses, the heaviest low on the left; 1.85 m high",
    ),
    _body("bust", _AXES, "in space: a marble bust of typical proportions on a pedestal, 1.78 m high"),
    _body("column", "pulse.csv", "in space: three marble drums off their axis as one body on a round base, 2.7 m high"),
    _body("showcase", "soft-soil.csv --scale 1.2", "a showcase by its size, weight and centre of mass, 1.95 m high"),
    _body("bookshelf", "far-field.csv", "a full bookshelf across its depth, by its centre of mass, 2.02 m high"),
    _body("cask", "x=near-fault.csv", "in space: a loaded transport cask that stands upright, 5.075 m high"),
    _body("drum", "pulse.csv", "in space: the lowest drum of a Doric column alone, 0.95 m high"),
    _body("gravestone", _AXES, "in space: a gravestone of granite on its base, 1.2192 m high"),
    _body("barrel", "near-fault.csv --scale 1.8", "in space: a full barrel of wine on its end, 0.945 m high"),
    *_MOTIONS.values(),
    Example(
        "objects",
        "list",
        "ten objects of a museum, in centimetres and kilograms",
        ("rocking inventory objects.csv --pga 0.3g --count 80 --output objects.html",),
        ("jobs/objects.csv",),
    ),
    Example(
        "liste",
        "list",
        "a list to fill in, in German; any spreadsheet opens it",
        ("rocking inventory liste.csv --pga 0.3g --count 80 --output liste.html",),
        ("jobs/liste.csv",),
    ),
    _question("block-under-a-pulse", "a cabinet under one sine, where the model of the impact decides"),
    _question("statue-let-go", "a statue that stands off its middle, let go to the left"),
    Example(
        "block-heard",
        "question",
        "when a block that was let go was heard, and what that says of its coefficient",
        ("rocking identify block-heard.toml --output block-heard.png",),
        ("questions/block-heard.toml", "questions/block-heard.csv"),
    ),
    _job("overturning-map", "map", "which sine pulses overturn a block, and how: 60 x 60 pulses"),
    _campaign("refined-map", "png", "the same, refined along the boundaries, which come as polylines"),
    _campaign("minimum-acceleration", "png", "every amplitude at which motions begin or cease to overturn two blocks"),
    _campaign("rocking-spectrum", "png", "how far blocks of all sizes rock on soft ground, under two models"),
    _job("stripes", "fragility", "how likely a column is to rock and to overturn at twelve levels"),
    _job("cloud", "fragility", "what peak ground velocity says about a statue under motions as they are"),
    _job("incremental", "fragility", "levels at which pulses overturn a block, and those at which it stands again"),
    Example(
        "inventory",
        "job",
        "which objects of a list stay standing in eighty motions of 0.3 g",
        ("rocking inventory inventory.toml --output inventory.html",),
        ("jobs/inventory.toml", "jobs/objects.csv"),
    ),
    _campaign("histories", "csv", "two blocks, two pulses, fifty scales, coefficients drawn anew at every impact"),
)

EXAMPLES: dict[str, Example] = {each.name: each for each in _ALL}
"""Every example by name: a new one is one entry here, and its files."""


HERE = Path(__file__).parent  # where the files of examples are, within the package


def record_text(motions: Mapping[str, GroundMotion]) -> str:
    """Return columns that `read_motion` reads back to the last bit, below what the motion is.

    >>> print(record_text({"x": GroundMotion([0.0, 0.1], 0.02, metadata={"seed": "1"})}))
    # seed: 1
    time [s],x [m/s2]
    0,0.0
    0.02,0.1
    <BLANKLINE>
    """
    parts = list(motions.values())
    lines = [f"# {key}: {value}" for key, value in parts[0].metadata.items()]
    lines.append(",".join(["time [s]", *(f"{name} [m/s2]" for name in motions)]))
    rows = zip(*(part.acceleration.tolist() for part in parts), strict=True)
    lines += [",".join([f"{k * parts[0].time_step:.9g}", *map(repr, row)]) for k, row in enumerate(rows)]
    return "\n".join([*lines, ""])


def contents(example: Example, motions: Mapping[str, Mapping[str, GroundMotion]]) -> dict[str, bytes]:
    """Return what stands in the files of an example; motions: by the names of its records."""
    own = {Path(file).name: (HERE / file).read_bytes() for file in example.files}
    return own | {f"{name}.csv": record_text(parts).encode() for name, parts in motions.items()}


def written(files: Mapping[str, bytes], folder: Path, *, force: bool) -> list[Path]:
    """Write files into a folder and return them; a file that holds something else is refused, before any is written."""
    paths = {folder / name: content for name, content in files.items()}
    if not folder.is_dir():
        raise InvalidValueError(
            "no folder {folder!r} to write {files} into", folder=str(folder), files=", ".join(files)
        )
    if folders := [str(path) for path in paths if path.is_dir()]:
        raise InvalidValueError(
            "{folders}: a folder of that name is there already", folders=", ".join(folders), hint="take another folder"
        )
    if not force and (odd := [path for path, content in paths.items() if holds_another(path, content)]):
        raise InvalidValueError(
            "{files}: there already, with something else in it", files=", ".join(map(str, odd)),
            hint="take another folder, or write over it with force",
        )  # fmt: skip
    for path, content in paths.items():
        path.write_bytes(content)
    return list(paths)


def holds_another(path: Path, content: bytes) -> bool:
    """Return whether there is something of that name that is not what would be written."""
    return path.exists() and path.read_bytes() != content
