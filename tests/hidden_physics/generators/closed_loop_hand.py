"""Probing trials in which a hand, modelled as an impedance, drives a probe of small mass through layered bone.

`driven_probe` solves the motion, `probe_effects` holds the hidden effects. This module draws bone, hand, paths and
sensors from the seed, scales the hidden effects and records the trials.
"""
from __future__ import annotations

import sys
import zlib
from math import exp, inf, pi, sqrt
from pathlib import Path
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from driven_probe import Hand, MinimumJerkPath, Plant, Trial  # noqa: E402
from made_set import MadeSet  # noqa: E402
from probe_effects import LAWS, either_sign, log_uniform  # noqa: E402

NAME = "closed_loop_hand"
RIG = "probing"
CATALOGUE = ["backlash", "coulomb_friction", "depth_friction", "force_ripple", "hysteresis", "inertia",
             "quadratic_drag", "rotary_bias", "rotary_coulomb_friction", "rotary_stiffness", "rotation_coupling",
             "sensor_bias", "sensor_drift", "stribeck_friction", "time_delay", "torque_crosstalk",
             "viscoelastic_relaxation"]
OUTSIDE = ["load_friction",  # dry friction in proportion to the bone's resistance; Amontons' law, own use
           "direction_drag",  # viscous drag in one direction of motion only; own
           "shear_thinning_drag",  # viscous drag whose viscosity falls with the speed; Carreau 1972 (form), own use
           "bouc_wen",  # hysteretic spring of order 2 with its own state; Wen 1976 (form)
           "work_softening",  # the bone's springs weaken as the work done on them passes a threshold; own
           "depth_texture",  # a random force along the depth, the same in each trial; sum of cosines, own
           "resonator",  # a mass on spring and damper inside the tool, below the sensor; own
           "ageing_friction",  # dry friction with the logarithm of the contact's age; Dieterich-Ruina ageing law (form)
           "breakaway_after_rest",  # bonds that form at rest and break with the slip; own
           "stiffness_varies_by_trial",  # each trial meets another stiffness; own
           "lateral_load_friction"]  # dry friction under a slow sideways load that nobody records; own

NEEDS_TURNING = {"rotary_bias", "rotary_coulomb_friction", "rotary_stiffness", "rotation_coupling", "torque_crosstalk"}
MAX_DRAWS = 20
SHARES, LEAST_LEFT = (0.04, 0.10), 0.5
PILOT_TRIALS = 3
COARSE_RATE_HZ, FINE_RATE_HZ = 500.0, 4000.0
BEFORE_ENTRY_S = 0.4


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


# ---- what is drawn: rig, bone, hand, paths
def draw_depth_moves(rng, duration, depth):
    """Moves, holds, reversals, slow creeps, fast pulses and retreats into the air, until the time is used up."""
    pace = log_uniform(rng, 0.4, 2.0)  # some trials are hasty, some slow
    at = start = -rng.uniform(5e-4, 2e-3)
    moves = [(BEFORE_ENTRY_S, 0.0)]

    def go(to, seconds):
        nonlocal at
        moves.append((float(seconds), float(to - at)))
        at = to
    go(rng.uniform(0.3, 0.9) * depth, rng.uniform(0.5, 1.2))
    kinds, shares = ("move", "hold", "reversals", "creep", "pulses", "retreat"), (0.34, 0.18, 0.16, 0.1, 0.14, 0.08)
    while sum(seconds for seconds, _ in moves) < duration:
        kind = rng.choice(kinds, p=shares)
        down = 1 if at < 0.2 * depth else -1 if at > 0.8 * depth else either_sign(rng)
        if kind == "move":
            to = rng.uniform(0.05, 1.0) * depth
            go(to, max(abs(to - at) / min(pace * log_uniform(rng, 0.005, 0.06), 0.1), 0.12))
        elif kind == "hold":
            go(at, rng.uniform(0.3, 1.2))
        elif kind == "creep":
            go(at + down * rng.uniform(3e-4, 2e-3), rng.uniform(0.8, 2.0))
        elif kind == "retreat":
            go(start, max((at - start) / log_uniform(rng, 0.015, 0.05), 0.15))
            go(at, rng.uniform(0.1, 0.4))
        else:
            fast = kind == "pulses"
            way = down * (rng.uniform(8e-4, 3e-3) if fast else rng.uniform(8e-4, 5e-3))
            for _ in range(rng.integers(1, 4)):
                seconds = rng.uniform(0.07, 0.15) if fast else rng.uniform(0.2, 0.6)
                go(at + way, seconds)
                go(at - way, seconds)
    return MinimumJerkPath(start, moves)


