#!/usr/bin/env python3
"""Makes probing sets that only turn from runs of the MRD Lab's tool characterisation.

    convert.py [--drum R] FOLDER_WITH_TXT OUT_FOLDER

A run's .TXT: lines that begin with % are its header; then 1 kHz rows of ten comma-separated columns
(the source's README). Taken are
    t_s        column 1, seconds (the header says ms, the values are seconds)
    theta_rad  column 2, back-end encoder, 2 pi / 8192 a count, from the middle of its course
    tz_Nm      minus column 3, back-end torque, 3.9811e-5 N.m a count: the sensor says what the tool
               does to the motor, a set what the hand does to the probe
    front_theta_rad, front_tz_Nm  columns 5 and 6, the other end; kept for people, ignored by the lab
Five rows are averaged into one (200 Hz): the motion is a sine of at most 0.5 Hz.

--drum R (metres) writes the same as a cable on a drum of that radius: x_m = R (theta + 0.6 rad), so that
it is never negative, and fz_N = tz / R, for the effects of the catalogue that act along x. The physics is
the same, seen along the cable: 1 N of friction there is R newton-metres of it on the axis.

A run XY turns at 0.1 (X + 1) Hz, by 30 degrees, against a reaction torque of 10 % (Y = 0) or 100 %
(Y = 9). Sets: slow and fast at each of the two loads.
"""
import argparse
import json
import math
from pathlib import Path

AVERAGED = 5
SETS = {
    "light_slow": ["10"],
    "light_fast": ["30", "40"],
    "loaded_slow": ["19"],
    "loaded_fast": ["39", "49"],
}
PREFIX = "Tool_4_Maryland_L_4_"


def rows_of(path):
    with open(path, encoding="ascii") as file:
        for line in file:
            if not line.startswith("%") and line.strip():
                yield [float(cell) for cell in line.split(",")]


def converted(path):
    back, torque, front, front_torque = 2 * math.pi / 8192, 3.9811e-5, 2 * math.pi / 4000, 3.9811e-5
    rows = [
        (r[0], back * r[1], -torque * r[2], front * r[4], front_torque * r[5]) for r in rows_of(path)
    ]
    middle = 0.5 * (max(r[1] for r in rows) + min(r[1] for r in rows))
    out = []
    for k in range(0, len(rows) - AVERAGED + 1, AVERAGED):
        mean = [sum(r[c] for r in rows[k : k + AVERAGED]) / AVERAGED for c in range(5)]
        out.append((mean[0], mean[1] - middle, *mean[2:]))
    return out


def csv_of(rows, drum_m):
    if drum_m is None:
        yield "t_s,theta_rad,tz_Nm,front_theta_rad,front_tz_Nm"
        for row in rows:
            yield "%.4f,%.6f,%.6f,%.6f,%.6f" % row
    else:
        yield "t_s,x_m,fz_N"
        for row in rows:
            yield "%.4f,%.8f,%.5f" % (row[0], drum_m * (row[1] + 0.6), row[2] / drum_m)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--drum", type=float)
    parser.add_argument("source", type=Path)
    parser.add_argument("target", type=Path)
    asked = parser.parse_args()
    for name, runs in SETS.items():
        folder = asked.target / name
        folder.mkdir(parents=True, exist_ok=True)
        trials = []
        for run in runs:
            rows = converted(asked.source / f"{PREFIX}{run}.TXT")
            text = "\n".join(csv_of(rows, asked.drum)) + "\n"
            (folder / f"run{run}.csv").write_text(text, encoding="ascii")
            speed, load = 0.1 * (int(run[0]) + 1), {"0": 10, "9": 100}[run[1]]
            trials.append({"id": f"run{run}", "file": f"run{run}.csv", "operator": "",
                           "notes": f"sine of {speed:.1f} Hz, reaction torque {load} %"})
        seen = "" if asked.drum is None else f", along a cable on a drum of {1e3 * asked.drum:g} mm"
        (folder / "set.json").write_text(json.dumps({
            "format": "tractus-measurements/1", "rig": "probing",
            "name": f"cable-driven tool, {name.replace('_', ', ')}{seen}",
            "source": "github.com/MRDLab/mis-tool-characterization, ODbL 1.0",
            "trials": trials}, indent=1) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
