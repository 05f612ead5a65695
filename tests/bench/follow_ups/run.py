#!/usr/bin/python3
"""Is the gain that a recommended recording promises what it then brings?

Makes sets (SIMULATED here, by physics of this file alone) that a few strokes leave undecided, asks
`tractus diagnose --next-recording`, makes the recording that it recommends with the same truth, asks again, and compares the
rise of the true structure's probability with what was promised.

    tests/bench/follow_ups/run.py --seeds 1..200 --jobs 2
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[3]
RATE_HZ = 1000.0
SLOW_M_S = 5e-5  # over which sgn(v) is smoothed


def sign(v):
    return numpy.tanh(v / SLOW_M_S)


def decayed(rate, x):
    """z' = rate-like memory of the way: exact over each step, Dahl's state of yield 1/rate."""
    z = numpy.zeros(len(x))
    for i in range(1, len(x)):
        dx = x[i] - x[i - 1]
        keep = numpy.exp(-abs(dx) * rate)
        z[i] = keep * z[i - 1] + numpy.sign(dx) * (1.0 - keep) / rate
    return z


def relaxed(x, time_s):
    z = numpy.zeros(len(x))
    keep = numpy.exp(-1.0 / RATE_HZ / time_s)
    for i in range(1, len(x)):
        z[i] = keep * z[i - 1] + (x[i] - x[i - 1]) * (1.0 - keep) * time_s * RATE_HZ
    return z


def hidden_force(kind, size, x, v, a, bone):
    """Forces by the formulas of the literature, written down here: Coulomb, Stribeck, Dahl, Maxwell, quadratic drag, mass."""
    if kind == "coulomb_friction":
        return size * sign(v)
    if kind == "stribeck_friction":
        return size * (0.5 + 0.5 * numpy.exp(-((v / 0.004) ** 2))) * sign(v)
    if kind == "hysteresis":
        return size / 4e-4 * decayed(1.0 / 4e-4, x)
    if kind == "viscoelastic_relaxation":
        return size / 0.003 * relaxed(x, 0.4)
    if kind == "quadratic_drag":
        return size * v * abs(v) / 0.02**2
    if kind == "inertia":
        return size / 2.0 * a
    return numpy.zeros(len(x))


KINDS = ["coulomb_friction", "stribeck_friction", "hysteresis", "viscoelastic_relaxation", "quadratic_drag", "inertia", ""]


def rest_to_rest(start, goal, speed, acceleration):
    """Positions of one move whose speed rises and falls as half a cosine, from the format's description."""
    way = abs(goal - start)
    if way == 0.0:
        return numpy.zeros(0)
    top = min(speed, numpy.sqrt(way * acceleration))
    rise, even = top / acceleration, way / top - top / acceleration
    time = numpy.arange(1, int((2 * rise + even) * RATE_HZ) + 1) / RATE_HZ
    rate = numpy.where(time < rise, 0.5 * (1 - numpy.cos(numpy.pi * time / rise)),
                       numpy.where(time > rise + even, 0.5 * (1 - numpy.cos(numpy.pi * (2 * rise + even - time) / rise)), 1.0))
    done = numpy.cumsum(numpy.clip(rate, 0.0, 1.0))
    return start + (goal - start) * done / done[-1]


def motion_of(program):
    pieces, here = [numpy.full(50, program["start_m"])], program["start_m"]
    for move in program["moves"]:
        pieces.append(rest_to_rest(here, move["to_m"], move["speed_m_s"], program["acceleration_m_s2"]))
        pieces.append(numpy.full(int(move["hold_s"] * RATE_HZ), move["to_m"]))
        here = move["to_m"]
    return numpy.concatenate(pieces)


