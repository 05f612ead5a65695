"""A SIMULATED measuring room: see README.md. Its physics and its clocks are its own; nothing of the product's is used."""
import argparse
import json
import pathlib

import numpy as np

import c3d_writer

FIRST_TAPS = (1.60, 2.03, 2.40, 2.96, 3.31)  # s, uneven, as a hand's
LAST_TAPS = (15.00, 15.46, 15.79, 16.31, 16.74)
MOVE_IN, PALPATE, MOVE_OUT, END = 4.0, 5.5, 13.0, 17.5
LENGTH = 0.13  # m, of the probe from the handle's frame to its tip
PLATE = np.array([0.040, 0.0, -0.020])  # the solid surface that is tapped, normal -z of V
PLATE_K, WALL_K, LOSS = 3000.0, 2500.0, 0.3  # N/m, N/m, s/m
CANAL_R, CANAL_END = 0.002, 0.030  # m
ZERO = np.array([0.7, -0.3, 1.1, 0.02, -0.01, 0.005])  # the sensor's, N and N m
COUNTS = 1_000_000


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def about(axis, angle):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis)])


def quaternion(R):
    w = np.sqrt(max(0.0, 1 + np.trace(R))) / 2  # turns here stay far from half
    return np.array([w, *(np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4 * w))])


def pose(R, p):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = R, p
    return X


def smooth(s):
    s = min(max(s, 0.0), 1.0)
    return s * s * s * (10 - 15 * s + 6 * s * s)


def tip(t):
    """Where the hand leads the tip, in V."""
    above = PLATE + [0.001 * np.sin(1.3 * t), 0.001 * np.cos(0.9 * t), -0.023]
    for k, tap in enumerate(FIRST_TAPS + LAST_TAPS):
        if abs(t - tap) < 0.16:  # down 25 mm, 2 mm and a little of them into the plate
            above = above + [0, 0, (0.0125 + 0.0001 * (k % 3)) * (1 + np.cos(np.pi * (t - tap) / 0.16))]
    s = t - PALPATE
    deep = 0.004 + 0.011 * (1 - np.cos(2 * np.pi * s / 3.7))
    wide = 0.0012 + 0.0017 * (0.5 - 0.5 * np.cos(2 * np.pi * s / 0.9))
    inside = np.array([wide * np.cos(2.1 * s), wide * np.sin(2.1 * s), deep])
    u = smooth((t - MOVE_IN) / (PALPATE - MOVE_IN)) - smooth((t - MOVE_OUT) / (LAST_TAPS[0] - 0.3 - MOVE_OUT))
    return (1 - u) * above + u * inside - [0, 0, 0.16 * u * (1 - u)]  # lifted on the way between them


def turn(t):
    return matrix(about([1, 0.3 * np.sin(0.4 * t), 0.1], 0.06 + 0.05 * np.sin(0.7 * t)))


def force_on_tip(p, v):
    """What plate and bone do to the tip, in V: springs that lose a little (Hunt and Crossley's form)."""
    f = np.zeros(3)
    into = p[2] - PLATE[2]
    if p[0] > 0.03 and into > 0:
        f[2] -= PLATE_K * into * max(0.0, 1 + LOSS * v[2])
    r = np.hypot(p[0], p[1])
    if p[0] < 0.02 and p[2] > 0 and r > CANAL_R:
        out = np.array([p[0], p[1], 0]) / r
        f -= out * WALL_K * (r - CANAL_R) * max(0.0, 1 + LOSS * out @ v)
    return f


def state(t):
    """X_VH and the wrench on the probe in H, at its origin."""
    R, p = turn(t), tip(t)
    v = (tip(t + 1e-5) - tip(t - 1e-5)) / 2e-5
    f_H = R.T @ force_on_tip(p, v)
    return pose(R, p - R @ [0, 0, LENGTH]), np.concatenate([f_H, np.cross([0, 0, LENGTH], f_H)])


def frame(X):
    return {"p_m": X[:3, 3].tolist(), "q": quaternion(X[:3, :3]).tolist()}


