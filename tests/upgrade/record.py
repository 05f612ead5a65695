#!/usr/bin/env python3
"""Makes a release's fixture: has the server of that release itself fill a data folder, and notes what it answers about it.

    tests/upgrade/record.py --bin PROGRAMS-OF-THE-RELEASE --case CASE --out tests/upgrade/NAME

CASE is a folder that `tractus carve` made. All people, stations and trials are simulated. What is written: README.md of the fixture
says it. Done once for each release, by its own programs; what is there is not made again."""
import argparse
import contextlib
import hashlib
import io
import json
import secrets
import shutil
import sqlite3
import subprocess
import sys
import tarfile
import tempfile
import time
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "attack"))
from processes import Server  # noqa: E402
from trial_file import announced, crc32c, hand_over, trial_bytes  # noqa: E402
from wire import Client, Target  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PIN = "2580"
SAMPLES = 120  # of each trial: 8 kB
DAY_US = 86_400_000_000
PEOPLE = {"dora": "director", "fay": "faculty", "rob": "researcher", "tech": "technician", "tom": "trainee", "zoe": "trainee"}


class Site:
    """A server of the release with a signed-in client for each person."""

    def __init__(self, binary, data):
        self.binary, self.data, self.clients, self.passwords = binary, data, {}, {}
        self.server = Server(binary, data, ["--plain"], None)

    def run(self, *words):
        return subprocess.run([self.binary, *map(str, words)], check=True, capture_output=True, text=True).stdout

    def nobody(self):
        return Client(Target(self.server.port))

    def sign_in(self, name, password):
        client = self.nobody()
        answer = client.ask("POST", "/session", {"name": name, "password": password})
        if answer.status != 200:
            raise RuntimeError(f"{name} cannot sign in: {answer}")
        client.credentials = {"Cookie": answer.header("set-cookie").split(";")[0]}
        client.identity = answer.json()
        self.clients[name], self.passwords[name] = client, password
        return client

    def add(self, name, role, **more):
        made = self.clients["admin"].must("POST", "/accounts", {"name": name, "role": role} | more)
        own = f"fixture of {name}"
        self.sign_in(name, made["password"]).must("POST", "/session/password", {"old": made["password"], "new": own})
        self.sign_in(name, own)

    def station(self, name):
        code, token = self.clients["admin"].must("POST", "/stations/codes", {"name": name})["code"], secrets.token_hex(32)
        made = self.nobody().must("POST", "/stations/enrol", {"code": code, "token_sha256": hashlib.sha256(token.encode()).hexdigest()})
        client = Client(Target(self.server.port), {"Authorization": f"Bearer {token}"})
        client.identity, client.token = made, token
        return client


def zipped(files):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return out.getvalue()


def train(station, seed):
    ticket = station.must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
    slot, trial = station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"], secrets.token_hex(16)
    answer = hand_over(station, trial, slot, trial_bytes(trial, slot, "participant", count=SAMPLES, seed=seed))
    if answer.status != 200:
        raise RuntimeError(f"a trial is not taken: {answer}")
    return trial


def wait_for_work(site):
    """Until every trial is scored and every run of the lab and of the statistics has ended."""
    end = time.monotonic() + 600
    while (waiting := [line for line in site.clients["admin"].ask("GET", "/server/metrics").body.decode().splitlines()
                       if line.startswith("tractus_jobs_waiting ")]) and float(waiting[0].split()[1]) > 0:
        if time.monotonic() > end:
            raise RuntimeError("jobs wait after 600 s")
        time.sleep(0.2)


