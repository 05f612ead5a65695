"""A cohort in a zip (tractus-cohort/1), as the server exports it."""
import json
import zipfile

from .arrays import parse_npy
from .errors import TractusError
from .hdf5 import write_hdf5
from .tables import kinds_in, parse_table


class Cohort:
    """Tables at once, samples when they are asked for: a cohort may be larger than the memory."""

    def __init__(self, path):
        try:
            self._zip = zipfile.ZipFile(path)
            self.about = json.loads(self._zip.read("cohort.json"))
        except (OSError, KeyError, ValueError, zipfile.BadZipFile) as reason:
            raise TractusError(f"{path}: not a cohort of Tractus: {reason}") from None
        if self.about.get("format") != "tractus-cohort/1":
            raise TractusError(f"{path}: format {self.about.get('format')!r}, expected 'tractus-cohort/1'")
        self._kinds = kinds_in(self.text("dictionary.csv"))
        self.summary, self.trials, self.scores = (self._table(name) for name in ("summary", "trials", "scores"))

    def text(self, name):
        """A file of the cohort, for example dictionary.csv."""
        return self._zip.read(name).decode("utf-8")

    def _table(self, name):
        return parse_table(self.text(f"{name}.csv"), lambda column: self._kinds.get((name, column), "text"))

    def trials_with_samples(self):
        return sorted(name[8:-4] for name in self._zip.namelist() if name.startswith("samples/"))

    def samples(self, trial):
        """The array of one trial: a row per sample, columns as dictionary.csv describes them."""
        with self.open_samples(trial) as file:
            return parse_npy(file.read(), file.name)

    def open_samples(self, trial):
        """The array of one trial as a file to be read."""
        name = f"samples/{trial}.npy"
        if name not in self._zip.NameToInfo:
            raise TractusError(f"trial {trial}: this export has no samples of it")
        return self._zip.open(name)

    def write_hdf5(self, to):
        """Writes all of it to one HDF5 file; needs h5py. See hdf5.py for what is where."""
        write_hdf5(self, to)

    def columns(self, trial):
        """Names of the columns of a trial's array."""
        rig = next(row["rig"] for row in self.trials if row["trial"] == trial)
        return [column for table, column in self._kinds if table == rig]

    def close(self):
        self._zip.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def read_cohort(path):
    return Cohort(path)
