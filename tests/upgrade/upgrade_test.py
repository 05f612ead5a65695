#!/usr/bin/env python3
"""Has the present tractus-server take over the data folder of each earlier release (the folders beside this file), and looks at everything in it.

    tests/upgrade/upgrade_test.py --bin build/release/bin

What is expected are the answers that the release's own server gave (answers.jsonl), and the files in db/migrations."""
import argparse
import contextlib
import hashlib
import io
import json
import re
import shutil
import sqlite3
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest
import zipfile
from pathlib import Path

import trail
from record import PIN, ROOT, Site, content, dump

sys.path.insert(0, str(ROOT / "tests/attack"))
from trial_file import crc32c  # noqa: E402
from wire import Client, Target  # noqa: E402

HERE = Path(__file__).resolve().parent
STEPS = sorted(path.stem for path in (ROOT / "db/migrations").glob("*.sql"))


def taken_out(fixture, data):
    """The release's data folder, as it stood on its disk."""
    with tarfile.open(fixture / "folder.tar.xz") as archive:
        archive.extractall(data)
    with contextlib.closing(sqlite3.connect(data / "tractus.db")) as database:
        database.execute("pragma journal_mode = wal")  # as servers of every release have set it
        database.executescript((fixture / "database.sql").read_text())
    (data / "tractus.db").chmod(0o600)
    data.chmod(0o700)


def digests(folder):
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.rglob("*") if path.is_file()}


def schema(path):
    with contextlib.closing(sqlite3.connect(path)) as database:
        rows = database.execute("select name, sql from sqlite_master where name not like 'sqlite_stat%' order by name").fetchall()
    return {name: " ".join((sql or "").replace('"', "").split()) for name, sql in rows}


def lost(old, new, at=""):
    """Where `new` lacks something of `old` or has another value; what `new` has beside it is its own affair."""
    if isinstance(old, dict) and isinstance(new, dict):
        return [line for key in old for line in (lost(old[key], new[key], f"{at}.{key}") if key in new else [f"{at}.{key} is gone"])]
    if isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        return [line for n, one in enumerate(old) for line in lost(one, new[n], f"{at}[{n}]")]
    return [] if old == new else [f"{at} was {old!r:.80}, is {new!r:.80}"]


def additions_only(step):
    """Whether servers that know nothing of the step's tables and columns go on reading and writing all others."""
    text = "\n".join(line for line in (ROOT / f"db/migrations/{step}.sql").read_text().splitlines() if not line.startswith("--"))
    statements = [" ".join(one.split()) for one in text.split(";") if one.strip()]
    return all(re.match(r"create (table|index) |alter table \w+ add column .* default ", one) for one in statements)


def rows_lost(old, new):
    """Of the audit trail, which goes on: every row of before is there, as it was."""
    now = {row["number"]: row for row in new["rows"]}
    return [line for row in old["rows"] for line in lost(row, now.get(row["number"], {}), f"row {row['number']}")]


