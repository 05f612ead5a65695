"""A server with people, stations and trials of two families: those of "ours", whose members attack, and those of "theirs"."""
import hashlib
import json
import os
import secrets
import shutil
import subprocess
import time
import urllib.parse

from processes import Postgres, Proxy, Server
from report import Worked
from trial_file import hand_over, trial_bytes
from wire import OWN_ADDRESS, Client, Target

ROLES = ("admin", "director", "faculty", "researcher", "technician", "trainee", "station")
PIN = "2580"
MOST_GROWTH = 1.2  # of resident memory, over what it was before an attack
VICTIM = "Victim"  # in each name that belongs to "their" family and to nobody else


class Setup:
    """How servers are set up in this run: which database, what stands before them."""

    def __init__(self, binaries, folder, database, behind):
        self.binary, self.folder, self.behind, self.worlds = binaries / "tractus-server", folder, behind, 0
        self.postgres = Postgres() if database == "postgresql" else None
        self.temporary = folder / "tmp"
        self.temporary.mkdir()
        self.environment = os.environ | {"TMPDIR": str(self.temporary)}

    def run(self, *words):
        return subprocess.run([str(self.binary), *map(str, words)], capture_output=True, text=True, env=self.environment, cwd=self.folder)

    def must_run(self, *words):
        ended = self.run(*words)
        if ended.returncode != 0:
            raise RuntimeError(f"tractus-server {words[0]}: exit {ended.returncode}: {ended.stderr.strip()}")
        return ended.stdout

    def proxy_options(self):
        """Behind a proxy on this machine, named where the server can be told which proxies it is to believe."""
        named = "--trusted-proxy" in self.run("serve", "--help").stdout
        return ["--behind-proxy", "--trusted-proxy", OWN_ADDRESS] if named else ["--behind-proxy"]

    def stop(self):
        if self.postgres:
            self.postgres.stop()


