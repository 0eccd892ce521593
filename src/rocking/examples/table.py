"""Table of all examples: title, files and commands of each, and the example motions."""

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
    """Return a velocity pulse, 0.9 m/s in 1.2 s, with a residual of higher frequencies."""
    pulse = mavroeidis_papageorgiou(velocity=0.9, period=1.2, cycles=1.5, phase=0.5)
    return with_pulse(_shaking(seed, length=9.0, frequency=5.0, corner=1.0 / 1.2), pulse, arrival=5.0)


def far_field(seed: int) -> GroundMotion:
    """Return a motion of magnitude 6.8 at 40 km, scaled to 0.35 g."""
    return _scaled_to_pga(0.35, point_source_motion(PointSource(magnitude=6.8, distance=40e3), seed=seed))


def long(seed: int) -> GroundMotion:
    """Return a motion of one minute, scaled to 0.35 g."""
    return _scaled_to_pga(0.35, _shaking(seed, length=60.0, frequency=3.0, corner=0.1))


def soft_soil(seed: int) -> GroundMotion:
    """Return a motion of a soft layer of 0.8 Hz, scaled to 0.35 g."""
    layer, envelope = KanaiTajimi(0.01, frequency=0.8, damping=0.25), Envelope(3.0, 12.0, 0.25)
    raw = kanai_tajimi_motion(layer, envelope, seed=seed, time_step=0.02, duration=45.0)
    action = "high-passed by a critically damped oscillator of 0.1 Hz"
    return _scaled_to_pga(0.35, raw.changed(action, acceleration=highpassed(raw.acceleration, raw.time_step, 0.1)))


def three_components(seed: int) -> dict[str, GroundMotion]:
    """Return similar motions along x and y, 0.4 g and 0.35 g, and z of higher frequency, 0.2 g."""
    # different seeds give different components
    components = {"x": (0.4, 3.0), "y": (0.35, 3.0), "z": (0.2, 8.0)}
    return {
        axis: _scaled_to_pga(peak, _shaking(3 * seed + k, length=12.0, frequency=frequency, corner=0.15))
        for k, (axis, (peak, frequency)) in enumerate(components.items())
    }


def pulse() -> GroundMotion:
    """Return a Ricker wavelet of 0.5 g and 1 s."""
    return ricker(amplitude=0.5 * g, period=1.0).sampled(0.005)


def _shaking(seed: int, length: float, frequency: float, corner: float) -> GroundMotion:
    """Return filtered noise with a significant duration [s], a frequency in the middle and a corner frequency [Hz]."""
    middle = 0.6 * length
    modulation = modulation_from_intensity(1.0, length, middle)
    shaper = NonstationaryFilter(frequency, slope=-0.3 * frequency / length, middle=middle, damping=0.3)
    duration = round(modulation.time_of(0.999) + 2.0 / corner, 1)
    return nonstationary_motion(modulation, shaper, seed=seed, duration=duration, corner=corner)


def _scaled_to_pga(peak: float, motion: GroundMotion) -> GroundMotion:
    return scaled_to(motion, "pga", peak * g)


Kind = Literal["body", "motion", "list", "input", "job"]