def draw_turns(rng, duration):
    moves, at = [], 0.0
    while sum(seconds for seconds, _ in moves) < duration:
        by = -np.sign(at or rng.normal()) * rng.uniform(0.4, 2.4)
        moves.append((float(max(abs(by) / log_uniform(rng, 0.4, 4.0), 0.15)), float(by)))
        moves.append((float(rng.uniform(0.05, 0.5)), 0.0))
        at += by
    return MinimumJerkPath(0.0, moves)


def draw_tremor(rng, amplitude):
    return tuple((amplitude * rng.uniform(0.4, 1.0), 2 * pi * rng.uniform(8, 12), rng.uniform(0, 2 * pi))
                 for _ in range(3))


def draw_layers(rng, depth):
    """1 to 4 layers, now and then with a void between two; at half of the borders their springs differ."""
    count = int(rng.integers(1, 5))
    cuts = np.cumsum(rng.uniform(0.6, 1.4, count))
    borders = [0.0, *(float(c) for c in cuts[:-1] / cuts[-1] * depth), depth + 0.03]
    void = int(rng.integers(1, count)) if count > 1 and rng.random() < 0.15 else None
    layers, load = [], 0.0
    for i in range(count):
        start, stiffness = borders[i] + (rng.uniform(1e-3, 2e-3) if i == void else 0.0), log_uniform(rng, 700, 4500)
        load *= rng.uniform(0.2, 0.6) if i == void else 1 + rng.choice((0.0, 1.0)) * rng.uniform(-0.25, 0.2)
        layers.append({"start_m": start, "thickness_m": borders[i + 1] - start, "stiffness_N_per_m": stiffness,
                       "damping_Ns_per_m": log_uniform(rng, 40, 350), "equilibrium_m": start - load / stiffness})
        load += stiffness * (borders[i + 1] - start)
    return layers


def regions_of(layers):
    regions = [(-inf, 0.0, 0.0, 0.0, 0.0)]
    for layer in layers:
        if layer["start_m"] > regions[-1][1]:
            regions.append((regions[-1][1], layer["start_m"], 0.0, 0.0, 0.0))
        regions.append((layer["start_m"], layer["start_m"] + layer["thickness_m"], layer["stiffness_N_per_m"],
                        layer["damping_Ns_per_m"], layer["equilibrium_m"]))
    return regions + [(regions[-1][1], inf, 0.0, 0.0, 0.0)]


