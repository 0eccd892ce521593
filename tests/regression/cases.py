"""What is asked: Python, commands, examples, campaigns and the application, with bodies that are not symmetric."""

import json
import shutil
import subprocess
import sys
import time
import tomllib
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import doors
import numpy as np
import trees

import rocking as rk
from rocking import conventions

ROOT = Path(__file__).parents[2]
Case = Callable[[Path], Any]

STEP = 0.015625
STATUE = rk.Section([rk.Region([(-0.45, 0.0), (0.55, 0.0), (0.4, 2.5), (-0.15, 2.2)], density=2400.0)])
PIER = rk.Section(
    [rk.Region([(0, 0), (2.4, 0), (2.1, 7.5), (0.3, 7.0)], 1900.0, holes=[[(0.8, 1.2), (1.6, 1.2), (1.4, 6.0)]])],
    feet=(0.1, 2.2),
)
BLOCK = rk.Block(width=0.5, height=2.0)
POINTS = rk.MassPoints([(0, 1), (1, 1), (0.5, 4)], [1.0, 2.0, 3.0], feet=(0.0, 1.0))
BODIES = {"block": BLOCK, "statue": STATUE, "pier": PIER, "points": POINTS}
CORNERS = np.array([[-0.4, -0.3], [0.3, -0.35], [0.45, 0.15], [0.1, 0.4], [-0.35, 0.25]])
SOLID = rk.Solid([
    rk.bodies.Part(rk.bodies.solid.extrusion(CORNERS, 1.4), 2400.0),
    rk.bodies.Part(rk.bodies.solid.frustum(0.4, 0.2, 0.9), 1800.0).moved(0.05, -0.03, 1.4),
])  # fmt: skip
PULSE = "sine:amplitude=3.2,period=0.8"


