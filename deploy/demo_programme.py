"""A programme worth exploring, on a server that runs: a year of SIMULATED trainees, a finished study, two measurement sets with
a hidden effect. deploy/run makes it after its first trial.

Everything goes the way it goes in practice: accounts, cohorts, assignments, studies and measurement sets through the public API;
trials by `tractus-station` with a simulated device, recorded, handed over and scored like any other. Their dates lie in the past
by the station's --started, and each file says that its date and its hand are simulated. Nothing writes to the database. The same
seed makes the same trials. Standard library alone."""
import argparse
import concurrent.futures
import datetime
import io
import json
import os
import secrets
import subprocess
import sys
import time
import urllib.error
import urllib.request
import zipfile
from pathlib import Path

SEED = 2026
ROLES = ("director", "faculty", "researcher", "technician")
PIN = "2580"
SCENARIOS = [{"scenario": {"tuned": name}} for name in ("hard", "soft", "lateral_breach", "in_out_in")]
# Skill at the first trial and in the end, trials to go half of the way: made up, so that there is something to see.
TRAINEES = {
    "Residents, first year": {"trainee": (0.10, 0.95, 10), "Simulated Abel": (0.05, 0.90, 16), "Simulated Berit": (0.00, 0.55, 30),
                              "Simulated Carl": (0.10, 0.95, 8)},
    "Residents, third year": {"Simulated Dora": (0.35, 1.00, 6), "Simulated Emil": (0.40, 1.00, 8), "Simulated Freya": (0.20, 0.80, 20)},
    "Fellows": {"Simulated Gustav": (0.70, 1.00, 4), "Simulated Hanna": (0.75, 1.00, 4)},
}
RELAPSES = "Simulated Carl"  # after a summer without practice: answers "none" to everything for one session
LATE = {"Simulated Berit", "Simulated Freya"}  # have not done what is overdue
# Days ago that it was done, title, rig, repeats of each case: each cohort gets all of them.
YEAR = [(350, "Autumn: four kinds of bone", "probing", 3), (285, "Winter: the wall of the tract", "palpation", 1),
        (230, "Winter: four kinds of bone", "probing", 3), (150, "Spring: four kinds of bone", "probing", 3),
        (95, "Summer: the wall of the tract", "palpation", 1), (40, "Summer: four kinds of bone", "probing", 3),
        (12, "Autumn: a check before the holidays", "probing", 1)]
OPEN = ("Before the examination: four kinds of bone", "probing", 1)  # due in two weeks, done by the fellows
# The CT of the case that ships, a tract each with another wall gone, in filled bone in which every wall's breach can be felt, and one
# to be drilled; the station carves nothing of its own.
RIGHT = ["--entry", "2.5,200,-61.5", "--target", "10,158,-61.5", "--preparation", "filled", "--certified"]
LEFT = ["--entry", "46,200,-61", "--target", "38.5,158,-61"]
CASES = {"L3 right pedicle, A": RIGHT, "L3 right pedicle, B": [*RIGHT, "--breach", "lateral"],
         "L3 right pedicle, C": [*RIGHT, "--breach", "inferior"], "L3 left pedicle, whole": [*LEFT, "--no-channel"]}
DRILLER = "Simulated Abel"  # has drilled and felt already what his year has to
STUDY = "recognition-2026"
YEARS_OF_EXPERIENCE = [6, 3, 1, 0.5, 0.1, 0]


def fail(what):
    raise SystemExit(f"deploy/demo_programme.py: {what}")


def say(line):
    print(f"   {line}", flush=True)


