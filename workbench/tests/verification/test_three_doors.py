"""The same inputs give the same numbers in the application, on the command line and in Python, to the last digit."""

import io
import json
import math
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from waiting import HANG
from web_clients import new_application, script_of, serving

import rocking as rk
from rocking import conventions
from rocking.motions.formats import write_motion
from rocking.plots.animation_scene import DrawnShape, fall_of

pytestmark = pytest.mark.verifies("same bits", control="test_negative_control_a_changed_input_differs", room="doors")

STATUE = [[0.0, 0.0], [0.5, 0.0], [0.5, 0.6], [0.4, 0.6], [0.3, 1.9], [0.15, 1.9], [0.1, 0.6], [0.0, 0.6]]
CABINET = {"units": "cm", "width": 50, "height": 200, "depth": 40, "density": 700}
HOLLOW = {
    "units": "mm",
    "name": "hollow <b>pier</b>",
    "section": {
        "region": [
            {
                "outline": [[0, 0], [900, 0], [700, 2400], [200, 2400]],
                "holes": [[[400, 400], [500, 400], [500, 1400], [400, 1400]]],
                "density": 1900.0,
            }
        ],
        "depth": 300.0,
    },
}
POINTS = {"points": [[0.1, 0.4], [0.5, 1.7], [0.9, 0.4]], "masses": [30.0, 55.0, 31.0], "feet": [0.0, 1.0]}
BODIES = {
    "cabinet": (CABINET, lambda: rk.Block(width=50 * 0.01, height=200 * 0.01, depth=40 * 0.01, density=700.0)),
    "statue": (
        {"units": "m", "section": {"region": [{"outline": STATUE, "density": 2400.0}], "feet": [0.05, 0.45]}},
        lambda: rk.Section([rk.Region(np.array(STATUE), 2400.0)], (0.05, 0.45)),
    ),
    "hollow": (
        HOLLOW,
        lambda: rk.Section(
            [
                rk.Region(
                    np.array(HOLLOW["section"]["region"][0]["outline"]) * 0.001,
                    1900.0,
                    holes=[np.array(HOLLOW["section"]["region"][0]["holes"][0]) * 0.001],
                )
            ],
            depth=300.0 * 0.001,
        ),
    ),
    "points": (
        {"units": "m", "mass_points": POINTS},
        lambda: rk.MassPoints(POINTS["points"], POINTS["masses"], (0.0, 1.0)),
    ),
}
RESTITUTIONS = {
    "models": ({"models": ["ked", "housner", "0.97*ked"]}, ["ked", "housner", "0.97*ked"]),
    "both": ({"models": ["shifted-impulse:k=0.6"], "values": [0.9, 0.1]}, ["shifted-impulse:k=0.6", 0.9, 0.1]),
    "sides": ({"left": 0.91, "right": 0.87}, [{"left": 0.91, "right": 0.87}]),
    "value": ({"value": 0.123456789012345}, [0.123456789012345]),
}
CASES = {
    "cabinet, sine": ("cabinet", {"pulse": "sine:amplitude=3.2,period=0.8", "scale": 1.06}, "models", {}),
    "statue, Ricker": ("statue", {"pulse": "ricker:amplitude=3.9,period=0.7", "scale": -1.1}, "both", {}),
    "hollow, near fault": (
        "hollow",
        {"pulse": "mavroeidis-papageorgiou:velocity=0.9,period=1.3,phase=0.4"},
        "both",
        {"settings": {"gravity": 9.81, "linear": True}},
    ),
    "points, record": ("points", {"record": "", "scale": 1.7}, "models", {}),
    "cabinet, record": ("cabinet", {"record": "", "scale": 1.3}, "sides", {"response": {"assumed_friction": 0.2}}),
    "statue, synthetic": ("statue", {"synthetic": "pulse-like", "seed": 5, "member": 2, "pga": 3.3}, "value", {}),
    "statue, let go": ("statue", None, "sides", {"response": {"initial_rotation": -0.7}}),
    "cabinet, let go": ("cabinet", None, "both", {"response": {"initial_rotation": 0.3, "assumed_friction": 0.25}}),
    "hollow, reference": (
        "hollow",
        {"pulse": "sine:amplitude=2.5,period=0.9"},
        "value",
        {"settings": {"engine": "reference"}},
    ),
}


