"""Rivals of the lab that read the same files: sparse regression, a Gaussian process, and the best single effect.

Each channel is a linear model y = base columns + library columns. Columns of the library are those of the catalogue's
effects, with a grid where an effect has a number that is not linear. All methods work on the Gram matrices of the
trials, so that leaving a trial out costs a solution of a small system. None states a probability.

    best_single        the effect that lowers the leave-one-trial-out error most, always
    stlsq              sequentially thresholded least squares (S. L. Brunton, J. L. Proctor, J. N. Kutz, PNAS 113
                       (2016), 3932-3937), threshold by the leave-one-trial-out error
    lasso_bic          LASSO (R. Tibshirani, J. R. Stat. Soc. B 58 (1996), 267-288) by coordinate descent, its path
                       judged by BIC (G. Schwarz, Ann. Stat. 6 (1978), 461-464) after a refit
    gaussian_process   a Gaussian process of depth and speed alone, by random Fourier features (A. Rahimi, B. Recht,
                       NIPS 2007): "unexplained" where it lowers the leave-one-trial-out error by 2 %
"""
from __future__ import annotations

import json
import math
import pathlib
import time
from dataclasses import dataclass

import numpy as np

MATERIAL = 0.02
RIDGE = 1e-9
RIDGES = np.geomspace(1e-5, 10.0, 7)  # of the Gaussian process: noise over prior variance
THRESHOLDS = np.geomspace(2e-3, 0.2, 12)  # of a column's share of the channel's rms
PENALTIES = np.geomspace(1.0, 1e-3, 40)


@dataclass
class Channel:
    """One measured signal and its columns: per trial y, base, library and the features of a Gaussian process."""
    name: str
    ids: list  # the effect of each library column
    trials: list  # (y, base [n, b], library [n, m], features [n, f], slow [n, s]); slow: per-trial trends of a drift


def read_columns(path: pathlib.Path) -> dict:
    names = path.open().readline().strip().split(",")
    values = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    return dict(zip(names, values.T))


def read_trials(folder: pathlib.Path) -> list:
    index = json.loads((folder / "set.json").read_text())
    return [read_columns(folder / trial["file"]) for trial in index["trials"]]


class Grams:
    """Gram matrices of [base, library, features, y] for each trial; with `drift`, slow trends are projected out."""

    def __init__(self, channel: Channel, drift: bool):
        self.ids, self.count = channel.ids, 0
        _, base, library, features, _ = channel.trials[0]
        b, m, f = base.shape[1], library.shape[1], features.shape[1]
        self.base, self.library, self.features = list(range(b)), list(range(b, b + m)), list(range(b + m, b + m + f))
        grams = []
        for y, base, library, features, slow in channel.trials:
            a = np.column_stack([base, library, features, y])
            if drift:
                q = np.linalg.qr(slow)[0]
                a = a - q @ (q.T @ a)
            grams.append(a.T @ a)
            self.count += len(y)
        self.scale = np.sqrt(np.maximum(np.diag(sum(grams))[:-1], 1e-30))
        scale = np.append(self.scale, 1.0)
        self.grams = [g / np.outer(scale, scale) for g in grams]
        self.total = sum(self.grams)
        self.size = math.sqrt(self.total[-1, -1])  # root of the sum of squares of y

    def solved(self, gram, columns, ridge=RIDGE):
        """Least squares with a ridge on all columns but the base; columns have norm 1 over all trials."""
        a = gram[np.ix_(columns, columns)]
        penalties = np.where(np.array(columns) < len(self.base), RIDGE, ridge)
        return np.linalg.solve(a + np.diag(penalties), gram[columns, -1])

    def error(self, columns, ridge=RIDGE) -> float:
        """Root mean square of what a fit to the other trials leaves of each trial."""
        left = 0.0
        for gram in self.grams:
            x = self.solved(self.total - gram, columns, ridge)
            left += gram[-1, -1] - 2 * x @ gram[columns, -1] + x @ gram[np.ix_(columns, columns)] @ x
        return math.sqrt(max(left, 0.0) / self.count)

    def squares(self, columns) -> float:
        """Sum of squares that a fit to all trials leaves."""
        x = self.solved(self.total, columns)
        return max(self.total[-1, -1] - x @ self.total[columns, -1], 1e-30)

    def of(self, names) -> list:
        return [i for i, name in zip(self.library, self.ids) if name in names]


def variants(grams: Grams, name: str) -> list:
    """Each candidate of one effect alone: columns that belong together carry the same id and variant."""
    groups: dict = {}
    for i, key in zip(grams.library, grams.ids):
        if key[0] == name:
            groups.setdefault(key[1], []).append(i)
    return list(groups.values())


def best_single(channels: list) -> dict:
    best = None
    for channel in channels:
        plain = Grams(channel, False)
        before = plain.error(plain.base)
        tried = [(min(plain.error(plain.base + v) for v in variants(plain, name)), name)
                 for name in sorted({key[0] for key in plain.ids})]
        if channel is channels[0]:
            tried.append((Grams(channel, True).error(plain.base), "sensor_drift"))
        error, name = min(tried)
        if best is None or error / before < best[0]:
            best = (error / before, name, before, error, channel is channels[0])
    _, name, before, error, primary = best
    if not primary:  # the steps are those of the primary channel, which an effect on the torque does not change
        before = error = None
    return reply([name], before, error)


