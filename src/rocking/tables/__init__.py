"""Tables of results with units, and one writer per file format."""

from rocking.tables.arrays import add_to_netcdf, to_dataset, to_mat, to_netcdf
from rocking.tables.datasets import save
from rocking.tables.rows import to_csv, to_dataframe, to_excel, to_parquet
from rocking.tables.table import PIECE, Cell, Column, Grid, Table, escaped, prefixed, safe_cell, target_of, text_array

__all__ = [
    "PIECE",
    "Cell",
    "Column",
    "Grid",
    "Table",
    "add_to_netcdf",
    "escaped",
    "prefixed",
    "safe_cell",
    "save",
    "target_of",
    "text_array",
    "to_csv",
    "to_dataframe",
    "to_dataset",
    "to_excel",
    "to_mat",
    "to_netcdf",
    "to_parquet",
]