def noise(factor: int, size: float, count: int = 600) -> rk.GroundMotion:
    """Return a motion made of whole numbers: every processor has it to the last bit."""
    number = np.arange(count)
    walk = (number * number * factor + 11 * number) % 101 - 50
    slow = (number * factor // 7) % 41 - 20
    phase, bump = number % 57, np.maximum(0, 200 * 200 - (number - 200) ** 2)
    wave = np.where(phase < 29, 1, -1) * (phase % 29) * (29 - phase % 29) * bump  # arches, largest at sample 200
    return rk.GroundMotion(size * (walk / 4.0 + slow + wave / 2.0**17) / 64.0, STEP, name=f"noise {factor}")


def both(factor: int, size: float) -> rk.GroundMotion:
    """Return a motion with a vertical part."""
    return rk.GroundMotion(noise(factor, size).acceleration, STEP, noise(factor + 54, 0.6 * size).acceleration)


MOTIONS = {"horizontal": noise(37, 4.0), "both": both(53, 5.0), "pulse": rk.pulses.sine(4.0, 0.8),
           "ricker": rk.pulses.ricker(5.0, 0.9)}  # fmt: skip


def python() -> dict[str, Case]:
    """Calls of the public names."""
    cases: dict[str, Case] = {}
    for name, body in BODIES.items():
        cases[f"body {name}"] = lambda _, body=body: _body(body)
        cases[f"coefficients {name}"] = lambda _, body=body: _coefficients(body)
    for name in ("statue", "block"):
        for motion, shaking in MOTIONS.items():
            for law in ("ked", "housner", 0.9):
                cases[f"simulate {name} {motion} {law}"] = lambda _, b=BODIES[name], m=shaking, r=law: (
                    doors.response_tree(doors.simulate(b, m, r))
                )
    cases["simulate linear reference"] = lambda _: doors.response_tree(
        doors.simulate(STATUE, MOTIONS["horizontal"], "ked", engine="reference", scale=0.6, linear=True)
    )
    cases["simulate drawn"] = lambda _: doors.response_tree(
        doors.simulate(BLOCK, MOTIONS["both"], rk.dynamics.RandomRestitution.normal(0.9, 0.03, seed=4))
    )
    cases["simulate by speed"] = lambda _: doors.response_tree(
        doors.simulate(BLOCK, MOTIONS["both"], rk.dynamics.SpeedRestitution([0.0, 0.5, 2.0], [0.95, 0.9, 0.8]))
    )
    cases["free"] = lambda _: [
        doors.response_tree(doors.free_rocking(b, 0.6 * b.side("left").slenderness_angle, "ked"))
        for b in (BLOCK, STATUE)
    ]
    cases["contact"] = lambda _: [
        doors.response_tree(doors.with_contact(STATUE, MOTIONS["both"], f, scale=0.7, normal_restitution=e))
        for f, e in ((0.15, 0.0), (0.4, 0.0), (2.0, 0.2))
    ]
    cases["space"] = lambda _: [
        doors.response_tree(doors.in_space(SOLID, noise(37, 2.5), noise(53, 2.0), noise(91, 1.0), law, duration=6.0))
        for law in ("housner-3d", "ked-3d", 0.9)
    ]
    cases["space free"] = lambda _: doors.response_tree(doors.free_in_space(SOLID, 0.05, 0.7, "ked-3d", duration=4.0))
    # none of these histories is chaotic: rounding does not change the number of impacts
    cases["space many"] = lambda _: doors.many_in_space(
        [SOLID], [(noise(k, 2.5, 300), noise(k + 16, 2.0, 300), noise(k + 54, 1.0, 300)) for k in (37, 41)],
        ["housner-3d", "ked-3d", 0.95], scales=[1.0, 1.8, 2.0],
    ).to_xarray()  # fmt: skip
    cases["solid"] = lambda _: _solid()
    records, pulses = [MOTIONS["horizontal"], MOTIONS["both"]], [MOTIONS["pulse"], MOTIONS["ricker"]]
    for label, motions in (("records", records), ("pulses", pulses)):
        cases[f"many {label}"] = lambda _, motions=motions: doors.simulate_many(
            list(BODIES.values()), motions, ["ked", "housner", 0.9], scale=[0.3, 0.6, 1.0, 2.0], threads=1, twin=True
        )
    cases["many drawn"] = lambda _: doors.simulate_many(
        [STATUE, BLOCK],
        [both(k, 4.0) for k in (5, 6, 7)],
        rk.dynamics.RandomRestitution.normal(0.9, 0.03, seed=2),
        scale=[0.5, 1.0],
    )
    cases["map"] = lambda _: doors.overturning_map(
        BLOCK, rk.pulses.sine(3.0, 0.6), ("frequency_ratio", np.linspace(0.5, 7, 12)),
        ("amplitude_ratio", np.linspace(1, 9, 10)), "ked",
    )  # fmt: skip
    cases["map refined"] = lambda _: doors.overturning_map(
        STATUE, rk.pulses.sine(3.0, 0.6), ("period", np.linspace(0.3, 2, 9)), ("pga", np.linspace(1, 9, 8)), 0.9,
        refine=2,
    )  # fmt: skip
    cases["spectrum"] = lambda _: doors.rocking_spectrum(records, [0.15, 0.25], [1.0, 2.0, 4.0], "housner")
    cases["minimum"] = lambda _: _parts(doors.minimum(STATUE, rk.pulses.sine(1.0, 0.7), 0.9, samples=60))
    cases["intensity"] = lambda _: [rk.motions.intensity_measures(motion) for motion in records]
    cases["response spectrum"] = lambda _: _parts(
        rk.motions.response_spectrum(noise(37, 4.0), [0.1, 0.2, 0.5, 1.0, 2.0], 0.05)
    )
    cases["processing"] = lambda _: _processed()
    cases["synthetic"] = lambda _: _synthetic()
    cases["pulses"] = lambda _: {
        name: getattr(rk.pulses, name)(3.0, 0.8).ground_motion(0.01).acceleration
        for name in ("sine", "cosine", "half_sine", "half_cosine", "rectangular", "ricker", "antisymmetric_ricker",
                     "type_a", "type_b", "type_c")
        if hasattr(getattr(rk.pulses, name)(3.0, 0.8), "ground_motion")
    }  # fmt: skip
    cases["evidence"] = lambda _: _evidence()
    cases["fragility"] = lambda _: _fragility()
    return cases


def _body(body: Any) -> Any:
    sides = {side: body.side(side) for side in ("left", "right")}
    names = ("half_width", "semi_diagonal", "slenderness_angle", "frequency_parameter", "moment_of_inertia",
             "slenderness_ratio", "uplift_acceleration")  # fmt: skip
    return {
        "mass": body.mass, "centre": body.centre, "feet": body.feet, "assumed": body.assumed,
        "sides": {side: {name: getattr(one, name) for name in names} for side, one in sides.items()},
        "mirrored": body.mirrored().centre, "scaled": body.scaled(size=2.0).mass,
    }  # fmt: skip


def _coefficients(body: Any) -> Any:
    made = {}
    for name in rk.restitution.models():
        for foot in ("left", "right"):
            try:
                made[f"{name} {foot}"] = rk.coefficient_of_restitution(body, name, foot=foot)
            except Exception as error:  # noqa: BLE001 - a refusal is an answer
                made[f"{name} {foot}"] = error
    return made


def _solid() -> Any:
    edges, corners = SOLID.base.edges, SOLID.base.corners
    impacts = [
        rk.restitution.space.impact_in_space(
            SOLID, -edges[0].direction, pivot=edges[0], onto=foot, model=model
        ).velocity
        for foot in (edges[2], corners[3])
        for model in ("housner-3d", "horizontal-momentum-3d", "ked-3d", "ked-3d-point")
    ]
    names = ("housner-3d", "horizontal-momentum-3d", "ked-3d", "ked-3d-point")
    frustum = rk.Solid(
        [
            rk.bodies.Part(rk.bodies.solid.box(0.5, 0.4, 1.5), 2400.0),
            rk.bodies.Part(rk.bodies.solid.box(0.2, 0.2, 0.3), 900.0).moved(0.1, 0, 1.5),
        ]
    )
    edge = {name: [rk.restitution.space.edge_coefficient(frustum, name, start=k) for k in range(4)] for name in names}
    return {"mass": SOLID.mass, "centre": SOLID.centre, "inertia": SOLID.inertia, "impacts": impacts, "edges": edge}


def _parts(value: Any) -> dict[str, Any]:
    names = [name for name in dir(value) if not name.startswith("_")]
    return {name: one for name in names if not callable(one := getattr(value, name))}


def _processed() -> Any:
    motion, there = noise(53, 3.0), rk.motions
    made = [
        there.demeaned(motion), there.detrended(motion, 2, "velocity"), there.tapered(motion, 0.1),
        there.bandpassed(motion, 0.1, 20.0), there.resampled(motion, 0.01), there.scaled_to(motion, "pga", 3.0),
        there.scaled_to(motion, "pgv", 0.3), there.scaled_to(motion, "sa(2.0)", 1.0),
        there.trimmed_to_significant(motion), there.rotated(motion, noise(54, 3.0), 0.4),
    ]  # fmt: skip
    return [
        [one.acceleration, one.time_step, one.provenance] for each in made
        for one in (each if isinstance(each, tuple) else (each,))
    ]  # fmt: skip


def _synthetic() -> Any:
    from rocking.studies import SyntheticSet

    return {
        name: [motion.acceleration for motion in SyntheticSet(name, count=2, seed=3)]
        for name in ("firm-ground", "soft-ground", "kanai-tajimi", "point-source", "pulse-like")
    }


def _evidence() -> Any:
    import rocking.evidence as there

    calibration, standings = there.calibrate(), there.league()
    return {
        "league": list(standings),
        "claims": [[claim.text if hasattr(claim, "text") else str(claim)] for claim in there.claims()],
        "errata": [str(each) for each in there.errata()],
        "verdict": there.verdict(standings),
        "intervals": {
            name: _parts(there.interval_for(rk.restitution.model("ked"), BODIES[name])) for name in ("block", "statue")
        },
        "calibration": {name: getattr(calibration, name) for name in ("eta", "k") if hasattr(calibration, name)},
    }


def _fragility() -> Any:
    from rocking.studies import SyntheticSet, fragility_analysis

    motions = list(SyntheticSet("point-source", count=20, seed=1))
    g = conventions.g
    stripes = fragility_analysis(BLOCK, motions, np.linspace(0.2, 1.2, 8) * g, "ked", limit_states=(0.3,))
    other = fragility_analysis(
        BLOCK, [motion.scaled(6.0) for motion in motions], restitution="ked", im="pgv", analysis="cloud"
    )
    growing = fragility_analysis(BLOCK, motions[:7], np.linspace(0.2, 1.6, 12) * g, "housner", analysis="incremental")
    return {
        "stripes": {
            state: [fit.median, fit.dispersion, fit.interval("median", method="bootstrap")]
            for state, fit in stripes.fits.items()
        },
        "cloud": {state: [fit.median, fit.dispersion] for state, fit in other.fits.items()},
        "incremental": {
            state: [fit.median, fit.dispersion, fit.interval("median")] for state, fit in growing.fits.items()
        },
    }


RECORD = "".join(f"{value:.6f}\n" for value in 0.4 * np.sin(0.06 * np.arange(800)) * np.exp(-0.002 * np.arange(800)))
SHORT = {"SIZE": "--width 0.5 --height 2", "PULSE": PULSE, "KED": "--restitution ked"}
ASKED = {
    "help": "--help",
    "cor": "restitution SIZE",
    "cor json": "restitution SIZE --json",
    "cor statue": "restitution statue.toml --json --output csv=o.csv --output picture=o.png",
    "cor one side": "restitution statue.toml --foot left --restitution ked --restitution 0.98*ked --check-identities",
    "cor solid": "restitution solid.toml --json",
    "cor solid page": "restitution solid.toml --restitution ked-3d",
    "cor refused": "restitution --width -1 --height 2",
    "cor refused model": "restitution SIZE --restitution kedd",
    "simulate": "simulate SIZE PULSE KED",
    "simulate json": "simulate SIZE PULSE --json KED",
    "simulate files": "simulate statue.toml PULSE --restitution housner -o csv=o.csv -o picture=o.png --json",
    "simulate record": "simulate statue.toml record.txt --units cm,g --set motion.time_step=0.01 --scale 3 KED",
    "simulate record json": "simulate SIZE record.txt --units m,g --set motion.time_step=0.01 --scale 4 --json KED",
    "simulate free": "simulate statue.toml --initial-rotation 0.5 KED",
    "simulate free json": "simulate SIZE --initial-rotation -0.5 --json KED",
    "simulate contact": "simulate SIZE PULSE --friction 0.4 KED",
    "simulate contact json": "simulate statue.toml PULSE --friction 0.3 --json KED",
    "simulate solid": "simulate solid.toml PULSE --motion y=sine:amplitude=1,period=0.5 KED",
    "simulate solid json": "simulate solid.toml PULSE --json KED",
    "simulate document": "simulate response.toml --json",
    "simulate document page": "simulate free.toml",
    "simulate refused": "simulate SIZE sine:amplitude=3",
    "simulate refused file": "simulate SIZE none.at2",
    "simulate refused units": "simulate SIZE record.txt --set motion.time_step=0.01",
    "simulate doubted": "simulate --width 500 --height 2000 sine:amplitude=300,period=0.8 KED",
    "map": "map SIZE PULSE --x frequency_ratio=0.5:7:14 --y amplitude_ratio=1:9:12 KED",
    "map files": "map statue.toml PULSE KED --x pga=0.1g:0.6g:9 --y period=0.3s:2s:8 --json -o csv=o.csv "
    "-o netcdf=o.nc -o picture=o.png",
    "map two": "map SIZE PULSE --x frequency_ratio=0.5:7:9 --y amplitude_ratio=1:9:9 --restitution ked "
    "--restitution housner",
    "map refined": "map SIZE PULSE --x frequency_ratio=0.5:7:9 --y amplitude_ratio=1:9:9 --refine 2 KED --json "
    "--output netcdf=o.nc --output csv=o.csv",
    "map refused": "map SIZE PULSE --x nonsense=1:2:3",
    "minimum": "overturning-pga SIZE sine:amplitude=1,period=0.8 --samples 60 KED",
    "minimum files": "overturning-pga statue.toml sine:amplitude=1,period=0.8 --samples 60 --json KED",
    "spectrum": "spectrum PULSE --slenderness 4,6 --periods 1:6:6 KED",
    "spectrum files": "spectrum PULSE --slenderness 10deg,15deg --periods 1:6:5 --json --output csv=o.csv KED",
    "fragility": "fragility SIZE --synthetic point-source --count 20 KED",
    "fragility json": "fragility SIZE --synthetic pulse-like --count 15 --seed 2 --json KED",
    "inventory": "inventory inventory.csv --pga 0.3g --count 30",
    "inventory files": "inventory inventory.csv --pga 0.3g --count 20 --json --output made",
    "models": "models",
    "models json": "models --json",
    "models one": "models ked-3d",
    "models refused": "models Hausner",
    "motion": "record show PULSE",
    "motion json": "record show record.txt --units g --set motion.time_step=0.01 --json",
    "motion files": "record show PULSE --output csv=o.csv --output picture=o.png",
    "formats": "record formats",
    "formats json": "record formats --json",
    "paper": "reproduce --json",
    "version": "--version",
    "unknown": "simulat",
    **{
        f"help {name}": f"{name} --help"
        for name in (
            "restitution", "simulate", "map", "overturning-pga", "spectrum", "fragility", "inventory", "reproduce",
            "models", "record show", "record formats", "serve", "campaign", "campaign run", "campaign export",
        )
    },
}  # fmt: skip


def inputs(folder: Path) -> None:
    """Put the files that commands read into a folder."""
    shutil.copy(rk.examples.path("statue"), folder / "statue.toml")
    shutil.copy(rk.examples.path("block-under-a-pulse"), folder / "response.toml")
    shutil.copy(rk.examples.path("statue-released"), folder / "free.toml")
    shutil.copy(rk.examples.path("objects"), folder / "inventory.csv")
    (folder / "record.txt").write_text(RECORD, encoding="utf-8")
    (folder / "solid.toml").write_text(SOLID_FILE, encoding="utf-8")


SOLID_FILE = """units = "m"
name = "column that leans"
[[solid.part]]
box = { width = 0.6, depth = 0.5, height = 1.6 }
density = 2400
[[solid.part]]
box = { width = 0.3, depth = 0.2, height = 0.4 }
at = [0.1, 0.05, 1.6]
density = 1800
"""


def commands() -> dict[str, Case]:
    """The command line: what it prints, and the files that it writes."""

    def asked(words: list[str], folder: Path) -> Any:
        inputs(folder)
        there = {path.name for path in folder.iterdir()}
        said = doors.command(words, folder)
        if "--json" in words and said["code"] == 0:
            said["out"] = json.loads(said["out"])
        made = {name: one for name, one in trees.of_files(folder).items() if name not in there}
        return said | {"files": made}

    def words(line: str) -> list[str]:
        return " ".join(SHORT.get(word, word) for word in line.split()).split()

    return {name: lambda folder, line=line: asked(words(line), folder) for name, line in ASKED.items()}


def examples() -> dict[str, Case]:
    """Every script of the gallery: what it prints, and the files that it writes."""

    def run(path: Path, folder: Path) -> Any:
        command = [sys.executable, "-W", "ignore", str(path)]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        return {"code": done.returncode, "out": done.stdout.splitlines(), "files": trees.of_files(folder)}

    scripts = sorted((ROOT / "examples").glob("*/*.py"))
    return {path.stem: lambda folder, path=path: run(path, folder) for path in scripts}


STUDY: dict[str, Any] = {
    "body": {"units": "m", "width": 0.5, "height": 2.0},
    "motions": {"pulse": "sine:amplitude=3,period=0.6"},
    "restitution": {"models": ["ked", "housner"]},
}
SYNTHETIC = {"synthetic": "pulse-like", "count": 12, "seed": 7}
PULSES = {"pulse": [f"sine:amplitude={a},period={p}" for a in (2.0, 4.0) for p in (0.4, 0.7)]}
AXES = {"x": {"axis": "frequency_ratio", "from": 1, "to": 6, "count": 6},
        "y": {"axis": "amplitude_ratio", "from": 1, "to": 8, "count": 5}}  # fmt: skip
STUDIES: dict[str, dict[str, Any]] = {
    "overturning-map": {"map": AXES},
    "refined": {"map": {**AXES, "refine": 1}, "restitution": {"value": 0.9}},
    "rocking-spectrum": {"spectrum": {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 4.0]}, "body": None},
    "stripes": {"fragility": {"levels": [2.0, 4.0, 6.0, 8.0, 10.0], "limit_states": [0.5]}, "motions": SYNTHETIC},
    "cloud": {"fragility": {"im": "pgv"}, "motions": SYNTHETIC},
    "incremental": {"fragility": {"levels": [2.0, 4.0, 8.0, 12.0]}, "motions": PULSES},
    "histories": {"histories": {"scales": [1.0, 4.0, 9.0]}, "motions": PULSES},
    "drawn": {
        "histories": {"scales": [1.0, 4.0, 9.0]}, "motions": PULSES,
        "restitution": {"distribution": {"mean": 0.9, "deviation": 0.03, "each": "impact"}},
    },
    "minimum-acceleration": {"minimum": {"samples": 20}},
}  # fmt: skip
INVENTORY = {
    "campaign": {"name": "objects", "kind": "inventory"}, "inventory": {"objects": "inventory.csv", "pga": "0.3g"},
    "motions": {"synthetic": "firm-ground", "count": 20, "seed": 1},
}  # fmt: skip
ENDINGS = ("nc", "csv", "mat", "xlsx", "parquet", "xml", "png", "html", "json")


