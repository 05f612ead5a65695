"""The definitions of the benchmark: what a right answer is, and every figure of the table. Pure functions.

A set hides effects (its truth) and is recorded by a sensor chain that may itself delay and drift. Effects of the truth
are *known* where the program's catalogue has them, else *foreign*. Named are the effects of the answer.

    gain of an effect   1 - floor / sqrt(floor^2 + left^2): by how much a model with the effect lowers the held-out
                        error of a model without it; left is the rms that a refit of the base leaves of the effect
    detectable          every hidden effect has a gain of 2 % at least; other sets are scored apart
    granted             effects that the sensor chain truly does, beside the truth: naming them is not wrong
    wrong               named, neither hidden nor granted
    exact               nothing wrong, every known effect named, and "unexplained" only where something is foreign
    announced           the verdict says that something is missing that is in no catalogue
    right               exact, and where something is foreign, announced
    useless             named although the held-out error did not fall when the effect was added, or although the
                        model found leaves no less of the fresh trials than the fitted base ("fresh trials")
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field

MATERIAL = 0.02  # share of the held-out error
Z95, Z90 = 1.959964, 1.644854  # quantiles of the normal distribution, two-sided
BINS = 10
RIGHT_MODEL_WITHIN, PHASE_WITHIN, PHASE_SHARE = 1.05, 1.2, 0.02
# Effects outside the catalogue of today and the ids under which a catalogue of tomorrow may list them.
ALSO_CALLED = {
    "bouc_wen": {"bouc_wen", "bouc_wen_hysteresis"},
    "bouc_wen_hysteresis": {"bouc_wen", "bouc_wen_hysteresis"},
    "direction_drag": {"direction_drag", "direction_dependent_drag"},
    "direction_dependent_drag": {"direction_drag", "direction_dependent_drag"},
    "direction_dependent_viscosity": {"direction_drag", "direction_dependent_drag"},
    "bone_gives_way": {"bone_gives_way", "bone_compliance"},
}
ANNOUNCING = {"unexplained", "partly"}


@dataclass
class Outcome:
    """What one solver's answer to one set comes to."""
    set: str
    rig: str
    generator: str
    kind: str
    hidden: tuple
    known: tuple = ()
    foreign: tuple = ()
    detectable: bool = True
    gains: dict = field(default_factory=dict)
    failed: str = ""
    verdict: str = ""
    named: tuple = ()
    wrong: tuple = ()
    missed: tuple = ()
    useless: tuple = ()
    announced: bool = False
    exact: bool = False
    named_in: bool = False
    right: bool = False
    near: bool = False  # wrong, but each wrong name is a limit of a hidden effect or has one as its limit
    probability: float | None = None
    covered: tuple = ()  # of each parameter of a rightly named effect: whether its 90 % interval holds the truth
    held_out_over_floor: float | None = None
    fresh_over_floor: float | None = None
    stated_floor_over_floor: float | None = None
    right_model_over_floor: float | None = None
    right_model_worst_phase: float | None = None
    judged_share: float | None = None  # of the fresh trials' samples
    wall_s: float | None = None
    cpu_s: float | None = None


# ---- truth
def true_floor(truth: dict, channel: str = "force") -> float:
    """Standard deviation that sensor and motion noise leave of a true model, in N (vector length) or N m."""
    sensor, chain = truth.get("sensor", {}), truth.get("chain", {})
    if channel == "tz_Nm":
        native = truth.get("torque_noise_sd_Nm", sensor.get("white_noise_sd_Nm", 0.0))
        unit, axes = "Nm", 1
    else:
        native = truth.get("force_noise_without_filter_sd_N", truth["force_noise_sd_N"])
        native = math.hypot(native, sensor.get("pose_noise_as_force_sd_N", 0.0),
                            chain.get("motion_noise_as_force_N", 0.0), chain.get("crosstalk_as_force_N", 0.0))
        unit, axes = "N", 3 if truth["rig"] == "palpation" else 1
    added = chain.get("noise_sd", {}).get(unit, 0.0) ** 2 + chain.get("step", {}).get(unit, 0.0) ** 2 / 12
    return math.sqrt((chain.get("gain", 1.0) * native) ** 2 + axes * added)


