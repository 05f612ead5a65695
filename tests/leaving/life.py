#!/usr/bin/env python3
"""A person's whole life on a real tractus-server: import, consent, training, own data, leaving; then a backup of before is restored.

    tests/leaving/life.py --bin build/release/bin
    tests/leaving/life.py --bin build/release/bin --database postgresql

`verify` holds at each step. The station is simulated: its trials are written by tests/attack/trial_file.py, without the product's code.
In between the server is killed while it erases, and a station hands over trials of people who left. Exit 0: all is as it should be."""
import argparse
import io
import json
import secrets
import shutil
import signal
import sys
import tempfile
import time
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "attack"))
from trial_file import announced, hand_over, trial_bytes  # noqa: E402
from world import PIN, Setup, World, run_sqlite  # noqa: E402

BASIS_OF_CONSENT = {"tier": "full"}
WAIT_S = 60


def check(holds, what):
    print(("  ok    " if holds else "  WRONG ") + what, flush=True)
    if not holds:
        raise SystemExit(1)


class Life:
    def __init__(self, world):
        self.world, self.setup = world, world.setup
        self.faculty = world.account("fay of the faculty", "faculty")
        self.director = world.account("dora", "director")
        self.station = world.station("station-1")
        self.cohort = self.faculty.must("POST", "/cohorts", {"name": "year 1"})["id"]
        self.people = {}

    def verified(self, when, data=None):
        ended = self.setup.run("verify", "--data", data or self.world.data)
        check(ended.returncode == 0, f"verify {when}" + ("" if ended.returncode == 0 else f": {ended.stdout}{ended.stderr}"))

    def import_class(self, names):
        rows = "".join(f"{name},trainee,PGY-1,B-{n},{PIN}\n" for n, name in enumerate(names))
        made = self.world.admin.must("POST", "/accounts/import", {
            "csv": "name,role,level,badge,pin\n" + rows, "cohort": self.cohort, "apply": True})
        for n, row in enumerate(made["rows"]):
            person, own = self.world.signed_in(row["name"], row["password"]), secrets.token_urlsafe(12)
            person.must("POST", "/session/password", {"old": row["password"], "new": own})
            self.world.passwords[row["name"]] = own
            self.people[row["name"]] = {"client": person, "id": row["id"], "badge": f"B-{n}", "trials": [], "slots": []}
        self.faculty.must("POST", "/assignments", {
            "title": "first week", "cases": [{"scenario": {"tuned": "hard"}}], "repeats": 8, "seed": 1, "release": "at_once",
            "cohort": self.cohort})

    def train(self, name, trials):
        person = self.people[name]
        ticket = self.station.must("POST", "/work/sign-in", {"badge": person["badge"], "pin": PIN})["ticket"]
        for seed in range(trials):
            work = self.station.must("POST", "/work/next", {"ticket": ticket})["trial"]
            trial = secrets.token_hex(16)
            data = trial_bytes(trial, work["slot"], "participant", seed=seed)
            answer = hand_over(self.station, trial, work["slot"], data)
            check(answer.status == 200, f"a trial of {name} is taken ({answer.status})")
            person["trials"].append((trial, data))
        person["next"] = self.station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"]
        person["ticket"] = ticket

    def own_data(self, name):
        answer = self.people[name]["client"].ask("GET", "/session/data")
        check(answer.status == 200, f"{name} downloads the own data ({answer.status})")
        with zipfile.ZipFile(io.BytesIO(answer.body)) as zipped:
            check(zipped.testzip() is None, "the zip is whole")
            return {entry: zipped.read(entry) for entry in zipped.namelist()}

    def erase(self, name, mode="erase"):
        return self.world.admin.ask("POST", f"/accounts/{self.people[name]['id']}/erasure", {"mode": mode, "name": name})

    def finished(self):
        end = time.monotonic() + WAIT_S
        while any(one["state"] != "done" for one in self.world.admin.must("GET", "/erasures")["erasures"]):
            if time.monotonic() > end:
                return False
            time.sleep(0.1)
        return True

    def texts(self, data, postgres):
        """Everything that the records say, as one text."""
        out = []
        if postgres:
            ask = lambda sql: self.setup.postgres.run_sql(sql, postgres)  # noqa: E731
            tables = [row[0] for row in ask("select table_name from information_schema.tables where table_schema = 'public'")]
        else:
            ask = lambda sql: run_sqlite(data / "tractus.db", sql)  # noqa: E731
            tables = [row[0] for row in ask("select name from sqlite_master where type = 'table'")]
        for table in tables:
            out += ["\x1f".join(row) for row in ask(f"select * from {table}")]
        return "\x1e".join(out)

    def files_named(self, data, trial):
        import hashlib
        sha = hashlib.sha256(trial[1]).hexdigest()
        return (data / "objects" / sha[:2] / sha[2:]).exists() or (data / "uploads" / f"{trial[0]}.part").exists()


def gone(life, name, data, postgres, when):
    text = life.texts(data, postgres)
    check(name not in text, f"no record names {name} {when}")
    check(not any(life.files_named(data, trial) for trial in life.people[name]["trials"]), f"no file of {name} is here {when}")


def killed_while_erasing(life, name, after_s):
    """Kills the server some time after it began, and starts it again."""
    answer = life.erase(name)
    time.sleep(after_s)
    life.world.server.stop(signal.SIGKILL)
    life.world.server.start()
    life.world.renew(life.world.admin)
    known = life.world.admin.ask("GET", f"/accounts/{life.people[name]['id']}/erasure").status
    check(answer is not None and answer.status == 202 and known == 404, f"{name}: acknowledged, and erased after kill -9 at {after_s * 1000:.0f} ms")
    check(life.finished(), f"{name}: what was interrupted is finished")