def job(name: str) -> dict[str, Any]:
    """Return the tables of a study's job."""
    kind = {"refined": "overturning-map", "drawn": "histories"}.get(name, name)
    made = {"campaign": {"name": f"{name} of a block", "kind": kind, "seed": 3}, **STUDY, **STUDIES[name]}
    return {key: value for key, value in made.items() if value is not None}


def _toml(tables: dict[str, Any]) -> str:
    def value(one: Any) -> str:
        if isinstance(one, dict):
            return "{ " + ", ".join(f"{key} = {value(each)}" for key, each in one.items()) + " }"
        return json.dumps(one)

    lines = [f"{key} = {value(one)}\n" for key, one in tables.items()]
    text = "".join(lines)
    assert tomllib.loads(text) == tables
    return text


def campaigns() -> dict[str, Case]:
    """Campaigns by the command line: what is said, every export that there is, and the bytes of the folder."""

    def run(name: str, folder: Path) -> Any:
        shutil.copy(rk.examples.path("objects"), folder / "inventory.csv")
        (folder / "job.toml").write_text(_toml(job(name) if name in STUDIES else INVENTORY), encoding="utf-8")
        said: dict[str, Any] = {}

        def ask(label: str, *words: str) -> None:
            said[label] = answered = doors.command(["campaign", *words], folder)
            if "--json" in words:
                answered["out"] = json.loads(answered["out"])

        ask("run", "run", "job.toml", "--output", "c", "--workers", "1")
        ask("again", "run", "job.toml", "--output", "c")
        ask("status", "status", "c", "--json")
        ask("verify", "verify", "c", "--json")
        kept = trees.of_files(folder / "c")
        whats = [None, "histories", "fragility", "fragility-points", "fema-p58", "refined", "boundary", "crossings",
                 "minima", "ims", "flips", "differences", "report"]  # fmt: skip
        for what in whats:
            for ending in ENDINGS:
                target = f"o-{what}.{ending}"
                ask(f"export {what} {ending}", "export", "c", "--output", f"{what}={target}" if what else target)
        files = {
            path.name: trees.of_file(path.name, path.read_bytes())
            for path in sorted(folder.glob("o-*"))
            if path.is_file()
        }
        return {"said": said, "kept": kept, "files": files}

    return {name: lambda folder, name=name: run(name, folder) for name in (*STUDIES, "inventory")}