def gain(truth: dict, hidden: dict) -> float:
    """By how much the held-out error falls when this hidden effect is modelled, as a share."""
    channel = hidden.get("channel", "force")
    rms = truth["torque_rms_Nm"] if channel == "tz_Nm" else truth["force_rms_N"]
    left = rms * hidden["share_of_force_rms"] * hidden.get("left_after_base_and_partner_refit",
                                                           hidden["left_after_base_refit"])
    floor = true_floor(truth, channel)
    return 1 - floor / math.hypot(floor, left) if left > 0 else 0.0


def granted(truth: dict) -> set:
    """Effects that the sensor chain and the rig truly have, beside what is hidden."""
    sensor = truth.get("sensor", {})
    ids = set()
    if truth.get("chain", {}).get("delay_s", 0.0) > 0 or sensor.get("delay_s", 0.0) > 0:
        ids.add("time_delay")
    if sensor.get("wander_range_N", 0.0) > 0:
        ids |= {"sensor_drift", "sensor_bias"}
    if truth.get("base", {}).get("mass_below_sensor_kg", 0.0) > 0:
        ids.add("inertia")
    return ids


def known_as(hidden_id: str, catalogue: dict) -> str | None:
    """The id under which the catalogue lists a hidden effect."""
    names = [n for n in sorted(ALSO_CALLED.get(hidden_id, {hidden_id})) if n in catalogue]
    return hidden_id if hidden_id in names else names[0] if names else None


def true_numbers(truth: dict, rig: str, info: dict, numbers: dict) -> dict:
    """The true numbers of an effect as the recordings have them: the chain's gain and delay included."""
    scale, seen = truth.get("chain", {}).get("gain", 1.0), {}
    for p in info["parameters"]:
        if p["name"] not in numbers:
            continue
        value, unit = numbers[p["name"]], p["unit"]
        scaled = unit in ("N", "N·m", "kg") if rig == "palpation" else ("N" in unit or unit == "kg")
        if p["name"] == "delay_s":
            value = value + truth.get("chain", {}).get("delay_s", 0.0) + truth.get("sensor", {}).get("force_lag_s", 0.0)
        if scaled:
            value = [scale * v for v in value] if isinstance(value, list) else scale * value
        seen[p["name"]] = value
    return seen


# ---- one answer
def covered_by(effect: dict, true: dict, units: dict) -> list:
    """For each component with a standard error: whether its 90 % interval holds the true value; angles modulo 2 pi."""
    held = []
    for name, value in true.items():
        stated = effect.get("parameters", {}).get(name)
        if not stated or stated.get("sd") is None:
            continue
        lists = [x if isinstance(x, list) else [x] for x in (stated["value"], stated["sd"], value)]
        for got, sd, want in zip(*lists):
            if sd is None:
                continue
            error = got - want
            if units.get(name) == "rad":
                error = math.remainder(error, 2 * math.pi)
            held.append(abs(error) <= Z90 * sd)
    return held


def errors_of(compared: dict) -> list:
    """By channel: an effect about the probe's axis lowers the torque's error alone."""
    return [compared["rmse"], *compared.get("other_rmse", [])]


def useless_steps(steps: list) -> list:
    """The effects whose step did not lower the held-out error."""
    return [after["model"].removeprefix("+ ") for before, after in zip(steps, steps[1:])
            if None not in (before["held_out_rmse"], after["held_out_rmse"])
            and after["held_out_rmse"] >= before["held_out_rmse"]]


def near_to(wrong: tuple, hidden: tuple, catalogue: dict) -> bool:
    """Whether each wrong name and a hidden effect are a limit of one another, by what the catalogue says."""
    def contains(a, b):
        return b in catalogue.get(a, {}).get("contains", [])
    return bool(wrong) and all(any(contains(w, h) or contains(h, w) for h in hidden) for w in wrong)