def teach(site, station, case):
    """Accounts, cohort, consents, assignment, trials, comment, rubric and rating, criteria and curriculum."""
    admin, director, faculty, trainee = (site.clients[name] for name in ("admin", "dora", "fay", "tom"))
    cohort = faculty.must("POST", "/cohorts", {"name": "year 1"})["id"]
    for name in ("tom", "zoe"):
        admin.must("POST", f"/cohorts/{cohort}/people", {"name": name})
    trainee.must("POST", "/session/consent", {"tier": "full"})
    site.clients["zoe"].must("POST", "/session/consent", {"tier": "none"})
    assignment = faculty.must("POST", "/assignments", {
        "title": "week 1", "cases": [{"scenario": {"tuned": "hard"}}], "repeats": 4, "seed": 1, "release": "at_once", "cohort": cohort})["id"]
    trials = [train(station, seed) for seed in (1, 2)]
    faculty.must("POST", f"/trials/{trials[0]}/comments", {"text": "hold the drill steadier", "at_s": 0.1})
    item = {"label": "Path", "low": 1, "high": 5, "low_text": "strays", "middle_text": "corrects itself", "high_text": "straight"}
    director.must("POST", "/rubrics", {"id": "path", "rubric": {"format": "tractus-rubric/1", "title": "Path", "items": [item]}})
    director.must("POST", f"/trials/{trials[0]}/rating-requests", {"rubric": "path"})
    faculty.must("POST", f"/trials/{trials[0]}/ratings", {"rubric": "path", "scores": [4], "comment": "nearly"})
    criteria = {"format": "tractus-criteria/1", "requirements": [{"kind": "recognition", "share": 0.8, "last": 5}]}
    director.must("POST", "/criteria", {"case": case, "reason": "our own rule", "criteria": criteria})
    director.must("POST", "/curricula", {"title": "First year", "reason": "begins", "steps": [
        {"id": "a", "name": "Hard bone", "cases": [{"scenario": {"tuned": "hard"}}], "repeats": 2, "after": [], "criteria": criteria}]})
    return {"assignment": assignment, "cohort": cohort, "trials": trials}


def research(site, station):
    """A study with a trial, a plan, a model and measurements of the lab with a comparison, a token."""
    researcher = site.clients["rob"]
    study = researcher.must("POST", "/studies", {
        "id": "blind", "title": "A blind study", "repeats": 1, "ordering": "random", "seed": 1,
        "scenarios": [{"tuned": "soft"}, {"tuned": "lateral_breach"}], "participants": [{"name": "S01"}, {"name": "S02"}]})["id"]
    analysis = {"id": "one", "question": "do they improve?", "method": "ols", "formula": "probing_force_mean ~ number"}
    plan = researcher.must("POST", "/cohort/plans", {"plan": {"format": "tractus-plan/1", "title": "A plan", "question": "do they improve?",
                                                              "subject": "participant", "analyses": [analysis]}})
    tool = ROOT / "tests/data/force/cable_tool_odbl"
    rows = {path.name: b"".join(path.read_bytes().splitlines(keepends=True)[:151]) for path in (tool / "drum/light_fast").iterdir()}
    kept = researcher.must("POST", "/lab/measurements?name=cable", zipped(rows), kind="application/octet-stream")
    model = researcher.must("POST", "/lab/models", (tool / "model.json").read_bytes())
    run = researcher.must("POST", "/lab/comparisons", {"model": model["id"], "measurements": kept["id"]})["id"]
    token = researcher.must("POST", "/tokens", {"name": "notebook", "scopes": ["studies:read", "lab:read"], "password": site.passwords["rob"],
                                                "expires_utc_us": int(time.time() * 1e6) + 300 * DAY_US})
    return {"study": study, "plan": plan["id"], "model": model["id"], "run": run, "token": token["token"]}


