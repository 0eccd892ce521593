"""Long-run dynamics as studies: Python calls, commands, job files, campaigns that resume, pictures."""

import json
import math
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from waiting import wait_for

import rocking as rk
from rocking import plots
from rocking.campaigns.jobs import Job, JobFolder, status_of
from rocking.dynamics.impact_laws import SpeedRestitution
from rocking.errors import InvalidValueError
from rocking.plots.style import SINGLE
from rocking.spec.questions import question_in
from rocking.studies.longrun import symmetric_orbit
from rocking.studies.longrun.study import Cells, LongRunHistories, random_states

pytestmark = pytest.mark.verifies("behaviour", room="studies")
BLOCK = rk.Block(width=1.0, height=2.0)
BODY = {"units": "m", "width": 1.0, "height": 2.0}


def motion(amplitude, frequency=2.0, body=BLOCK):
    """Return the ground motion of an amplitude ratio and a frequency ratio."""
    system = rk.HarmonicRocking.of_ratios(body, amplitude, frequency)
    return system.excitation


def test_a_diagram_compares_models_and_sweeps():
    """Kinds, periods and symmetry of the branch of slenderness 2 at frequency 2, with both sweeps and two models."""
    values = np.array([0.5, 1.2, 2.3, 2.6, 2.75, 2.88, 2.95])
    orbit = symmetric_orbit(rk.HarmonicRocking.of_ratios(BLOCK, 0.5, 2.0, restitution="housner"))
    state = [[np.nan, np.nan], [orbit.phase, orbit.speed]]
    found = rk.bifurcation(BLOCK, motion(1.2), "amplitude", values, ["housner", "ked"], starts=state,
                           sweeps=("none", "up"), cycles=(400, 16))  # fmt: skip
    assert dict(found.sizes) == {"restitution": 2, "sweep": 2, "amplitude_ratio": 7, "initial_state": 2,
                                 "period_number": 16}  # fmt: skip
    once = found.isel(period_number=0).sel(restitution="housner", sweep="up")
    assert once["attractor"].values[0].tolist() == [0, 2]  # at rest below uplift, where the large orbit exists
    assert np.isneginf(once["exponent"].values[0, 0])
    large = once.isel(initial_state=1)
    assert large["is_symmetric"].values[:3].tolist() == [1, 1, 1]
    assert large["is_symmetric"].values[3:].tolist() == [0, 0, 0, 0]  # beyond the pitchfork at 2.387
    assert large["periods"].values.tolist() == [1, 1, 1, 1, 1, 1, 2]  # beyond the period doubling at 2.926
    assert large["impacts_per_period"].values == pytest.approx(2.0)
    assert large["exponent"].values[1] / BLOCK.frequency_parameter == pytest.approx(-0.2270663216, abs=0.02)


@pytest.mark.parametrize(("axis", "values"), [("slenderness", [2.0, 4.0]), ("size", [0.5, 2.0]),
                                              ("frequency", [2.0, 3.0]), ("restitution", [0.7, 0.9])])  # fmt: skip
def test_axes_of_diagrams(axis, values):
    """A value of an axis is the system with this value: the same attractor as of the body itself."""
    excitation = motion(1.2)
    states = [[5.9, 1.1]]
    options = {"starts": states, "cycles": (100, 4), "exponents": False}
    found = rk.bifurcation(BLOCK, excitation, axis, values, "housner", **options).isel(period_number=-1)
    value, restitution, body, own = values[1], "housner", BLOCK, excitation
    if axis == "slenderness":
        angle, size = np.arctan(1.0 / value), 2.0 * BLOCK.semi_diagonal
        body = rk.Block(width=size * np.sin(angle), height=size * np.cos(angle))
        own = motion(1.2, body=body)
    elif axis == "size":
        body = BLOCK.scaled(size=value / BLOCK.semi_diagonal)
    elif axis == "frequency":
        own = motion(1.2, value)
    else:
        restitution = value
    alone = rk.poincare(body, own, restitution, starts=states, cycles=(100, 4)).isel(period_number=-1)
    assert found["rotation_ratio"].values.ravel()[1] == pytest.approx(alone["rotation_ratio"].item(), nan_ok=True)


