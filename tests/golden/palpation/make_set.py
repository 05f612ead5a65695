"""Makes a small palpation set: a bone block with a drilled tract (NRRD), seeded strokes, set.json, model.json.

    python3 make_set.py FOLDER [--seed 7] [--seconds 1.5] [--trials 12] [--measured]

Everything is simulated. Without --measured the force columns hold the sensor's noise alone; with it, what the law in
law.py gives for a softer bone and a stiffer shank (so that a replay with the published numbers is visibly wrong), noise
added. The block lies oblique and off the origin, so that no axis of any frame coincides with another's.
"""
import argparse
import json
import pathlib

import numpy as np

import law

DIMS, SPACING = (44, 48, 60), np.array([0.40e-3, 0.42e-3, 0.45e-3])
RADIUS, LENGTH = 1.6e-3, 16e-3
RATES = (100, 4000, 100, 1000, 250, 100)
TRANSFER = [[150, 0], [700, 1]]


def turn(axis, angle):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


DIRECTIONS = turn([1, 2, -1], 0.6)
ORIGIN = np.array([0.021, -0.034, 0.112])
AXIS = turn([0.3, 1, 0], 0.12) @ DIRECTIONS @ np.array([0, 0, -1.0])  # nearly along -k, into the bone
ENTRY = ORIGIN + DIRECTIONS @ (SPACING * np.array([22.3, 23.6, 51.2]))


def across(axis):
    side = np.cross(axis, [0.2, 1, 0.1])
    side /= np.linalg.norm(side)
    return side, np.cross(axis, side)


def bone(seed):
    """CT values [i, j, k]: a block with a blunt canal, a wall blurred over a voxel, pores as smooth waves, noise."""
    index = np.stack(np.meshgrid(*map(np.arange, DIMS), indexing="ij"), -1)
    p = ORIGIN + (index * SPACING) @ DIRECTIONS.T
    depth = (p - ENTRY) @ AXIS
    radial = np.linalg.norm(p - ENTRY - depth[..., None] * AXIS, axis=-1)
    canal = np.maximum(radial - RADIUS, depth - LENGTH)
    inside = np.minimum(canal, depth)  # > 0 in the bone, m
    solid = 1 / (1 + np.exp(-inside / 0.12e-3))
    waves = np.prod(np.sin((p - ENTRY) / np.array([0.9e-3, 1.1e-3, 1.0e-3]) + [0.3, 1.0, 2.0]), -1)
    noise = np.random.default_rng(seed).normal(0, 20, DIMS)
    return np.clip(np.round(-60 + solid * (900 + 650 * waves) + noise), -1000, 3000).astype(np.int16)


def write_nrrd(path, values):
    vector = lambda v: "(" + ",".join(repr(float(x * 1e3)) for x in v) + ")"
    columns = [DIRECTIONS[:, a] * SPACING[a] for a in range(3)]
    header = ["NRRD0004", "type: short", "dimension: 3", "space: left-posterior-superior",
              "sizes: " + " ".join(map(str, DIMS)), "space directions: " + " ".join(map(vector, columns)),
              "kinds: domain domain domain", "endian: little", "encoding: raw", "space origin: " + vector(ORIGIN)]
    path.write_bytes(("\n".join(header) + "\n\n").encode() + values.astype("<i2").tobytes(order="F"))


def stroke(rng, seconds, rate, kind, length_m):
    """Handle poses of one stroke: in, along the walls or against the end, and out. `kind` is "walls" or "end"."""
    t = np.arange(int(round(seconds * rate)) + 1) / rate
    s = t / seconds
    gate = np.clip(np.minimum(s, 1 - s) / 0.18, 0, 1)
    gate = gate**2 * (3 - 2 * gate)
    turns, phase = rng.uniform(0.8, 1.6), rng.uniform(0, 2 * np.pi)
    angle = phase + 2 * np.pi * turns * s
    if kind == "walls":
        depth = -1e-3 + gate * (rng.uniform(0.75, 0.9) * LENGTH + 1e-3) + gate * 1.5e-3 * np.sin(2 * np.pi * 2 * t)
        push = gate**3 * rng.uniform(2.0, 4.5) * 1e-3
    else:
        taps = np.maximum(0, np.sin(2 * np.pi * rng.uniform(3, 5) * t)) ** 2
        depth = -1e-3 + gate * (LENGTH + 0.2e-3) + gate**4 * rng.uniform(0.6, 1.0) * 1e-3 * taps
        push = gate**3 * rng.uniform(0.2, 0.8) * 1e-3
    tremor = sum(rng.normal(0, 8e-6, (3, 1)) * np.sin(2 * np.pi * rng.uniform(7, 12) * t + rng.uniform(0, 6))
                 for _ in range(3)).T
    side, up = across(AXIS)
    offset = push[:, None] * (np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * up)
    tip = ENTRY + depth[:, None] * AXIS + offset + tremor
    # The hand pivots some way above the entrance: the handle goes to the other side.
    pivot = ENTRY - 0.03 * AXIS
    roll = rng.uniform(0, 2 * np.pi)
    poses = []
    for target in tip:
        z = target - pivot
        z /= np.linalg.norm(z)
        x = np.cos(roll) * side + np.sin(roll) * up
        x -= z * (x @ z)
        x /= np.linalg.norm(x)
        poses.append((target - length_m * z, np.stack([x, np.cross(z, x), z], -1)))
    return t, np.array([p for p, _ in poses]), np.array([quaternion(R) for _, R in poses])