def outcome(truth: dict, reply: dict, catalogue: dict) -> Outcome:
    """Scores one reply to one set against the catalogue of the set's rig."""
    hidden = tuple(h["id"] for h in truth["hidden"])
    names = {h: known_as(h, catalogue) for h in hidden}
    known = tuple(n for n in names.values() if n)
    foreign = tuple(h for h, n in names.items() if not n)
    gains = {h["id"]: gain(truth, h) for h in truth["hidden"]}
    o = Outcome(truth["set"], truth["rig"], truth["generator"], truth["kind"], hidden, known, foreign,
                all(g >= MATERIAL for g in gains.values()), gains, wall_s=reply.get("wall_s"), cpu_s=reply.get("cpu_s"))
    if "answer" not in reply:
        o.failed, o.missed = reply.get("failed", "no answer"), known
        return o
    answer, floor = reply["answer"], true_floor(truth)
    o.verdict, o.probability = answer["verdict"], answer.get("probability")
    o.named = tuple(e["id"] for e in answer["effects"])
    o.wrong = tuple(n for n in o.named if n not in known and n not in granted(truth))
    seen = tuple(names[h] for h in hidden if names[h] and gains[h] >= MATERIAL)
    o.missed = tuple(k for k in (known if o.detectable else seen) if k not in o.named)
    o.near = near_to(o.wrong, known, catalogue)
    o.named_in = bool(known) and set(known) <= set(o.named)
    o.announced = o.verdict in ANNOUNCING if foreign else o.verdict == "unexplained"
    o.exact = not o.wrong and not o.missed and (bool(foreign) or not o.announced)
    o.right = o.exact and (o.announced or not foreign or not o.detectable)
    steps = answer.get("steps", [])
    o.useless = tuple(useless_steps(steps))
    if steps and steps[-1]["held_out_rmse"] is not None:
        o.held_out_over_floor = steps[-1]["held_out_rmse"] / floor
    if answer.get("base", {}).get("noise_floor"):
        o.stated_floor_over_floor = answer["base"]["noise_floor"] / floor
    for effect in answer["effects"]:
        origin = next((h for h in truth["hidden"] if names[h["id"]] == effect["id"]), None)
        if origin:
            info = catalogue[effect["id"]]
            true = true_numbers(truth, truth["rig"], info, origin["parameters"])
            o.covered += tuple(covered_by(effect, true, {p["name"]: p["unit"] for p in info["parameters"]}))
    if (reply.get("fresh") or {}).get("rmse") is not None:
        o.fresh_over_floor = reply["fresh"]["rmse"] / floor
        o.judged_share = next((j["share"] for j in reply["fresh"].get("judgements", []) if j["judgement"] == "judged"),
                              None)
        base = reply.get("fresh_base") or {}
        if o.named and base.get("rmse") is not None and not any(
                found < given for found, given in zip(errors_of(reply["fresh"]), errors_of(base), strict=True)):
            o.useless += ("fresh trials",)
    right = (reply.get("right_model") or {}).get("fresh") or {}
    if right.get("rmse") is not None and not foreign:
        o.right_model_over_floor = right["rmse"] / floor
        worst = [p["rmse"] / floor for p in right.get("phases", [])
                 if p["rmse"] is not None and p["share_of_time"] >= PHASE_SHARE]
        o.right_model_worst_phase = max(worst, default=None)
    return o


# ---- many answers
def wilson(hits: int, count: int, z: float = Z95) -> tuple:
    """Confidence interval of a rate (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927), 209-212)."""
    if not count:
        return 0.0, 1.0
    rate, share = hits / count, z * z / count
    middle = (rate + share / 2) / (1 + share)
    half = z / (1 + share) * math.sqrt(rate * (1 - rate) / count + share / (4 * count))
    return max(0.0, middle - half), min(1.0, middle + half)


@dataclass(frozen=True)
class Rate:
    """How often something was so, of how many."""
    hits: int
    count: int

    @property
    def interval(self):
        return wilson(self.hits, self.count)


