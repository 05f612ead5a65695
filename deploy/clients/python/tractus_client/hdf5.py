"""A cohort as one HDF5 file (tractus-cohort-hdf5/1); needs h5py and NumPy.

/TABLE/COLUMN         trials, scores, summary: an array per column; text, numbers (NaN: no value), truth (1, 0; -1: no value)
/samples/TRIAL        doubles, a row per sample, in chunks; attributes `rig`, `columns`, `units`
Attributes of a column: `unit`, `meaning`. Attributes of the file: `format`, and the fields of cohort.json (`study` "" for all).
"""
import csv
import io
import os

from .arrays import npy_shape
from .errors import TractusError

FORMAT = "tractus-cohort-hdf5/1"
_CHUNK_BYTES = 1 << 20


def write_hdf5(cohort, to):
    """Writes what `read_cohort` read to the file `to`, which appears when it is whole: one chunk in memory at a time."""
    try:
        import h5py
    except ImportError:
        raise TractusError("HDF5 needs the package h5py") from None
    part = f"{to}.part"
    try:
        with h5py.File(part, "w") as file:
            _write(cohort, file)
        os.replace(part, to)
    finally:
        if os.path.exists(part):
            os.remove(part)


def _write(cohort, file):
    dictionary = list(csv.DictReader(io.StringIO(cohort.text("dictionary.csv"))))
    file.attrs["format"] = FORMAT
    for field in ("study", "tier", "trials_counted", "trials_listed"):
        if field in cohort.about:
            file.attrs[field] = "" if cohort.about[field] is None else cohort.about[field]
    meant = {(row["table"], row["column"]): row for row in dictionary}
    for name in ("summary", "trials", "scores"):
        for column in getattr(cohort, name).columns:
            _write_column(file, name, column, getattr(cohort, name), meant.get((name, column), {}))
    rigs = {row["trial"]: row["rig"] for row in cohort.trials}
    for trial in cohort.trials_with_samples():
        columns = [row for row in dictionary if row["table"] == rigs[trial]]
        samples = _write_samples(cohort, file, trial)
        samples.attrs["rig"] = rigs[trial]
        samples.attrs["columns"] = [row["column"] for row in columns]
        samples.attrs["units"] = [row["unit"] for row in columns]


def _write_column(file, table, column, rows, meant):
    import h5py
    import numpy
    cells, kind = [row[column] for row in rows], meant.get("type", "text")
    if kind in ("number", "integer"):
        values = numpy.array([numpy.nan if cell is None else cell for cell in cells], "<f8")
    elif kind == "truth":
        values = numpy.array([-1 if cell is None else int(cell) for cell in cells], "i1")
    else:
        values = numpy.array(["" if cell is None else str(cell) for cell in cells], h5py.string_dtype())
    made = file.create_dataset(f"{table}/{column}", data=values)
    made.attrs["unit"], made.attrs["meaning"] = meant.get("unit", ""), meant.get("meaning", "")


def _write_samples(cohort, file, trial):
    import numpy
    with cohort.open_samples(trial) as array:
        rows, columns = npy_shape(array, f"trial {trial}")
        chunk = max(1, min(rows, _CHUNK_BYTES // (8 * columns)))
        made = file.create_dataset(f"samples/{trial}", (rows, columns), "<f8", chunks=(chunk, columns) if rows else None)
        for first in range(0, rows, chunk):
            count = min(chunk, rows - first)
            made[first:first + count] = numpy.frombuffer(array.read(count * columns * 8), "<f8").reshape(count, columns)
    return made
