"""Results with units on their way out: one container, and one writer a format, through which every file is written."""

from rocking.tables.arrays import (
    add_to_netcdf,
    dataset_to_netcdf,
    grid_to_mat,
    grid_to_netcdf,
    structure_of,
    to_dataset,
    to_mat,
)
from rocking.tables.rows import to_csv, to_dataframe, to_excel, to_parquet
from rocking.tables.table import PIECE, Cell, Column, Grid, Table, blocks, escaped, safe_cell, target_of, text_array

__all__ = [
    "PIECE",
    "Cell",
    "Column",
    "Grid",
    "Table",
    "add_to_netcdf",
    "blocks",
    "dataset_to_netcdf",
    "escaped",
    "grid_to_mat",
    "grid_to_netcdf",
    "safe_cell",
    "structure_of",
    "target_of",
    "text_array",
    "to_csv",
    "to_dataframe",
    "to_dataset",
    "to_excel",
    "to_mat",
    "to_parquet",
]
