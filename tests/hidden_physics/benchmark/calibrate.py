"""Fits the odds that more is missing (`MoreMissingOdds` in shared/lab/settings.hpp) to labelled answers to development sets.

An answer is labelled by the truth: does its final model lack a hidden effect that lowers the held-out error by a material share?
The model is logistic in ln(error / floor) and in the share of the error that signals predict, with coefficients of its own for
the probing force, the torque about the probe's axis and the palpation force; the share's is common, and that of the share which laws
of physics predict is the palpation's alone. A weak normal prior stands for
what is not in the data. The rows that are printed for each generator are of a fit that never saw that generator.
"""
from __future__ import annotations

import argparse
import json
import math
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import scoring  # noqa: E402

CHANNELS = ("probing", "torque", "palpation")
# at_floor of each channel, per_log_error of each channel, per_share, per_law_share: before the data, mean and standard deviation.
PRIOR_MEAN = np.array([-3.0, -3.0, -3.0, 5.0, 5.0, 5.0, 8.0, 20.0])
PRIOR_SD = np.array([1.5, 1.5, 1.5, 3.0, 3.0, 3.0, 6.0, 20.0])


def channel_answers(answer: dict) -> list:
    """The parts of an answer that are judged by themselves: the force, and where there is one the torque."""
    torque = answer.get("torque")
    return [("force", answer)] + ([("tz_Nm", torque)] if torque else [])


def row_of(truth: dict, channel: str, part: dict, catalogue: dict) -> dict:
    """Features and label of one part of an answer."""
    rig = truth["rig"]
    named = {e["id"] for e in part["effects"]}
    lacking = [h for h in truth["hidden"]
               if (rig == "palpation" or (h.get("channel") == "tz_Nm") == (channel == "tz_Nm"))
               and scoring.gain(truth, h) >= scoring.MATERIAL and scoring.known_as(h["id"], catalogue) not in named]
    last = part["steps"][-1]
    return {"channel": rig if channel == "force" else "torque", "generator": truth["generator"],
            "above": max(0.0, math.log(last["held_out_rmse"] / last["noise_floor"])),
            "share": part.get("rest_explained", 0.0), "law_share": part.get("law_explained", 0.0), "more": bool(lacking)}


def rows_of(folder: pathlib.Path, label: str) -> list:
    """Of every answer in a generation's folder."""
    catalogue = json.loads((folder / "catalogue.json").read_text())
    rows = []
    for path in sorted((folder / "answers" / label).glob("*.json")):
        truth, reply = json.loads((folder / "truth" / path.name).read_text()), json.loads(path.read_text())
        if "answer" in reply:
            rows += [row_of(truth, channel, part, catalogue[truth["rig"]])
                     for channel, part in channel_answers(reply["answer"])]
    return rows


def features(row: dict) -> list:
    at = CHANNELS.index(row["channel"])
    out = [0.0] * 8
    out[at], out[3 + at], out[6], out[7] = 1.0, row["above"], row["share"], row["law_share"]
    return out


def fitted(rows: list) -> np.ndarray:
    """The posterior's mode, by Newton's method [Hastie2009, eq. 4.26, with a normal prior]."""
    x, y = np.array([features(row) for row in rows]), np.array([float(row["more"]) for row in rows])
    odds = PRIOR_MEAN.copy()
    for _ in range(100):
        p = probability(x, odds)
        step = np.linalg.solve((x * (p * (1 - p))[:, None]).T @ x + np.diag(PRIOR_SD**-2),
                               x.T @ (y - p) - (odds - PRIOR_MEAN) / PRIOR_SD**2)
        odds = odds + step / max(1.0, np.abs(step).max())  # a whole step may overshoot where p is near 0 or 1
        if np.abs(step).max() < 1e-10:
            break
    return odds


def probability(x: np.ndarray, odds: np.ndarray) -> np.ndarray:
    return 1.0 / (1.0 + np.exp(-x @ odds))


def score(rows: list, stated: np.ndarray) -> str:
    pairs = [(float(p), row["more"]) for p, row in zip(stated, rows)]
    return (f"{len(rows):5} {sum(row['more'] for row in rows):5} {stated.mean():7.3f} {scoring.brier(pairs):7.3f} "
            f"{scoring.calibration_error(pairs):7.3f}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("generation", type=pathlib.Path, nargs="+", help="folder of a generation: truth/, answers/")
    parser.add_argument("--label", default="tractus", help="whose answers (default: tractus)")
    options = parser.parse_args()
    if any(folder.name.startswith("frozen") for folder in options.generation):
        parser.error("a frozen generation is for measuring, not for fitting")
    rows = [row for folder in options.generation for row in rows_of(folder, options.label)]
    odds = fitted(rows)
    print(f"{'channel':22} at_floor  per_log_error  per_share  per_law_share")
    for k, channel in enumerate(CHANNELS):
        print(f"{channel:22} {odds[k]:8.2f} {odds[3 + k]:14.2f} {odds[6]:10.2f} {odds[7]:14.2f}")
    print(f"\n{'fit without':22} parts  more  stated   Brier     ECE")
    for generator in sorted({row["generator"] for row in rows}):
        held = [row for row in rows if row["generator"] == generator]
        others = fitted([row for row in rows if row["generator"] != generator])
        print(f"{generator:22} {score(held, probability(np.array([features(r) for r in held]), others))}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
