#!/usr/bin/env python3
"""Calibrates the lab's stated probabilities on sets of all generators but one, and says how they do on that one.

    tests/hidden_physics/benchmark/calibration.py build/hidden-physics/development [more folders] [--label tractus]

A stated probability p becomes 1 / (1 + exp(-(a + b ln(p / (1 - p))))) (J. C. Platt, in Advances in Large Margin
Classifiers, MIT Press 1999, 61-74), with numbers a, b for answers that end the matter (complete, missing) and others for
those that say that more is missing (partly, unexplained). Believed before: a = 0 +- 1, b = 1 +- 0.5, so that few sets
change little. The maps compose: what is printed last stands for the numbers in `CalibrationSettings`
(shared/lab/settings.hpp) with what the sets add to them.
"""
from __future__ import annotations

import argparse
import math
import pathlib
import re
import sys
from dataclasses import dataclass

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE)]
import report  # noqa: E402
import scoring  # noqa: E402

SETTINGS = HERE.parents[2] / "shared/lab/settings.hpp"
CERTAIN = 1e-3  # a probability nearer to 0 or 1 counts as this near
SD_OFFSET, SD_SLOPE = 1.0, 0.5  # what is believed before the sets
STEPS = 50  # of Newton's method, which needs about ten


@dataclass(frozen=True)
class Map:
    """From stated to calibrated odds, in logarithms: offset + slope * stated."""
    offset: float = 0.0
    slope: float = 1.0

    def __call__(self, p: float) -> float:
        return 1 / (1 + math.exp(-(self.offset + self.slope * log_odds(p))))

    def after(self, first: "Map") -> "Map":
        """The one map that does what `first` and then this one do."""
        return Map(self.offset + self.slope * first.offset, self.slope * first.slope)


@dataclass(frozen=True)
class Stated:
    """One answer: from which generator, what it said of itself, and whether it was right."""
    generator: str
    group: str
    probability: float
    right: bool


def log_odds(p: float) -> float:
    p = min(max(p, CERTAIN), 1 - CERTAIN)
    return math.log(p / (1 - p))


def group_of(verdict: str) -> str:
    return "more_is_missing" if verdict in scoring.ANNOUNCING else "ended"


GROUPS = ("ended", "more_is_missing")


def cost(a: float, b: float, seen: list) -> float:
    """Minus the logarithm of the map's probability after the answers, but for a constant. seen: (log odds, right)."""
    prior = (a / SD_OFFSET) ** 2 / 2 + ((b - 1) / SD_SLOPE) ** 2 / 2
    return prior + sum(log_of_one_plus_exp(-(a + b * x) if right else a + b * x) for x, right in seen)


def log_of_one_plus_exp(u: float) -> float:
    return u + math.log1p(math.exp(-u)) if u > 0 else math.log1p(math.exp(u))


def newton_step(a: float, b: float, seen: list) -> tuple:
    ga, gb = a / SD_OFFSET ** 2, (b - 1) / SD_SLOPE ** 2
    haa, hab, hbb = 1 / SD_OFFSET ** 2, 0.0, 1 / SD_SLOPE ** 2
    for x, right in seen:
        p = math.exp(-log_of_one_plus_exp(-(a + b * x)))
        w = p * (1 - p)
        ga, gb = ga + p - right, gb + (p - right) * x
        haa, hab, hbb = haa + w, hab + w * x, hbb + w * x * x
    det = haa * hbb - hab * hab
    return (hab * gb - hbb * ga) / det, (hab * ga - haa * gb) / det


def fitted(answers: list) -> Map:
    """The most probable map of these answers, by Newton's method with steps that are halved until they help."""
    seen = [(log_odds(x.probability), x.right) for x in answers]
    a, b = 0.0, 1.0
    for _ in range(STEPS):
        da, db = newton_step(a, b, seen)
        if abs(da) + abs(db) < 1e-12:
            break
        now, share = cost(a, b, seen), 1.0
        while cost(a + share * da, b + share * db, seen) > now and share > 1e-6:
            share /= 2
        a, b = a + share * da, b + share * db
    return Map(a, b)


def maps_of(answers: list) -> dict:
    """One map for each group of answers."""
    return {group: fitted([x for x in answers if x.group == group]) for group in GROUPS}


def calibrated(answers: list, maps: dict) -> list:
    """(probability, right) of the answers under the maps."""
    return [(maps[x.group](x.probability), x.right) for x in answers]


def left_out(answers: list) -> dict:
    """By generator: (as stated, as calibrated on all other generators), each a list of (probability, right)."""
    found = {}
    for generator in sorted({x.generator for x in answers}):
        mine = [x for x in answers if x.generator == generator]
        maps = maps_of([x for x in answers if x.generator != generator])
        found[generator] = [(x.probability, x.right) for x in mine], calibrated(mine, maps)
    return found


def answers_in(places: list, label: str) -> list:
    """Every answer with a probability to a set whose effects can be seen at all."""
    found = []
    for place in places:
        for o in report.outcomes_of(pathlib.Path(place)).get(label, []):
            if o.detectable and o.probability is not None:
                found.append(Stated(o.generator, group_of(o.verdict), o.probability, o.right))
    return found


def maps_in_use(text: str) -> dict:
    """The numbers of CalibrationSettings in the lab's settings."""
    block = re.search(r"struct CalibrationSettings \{(.*?)\n\};", text, re.S).group(1)
    numbers = dict(re.findall(r"double (\w+) = (-?[\d.]+);", block))
    return {group: Map(float(numbers[f"{group}_offset"]), float(numbers[f"{group}_slope"])) for group in GROUPS}


def shown_row(name: str, before: list, after: list) -> list:
    numbers = [f(x) for f in (scoring.calibration_error, scoring.brier) for x in (before, after)]
    mean = sum(p for p, _ in before) / len(before), sum(p for p, _ in after) / len(after)
    return [name, str(len(before)), f"{sum(r for _, r in before) / len(before):.3f}", *(f"{m:.3f}" for m in mean),
            *(f"{n:.3f}" for n in numbers)]


def table(answers: list) -> str:
    rows = [["left out", "sets", "right", "stated", "calibrated", "ECE stated", "calibrated", "Brier stated", "calibrated"]]
    by_generator = left_out(answers)
    rows += [shown_row(name, before, after) for name, (before, after) in by_generator.items()]
    pooled = [sum((pair[k] for pair in by_generator.values()), []) for k in (0, 1)]
    rows.append(shown_row("all", *pooled))
    curve = [["stated, mean", "right", "sets"], *([f"{p:.3f}", f"{r:.3f}", str(n)]
                                                 for p, r, n in scoring.reliability(pooled[1]))]
    return report.grid(rows) + "\n\nreliability of the calibrated, each generator by the others\n" + report.grid(curve)


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("places", nargs="+", metavar="FOLDER", help="a generation's folder with answers")
    parser.add_argument("--label", default="tractus", help="whose answers (default: tractus)")
    options = parser.parse_args(arguments)
    answers = answers_in(options.places, options.label)
    if len({x.generator for x in answers}) < 2:
        raise SystemExit(f"calibration: {len(answers)} answers of fewer than two generators: nothing can be left out")
    print(table(answers))
    now, new = maps_in_use(SETTINGS.read_text()), maps_of(answers)
    for group in GROUPS:
        both = new[group].after(now[group])
        count = sum(x.group == group for x in answers)
        print(f"\n{group}: of {count} sets; {group}_offset = {both.offset:.3f}, {group}_slope = {both.slope:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