class World:
    """One data folder and the server on it. `front`: "plain", "tls", or "proxy" (the server's own, without nginx)."""

    def __init__(self, setup, front=None, options=(), prepare=None):
        setup.worlds += 1
        self.setup, self.front = setup, front or ("nginx" if setup.behind == "nginx" else "plain")
        self.folder = setup.folder / f"world-{setup.worlds}"
        self.folder.mkdir(mode=0o700)
        self.data, self.admin_password = self.folder / "data", secrets.token_urlsafe(12)
        if prepare:
            prepare(self.data)
        self.init()
        flags = {"plain": ["--plain"], "tls": []}.get(self.front) or ([] if self.front == "tls" else setup.proxy_options())
        self.server = Server(setup.binary, self.data, [*flags, *options], setup.environment)
        self.server.start()
        self.proxy = Proxy(self.folder / "nginx", [self.server.port], self.data / "tls") if self.front == "nginx" else None
        encrypted = self.front in ("tls", "nginx")
        authority = str(self.data / "tls/authority.pem") if encrypted else None
        self.target = Target(self.proxy.port if self.proxy else self.server.port, authority)
        self.direct = self.target if not self.proxy else Target(self.server.port)
        self.people, self.passwords, self.restarts = {}, {}, 0
        self.admin = self.signed_in("admin", self.admin_password)
        self.people["admin"] = self.admin

    def init(self):
        file = self.folder / "password"
        file.write_text(self.admin_password + "\n")
        words = ["init", "--data", self.data, "--admin-name", "admin", "--password-file", file, "--host", "127.0.0.1"]
        if self.setup.postgres:
            self.database = self.setup.postgres.add_database()
            words += ["--database", self.setup.postgres.address(self.database)]
        self.setup.must_run(*words)

    # --- people and stations -------------------------------------------------------------------------------------------------

    def nobody(self, source=OWN_ADDRESS):
        return Client(self.target, source=source)

    def signed_in(self, name, password, source=OWN_ADDRESS):
        client = Client(self.target, source=source)
        answer = client.ask("POST", "/session", {"name": name, "password": password})
        if answer.status != 200:
            raise RuntimeError(f"{name} cannot sign in: {answer}")
        client.credentials = {"Cookie": answer.header("set-cookie").split(";")[0]}
        client.identity = answer.json()
        self.passwords[name] = password
        return client

    def account(self, name, role, **more):
        """With a password of its own: the first one has to be changed."""
        first = self.admin.must("POST", "/accounts", {"name": name, "role": role} | more)["password"]
        person, own = self.signed_in(name, first), secrets.token_urlsafe(12)
        person.must("POST", "/session/password", {"old": first, "new": own})
        self.passwords[name] = own
        return person

    def station(self, name, admin=None):
        code, token = (admin or self.admin).must("POST", "/stations/codes", {"name": name})["code"], secrets.token_hex(32)
        made = self.nobody().must("POST", "/stations/enrol", {"code": code, "token_sha256": hashlib.sha256(token.encode()).hexdigest()})
        client = Client(self.target, {"Authorization": f"Bearer {token}"})
        client.identity = made
        return client

    def furnish(self):
        self.people |= {role: self.account(role, role) for role in ("director", "researcher", "technician")}
        self.ours = Family(self, "Our", "101")
        self.theirs = Family(self, VICTIM, "102")
        self.people |= {"faculty": self.ours.faculty, "trainee": self.ours.trainee, "station": self.ours.station}
        self.spare = self.account("spare", "trainee").identity["id"]
        self.stranger = self.account(f"{VICTIM} of no cohort", "trainee", badge="103", pin=PIN)
        self.study = "study-one"
        self.people["researcher"].must("POST", "/studies", {
            "id": self.study, "title": "A study", "repeats": 1, "ordering": "random", "seed": 1,
            "scenarios": [{"tuned": "soft"}, {"tuned": "lateral_breach"}], "participants": [{"name": "S01"}, {"name": "S02"}]})
        self.wait_for_scores()

    def published_case(self):
        """The id of a case that any station may announce a trial for."""
        scenario = self.admin.must("GET", "/scenarios/hard")
        scenario.pop("origin", None)
        return self.admin.must("POST", "/scenarios", {"scenario": scenario | {"name": "published"}, "publish": True})["id"]

    def mend(self):
        """Makes the world again what attacks expect of it: who is in which cohort, who is signed in, what runs."""
        ours, theirs, admin = self.ours, self.theirs, self.admin
        for cohort in admin.must("GET", "/cohorts")["cohorts"]:
            if cohort["id"] != theirs.cohort:
                for person in (theirs.trainee, theirs.pupil, self.stranger):
                    admin.ask("DELETE", f"/cohorts/{cohort['id']}/people/{person.identity['id']}")
        admin.ask("POST", f"/cohorts/{ours.cohort}/people", {"name": f"{ours.name} trainee"})
        admin.ask("POST", f"/studies/{self.study}/state", {"state": "running"})
        for family in (ours, theirs):
            admin.ask("POST", f"/assignments/{family.assignment}/release", {"release": "at_once"})
            family.renew_ticket()
        for person in {*self.people.values(), ours.faculty, theirs.faculty, theirs.trainee, theirs.pupil, self.stranger}:
            self.renew(person)

    def renew(self, person):
        """Signs in again whose session an attack, or what answered it, has ended."""
        name = person.identity["name"]
        if name in self.passwords and person.ask("GET", "/session").status == 401:
            person.credentials = self.signed_in(name, self.passwords[name]).credentials

    def wait_for_scores(self):
        end = time.monotonic() + 60
        while any(trial["state"] == "assessing" for trial in self.admin.must("GET", "/trials?limit=200")["trials"]):
            if time.monotonic() > end:
                raise RuntimeError("trials are not scored after 60 s")
            time.sleep(0.1)

    # --- before and after each attack -----------------------------------------------------------------------------------------

    def healthy(self):
        client = Client(self.target, patience_s=15)
        return client.ask("GET", "/health").status == 200 and self.server.alive()

    def begin_attack(self):
        if not self.healthy():
            self.restart()
        self.mend()
        self.before_bytes = self.server.resident_bytes()

    def end_attack(self):
        """What an attack must leave as it was: a list of what it did not."""
        if not self.healthy():
            died = f"the server died or hangs: {self.server.last_words()[-200:]}"
            self.restart()
            return [died]
        return [seen for seen in (self.grown(), self.not_verified()) if seen]

    def grown(self):
        end = time.monotonic() + 5
        while (now := self.server.resident_bytes()) > MOST_GROWTH * self.before_bytes:
            if time.monotonic() > end:
                return f"memory grew from {self.before_bytes >> 20} to {now >> 20} MiB"
            time.sleep(0.2)
        return ""

    def not_verified(self):
        ended = self.setup.run("verify", "--data", self.data)
        return "" if ended.returncode == 0 else f"verify: {(ended.stdout + ended.stderr).strip()[:300]}"

    def restart(self):
        self.server.stop()
        self.server.start()
        self.restarts += 1
        self.before_bytes = self.server.resident_bytes()

    def __enter__(self):
        return self

    def __exit__(self, failure, *_):
        alive = self.server.alive()
        self.server.stop()
        if self.proxy:
            self.proxy.stop()
        shutil.rmtree(self.data / "objects", ignore_errors=True)  # it may be large
        if failure is None and not alive:
            raise Worked(f"the server died: {self.server.last_words()[-200:]}")

    # --- the records, by hand -------------------------------------------------------------------------------------------------

    def copy(self, number):
        """The stopped server's folder and records under another name: (folder, run_sql)."""
        folder = self.folder / f"copy-{number}"
        shutil.copytree(self.data, folder)
        if not self.setup.postgres:
            return folder, lambda sql: run_sqlite(folder / "tractus.db", sql)
        name = self.setup.postgres.add_database(self.database)
        for file in folder.iterdir():
            if file.is_file() and file.read_bytes().startswith(b"postgresql://"):
                file.write_text(self.setup.postgres.address(name) + "\n")
        return folder, lambda sql: self.setup.postgres.run_sql(sql, name)