BODY_TABLES = {
    "block": {"units": "cm", "width": 50, "height": 200, "name": "vase"},
    "hollow": {"units": "m", "section": {"region": [
        {"outline": [[0, 0], [1, 0], [0.8, 3], [0, 3]], "density": 2000, "holes": [[[0.2, 1], [0.6, 1], [0.4, 2]]]}
    ]}},
    "points": {
        "units": "m", "mass_points": {"points": [[0, 1], [1, 1], [0.5, 4]], "masses": [1, 2, 3], "feet": [0, 1]},
    },
    "none": {"units": "m", "width": -1, "height": 2},
}  # fmt: skip
MOTION_TABLES = {
    "pulse": {"pulse": PULSE, "scale": 2.0}, "synthetic": {"synthetic": "pulse-like", "seed": 3, "scale": 3.0},
    "none": {"pulse": "sine:amplitude=3"},
}  # fmt: skip
ASKED_OF_PAGE = {
    **{f"body {name}": ("/api/body", {"body": body}) for name, body in BODY_TABLES.items()},
    **{f"impact {name}": ("/api/impact", {"body": body}) for name, body in BODY_TABLES.items()},
    **{f"motion {name}": ("/api/motion", {"motion": motion}) for name, motion in MOTION_TABLES.items()},
    **{
        f"response {name} {other}": ("/api/response", {
            "body": body, "motion": motion, "restitution": {"models": ["ked", "housner"], "values": [0.8]},
        })
        for name, body in BODY_TABLES.items() for other, motion in MOTION_TABLES.items()
    },
    "response free": ("/api/response", {
        "body": BODY_TABLES["hollow"], "restitution": {"value": 0.9}, "response": {"initial_rotation": 0.4},
    }),
}  # fmt: skip
MOVED = {"body": BODY_TABLES["hollow"], "motion": MOTION_TABLES["pulse"], "restitution": {"models": ["ked", "housner"]}}
TAKEN = (
    "table/response.csv", "table/response.xlsx", "table/response.mat", "table/response.nc", "table/body.csv",
    "table/motion.csv", "table/motion.nc", "inputs.toml", "inputs.zip", "report.pdf",
)  # fmt: skip


