"""Bodies that would take long are refused in words before anything is made of them, and what is allowed is quick."""

import math
import time

import pytest

from rocking.app.errors import TooLarge
from rocking.app.schemas.inputs import CAPS, check_file

AT_MOST = 3.0
"""Seconds for an answer; one of an idle core takes less than one."""


def sheets(count):
    """Return a pile of thin slabs."""
    outlines = ([[0, k], [50, k], [50, k + 1], [0, k + 1]] for k in range(count))
    return {"units": "cm", "section": {"region": [{"outline": made, "density": 2000.0} for made in outlines]}}


def arches(count):
    """Return a wall on count + 1 feet."""
    made = [point for k in range(count) for point in ([2 * k, 0], [2 * k + 1, 0], [2 * k + 1.2, 1], [2 * k + 1.8, 1])]
    made += [[2 * count, 0], [2 * count + 1, 0], [2 * count + 1, 50], [0, 50]]
    return {"units": "m", "section": {"region": [{"outline": made, "density": 2000.0}]}}


def pierced(count):
    """Return a wall with a row of holes."""
    holes = [[[3 * k + 1, 1], [3 * k + 2, 1], [3 * k + 2, 2], [3 * k + 1, 2]] for k in range(count)]
    outline = [[0, 0], [3 * count + 1, 0], [3 * count + 1, 9], [0, 9]]
    return {"units": "m", "section": {"region": [{"outline": outline, "holes": holes, "density": 2000.0}]}}


def cloud(count):
    """Return points with mass on two feet."""
    points = [[math.cos(k), 1.5 + math.sin(k)] for k in range(count)]
    return {"units": "m", "mass_points": {"points": points, "masses": [1.0] * count, "feet": [-0.5, 0.5]}}


def disc(count):
    """Return a regular polygon."""
    return {"units": "m", "regular_polygon": {"sides": count, "radius": 1.0}}


def text(count):
    """Return squares in a pile, as a text."""
    squares = (f"((0 {k}, 50 {k}, 50 {k + 1}, 0 {k + 1}, 0 {k}))" for k in range(count))
    region = {"wkt": f"MULTIPOLYGON ({', '.join(squares)})", "units": "m", "density": 2000.0}
    return {"units": "m", "section": {"region": [region]}}


CASES = {
    "regions": (sheets, 250),
    "holes": (pierced, 500),
    "vertices": (disc, 10_000),
    "mass points": (cloud, 10_000),
    "stretches": (arches, 39),
    "text": (text, 250),
}


@pytest.mark.timed
@pytest.mark.parametrize("endpoint", ["body", "impact"])
@pytest.mark.parametrize(("make", "most"), CASES.values(), ids=CASES)
def test_the_largest_body_is_answered_and_one_more_is_refused(client, make, most, endpoint):
    """At the cap there is an answer within seconds; one above it a 413 that names both numbers."""
    start = time.perf_counter()
    assert client.post(f"/api/{endpoint}", json={"body": make(most)}).status_code == 200
    assert time.perf_counter() - start < AT_MOST + (4.0 if endpoint == "impact" else 0.0)  # the first one fits
    start = time.perf_counter()
    refused = client.post(f"/api/{endpoint}", json={"body": make(most + 1)})
    assert (refused.status_code, refused.json()["error"]["kind"]) == (413, "too-large")
    extra = 1 if make is arches else 0
    for number in (most + extra, most + extra + 1):
        assert str(number) in refused.json()["error"]["message"]
    assert time.perf_counter() - start < AT_MOST


def test_caps_are_told(client):
    """The API tells every cap among its limits."""
    assert CAPS.items() <= client.get("/api/info").json()["limits"].items()


@pytest.mark.parametrize(
    ("name", "piece"), [("a.wkt", b"1.25 2.5, "), ("a.json", b"[1.25, 2.5], "), ("a.dxf", b" 10\r\n1.25\r\n")]
)
def test_an_endless_body_file_is_not_read(client, name, piece):
    """A file of a hundred thousand points is refused at once; one of a thousand is left to the reader."""
    check_file(piece * 1000, name)
    with pytest.raises(TooLarge, match="vertices"):
        check_file(piece * 100_000, name)
    answer = client.post(
        f"/api/body/file?name={name}&units=m",
        content=piece * 100_000,
        headers={"Content-Type": "application/octet-stream"},
    )
    assert answer.status_code == 413