X_BH = pose(matrix(about([1, 2, 3], 0.7)), [0.012, -0.034, 0.056])  # as a CT of the handle would say
X_BV = pose(matrix(about([3, -1, 1], 1.1)), [-0.05, 0.02, 0.08])  # and one of the vertebra
X_HS = pose(matrix(about([0, 0, 1], 0.5)), [0, 0, 0.03])
CLUSTER = np.array([[0, 0, 0], [0.05, 0, 0], [0, 0.07, 0], [0.02, 0.03, 0.06]])  # markers of either body


def bone(t):
    return pose(matrix(about([0.2, 1, 0.1], 0.3 + 0.02 * np.sin(0.5 * t))), [0.4 + 0.001 * np.sin(t), 0.1, 0.9])


def tracked(t):
    """X_C of probe and vertebra."""
    B = bone(t)
    return B @ X_BV @ state(t)[0] @ np.linalg.inv(X_BH), B


def shaken(X, rng, args):
    wobble = rng.normal(0, args.turn_noise, 3)
    return pose(X[:3, :3] @ matrix(about(wobble + 1e-12, np.linalg.norm(wobble))), X[:3, 3] + rng.normal(0, args.point_noise, 3))


def write_motion(room, times, poses):
    with open(room / "played.csv", "w") as out:  # what the peer plays
        out.write("t_s" + "".join(f",{b}.{c}" for b in ("probe", "vertebra") for c in ("px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz")) + "\n")
        for t, bodies in zip(times, poses):
            out.write(f"{t:.6f}" + "".join(f",{v:.9g}" for X in bodies for v in (*X[:3, 3], *quaternion(X[:3, :3]))) + "\n")
    with open(room / "motion.tsv", "w", newline="") as out:
        out.write(f"NO_OF_FRAMES\t{len(times)}\r\nNO_OF_CAMERAS\t8\r\nNO_OF_BODIES\t2\r\nFREQUENCY\t100\r\n"
                  "DESCRIPTION\tSIMULATED\r\nDATA_INCLUDED\t6D\r\nBODY_NAMES\tprobe\tvertebra\r\nFrame\tTime")
        for name in ("probe", "vertebra"):
            out.write(f"\t{name} X\tY\tZ\tRoll\tPitch\tYaw\tResidual" + "".join(f"\tRot[{k}]" for k in range(9)))
        out.write("\r\n")
        for n, (t, bodies) in enumerate(zip(times, poses)):
            out.write(f"{n + 1}\t{t:.5f}")
            for X in bodies:
                out.write("".join(f"\t{v:.4f}" for v in 1000 * X[:3, 3]) + "\t0\t0\t0\t0.1")
                out.write("".join(f"\t{v:.7f}" for v in X[:3, :3].T.ravel()))
            out.write("\r\n")


def write_c3d(room, poses, force_S):
    points = [[1000 * (X[:3, :3] @ m + X[:3, 3]) for X in bodies for m in CLUSTER] for bodies in poses]
    labels = [f"{b}{k}" for b in ("probe", "vertebra") for k in range(4)]
    units = np.array([1, 1, 1, 1000, 1000, 1000])  # N, N mm: as motion capture systems write them
    c3d_writer.write(room / "motion.c3d", points, labels, 100.0, force_S * units, ["Fx", "Fy", "Fz", "Mx", "My", "Mz"],
                     ["N", "N", "N", "Nmm", "Nmm", "Nmm"], 10)