def run_sqlite(path, sql):
    import sqlite3
    with sqlite3.connect(path) as database:
        rows = database.execute(sql).fetchall()
    database.close()
    return [[str(value) for value in row] for row in rows]


class Family:
    """Faculty, a cohort of two trainees, a station, an assignment that is through and one with places left, trials, a comment."""

    def __init__(self, world, name, badge):
        self.world, self.name, self.badge = world, name, badge
        self.faculty = world.account(f"{name} faculty", "faculty")
        self.trainee = world.account(f"{name} trainee", "trainee", badge=badge, pin=PIN)
        self.pupil = world.account(f"{name} pupil", "trainee")
        self.station = world.station(f"{name} station")
        self.cohort = self.faculty.must("POST", "/cohorts", {"name": f"{name} cohort"})["id"]
        for person in ("trainee", "pupil"):
            world.admin.must("POST", f"/cohorts/{self.cohort}/people", {"name": f"{name} {person}"})
        self.ticket = self.sign_in_at_station()
        self.assign(3, people=[f"{name} trainee"])
        self.finished_trial = [self.next_trial(seed) for seed in (1, 2, 3)][0]
        self.assignment = self.assign(6, cohort=self.cohort)
        self.trial = self.next_trial(4)
        self.slot = self.next_slot()["slot"]
        said = self.faculty.must("POST", f"/trials/{self.trial}/comments", {"text": f"{name} comment", "at_s": 0.1})
        self.comment = said["comments"][0]["id"]
        whole = self.faculty.must("GET", f"/assignments/{self.assignment}")
        self.participant = next(one["participant"] for one in whole["trainees"] if one["name"] == f"{name} trainee")

    def assign(self, repeats, **whom):
        return self.faculty.must("POST", "/assignments", whom | {
            "title": f"{self.name} assignment", "cases": [{"scenario": {"tuned": "hard"}}], "repeats": repeats, "seed": 1,
            "release": "at_once"})["id"]

    def sign_in_at_station(self):
        return self.station.must("POST", "/work/sign-in", {"badge": self.badge, "pin": PIN})["ticket"]

    def renew_ticket(self):
        if self.station.ask("POST", "/work/next", {"ticket": self.ticket}).status == 200:
            return
        badge = {"badge": self.badge, "pin": PIN}
        if self.station.ask("POST", "/work/sign-in", badge).status != 200:  # an attack has set another one
            self.world.admin.must("POST", f"/accounts/{self.trainee.identity['id']}/badge", badge)
        self.ticket = self.sign_in_at_station()

    def next_slot(self):
        return self.station.must("POST", "/work/next", {"ticket": self.ticket})["trial"]

    def next_trial(self, seed):
        """Does the next assigned trial at the family's station; its id."""
        slot, trial_id = self.next_slot()["slot"], secrets.token_hex(16)
        answer = hand_over(self.station, trial_id, slot, trial_bytes(trial_id, slot, "participant", seed=seed))
        if answer.status != 200:
            raise RuntimeError(f"a trial is not taken: {answer}")
        return trial_id

    def ids(self):
        """What an attacker may have found out and asks with."""
        return {"account": self.trainee.identity["id"], "faculty": self.faculty.identity["id"], "cohort": self.cohort,
                "assignment": self.assignment, "trial": self.trial, "comment": self.comment, "station": self.station.identity["id"],
                "slot": self.slot, "participant": self.participant, "name": f"{self.name} pupil", "badge": self.badge,
                "ticket": self.ticket}

    def secrets(self):
        """What nobody of the other family can know unless the server tells it: (text, what it is)."""
        return {f"{self.name} trainee": "a trainee's name", f"{self.name} cohort": "a cohort's name", f"{self.name} assignment": "a title",
                f"{self.name} comment": "a comment", f"{self.name} faculty": "a teacher's name", self.finished_trial: "a trial"}


def quoted(text):
    return urllib.parse.quote(str(text), safe="")


def json_text(value):
    return json.dumps(value, ensure_ascii=False)
