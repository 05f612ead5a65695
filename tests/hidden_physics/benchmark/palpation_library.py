"""Columns of the linear models of a palpation set: how the wrench changes with each number of the base, and with each
effect at a small size.

The wrench is that of the benchmark's own solver (generators/point_cloud), driven by the smoothed recorded poses: its
laws are exactly those that made the sets, so that these rivals are better off than any other reader of the files.
"""
from __future__ import annotations

import gzip
import pathlib
import struct
import sys
from types import SimpleNamespace

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / "generators")]
from baselines import Channel  # noqa: E402
from point_cloud.bone import MM, Field  # noqa: E402
from point_cloud.effects import EFFECTS  # noqa: E402
from point_cloud.physics import predict  # noqa: E402
from probing_library import local_polynomial, random_features, trends  # noqa: E402
from sensor_chain import interpolated  # noqa: E402

SMOOTHED_S, KEPT_HZ = 0.03, 50.0
CHANGE = 0.01  # of a number of the base
LOADS = ("fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm")


def nrrd_of(content):
    """(values [x][y][z], origin, spacing) of an NRRD volume in LPS with axes along x, y, z; in m."""
    head, packed = content.split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    size = [int(n) for n in fields["sizes"].split()]
    rows = [[float(n) for n in v.strip("()").split(",")] for v in fields["space directions"].split()]
    origin = [float(n) for n in fields["space origin"].strip("()").split(",")]
    raw = gzip.decompress(packed) if fields["encoding"] == "gzip" else packed
    return (np.frombuffer(raw, "<i2").reshape(size, order="F").astype(float), np.array(origin) * MM,
            np.diag(np.array(rows)) * MM)


def nifti_of(content):
    """The same of a NIfTI-1 volume whose axes are R, A, S."""
    raw = gzip.decompress(content)
    size = struct.unpack("<3h", raw[42:48])
    rows = np.frombuffer(raw[280:328], "<f4").reshape(3, 4).astype(float)
    start = int(struct.unpack("<f", raw[108:112])[0])
    values = np.frombuffer(raw[start:], "<i2", count=int(np.prod(size))).reshape(size, order="F").astype(float)
    spacing = np.diag(rows[:, :3]) * MM  # to LPS: x and y turn round
    last = rows[:, 3] + rows[:, :3] @ (np.array(size) - 1)
    return values[::-1, ::-1], np.array([-last[0], -last[1], rows[2, 3]]) * MM, np.abs(spacing)


