#!/usr/bin/env python3
"""Reads a cohort that GET /api/v1/export/cohort.zip gave (tractus-cohort/1) with nothing but Python itself.

    python3 read_cohort.py cohort.zip

Prints one line a table and one a trial's samples. In a notebook: trials, scores, samples = read("cohort.zip"); with pandas
pandas.DataFrame(trials), with NumPy numpy.load(zipfile.ZipFile("cohort.zip").open(name)).
"""
import ast
import csv
import io
import json
import struct
import sys
import zipfile


def table(archive, name):
    """Rows as dictionaries; numbers as numbers by dictionary.csv, what is not known as None."""
    with archive.open("dictionary.csv") as file:
        kinds = {(row["table"], row["column"]): row["type"] for row in csv.DictReader(io.TextIOWrapper(file, "utf-8"))}
    with archive.open(name) as file:
        rows = list(csv.DictReader(io.TextIOWrapper(file, "utf-8")))
    convert = {"number": float, "integer": int, "truth": lambda text: text == "1"}
    for row in rows:
        for column, text in row.items():
            kind = kinds[name.removesuffix(".csv"), column]
            row[column] = None if text == "" else convert.get(kind, str)(text)
    return rows


def array(archive, name):
    """A .npy file of version 1.0: a list of rows of floats."""
    data = archive.read(name)
    if data[:8] != b"\x93NUMPY\x01\x00":
        raise ValueError(f"{name}: not a .npy file of version 1.0")
    length = struct.unpack("<H", data[8:10])[0]
    head = ast.literal_eval(data[10:10 + length].decode("latin1"))
    if head["descr"] != "<f8" or head["fortran_order"]:
        raise ValueError(f"{name}: little-endian doubles row after row are expected")
    rows, columns = head["shape"]
    values = struct.unpack(f"<{rows * columns}d", data[10 + length:])
    return [values[row * columns:(row + 1) * columns] for row in range(rows)]


def read(path):
    with zipfile.ZipFile(path) as archive:
        about = json.loads(archive.read("cohort.json"))
        if about["format"] != "tractus-cohort/1":
            raise ValueError(f"{path}: not a tractus-cohort/1")
        samples = {name[8:-4]: array(archive, name) for name in archive.namelist() if name.startswith("samples/")}
        return table(archive, "trials.csv"), table(archive, "scores.csv"), samples


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: read_cohort.py cohort.zip")
    trials, scores, samples = read(sys.argv[1])
    people = {trial["participant"] for trial in trials}
    print(f"trials {len(trials)} participants {len(people)} scores {len(scores)}")
    for trial, rows in sorted(samples.items()):
        print(f"samples {trial} rows {len(rows)} columns {len(rows[0])} last_t_s {rows[-1][0]:.6f}")


if __name__ == "__main__":
    main()