def draw_set(rng, turning):
    """Everything of a set but the hidden effects: plant, paths, hands, sensors, what the user knows."""
    d = SimpleNamespace(trials=10, seconds=8.0, depth=rng.uniform(0.012, 0.03))
    if rng.random() < 0.2:
        d.trials, d.seconds = int(rng.integers(6, 17)), rng.uniform(4, 15)
    d.layers = draw_layers(rng, d.depth)
    d.rotary = SimpleNamespace(
        inertia_kgm2=log_uniform(rng, 1e-4, 4e-4), viscous_Nms_per_rad=log_uniform(rng, 0.01, 0.04),
        detent_Nm=log_uniform(rng, 0.005, 0.015), detent_pitch_rad=round(rng.uniform(0.2, 0.5), 3)) if turning else None
    regions = regions_of(d.layers)
    depths = np.linspace(0, d.depth, 200)
    here = np.array([next(r for r in regions if x < r[1]) for x in depths])
    springs = here[:, 2] * (depths - here[:, 4])
    grip = rng.uniform(15, 50)
    mass = max(log_uniform(rng, 0.12, 0.4), (max(here[:, 3]) + grip) / 1500)
    d.plant = Plant(regions, mass, rng.uniform(0.002, 0.006), d.rotary)
    stiffness, expected = rng.uniform(600, 1800), float(depths @ springs / (depths @ depths)) * rng.uniform(0.85, 1.1)
    tremor = log_uniform(rng, 1e-5, 6e-5)
    d.hands, d.turners = [], []
    for _ in range(d.trials):
        seconds = d.seconds * rng.uniform(0.95, 1.05)
        path = draw_depth_moves(rng, seconds, d.depth)
        d.hands.append(Hand(path, stiffness, grip, expected, float(np.mean(here[:, 3])), draw_tremor(rng, tremor)))
        d.turners.append(Hand(draw_turns(rng, path.duration), 0.5, 0.01, 0.0, d.rotary.viscous_Nms_per_rad,
                              draw_tremor(rng, 3e-3)) if turning else None)
    d.hand_numbers = {"stiffness_N_per_m": stiffness, "damping_Ns_per_m": grip, "tremor_m": tremor,
                      "expected_stiffness_N_per_m": expected}
    d.sensor = {
        "rate_Hz": float(rng.choice((500, 1000, 2000))), "position_step_m": round(log_uniform(rng, 1e-7, 5e-6), 7),
        "position_noise_in_steps": 0.3, "angle_counts": int(rng.choice((4096, 8192, 20000, 36000))),
        "noise_share_of_rms": log_uniform(rng, 0.004, 0.015), "noise_correlation_s": log_uniform(rng, 2e-4, 5e-3),
        "hum_Hz": 50.0, "hum_share_of_noise": rng.uniform(0, 1 / 3), "delay_s": rng.uniform(0, 1e-3),
        "low_pass_Hz": log_uniform(rng, 150, 500), "clock_jitter_in_periods": rng.uniform(0, 0.1)}
    d.borders_known, d.equilibrium_known, d.noise_known = rng.random() < 0.7, rng.random() < 0.5, rng.random() < 0.5
    return d


# ---- what the user is given
def stated_model(rng, d):
    """The base model as a user would write it: springs, dampers, unknown equilibria up to 10 % off, borders to 1 um."""
    def off(value):
        return float(f"{value * rng.uniform(0.9, 1.1):.4g}")
    layers = [{"start_m": round(at["start_m"], 6), "thickness_m": round(at["thickness_m"], 6),
               "stiffness_N_per_m": off(at["stiffness_N_per_m"]), "damping_Ns_per_m": off(at["damping_Ns_per_m"]),
               "equilibrium_m": round(at["equilibrium_m"] if d.equilibrium_known else off(at["equilibrium_m"]), 6)}
              for at in d.layers]
    base, fixed = {"layers": layers}, []
    if d.borders_known:
        fixed += ["/base/layers/*/start_m", "/base/layers/*/thickness_m"]
    if d.equilibrium_known:
        fixed += ["/base/layers/*/equilibrium_m"]
    if d.rotary:
        base["rotary"] = {"viscous_Nms_per_rad": off(d.rotary.viscous_Nms_per_rad),
                          "detent_Nm": off(d.rotary.detent_Nm),
                          "detent_pitch_rad": d.rotary.detent_pitch_rad}
        fixed += ["/base/rotary/detent_pitch_rad"]
    return {"format": "tractus-model/1", "rig": RIG, "name": "layered bone", "base": base, "fixed": fixed,
            "effects": []}


# ---- the sensor chain
def low_passed(values, rate, cutoff, delay):
    """Butterworth filter of second order and a delay, exact in frequency; the ends are held for 0.25 s."""
    pad = int(rate / 4)
    padded = np.pad(values, pad, "edge")
    frequency = np.fft.rfftfreq(len(padded), 1 / rate)
    s = 1j * frequency / cutoff
    response = np.exp(-2j * pi * frequency * delay) / (1 + sqrt(2) * s + s * s)
    return np.fft.irfft(np.fft.rfft(padded) * response, len(padded))[pad:pad + len(values)]