@dataclass(frozen=True)
class Example:
    """A built-in example. All examples are invented, except bodies whose file states the source of the dimensions.

    Parameters
    ----------
    name : str
        Name of the example.
    kind : {"body", "motion", "list", "input", "job"}
        A body, a ground motion, a list of objects, an input file of one response, or a job of many.
    title : str
        Description in one line.
    commands : tuple of str
        Commands to run in a folder with the files.
    files : tuple of str
        Files in the package, the main file first; motions have no files.
    records : tuple of str
        Names of the motions for records that the commands require.
    options : mapping
        Options of `read_body` for facts that are not in the file.
    make : callable, optional
        Function that returns the motion, of the seed or without arguments.
    model : str
        Model of the motion, with its source.
    seed : int, optional
        Default seed of a motion; None for a deterministic motion.
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
        """Names of the files and records in the output folder."""
        return (*(file.rpartition("/")[2] for file in self.files), *(f"{name}.csv" for name in self.records))

    @property
    def outputs(self) -> tuple[str, ...]:
        """Files and folders written by the commands."""
        arguments = [word for command in self.commands for word in shlex.split(command)]
        return tuple(after for word, after in pairwise(arguments) if word == "--output")


def _body(
    name: str, shaking: str, title: str, *, options: Mapping[str, Any] | None = None, ending: str = "toml"
) -> Example:
    """Return a body example; `shaking` contains arguments of `rocking simulate` after the body."""
    file, options = f"{name}.{ending}", options or {}
    stated = "".join(f" --{key} {value}" for key, value in options.items())
    commands = f"rocking restitution {file}{stated}", f"rocking simulate {file} {shaking}{stated} --output {name}.png"
    records = tuple(motion for motion in _MOTIONS if f"{motion}.csv" in shaking)
    return Example(name, "body", title, commands, (f"bodies/{file}",), records, options)


def _motion(name: str, make: Callable[..., Any], model: str, title: str, seed: int | None = 1) -> Example:
    commands = (f"rocking record show {name}.csv --output {name}.png",)
    return Example(name, "motion", title, commands, records=(name,), make=make, model=model, seed=seed)


def _input(name: str, title: str) -> Example:
    return Example(
        name, "input", title, (f"rocking simulate {name}.toml --output {name}.png",), (f"questions/{name}.toml",)
    )


def _job(name: str, command: str, title: str) -> Example:
    return Example(name, "job", title, (f"rocking {command} {name}.toml --output {name}.png",), (f"jobs/{name}.toml",))


def _campaign(name: str, ending: str, title: str) -> Example:
    """Return a job of several bodies or models with its own folder; `ending` is the extension of the export."""
    commands = (
        f"rocking campaign run {name}.toml --output {name}",
        f"rocking campaign export {name} --output {name}.{ending}",
    )
    return Example(name, "job", title, commands, (f"jobs/{name}.toml",))


_AXES = " ".join(f"--motion {axis}=three-components.csv#{axis}" for axis in "xyz")
_MOTIONS = {
    motion.name: motion
    for motion in (
        _motion(
            "near-fault",
            near_fault,
            f"pulse of Mavroeidis & Papageorgiou (2003) on {FILTERED}",
            "a long velocity pulse, 0.9 m/s in 1.2 s, in an ordinary motion",
        ),
        _motion(
            "far-field",
            far_field,
            "stochastic point source (Boore 2003)",
            "magnitude 6.8 at 40 km on firm ground, scaled to 0.35 g",
        ),
        _motion("long", long, FILTERED, "one minute of strong motion, scaled to 0.35 g"),
        _motion(
            "soft-soil",
            soft_soil,
            "layer of soil on white noise (Kanai 1957, Tajimi 1960)",
            "a soft layer of 0.8 Hz, scaled to 0.35 g",
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
        _motion("pulse", pulse, "Ricker wavelet", "a symmetric Ricker wavelet of 0.5 g and 1 s", None),
    )
}

_ALL = (
    _body(
        "statue",
        "near-fault.csv",
        "a marble figure with eccentric centre of mass on a brick pedestal, 2.55 m high",
    ),
    _body("stele", "far-field.csv", "a tapered limestone stele inclined to the right, 2.35 m high"),
    _body("pier", "near-fault.csv --scale 1.3", "a masonry pier with a shaft left of its middle, 7.5 m high"),
    _body(
        "cabinet",
        "soft-soil.csv --scale 1.2",
        "a cabinet with equipment on its left, 2.1 m high; WKT file without units",
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
        "an instrument rack as seven masses, the heaviest low on the left; 1.85 m high",
    ),
    _body("bust", _AXES, "3D: a marble bust of typical proportions on a pedestal, 1.78 m high"),
    _body("column", "pulse.csv", "3D: three eccentric marble drums as one body on a round base, 2.7 m high"),
    _body("showcase", "soft-soil.csv --scale 1.2", "a showcase by its size, weight and centre of mass, 1.95 m high"),
    _body("bookshelf", "far-field.csv", "a full bookshelf across its depth, by its centre of mass, 2.02 m high"),
    _body("cask", "x=near-fault.csv --scale 1.2", "3D: a loaded upright transport cask, 5.075 m high"),
    _body("drum", "pulse.csv", "3D: the lowest drum of a Doric column, 0.95 m high"),
    _body("gravestone", _AXES, "3D: a gravestone of granite on its base, 1.2192 m high"),
    _body("barrel", "near-fault.csv --scale 1.8", "3D: a full barrel of wine on its end, 0.945 m high"),
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
        "a German list form for spreadsheets",
        ("rocking inventory liste.csv --pga 0.3g --count 80 --output liste.html",),
        ("jobs/liste.csv",),
    ),
    _input("block-under-a-pulse", "a cabinet under a sine pulse; the result depends on the restitution model"),
    _input("statue-released", "a statue with eccentric centre of mass, free rocking from the left"),
    Example(
        "block-sound",
        "input",
        "impact times of a freely rocking block from sound, and its coefficient of restitution",
        ("rocking identify block-sound.toml --output block-sound.png",),
        ("questions/block-sound.toml", "questions/block-sound.csv"),
    ),
    _job("overturning-map", "map", "overturning map of a block under 60 x 60 sine pulses"),
    _campaign("refined-map", "png", "the same map with refined boundaries as polylines"),
    _campaign("minimum-acceleration", "png", "every PGA interval with overturning of two blocks"),
    _campaign("rocking-spectrum", "png", "rocking spectrum on soft ground for two restitution models"),
    _job("stripes", "fragility", "fragility of a column for rocking and overturning at 12 intensity levels"),
    _job("cloud", "fragility", "cloud analysis of a statue with PGV and unscaled motions"),
    _job("incremental", "fragility", "incremental dynamic analysis of a block with resurrections"),
    Example(
        "inventory",
        "job",
        "risk of the objects of a list under 80 motions of 0.3 g",
        ("rocking inventory inventory.toml --output inventory.html",),
        ("jobs/inventory.toml", "jobs/objects.csv"),
    ),
    _campaign("histories", "csv", "two blocks, two pulses, 50 scale factors, a random coefficient at every impact"),
)

EXAMPLES: dict[str, Example] = {example.name: example for example in _ALL}
"""All examples by name."""


HERE = Path(__file__).parent  # folder of the example files in the package


def record_text(motions: Mapping[str, GroundMotion]) -> str:
    """Return the metadata of motions as comments and their columns with all digits, for `read_motion`.

    >>> print(record_text({"x": GroundMotion([0.0, 0.1], 0.02, metadata={"seed": "1"})}))
    # seed: 1
    time [s],x [m/s2]
    0,0.0
    0.02,0.1
    <BLANKLINE>
    """
    components = list(motions.values())
    lines = [f"# {key}: {value}" for key, value in components[0].metadata.items()]
    lines.append(",".join(["time [s]", *(f"{name} [m/s2]" for name in motions)]))
    rows = zip(*(component.acceleration.tolist() for component in components), strict=True)
    lines += [",".join([f"{k * components[0].time_step:.9g}", *map(repr, row)]) for k, row in enumerate(rows)]
    return "\n".join([*lines, ""])


def contents(example: Example, motions: Mapping[str, Mapping[str, GroundMotion]]) -> dict[str, bytes]:
    """Return the contents of the files of an example by name; `motions` contains motions by the names of records."""
    own = {Path(file).name: (HERE / file).read_bytes() for file in example.files}
    return own | {f"{name}.csv": record_text(components).encode() for name, components in motions.items()}


def written(files: Mapping[str, bytes], folder: Path, *, force: bool) -> list[Path]:
    """Write files into a folder and return their paths; raise an error if a file with other content exists."""
    paths = {folder / name: content for name, content in files.items()}
    if not folder.is_dir():
        raise InvalidValueError("no folder {folder!r} for {files}", folder=str(folder), files=", ".join(files))
    if folders := [str(path) for path in paths if path.is_dir()]:
        raise InvalidValueError(
            "{folders}: a folder with this name exists", folders=", ".join(folders), hint="use another folder"
        )
    if not force and (changed := [path for path, content in paths.items() if holds_another(path, content)]):
        raise InvalidValueError(
            "{files} already exists with other content", files=", ".join(map(str, changed)),
            hint="use another folder, or replace the file with force",
        )  # fmt: skip
    for path, content in paths.items():
        path.write_bytes(content)
    return list(paths)


def holds_another(path: Path, content: bytes) -> bool:
    """Return True if the path exists with other content."""
    return path.exists() and path.read_bytes() != content