def application() -> dict[str, Case]:
    """The web application: answers, files, studies with results, cells and exports."""

    def ask(path: str, document: Any, folder: Path) -> Any:
        with doors.application(folder) as client:
            answer = client.post(path, json=document)
            return {"status": answer.status_code, "answer": answer.json()}

    def take(name: str, folder: Path) -> Any:
        with doors.application(folder) as client:
            answer = client.post(f"/api/{name}", json=MOVED)
            kind = answer.headers["Content-Type"]
            return {"status": answer.status_code, "type": kind, "file": trees.of_file(name, answer.content)}

    def study(name: str, folder: Path) -> Any:
        with doors.application(folder) as client:
            made = client.post("/api/studies", json={"job": job(name)}).json()
            while (facts := client.get(f"/api/studies/{made['id']}").json())["state"] not in {
                "done",
                "failed",
                "refused",
            }:
                time.sleep(0.05)
            there = f"/api/studies/{made['id']}"
            said: dict[str, Any] = {"state": facts["state"], "result": client.get(f"{there}/result").json()}
            for x in range(3):
                said[f"cell {x}"] = client.get(f"{there}/cell", params={"x": x, "points": 20}).json()
            for ending in ENDINGS:
                answer = client.get(f"{there}/export.{ending}")
                said[f"export {ending}"] = [answer.status_code, trees.of_file(f"x.{ending}", answer.content)]
            return said

    def info(folder: Path) -> Any:
        with doors.application(folder) as client:
            return {path: client.get(path).json() for path in ("/api/info", "/api/openapi.json")}

    return {
        **{name: lambda folder, how=how: ask(*how, folder) for name, how in ASKED_OF_PAGE.items()},
        **{f"take {name}": lambda folder, name=name: take(name, folder) for name in TAKEN},
        **{f"study {name}": lambda folder, name=name: study(name, folder) for name in STUDIES},
        "info": info,
    }


GROUPS = {
    "python": python,
    "commands": commands,
    "examples": examples,
    "campaigns": campaigns,
    "application": application,
}


def answer(case: Case, folder: Path) -> Any:
    """Return what a case answers, as a tree; an error is an answer."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return trees.tree(case(folder))
        except Exception as error:  # noqa: BLE001
            return trees.tree(error)