class Path:
    """Smoothed recorded poses as a motion, between the samples by cubic Hermite interpolation."""

    def __init__(self, columns):
        t = columns["t_s"]
        step = float(np.median(np.diff(t)))
        self.t = np.arange(t[0], t[-1], step)
        half = max(2, int(round(SMOOTHED_S / step)))
        q = np.stack([columns[n] for n in ("qw", "qx", "qy", "qz")], 1)
        q = q * np.cumprod(np.append(1.0, np.where((q[1:] * q[:-1]).sum(1) < 0, -1.0, 1.0)))[:, None]
        seven = [columns[n] for n in ("px_m", "py_m", "pz_m")] + list(q.T)
        self.smooth = [local_polynomial(np.interp(self.t, t, values), half, step)[0] for values in seven]

    def pose(self, at):
        flat = np.clip(at.ravel(), self.t[0], self.t[-1])
        s = np.stack([interpolated(self.t, values, flat) for values in self.smooth], -1).reshape(at.shape + (7,))
        w, x, y, z = np.moveaxis(s[..., 3:] / np.linalg.norm(s[..., 3:], axis=-1, keepdims=True), -1, 0)
        rows = [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
        return s[..., :3], np.stack(rows, -1).reshape(at.shape + (3, 3))

    def bending(self, at):
        return np.zeros(at.shape + (2,))


def small_effects(probe):
    """(id, variant, numbers) of each effect of the catalogue, one for each direction that it may have."""
    reference, axes = 300.0, np.eye(3)
    listed = [("contact_friction", 0, {"coefficient": 0.1, "bends_shank": 1.0}),
              ("contact_damping", 0, {"damping_Ns_per_m": 3.0, "bends_shank": 1.0}),
              ("contact_nonlinearity", 0, {"exponent": 1.1, "reference_gradient_per_m": reference,
                                           "_factor": probe.force_factor_Nm}),
              ("contact_hysteresis", 0, {"loss": 0.1}), ("time_delay", 0, {"delay_s": 0.002}),
              ("shank_taper", 0, {"handle_radius_m": 1.1 * probe.radius_m, "tip_radius_m": 0.9 * probe.radius_m}),
              ("tip_ball", 0, {"radius_m": 0.8 * MM})]
    listed += [("pose_offset", 0, {"offset_m": list(0.05 * MM * a)}) for a in axes]
    listed += [("shank_curvature", 0, {"bow_m": 0.1 * MM, "direction_rad": b}) for b in (0.0, np.pi / 2)]
    for name in ("probe_inertia", "probe_weight"):
        listed += [(name, 0, {"mass_kg": 0.01, "centre_m": c}) for c in (0.0, probe.length_m)]
    listed += [("sensor_bias", 0, {"force_N": list(0.1 * a), "torque_Nm": [0.0] * 3}) for a in axes]
    return listed + [("sensor_bias", 0, {"force_N": [0.0] * 3, "torque_Nm": list(0.01 * a)}) for a in axes]


def free_numbers(model):
    names = ["force_factor_Nm", "youngs_modulus_Pa", "force_scale", "torque_scale"]
    return [n for n in names if f"/base/{n}" not in model["fixed"]]


def linearised(model, bone, columns):
    """Measured wrench, base columns and library columns of one trial, six rows a sample; torques over the length."""
    probe = SimpleNamespace(**model["base"])
    path = Path(columns)
    every = max(1, int(round(1 / KEPT_HZ / float(np.median(np.diff(columns["t_s"]))))))
    t = columns["t_s"][3 * every:-3 * every:every][None]
    rows = np.searchsorted(columns["t_s"], t[0])
    unit = np.array([1, 1, 1] + 3 * [probe.length_m])

    def flat(wrench):
        return (wrench[0] / unit).ravel()

    plain, bend, _ = predict(bone, probe, path, t)
    base = [flat(plain)]
    for name in free_numbers(model):
        changed = SimpleNamespace(**{**vars(probe), name: (1 + CHANGE) * getattr(probe, name)})
        base.append(flat(predict(bone, changed, path, t, start=bend)[0]) - base[0])
    library = [flat(predict(bone, probe, path, t, [(EFFECTS[name], numbers)], start=bend)[0]) - base[0]
               for name, _, numbers in small_effects(probe)]
    measured = np.stack([columns[n][rows] for n in LOADS], 1) / unit
    o, _ = path.pose(t)
    v = np.gradient(o[0], t[0], axis=0)
    return measured.ravel(), np.column_stack(base), np.column_stack(library), o[0], v


def channels_of(model, trials, folder):
    """The wrench as one linear model."""
    content = (folder / model["volume"]).read_bytes()
    hu, origin, spacing = (nrrd_of if content[:4] == b"NRRD" else nifti_of)(content)
    bone = SimpleNamespace(field=Field(hu, origin, spacing, model["transfer"]))
    made = [linearised(model, bone, columns) for columns in trials]
    signals = [np.concatenate([np.column_stack([o, v]) for _, _, _, o, v in made])[:, k] for k in range(6)]
    middle, sizes = [s.mean() for s in signals], [s.std() for s in signals]
    listed, axes = [], np.eye(6)
    for y, base, library, o, v in made:
        state = [(s - m) for s, m in zip(np.column_stack([o, v]).T, middle)]
        features = random_features(state, sizes)
        features = np.concatenate([np.kron(features, a[:, None]) for a in axes[:3]], 1)  # of each force's axis
        slow = np.concatenate([np.kron(trends(len(o)), a[:, None]) for a in axes], 1)
        listed.append((y, base, library, features, slow))
    probe = SimpleNamespace(**model["base"])
    return [Channel("force_N", [(name, variant) for name, variant, _ in small_effects(probe)], listed)]