def run(life):
    world = life.world
    database = getattr(world, "database", None)
    names = ["zoe of basel", "max of bern", "lea of chur", "tim of thun", "ida of glarus", "uli of uri"]
    zoe, max_, lea, tim, ida, uli = names
    life.import_class(names)
    life.verified("after the import")
    for name in names:
        life.people[name]["client"].must("POST", "/session/consent", BASIS_OF_CONSENT)
    life.verified("after the consents")
    for name in names:
        life.train(name, 2)
    world.wait_for_scores()
    life.faculty.must("POST", f"/trials/{life.people[zoe]['trials'][0][0]}/comments", {"text": "steadier", "at_s": 0.1})
    life.verified("after the training")

    own = life.own_data(zoe)
    check({f"trials/{trial}.ttrial" for trial, _ in life.people[zoe]["trials"]} <= set(own), "her recordings are in it")
    check(all(own[f"trials/{trial}.ttrial"] == data for trial, data in life.people[zoe]["trials"]), "byte by byte as the station sent them")
    check(not any(other.encode() in content for other in names[1:] for content in own.values()), "no other person is in it")
    check(b"steadier" in own[f"trials/{life.people[zoe]['trials'][0][0]}.json"], "the comment on her trial is in it")
    print(f"  files: {', '.join(sorted(own))}")
    life.verified("after the download")

    backup = world.folder / "backups" / "before"
    backup.parent.mkdir()
    life.setup.must_run("backup", "--data", world.data, "--out", backup)

    # Zoe leaves while a station hands over one of her trials.
    half = (secrets.token_hex(16), None)
    data = trial_bytes(half[0], life.people[zoe]["next"], "participant", seed=9)
    half = (half[0], data)
    life.people[zoe]["trials"].append(half)
    check(announced(life.station, half[0], life.people[zoe]["next"], data).status == 200, "an upload of hers is under way")
    preview = world.admin.must("GET", f"/accounts/{life.people[zoe]['id']}/erasure?mode=erase")
    check(preview["files"] == 3 and preview["open_uploads"] == 1, "the preview counts three recordings, one under way")
    check(life.erase(zoe).status == 202, "she is erased")
    check(life.people[zoe]["client"].ask("GET", "/session").status == 401, "her session ended")
    check(life.station.ask("POST", "/work/sign-in", {"badge": life.people[zoe]["badge"], "pin": PIN}).status in (401, 403), "her badge ended")
    check(life.station.ask("POST", "/work/next", {"ticket": life.people[zoe]["ticket"]}).status in (401, 403), "her ticket at the station ended")
    refused = life.station.ask("POST", f"/uploads/{half[0]}/commit")
    check(refused.status == 409 and b"whose data were erased" in refused.body, "the station is told why her trial is not taken")
    check(life.finished(), "the erasure is finished")
    gone(life, zoe, world.data, database, "after she left")
    life.verified("after she left")

    # Max is anonymised: his trials stay, and a later trial of a station that was offline is refused in words.
    check(life.erase(max_, "anonymise").status == 202 and life.finished(), "max is anonymised")
    check(max_ not in life.texts(world.data, database), "no record names him")
    check(all(life.files_named(world.data, trial) for trial in life.people[max_]["trials"]), "his recordings stay")
    late = secrets.token_hex(16)
    answer = hand_over(life.station, late, life.people[max_]["next"], trial_bytes(late, life.people[max_]["next"], "participant", seed=7))
    check(answer.status == 409 and b"delete it from this station" in answer.body, "a later trial of his is refused in words")
    life.verified("after he was anonymised")

    for name, after_s in ((lea, 0.0), (tim, 0.003), (ida, 0.02)):
        killed_while_erasing(life, name, after_s)
        gone(life, name, world.data, database, "after kill -9")
        life.verified("after kill -9")

    # The backup of before: whoever left is in it, and gone again when it is restored.
    world.server.stop()
    check(zoe in life.texts(backup, None), "she is in the backup of before")
    shutil.copy(world.data / "erasures.list", backup.parent / "erasures.list")
    listed = json.loads((backup.parent / "erasures.list").read_text())
    check(len(listed["erasures"]) == 5 and not any(name in json.dumps(listed) for name in names), "the list holds five numbers and no name")
    restored = world.folder / "restored"
    words, other = ["restore", "--from", backup, "--data", restored], None
    if database:
        other = life.setup.postgres.add_database()
        words += ["--database", life.setup.postgres.address(other)]
    said = life.setup.must_run(*words)
    check("5 people who left since the backup was made were erased again" in said, "restore says so")
    for name in (zoe, lea, tim, ida):
        gone(life, name, restored, other, "in the restored folder")
    text = life.texts(restored, other)
    check(max_ not in text and uli in text, "max is nobody in it, uli is there")
    life.verified("of the restored folder", restored)
    without = world.folder / "without"
    shutil.move(backup.parent / "erasures.list", world.folder / "list")
    words = ["restore", "--from", backup, "--data", without]
    if database:
        words += ["--database", life.setup.postgres.address(life.setup.postgres.add_database())]
    check("no list of erasures was found" in life.setup.must_run(*words), "a restore without a list says that it had none")
    world.server.start()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    parser.add_argument("--database", choices=("sqlite", "postgresql"), default="sqlite")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-life-"))
    setup = Setup(options.bin.resolve(), folder, options.database, "nothing")
    try:
        with World(setup) as world:
            run(Life(world))
    finally:
        setup.stop()
        shutil.rmtree(folder, ignore_errors=True)
    print(f"a whole life on {options.database}: as it should be")


if __name__ == "__main__":
    main()
