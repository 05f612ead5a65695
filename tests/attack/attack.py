#!/usr/bin/env python3
"""Attacks a real tractus-server that it starts on this machine's loopback, on a data folder of its own.

    tests/attack/attack.py --bin build/release/bin --junit build/attack.xml
    tests/attack/attack.py --bin build/release/bin --database postgresql --junit build/attack-postgresql.xml
    tests/attack/attack.py --bin build/release/bin --behind nginx --only relations

Exit 0: every attack was held off. 1: at least one worked. 2: it could not be tried."""
import argparse
import concurrent.futures
import shutil
import sys
import tempfile
import time
from pathlib import Path

import api_tokens
import flood
import insiders
import nesting
import relations
import sign_in
import storage
import transport
from report import ATTACKS, Report
from trial_file import announced
from wire import Client
from world import Setup, World

ORDER = [module.__name__ for module in (nesting, relations, sign_in, api_tokens, insiders, storage, transport, flood)]


def warm_up(world):
    """What a server that has been up for a while has done once: so that growth afterwards is an attack's."""
    def one(n):
        source = f"127.0.12.{n + 1}"
        Client(world.target, source=source).ask("POST", "/session", {"name": f"warm {n}", "password": "not the password"})
        world.nobody(source).ask("POST", "/cohorts", b"x" * 4000)
        world_client = Client(world.target, world.people["researcher"].credentials, source)
        for path in ("/studies", "/lab/models", "/cohort/table", "/export/trials.csv", "/cases"):
            world_client.ask("GET", path)
        world_client.ask("POST", "/lab/measurements?name=warm", b"PK" + bytes(1 << 20), kind="application/octet-stream")
        Client(world.target, world.people["admin"].credentials, source).ask("GET", f"/trials/{world.ours.trial}/signals?points=2000")
    with concurrent.futures.ThreadPoolExecutor(16) as pool:
        list(pool.map(one, range(32)))
    announced(world.ours.station, "e" * 32, world.ours.next_slot()["slot"], bytes(1 << 16))
    flood.block(world, "json_body", 600)
    flood.block(world, "path_and_query", 600)
    # Each route once by those who may: caches of connections and the allocator's arenas stay after a first pass, and a second
    # pass adds nothing to them.
    relations.asked_about_strangers(world)


def options_of(words):
    parser = argparse.ArgumentParser(prog="tests/attack/attack.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    parser.add_argument("--database", choices=("sqlite", "postgresql"), default="sqlite")
    parser.add_argument("--behind", choices=("nothing", "nginx"), default="nothing", help="what stands before the server")
    parser.add_argument("--junit", type=Path, help="where the JUnit report goes")
    parser.add_argument("--only", default="", help="only attacks whose module.function holds this text")
    parser.add_argument("--keep", action="store_true", help="leave the scratch folder behind")
    return parser.parse_args(words)


def run(options, folder):
    suite = f"attack on {options.database}" + (f" behind {options.behind}" if options.behind != "nothing" else "")
    report, began, setup = Report(suite), time.monotonic(), None
    ATTACKS.sort(key=lambda attack: ORDER.index(attack[1].__module__))
    try:
        setup = Setup(options.bin.resolve(), folder, options.database, options.behind)
        with World(setup) as world:
            world.furnish()
            warm_up(world)
            print(f"{suite}: {time.monotonic() - began:.0f} s to set up", flush=True)
            report.run(world, options.only)
    finally:
        if setup:
            setup.stop()
    if options.junit:
        report.write(options.junit)
    failed = report.failed()
    print(f"{suite}: {len(report.cases)} attacks, {len(failed)} worked, {time.monotonic() - began:.0f} s")
    for words, _, outcome, text, _ in failed:
        print(f"   {outcome}: {words}\n      {text[:400]}")
    return 1 if failed else 0


def main(words):
    options = options_of(words)
    folder = Path(tempfile.mkdtemp(prefix="tractus-attack-"))
    try:
        return run(options, folder)
    except (OSError, RuntimeError) as error:
        print(f"tests/attack/attack.py: {error}", file=sys.stderr)
        return 2
    finally:
        if not options.keep:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