def coloured_noise(rng, times, sd, sensor):
    """AR(1) with the correlation time, and the mains' hum; together of standard deviation sd * sqrt(1 + hum^2)."""
    keep = exp(-1 / sensor["rate_Hz"] / sensor["noise_correlation_s"])
    noise = rng.normal(0, sd, len(times))
    noise[1:] *= sqrt(1 - keep ** 2)
    noise = noise.tolist()
    for k in range(1, len(noise)):
        noise[k] += keep * noise[k - 1]
    hum = sqrt(2) * sensor["hum_share_of_noise"] * sd
    return np.array(noise) + hum * np.sin(2 * pi * sensor["hum_Hz"] * times + rng.uniform(0, 2 * pi))


def readings(sample, effects, trial, channel):
    """A channel as a perfect sensor with the hidden faults would show it, and what each fault adds."""
    true = sample.force if channel == "fz_N" else sample.torque
    faults = [e.reads(sample.t, sample.force, sample.torque, trial) if e.reads and e.channel == channel else 0.0 * true
              for e in effects]
    return true + sum(faults), faults


def record(rng, trial, number, effects, sensor, sds):
    """The columns of a trial's file, the noise in force and torque, what filter and delay made of the force (rms)."""
    rate = sensor["rate_Hz"]
    count = int((trial.hand.path.duration - 0.01) * rate)
    times = np.arange(count) / rate
    moments = np.maximum(times + sensor["clock_jitter_in_periods"] / rate * rng.uniform(-1, 1, count), 0.0)
    fine = trial.sample(np.arange(0.0, trial.hand.path.duration - 1 / FINE_RATE_HZ, 1 / FINE_RATE_HZ))
    states, _ = trial.states(moments)
    step = sensor["position_step_m"]
    columns = {"t_s": np.round(times, 6), "x_m": np.round(np.floor(
        states[:, 0] / step + rng.normal(0, sensor["position_noise_in_steps"], count)) * step, 7)}
    noises, changed = {}, {}
    for channel in ("fz_N", "tz_Nm")[:2 if trial.turning else 1]:
        shown, _ = readings(fine, effects, number, channel)
        values = low_passed(shown, FINE_RATE_HZ, sensor["low_pass_Hz"], sensor["delay_s"])
        changed[channel] = rms(values - shown)
        noises[channel] = coloured_noise(rng, times, sds[channel], sensor)
        columns[channel] = np.round(np.interp(moments, fine.t, values) + noises[channel], 4 if channel == "fz_N" else 6)
    if trial.turning:
        count_rad = 2 * pi / sensor["angle_counts"]
        columns["theta_rad"] = np.round(np.floor(states[:, 2] / count_rad) * count_rad, 7)
        columns = {name: columns[name] for name in ("t_s", "x_m", "theta_rad", "fz_N", "tz_Nm")}
    return columns, noises, changed["fz_N"]


# ---- how large the hidden effects are
def base_columns(samples, d, channel):
    """The base's free numbers as columns of a linear fit on the true motion."""
    join = {name: np.concatenate([getattr(s, name) for s in samples]) for name in ("x", "v", "region")}
    if channel == "tz_Nm":
        theta, omega = (np.concatenate([getattr(s, name) for s in samples]) for name in ("theta", "omega"))
        return np.column_stack([omega, np.sin(2 * pi * theta / d.rotary.detent_pitch_rad)])
    columns = []
    for i, (_, _, stiffness, _, equilibrium) in enumerate(d.plant.regions):
        inside = join["region"] == i
        if stiffness and inside.any():
            columns += [inside * (join["x"] - equilibrium), inside * join["v"]]
            columns += [] if d.equilibrium_known else [1.0 * inside]
    return np.column_stack(columns)


def left_over(values, columns):
    """Share of the rms of `values` that a linear fit of the columns leaves."""
    scaled = columns / np.maximum(np.sqrt(np.mean(columns ** 2, axis=0)), 1e-30)
    solution = np.linalg.lstsq(scaled, values, rcond=None)[0]
    return rms(values - scaled @ solution) / max(rms(values), 1e-30)


