"""PEER AT2: its header variants, typed by hand, and what is refused."""

import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Source, formats

PEER = formats()["peer"]
VALUES = [0.1, -0.25, 0.3, 0.0, 0.05, -0.01, 0.02]
BODY = "  .1000000E+00 -.2500000E+00  .3000000E+00  .0000000E+00  .5000000E-01\n -.1000000E-01  .2000000E-01\n"
TOP = "A DATABASE\nSOMEWHERE 01/17/94 1231, CELLAR, 360 (STATION 12)\nACCELERATION TIME HISTORY IN UNITS OF G\n"
SIZE = "NPTS=  7, DT= .02000 SEC\n"


def _source(text: str) -> Source:
    return Source("hand.at2", text.encode("latin-1"))


@pytest.mark.parametrize(
    "size",
    [
        "NPTS=  7, DT= .02000 SEC",
        "NPTS=   7, DT=   .0200 SEC,                     ",
        "NPTS= 7, dt= 0.02 sec",
        "DT= .02000 SEC, NPTS= 7",
        "   7    0.0200    NPTS, DT",
        "7 .02 NPTS,DT (SEC)",
        "NPTS=   7, DT=   .0200 SEC,  -5 POLE @      .03000 HZ,   0 POLE @      .00000",
        "NPTS= 7, DT= .02 SECONDS., filtered",
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r\r\n"])
def test_header_variants(size: str, end: str) -> None:
    """Every way of stating size and step, and every line end, gives the same record."""
    source = _source((TOP + size + "\n" + BODY).replace("\n", end))
    assert PEER.recognises(source)
    part = PEER.read(source).components[0]
    assert (part.name, part.unit, part.time_step) == ("360", "g", 0.02)
    assert part.acceleration.tolist() == VALUES


def test_free_header_with_eight_columns_and_marks() -> None:
    """A free header may stand ahead; the marks around the data are passed over."""
    text = (
        "Somewhere\n7 points at equal spacing of 0.02 sec\nThe units are (g)\n*** Begin data ***\n" + SIZE
        + "0.1 -0.25 0.3 0.0 0.05 -0.01 0.02\n*** End Data ***\n\n"
    )  # fmt: skip
    record = PEER.read(_source(text))
    assert record.components[0].acceleration.tolist() == VALUES
    assert record.header.count("\n") == 4
    with pytest.raises(RecordError, match=r"line 2: 8 points at 0.02 s here, but 7"):
        PEER.read(_source(text.replace("7 points", "8 points")))
    # a header that states the step twice, 0.1 % or more apart, is damaged
    for spacing in (0.02002, 0.01999, 0.0205):
        with pytest.raises(RecordError, match="s here, but"):
            PEER.read(_source(text.replace("0.02 sec", f"{spacing} sec")))


@pytest.mark.parametrize("more", [0, 1, 2, 3])
def test_the_first_line_is_the_title(more: int) -> None:
    """Before the line of the size, however many there are; a file that begins with the size has none."""
    lines = [" A DATABASE ", "SOMEWHERE, 01/17/94, CELLAR, 360", "IN THE CELLAR", ""][: more + 1]
    record = PEER.read(_source("\n".join(lines) + "\n" + SIZE + BODY), units="g")
    assert record.metadata["title"] == "A DATABASE"
    assert "title" not in PEER.read(_source(SIZE + BODY), units="g").metadata


def test_two_samples_are_a_record_and_one_is_none() -> None:
    """The shortest record has two samples; a header that states one is refused with its line."""
    part = PEER.read(_source(TOP + "NPTS= 2, DT= .02 SEC\n .1 -.25\n")).components[0]
    assert part.acceleration.tolist() == [0.1, -0.25]
    with pytest.raises(RecordError, match="line 4: number of samples expected, found '1'"):
        PEER.read(_source(TOP + "NPTS= 1, DT= .02 SEC\n .1\n"))


def test_metadata_and_header_are_kept() -> None:
    """Event, date, station and filter are what the second and third lines say."""
    record = PEER.read(_source(TOP.replace("OF G", "OF G. FILTER POINTS: HP=0.2 Hz LP=15.0 Hz") + SIZE + BODY))
    assert record.metadata["event"] == "SOMEWHERE"
    assert record.metadata["station"] == "CELLAR"
    assert record.metadata["date"] == "01/17/94"
    assert record.metadata["filter"] == "high-pass 0.2 Hz, low-pass 15.0 Hz"
    assert record.header.startswith("A DATABASE\nSOMEWHERE")


DAMAGES = [
    ("NPTS=  7", "NPTS=  8", "states 8 samples, but the file contains 7"),
    ("NPTS=  7", "NPTS= 999999999", "states 999999999 samples"),
    ("NPTS=  7", "NPTS=  7x", "line 4: number of samples expected, found '7X'"),
    ("DT= .02000", "DT= .02O00", "line 4: time step expected"),
    ("DT= .02000", "DT= 0.0", "time step must be in"),
    ("UNITS OF G", "UNITS OF CM/SEC/SEC", "line 3: PEER accelerations are in g"),
    ("UNITS OF G", "UNITS OF G/10", "line 3: PEER accelerations are in g"),
    (" IN UNITS OF G", "", "add units="),
    ("-.2500000E+00", "-.25O0000E+00", "line 5: number expected"),
    ("-.2500000E+00", "nan", "line 5: number expected"),
    ("-.2500000E+00", "1e999", "line 5: number is too large"),
    ("-.2500000E+00", "", "line 6|contains 6"),
    # a velocity file looks the same but for its unit
    ("ACCELERATION TIME HISTORY IN UNITS OF G", "VELOCITY TIME SERIES IN UNITS OF CM/S", "'CM/S', a velocity; .*AT2"),
    ("ACCELERATION TIME HISTORY IN UNITS OF G", "DISPLACEMENT TIME SERIES IN CM", ", a displacement; .*AT2"),
    (".5000000E-01\n", ".5000000E-01\n\n.1\n", "line 8: 5 numbers per line expected"),
]


def test_damage_is_refused() -> None:
    """A count, step, unit or number that is damaged is refused, with its line where it has one."""
    refused(PEER, TOP + SIZE + BODY, DAMAGES)


@pytest.mark.parametrize(
    "text",
    [
        "Each file states NPTS= 4000, DT= .01 SEC in its fourth line.\n",
        "# Records\n\nThe header has NPTS and DT.\nNPTS=  7, DT= .02000 SEC\nis what it looks like.\n",
        "# Records\n\n" + SIZE + BODY + "These numbers were typed by hand.\n",
        "Records\n" + SIZE,
        "Records\n" + SIZE + "\n   \n",
        SIZE + BODY,
        TOP + "about NPTS=  7, DT= .02000 SEC or so\n" + BODY,
        TOP + "   7    0.0200    NPTS, DT\nand so on\n",
    ],
)
def test_prose_is_not_recognised(text: str) -> None:
    """A page that speaks of NPTS and DT is no PEER file: titles, one line of size, and numbers must follow."""
    assert not PEER.recognises(_source(text))
    with pytest.raises(RecordError):
        PEER.read(_source(text + "end of page\n"))


@pytest.mark.parametrize(("old", "new"), [("NPTS=  7", "NPTS=  7x"), ("-.1000000E-01", "-.1000O00E-01")])
def test_damaged_files_are_still_recognised(old: str, new: str) -> None:
    """One damaged number does not hide what a file is, so that the refusal names its line."""
    assert PEER.recognises(_source((TOP + SIZE + BODY).replace(old, new)))


def test_contradicting_user_is_refused() -> None:
    """The user cannot overrule the unit or step of the file."""
    with pytest.raises(RecordError, match="states the unit g, not m/s2"):
        PEER.read(_source(TOP + SIZE + BODY), units="m/s2")
    with pytest.raises(RecordError, match=r"time step of 0.02 s, not 0.01"):
        PEER.read(_source(TOP + SIZE + BODY), time_step=0.01)


def test_round_trip_converts_to_g(made_up) -> None:
    """Writing converts m/s2 to g by 9.80665, to 8 digits."""
    again = read_back(PEER, made_up("045", scale=3.0), 1.0 / 9.80665, rtol=1e-7)
    assert (again.metadata["event"], again.metadata["station"]) == ("Somewhere", "Cellar")
    with pytest.raises(RecordError, match="allows 1 to 1 components"):
        PEER.write(made_up("a", "b"))