def record_motion():
    """A motion of ten seconds that no file has held yet, in the unit of a PEER file when it is written."""
    time = np.arange(1000) * 0.01
    wave = 2.5 * np.sin(2.0 * np.pi * 1.1 * time) * np.exp(-(((time - 3.0) / 1.7) ** 2))
    return rk.GroundMotion(wave + 0.7 * np.sin(31.0 * time) * np.exp(-0.5 * time), 0.01, name="made for a test")


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """A record file that our own writer wrote."""
    path = tmp_path_factory.mktemp("records") / "made.at2"
    write_motion(record_motion(), path, "peer")
    return path


@pytest.fixture(scope="module")
def inside(tmp_path_factory):
    """The application in this process."""
    with script_of(new_application(tmp_path_factory.mktemp("data"))) as client:
        yield client


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A real server in a process of its own, asked over a socket."""
    import httpx

    with (
        serving(tmp_path_factory.mktemp("d")) as (_, url, head),
        httpx.Client(base_url=url, headers=head, timeout=HANG) as client,
    ):
        yield client


def document_of(case, client, record):
    """Inputs of a case; its record, if it has one, is sent first."""
    body, motion, restitution, more = CASES[case]
    if motion is not None and "record" in motion:
        octets = {"Content-Type": "application/octet-stream"}
        sent = client.post(
            "/api/records", params={"name": record.name}, content=record.read_bytes(), headers=octets
        ).json()
        assert sent["needs"] == []
        motion = {**motion, "record": sent["record"], "file_name": sent["file_name"]}
    return {"body": BODIES[body][0], "motion": motion, "restitution": RESTITUTIONS[restitution][0], **more}


def application(client, document):
    """Answers of the application, by label."""
    answer = client.post("/api/response", json=document)
    assert answer.status_code == 200, answer.text
    return {one.pop("label"): one for one in answer.json()["answers"]}


def unpacked(client, document, folder):
    """The file that the application hands out."""
    bundle = client.post("/api/inputs.zip", json=document)
    assert bundle.status_code == 200, bundle.text
    with zipfile.ZipFile(io.BytesIO(bundle.content)) as files:
        files.extractall(folder)
    (toml,) = folder.rglob("*.toml")
    return toml


def in_python(case, record):
    """Responses as a Python user computes them, in the order of the restitutions."""
    body, motion, restitution, more = CASES[case]
    settings = dict(more.get("settings", {}))
    free, made = more.get("response", {}).get("initial_rotation"), BODIES[body][1]()
    found = []
    for choice in RESTITUTIONS[restitution][1]:
        if free is not None:
            side = made.side("right" if free > 0.0 else "left", settings.get("gravity", conventions.g))
            found.append(rk.free_rocking(made, free * side.slenderness_angle, choice, **settings))
            continue
        found.append(
            rk.simulate(made, python_motion(motion, record), choice, scale=motion.get("scale", 1.0), **settings)
        )
    return found


def python_motion(motion, record):
    """The motion of a case, made by the library's own names."""
    if "pulse" in motion:
        name, _, words = motion["pulse"].partition(":")
        values = {key: float(value) for key, value in (word.split("=") for word in words.split(","))}
        return getattr(rk.pulses, name.replace("-", "_"))(**values)
    if "record" in motion:
        return rk.read_motion(record)
    from rocking.motions import scaled_to
    from rocking.motions.synthetic import family

    return scaled_to(family(motion["synthetic"]).motion(motion["seed"], motion["member"]), "pga", motion["pga"])


def numbers_of(response):
    """Every number of a response, as the library holds them."""
    parameters, finite = response.parameters, lambda value: value if math.isfinite(value) else None
    contact = response.contact
    return {
        "peak_rotation": response.peak_rotation,
        "overturning_time": finite(response.overturning_time),
        "impacts": [tuple(row) for row in response.impacts.tolist()],
        "uplift_times": response.uplifts.tolist(),
        "coefficients": (parameters.left.coefficient, parameters.right.coefficient),
        "energy_closure": response.energy.closure,
        "error_estimate": finite(response.error_estimate),
        "friction": (finite(contact.friction_of_motion), finite(contact.friction_of_impacts)),
        "least_force": finite(response.least_force),
        "lost_contact": response.lost_contact,
        "initial_rotation": float(response.rotation[0]),
        "still_rocking": {
            "time": response.time[-1], "rotation": response.rotation[-1],
            "angular_velocity": response.angular_velocity[-1], "unfinished": response.unfinished,
        } if response.still_rocking else None,
    }  # fmt: skip


