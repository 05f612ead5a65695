#!/usr/bin/env python3
"""Upgrades two servers on one PostgreSQL one after the other while two stations hand over trials: nothing that was acknowledged is lost.

    tests/upgrade/rolling_test.py --bin build/release/bin [--old PROGRAMS-OF-AN-EARLIER-RELEASE]

Without --old the present program stands for the earlier one too: while it runs, tables that it does not need for trials are taken away with
their migrations, so that the next server has something to migrate. What was acknowledged is noted here, at the station's end."""
import argparse
import hashlib
import json
import secrets
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

from record import PIN, ROOT, Site

sys.path.insert(0, str(ROOT / "tests/attack"))
from processes import Postgres, Server, wait_until  # noqa: E402
from trial_file import crc32c, trial_bytes  # noqa: E402
from wire import Client, Target  # noqa: E402

TAKEN_AWAY = {29: ("record_statements", "record_stores"), 31: ("pacs_imports",)}
# What a later version may do to tables that servers of this one read and write at each trial.
LATER = """begin;
set local lock_timeout = '500ms';
alter table accounts add column later text not null default '';
alter table trials add column later bigint not null default 0;
alter table study_slots add column later bigint not null default 0;
create table later_things (id text primary key, trial_id text not null references trials (id));
create index trials_later on trials (later);
insert into schema_versions (version, name, applied_utc_us) values (9999, 'later', 1);
commit;"""
PIECES = 3


