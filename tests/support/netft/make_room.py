"""A simulated measuring room: see README.md."""
import argparse
import csv
import json
import pathlib
import shutil

import numpy as np

TAPS_S = (2.0, 2.43, 2.80, 3.36, 3.71)  # uneven, as a hand's
TAP_N, CONTACT_S = 6.0, 0.03
LEAD_S = 5.0  # taps and a pause, before the trial's own motion
ZERO = np.array([0.7, -0.3, 1.1, 0.02, -0.01, 0.005])  # the sensor's


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def about(axis, angle):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])


def pose(R, p):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = R, p
    return X


def columns(path, names):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return np.array([[float(row[name]) for name in names] for row in rows])


def taps_before(X0, rate):
    """The handle above a solid surface: down along its own axis, a short contact, up again."""
    t = np.arange(0, LEAD_S, 1 / rate)
    way, force = np.zeros_like(t), np.zeros((len(t), 6))
    for tap in TAPS_S:
        near = np.abs(t - tap) < 0.16
        way[near] += 0.0125 * (1 + np.cos(np.pi * (t[near] - tap) / 0.16))
        hit = np.abs(t - tap) < CONTACT_S / 2
        force[hit, 2] -= TAP_N * np.cos(np.pi * (t[hit] - tap) / CONTACT_S)
    back = 0.04  # off the bone
    X = np.array([X0 @ pose(np.eye(3), [0.002 * np.sin(t_k), 0, w - 0.025 - back]) for t_k, w in zip(t, way)])
    return t, X, force


def approach(X0, rate):
    """From above the surface to where the trial begins, in a second."""
    s = np.arange(0, 1, 1 / rate)
    z = -0.065 * (1 + np.cos(np.pi * s)) / 2
    return s + LEAD_S, np.array([X0 @ pose(np.eye(3), [0, 0, z_k]) for z_k in z]), np.zeros((len(s), 6))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("set", type=pathlib.Path)
    parser.add_argument("replayed", type=pathlib.Path)
    parser.add_argument("trial")
    parser.add_argument("room", type=pathlib.Path)
    parser.add_argument("--offset", type=float, default=0.7321, help="s, of the sensor's clock after the capture's")
    parser.add_argument("--noise", type=float, default=0.03, help="N, per sample of the sensor")
    parser.add_argument("--every", type=int, default=5, help="samples of the force for one of the motion")
    parser.add_argument("--seed", type=int, default=3)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    recorded = columns(args.set / f"{args.trial}.csv", ["t_s", "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz"])
    wrench = columns(args.replayed / "trials" / f"{args.trial}.csv", ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"])
    rate = (len(recorded) - 1) / (recorded[-1, 0] - recorded[0, 0])
    X = np.array([pose(matrix(row[4:8]), row[1:4]) for row in recorded])
    t0, X0, f0 = taps_before(X[0], rate)
    t1, X1, f1 = approach(X[0], rate)
    t = np.concatenate([t0, t1, t1[-1] + 1 / rate + recorded[:, 0] - recorded[0, 0]])
    X_VH, f_H = np.concatenate([X0, X1, X]), np.concatenate([f0, f1, wrench])

    X_BH = pose(matrix(about([1, 2, 3], 0.7)), [0.012, -0.034, 0.056])   # from a CT of the handle
    X_BV = pose(matrix(about([3, -1, 1], 1.9)), [-0.05, 0.02, 0.08])    # from a CT of the vertebra
    X_HS = pose(matrix(about([0, 0, 1], 0.5)), [0, 0, 0.03])
    bones = [pose(matrix(about([0.2, 1, 0.1], 0.3 + 0.02 * np.sin(0.5 * k))), [0.4 + 0.001 * np.sin(k), 0.1, 0.9]) for k in t]
    names, tracks = ["probe", "vertebra"], [[], []]
    for k in range(len(t)):
        tracks[1].append(bones[k])
        tracks[0].append(bones[k] @ X_BV @ X_VH[k] @ np.linalg.inv(X_BH))

    args.room.mkdir(parents=True)
    step = slice(None, None, args.every)
    with open(args.room / "motion.tsv", "w", newline="") as out:
        out.write(f"NO_OF_FRAMES\t{len(t[step])}\r\nNO_OF_CAMERAS\t8\r\nNO_OF_BODIES\t2\r\nFREQUENCY\t{rate / args.every:g}\r\n"
                  "DESCRIPTION\tSIMULATED\r\nDATA_INCLUDED\t6D\r\nBODY_NAMES\tprobe\tvertebra\r\nFrame\tTime")
        for name in names:
            out.write(f"\t{name} X\tY\tZ\tRoll\tPitch\tYaw\tResidual" + "".join(f"\tRot[{k}]" for k in range(9)))
        out.write("\r\n")
        for n, k in enumerate(range(0, len(t), args.every)):
            out.write(f"{n + 1}\t{t[k]:.5f}")
            for track in tracks:
                p = 1000 * track[k][:3, 3] + rng.normal(0, 0.002, 3)
                out.write("".join(f"\t{v:.4f}" for v in p) + "\t0\t0\t0\t0.1")
                out.write("".join(f"\t{v:.7f}" for v in track[k][:3, :3].T.ravel()))
            out.write("\r\n")
    R, r = X_HS[:3, :3], X_HS[:3, 3]
    f_S = np.hstack([f_H[:, :3] @ R, (f_H[:, 3:] - np.cross(r, f_H[:, :3])) @ R])
    f_S = f_S + ZERO + rng.normal(0, 1, f_S.shape) * np.array([args.noise] * 3 + [args.noise / 50] * 3)
    np.savetxt(args.room / "force.csv", np.hstack([(t + args.offset)[:, None], f_S]), delimiter=",", fmt="%.7g", comments="",
               header="t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm")

    def frame(X_):
        w = np.sqrt(max(0.0, 1 + np.trace(X_[:3, :3]))) / 2
        v = np.array([X_[2, 1] - X_[1, 2], X_[0, 2] - X_[2, 0], X_[1, 0] - X_[0, 1]]) / (4 * w)
        return {"p_m": X_[:3, 3].tolist(), "q": [w, *v.tolist()]}

    trials = [{"id": args.trial, "motion": "motion.tsv", "force": "force.csv", "operator": "simulated hand"}]
    (args.room / "assembly.json").write_text(json.dumps({
        "format": "tractus-assembly/1", "rig": "palpation", "simulated": True, "notes": "made by make_room.py",
        "tool": {"body": "probe", "X_BH": frame(X_BH)}, "bone": {"body": "vertebra", "X_BV": frame(X_BV)},
        "sensor": {"X_HS": frame(X_HS), "says": "on_probe"}, "tip_z_m": 0.13, "trials": trials}, indent=1))
    (args.room / "truth.json").write_text(json.dumps({
        "clock_offset_s": args.offset, "noise_N": args.noise, "rows_noise_N": args.noise / np.sqrt(args.every),
        "zero": ZERO.tolist(), "taps_s": TAPS_S, "begins_s": float(t1[-1] + 1 / rate)}))
    volume = json.loads((args.set / "set.json").read_text())["volume"]
    shutil.copy(args.set / volume, args.room / volume)
    model = json.loads((args.set / "model.json").read_text())
    model["volume"] = volume
    (args.room / "model.json").write_text(json.dumps(model))


if __name__ == "__main__":
    main()