def names_of(grams: Grams, columns) -> list:
    """The effects that have a column among these, in the library's order."""
    kept = set(columns)
    return list(dict.fromkeys(key[0] for i, key in zip(grams.library, grams.ids) if i in kept))


def thresholded(grams: Grams, threshold: float) -> list:
    """The library columns that sequential thresholding keeps."""
    kept = list(grams.library)
    for _ in range(20):
        x = grams.solved(grams.total, grams.base + kept, 1e-6)[len(grams.base):]
        left = [i for i, value in zip(kept, x) if abs(value) >= threshold * grams.size]  # columns have norm 1
        if left == kept:
            break
        kept = left
    return kept


def stlsq_columns(grams: Grams) -> tuple:
    tried = [(grams.error(grams.base + kept), len(kept), kept)
             for kept in (thresholded(grams, t) for t in THRESHOLDS)]
    error, _, kept = min(tried)
    return error, kept


def lasso_columns(grams: Grams) -> tuple:
    """The columns of the LASSO path with the least BIC; the base is not penalised."""
    b, m = grams.base, grams.library
    g = grams.total
    onto = np.linalg.solve(g[np.ix_(b, b)] + RIDGE * np.eye(len(b)), g[np.ix_(b, [*m, -1])])
    schur = g[np.ix_(m, [*m, -1])] - g[np.ix_(m, b)] @ onto  # the base projected out
    a, c = schur[:, :-1], schur[:, -1]
    x, diagonal, best = np.zeros(len(m)), np.maximum(np.diag(a).copy(), 1e-12), None
    for penalty in PENALTIES * np.abs(c).max():
        for _ in range(60):
            most = 0.0
            for j in range(len(m)):
                free = c[j] - a[j] @ x + diagonal[j] * x[j]
                new = math.copysign(max(abs(free) - penalty, 0.0), free) / diagonal[j]
                most, x[j] = max(most, abs(new - x[j])), new
            if most < 1e-6 * grams.size:
                break
        kept = [i for i, value in zip(m, x) if value != 0.0]
        bic = grams.count * math.log(grams.squares(b + kept) / grams.count) + len(kept) * math.log(grams.count)
        if best is None or bic < best[0]:
            best = (bic, kept)
    return grams.error(b + best[1]), best[1]


def sparse(channels: list, choose) -> dict:
    named, before, after = [], None, None
    for channel in channels:
        plain = Grams(channel, False)
        error, kept = choose(plain)
        found = names_of(plain, kept)
        if channel is channels[0]:
            drifting = Grams(channel, True)
            with_drift, kept_then = choose(drifting)
            before, after = plain.error(plain.base), error
            if with_drift < (1 - MATERIAL) * error:
                after, found = with_drift, [*names_of(drifting, kept_then), "sensor_drift"]
        named += [name for name in found if name not in named]
    return reply(named, before, after)


def gaussian_process(channels: list) -> dict:
    grams = Grams(channels[0], False)
    before = grams.error(grams.base)
    after = min(grams.error(grams.base + grams.features, ridge) for ridge in RIDGES)
    unexplained = after < (1 - MATERIAL) * before
    return reply([], before, after if unexplained else before, "unexplained" if unexplained else "complete")


def reply(named, before, after, verdict=None) -> dict:
    """An answer in the words of `tractus diagnose --json`."""
    steps = [{"model": "base", "held_out_rmse": before}]
    if named or verdict == "unexplained":
        steps.append({"model": "+ " + "+".join(named or ["unknown function"]), "held_out_rmse": after})
    return {"verdict": verdict or ("missing" if named else "complete"), "probability": None,
            "effects": [{"id": name, "parameters": {}} for name in named], "steps": steps, "base": {}}


SOLVERS = {"best_single": best_single, "stlsq": lambda c: sparse(c, stlsq_columns),
           "lasso_bic": lambda c: sparse(c, lasso_columns), "gaussian_process": gaussian_process}


def answered_all(solvers: list, folder: pathlib.Path) -> dict:
    """Replies of several solvers to one set; the columns are made once and their time is counted to each."""
    started, used = time.monotonic(), time.process_time()
    model = json.loads((folder / "model.json").read_text())
    if model["rig"] == "probing":
        import probing_library as library
    else:
        import palpation_library as library
    channels = library.channels_of(model, read_trials(folder / "measurements"), folder / "measurements")
    made_s, made_cpu_s, replies = time.monotonic() - started, time.process_time() - used, {}
    for solver in solvers:
        begun, used = time.monotonic(), time.process_time()
        answer = SOLVERS[solver](channels)
        replies[solver] = {"answer": answer, "wall_s": made_s + time.monotonic() - begun,
                           "cpu_s": made_cpu_s + time.process_time() - used}
    return replies
