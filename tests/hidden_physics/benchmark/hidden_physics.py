#!/usr/bin/env python3
"""Makes measurement sets with hidden physics, has the model lab and its rivals answer them, and scores the answers."""
from __future__ import annotations

import argparse
import concurrent.futures
import os
import pathlib
import re
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE)]
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the processes share the cores
import jobs  # noqa: E402
import plan  # noqa: E402
import recordings  # noqa: E402
import report  # noqa: E402

ROOT = HERE.parents[2]
EXAMPLES = """examples:
  deploy/hidden-physics --quick                                 40 sets, for everyday use
  deploy/hidden-physics --probing 300 --palpation 300 --jobs 4
  deploy/hidden-physics --generation frozen-1 --probing 300 --palpation 300
  deploy/hidden-physics --program /tmp/old/tractus --label old  another program on the same sets, beside the first
  deploy/hidden-physics --probing 10 --only probing0004 --keep  one set; its files stay in FOLDER/GENERATION/sets
  deploy/hidden-physics --named                                 sets that were once answered wrongly
  deploy/hidden-physics --recordings --emps ~/EMPS              real machines
  deploy/hidden-physics --report                                the table of the answers that are there

What has an answer is not run again: a run that was stopped goes on, a larger one adds to a smaller one.
A generation whose name begins with "frozen" is reported as rates alone; do not tune on it. Any other name is a
development generation, whose wrong answers are listed by set.
"""
SOLVERS = ["best_single", "stlsq", "lasso_bic", "gaussian_process"]


def parsed(arguments):
    parser = argparse.ArgumentParser(prog="deploy/hidden-physics", description=__doc__, epilog=EXAMPLES,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="30 probing and 10 palpation sets of the development "
                        "generation")
    parser.add_argument("--probing", type=int, default=0, metavar="N", help="number of probing sets")
    parser.add_argument("--palpation", type=int, default=0, metavar="N", help="number of palpation sets")
    parser.add_argument("--generation", default="development", metavar="NAME", help="which sets (default: development)")
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/tractus"), metavar="FILE",
                        help="the program that answers (default: the built one)")
    parser.add_argument("--label", default="tractus", metavar="NAME", help="name of its answers (default: tractus)")
    parser.add_argument("--baselines", default=",".join(SOLVERS), metavar="A,B",
                        help="rivals on the same sets, or none (default: %(default)s)")
    parser.add_argument("--folder", default=str(ROOT / "build/hidden-physics"), metavar="DIR",
                        help="where sets, answers and the table go (default: build/hidden-physics)")
    parser.add_argument("--jobs", type=int, default=max(1, (os.cpu_count() or 2) // 2), metavar="N",
                        help="sets at a time (default: half of the cores)")
    parser.add_argument("--threads", type=int, default=2, metavar="N", help="threads of the program (default: 2)")
    parser.add_argument("--named", action="store_true", help="the sets of named_sets.json: wrong answers of before")
    parser.add_argument("--recordings", action="store_true", help="also the real recordings of the repository")
    parser.add_argument("--emps", metavar="DIR", help="also EMPS, a real servo axis, from this folder of its files")
    parser.add_argument("--only", metavar="TEXT", help="only sets whose name contains this")
    parser.add_argument("--keep", action="store_true", help="keep the sets' files after the answers")
    parser.add_argument("--report", action="store_true", help="run nothing; write the table of what is there")
    options = parser.parse_args(arguments)
    if options.quick:
        options.probing, options.palpation = max(options.probing, 30), max(options.palpation, 10)
    options.baselines = [] if options.baselines == "none" else options.baselines.split(",")
    unknown = [name for name in options.baselines if name not in SOLVERS]
    if unknown:
        parser.error(f"--baselines: {unknown[0]} is none of {', '.join(SOLVERS)}")
    real = options.recordings or options.emps or options.named
    if not options.report and not real and options.probing + options.palpation < 1:
        parser.error("nothing to run: give --quick, --probing N, --palpation N, --named, --recordings or --report")
    if min(options.probing, options.palpation) < 0 or options.jobs < 1 or options.threads < 1:
        parser.error("numbers of sets, --jobs and --threads cannot be below 0 or 1")
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]*", options.generation):
        parser.error("--generation: use letters, digits, '-', '_' and '.'")
    if options.label in SOLVERS:
        parser.error(f"--label: {options.label} is the name of a baseline")
    if not options.report and not os.access(options.program, os.X_OK):
        parser.error(f"{options.program} is no program: build it with deploy/run, or give --program FILE")
    return options


def show_progress(done, count, started, failed):
    """A line on the terminal, or every tenth set a line of its own where there is none."""
    share = done / max(count, 1)
    left_s = (time.monotonic() - started) * (1 - share) / share if done else 0.0
    line = (f"[{'#' * int(30 * share):30s}] {done} of {count} sets, {left_s / 60:.0f} min left"
            + (f", {failed} failed" if failed else ""))
    if sys.stderr.isatty():
        print(f"\r{line} ", end="\n" if done == count else "", file=sys.stderr, flush=True)
    elif done % 10 == 0 or done == count:
        print(line, file=sys.stderr, flush=True)


def run_all(options, sets, place):
    """Runs the sets in parallel processes. Returns how many failed."""
    catalogue = jobs.catalogue_of(options.program)
    jobs.write_json(place / "catalogue.json", catalogue)
    started, done, failures = time.monotonic(), 0, []
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        waiting = [pool.submit(jobs.run_set, planned, place, options.program, options.label, catalogue, options.threads,
                               options.baselines, options.keep) for planned in sets]
        for future in concurrent.futures.as_completed(waiting):
            name, error = future.result()
            done += 1
            if error:
                failures.append((name, error))
                print(f"\n{name}: {error}", file=sys.stderr)
            show_progress(done, len(sets), started, len(failures))
    return len(failures)


def run_recordings(options, work, place):
    """Has the program answer the real recordings that were asked for."""
    asked = recordings.IN_REPOSITORY if options.recordings else []
    if options.emps:
        asked = [*asked, recordings.emps_recording(pathlib.Path(options.emps), work / "emps")]
    for recording in asked:
        recordings.answered(recording, options.program, place, options.label, options.threads)


def wanted_sets(options):
    """The sets that were asked for, in the order in which they run."""
    if options.named:
        sets = plan.named_sets()
    else:
        rigs = [plan.planned_sets(options.generation, rig, getattr(options, rig)) for rig in plan.GENERATORS]
        sets = [s for _, s in sorted(((k / len(listed), s) for listed in rigs for k, s in enumerate(listed)),
                                     key=lambda pair: pair[0])]  # a run that is stopped has some of each rig
    if options.only:
        sets = [s for s in sets if options.only in s.name]
        if not sets:
            raise SystemExit(f"hidden-physics: --only {options.only}: none of the sets asked for has this in its name")
    return sets


def main(arguments=None):
    options = parsed(arguments)
    work = pathlib.Path(options.folder).absolute()
    place = work / ("named" if options.named else options.generation)
    failed = 0
    if not options.report:
        sets = wanted_sets(options)
        if plan.is_frozen(options.generation):
            print(f"{options.generation} is a frozen generation: its sets are for measuring, never for tuning.",
                  file=sys.stderr)
        failed = run_all(options, sets, place) if sets else 0
        run_recordings(options, work, place)
    if not (place / "answers").is_dir() and not (place / "recordings").is_dir():
        raise SystemExit(f"hidden-physics: {place} holds no answers yet: run without --report first")
    print(report.written(place, place.name))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