def rate(values) -> Rate:
    values = list(values)
    return Rate(sum(map(bool, values)), len(values))


def brier(stated: list) -> float | None:
    """Mean squared difference of stated probability and outcome (G. W. Brier, Mon. Weather Rev. 78 (1950), 1-3)."""
    return sum((p - r) ** 2 for p, r in stated) / len(stated) if stated else None


def reliability(stated: list, bins: int = BINS) -> list:
    """Bins of equal width of the stated probability: (mean stated, share right, count); empty bins are left out."""
    groups: dict = {}
    for p, r in stated:
        groups.setdefault(min(int(p * bins), bins - 1), []).append((p, r))
    return [(sum(p for p, _ in g) / len(g), sum(r for _, r in g) / len(g), len(g)) for _, g in sorted(groups.items())]


def calibration_error(stated: list, bins: int = BINS) -> float | None:
    """Expected calibration error: |mean stated - share right| of the bins, weighted by their counts."""
    return sum(n * abs(p - r) for p, r, n in reliability(stated, bins)) / len(stated) if stated else None


def median(values):
    ordered = sorted(v for v in values if v is not None)
    if not ordered:
        return None
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2


def quantile(values, share):
    """The smallest value below or at which this share of the values lies."""
    ordered = sorted(v for v in values if v is not None)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)] if ordered else None


def figures(outcomes: list) -> dict:
    """Every figure of the table for a group of outcomes of one solver."""
    sure = [o for o in outcomes if o.detectable]
    empty = [o for o in sure if not o.hidden]
    single = [o for o in sure if len(o.hidden) == 1 and not o.foreign]
    pairs = [o for o in sure if len(o.hidden) == 2 and not o.foreign]
    outside = [o for o in sure if o.foreign]
    stated = [(o.probability, o.right) for o in sure if o.probability is not None]
    right_models = [o.right_model_over_floor for o in outcomes if o.right_model_over_floor is not None]
    phases = [o.right_model_worst_phase for o in outcomes if o.right_model_worst_phase is not None]
    return {
        "answered": rate(not o.failed for o in outcomes),
        "nothing_said_nothing": rate(o.right for o in empty),
        "false_alarm": rate(bool(o.wrong) or o.verdict == "unexplained" for o in empty),
        "single_exact": rate(o.right for o in single),
        "single_named_in": rate(o.named_in for o in single),
        "pair_both_exact": rate(o.right for o in pairs),
        "pair_both_named_in": rate(o.named_in for o in pairs),
        "outside_announced": rate(o.announced for o in outside),
        "outside_right": rate(o.right for o in outside),
        "undetectable_right": rate(o.right for o in outcomes if not o.detectable),
        "wrong_effect_named": rate(bool(o.wrong) for o in outcomes),
        "useless_effect_named": rate(bool(o.useless) for o in outcomes),
        "intervals_hold_truth": rate(c for o in outcomes for c in o.covered),
        "right_model_close": rate(r <= RIGHT_MODEL_WITHIN for r in right_models),
        "right_model_phases_close": rate(p <= PHASE_WITHIN for p in phases),
        "brier": brier(stated), "calibration_error": calibration_error(stated), "reliability": reliability(stated),
        "stated_mean": sum(p for p, _ in stated) / len(stated) if stated else None,
        "right": rate(r for _, r in stated),
        "held_out_over_floor": [median(o.held_out_over_floor for o in sure),
                                quantile([o.held_out_over_floor for o in sure], 0.9)],
        "right_model_over_floor": [median(right_models), quantile(right_models, 0.9)],
        "stated_floor_over_floor": median(o.stated_floor_over_floor for o in outcomes),
        "judged_share": [median(o.judged_share for o in outcomes), quantile([o.judged_share for o in outcomes], 0.1)],
        "cpu_s": [median(o.cpu_s for o in outcomes), quantile([o.cpu_s for o in outcomes], 0.9)],
        "wall_s": [median(o.wall_s for o in outcomes), quantile([o.wall_s for o in outcomes], 0.9)],
    }
