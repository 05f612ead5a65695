"""Holds the reader of MATLAB files and the conversion of EMPS against files made by hand."""
import json
import pathlib
import struct
import sys
import tempfile
import unittest
import zlib

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import recordings  # noqa: E402


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def matrix(name, values):
    """A double matrix with one column as the format's document lays it out; short names are packed."""
    short = struct.pack("<HH", 1, len(name)) + name.encode().ljust(4, b"\0") if len(name) <= 4 else None
    return element(14, element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", len(values), 1))
                   + (short or element(1, name.encode())) + element(9, np.asarray(values, "<f8").tobytes()))


def mat_file(folder, arrays, compressed):
    head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"
    body = b""
    for name, values in arrays.items():
        packed = zlib.compress(matrix(name, values))
        body += struct.pack("<II", 15, len(packed)) + packed if compressed else matrix(name, values)
    path = pathlib.Path(folder) / "DATA_EMPS.mat"
    path.write_bytes(head + body)
    return path


class Recordings(unittest.TestCase):
    def test_arrays_of_both_kinds_of_file_are_read(self):
        for compressed in (False, True):
            with tempfile.TemporaryDirectory() as folder:
                got = recordings.mat_arrays(mat_file(folder, {"qm": [1.5, -2.0], "long_name": [3.0]}, compressed))
            self.assertEqual(sorted(got), ["long_name", "qm"])
            np.testing.assert_array_equal(got["qm"], [[1.5], [-2.0]])

    def test_emps_becomes_trials_in_newtons(self):
        t = np.arange(6000) * 1e-3
        with tempfile.TemporaryDirectory() as folder:
            mat_file(folder, {"t": t, "qm": 0.1 * t, "vir": np.full(6000, 2.0)}, True)
            made = recordings.emps_recording(pathlib.Path(folder), pathlib.Path(folder) / "out")
            rows = (made.measurements / "part01.csv").read_text().splitlines()
            index = json.loads((made.measurements / "set.json").read_text())
            layer = json.loads(made.model.read_text())["base"]["layers"][0]
        self.assertEqual(rows[1], "0.000000,0.05000000,70.30000")  # 2 V of 35.15 N/V
        self.assertEqual([trial["id"] for trial in index["trials"]], ["part01", "part02"])
        self.assertEqual(len(rows), 2501)
        self.assertEqual((layer["start_m"], layer["thickness_m"]), (0.0, 1.0))  # all that a model file may hold

    def test_without_the_files_one_line_says_where_they_come_from(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(SystemExit) as said:
            recordings.emps_recording(pathlib.Path(folder), pathlib.Path(folder) / "out")
        self.assertIn("nonlinearbenchmark.org", str(said.exception))

    def test_the_recordings_of_the_repository_are_there_with_their_licences(self):
        for recording in recordings.IN_REPOSITORY:
            self.assertTrue(recording.model.is_file() and (recording.measurements / "set.json").is_file())
            self.assertIn("icen", (recording.model.parent / "README.md").read_text())


if __name__ == "__main__":
    unittest.main()