def test_sections_after_impacts_and_exponents():
    """The speeds of a stable 2-cycle of impacts; exponents of the orbit are equal, and those of chaos positive."""
    section = rk.poincare(BLOCK, motion(1.2), "housner", starts=[[5.9, 1.2]], cycles=(200, 20), at="impact")
    speeds = np.abs(section["velocity_ratio"].values[0, :40])
    assert np.ptp(speeds) < 1e-9
    found = rk.lyapunov(BLOCK, motion(3.0166), "housner", orbits=8, cycles=(300, 700))
    finite = found["exponent"].values[np.isfinite(found["exponent"].values)] / BLOCK.frequency_parameter
    assert finite.mean() == pytest.approx(0.1155, abs=0.02)  # an independent program: .11552(40)
    rested = rk.lyapunov(BLOCK, motion(0.5), "housner", orbits=4, cycles=(300, 10))
    assert not (rested["exponent"] > 0.0).any()


@pytest.mark.slow
def test_branches_of_orbits():
    """Fold, pitchfork and doublings as of two independent programs, stability between them."""
    found = rk.periodic_orbits(BLOCK, motion(1.2), limits=(0.05, 3.2), restitution="housner", points=60)
    marked = found["branch_point"].values.copy()
    assert marked[0, 0] == 4  # the unstable branch ends at a grazing
    marked[marked == 4] = 0
    values = found["amplitude_ratio"].values[marked > 0]
    assert values == pytest.approx([0.365698905, 2.387388435, 2.926390467, 2.986533874], abs=2e-9)
    assert marked[marked > 0].tolist() == [1, 2, 3, 3]
    stable = found["is_stable"].values[0] == 1
    assert found["amplitude_ratio"].values[0][stable & (marked[0] == 0)].max() < 2.3874


@pytest.mark.slow
def test_basins_paths_and_erosion():
    """Counts of the reference, cell for cell; a path is a row of the basin; larger amplitudes leave fewer states."""
    slender = rk.Block(width=1.0, height=4.0)
    excitation = motion(1.5, 3.0, slender)
    whole = rk.basin(slender, excitation, "housner")
    counts = np.bincount(whole["final_state"].values.ravel(), minlength=4)
    assert counts.tolist() == [6334, 106, 3560, 0]
    path = rk.basin(slender, excitation, "housner", speeds=whole["speed_ratio"].values[30:31])
    assert (path["final_state"].values[0, :, 0] == whole["final_state"].values[0, :, 30]).all()
    eroded = rk.basin(slender, excitation, ["housner", "ked"], amplitudes=[0.5, 2.0], phases=20, speeds=20, check=False)
    safe = (eroded["outcome"] != 2).mean(dim=("ground_phase", "speed_ratio"))
    assert (np.diff(safe.values, axis=1) < 0.0).all()


def test_rows_do_not_depend_on_how_they_are_cut():
    """Any piece of the histories of a task, across systems too, is the piece of all of them."""
    systems = tuple(rk.HarmonicRocking.of_ratios(BLOCK, 1.5, 2.0, restitution=r) for r in (0.5, 0.7))
    cells = Cells(np.array([0.8, 1.5]), np.linspace(0.1, 6.0, 5), np.linspace(0.1, 1.5, 4), 30)
    histories = LongRunHistories(systems=systems, task=cells)
    whole = histories.run(0, histories.count)
    parts = [histories.run(a, b) for a, b in ((0, 17), (17, 63), (63, 80))]
    for name, values in whole.items():
        assert np.array_equal(np.concatenate([part[name] for part in parts]), values)
    assert histories.key() == LongRunHistories(systems=systems, task=cells).key()
    assert np.isnan(random_states(3, 0)[0]).all()


