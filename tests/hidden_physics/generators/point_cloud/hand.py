"""The hand: a stochastic process that palpates, and yields to the force that it causes."""
from types import SimpleNamespace

import numpy as np

from point_cloud.bone import MM, unit
from point_cloud.physics import contact, equilibrium, rig_of

HAND_STEP_S = 0.005


def draw_probe(rng, bone):
    """Numbers of the true base physics. The force factor follows from how hard this hand pushes."""
    p = SimpleNamespace(points=int(rng.choice([3, 3, 4])), length_m=round(rng.uniform(0.09, 0.13), 3),
                        radius_m=round(rng.uniform(0.8, 1.25) * MM, 5), limit_N=rng.uniform(1.8, 4.2))
    p.point_spacing_m = round(rng.uniform(6, 9) * MM * (1 if p.points == 3 else 0.7), 4)
    p.youngs_modulus_known = bool(rng.random() < 0.4)
    p.youngs_modulus_Pa = 1.95e11 if p.youngs_modulus_known else 1.95e11 * rng.uniform(0.9, 1.1)
    p.force_scale = p.torque_scale = float(rng.choice([0.3, 0.5, 1.0]))
    p.force_factor_Nm = p.limit_N / rng.uniform(0.55, 0.65) / p.force_scale / bone.end_push_per_m.max()
    p.reach_m = 0.5 * p.limit_N / p.force_scale / rig_of(p, []).k  # the tip's way aside at which the hand pushes hard
    return p


class Motion:
    """Poses of H in V from six coordinates: tip (u, w, s) along the tract's frame, mouth (u, w), roll; in m and rad.
    The coordinates are cubic B-splines over control points of shape (trials, times, 6)."""

    def __init__(self, bone, length_m, control, delta):
        self.bone, self.length_m, self.control, self.delta = bone, length_m, control, delta

    def _spline(self, points, t_s):
        x = np.clip(t_s / HAND_STEP_S, 0, points.shape[1] - 1.001)
        i, f = np.floor(x).astype(int), (x - np.floor(x))[..., None]
        weights = (1 - f) ** 3, 3 * f ** 3 - 6 * f ** 2 + 4, -3 * f ** 3 + 3 * f ** 2 + 3 * f + 1, f ** 3
        trial = np.arange(len(points))[:, None]
        return sum(w * points[trial, np.clip(i + k - 1, 0, points.shape[1] - 1)] for k, w in enumerate(weights)) / 6

    def pose(self, t_s):
        return pose_of(self.bone, self.length_m, self._spline(self.control, t_s))

    def bending(self, t_s):
        return self._spline(self.delta, t_s)


def pose_of(bone, length_m, x):
    """Origin and rotation of H in V of coordinates (..., 6). The shank leans from the mouth to the tip."""
    u, w, s, mouth_u, mouth_w, roll = np.moveaxis(x, -1, 0)
    lever = (s + 0.012 + np.sqrt((s - 0.012) ** 2 + 0.004 ** 2)) / 2  # smooth maximum of s and 12 mm
    z = unit(np.stack([u - mouth_u, w - mouth_w, lever], -1) @ bone.frame.T)
    tip = bone.entry_m + np.stack([u, w, s], -1) @ bone.frame.T
    level = unit(bone.frame[:, 0] - (z @ bone.frame[:, 0])[..., None] * z)
    x_axis = np.cos(roll)[..., None] * level + np.sin(roll)[..., None] * np.cross(z, level)
    return tip - length_m * z, np.stack([x_axis, np.cross(z, x_axis), z], -1)


