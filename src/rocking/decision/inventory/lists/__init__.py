"""Lists in files: from a file to the objects of an inventory.

A file has sheets (`sheets.py`). A sheet has rows of cells. The header (`header.py`) is the rows with the titles of the
columns; `columns.py` contains the meaning of titles in eight languages. `cells.py` reads measures from cells, `rows.py`
reads the values of a row, and `reader.py` combines all of them.
"""