def quaternion(R):
    """w x y z of a rotation matrix, by its eigenvector: no case of a small trace."""
    K = np.array([[R[0, 0] - R[1, 1] - R[2, 2], R[1, 0] + R[0, 1], R[2, 0] + R[0, 2], R[2, 1] - R[1, 2]],
                  [0, R[1, 1] - R[0, 0] - R[2, 2], R[2, 1] + R[1, 2], R[0, 2] - R[2, 0]],
                  [0, 0, R[2, 2] - R[0, 0] - R[1, 1], R[1, 0] - R[0, 1]],
                  [0, 0, 0, R[0, 0] + R[1, 1] + R[2, 2]]])
    x, y, z, w = np.linalg.eigh((K + K.T - np.diag(np.diag(K))) / 3)[1][:, -1]
    return np.array([w, x, y, z]) * (1 if w >= 0 else -1)


def measured(values, trials):
    """What a sensor would say for another bone and shank, by law.py, sampled at the recorded times."""
    field = law.Field(values, SPACING, ORIGIN, DIRECTIONS, TRANSFER, "potential")
    probe = law.Probe(force_factor_Nm=0.0022, force_scale=0.3, torque_scale=0.3, radius_m=0.00085)
    paths = [law.motion(*trial) for trial in trials]
    delta, out = np.zeros((len(trials), 2)), [[] for _ in trials]
    for s in range(len(paths[0][0])):
        p, R = np.array([path[0][s] for path in paths]), np.array([path[1][s] for path in paths])
        delta, _ = probe.rest(field, p, R, delta, tolerance_N=1e-4)
        w = probe.wrench(field, p, R, delta)
        for n, path in enumerate(paths):
            if s in path[2]:
                out[n].append(w[n])
    return [np.array(w) for w in out]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--seconds", type=float, default=1.5)
    parser.add_argument("--trials", type=int, default=12)
    parser.add_argument("--field", default="paper")
    parser.add_argument("--measured", action="store_true")
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    args.folder.mkdir(parents=True)
    values = bone(args.seed)
    write_nrrd(args.folder / "bone.nrrd", values)
    trials = [stroke(rng, args.seconds, RATES[n % len(RATES)], "walls" if n % 2 == 0 else "end", 0.13)
              for n in range(args.trials)]
    wrenches = measured(values, trials) if args.measured else [np.zeros((len(t), 6)) for t, _, _ in trials]
    entries = []
    for n, ((t, p, q), w) in enumerate(zip(trials, wrenches)):
        w = w + rng.normal(0, [0.004] * 3 + [0.0002] * 3, w.shape)
        np.savetxt(args.folder / f"t{n:02}.csv", np.hstack([t[:, None], p, q, w]), delimiter=",", fmt="%.17g", comments="",
                   header="t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm")
        entries.append({"id": f"t{n:02}", "file": f"t{n:02}.csv", "operator": f"simulated hand {1 + n // 2 % 2}",
                        "notes": "walls" if n % 2 == 0 else "end"})
    index = {"format": "tractus-measurements/1", "rig": "palpation", "volume": "bone.nrrd", "simulated": True,
             "tract": {"entry_m": ENTRY.tolist(), "axis": AXIS.tolist(), "length_m": LENGTH}, "trials": entries}
    (args.folder / "set.json").write_text(json.dumps(index, indent=1))
    model = {"format": "tractus-model/1", "rig": "palpation", "name": "uniform cantilever", "transfer": TRANSFER,
             "base": {"field": args.field}}
    (args.folder / "model.json").write_text(json.dumps(model, indent=1))


if __name__ == "__main__":
    main()
