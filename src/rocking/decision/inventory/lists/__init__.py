"""Lists in files: from a file to the objects of an inventory.

A file has sheets (`sheets.py`). A sheet has rows of cells. The header (`header.py`) is the rows with the titles of the
columns; `columns.py` has the meaning of titles in eight languages. `cells.py` reads measures from cells, `rows.py` the
values of a row, and `reader.py` puts them together.
"""
