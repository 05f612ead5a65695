"""Makes a planned set, has each solver answer it, and keeps the answers; what has an answer is not run again."""
from __future__ import annotations

import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "generators")]
import made_set  # noqa: E402
import motion_floor  # noqa: E402
import plan  # noqa: E402
import scoring  # noqa: E402
import sensor_chain  # noqa: E402

FRESH_SHARE = 0.2  # of the trials: kept back from every solver
LIMIT_S = 3 * 3600  # of wall time: machines are busy


def write_json(path: pathlib.Path, value) -> None:
    """Writes a file at once or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    part.write_text(json.dumps(value, indent=1) + "\n")
    part.replace(path)


def make_set(planned: plan.PlannedSet, folder: pathlib.Path) -> dict:
    """Makes the set's files: model.json, truth.json, measurements/ for the solvers, fresh/ kept back. Returns truth."""
    made = plan.generator_module(planned.generator).make(planned.seed, list(planned.hidden), planned.shares)
    made = sensor_chain.pass_through(plan.random_of(planned.generation, planned.name, "chain"), made,
                                     planned.kind == "parameters", steady_clock=planned.generator == "oscillators")
    chain = made.truth["chain"]
    if planned.rig == "probing":
        chain["motion_noise_as_force_N"] = motion_floor.motion_floor_N(made.truth, made.trials,
                                                                       scoring.true_floor(made.truth))
    else:
        chain["crosstalk_as_force_N"] = motion_floor.crosstalk_floor_N(made.truth, made.trials)
    made.truth.update(set=planned.name, generation=planned.generation, kind=planned.kind)
    fresh = max(2, round(FRESH_SHARE * len(made.trials)))
    part = folder.with_name(folder.name + ".part")
    shutil.rmtree(part, ignore_errors=True)
    given, kept_back = made.trials[:-fresh], made.trials[-fresh:]
    made.trials = kept_back
    made_set.write(made, part)
    (part / "measurements").rename(part / "fresh")
    made.trials = given
    made_set.write(made, part)
    for name, content in made.extra_files.items():  # a model names its volume beside itself
        (part / name).write_bytes(content)
    shutil.rmtree(folder, ignore_errors=True)
    part.rename(folder)
    return made.truth


def children_cpu_s() -> float:
    """Processor time of all programs that this process has run to their end."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_program(arguments: list, limit_s: float = LIMIT_S) -> dict:
    """What a command prints as JSON, and how long it took; a failure is an answer of its own."""
    started, used = time.monotonic(), children_cpu_s()
    try:
        done = subprocess.run(arguments, capture_output=True, text=True, timeout=limit_s, check=False)
    except subprocess.TimeoutExpired:
        return {"failed": f"no answer within {limit_s:.0f} s", "wall_s": limit_s}
    times = {"wall_s": time.monotonic() - started, "cpu_s": children_cpu_s() - used}
    try:
        answer = json.loads(done.stdout)
    except json.JSONDecodeError:
        answer = None
    if not isinstance(answer, dict) or answer.get("error") or done.returncode not in (0, 1):
        line = (done.stderr.strip() or done.stdout.strip() or f"exit status {done.returncode}").splitlines()[-1]
        return {"failed": line[:400], **times}
    return {"answer": answer, **times}


def asked_lab(program: str, folder: pathlib.Path, scratch: pathlib.Path, threads: int) -> dict:
    """The lab's diagnosis of a set, and what its model and the fitted base leave on the fresh trials."""
    given = ["--model", str(folder / "model.json"), "--measurements", str(folder / "measurements"), "--threads",
             str(threads), "--json"]
    found, base = scratch / "found.model.json", scratch / "base.model.json"
    out = run_program([program, "diagnose", *given, "--out-model", str(found)])
    if "answer" in out:
        for field in ("where", "trials", "notes"):
            out["answer"].pop(field, None)
        run_program([program, "fit", *given, "--out", str(base)])
        for name, model in (("fresh", found), ("fresh_base", base)):
            if model.exists():
                out[name] = compared(program, model, folder)
    return out