def test_what_cannot_be_computed_is_refused():
    """Values name their parameter."""
    excitation = motion(1.2)
    for name, call in {
        "axis": lambda: rk.bifurcation(BLOCK, excitation, "mass", [1.0]),
        "values": lambda: rk.bifurcation(BLOCK, excitation, "amplitude", [2.0, 1.0]),
        "sweeps": lambda: rk.bifurcation(BLOCK, excitation, "amplitude", [1.0], sweeps=("left",)),
        "excitation": lambda: rk.basin(BLOCK, rk.pulses.sine(1.0, 1.0)),
        "at": lambda: rk.poincare(BLOCK, excitation, at="noon"),
        "points": lambda: rk.periodic_orbits(BLOCK, excitation, points=3),
        "limits": lambda: rk.periodic_orbits(BLOCK, excitation, limits=(2.0, 1.0)),
        "cycles": lambda: rk.poincare(BLOCK, excitation, cycles=100),
        r"cycles\[0\]": lambda: rk.lyapunov(BLOCK, excitation, cycles=(10, 20)),
        "amplitude": lambda: rk.bifurcation(BLOCK, excitation, "amplitude", [-1.0, 1.0]),
        "speeds": lambda: rk.basin(BLOCK, excitation, speeds=[-0.1, 0.1]),
        "phases": lambda: rk.basin(BLOCK, excitation, phases=[np.nan]),
    }.items():
        with pytest.raises(InvalidValueError, match=name):
            call()


@pytest.mark.slow
def test_pictures():
    """One panel or curve per model, at most four side by side; all calls have a picture."""
    excitation, models = motion(1.2), ["housner", "ked", "calibrated", 0.5, 0.7]
    diagram = rk.bifurcation(BLOCK, excitation, "amplitude", [0.9, 1.2], models, starts=2, cycles=(20, 4))
    figure = plots.bifurcation_picture(diagram)
    assert len([axes for axes in figure.axes if axes.get_visible()]) == 10
    assert plots.basins_picture(rk.basin(BLOCK, excitation, phases=4, speeds=4)).get_figwidth() == pytest.approx(SINGLE)
    eroded = rk.basin(BLOCK, excitation, models, amplitudes=[0.5, 1.0], phases=4, speeds=4)
    assert len(plots.basins_picture(eroded).axes[0].get_legend_handles_labels()[1]) == 5
    orbits = rk.periodic_orbits(BLOCK, excitation, restitution="housner", points=20, doublings=1)
    assert len(plots.orbits_picture(orbits).axes) == 1
    exponents = rk.lyapunov(BLOCK, excitation, models[:2], orbits=3, cycles=(60, 20))
    assert len(plots.lyapunov_picture(exponents).axes[0].get_yticks()) == 2
    section = rk.poincare(BLOCK, excitation, at="impact", cycles=(10, 10))
    assert plots.poincare_picture(section).axes[0].get_xlabel().startswith("phase")


def drawn(axes, *, is_upright=False):
    """Return the labelled lines of an axis of amplitudes, as texts and values."""
    lines = [line.get_ydata()[0] if is_upright else line.get_xdata()[0] for line in axes.lines if line.get_ls() == ":"]
    return sorted(text.get_text() for text in axes.texts), sorted(lines)


@pytest.mark.verifies("closed form", "Lenci and Rega (2006), the half sine and static uplift", within="1e-12")
def test_thresholds_are_drawn_on_axes_of_amplitudes():
    """Those of each model and of each start; none on another axis, or of a coefficient that depends on the speed."""
    excitation, both = motion(1.2), {"half": 0.5, "elastic": 0.9}
    values, options = np.linspace(0.1, 2.5, 9), {"starts": 1, "cycles": (4, 2), "exponents": False}
    figure = plots.bifurcation_picture(rk.bifurcation(BLOCK, excitation, "amplitude", values, both, **options))
    texts, lines = drawn(figure.axes[0])
    assert texts == ["Housner", "Melnikov", "fold", "no impact", "one impact", "tangency", "uplift"]
    for exact in (1.0, 1.386750490563072805, 1.8007239305607457817, math.sqrt(5.0)):
        assert min(abs(line - exact) for line in lines) < 1e-12
    assert min(abs(line - 1.386750490563072805) for line in drawn(figure.axes[1])[1]) > 0.01  # of another coefficient
    frequencies = rk.bifurcation(BLOCK, excitation, "frequency", [1.0, 2.0], 0.5, **options)
    assert drawn(plots.bifurcation_picture(frequencies).axes[0]) == ([], [])
    eroded = plots.basins_picture(rk.basin(BLOCK, excitation, both, amplitudes=values, phases=3, speeds=3, check=False))
    assert drawn(eroded.axes[0])[0] == ["Melnikov", "Melnikov", "tangency", "tangency"]
    from_rest = plots.basins_picture(rk.basin(BLOCK, excitation, 0.5, amplitudes=values, phases=3, speeds=0))
    assert drawn(from_rest.axes[0], is_upright=True)[0] == ["Housner", "no impact", "one impact", "uplift"]
    by_speed = rk.basin(
        BLOCK, excitation, SpeedRestitution([0.0, 1.0], [0.9, 0.7]), amplitudes=values, phases=3, speeds=0
    )
    assert drawn(plots.basins_picture(by_speed).axes[0], is_upright=True) == (["uplift"], [1.0])