class Release(unittest.TestCase):
    fixture = None

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="tractus-upgrade-")
        self.addCleanup(scratch.cleanup)
        self.data = Path(scratch.name) / "data"
        taken_out(self.fixture, self.data)
        first, *self.answers = map(json.loads, (self.fixture / "answers.jsonl").read_text().splitlines())
        self.made, self.passwords = first["made"], first["passwords"]
        self.site = Site(self.binary, self.data)
        self.addCleanup(self.site.server.stop)

    def run_program(self, *words):
        return subprocess.run([self.binary, *words, "--data", self.data], capture_output=True, text=True)

    def served(self):
        self.site.server.start()
        for name, password in self.passwords.items():
            self.site.sign_in(name, password)

    def known_steps(self):
        with contextlib.closing(sqlite3.connect(self.data / "tractus.db")) as database:
            return [row[0] for row in database.execute("select version from schema_versions")]

    def covered(self):
        """Keys and columns of each table whose rows the audit trail covers."""
        with contextlib.closing(sqlite3.connect(self.data / "tractus.db")) as database:
            rows = database.execute("select detail from audit where what = 'beginCoverage' order by number").fetchall()
        return json.loads(rows[-1][0])["tables"]

    def edit(self, sql):
        with contextlib.closing(sqlite3.connect(self.data / "tractus.db")) as database, database:
            database.execute(sql)

    def assert_verified(self):
        """The chain of the trail and its anchors by trail.py, the rows and files by the program."""
        with contextlib.closing(sqlite3.connect(self.data / "tractus.db")) as database:
            self.assertEqual(trail.broken(self.data, database), [])
        ended = self.run_program("verify")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_the_check_names_the_steps_and_changes_no_byte(self):
        with contextlib.closing(sqlite3.connect(self.data / "tractus.db")) as database:
            self.assertEqual(trail.broken(self.data, database), [])
        before, known = digests(self.data), self.known_steps()
        said = self.run_program("upgrade", "--check", "--json")
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertEqual(json.loads(said.stdout)["migrations"], [step[5:] for step in STEPS if int(step[:4]) not in known])
        self.assertEqual(digests(self.data), before)

    def test_everything_is_read_with_the_values_of_before(self):
        self.served()
        self.assertEqual(sorted(self.known_steps()), [int(step[:4]) for step in STEPS])
        self.assertGreater(len(self.answers), 40)
        for one in self.answers:
            with self.subTest(f"{one['who']} {one['path']}"):
                answer = self.site.clients[one["who"]].ask("GET", one["path"])
                self.assertEqual(answer.status, 200, str(answer))
                compare = rows_lost if one["path"].startswith("/audit") else lost
                self.assertEqual(compare(one["answer"], content(answer)), [])
        self.assertTrue(self.site.clients["admin"].must("GET", "/audit/check")["holds"])
        self.assert_verified()

    def test_recordings_badge_token_and_station_are_as_before(self):
        self.served()
        with contextlib.closing(sqlite3.connect(self.data / "tractus.db")) as database:
            stored = dict(database.execute("select id, sha256 from trials"))
        own = zipfile.ZipFile(io.BytesIO(self.site.clients["tom"].ask("GET", "/session/data").body))
        for trial in self.made["trials"]:
            self.assertEqual(hashlib.sha256(own.read(f"trials/{trial}.ttrial")).hexdigest(), stored[trial])
        target = Target(self.site.server.port)
        token = Client(target, {"Authorization": f"Bearer {self.made['token']}"})
        self.assertEqual([study["id"] for study in token.must("GET", "/studies")["studies"]], [self.made["study"]])
        station = Client(target, {"Authorization": f"Bearer {self.made['station_token']}"})
        ticket = station.must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
        self.assertEqual(station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"], self.made["half"]["slot"])
        manifest = station.ask("GET", f"/cases/{self.made['case']}/parts/volume.tvol")
        self.assertEqual(manifest.status, 200, str(manifest))

    def test_an_upload_that_was_half_sent_goes_on(self):
        self.served()
        half, whole = self.made["half"], bytes.fromhex(self.made["half"]["whole"])
        station = Client(Target(self.site.server.port), {"Authorization": f"Bearer {self.made['station_token']}"})
        state, rest = station.must("GET", f"/uploads/{half['trial']}"), whole[half["sent_bytes"]:]
        self.assertIn(half["sent_bytes"], state.values(), state)
        station.must("PATCH", f"/uploads/{half['trial']}?offset_bytes={half['sent_bytes']}", rest, kind="application/octet-stream",
                     headers={"X-Crc32c": f"{crc32c(rest):08x}"})
        station.must("POST", f"/uploads/{half['trial']}/commit")
        end = time.monotonic() + 60
        while (trial := self.site.clients["admin"].must("GET", f"/trials/{half['trial']}"))["state"] != "assessed":
            self.assertLess(time.monotonic(), end, trial)
            time.sleep(0.1)
        self.assert_verified()

    def test_commands_that_only_look_or_add_leave_the_records_to_the_release(self):
        """A server of the release may still be at work: after an upgrade that was refused the new programs are there already."""
        records, out = dump(self.data / "tractus.db"), self.data.with_name("out")
        step = next(step for step in STEPS if int(step[:4]) not in self.known_steps())
        for words in (["verify"], ["backup", "--out", out], ["anchor"], ["enrol", "--name", "new", "--out", out], ["publish", self.fixture]):
            ended = self.run_program(*words)
            self.assertEqual((ended.returncode, len(ended.stderr.splitlines())), (2, 1), ended.stdout + ended.stderr)
            self.assertIn(f"without migration {step}", ended.stderr)
            self.assertFalse(out.exists())
        self.assertEqual(dump(self.data / "tractus.db"), records)

    def test_a_backup_of_the_release_is_restored(self):
        backup, restored = self.data.with_name("backup"), self.data.with_name("restored")
        shutil.copytree(self.data, backup)
        listed = {name: digests(backup)[name] for name in ("secret.key", "audit.anchor", "audit.highwater")}
        (backup / "backup.json").write_text(json.dumps({
            "format": "tractus-backup/1", "made_utc_us": 1, "database_sha256": digests(backup)["tractus.db"], "files": listed,
            "object_bytes": sum(path.stat().st_size for path in (backup / "objects").rglob("*") if path.is_file()), "rows": {}}))
        before = digests(backup)
        ended = subprocess.run([self.binary, "restore", "--from", backup, "--data", restored], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertEqual(digests(backup), before)
        self.data = self.site.data = self.site.server.data = restored
        self.served()
        self.assertEqual({trial["id"] for trial in self.site.clients["admin"].must("GET", "/trials?limit=200")["trials"]}, set(self.made["trials"]))
        self.assert_verified()

    def test_a_second_start_migrates_and_changes_nothing(self):
        self.site.server.start()
        self.site.server.stop()
        records = dump(self.data / "tractus.db")
        self.site.server.start()
        self.site.server.stop()
        self.assertEqual(dump(self.data / "tractus.db"), records)
        said = self.run_program("upgrade", "--check", "--json")
        self.assertEqual(json.loads(said.stdout)["migrations"], [])

    def test_servers_of_the_release_may_go_on_beside_this_version(self):
        """Else the changelog has to say that all servers are stopped for the upgrade, and this test which release that was."""
        known, covered = self.known_steps(), self.covered()
        self.assertEqual([step for step in STEPS if int(step[:4]) not in known and not additions_only(step)], [])
        self.site.server.start()
        self.site.server.stop()
        now = self.covered()
        self.assertEqual({table: now.get(table) for table in covered}, covered, "digests of rows are made of other columns")

    def test_its_schema_is_that_of_a_new_folder(self):
        """So a step that was released is never edited: whoever has it would be left with another schema."""
        self.site.server.start()
        self.site.server.stop()
        new = self.data.with_name("new")
        subprocess.run([self.binary, "init", "--data", new], check=True, capture_output=True)
        self.assertEqual(schema(self.data / "tractus.db"), schema(new / "tractus.db"))

    def test_an_edit_by_hand_before_the_upgrade_is_found_after_it(self):
        self.edit("update accounts set role = 'admin' where name = 'zoe'")
        self.site.server.start()
        self.site.server.stop()
        ended = self.run_program("verify")
        self.assertEqual(ended.returncode, 1, ended.stdout + ended.stderr)

    def test_a_kill_while_it_migrates_leaves_all_steps_or_none(self):
        """Killed a little later each time, until the steps are there."""
        before, after_s, kills = self.known_steps(), 0.0, 0
        while (known := self.known_steps()) == before:
            starting = subprocess.Popen([self.binary, "serve", "--plain", "--listen", "127.0.0.1:0", "--data", self.data],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(after_s)
            starting.kill()
            starting.wait()
            after_s, kills = 1.2 * after_s + 0.005, kills + 1
        print(f"{kills} kills ", end="", flush=True)
        self.assertGreater(kills, 1)
        self.assertEqual(sorted(known), [int(step[:4]) for step in STEPS])
        self.served()
        self.assert_verified()

    def test_a_migration_that_fails_leaves_the_folder_to_the_release(self):
        step = next(step for step in reversed(STEPS) if int(step[:4]) not in self.known_steps()
                    and "create table" in (ROOT / f"db/migrations/{step}.sql").read_text())
        table = (ROOT / f"db/migrations/{step}.sql").read_text().split("create table ")[1].split()[0]
        self.edit(f"create table {table} (somebody_elses text)")
        records, files = dump(self.data / "tractus.db"), digests(self.data)
        for words in (["upgrade", "--check"], ["serve", "--plain", "--listen", "127.0.0.1:0"]):
            ended = self.run_program(*words)
            self.assertEqual((ended.returncode, len(ended.stderr.splitlines())), (2, 1), ended.stdout + ended.stderr)
            self.assertIn(step, ended.stderr)
            self.assertEqual(dump(self.data / "tractus.db"), records)
            left = {name: digest for name, digest in digests(self.data).items() if name != "serving.lock"}
            self.assertEqual(left, files)
        self.edit(f"drop table {table}")
        self.served()
        self.assert_verified()


def load(binary):
    """A class of tests for each release's folder."""
    suite = unittest.TestSuite()
    for fixture in sorted(path.parent for path in HERE.glob("*/database.sql")):
        made = type(f"Of_{fixture.name}", (Release,), {"fixture": fixture, "binary": binary})
        suite.addTests(unittest.defaultTestLoader.loadTestsFromTestCase(made))
    return suite


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    parser.add_argument("--fixtures", type=Path, default=HERE, help="folder of the releases' folders")
    options = parser.parse_args()
    HERE = options.fixtures.resolve()
    found = load(options.bin.resolve() / "tractus-server")
    ended = unittest.TextTestRunner(verbosity=2).run(found)
    sys.exit(0 if ended.wasSuccessful() and found.countTestCases() else 1)
