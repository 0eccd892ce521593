"""The comparison with other restitution models: its headline, the ranges of groups, and its progress."""

import re

import pytest

from rocking.cli import page

PRISM = 'units = "m"\n[[solid.part]]\nbox = { width = 0.5, depth = 0.5, height = 2.0 }\n'
PULSES = "sine:amplitude=3.2,period=0.8", "sine:amplitude=3,period=0.5"
BLOCK = "--width", 0.5, "--height", 2
LEANING = "POLYGON ((0 0, 0.6 0, 0.6 1.0, 0.3 2.0, 0 2.0, 0 0))"
LEVELS = "--levels", "1,4"
FAMILY = "--synthetic", "firm-ground", "--count", 2


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("simulate", "BODY", *PULSES),
        ("histories", "BODY", PULSES[0], "--friction", 0.5),
        ("fragility", "BODY", *FAMILY, *LEVELS, "--friction", 0.5),
        ("overturning-pga", "BODY", PULSES[0], "--friction", 0.5, "--set", "minimum.max_pga=4"),
    ],
    ids=lambda words: words[0],
)
def test_the_model_of_a_solid_is_that_in_3d(run, file, words):
    body = file(PRISM, "prism.toml")
    out = run(*(body if word == "BODY" else word for word in words))[1]
    assert "calibrated-3d. It is the default because its plane form" in out


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "first"),
    [
        (("simulate", PULSES[0]), "calibrated "),
        (("assess", *FAMILY, "--pga", "0.3g"), "calibrated, low"),
    ],
    ids=["simulate", "assess"],
)
def test_coefficients_of_a_group_have_a_range_per_foot(run, file, words, first):
    command, *more = words
    out = run(command, file(LEANING, "body.wkt"), *more, "--units", "m")[1]
    lines = out.splitlines()
    row = next(line for line in lines if re.match(r"\d other models", line))
    ends = re.search(r" (0\.9\d+)-(0\.9\d+) / (0\.8\d+)-(0\.9\d+) ", row)
    assert ends is not None
    left_low, left_high, right_low, right_high = map(float, ends.groups())
    assert left_low < left_high
    assert right_low < right_high
    assert re.search(r" 0\.\d+ / 0\.\d+ ", next(line for line in lines if line.startswith(first)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "total"),
    [
        (("histories", *BLOCK, *PULSES), 6),
        (("histories", *BLOCK, *PULSES, "--restitution", "ked"), 2),
        (("fragility", *BLOCK, *FAMILY, *LEVELS), 12),
    ],
)
def test_progress_counts_the_compared_models(run, monkeypatch, words, total):
    counted = []

    def bar(what, count=None, *, quiet=False):
        counted.append(count)
        return page_bar(what, count, quiet=True)

    page_bar = page.bar
    monkeypatch.setattr(f"rocking.cli.{words[0]}.bar", bar)
    assert run(*words)[0] == 0
    assert counted == [total]