JOB = """
[campaign]
name = "basin"
kind = "basins"
chunk = 500
[body]
units = "m"
width = 1.0
height = 4.0
[restitution]
models = ["housner", "ked"]
[basins]
amplitudes = [0.9, 1.5]
phases = {phases}
speeds = {phases}
impacts = {impacts}
"""


@pytest.mark.slow
def test_a_campaign_resumes_after_a_kill(tmp_path):
    """A basin whose process is killed goes on where it stood, and ends with the same results."""
    (tmp_path / "job.toml").write_text(JOB.format(phases=60, impacts=300), encoding="utf-8")
    words = [sys.executable, "-m", "rocking", "campaign", "run", tmp_path / "job.toml", "--output", tmp_path / "c"]
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_for(
        lambda: (
            (tmp_path / "c" / "job.toml").exists()
            and (begun := status_of(tmp_path / "c", verify=False).status)
            and begun.histories_done
        )
    )
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    done = status_of(tmp_path / "c").status.histories_done
    assert 0 < done < 14400
    folder = JobFolder.open(tmp_path / "c")
    assert folder.run().resumed > 0
    assert status_of(tmp_path / "c").complete
    whole = folder.campaign.results()
    alone = folder.job.problem.answer()
    assert np.array_equal(whole["final_state"], alone["final_state"].values.ravel())


def as_toml(tables):
    """Return the text of tables of numbers, words and lists."""
    lines = [
        line
        for name, table in tables.items()
        for line in (f"[{name}]", *(f"{key} = {json.dumps(value)}" for key, value in table.items()))
    ]
    return "\n".join(lines)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "table"),
    [
        ("bifurcation", {"values": [0.9, 1.2], "starts": 2, "settled": 20, "kept": 4}),
        ("orbits", {"points": 20, "doublings": 1}),
        ("lyapunov", {"orbits": 3, "settled": 60, "kept": 20}),
        ("basins", {"phases": 4, "speeds": 4}),
    ],
)
def test_jobs_have_results_and_pictures(kind, table, tmp_path):
    """Each kind is a campaign with files and a picture, without ground motions."""
    tables = {"campaign": {"name": "a", "kind": kind}, "body": BODY, "restitution": {"models": ["ked", "housner"]}}
    document = question_in({**tables, kind: table})
    text = as_toml({**tables, kind: table})
    folder = JobFolder.create(tmp_path / "c", Job.of_text(text))
    folder.run()
    from rocking.campaigns.jobs import export

    for name in ("a.nc", "a.csv"):
        assert export(folder, tmp_path / name).stat().st_size > 100
    from rocking.plots.campaign import campaign_picture

    assert len(campaign_picture(folder).axes) > 0
    assert math.prod(document.sizes) == folder.campaign.plan.count
    assert json.loads((tmp_path / "a.csv.provenance.json").read_text())["kind"] == kind
    for odd in ({"motions": [{"pulse": ["sine:amplitude=1,period=1"]}]}, {kind: {**table, "frequency": -1.0}}):
        with pytest.raises(InvalidValueError):
            question_in({**tables, kind: table, **odd})