def measure(trials, effects, d):
    """For each effect: its share of its channel's rms, and what a refit of the base (and its partner) leaves of it."""
    samples = [trial.coarse for trial in trials]
    total, added = {}, []
    for channel in ("fz_N", "tz_Nm")[:2 if d.rotary else 1]:
        total[channel] = rms(np.concatenate([readings(s, effects, k, channel)[0] for k, s in enumerate(samples)]))
    for i, e in enumerate(effects):
        added.append(np.concatenate([s.added[i] + readings(s, effects, k, e.channel)[1][i]
                                     for k, s in enumerate(samples)]))
    answers = []
    for i, e in enumerate(effects):
        columns = base_columns(samples, d, e.channel)
        partners = [added[j][:, None] for j, other in enumerate(effects) if j != i and other.channel == e.channel]
        answers.append(SimpleNamespace(share=rms(added[i]) / total[e.channel], left=left_over(added[i], columns),
                                       left_with_partner=left_over(added[i], np.hstack([columns, *partners]))))
    return answers, total


def usual_motion(trials, d):
    """What the hand did without the effects: the scales that the makers of effects start from."""
    def join(name):
        return np.concatenate([getattr(t.coarse, name) for t in trials])

    def rate(name):
        return np.concatenate([np.gradient(getattr(t.coarse, name), t.coarse.t) for t in trials])
    stiffness = np.array([region[2] for region in d.plant.regions])[join("region")]
    work = np.sum(np.maximum(join("force") * join("v"), 0)) / COARSE_RATE_HZ / len(trials)
    s = SimpleNamespace(trials=d.trials, force=rms(join("force")), speed=rms(join("v")), depth=rms(join("x")),
                        speed_squared=rms(join("v") ** 2), acceleration=rms(rate("v")), force_rate=rms(rate("force")),
                        stiffness=rms(stiffness), work=float(work))
    if d.rotary:
        s.theta, s.omega, s.torque = rms(join("theta")), rms(join("omega")), rms(join("torque"))
    return s


def solve(d, effects, count):
    trials = []
    for k in range(count):
        trials.append(Trial(d.plant, d.hands[k], d.turners[k], effects, k))
        end = trials[-1].hand.path.duration - 1 / COARSE_RATE_HZ
        trials[-1].coarse = trials[-1].sample(np.arange(0.0, end, 1 / COARSE_RATE_HZ), shares=True)
    return trials


def scaled_effects(rng, d, names, shares, last):
    """The effects, sized by trying them on a few trials, then on all; trials, measures, totals; whether accepted."""
    if not names:
        trials = solve(d, [], d.trials)
        return [], trials, *measure(trials, [], d), True
    usual, effects, aims = usual_motion(solve(d, [], PILOT_TRIALS), d), [], []
    for name in names:
        usual.share = log_uniform(rng, 1.1 * shares[0], shares[1] / 1.1)
        usual.aim = usual.share * (usual.torque if name.startswith("rotary_") else usual.force)
        effects.append(LAWS[name].make(rng, usual))
        effects[-1].name = name
        aims.append(usual.share)
    counts = [PILOT_TRIALS] * 4 + [d.trials] * 2
    while True:
        count = counts.pop(0)
        trials = solve(d, effects, count)
        answers, total = measure(trials, effects, d)
        good = all(shares[0] <= a.share <= shares[1] for a in answers)
        if not counts or count == d.trials and good:
            break
        if not last and count < d.trials and min(a.left for a in answers) < 0.8 * LEAST_LEFT:
            return effects, trials, answers, total, False
        ratios = [min(max(aim / max(a.share, 1e-9), 0.3), 3.0) for aim, a in zip(aims, answers)]
        if count < d.trials and all(0.93 < ratio < 1.07 for ratio in ratios):
            counts = [d.trials] * 2
        for effect, ratio in zip(effects, ratios):
            effect.parameters.update({size: effect.parameters[size] * ratio for size in effect.size})
    return effects, trials, answers, total, good and min(a.left for a in answers) >= LEAST_LEFT


