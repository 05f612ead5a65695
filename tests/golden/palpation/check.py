"""Holds a replay against the oracle of law.py and prints one line of JSON.

    python3 check.py SET MODEL REPLAYED

SET is the folder of the measurements, REPLAYED what `tractus replay` made of it with MODEL.

What can be compared. In a stiff wall the bent shank often has several places to rest, and where the one it is in ceases
to be (a snap), the published rule does not say to which of the others it goes: any solver's answer there is as good as
another's, and the difference lasts until the shank is free again. Whether a sample is one of those is found here without
the product: the oracle walks the whole path FOUR times, each in another numerical way (pseudo-time steps of three
lengths; from the last rest, from its extrapolation, from a rest moved by 1 um). A sample is *smooth* if the four agree to
1e-7 N. On smooth samples forces and deflections must agree with the product's to 1e-6 N.

On every sample that the product calls converged, smooth or not, two more things must hold: its forces are the law's at its
own deflection, and that deflection is a rest to the published 0.001 N.
"""
import csv
import json
import pathlib
import sys

import numpy as np

import law

WAYS = ("last rest", "last rest, short steps", "extrapolated", "last rest moved by 1 um, long steps")
SAME_N = 1e-7


def read_nrrd(path):
    head, data = path.read_bytes().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().split("\n")[1:])
    vectors = lambda text: np.array([[float(x) for x in v.strip("()").split(",")] for v in text.split()]) * 1e-3
    columns = vectors(fields["space directions"])
    spacing = np.linalg.norm(columns, axis=1)
    values = np.frombuffer(data, "<i2").reshape([int(n) for n in fields["sizes"].split()], order="F")
    return values.astype(float), spacing, vectors(fields["space origin"])[0], (columns / spacing[:, None]).T


def read_csv(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def columns(table, *names):
    return np.stack([table[name] for name in names], -1)


def walk(field, probe, paths):
    """The oracle along all paths at once, in each of the WAYS: delta and wrench at recorded times, [way][trial]."""
    trials, ways = len(paths), len(WAYS)
    steps = [len(path[0]) for path in paths]
    delta = np.zeros((ways, trials, 2))
    before = delta.copy()
    rng = np.random.default_rng(1)
    out = [[[] for _ in paths] for _ in WAYS]
    recorded = [set(path[2].tolist()) for path in paths]
    for s in range(max(steps)):
        p = np.array([path[0][min(s, n - 1)] for path, n in zip(paths, steps)])
        R = np.array([path[1][min(s, n - 1)] for path, n in zip(paths, steps)])
        start = delta.copy()
        start[2] = 2 * delta[2] - before[2]
        turn = rng.uniform(0, 2 * np.pi, trials)
        start[3] += 1e-6 * np.stack([np.cos(turn), np.sin(turn)], -1)
        before = delta.copy()
        tiled = np.tile(p, (ways, 1)), np.tile(R, (ways, 1, 1))
        lengths = np.repeat([1e-4, 1e-5, 1e-4, 1e-3], trials)
        flat, miss = probe.rest(field, *tiled, start.reshape(-1, 2), step_m=lengths)
        delta = flat.reshape(ways, trials, 2)
        wrench = probe.wrench(field, *tiled, flat).reshape(ways, trials, 6)
        miss = miss.reshape(ways, trials)
        for n in range(trials):
            if s < steps[n] and s in recorded[n]:
                for way in range(ways):
                    out[way][n].append(np.concatenate([delta[way, n], wrench[way, n], [miss[way, n]]]))
    return [[np.array(rows) for rows in way] for way in out]


def main():
    folder, model_path, replayed = map(pathlib.Path, sys.argv[1:4])
    index, model = json.loads((folder / "set.json").read_text()), json.loads(model_path.read_text())
    base = dict(model["base"])
    field = law.Field(*read_nrrd(folder / index["volume"]), model["transfer"], base.pop("field", "paper"))
    offset = np.array(base.pop("pose_offset_m", [0, 0, 0]))
    probe = law.Probe(**base)
    paths, ours = [], []
    for trial in index["trials"]:
        table = read_csv(folder / trial["file"])
        paths.append(law.motion(table["t_s"], columns(table, "px_m", "py_m", "pz_m") + offset,
                                columns(table, "qw", "qx", "qy", "qz")))
        ours.append(read_csv(replayed / "trials" / (trial["id"] + ".csv")))
    truth = walk(field, probe, paths)

    count = dict.fromkeys(("samples", "smooth", "in_contact", "smooth_in_contact", "converged"), 0)
    worst = dict.fromkeys(("smooth_force_N", "smooth_torque_Nm", "smooth_deflection_m", "law_force_N", "law_torque_Nm",
                           "rest_N"), 0.0)
    differences = []
    for n, (path, table) in enumerate(zip(paths, ours)):
        way = [truth[w][n] for w in range(len(WAYS))]
        wrench = columns(table, "fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm")
        delta = columns(table, "deflection_x_m", "deflection_y_m")
        spread = np.max([np.abs(w[:, 2:8] - way[0][:, 2:8]).max(1) for w in way], 0)
        rest = np.max([w[:, 8] for w in way], 0)
        smooth = (spread < SAME_N) & (rest < 1e-9)
        contact = np.linalg.norm(way[0][:, 2:5], axis=1) > 0.01
        converged = table["converged"] == 1
        p, R = path[0][path[2]], path[1][path[2]]
        off_law = np.abs(probe.wrench(field, p, R, delta) - wrench)
        miss = np.linalg.norm(probe.residual(field, p, R, delta), axis=1)
        count["samples"] += len(wrench)
        count["smooth"] += int(smooth.sum())
        count["in_contact"] += int(contact.sum())
        count["smooth_in_contact"] += int((smooth & contact).sum())
        count["converged"] += int(converged.sum())
        off = np.abs(wrench - way[0][:, 2:8])
        differences.append(off[smooth, :3].max(1))
        for name, values in (("smooth_force_N", off[smooth, :3]), ("smooth_torque_Nm", off[smooth, 3:]),
                             ("smooth_deflection_m", np.abs(delta - way[0][:, :2])[smooth]),
                             ("law_force_N", off_law[:, :3]), ("law_torque_Nm", off_law[:, 3:]),
                             ("rest_N", miss[converged])):
            worst[name] = max(worst[name], float(values.max(initial=0.0)))
    differences = np.concatenate(differences)
    print(json.dumps({**count, **{"worst_" + k: v for k, v in worst.items()},
                      "smooth_force_N_p50_p99": np.percentile(differences, [50, 99]).tolist(),
                      "largest_force_N": float(max(np.abs(columns(t, "fx_N", "fy_N", "fz_N")).max() for t in ours))}))


if __name__ == "__main__":
    main()