def compared(program, model, folder) -> dict:
    """What `compare` says of a model on the fresh trials: error and floor of the primary channel, by phase, and of
    the other channels the error."""
    out = run_program([program, "compare", "--model", str(model), "--measurements", str(folder / "fresh"), "--json"])
    if "answer" not in out:
        return out
    answer = out["answer"]
    first = answer["channels"][0]
    return {"channel": first["name"], "rmse": first["rmse"], "noise_floor": first["noise_floor"],
            "other_rmse": [channel["rmse"] for channel in answer["channels"][1:]],
            "phases": [{k: p.get(k) for k in ("phase", "rmse", "share_of_time", "share_of_error", "judged_share")}
                       for p in answer.get("phases", [])],
            "judgements": answer.get("judgements", []), "wall_s": out["wall_s"]}


def right_model(program, folder: pathlib.Path, scratch: pathlib.Path, truth: dict, catalogue: dict) -> dict | None:
    """The given model with the hidden effects at their true numbers, fitted, on the fresh trials; None where the
    program's catalogue has not all of them, or one of them is free in each trial."""
    model = json.loads((folder / "model.json").read_text())
    wanted = [(h["id"], h["parameters"]) for h in truth["hidden"]]
    late_s = truth["chain"]["delay_s"] + truth.get("sensor", {}).get("force_lag_s", 0.0)
    if "time_delay" not in dict(wanted):
        wanted.append(("time_delay", {"delay_s": late_s}))
    for name, numbers in wanted:
        info = catalogue.get(name)
        if info is None or info["free_per_trial"]:
            return None
        values = {}
        for p in info["parameters"]:
            value = numbers.get(p["name"], p["initial"])
            within = [min(max(v, p["low"]), p["high"]) for v in (value if isinstance(value, list) else [value])]
            values[p["name"]] = within if isinstance(value, list) else within[0]
        model["effects"].append({"id": name, "parameters": values})
    start, fitted = scratch / "right.model.json", scratch / "right-fitted.model.json"
    start.write_text(json.dumps(model))
    out = run_program([program, "fit", "--model", str(start), "--measurements", str(folder / "measurements"),
                       "--out", str(fitted), "--json"])
    if "answer" not in out:
        return out
    return {"fit": {k: out["answer"][k] for k in ("rmse", "held_out_rmse", "noise_floor")}, "wall_s": out["wall_s"],
            "fresh": compared(program, fitted, folder)}


def catalogue_of(program: str) -> dict:
    """What `tractus effects` lists, by rig and id."""
    out = run_program([program, "effects", "--json"], 60)
    if "answer" not in out:
        raise SystemExit(f"hidden-physics: {program} effects --json: {out['failed']}")
    listed: dict = {}
    for effect in out["answer"]["effects"]:
        listed.setdefault(effect["rig"], {})[effect["id"]] = effect
    return listed


def run_set(planned: plan.PlannedSet, place: pathlib.Path, program: str, label: str, catalogue: dict, threads: int,
            baselines: list, keep: bool) -> tuple:
    """Makes the set if needed and asks every solver that has not answered yet. Returns (name, error or None).

    place: the folder of truth, answers and sets.
    """
    folder, scratch = place / "sets" / planned.name, place / "scratch" / planned.name
    answers = {solver: place / "answers" / solver / f"{planned.name}.json" for solver in [label, *baselines]}
    missing = [solver for solver, path in answers.items() if not path.exists()]
    try:
        if not missing:
            return planned.name, None
        truth_file = place / "truth" / f"{planned.name}.json"
        if not (folder / "measurements" / "set.json").exists():
            started = time.monotonic()
            truth = make_set(planned, folder)
            truth["made_in_s"] = time.monotonic() - started
            write_json(truth_file, truth)
        truth = json.loads(truth_file.read_text())
        scratch.mkdir(parents=True, exist_ok=True)
        for path in folder.glob("volume.*"):
            shutil.copy(path, scratch)
        if label in missing:
            answer = asked_lab(program, folder, scratch, threads)
            answer["right_model"] = right_model(program, folder, scratch, truth, catalogue[planned.rig])
            write_json(answers[label], answer)
        rivals = [solver for solver in missing if solver != label]
        if rivals:
            import baselines as rival_solvers
            for solver, answer in rival_solvers.answered_all(rivals, folder).items():
                write_json(answers[solver], answer)
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
        return planned.name, None
    except Exception as error:  # a set that fails is reported, the others go on
        return planned.name, f"{type(error).__name__}: {error}"
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
