"""Holds a replay against the oracle of law.py and prints one line of JSON.

    python3 check.py SET MODEL REPLAYED

SET is the folder of the measurements, REPLAYED what `tractus replay` made of it with MODEL.

What can be compared. In a stiff wall the bent shank often has several places to rest within a fraction of a voxel. Which of
them is taken then depends on how the solver moves, and where the one it is in ceases to be (a snap), the published rule
says neither to which of the others it goes, nor when: it takes any place where the forces sum up to less than 0.001 N for
a rest, so a shank may stay at a place that has just ceased to be one. Whether a sample is one of those is found here without
the product. The oracle walks the whole path in FIVE ways: from the last rest; from its extrapolation; twice from the last
rest moved by 0.05 to 0.3 mm (up to most of a voxel, in opposite directions, turned at random at every step), all to
1e-10 N; and stopping at 0.001 N as printed. A sample is *smooth* if the first four agree to 1e-7 N; if the fifth has not
stayed behind (0.001 N moves the free tip by 20 um, so it must lie within 25 um of them); if the rest is no flat one (in no
direction less than half as stiff as the free shank); and if there is no other place round it that the published rule would
take: from 16 starts up to 0.25 mm away one comes, stopping at 0.001 N, within 50 um of it. On smooth samples forces must
agree with the product's to 1e-6 N.

On every sample that the product calls converged, smooth or not, two more things must hold: its forces are the law's at its
own deflection, and that deflection is a rest to the published 0.001 N.
"""
import csv
import json
import pathlib
import sys

import numpy as np

import law

MOVED = 2
WAYS = 3 + MOVED  # last rest, extrapolated, moved ..., the published stop
SAME_N, BEHIND_M, ALONE_M = 1e-7, 25e-6, 50e-6
STOPS_N = [1e-10] * (WAYS - 1) + [1e-3]


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
    """The oracle along all paths at once, in all the ways: delta and wrench at recorded times, [way][trial]."""
    trials, ways = len(paths), WAYS
    steps = [len(path[0]) for path in paths]
    delta = np.zeros((ways, trials, 2))
    before = delta.copy()
    rng = np.random.default_rng(1)
    out = [[[] for _ in paths] for _ in range(WAYS)]
    recorded = [set(path[2].tolist()) for path in paths]
    for s in range(max(steps)):
        p = np.array([path[0][min(s, n - 1)] for path, n in zip(paths, steps)])
        R = np.array([path[1][min(s, n - 1)] for path, n in zip(paths, steps)])
        start = delta.copy()
        start[1] = 2 * delta[1] - before[1]
        turn = rng.uniform(0, 2 * np.pi, trials) + np.pi * np.arange(MOVED)[:, None]
        reach = rng.uniform(0.05e-3, 0.3e-3, (MOVED, trials, 1))
        start[2:2 + MOVED] += reach * np.stack([np.cos(turn), np.sin(turn)], -1)
        before = delta.copy()
        tiled = np.tile(p, (ways, 1)), np.tile(R, (ways, 1, 1))
        flat, miss = probe.rest(field, *tiled, start.reshape(-1, 2), tolerance_N=np.repeat(STOPS_N, trials))
        delta = flat.reshape(ways, trials, 2)
        wrench = probe.wrench(field, *tiled, flat).reshape(ways, trials, 6)
        miss = miss.reshape(ways, trials)
        for n in range(trials):
            if s < steps[n] and s in recorded[n]:
                for way in range(ways):
                    out[way][n].append(np.concatenate([delta[way, n], wrench[way, n], [miss[way, n]]]))
    return [[np.array(rows) for rows in way] for way in out]


def alone(field, probe, p, R, rest_m):
    """Is each rest the only place around that the published rule would take?"""
    turn = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([np.cos(turn), np.sin(turn)], -1)
    yes = np.ones(len(p), bool)
    for reach in (0.12e-3, 0.25e-3):
        for way in reach * ring:
            end, _ = probe.rest(field, p[yes], R[yes], rest_m[yes] + way, tolerance_N=1e-3)
            yes[yes] = np.linalg.norm(end - rest_m[yes], axis=1) < ALONE_M
    return yes


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
        way = [truth[w][n] for w in range(WAYS)]
        wrench = columns(table, "fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm")
        delta = columns(table, "deflection_x_m", "deflection_y_m")
        spread = np.max([np.abs(w[:, 2:8] - way[0][:, 2:8]).max(1) for w in way[:-1]], 0)
        rest = np.max([w[:, 8] for w in way[:-1]], 0)
        behind = np.linalg.norm(way[-1][:, :2] - way[0][:, :2], axis=1)
        contact = np.linalg.norm(way[0][:, 2:5], axis=1) > 0.01
        converged = table["converged"] == 1
        p, R = path[0][path[2]], path[1][path[2]]
        J = probe.jacobian(field, p, R, way[0][:, :2])
        stiff = np.linalg.eigvalsh((J + J.transpose(0, 2, 1)) / 2)[:, 0] > 0.5 * probe.k
        smooth = (spread < SAME_N) & (rest < 1e-9) & (behind < BEHIND_M) & stiff
        smooth[smooth] = alone(field, probe, p[smooth], R[smooth], way[0][smooth, :2])
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