class Person:
    """Somebody who has signed in, as a browser does."""

    def __init__(self, url, name, password):
        self.url, self.cookie = url, None
        self.session = self.ask("POST", "/session", {"name": name, "password": password})

    def ask(self, method, path, body=None, kind="application/json"):
        headers = {"X-Tractus": "1", "Content-Type": kind}
        if self.cookie:
            headers["Cookie"] = self.cookie
        data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
        request = urllib.request.Request(f"{self.url}/api/v1{path}", data=data, headers=headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                if set_cookie := answer.headers.get("Set-Cookie"):
                    self.cookie = set_cookie.split(";")[0]
                return json.loads(answer.read() or b"null")
        except urllib.error.HTTPError as error:
            fail(f"{method} {path}: {error.code} {error.read().decode(errors='replace').strip()}")
        except OSError as error:
            fail(f"{method} {path}: {error}")


def utc_us(days_ago, hour=9, minute=0):
    day = datetime.datetime.now(datetime.timezone.utc) - datetime.timedelta(days=days_ago)
    return int(day.replace(hour=hour, minute=minute, second=0, microsecond=0).timestamp() * 1e6)


def soon_us():
    """The server takes no due time in the past: what was due long ago is due in a minute, and overdue from then on."""
    return int((datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(minutes=1)).timestamp() * 1e6)


def started(days_ago, hour):
    return datetime.datetime.fromtimestamp(utc_us(days_ago, hour) / 1e6, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%MZ")


def skill_of(trainee, trials_done):
    first, last, halfway = trainee
    return last - (last - first) * 0.5 ** (trials_done / halfway)


def zip_of(generated):
    """A generated set as the lab takes it: said to be simulated, with its volume where it has one."""
    told = json.loads((generated / "measurements" / "set.json").read_text()) | {"simulated": True}
    zipped = io.BytesIO()
    with zipfile.ZipFile(zipped, "w", zipfile.ZIP_DEFLATED) as archive:
        if (generated / "volume.nrrd").exists():
            archive.write(generated / "volume.nrrd", "volume.nrrd")
            told["volume"] = "volume.nrrd"
        for file in sorted((generated / "measurements").glob("*.csv")):
            archive.write(file, file.name)
        archive.writestr("set.json", json.dumps(told))
    return zipped.getvalue()


class Programme:
    def __init__(self, options):
        self.bin, self.home, self.url = options.bin.resolve(), options.home.resolve(), options.url.rstrip("/")
        self.volume, self.key = options.volume, options.key
        self.admin = Person(self.url, "admin", options.admin_password_file.read_text().strip())
        self.passwords, self.badges, self.done = {}, {}, {}
        self.stations = [f"station-{letter}" for letter in "abc"]

    def run(self, program, *words, check=True):
        ended = subprocess.run([self.bin / program, *map(str, words)], capture_output=True, text=True)
        if check and ended.returncode != 0:
            fail(f"{program} {' '.join(map(str, words[:1]))}: exit {ended.returncode}: {ended.stderr.strip()}")
        return ended.stdout

    def account(self, name, role, badge=None):
        """With a password of its own at once: the first one that the server hands out has to be changed."""
        wanted = {"name": name, "role": role} | ({"badge": badge, "pin": PIN} if badge else {})
        first = self.admin.ask("POST", "/accounts", wanted)["password"]
        password = secrets.token_urlsafe(12)
        person = Person(self.url, name, first)
        person.ask("POST", "/session/password", {"old": first, "new": password})
        self.passwords[name] = (role, password)
        return password

    def people(self):
        for role in ROLES:
            self.account(role, role)
        self.faculty = Person(self.url, "faculty", self.passwords["faculty"][1])
        self.researcher = Person(self.url, "researcher", self.passwords["researcher"][1])
        self.cohorts = {}
        badge = 1000
        for cohort, trainees in TRAINEES.items():
            made = self.faculty.ask("POST", "/cohorts", {"name": f"{cohort} (simulated)"})
            self.cohorts[cohort] = made["id"]
            for name in trainees:
                badge += 1
                self.badges[name] = str(badge)
                self.done[name] = 0
                self.account(name, "trainee", str(badge))
                # Faculty add whom they may see; who is in no cohort yet, the administrator adds.
                self.admin.ask("POST", f"/cohorts/{made['id']}/people", {"name": name})

    def fleet(self):
        for name in self.stations:
            token = self.home / f"{name}.token"
            code = self.admin.ask("POST", "/stations/codes", {"name": name})["code"]
            self.run("tractus-station", "enrol", "--server", self.url, "--code", code, "--token-file", token)
            folder = self.home / name
            folder.mkdir(exist_ok=True)
            (folder / "config.json").write_text(json.dumps({"format": "tractus-station/1", "name": name}))
            self.run("tractus-station", "trust", "--data", folder, "--case", self.home / "case")

    def cases(self):
        self.case_ids = []
        for number, (title, options) in enumerate(CASES.items()):
            out = self.home / f"demo-case-{number}"
            if not out.exists():
                self.run("tractus", "carve", "--volume", self.volume, *options,
                         "--title", title, "--source", "TPTBox sample CT, Apache-2.0 (tests/data/SOURCES.md)", "--key", self.key,
                         "--out", out)
            self.run("tractus-server", "publish", "--data", self.home / "server", out)
        shipped = [one for one in self.admin.ask("GET", "/cases")["cases"] if one["title"].startswith("L3")]
        self.case_ids = [{"case": one["id"]} for one in shipped if not one["planned"]]
        self.whole_ids = [{"case": one["id"]} for one in shipped if one["planned"]]

    def session(self, station, name, rig, days_ago, hour, trials, extra=()):
        """Somebody at a station: signs in by badge, does some of what waits."""
        cohort = next(group for group in TRAINEES.values() if name in group)
        device = "sim-rig" if rig == "probing" else "sim-lambda6"
        seed = SEED * 1_000_000 + int(self.badges[name]) * 1000 + self.done[name]
        # The rig's hand has a skill; the palpating one takes its time as it learns.
        skill = skill_of(cohort[name], self.done[name])
        how = {"probing": ["--skill", f"{skill:.3f}"], "palpation": ["--duration", f"{5 + 7 * skill:.1f}"], "drilling": []}[rig]
        self.run("tractus-station", "assigned", "--badge", self.badges[name], "--pin-file", self.home / "demo.pin", "--data",
                 self.home / station, "--server", self.url, "--token-file", self.home / f"{station}.token", "--device", device,
                 "--speed", "fast", "--started", started(days_ago, hour), "--seed", seed, "--trials", trials, "--json", *how, *extra)
        self.done[name] += trials

    def assignment(self, cohort, title, rig, repeats, due_days_ago):
        cases = {"probing": SCENARIOS, "palpation": self.case_ids, "drilling": self.whole_ids}[rig]
        self.faculty.ask("POST", "/assignments", {
            "title": title, "cases": cases, "cohort": self.cohorts[cohort], "ordering": "random", "repeats": repeats,
            "seed": SEED + due_days_ago % 1000, "due_utc_us": max(utc_us(due_days_ago, 18), soon_us()), "release": "at_once"})
        return len(cases) * repeats

    def year_of(self, cohort, station):
        """One cohort at its station through the year, in the order of time."""
        for days_ago, title, rig, repeats in YEAR:
            trials = self.assignment(cohort, title, rig, repeats, days_ago - 7)
            for hour, name in enumerate(TRAINEES[cohort], 8):
                if days_ago == YEAR[-1][0] and name in LATE:
                    continue
                relapse = name == RELAPSES and days_ago in (40, 12)
                half = trials // 2 if trials > 6 else trials
                for part, number in enumerate([half, trials - half] if trials > half else [trials]):
                    extra = ["--answer", "none"] if relapse else []
                    self.session(station, name, rig, days_ago - 3 * part, hour, number, extra)
        title, rig, repeats = OPEN
        trials = self.assignment(cohort, title, rig, repeats, -14)
        if cohort == "Fellows":
            for hour, name in enumerate(TRAINEES[cohort], 8):
                self.session(station, name, rig, 2, hour, trials)

    def drilling(self, station):
        """Whole bone, due in a week: a channel is made, then felt."""
        cohort = next(name for name, trainees in TRAINEES.items() if DRILLER in trainees)
        self.assignment(cohort, "Make the channel, then feel it", "drilling", 1, -7)
        self.session(station, DRILLER, "drilling", 1, 9, 2)

    def study(self, station):
        names = [f"S{number:02}" for number in range(1, len(YEARS_OF_EXPERIENCE) + 1)]
        self.researcher.ask("POST", "/studies", {
            "id": STUDY, "title": "Recognition of breaches, SIMULATED surgeons", "repeats": 3, "ordering": "random", "seed": SEED,
            "scenarios": [one["scenario"] for one in SCENARIOS],
            "participants": [{"name": name, "level": "senior" if years > 2 else "fellow" if years >= 0.5 else "resident",
                              "experience_years": years, "simulated": True} for name, years in zip(names, YEARS_OF_EXPERIENCE)]})
        for day, name in enumerate(names):
            self.run("tractus-station", "study", "--study", STUDY, "--participant", name, "--device", "sim-rig", "--speed", "fast",
                     "--data", self.home / station, "--server", self.url, "--token-file", self.home / f"{station}.token", "--seed",
                     SEED, "--started", started(200 - day, 14))

    def hidden_effects(self):
        """What the model lab is for; the truth stays in a file beside the data, for who wants to look afterwards. Probing last: the
        lab offers the newest first, and its search takes seconds."""
        for rig, seed, effect, more in (("palpation", 12, "contact_friction", ["--tract", "--trials", 4, "--duration", 6, "--rate", 200]),
                                        ("probing", 7, "coulomb_friction", ["--trials", 6, "--duration", 4])):
            out = self.home / f"hidden-{rig}"
            if not out.exists():
                self.run(f"blind-{rig}", "--seed", seed, "--out", out, "--effect", effect, *more)
            model = json.loads((out / "model.json").read_text())
            model.pop("volume", None)  # the set brings it along
            self.researcher.ask("POST", "/lab/models?note=as%20handed%20out%2C%20simulated", model)
            self.researcher.ask("POST", f"/lab/measurements?name=Hidden%20effect%2C%20{rig}%20%28simulated%29", zip_of(out),
                                "application/octet-stream")

    def scored(self):
        """Every trial that was handed over has its scores, and none failed."""
        for _ in range(600):
            states, cursor = [], ""
            while True:
                page = self.admin.ask("GET", f"/trials?limit=200{cursor}")
                states += [trial["state"] for trial in page["trials"]]
                if not page["more"]:
                    break
                cursor = "&cursor=" + page["next"]
            if "assessing" not in states:
                break
            time.sleep(0.5)
        if "failed" in states or "assessing" in states:
            fail(f"{states.count('failed')} trials could not be scored, {states.count('assessing')} still wait")
        return len(states)


def make(programme):
    (programme.home / "demo.pin").write_text(PIN + "\n")
    programme.people()
    programme.fleet()
    programme.cases()
    say(f"{len(programme.badges)} simulated trainees in {len(TRAINEES)} cohorts, {len(programme.case_ids)} cases, three stations")
    with concurrent.futures.ThreadPoolExecutor() as pool:
        work = [pool.submit(programme.year_of, cohort, station) for cohort, station in zip(TRAINEES, programme.stations)]
        work.append(pool.submit(programme.hidden_effects))
        for one in work:
            one.result()
    programme.drilling(programme.stations[0])
    say("a year of assignments, done by simulated hands")
    programme.study(programme.stations[0])
    trials = programme.scored()
    for station in programme.stations:  # what a station keeps was handed over whole: half a gigabyte twice is enough
        for file in (programme.home / station / "trials").glob("*.ttrial"):
            file.unlink()
    say(f"a finished study, two measurement sets with a hidden effect; {trials} trials in all, every one scored and SIMULATED")


def main():
    parser = argparse.ArgumentParser(prog="deploy/demo_programme.py", description=__doc__.split("\n")[0],
                                     epilog="Example: deploy/demo_programme.py --bin build/release/bin --home run --url "
                                     "http://127.0.0.1:8480 --admin-password-file run/admin-password --volume run/l3.tvol --key run/signing.key")
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    parser.add_argument("--home", type=Path, required=True, help="where deploy/run keeps its things")
    parser.add_argument("--url", required=True)
    parser.add_argument("--admin-password-file", type=Path, required=True)
    parser.add_argument("--volume", type=Path, required=True, help="the CT that cases are carved from")
    parser.add_argument("--key", type=Path, required=True, help="that cases are signed with")
    options = parser.parse_args()
    told = options.home / "demo-accounts.json"
    if told.exists():
        say("the programme is there already")
        return 0
    began = time.monotonic()
    programme = Programme(options)
    make(programme)
    told.write_text(json.dumps({name: {"role": role, "password": password} for name, (role, password) in programme.passwords.items()},
                               indent=1, ensure_ascii=False) + "\n")
    say(f"made in {time.monotonic() - began:.0f} s")
    return 0


if __name__ == "__main__":
    os.umask(0o077)
    sys.exit(main())
