#!/usr/bin/env python3
"""Writes the recordings of a friction damper as a measurement set: inches to metres, kip to kN, four rows into one.

    convert.py FOLDER_WITH_JSON damper
FOLDER_WITH_JSON: `data/dataset-2/characterization datasets` of the source (README.md).
"""
import json
import pathlib
import sys

INCH_M, KIP_KN = 0.0254, 4.4482216  # exact; 1000 lbf
MIDDLE_M = 0.05  # added, so that the whole motion lies at positive depths
ROWS = 4  # of 1024 Hz into one of 256 Hz
RUNS = ["2Hz36lbtension0.5amplitude", "1Hz36lbtension0.5amplitude", "1Hz36lbtension1amplitude",
        "0.5Hz36lbtension0.5amplitude", "0.5Hz36lbtension1amplitude", "0.5Hz36lbtension1.5amplitude",
        "0.25Hz36lbtension0.5amplitude"]


def converted(rows):
    """Lines of t_s, x_m, fz_N, where fz_N holds kN: four rows averaged, rounded to 1 um and 0.0001."""
    for k in range(0, len(rows) - ROWS + 1, ROWS):
        t, x, force = (sum(row[i] for row in rows[k:k + ROWS]) / ROWS for i in range(3))
        yield f"{t:.6f},{MIDDLE_M + INCH_M * x:.6f},{KIP_KN * force:.4f}"


def main(source, target):
    target.mkdir(parents=True, exist_ok=True)
    trials = []
    for run in RUNS:
        rows = json.loads((source / f"{run}.json").read_text())["data"]
        name = run.replace("36lbtension", "_").replace("amplitude", "in")
        (target / f"{name}.csv").write_text("t_s,x_m,fz_N\n" + "\n".join(converted(rows)) + "\n")
        trials.append({"id": name, "file": f"{name}.csv"})
    index = {"format": "tractus-measurements/1", "rig": "probing", "name": "banded rotary friction damper, 36 lb",
             "simulated": False, "trials": trials}
    (target / "set.json").write_text(json.dumps(index, indent=1) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