def numbers_in(facts):
    """The same numbers, as a door tells them."""
    plain = ("peak_rotation", "overturning_time", "uplift_times", "energy_closure", "error_estimate")
    return {
        **{name: facts[name] for name in (*plain, "least_force", "lost_contact", "initial_rotation")},
        "impacts": [tuple(row.values()) for row in facts["impacts"]],
        "coefficients": (facts["coefficient"]["left"], facts["coefficient"]["right"]),
        "friction": (facts["friction_of_motion"], facts["friction_of_impacts"]),
        "still_rocking": facts["last_state"] and {**facts["last_state"]},
    }


@pytest.mark.verifies(against="application, command line and Python")
@pytest.mark.parametrize("case", CASES)
def test_three_doors_agree_to_the_last_digit(run, case, inside, record, tmp_path):
    """Application, command line and Python give equal float64 for every number of every restitution."""
    document = document_of(case, inside, record)
    answers = application(inside, document)
    for answer, response in zip(answers.values(), in_python(case, record), strict=True):
        assert numbers_in(answer) == numbers_of(response)
        assert answer["outcome"] == response.outcome.name.lower()
        lying = DrawnShape.of(response.body).lying
        fall = fall_of(response, lying)
        # drawn, as the series are, and not among the facts that the command prints
        assert answer.pop("fall") == {
            "time": fall.time[1:].tolist(), "rotation": fall.rotation[1:].tolist(), "lying": list(lying),
        }  # fmt: skip
    code, out, err = run("simulate", unpacked(inside, document, tmp_path), "--json")
    assert code == 0, err
    printed = json.loads(out)
    others, *_ = (printed.pop(key, None) for key in ("other_models", "headline", "units", "messages"))
    first, *rest = answers.items()
    assert {key: value for key, value in first[1].items() if key != "series"} == printed
    assert list(others) == [label for label, _ in rest]
    for label, answer in rest:
        told = others[label]
        assert told.pop("impacts") == len(answer["impacts"])
        assert told == {key: answer[key] for key in told}


@pytest.mark.verifies(against="a server in a process of its own")
def test_a_real_server_gives_the_same_answers(served, inside, record):
    """Over a socket, from another process, every answer is the same JSON, curves included."""
    for case in ("cabinet, sine", "points, record", "statue, let go"):
        document = document_of(case, served, record)
        document_of(case, inside, record)
        assert application(served, document) == application(inside, document)


@pytest.mark.verifies(against="the application and `rocking restitution`")
def test_coefficients_are_those_of_the_command(inside):
    """POST /api/impact and `rocking restitution --json` say the same of a block."""
    words = [sys.executable, "-m", "rocking", "restitution", "--width", "0.5", "--height", "2", "--json"]
    printed = json.loads(subprocess.run(words, capture_output=True, text=True, check=True, timeout=HANG).stdout)
    answer = inside.post("/api/impact", json={"body": {"units": "m", "width": 0.5, "height": 2}}).json()
    assert printed.pop("units").items() <= answer["units"].items()
    assert {key: answer[key] for key in printed if key != "body"} == {k: v for k, v in printed.items() if k != "body"}
    assert {key: answer["body"][key] for key in printed["body"]} == printed["body"]


@pytest.mark.verifies(against="the application and `rocking record show`")
def test_motion_is_that_of_the_command(inside, record):
    """POST /api/motion and `rocking record show --json` say the same of a scaled record, but for its spectrum."""
    words = [sys.executable, "-m", "rocking", "record", "show", str(record), "--scale", "1.3", "--json"]
    printed = json.loads(subprocess.run(words, capture_output=True, text=True, check=True, timeout=HANG).stdout)
    document = document_of("cabinet, record", inside, record)
    answer = inside.post("/api/motion", json={"motion": document["motion"]}).json()
    assert printed.pop("units").items() <= answer["units"].items()
    del printed["spectrum"]
    assert {key: answer[key] for key in printed} == printed


def smallest_change(document, where):
    """The document with one number moved by one unit in the last place."""
    changed = json.loads(json.dumps(document))
    table, key = where
    changed[table][key] = math.nextafter(float(changed[table][key]), math.inf)
    return changed


@pytest.mark.verifies("negative control", "one unit in the last place of a scale, a height or a coefficient")
@pytest.mark.parametrize("where", [("motion", "scale"), ("body", "height"), ("restitution", "value")])
def test_negative_control_a_changed_input_differs(inside, record, where):
    """One unit in the last place of a scale, a height or a coefficient changes the numbers: equality is no accident."""
    document = {**document_of("cabinet, sine", inside, record), "restitution": {"value": 0.93}}
    (before,), (after,) = (application(inside, one).values() for one in (document, smallest_change(document, where)))
    assert numbers_in(before) != numbers_in(after)
    assert numbers_in(before) == numbers_in(*application(inside, document).values())