def truth_of(seed, d, effects, answers, total, trials, recorded, draws, accepted):
    outside = any(e.name in OUTSIDE for e in effects)
    every = {channel: np.concatenate([noise[channel] for _, noise, _ in recorded]) for channel in recorded[0][1]}
    pinned = np.concatenate([t.coarse.pinned for t in trials])
    return {
        "generator": NAME, "seed": seed, "rig": RIG,
        "kind": "outside" if outside else ("nothing", "one", "two")[len(effects)],
        "hidden": [{"id": e.name, "in_catalogue": e.name in CATALOGUE, "parameters": e.parameters,
                    "formula": LAWS[e.name].formula, "source": LAWS[e.name].source, "channel": e.channel,
                    "share_of_force_rms": a.share, "left_after_base_refit": a.left,
                    "left_after_base_and_partner_refit": a.left_with_partner} for e, a in zip(effects, answers)],
        "accepted": accepted, "draws": draws, "force_noise_sd_N": rms(every["fz_N"]), "force_rms_N": total["fz_N"],
        **({"torque_noise_sd_Nm": rms(every["tz_Nm"]), "torque_rms_Nm": total["tz_Nm"]} if d.rotary else {}),
        "base": {"layers": d.layers, **({"rotary": vars(d.rotary)} if d.rotary else {}),
                 "mass_above_sensor_kg": d.plant.mass_above_kg, "mass_below_sensor_kg": d.plant.mass_below_kg},
        "stated_off_by_up_to_a_tenth": ["stiffness_N_per_m", "damping_Ns_per_m", *([] if d.equilibrium_known else [
            "equilibrium_m"]), *(["viscous_Nms_per_rad", "detent_Nm"] if d.rotary else [])],
        "hand": d.hand_numbers, "sensor": {
            **d.sensor, "force_lag_s": d.sensor["delay_s"] + sqrt(2) / (2 * pi * d.sensor["low_pass_Hz"]),
            "force_changed_by_filter_and_delay_rms_N": rms([changed for _, _, changed in recorded])},
        "share_of_time_held_at_a_border": float(np.mean(pinned))}


def make(seed: int, hidden: list, shares=SHARES) -> MadeSet:
    """A measurement set with these effects hidden: none, one or two ids of CATALOGUE and OUTSIDE.

    Each makes between the two shares (1.3 apart at least) of its channel's rms.
    """
    names = sorted(hidden)
    if len(set(names)) != len(names) or len(names) > 2 or not set(names) <= set(CATALOGUE + OUTSIDE):
        raise ValueError(f"hidden is {hidden}: give none, one or two different ids of CATALOGUE and OUTSIDE")
    for draw in range(1, MAX_DRAWS + 1):
        rng = np.random.default_rng([seed, zlib.crc32("+".join(names).encode()), draw])
        d = draw_set(rng, bool(NEEDS_TURNING & set(names)) or rng.random() < 0.6)
        effects, trials, answers, total, accepted = scaled_effects(rng, d, names, shares, draw == MAX_DRAWS)
        if accepted:
            break
    model = stated_model(rng, d)
    sds = {channel: d.sensor["noise_share_of_rms"] * size for channel, size in total.items()}
    recorded = [record(rng, trial, k, effects, d.sensor, sds) for k, trial in enumerate(trials)]
    stated = {"name": f"{NAME} {seed}", "simulated": True}
    if d.noise_known:
        hum = sqrt(1 + d.sensor["hum_share_of_noise"] ** 2)
        stated["noise"] = {channel: float(f"{sd * hum * rng.uniform(0.9, 1.1):.2g}") for channel, sd in sds.items()}
    return MadeSet(model=model, stated=stated, extra_files={},
                   trials=[(f"trial{k + 1}", columns) for k, (columns, _, _) in enumerate(recorded)],
                   truth=truth_of(seed, d, effects, answers, total, trials, recorded, draw, accepted))
