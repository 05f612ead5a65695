"""Columns of the linear models of a probing set: the base, the catalogue's effects, features of depth and speed."""
from __future__ import annotations

import math

import numpy as np

from baselines import Channel

MOST_RATE_HZ, KEPT_HZ = 1000.0, 200.0
SMOOTHED_S = 0.015  # half window of the local polynomial
BORDER_S = 0.015  # samples this near a crossing of a border are left out
AT_REST_M_S, AT_REST_RAD_S = 2e-4, 5e-3
FEATURES = 100


def local_polynomial(values, half, step, order=3):
    """Value, first and second derivative by a cubic in a moving window (A. Savitzky, M. J. E. Golay, Anal. Chem. 36
    (1964), 1627-1639); the ends are extended by reflection about the end point."""
    at = np.arange(-half, half + 1) * step
    weights = np.linalg.pinv(np.vander(at, order + 1, increasing=True))
    before, after = 2 * values[0] - values[half:0:-1], 2 * values[-1] - values[-2:-half - 2:-1]
    padded = np.concatenate([before, values, after])
    return [math.factorial(k) * np.convolve(padded, weights[k][::-1], "valid") for k in range(3)]


def resampled(columns):
    """The columns on a uniform grid of at most MOST_RATE_HZ, and the step."""
    t = columns["t_s"]
    step = max(float(np.median(np.diff(t))), 1 / MOST_RATE_HZ)
    grid = np.arange(t[0], t[-1], step)
    bins = int(round(step / float(np.median(np.diff(t)))))
    shown = {}
    for name, values in columns.items():
        if bins > 1:  # the mean over a step, about its middle
            sums = np.concatenate([[0.0], np.cumsum(values)])
            middle = np.searchsorted(t, grid)
            low, high = np.maximum(middle - bins // 2, 0), np.minimum(middle + bins // 2 + 1, len(t))
            shown[name] = (sums[high] - sums[low]) / (high - low)
        else:
            shown[name] = np.interp(grid, t, values)
    return {**shown, "t_s": grid}, step


def play(x, gap):
    """The play operator of full width gap, centred at the start."""
    seen, out = x[0], np.empty(len(x))
    for k, value in enumerate(x.tolist()):
        seen = min(max(seen, value - gap / 2), value + gap / 2)
        out[k] = seen
    return out


def first_order(drive, rate, step):
    """q with dq/dt = drive - rate q, q = 0 at the start; exponential steps."""
    q, out = 0.0, np.empty(len(drive))
    keep = np.exp(-rate * step)
    add = np.where(rate > 1e-9, drive * (1 - keep) / np.maximum(rate, 1e-9), drive * step)
    for k, (a, b) in enumerate(zip(keep.tolist(), add.tolist())):
        q = a * q + b
        out[k] = q
    return out


def layer_numbers(model, x):
    """Number of the layer at each depth (-1: none) and its stated stiffness and equilibrium."""
    number, stiffness, equilibrium = np.full(len(x), -1), np.zeros(len(x)), np.zeros(len(x))
    for i, layer in enumerate(model["base"]["layers"]):
        inside = (x >= layer["start_m"]) & (x < layer["start_m"] + layer["thickness_m"])
        number[inside], stiffness[inside] = i, layer["stiffness_N_per_m"]
        equilibrium[inside] = layer["equilibrium_m"]
    return number, stiffness, equilibrium


def is_fixed(model, i, name):
    return bool({f"/base/layers/{i}/{name}", f"/base/layers/*/{name}"} & set(model["fixed"]))


def axial_base(model, number, x, v, a):
    columns = []
    for i, layer in enumerate(model["base"]["layers"]):
        inside = number == i
        columns += [inside * v]
        columns += [] if is_fixed(model, i, "stiffness_N_per_m") else [inside * (x - layer["equilibrium_m"])]
        columns += [] if is_fixed(model, i, "equilibrium_m") else [1.0 * inside]
    return np.column_stack(columns + [a for e in model["effects"] if e["id"] == "inertia"])


def axial_library(model, s, step):
    """(id, variant) and column of each effect on the force."""
    x, v, a, sign = s["x"], s["v"], s["a"], np.tanh(s["v"] / AT_REST_M_S)
    _, stiffness, _ = layer_numbers(model, x)
    listed = [("coulomb_friction", 0, sign), ("depth_friction", 0, np.maximum(x, 0) * sign),
              ("quadratic_drag", 0, v * np.abs(v)), ("sensor_bias", 0, np.ones(len(x))),
              ("time_delay", 0, -s["force_rate"])]
    if not any(e["id"] == "inertia" for e in model["effects"]):
        listed.append(("inertia", 0, a))
    for k, way in enumerate(np.geomspace(3e-5, 2e-3, 6)):
        listed.append(("hysteresis", k, first_order(v, np.abs(v) / way, step)))
    for k, tau in enumerate(np.geomspace(0.02, 2.0, 6)):
        listed.append(("viscoelastic_relaxation", k, first_order(v, np.full(len(v), 1 / tau), step)))
    for k, slow in enumerate(np.geomspace(2e-3, 3e-2, 4)):
        listed += [("stribeck_friction", k, sign), ("stribeck_friction", k, np.exp(-(v / slow) ** 2) * sign)]
    for k, period in enumerate(np.geomspace(5e-4, 6e-3, 60)):
        listed += [("force_ripple", k, np.sin(2 * np.pi * x / period)),
                   ("force_ripple", k, np.cos(2 * np.pi * x / period))]
    for k, gap in enumerate(np.geomspace(3e-5, 1e-3, 6)):
        listed.append(("backlash", k, stiffness * (play(x, gap) - x)))
    if "omega" in s:
        listed += [("rotation_coupling", 0, -np.abs(s["omega"]) * s["fz"]), ("torque_crosstalk", 0, s["tz"])]
    return listed


def states(columns, step):
    half = max(3, int(round(SMOOTHED_S / step)))
    s = {"fz": columns["fz_N"]}
    s["x"], s["v"], s["a"] = local_polynomial(columns["x_m"], half, step)
    s["force_rate"] = local_polynomial(columns["fz_N"], half, step)[1]
    if "theta_rad" in columns:
        s["theta"], s["omega"], _ = local_polynomial(columns["theta_rad"], half, step)
        s["tz"] = columns["tz_Nm"]
    return s, half


def kept_samples(number, half, step):
    """About KEPT_HZ samples a second, none near the ends or a border."""
    near = max(1, int(round(BORDER_S / step)))
    crossed = np.flatnonzero(np.diff(number) != 0)
    good = np.ones(len(number), bool)
    good[:half], good[len(good) - half:] = False, False
    for k in crossed:
        good[max(0, k - near):k + near + 2] = False
    return np.flatnonzero(good)[::max(1, int(round(1 / KEPT_HZ / step)))]


def trends(count):
    t = np.linspace(-1, 1, count)
    return np.column_stack([np.ones(count), t, t * t, t ** 3])


def random_features(signals, sizes):
    """Fourier features of a Gaussian process with length scales of one standard deviation of each signal."""
    random = np.random.default_rng(0)
    waves = random.normal(size=(len(signals), FEATURES))
    phases = random.uniform(0, 2 * np.pi, FEATURES)
    return np.cos(np.column_stack([s / z for s, z in zip(signals, sizes)]) @ waves + phases)


def channels_of(model, trials, _folder):
    """The force, and the torque where it was recorded, as linear models."""
    axial, rotary, ids = [], [], []
    made = []
    for columns in trials:
        shown, step = resampled(columns)
        s, half = states(shown, step)
        made.append((s, step, half))
    sizes = [float(np.std(np.concatenate([s[name] for s, _, _ in made]))) for name in ("x", "v")]
    for s, step, half in made:
        number = layer_numbers(model, s["x"])[0]
        kept = kept_samples(number, half, step)
        listed = axial_library(model, s, step)
        ids = [(name, variant) for name, variant, _ in listed]
        axial.append((s["fz"][kept], axial_base(model, number, s["x"], s["v"], s["a"])[kept],
                      np.column_stack([c for _, _, c in listed])[kept],
                      random_features([s["x"][kept], s["v"][kept]], sizes), trends(len(kept))))
        if "omega" in s and model["base"].get("rotary"):
            pitch = model["base"]["rotary"]["detent_pitch_rad"]
            base = np.column_stack([s["omega"], np.sin(2 * np.pi * s["theta"] / pitch)])
            library = np.column_stack([np.tanh(s["omega"] / AT_REST_RAD_S), s["theta"], np.ones(len(base))])
            rotary.append((s["tz"][kept], base[kept], library[kept], np.zeros((len(kept), 0)), trends(len(kept))))
    channels = [Channel("fz_N", ids, axial)]
    if rotary:
        channels.append(Channel("tz_Nm", [("rotary_coulomb_friction", 0), ("rotary_stiffness", 0),
                                          ("rotary_bias", 0)], rotary))
    return channels
