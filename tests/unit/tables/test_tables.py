"""The container of results: cells, codes, streams; a grid and its rows say the same in every format."""

import csv

import numpy as np
import pytest
from scipy.io import loadmat

from rocking.errors import InvalidValueError
from rocking.quantities import QUANTITIES
from rocking.tables import (
    PIECE,
    Column,
    Grid,
    Table,
    safe_cell,
    text_array,
    to_csv,
    to_dataframe,
    to_excel,
    to_mat,
    to_netcdf,
    to_parquet,
)
from rocking.tables.table import written_whole

CODES = np.array([2, 0, 3, 1, 4, 77])


def grid(piece: int = 4) -> Grid:
    """Twelve histories over three motions and four scales, handed out a few at a time."""
    values = {"outcome": np.arange(12) % 4, "peak_rotation": np.where(np.arange(12) == 5, np.nan, np.arange(12) / 7.0)}

    def arrays():
        for first in range(0, 12, piece):
            yield first, min(first + piece, 12), {name: v[first : first + piece] for name, v in values.items()}

    coordinates = {
        "motion": Column(text_array(["a", "=b()", "c"]), "1", "name", dims=("motion",)),
        "scale": Column(np.array([1.0, 2.0, 3.0, 4.5]), "1", "factor", dims=("scale",)),
        "pga": Column(np.arange(12.0).reshape(3, 4), "m/s2", "strength", dims=("motion", "scale")),
    }
    types = {"outcome": np.int64, "peak_rotation": np.float64}
    return Grid("histories", {"motion": 3, "scale": 4}, coordinates, types, arrays, {"provenance": "{}", "a": 1})


def read(path):
    """Header and rows of a CSV file."""
    with path.open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    return header, rows


def test_codes_stand_with_their_words(tmp_path):
    """After a column of codes comes one that says what they stand for; a number that is no code has no word."""
    header, rows = read(to_csv(Table("row", {"outcome": Column.of("outcome", CODES)}), tmp_path / "o.csv"))
    known = QUANTITIES["outcome"].codes
    assert header == ["outcome", "outcome_meaning"]
    assert rows == [[str(code), known.get(code, "")] for code in CODES.tolist()]


@pytest.mark.parametrize("piece", [1, 5, 12])
def test_rows_of_a_grid_do_not_depend_on_its_pieces(tmp_path, piece):
    """Whatever the pieces, rows run through the last dimension first, with what is known along each."""
    header, rows = read(to_csv(grid(piece), tmp_path / "g.csv"))
    assert header == ["motion", "scale", "pga [m/s2]", "outcome", "outcome_meaning", "peak_rotation [rad]"]
    assert [row[0] for row in rows] == ["a"] * 4 + ["'=b()"] * 4 + ["c"] * 4
    assert [float(row[1]) for row in rows] == [1.0, 2.0, 3.0, 4.5] * 3
    assert [float(row[2]) for row in rows] == list(range(12))
    assert [row[5] for row in rows] == ["" if k == 5 else repr(k / 7.0) for k in range(12)]


def test_a_grid_is_the_same_in_every_format(tmp_path):
    """Parquet, Excel, MATLAB and netCDF hold what CSV holds."""
    parquet, openpyxl = pytest.importorskip("pyarrow.parquet"), pytest.importorskip("openpyxl")
    xarray = pytest.importorskip("xarray")
    wanted = np.where(np.arange(12) == 5, np.nan, np.arange(12) / 7.0)
    to_parquet(grid(), tmp_path / "g.parquet")
    to_excel([("histories", grid())], tmp_path / "g.xlsx", {"a": "=1"})
    to_mat(grid(), tmp_path / "g.mat", "campaign")
    to_netcdf(grid(), tmp_path / "g.nc")
    table = parquet.read_table(tmp_path / "g.parquet")
    assert table["motion"].to_pylist() == ["a"] * 4 + ["=b()"] * 4 + ["c"] * 4
    assert np.array_equal(table["peak_rotation"].to_numpy(), wanted, equal_nan=True)
    book = openpyxl.load_workbook(tmp_path / "g.xlsx")
    assert [row[4] for row in book["histories"].iter_rows(min_row=2, values_only=True)] == [
        QUANTITIES["outcome"].codes[k % 4] for k in range(12)
    ]
    assert book["provenance"]["B1"].value == "'=1"
    found = loadmat(tmp_path / "g.mat", simplify_cells=True)["campaign"]["results"]["peak_rotation"]
    assert np.array_equal(found, wanted.reshape(3, 4), equal_nan=True)
    data = xarray.load_dataset(tmp_path / "g.nc", engine="h5netcdf")
    assert np.array_equal(data["peak_rotation"].values, wanted.reshape(3, 4), equal_nan=True)
    assert data["outcome"].attrs["flag_meanings"].split() == list(QUANTITIES["outcome"].codes.values())
    assert data["pga"].dims == ("motion", "scale")


def test_cells_come_piece_by_piece():
    """A table longer than a piece has all its rows, in order."""
    table = Table("row", {"x": Column(np.arange(PIECE + 3))})
    assert [cell for (cell,) in table.cells()] == list(range(PIECE + 3))


def test_a_frame_has_the_headings_of_the_file(tmp_path):
    """pandas and CSV agree on headings, codes with their words."""
    pytest.importorskip("pandas")
    table = Table("row", {"outcome": Column.of("outcome", CODES), "x": Column(CODES * 0.5, "m")}, no_unit="-")
    frame = to_dataframe(table)
    assert list(frame.columns) == read(to_csv(table, tmp_path / "t.csv"))[0]
    assert frame["x [m]"].tolist() == (CODES * 0.5).tolist()


def test_tables_of_cells_refuse_what_would_be_lost():
    """Headings that stand twice, and numbers that are none."""
    with pytest.raises(InvalidValueError, match="headings of a table must differ, got a, a"):
        Table.of_rows("row", ("a", "a"), [(1, 2)])
    for bad in (np.nan, np.inf):
        with pytest.raises(InvalidValueError, match="must be finite"):
            Table.of_rows("row", ("a",), [(bad,)])
        with pytest.raises(InvalidValueError, match="must be finite"):
            safe_cell(bad)


def test_a_file_is_whole_or_not_there(tmp_path):
    """What was there stays until all of the new is written; what broke off leaves nothing behind."""
    path = tmp_path / "a.csv"
    for text in ("old", "new"):
        with written_whole(path) as unfinished:
            unfinished.write_text(text, "utf-8")
            assert (path.read_text("utf-8") if path.exists() else "") == ("" if text == "old" else "old")
    with pytest.raises(KeyError), written_whole(path) as unfinished:  # noqa: PT012 - breaks off after half
        unfinished.write_text("half", "utf-8")
        raise KeyError
    assert path.read_text("utf-8") == "new"
    assert list(tmp_path.iterdir()) == [path]
