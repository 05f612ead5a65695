"""The demo study's conductor; see deploy/demo-study. Standard library alone; asks the server as a browser does."""
import argparse
import hashlib
import json
import os
import queue
import secrets
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request
from pathlib import Path

STUDY = "demo-study"
# Years as published (Tables 2 and 4); who of them was senior, fellow or resident is not: given by order.
YEARS = [6, 3, 1, 1, 0.5, 0.33, 0.1, 0, 0, 0]
LEVELS = ["senior"] * 2 + ["fellow"] * 4 + ["resident"] * 4
SCENARIOS = ["hard", "soft", "lateral_breach", "in_out_in"]
BREACHES = {"Lateral breach", "In, out and in again"}
REPEATS = 3
STATIONS = 3
KILL_SERVER_AFTER = 50  # trials of all
KILLED_AFTER_TRIALS = 3  # of station 2, then in the middle of the next


def fail(what):
    raise SystemExit(f"deploy/demo-study: {what}")


class Server:
    """The server's process and a signed-in account."""

    def __init__(self, programs, home, web):
        self.programs, self.home, self.web, self.cookie = programs, home, web, None
        self.up, self.deaths = threading.Event(), 0
        password = secrets.token_urlsafe(12)
        (home / "password").write_text(password + "\n")
        self.run("init", "--data", home / "server", "--password-file", home / "password")
        self.password = password

    def run(self, *arguments):
        subprocess.run([self.programs / "tractus-server", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    def start(self, port=0):
        command = [self.programs / "tractus-server", "serve", "--data", self.home / "server", "--listen", f"127.0.0.1:{port}", "--plain", "--json"]
        if (self.web / "index.html").exists():
            command += ["--web", self.web]
        self.log = open(self.home / "server.log", "a")
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.log, text=True, start_new_session=True)
        self.url = json.loads(self.process.stdout.readline())["listening"].rstrip("/")
        if not self.cookie:
            self.ask("POST", "/session", {"name": "admin", "password": self.password})
        self.up.set()

    def die_for(self, seconds):
        """Killed as by a power cut, and started again at the same address."""
        self.up.clear()
        self.deaths += 1
        self.process.kill()
        self.process.wait()
        say(f"the server is killed, for {seconds} s")
        time.sleep(seconds)
        self.start(int(self.url.rsplit(":", 1)[1]))
        say("the server is back")

    def ask(self, method, path, body=None):
        """The server's answer; a question that meets the server's death is asked again when it is back."""
        deaths = self.deaths
        try:
            return self.answer(method, path, body)
        except OSError:
            if deaths == self.deaths and self.up.is_set():
                raise
        self.back()
        return self.answer(method, path, body)

    def back(self):
        if not self.up.wait(60):
            fail("the server has not come back after a minute")

    def answer(self, method, path, body):
        headers = {"X-Tractus": "1", "Content-Type": "application/json"}
        if self.cookie:
            headers["Cookie"] = self.cookie
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"{self.url}/api/v1{path}", data=data, headers=headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                if set_cookie := answer.headers.get("Set-Cookie"):
                    self.cookie = set_cookie.split(";")[0]
                return json.loads(answer.read() or b"null")
        except urllib.error.HTTPError as error:
            fail(f"{method} {path}: {error.code} {error.read().decode()}")

    def stop(self):
        self.process.terminate()
        self.process.wait(30)
        self.log.close()


class Station(threading.Thread):
    """One station: a folder of its own, one participant after the other from the common queue."""

    def __init__(self, number, server, waiting, fail_once):
        super().__init__(name=f"station-{number}")
        self.server, self.waiting, self.fail_once = server, waiting, fail_once
        self.home = server.home / self.name
        self.token = server.home / f"{self.name}.token"
        self.safe, self.killed, self.plans, self.wrong = {}, [], [], None
        server.run("enrol", "--data", server.home / "server", "--name", self.name, "--out", self.token)
        self.home.mkdir()
        (self.home / "config.json").write_text(json.dumps({"format": "tractus-station/1", "name": self.name}))

    def run(self):
        try:
            while True:
                try:
                    participant = self.waiting.get_nowait()
                except queue.Empty:
                    return
                while not self.trials_of(participant):
                    pass
        except BaseException as reason:  # shown by the main thread
            self.wrong = reason

    def trials_of(self, participant):
        """A participant's trials; False when it must be asked for again: the station was killed, or the server was away."""
        command = [self.server.programs / "tractus-station", "study", "--study", STUDY, "--participant", participant,
                   "--device", "sim-rig", "--speed", "fast", "--data", self.home, "--server", self.server.url,
                   "--token-file", self.token, "--seed", "2026", "--follow"]
        deaths = self.server.deaths
        with open(self.server.home / f"{self.name}.out", "a") as out:
            process = subprocess.Popen(command, stdout=out, stderr=subprocess.PIPE, text=True)
            for line in process.stderr:
                out.write(line)
                if line.startswith('{"trial_id"'):
                    self.on_disk(json.loads(line), process)
            status = process.wait()
        if status == -signal.SIGKILL:
            say(f"{self.name} starts again")
            return False
        if status != 0 and deaths != self.server.deaths:  # nothing on the disk of this participant: it needs the server
            self.server.back()
            return False
        if status != 0:
            fail(f"{self.name}: {participant}: exit {status}; see {self.name}.out")
        study = self.server.ask("GET", f"/studies/{STUDY}")
        return any(person["name"] == participant and person["done"] == person["planned"] for person in study["participants"])

    def on_disk(self, said, process):
        if said["trial_id"] not in self.safe:  # while it runs: what is left to be done lies beside it
            self.plans += [file.read_bytes() for file in (self.home / "studies").rglob("*.json")]
        self.safe[said["trial_id"]] = said["samples_safe"]
        if self.fail_once and len(self.safe) > KILLED_AFTER_TRIALS and said["samples_safe"] >= 2000:
            self.fail_once = False
            process.send_signal(signal.SIGKILL)
            self.killed.append(said["trial_id"])
            say(f"{self.name} is killed in the middle of a trial, {said['samples_safe']} samples on its disk")


def say(line):
    print(line, flush=True)


def make_study(server):
    people = [{"name": f"S{i + 1:02}", "level": level, "experience_years": years, "simulated": True}
              for i, (years, level) in enumerate(zip(YEARS, LEVELS))]
    server.ask("POST", "/studies", {
        "id": STUDY, "title": "Twelve trials, simulated surgeons", "scenarios": [{"tuned": name} for name in SCENARIOS],
        "repeats": REPEATS, "ordering": "random", "seed": 2026, "participants": people})
    return [one["name"] for one in people]


def wait_until_assessed(server):
    for _ in range(600):
        study = server.ask("GET", f"/studies/{STUDY}")
        trials = trials_of(study)
        if all(trial["assessment"] in ("assessed", "failed") for trial in trials.values()):
            return study
        time.sleep(0.2)
    fail("the server has not assessed every trial after two minutes")


def trials_of(study):
    return {trial["id"]: trial for person in study["participants"] for slot in person["slots"] for trial in slot["trials"]}


def recorded_samples(content):
    """Counted from the frames of a trial file alone (shared/doc/trial-format.md), without the product's reader."""
    at, samples = content.index(b"\n") + 1, 0
    while at < len(content):
        kind, length = struct.unpack_from("<4sI", content, at)
        if kind in (b"SAMP", b"PACK"):
            samples += struct.unpack_from("<I", content, at + 20)[0]
        at += 20 + length
    return samples


def compare(server, stations, study):
    """Every sample that a station has is on the server: counts, and the hash of every file."""
    on_server = trials_of(study)
    at_stations, samples, wrong = set(), 0, []
    for station in stations:
        for file in sorted((station.home / "trials").glob("*.ttrial")):
            trial = file.stem
            at_stations.add(trial)
            there = on_server.get(trial)
            content = file.read_bytes()
            counted, sha256 = recorded_samples(content), hashlib.sha256(content).hexdigest()
            kept = server.home / "server" / "objects" / sha256[:2] / sha256[2:]
            samples += counted
            if there is None:
                wrong.append(f"{trial}: is not on the server")
            elif there["samples"] != counted or there["sha256"] != sha256:
                wrong.append(f"{trial}: {counted} samples at the station, {there['samples']} on the server")
            elif hashlib.sha256(kept.read_bytes()).hexdigest() != sha256:
                wrong.append(f"{trial}: the server's file is another")
            elif counted < station.safe.get(trial, 0):
                wrong.append(f"{trial}: {station.safe[trial]} samples were safe, {counted} are left")
    wrong += [f"{trial}: is on the server and at no station" for trial in set(on_server) - at_stations]
    return samples, len(at_stations), wrong


def leaks(stations, study):
    """What at a station would tell which scenario a trial was: names, kinds and ids in any file, log or file name, sealed trials
    of different sizes, headers that differ from trial to trial by more than they must."""
    telling = [name.encode() for scenario in study["scenarios"] for name in (scenario["case_id"], scenario["title"])]
    telling += [name.encode() for name in SCENARIOS if name not in ("hard", "soft")] + [b'"hard"', b'"soft"', b"walls", b"layers", b"scenario"]
    found, sizes, headers = [], set(), set()
    for station in stations:
        files = [file for file in station.home.rglob("*") if file.is_file()] + [station.home.parent / f"{station.name}.out"]
        for plan in map(json.loads, station.plans):
            sizes |= {len(trial.pop("sealed")) for trial in plan["trials"]}  # random characters spell anything
            found += [f"a plan: {word.decode()}" for word in telling if word in json.dumps(plan).encode()]
        for file in files:
            content = file.read_bytes()
            if file.suffix == ".ttrial":
                header = json.loads(content[36:36 + struct.unpack_from("<I", content, 20)[0]])
                headers.add(json.dumps([sorted(header), header["probe"], sorted(header["extra"]), header["extra"]["limits"]]))
                content = texts_of(content)
            found += [f"{file.name}: {word.decode()}" for word in telling if word in content or word in file.name.encode()]
    if len(sizes) != 1:
        found.append(f"sealed trials have sizes {sorted(sizes)}")
    if len(headers) != 1:
        found.append(f"the headers differ: {sorted(headers)}")
    return found


def texts_of(content):
    """Header and events of a trial file: all of it that is text."""
    at, out = content.index(b"\n") + 1, b""
    while at < len(content):
        kind, length = struct.unpack_from("<4sI", content, at)
        if kind in (b"HEAD", b"EVNT"):
            out += content[at + 20:at + 20 + length] + b"\n"
        at += 20 + length
    return out


def table(study):
    say(f"\n{'':4} {'level':9} {'years':>5}  {'done':>8}  {'recognised':>11}  {'breaches recognised':>19}   all SIMULATED")
    for person in study["participants"]:
        counted = [(slot["scenario"], trial["correct"]) for slot in person["slots"] for trial in slot["trials"] if trial["state"] == "counts"]
        breaches = [right for scenario, right in counted if scenario in BREACHES]
        say(f"{person['name']:4} {person['level']:9} {person['experience_years']:5g}  {person['done']:3} of {person['planned']:2}"
            f"  {sum(right is True for _, right in counted):5} of {len(counted):2}  {sum(right is True for right in breaches):13} of {len(breaches):2}")


def check_complete(study):
    for person in study["participants"]:
        by_scenario = {}
        for slot in person["slots"]:
            counting = [trial for trial in slot["trials"] if trial["state"] == "counts"]
            if counting:
                by_scenario[slot["scenario"]] = by_scenario.get(slot["scenario"], 0) + 1
        if person["done"] != REPEATS * len(SCENARIOS) or set(by_scenario.values()) != {REPEATS} or len(by_scenario) != len(SCENARIOS):
            fail(f"{person['name']}: not every scenario {REPEATS} times: {by_scenario}")
    failed = [trial["id"] for trial in trials_of(study).values() if trial["assessment"] == "failed"]
    if failed:
        fail(f"{len(failed)} trials could not be assessed: {failed[0]}")


def done_so_far(server):
    return sum(person["done"] for person in server.ask("GET", f"/studies/{STUDY}")["participants"])


def kill_server_in_the_middle(server, stations):
    while any(station.is_alive() for station in stations):
        if done_so_far(server) >= KILL_SERVER_AFTER:
            return server.die_for(5)
        time.sleep(0.5)
    fail("the study was through before the server could be killed: the demo shows nothing")


def conduct(programs, home, web, kill, kill_server):
    server = Server(programs, home, web)
    server.start()
    waiting = queue.Queue()
    for name in make_study(server):
        waiting.put(name)
    began = time.monotonic()
    stations = [Station(n + 1, server, waiting, kill and n == 1) for n in range(STATIONS)]
    say(f"{len(YEARS)} simulated surgeons, {REPEATS * len(SCENARIOS)} trials each, {STATIONS} stations, at {server.url}")
    for station in stations:
        station.start()
    if kill_server:
        kill_server_in_the_middle(server, stations)
    for station in stations:
        station.join()
        if station.wrong:
            raise station.wrong
    study = wait_until_assessed(server)
    took = time.monotonic() - began
    check_complete(study)
    if kill and not stations[1].killed:
        fail("station-2 was never killed: the demo shows nothing")
    samples, files, wrong = compare(server, stations, study)
    told = leaks(stations, study)
    table(study)
    say(f"\n{files} trial files, {samples} samples at the stations; on the server, by count and SHA-256: "
        f"{'the same' if not wrong else 'NOT the same'}. {took:.0f} s.")
    say(f"Files, names and logs of the stations that tell which scenario a trial was: {len(told) or 'none'}.")
    for line in wrong + told:
        say(f"  {line}")
    return server, not wrong and not told


def main():
    parser = argparse.ArgumentParser(prog="deploy/demo-study")
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("--web", type=Path, required=True)
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep the folder and leave the server running")
    parser.add_argument("--kill-server", action="store_true", help="kill the server too, for five seconds in the middle")
    parser.add_argument("--no-kill", action="store_true", help="leave every station alone")
    options = parser.parse_args()
    if options.keep and options.keep.exists():
        fail(f"{options.keep}: exists already")
    home = options.keep or Path(tempfile.mkdtemp(prefix="demo-study-"))
    home.mkdir(parents=True, exist_ok=True)
    server, same = None, False
    try:
        server, same = conduct(options.bin.resolve(), home.resolve(), options.web.resolve(), not options.no_kill, options.kill_server)
    finally:
        if server and not options.keep:
            server.stop()
            shutil.rmtree(home)
    if options.keep:
        say(f"the study: {server.url}/studies/{STUDY} (admin, password in {home}/password; server: process {server.process.pid})")
    return 0 if same else 1


if __name__ == "__main__":
    os.umask(0o077)
    sys.exit(main())
