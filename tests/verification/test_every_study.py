"""Every study for every body and motion: components of plane bodies, blocks with a depth, inventories, animations."""

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Part, Solid, box
from rocking.campaigns.jobs import Job, JobFolder, analyses
from rocking.decision.inventory import InventoryObject, assess
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.errors import InvalidValueError
from rocking.motions import with_vertical
from rocking.studies import minimum_overturning_acceleration, overturning_map, rocking_spectrum
from rocking.studies.fragility import fragility_analysis

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="studies")]

TIME = 0.02 * np.arange(80)
X, Y, Z = (
    rk.GroundMotion(size * np.sin(rate * TIME) * np.exp(-TIME), 0.02, name=name)
    for name, size, rate in (("x", 5.0, 8.0), ("y", 4.5, 11.0), ("z", 4.0, 17.0))
)
BLOCK = rk.Block(width=0.5, height=2.0, depth=0.7)


@pytest.mark.verifies("same bits", "the record that holds both components", within="exact")
def test_upright_components_of_plane_bodies():
    """x and z in every study of a plane body are one record with a vertical part; without it answers differ."""
    apart, whole = {"x": X, "z": Z}, with_vertical(X, Z)
    axes = (("scale", [1.0, 1.6, 2.4]), ("semi_diagonal", [0.5, 1.0]))

    def answers(motion):
        spectrum = rocking_spectrum(motion, [0.25], [1.5, 2.5], 0.9)
        least = minimum_overturning_acceleration(BLOCK, motion, 0.9, samples=12, bisections=0)
        stripes = fragility_analysis(BLOCK, [motion, motion], [4.0, 9.0], 0.9, friction=0.5)
        found = overturning_map(BLOCK, motion, *axes, 0.9)
        peaks = [each.peak_rotation.values for each in (found, spectrum)]
        return [*peaks, stripes.responses.rotation, least.acceleration]

    both, one, flat = answers(apart), answers(whole), answers(X)
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(both, one, strict=True))
    assert not any(np.array_equal(a, b, equal_nan=True) for a, b in zip(both, flat, strict=True))


@pytest.fixture
def files(tmp_path, monkeypatch):
    """The records as files, and a folder to work in."""
    monkeypatch.chdir(tmp_path)
    for motion in (X, Y, Z):
        rows = (f"{t:.2f},{a:.17g}" for t, a in zip(TIME, motion.acceleration, strict=True))
        (tmp_path / f"{motion.name}.csv").write_text("\n".join(["time [s],acceleration [m/s2]", *rows]))
    return tmp_path


@pytest.mark.verifies("second engine", "the plane engine, where the ground hardly moves along y", within="1e-6")
def test_a_block_of_known_depth_moves_along_y(files, run, answered):
    """With y it is a box in space: a y of next to nothing leaves the plane answer, and one that shakes does not."""
    size = ("--width", "0.5", "--height", "2", "--depth", "0.6", "--restitution", "housner")
    axes = ("--x", "scale=0.8,1.0,1.2", "--y", "duration=1.6")
    still = 1e-9 * Y.acceleration
    head = "time [s],acceleration [m/s2]"
    np.savetxt(files / "still.csv", np.c_[TIME, still], "%.17g", ",", header=head, comments="")
    plane, calm, shaken = (
        np.array(answered("map", *size, "x.csv", *more, *axes)["peak_ratio"])
        for more in ((), ("--motion", "y=still.csv"), ("--motion", "y=y.csv"))
    )
    assert calm == pytest.approx(plane, rel=1e-6)
    assert shaken != pytest.approx(plane, rel=1e-3)
    box_in_space = Solid(Part(box(0.5, 0.6, 2.0), 2400.0))
    python = overturning_map(box_in_space, {"x": X, "y": Y}, ("scale", [0.8, 1.0, 1.2]), ("duration", [1.6]), "housner")
    assert shaken == pytest.approx(python.peak_ratio.values, rel=1e-6)
    _, _, err = run("map", *size[:4], "x.csv", "--motion", "y=y.csv", *axes)
    assert "section with a depth (--depth" in " ".join(err.split())


@pytest.mark.verifies("invariant", "the object turned by a quarter, under the motions as they are", within="1e-6")
def test_an_inventory_under_two_components():
    """Along its depth an object feels the leading component, the other across: as one with its sides exchanged."""
    hazard = Hazard.of_records([{"x": X, "y": Y, "z": Z}, {"x": Y, "y": X}], IntensityLevel("PGA", 3.3))
    assert [one.name for one in hazard.motions] == ["x", "x"]
    assert [one.peak for one in hazard.motions] == pytest.approx([3.3, 3.3])
    sizes = {"width": 0.3, "depth": 0.5, "height": 1.2, "friction": 0.5}
    swapped = {**sizes, "width": sizes["depth"], "depth": sizes["width"]}
    (one,), (turned,) = (
        assess([InventoryObject(name="chest", **each)], hazard, restitution=0.9).verdicts for each in (sizes, swapped)
    )
    for along, other in zip(one.results, turned.results[::-1], strict=True):
        assert along.high_rotation == pytest.approx(other.high_rotation, rel=1e-6)
        assert along.median_rotation == pytest.approx(other.median_rotation, rel=1e-6)
    alone = assess([InventoryObject(name="chest", **sizes)], Hazard.of_records(hazard.motions), restitution=0.9)
    assert one.results[1].high_rotation != pytest.approx(alone.verdicts[0].results[1].high_rotation, rel=0.1)


@pytest.mark.verifies("same bits", "the call in memory", within="exact")
def test_an_incremental_campaign_of_a_solid(files):
    """A job of an incremental analysis takes a solid, two components and friction; another friction differs."""
    (files / "body.toml").write_text(
        'units = "m"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.6, height = 1.4 }\ndensity = 2000\n'
    )
    job = "[campaign]\nname = 'a'\nkind = 'incremental'\n[body]\nfile = 'body.toml'\n[fragility]\nlevels = [4, 8]\n"
    job += "[restitution]\nvalue = 0.9\n[settings]\nfriction = 0.6\n"
    job += "[motions]\nx = { record = 'x.csv' }\ny = { record = 'y.csv' }\n"
    folder = JobFolder.create(files / "c", Job.of_text(job, folder=files))
    folder.run(workers=1)
    (found,) = analyses(folder).values()
    body, pair = Solid(Part(box(0.5, 0.6, 1.4), 2000.0)), {"x": X, "y": Y}
    python = fragility_analysis(body, [pair], [4.0, 8.0], 0.9, friction=0.6, analysis="incremental")
    assert np.array_equal(found.responses.rotation, python.responses.rotation)
    smooth = fragility_analysis(body, [pair], [4.0, 8.0], 0.9, friction=0.2, analysis="incremental")
    assert not np.array_equal(found.responses.rotation, smooth.responses.rotation)


@pytest.mark.verifies("damage")
def test_mass_at_one_point_is_no_body_that_slides():
    """A mass without a moment of inertia of its own is refused with friction, and rocks without."""
    point = rk.MassPoints([(0.0, 1.0)], [10.0], feet=(-0.2, 0.2))
    with pytest.raises(InvalidValueError, match="needs a moment of inertia about its centre"):
        rk.simulate(point, X, None, friction=0.3)
    assert rk.simulate(point, X, 0.9).outcome is not rk.Outcome.FAILED