class Station(threading.Thread):
    """Hands over one trial after another, by the server that it prefers while that answers, else by the other, as behind a proxy."""

    def __init__(self, targets, token, badge, seed):
        super().__init__(daemon=True)
        self.badge, self.seed = badge, seed
        self.clients = [Client(target, {"Authorization": f"Bearer {token}"}) for target in targets]
        self.acknowledged, self.by, self.refusals, self.wrong = {}, {target.port: 0 for target in targets}, [], []
        self.over = threading.Event()

    def ask(self, method, path, body=None, headers=None):
        """An answer below 500, of whichever server; it asks until there is one."""
        kind = "application/octet-stream" if isinstance(body, bytes) else "application/json"
        end = time.monotonic() + 60
        while time.monotonic() < end:
            for client in self.clients:
                answer = client.ask(method, path, body, kind=kind, headers=headers)
                if 0 < answer.status < 500:
                    self.by[client.line.target.port] += 1
                    return answer
                if answer.status:
                    self.refusals.append(f"{method} {path.split('/')[1]}: {answer}")
            time.sleep(0.05)
        raise RuntimeError(f"{method} {path}: no server answers for 60 s")

    def must(self, *words):
        answer = self.ask(*words)
        if answer.status != 200:
            raise RuntimeError(f"{words[:2]}: {answer}")
        return answer.json()

    def hand_over(self, trial, slot, data):
        self.must("PUT", f"/uploads/{trial}", {"case_id": slot, "size_bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()})
        durable = 0
        while durable < len(data):
            piece = data[durable:durable + len(data) // PIECES + 1]
            answer = self.ask("PATCH", f"/uploads/{trial}?offset_bytes={durable}", piece, {"X-Crc32c": f"{crc32c(piece):08x}"})
            now = answer.json()["offset_bytes"]
            if now < durable:
                self.wrong.append(f"{trial}: {durable} bytes were acknowledged, {now} are there")
            durable = now
        self.must("POST", f"/uploads/{trial}/commit")
        self.acknowledged[trial] = hashlib.sha256(data).hexdigest()

    def run(self):
        try:
            ticket = self.must("POST", "/work/sign-in", {"badge": self.badge, "pin": PIN})["ticket"]
            while not self.over.is_set():
                slot, trial = self.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"], secrets.token_hex(16)
                self.seed += 1
                self.hand_over(trial, slot, trial_bytes(trial, slot, "participant", seed=self.seed))
        except Exception as failure:  # noqa: BLE001  # told by the test
            self.wrong.append(str(failure))


class Department:
    """Two servers' places on one folder and one PostgreSQL, two trainees, two stations at work."""

    def __init__(self, test, old, new):
        self.test, self.postgres = test, Postgres()
        test.addCleanup(self.postgres.stop)
        scratch = tempfile.TemporaryDirectory(prefix="tractus-rolling-")
        test.addCleanup(scratch.cleanup)
        self.data, self.database = Path(scratch.name) / "data", self.postgres.add_database()
        password = Path(scratch.name) / "password"
        password.write_text("fixture of admin\n")
        self.site = Site(old, self.data)
        self.site.run("init", "--data", self.data, "--admin-name", "admin", "--password-file", password,
                      "--database", self.postgres.address(self.database))
        self.first, self.second = self.site.server, Server(new, Path(scratch.name) / "data", ["--plain"], None)
        self.second.log = Path(scratch.name) / "second.log"
        for server in (self.first, self.second):
            test.addCleanup(server.stop)
        self.first.start()
        self.site.sign_in("admin", "fixture of admin")
        self.site.add("fay", "faculty")
        self.stations = []
        for number, name in enumerate(("tom", "zoe")):
            self.site.add(name, "trainee", badge=f"B-{number}", pin=PIN)
            cohort = self.site.clients["fay"].must("POST", "/cohorts", {"name": name})["id"]
            self.site.clients["admin"].must("POST", f"/cohorts/{cohort}/people", {"name": name})
            self.site.clients["fay"].must("POST", "/assignments", {
                "title": name, "cases": [{"scenario": {"tuned": kind}} for kind in ("hard", "soft", "lateral_breach", "in_out_in")], "repeats": 20,
                "seed": 1, "release": "at_once", "cohort": cohort})
            targets = [Target(server.port) for server in (self.first, self.second)][::1 if number == 0 else -1]
            self.stations.append(Station(targets, self.site.station(f"station-{number}").token, f"B-{number}", 1000 * number))

    def sql(self, text):
        return self.postgres.run_sql(text, self.database)

    def migrates(self, text):
        """As the servers migrate: it gives way to a reader that holds a table, and begins anew."""
        end = time.monotonic() + 60
        while True:
            try:
                return self.sql(text)
            except RuntimeError as error:
                if "lock timeout" not in str(error) or time.monotonic() > end:
                    raise
            time.sleep(0.1)

    def trains(self, more):
        """Waits until each station has had so many more trials acknowledged."""
        goal = [len(station.acknowledged) + more for station in self.stations]
        wait_until(lambda: any(station.wrong for station in self.stations)
                   or all(len(station.acknowledged) >= least for station, least in zip(self.stations, goal)), 120, f"{more} more trials each")
        self.test.assertEqual([station.wrong for station in self.stations], [[], []])

    def ends(self, verifier):
        """All work is done; everything that was acknowledged is there, once, byte by byte, and the records hold."""
        for station in self.stations:
            station.over.set()
        for station in self.stations:
            station.join(120)
        self.test.assertEqual([station.wrong for station in self.stations], [[], []])
        wait_until(lambda: self.sql("select count(*) from jobs where state <> 'done'") == [["0"]], 120, "every job is done")
        stored = dict(self.sql("select id, sha256 from trials where state = 'assessed'"))
        acknowledged = self.stations[0].acknowledged | self.stations[1].acknowledged
        self.test.assertEqual(stored, acknowledged)
        for sha in acknowledged.values():
            self.test.assertEqual(hashlib.sha256((self.data / "objects" / sha[:2] / sha[2:]).read_bytes()).hexdigest(), sha)
        ended = subprocess.run([verifier, "verify", "--data", self.data], capture_output=True, text=True)
        self.test.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        refusals = [line for station in self.stations for line in station.refusals]
        print(f"\n  {len(acknowledged)} trials acknowledged and there; answers by server {[station.by for station in self.stations]}; "
              f"{len(refusals)} answers of 500 and more {sorted(set(refusals))[:3]}", flush=True)


class Rolling(unittest.TestCase):
    def test_a_server_of_the_next_version_migrates_beside_one_at_work(self):
        at = Department(self, self.old, self.new)
        if self.old == self.new:
            for version, tables in TAKEN_AWAY.items():
                at.sql("; ".join(f"drop table {table}" for table in tables) + f"; delete from schema_versions where version = {version}")
        before = {int(row[0]) for row in at.sql("select version from schema_versions")}
        for station in at.stations:
            station.start()
        at.trains(4)
        said = subprocess.run([self.new, "upgrade", "--check", "--json", "--data", at.data], capture_output=True, text=True)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertGreater(len(json.loads(said.stdout)["migrations"]), 1)
        self.assertEqual({int(row[0]) for row in at.sql("select version from schema_versions")}, before)
        at.second.start()
        self.assertGreater({int(row[0]) for row in at.sql("select version from schema_versions")}, before)
        at.trains(8)  # side by side
        for server in (at.first, at.second):
            self.assertGreater(sum(station.by[server.port] for station in at.stations), 30)
        at.first.stop()
        at.trains(4)
        at.first.binary = self.new
        at.first.start()
        at.trains(2)
        at.ends(self.new)

    def test_a_migration_that_fails_leaves_the_server_at_work(self):
        at = Department(self, self.new, self.new)
        newest = at.sql("select version, name from schema_versions order by version desc limit 1")[0]
        at.sql(f"delete from schema_versions where version = {newest[0]}")  # its tables are there: it fails
        before = at.sql("select * from schema_versions order by version")
        for station in at.stations:
            station.start()
        at.trains(2)
        with self.assertRaisesRegex(RuntimeError, f"migration 0*{newest[0]}_{newest[1]}: .*already exists"):
            at.second.start()
        self.assertEqual(len(at.second.log.read_text().splitlines()), 1, at.second.log.read_text())
        self.assertEqual(at.sql("select * from schema_versions order by version"), before)
        at.trains(2)
        self.assertEqual([line for station in at.stations for line in station.refusals], [])
        at.sql(f"insert into schema_versions values ({newest[0]}, '{newest[1]}', 1)")
        at.ends(self.new)

    def test_servers_at_work_go_on_when_a_later_version_migrates_and_one_that_starts_refuses(self):
        at = Department(self, self.new, self.new)
        at.second.start()
        for station in at.stations:
            station.start()
        at.trains(3)
        at.migrates(LATER)
        at.trains(5)
        at.first.stop()
        with self.assertRaisesRegex(RuntimeError, "the database has schema 9999, but this program supports schemas up to"):
            at.first.start()
        at.trains(3)
        at.sql("delete from schema_versions where version = 9999")  # so that `verify` of this version opens it
        at.ends(self.new)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    parser.add_argument("--old", type=Path, help="folder of an earlier release's programs")
    options, others = parser.parse_known_args()
    Rolling.new = options.bin.resolve() / "tractus-server"
    Rolling.old = (options.old or options.bin).resolve() / "tractus-server"
    unittest.main(argv=[sys.argv[0], *others], verbosity=2, warnings="ignore")