def write_volume(room):
    n, step = (60, 60, 90), 0.5  # mm; V's origin lies in the mouth of the canal
    x, y, z = np.meshgrid(*[(np.arange(k) - o) * step for k, o in zip(n, (30, 30, 10))], indexing="ij")
    solid = (z > 0) & ~((np.hypot(x, y) < 1000 * CANAL_R) & (z < 1000 * CANAL_END))
    with open(room / "bone.nrrd", "wb") as out:
        out.write(("NRRD0005\n# SIMULATED\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
                   f"sizes: {n[0]} {n[1]} {n[2]}\nspace directions: ({step},0,0) (0,{step},0) (0,0,{step})\n"
                   f"space origin: ({-30 * step},{-30 * step},{-10 * step})\n"
                   "kinds: domain domain domain\nendian: little\nencoding: raw\n\n").encode())
        out.write(np.where(solid, 1200, -50).astype("<i2").ravel(order="F").tobytes())
    (room / "model.json").write_text(json.dumps({
        "format": "tractus-model/1", "rig": "palpation", "name": "as published", "volume": "bone.nrrd",
        "transfer": [[150, 0], [700, 1]],
        "base": {"force_factor_Nm": 0.005, "force_scale": 0.3, "torque_scale": 0.3, "points": 3, "point_spacing_m": 0.009,
                 "youngs_modulus_Pa": 1.95e11, "length_m": LENGTH, "radius_m": 0.0007, "pose_offset_m": [0, 0, 0],
                 "field": "paper"}, "effects": []}))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("room", type=pathlib.Path)
    parser.add_argument("--ahead", type=float, default=0.7321, help="s, by which the force is recorded before the motion")
    parser.add_argument("--drift", type=float, default=250e-6, help="by which the sensor's clock runs fast")
    parser.add_argument("--noise", type=float, default=0.03, help="N, per sample of the sensor")
    parser.add_argument("--point-noise", type=float, default=5e-5, help="m, of a tracked position")
    parser.add_argument("--turn-noise", type=float, default=2e-4, help="rad")
    parser.add_argument("--seed", type=int, default=3)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    args.room.mkdir(parents=True)

    times = np.arange(0, END, 0.01)
    poses = [[shaken(X, rng, args) for X in tracked(t)] for t in times]
    write_motion(args.room, times, poses)

    sensor = np.arange(0, (END + args.ahead) * (1 + args.drift), 0.001)  # its own clock
    f_H = np.array([state(t)[1] for t in sensor / (1 + args.drift) - args.ahead])
    R, r = X_HS[:3, :3], X_HS[:3, 3]
    f_S = np.hstack([f_H[:, :3] @ R, (f_H[:, 3:] - np.cross(r, f_H[:, :3])) @ R])
    f_S = f_S + ZERO + rng.normal(0, 1, f_S.shape) * np.array([args.noise] * 3 + [args.noise / 50] * 3)
    np.savetxt(args.room / "force.csv", np.hstack([sensor[:, None], f_S]), delimiter=",", fmt="%.7g", comments="",
               header="t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm")
    np.savetxt(args.room / "counts.csv", np.rint(f_S * COUNTS).astype(int), delimiter=",", fmt="%d")
    # A C3D file has one clock: the force as an analog board of the capture system would have it.
    board = np.arange(0, 10 * len(times)) / 1000
    nearest = np.clip(np.searchsorted(sensor, (board + args.ahead) * (1 + args.drift)), 0, len(sensor) - 1)
    write_c3d(args.room, poses, f_S[nearest])
    write_volume(args.room)

    truth = np.array([[t, *X[:3, 3], *quaternion(X[:3, :3]), *w] for t in times for X, w in [state(t)]])
    np.savetxt(args.room / "truth.csv", truth, delimiter=",", fmt="%.9g", comments="",
               header="t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm")
    (args.room / "assembly.json").write_text(json.dumps({
        "format": "tractus-assembly/1", "rig": "palpation", "simulated": True, "notes": "SIMULATED by make_room.py",
        "volume": "bone.nrrd", "tool": {"body": "probe", "X_BH": frame(X_BH)}, "bone": {"body": "vertebra", "X_BV": frame(X_BV)},
        "sensor": {"X_HS": frame(X_HS), "says": "on_probe"}, "tip_z_m": LENGTH,
        "trials": [{"id": "trial1", "motion": "motion.tsv", "force": "force.csv", "operator": "simulated hand"}]}, indent=1))
    (args.room / "truth.json").write_text(json.dumps({
        "ahead_s": args.ahead, "drift": args.drift, "noise_N": args.noise, "zero": ZERO.tolist(), "counts": COUNTS,
        "first_taps_s": FIRST_TAPS, "last_taps_s": LAST_TAPS, "end_s": END,
        "markers_m": {f"{b}{k}": CLUSTER[k].tolist() for b in ("probe", "vertebra") for k in range(4)}}))


if __name__ == "__main__":
    main()