def half_sent(station):
    """An upload that is announced and of which the first half is here: (trial, slot, its bytes)."""
    ticket = station.must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
    slot, trial = station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"], secrets.token_hex(16)
    data = trial_bytes(trial, slot, "participant", count=SAMPLES, seed=7)
    half = data[:len(data) // 2]
    station.must("PUT", f"/uploads/{trial}", {"case_id": slot, "size_bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()})
    station.must("PATCH", f"/uploads/{trial}?offset_bytes=0", half, kind="application/octet-stream", headers={"X-Crc32c": f"{crc32c(half):08x}"})
    return {"trial": trial, "slot": slot, "sent_bytes": len(half), "whole": data.hex()}


def fill(site, case):
    for name, role in PEOPLE.items():
        site.add(name, role, **({"badge": "B-1", "pin": PIN} if name == "tom" else {}))
    station = site.station("station-1")
    gone = site.station("stolen")
    site.clients["admin"].must("POST", f"/stations/{gone.identity['id']}/revoke")
    made = teach(site, station, case) | research(site, station) | {"case": case, "station": station.identity["id"]}
    site.clients["tom"].must("POST", "/session/notifications", {"address": "tom@example.org", "choices": [{"kind": "released", "delivery": "daily"}]})
    site.clients["fay"].must("POST", "/session/views", {"page": "trials", "name": "hard bone", "search": "q=hard"})
    wait_for_work(site)
    return made | {"half": half_sent(station), "station_token": station.token}


def questions(made):
    """(who, path) of what the release is asked; its answers are what every later version has to give."""
    one, two = made["trials"]
    asked = {
        "admin": ["/accounts", "/accounts/tokens", "/audit?limit=200", "/stations", f"/stations/{made['station']}", "/cohorts", "/consents", "/cases",
                  f"/cases/{made['case']}", "/trials?limit=200", "/group-rules", "/erasures"],
        "dora": ["/session", "/rubrics", "/curricula", "/criteria", f"/cases/{made['case']}/passing", "/retention", "/cohort/trainees",
                 "/cohort/progress"],
        "fay": ["/session", f"/cohorts/{made['cohort']}", "/assignments", f"/assignments/{made['assignment']}", f"/trials/{one}",
                f"/trials/{one}/comments", f"/trials/{one}/ratings", "/session/views", "/ratings"],
        "rob": ["/session", "/studies", f"/studies/{made['study']}", f"/studies/{made['study']}/events", "/cohort/plans",
                f"/cohort/plans/{made['plan']}", "/lab/models", f"/lab/models/{made['model']}", "/lab/measurements", "/lab/runs", f"/lab/runs/{made['run']}",
                "/cohort/table", "/export/summary.csv", "/export/trials.csv", "/export/scores.csv", "/tokens"],
        "tech": ["/session"],
        "tom": ["/session", "/session/consent", "/session/notifications", "/assignments", f"/trials/{two}", f"/trials/{one}/comments"],
        "zoe": ["/session", "/session/consent"]}
    return [(who, path) for who, paths in asked.items() for path in paths]


def content(answer):
    """JSON as it is, anything else as text."""
    return answer.json() if "json" in answer.header("content-type") else answer.body.decode()


def answers(site, made):
    out = []
    for who, path in questions(made):
        answer = site.clients[who].ask("GET", path)
        if answer.status != 200:
            raise RuntimeError(f"{who} {path}: {answer}")
        out.append({"who": who, "path": path, "answer": content(answer)})
    return out


def lines(made, said):
    """One JSON object a line: first what was made, then an answer each."""
    return "".join(json.dumps(one) + "\n" for one in [made, *said])


def dump(database):
    with contextlib.closing(sqlite3.connect(database)) as connection:
        return "\n".join(connection.iterdump()) + "\n"


def kept(info):
    name = info.name.removeprefix("./")
    left_out = name.startswith(("tls", "scratch", "serving.lock", "tractus.db"))
    info.uid = info.gid = 0
    info.uname = info.gname = ""
    return None if left_out else info


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("--case", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-record-"))
    password = folder / "password"
    password.write_text("fixture of admin\n")
    site = Site(options.bin.resolve() / "tractus-server", folder / "data")
    try:
        site.run("init", "--data", site.data, "--admin-name", "admin", "--password-file", password)
        case = json.loads(site.run("publish", "--data", site.data, "--json", options.case))["case_id"]
        site.server.start()
        site.sign_in("admin", "fixture of admin")
        made = fill(site, case)
        site.server.stop()
        site.server.start()  # what it answers after a start of its own, as the later one will be asked
        said = answers(site, made)
        site.server.stop()
        site.run("verify", "--data", site.data)
        options.out.mkdir(parents=True, exist_ok=True)
        (options.out / "database.sql").write_text(dump(site.data / "tractus.db"))
        (options.out / "answers.jsonl").write_text(lines({"made": made, "passwords": site.passwords}, said))
        with tarfile.open(options.out / "folder.tar.xz", "w:xz") as archive:
            archive.add(site.data, ".", filter=kept)
    finally:
        site.server.stop()
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
