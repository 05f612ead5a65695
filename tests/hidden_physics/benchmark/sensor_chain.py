"""What every recording of the benchmark goes through behind its generator's own sensors, and what the user writes down.

In this order: the force comes late (the motion is shown early), its gain is off, coloured noise, clipping, rounding to
whole counts, a clock with jitter, dropped rows; numbers of the model rounded and, on request, far off.

A probe may move too fast for interpolation, so that its delay is a whole number of samples (none below 500 Hz); a hand
that palpates does not. The jitter is small beside that of the generators: it shows as an error of the speed, which no
reader of the files can tell from noise, and which the true floor of the score does not hold. A steady clock has none.
"""
from __future__ import annotations

import math
import pathlib
import sys

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1])]
from made_set import decimals  # noqa: E402

LOADS = ("fz_N", "tz_Nm", "fx_N", "fy_N", "tx_Nm", "ty_Nm")
UNIT_FORCE = {"fz_N", "fx_N", "fy_N"}
QUATERNION = ("qw", "qx", "qy", "qz")
MOST_DELAY_S, MOST_GAIN, MOST_JITTER = 2e-3, 0.01, 0.01
FAR_OFF = 2.0  # a number of a "parameters" set is at most this factor off


def log_uniform(random, low, high):
    return float(math.exp(random.uniform(math.log(low), math.log(high))))


def interpolated(times, values, at):
    """Cubic Hermite interpolation with slopes by central differences (Catmull and Rom 1974 on uneven times)."""
    slopes = np.gradient(values, times)
    i = np.clip(np.searchsorted(times, at, "right") - 1, 0, len(times) - 2)
    h = times[i + 1] - times[i]
    s = (at - times[i]) / h
    return ((1 + 2 * s) * (1 - s) ** 2 * values[i] + s * (1 - s) ** 2 * h * slopes[i]
            + s * s * (3 - 2 * s) * values[i + 1] + s * s * (s - 1) * h * slopes[i + 1])


def coloured(random, count, keep):
    """Noise of standard deviation 1 whose neighbours have the correlation `keep`."""
    noise = random.normal(size=count)
    noise[1:] *= math.sqrt(1 - keep**2)
    noise = noise.tolist()
    for k in range(1, count):
        noise[k] += keep * noise[k - 1]
    return np.array(noise)


def draw_chain(random, columns, period_s, steady_clock):
    """The chain of one set; `columns` are those of all its trials, joined."""
    sizes = {name: float(np.sqrt(np.mean(columns[name] ** 2))) for name in LOADS if name in columns}
    force = math.sqrt(sum(sizes[n] ** 2 for n in sizes if n in UNIT_FORCE))
    torque = math.sqrt(sum(sizes[n] ** 2 for n in sizes if n not in UNIT_FORCE))
    noise = log_uniform(random, 5e-4, 3e-3)
    counts = log_uniform(random, 0.3, 2.0)
    delay_s = float(random.uniform(0, MOST_DELAY_S))
    if "x_m" in columns:
        delay_s = float(random.integers(0, int(MOST_DELAY_S / period_s) + 1)) * period_s
    clips = random.random() < 0.2
    quantile = 1 - random.uniform(2e-4, 3e-3)
    return {
        "delay_s": delay_s,
        "gain": float(1 + random.uniform(-MOST_GAIN, MOST_GAIN)),
        "noise_sd": {"N": noise * force, "Nm": noise * torque},
        "noise_time_constant_s": log_uniform(random, 1e-3, 5e-2),
        "step": {"N": float(f"{counts * noise * force:.2g}"), "Nm": float(f"{counts * noise * torque:.2g}")},
        "clips_at": {name: float(f"{np.quantile(np.abs(columns[name]), quantile):.4g}") for name in sizes} if clips
        else None,
        "clock_jitter_in_periods": 0.0 if steady_clock else float(random.uniform(0, MOST_JITTER)),
        "dropped_share": float(random.choice([0.0, random.uniform(0, 0.01)])),
        "longest_gap_rows": int(random.integers(1, 6)),
    }


def shown_early(t, values, delay_s, period_s, fast):
    """A signal of the motion as it was delay_s later, and where there is such a sample."""
    if not fast:
        return interpolated(t, values, t + delay_s), t + delay_s <= t[-1]
    number = np.round((t - t[0]) / period_s).astype(int)
    wanted = number + int(round(delay_s / period_s))
    at = np.minimum(np.searchsorted(number, wanted), len(t) - 1)
    return values[at], number[at] == wanted