class Truth:
    def __init__(self, seed):
        self.random = numpy.random.default_rng(seed)
        self.kind = KINDS[seed % len(KINDS)]
        self.stiffness = self.random.uniform(1500.0, 6000.0)
        self.damping = self.random.uniform(300.0, 2000.0)
        self.noise_N = self.random.uniform(0.03, 0.1)
        self.size_N = self.noise_N * numpy.exp(self.random.uniform(numpy.log(0.8), numpy.log(6.0)))

    def recording(self, x):
        x = numpy.convolve(numpy.pad(x, 10, mode="edge"), numpy.hanning(21) / numpy.hanning(21).sum(), "valid")
        v = numpy.gradient(x) * RATE_HZ
        a = numpy.gradient(v) * RATE_HZ
        bone = self.stiffness * (x - 0.004) + self.damping * v
        force = bone + hidden_force(self.kind, self.size_N, x, v, a, bone)
        return numpy.column_stack([numpy.arange(len(x)) / RATE_HZ, x + self.random.normal(0, 2e-7, len(x)),
                                   force + self.random.normal(0, self.noise_N, len(x))])

    def first_motion(self):
        """A person's strokes: few speeds, one range."""
        speed = self.random.uniform(0.004, 0.02)
        moves = []
        for _ in range(4):
            moves += [{"to_m": self.random.uniform(0.012, 0.016), "speed_m_s": speed * self.random.uniform(0.9, 1.1), "hold_s": 0.1},
                      {"to_m": self.random.uniform(0.006, 0.008), "speed_m_s": speed * self.random.uniform(0.9, 1.1), "hold_s": 0.1}]
        return motion_of({"start_m": 0.007, "acceleration_m_s2": 0.3, "moves": moves})

    def model(self):
        wrong = lambda value: value * self.random.uniform(0.8, 1.25)
        return {"format": "tractus-model/1", "rig": "probing", "name": "given",
                "base": {"layers": [{"start_m": 0.0, "thickness_m": 0.05, "stiffness_N_per_m": wrong(self.stiffness),
                                     "damping_Ns_per_m": wrong(self.damping), "equilibrium_m": 0.004}],
                         "rotary": {"viscous_Nms_per_rad": 0.02, "detent_Nm": 0.01, "detent_pitch_rad": 0.35}},
                "effects": []}


def write_set(folder, trials):
    folder.mkdir()
    index = {"format": "tractus-measurements/1", "rig": "probing", "simulated": True, "trials": []}
    for k, rows in enumerate(trials):
        name = f"t{k + 1}"
        numpy.savetxt(folder / f"{name}.csv", rows, delimiter=",", header="t_s,x_m,fz_N", comments="", fmt="%.9g")
        index["trials"].append({"id": name, "file": f"{name}.csv"})
    (folder / "set.json").write_text(json.dumps(index))


def asked(program, folder, model, *more):
    done = subprocess.run([program, "diagnose", "--json", "--threads", "1", "--model", model, "--measurements", folder, *more],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip() or done.stdout.strip())
    return json.loads(done.stdout)


def probability_of(answer, kind):
    """Of the structure that is exactly the truth."""
    want = [kind] if kind else []
    return next((h["probability"] for h in answer["hypotheses"] if h["effects"] == want), 0.0)


def followed_up(program, seed):
    truth = Truth(seed)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        (scratch / "model.json").write_text(json.dumps(truth.model()))
        trials = [truth.recording(truth.first_motion()) for _ in range(4)]
        write_set(scratch / "before", trials)
        first = asked(program, scratch / "before", scratch / "model.json", "--next-recording", scratch / "next.json")
        programs = (first["settle"] or {}).get("programs", [])
        if not programs:
            return {"seed": seed, "kind": truth.kind, "open": False, "probability": probability_of(first, truth.kind)}
        best = programs[0]
        motion = motion_of(best["program"])
        write_set(scratch / "after", trials + [truth.recording(motion) for _ in range(3)])
        second = asked(program, scratch / "after", scratch / "model.json")
        return {"seed": seed, "kind": truth.kind, "open": True, "program": best["name"], "promised": best["expected_gain"],
                "before": probability_of(first, truth.kind), "after": probability_of(second, truth.kind)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/tractus"))
    parser.add_argument("--seeds", default="1..20", metavar="A..B")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 2) // 2))
    parser.add_argument("--rows", metavar="FILE", help="each follow-up as a line of JSON")
    options = parser.parse_args()
    first, last = (int(n) for n in options.seeds.split(".."))
    rows = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(lambda seed: followed_up(options.program, seed), range(first, last + 1)):
            rows.append(row)
            print(json.dumps(row), file=sys.stderr, flush=True)
    if options.rows:
        pathlib.Path(options.rows).write_text("".join(json.dumps(row) + "\n" for row in rows))
    followed = [row for row in rows if row["open"]]
    print(f"{len(rows)} sets, {len(followed)} left undecided and followed up")
    if followed:
        gained = [row["after"] - row["before"] for row in followed]
        promised = [row["promised"] for row in followed]
        differences = [g - p for g, p in zip(gained, promised)]
        error = statistics.stdev(differences) / len(followed) ** 0.5 if len(followed) > 1 else float("nan")
        print(f"promised {statistics.mean(promised):.3f}, gained {statistics.mean(gained):.3f}: "
              f"difference {statistics.mean(differences):+.3f} ± {error:.3f} (asked: within 0.05)")


if __name__ == "__main__":
    main()