def programme(rng, bone, probe, steps):
    """Targets of one trial: phases in random order, an Ornstein-Uhlenbeck process on top, smoothed by a window."""
    depth, radii = bone.length_m, bone.radii_m
    time = np.arange(steps) * HAND_STEP_S
    target, begin, kinds = np.zeros((steps, 6)), 0.0, ["air"]
    while begin < time[-1]:
        span = rng.uniform(0.5, 0.8) if kinds[-1] == "enter" else rng.uniform(1.1, 2.3)
        now = (time >= begin) & (time <= begin + span)
        t, x = time[now] - begin, np.zeros((now.sum(), 6))
        angle, push = rng.uniform(-np.pi, np.pi), min(rng.uniform(0.3, 1.2) * probe.reach_m, 4 * MM)
        x[:, 2] = depth * rng.uniform(0.35, 0.9)
        if kinds[-1] == "air":
            x[:, 2] = -rng.uniform(5, 12) * MM
            sway = rng.uniform(-5, 5, (2, 2)) * MM
            x[:, :2] = sway[0] * np.sin(2 * np.pi * rng.uniform(0.4, 1.2) * t)[:, None] + sway[1]
            x[:, 3:5], x[:, 5] = -x[:, :2] * rng.uniform(0, 0.5), rng.uniform(-0.6, 0.6)
        elif kinds[-1] == "enter":
            x[:, 2] = np.linspace(-2 * MM, 6 * MM, len(t))
        elif kinds[-1] == "poke":
            deep = np.interp(rng.uniform(0.5, 1.0) * probe.limit_N / probe.force_scale / probe.force_factor_Nm,
                             bone.end_push_per_m, bone.axial_m) + 0.25 * MM
            back, tap = rng.uniform(1.0, 4.0) * MM, 2 * np.pi * rng.uniform(0.7, 1.6) * t
            x[:, 2] = deep - back * (0.5 + 0.5 * np.cos(tap)) ** 2
            x[:, :2] = rng.uniform(-0.8, 0.8, 2) * MM
        else:
            x[:, 2] = np.minimum(x[:, 2], depth - 4 * MM)
            if kinds[-1] == "circle":
                angle = angle + rng.choice([-1, 1]) * 2 * np.pi * rng.uniform(0.4, 0.9) * t
            if kinds[-1] == "slide":
                middle, sweep = rng.uniform(0.4, 0.6), rng.uniform(0.1, 0.25)
                x[:, 2] = depth * (middle + sweep * np.sin(2 * np.pi * rng.uniform(0.4, 0.9) * t))
            if kinds[-1] == "roll":
                x[:, 5] = rng.uniform(0.5, 1.3) * np.sin(2 * np.pi * rng.uniform(0.2, 0.5) * t)
            x[:, 0], x[:, 1] = (radii[0] + push) * np.cos(angle), (radii[1] + push) * np.sin(angle)
            x[:, 3:5] = rng.uniform(-0.8, 0.8, 2) * MM - 0.1 * x[:, :2]
        target[now] = x
        begin += span
        kinds.append("enter" if kinds[-1] == "air" else str(rng.choice(
            ["air", "circle", "poke", "slide", "roll"], p=[0.14, 0.24, 0.28, 0.22, 0.12])))
    window = np.hanning(61) / np.hanning(61).sum()
    shake = np.array([0.6, 0.6, 0.25, 0.4, 0.4, 50]) * MM * rng.uniform(0.5, 1.3)
    process, keep = np.zeros((steps, 6)), np.exp(-HAND_STEP_S / rng.uniform(0.1, 0.35))
    for j in range(1, steps):
        process[j] = keep * process[j - 1] + np.sqrt(1 - keep ** 2) * shake * rng.standard_normal(6)
    padded = np.pad(target, ((30, 30), (0, 0)), "edge")
    smooth = np.stack([np.convolve(padded[:, k], window, "valid") for k in range(6)], -1)
    return smooth + process, kinds


def palpate(rng, bone, probe, trials, seconds):
    """The hand follows its targets through a second-order filter and retreats from the force of the base physics."""
    steps = int(seconds / HAND_STEP_S) + 2
    target = np.stack([programme(rng, bone, probe, steps)[0] for _ in range(trials)])
    rig, x = rig_of(probe, []), target[:, 0].copy()
    v, delta, path, bends = np.zeros_like(x), np.zeros((trials, 2)), [], []
    omega, zeta, yielding = 2 * np.pi * rng.uniform(1.6, 2.6), rng.uniform(0.8, 1.2), rng.uniform(0.1, 0.25) * MM
    for j in range(steps):
        o, r = pose_of(bone, probe.length_m, x)
        delta = equilibrium(rig, bone.field, o, r, delta, 0.0, 1e-4, 8)
        pushes = probe.force_scale * contact(rig, bone.field, o, r, delta)[1] @ bone.frame
        hardest = np.linalg.norm(pushes, axis=-1).max(1)[:, None] / probe.limit_N
        goal = target[:, j].copy()
        goal[:, :3] += yielding * pushes.sum(1) * (1 + hardest ** 2)
        goal[:, [0, 1, 3, 4]] /= 1 + (hardest / 0.8) ** 4  # a lever in the tract pushes hard at both of its ends
        path.append(x.copy())
        bends.append(delta)
        v = v + HAND_STEP_S * (omega ** 2 * (goal - x) - 2 * zeta * omega * v)
        x = x + HAND_STEP_S * v
    return Motion(bone, probe.length_m, np.stack(path, 1), np.stack(bends, 1))