def rounded_like(values, like):
    return np.round(values, decimals(np.asarray(like, float)))


def passed(random, chain, columns, period):
    """One trial as the chain shows it. period: of the samples, in s, more exact than rounded time stamps tell."""
    t = np.asarray(columns["t_s"], float)
    fast = "x_m" in columns
    inside = shown_early(t, t, chain["delay_s"], period, fast)[1]
    shown = {}
    for name, values in columns.items():
        values = np.asarray(values, float)
        if name == "t_s":
            shown[name] = t[inside]
        elif name not in LOADS:
            shown[name] = shown_early(t, values, chain["delay_s"], period, fast)[0][inside]
        else:
            unit = "N" if name in UNIT_FORCE else "Nm"
            keep = math.exp(-period / chain["noise_time_constant_s"])
            load = chain["gain"] * values + chain["noise_sd"][unit] * coloured(random, len(t), keep)
            if chain["clips_at"]:
                load = np.clip(load, -chain["clips_at"][name], chain["clips_at"][name])
            step = chain["step"][unit]
            shown[name] = np.round(np.round(load / step) * step, 7)[inside] if step else load[inside]
    if QUATERNION[0] in shown:
        norm = np.sqrt(sum(shown[name] ** 2 for name in QUATERNION))
        shown.update({name: shown[name] / norm for name in QUATERNION})
    jitter = chain["clock_jitter_in_periods"] * period * random.uniform(-1, 1, len(shown["t_s"]))
    shown["t_s"] = np.maximum.accumulate(np.round(shown["t_s"] + jitter, 6) - shown["t_s"][0])
    kept = np.concatenate([[True], np.diff(shown["t_s"]) > 1e-6])
    to_lose = int(chain["dropped_share"] * len(kept))
    while to_lose > 0:
        size = min(int(random.integers(1, chain["longest_gap_rows"] + 1)), to_lose)
        begin = int(random.integers(1, len(kept) - size - 1))
        kept[begin:begin + size] = False
        to_lose -= size
    return {name: (values if name in LOADS or name == "t_s" else rounded_like(values, columns[name]))[kept]
            for name, values in shown.items()}


def put_off(random, value, factor, digits):
    if isinstance(value, dict):
        return {key: put_off(random, v, factor, digits) for key, v in value.items()}
    if isinstance(value, list):
        return [put_off(random, v, factor, digits) for v in value]
    if not isinstance(value, float) or value == 0.0:
        return value
    return float(f"{value * math.exp(random.uniform(-1, 1) * math.log(factor)):.{digits}g}")


PLACES = {"start_m", "thickness_m", "equilibrium_m", "detent_pitch_rad", "length_m", "radius_m", "point_spacing_m",
          "pose_offset_m", "points", "field"}  # measured with a ruler, and what is no size


def written_down(random, model, far_off):
    """The model as a user writes it: numbers rounded to three digits; with far_off up to a factor of two off.

    Numbers that the model fixes, and places, keep their digits.
    """
    fixed = {path.split("/")[-1] for path in model["fixed"]} | PLACES
    factor = FAR_OFF if far_off else 1.0

    def walk(node):
        if isinstance(node, list):
            return [walk(n) for n in node]
        return {key: walk(v) if isinstance(v, (dict, list)) and key not in fixed else
                v if key in fixed else put_off(random, v, factor, 3) for key, v in node.items()}

    return {**model, "base": walk(model["base"]),
            "effects": [{**e, "parameters": put_off(random, e["parameters"], min(factor, 1.1), 3)}
                        for e in model["effects"]]}


def pass_through(random, made, far_off, steady_clock=False):
    """Sends a made set through the chain; its truth then says what the chain did, under "chain"."""
    joined = {name: np.concatenate([np.asarray(c[name], float) for _, c in made.trials]) for name in made.trials[0][1]}
    period_s = 1 / made.truth["sensor"]["rate_Hz"]
    chain = draw_chain(random, joined, period_s, steady_clock)
    made.trials = [(name, passed(random, chain, columns, period_s)) for name, columns in made.trials]
    made.model = written_down(random, made.model, far_off)
    if "noise" in made.stated:  # what the user states of the noise no longer holds exactly; it never does
        made.stated["noise"] = {n: float(f"{math.hypot(sd, chain['noise_sd']['N' if n in UNIT_FORCE else 'Nm']):.2g}")
                                for n, sd in made.stated["noise"].items()}
    made.truth["chain"] = chain
    made.truth["far_off"] = far_off
    return made
