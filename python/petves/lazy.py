"""Arrays of HDF5 files that are read when they are used, for xarray."""

from pathlib import Path
from typing import Any

import numpy as np
from xarray.backends import BackendArray
from xarray.core import indexing

from petves.runfiles import read_h5


class FileArray(BackendArray):
    """The first rows of a dataset of an HDF5 file, open only while it is read; rows that are not written yet are NaN."""

    def __init__(self, path: Path, name: str, rows: int) -> None:
        self.path, self.name = path, name
        self.shape, self.dtype = read_h5(path, lambda file: ((rows, *file[name].shape[1:]), file[name].dtype))

    def __getitem__(self, key: indexing.ExplicitIndexer) -> np.ndarray:
        """Return a part, as xarray asks for it."""
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._part)

    def _part(self, key: tuple[Any, ...]) -> np.ndarray:
        """Return a part by integers and by slices with steps forward."""
        one = not isinstance(key[0], slice)
        rows = slice(*(slice(key[0], key[0] + 1) if one else key[0]).indices(self.shape[0]))
        values = read_h5(self.path, lambda file: file[self.name][(rows, *key[1:])])
        missing = len(range(rows.start, rows.stop, rows.step)) - len(values)
        values = np.concatenate([values, np.full((missing, *values.shape[1:]), np.nan, values.dtype)])
        return values[0] if one else values


def lazy_array(path: Path, name: str, rows: int) -> indexing.LazilyIndexedArray:
    """Return the first rows of a dataset as xarray takes them, read when they are used."""
    return indexing.LazilyIndexedArray(FileArray(path, name, rows))
