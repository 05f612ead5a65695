#!/usr/bin/env python3
"""Walks through the runbook of deploy/operations on a real tractus-server: what goes wrong is made to go wrong, and mended as written there.

    sudo tests/operations/drill.py --bin build/release/bin

A full disk (a small disk in memory: needs root), a wrong clock (libfaketime), a certificate that has ended, a stolen station, records of
yesterday. Exit 0: all is as the runbook says."""
import argparse
import json
import os
import secrets
import shutil
import signal
import ssl
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "attack"))
from trial_file import announced, hand_over, trial_bytes  # noqa: E402
from wire import Target  # noqa: E402
from world import PIN, Setup, World  # noqa: E402

FAKETIME = Path("/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1")
DISK_BYTES, RESERVE_BYTES = 1500 << 20, 256 << 20


def check(holds, what):
    print(("  ok    " if holds else "  WRONG ") + what, flush=True)
    if not holds:
        raise SystemExit(1)


class Department:
    """A server with one trainee, one teacher, two stations and work to do."""

    def __init__(self, setup, front=None, options=(), prepare=None):
        self.setup, self.world = setup, World(setup, front=front, options=options, prepare=prepare)
        self.faculty = self.world.account("fay", "faculty")
        self.trainee = self.world.account("tom", "trainee", badge="B-1", pin=PIN)
        self.stations = [self.world.station(f"station-{number}") for number in (1, 2)]
        cohort = self.faculty.must("POST", "/cohorts", {"name": "year 1"})["id"]
        self.world.admin.must("POST", f"/cohorts/{cohort}/people", {"name": "tom"})
        self.faculty.must("POST", "/assignments", {"title": "week 1", "cases": [{"scenario": {"tuned": "hard"}}], "repeats": 20, "seed": 1,
                                                   "cohort": cohort})

    def slot(self, station):
        ticket = station.must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
        return station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"]

    def train(self, station, seed):
        slot, trial = self.slot(station), secrets.token_hex(16)
        data = trial_bytes(trial, slot, "participant", seed=seed)
        return trial, slot, data, hand_over(station, trial, slot, data)

    def trials(self):
        return {one["id"] for one in self.world.admin.must("GET", "/trials?limit=200")["trials"]}

    def verified(self, *words, data=None):
        return self.setup.run("verify", "--data", data or self.world.data, *words)

    def restarted(self, environment=None):
        self.world.server.stop()
        self.world.server.environment = environment or self.setup.environment
        self.world.server.start()
        for person in (self.faculty, self.trainee, self.world.admin):
            self.world.renew(person)

    def stop(self):
        self.world.__exit__(None, None, None)


def disk_full(setup):
    print("Disk full")
    if os.geteuid() != 0:
        print("  left out: a disk of its own needs root")
        return
    mounted = []

    def small_disk(data):
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK_BYTES},mode=700", "tractus-drill", data.parent], check=True)
        mounted.append(data.parent)

    try:
        at = Department(setup, prepare=small_disk)
        check(at.world.admin.ask("GET", "/health").status == 200, "health is 200 before")
        under_way, slot = secrets.token_hex(16), at.slot(at.stations[0])
        data = trial_bytes(under_way, slot, "participant", seed=1)
        check(announced(at.stations[0], under_way, slot, data).status == 200, "a trial is under way")
        filler = at.world.folder / "old-backups"
        free = shutil.disk_usage(at.world.folder).free
        with open(filler, "wb") as file:
            file.write(b"\0" * (free - RESERVE_BYTES // 2))
        health = at.world.admin.ask("GET", "/health")
        check(health.status == 503 and b"disk" in health.body, f"health is 503 and says why: {health.body.decode()[:120]}")
        ticket = at.stations[0].must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
        refused = at.stations[0].ask("POST", "/work/next", {"ticket": ticket})
        check(refused.status == 503 and b"free bytes" in refused.body, f"a new trial is refused before it begins: {refused}")
        check(at.stations[0].ask("POST", f"/uploads/{under_way}/commit").status == 200, "what was under way is taken")
        check(at.trainee.ask("GET", "/session").status == 200 and at.faculty.ask("GET", "/assignments").status == 200, "pages are answered")
        filler.unlink()
        check(at.world.admin.ask("GET", "/health").status == 200, "with old backups gone, health is 200 without a restart")
        check(at.train(at.stations[0], 3)[3].status == 200 and under_way in at.trials(), "trials are taken again; nothing was lost")
        check(at.verified().returncode == 0, "verify holds")
        at.stop()
    finally:
        for folder in mounted:
            subprocess.run(["umount", "-l", folder], check=False)


def clock_wrong(setup):
    print("Clock wrong")
    if not FAKETIME.exists():
        raise SystemExit(f"{FAKETIME} is missing: install faketime")
    at = Department(setup)
    first = at.train(at.stations[0], 1)[0]
    for days in ("+3d", "-3d"):
        at.restarted(setup.environment | {"LD_PRELOAD": str(FAKETIME), "FAKETIME": days, "FAKETIME_DONT_FAKE_MONOTONIC": "1"})
        check(at.world.admin.ask("GET", "/session").status == 200, f"with a clock of {days}, people sign in")
        check(at.train(at.stations[0], 2)[3].status == 200, f"with a clock of {days}, a trial is taken")
    at.restarted()
    check(at.world.admin.ask("GET", "/session").status == 200 and at.train(at.stations[0], 4)[3].status == 200, "after the clock is right again, too")
    check(first in at.trials() and len(at.trials()) == 4, "all four trials are there")
    ended = at.verified()
    check(ended.returncode == 0, f"verify holds: the trail counts its rows and does not rely on the clock {ended.stdout}{ended.stderr}")
    at.stop()


def trusts(target, authority):
    try:
        Target(target.port, str(authority)).connect().close()
        return ""
    except ssl.SSLError as error:
        return str(error)


def certificate_expired(setup):
    print("Certificate expired")
    at = Department(setup, front="tls")
    authority, own = at.world.data / "tls/authority.pem", at.world.folder / "own"
    before = (at.world.data / "tls/server.pem").read_bytes()
    check(trusts(at.world.target, authority) == "", "a client that trusts the authority connects")
    year = setup.environment | {"LD_PRELOAD": str(FAKETIME), "FAKETIME": "+800d", "FAKETIME_DONT_FAKE_MONOTONIC": "1"}
    at.world.server.stop()
    at.world.server.environment = year
    at.world.server.start()
    renewed = (at.world.data / "tls/server.pem").read_bytes()
    check(renewed != before, "two years later a restart makes a new certificate of the same authority")
    check(authority.read_bytes() in renewed, "which stations and browsers trust already")
    at.world.server.stop()
    own.mkdir()
    for name, days in (("old", "-10d"), ("new", "+0d")):
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "5",
                        "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", own / f"{name}.key", "-out", own / f"{name}.pem"],
                       check=True, capture_output=True, env=os.environ | {"LD_PRELOAD": str(FAKETIME), "FAKETIME": days})
    at.world.server.environment = setup.environment
    options = list(at.world.server.options)
    for name, words in (("old", "certificate has expired"), ("new", "")):
        at.world.server.options = [*options, "--certificate", own / f"{name}.pem", "--key", own / f"{name}.key"]
        at.world.server.start()
        said = trusts(at.world.target, own / f"{name}.pem")
        check(words in said and bool(words) == bool(said), f"a certificate of your own, {name}: {said or 'trusted'}")
        at.world.server.stop()


def station_stolen(setup):
    print("Station stolen")
    at = Department(setup)
    stolen, other = at.stations
    trial, slot, data, _ = at.train(stolen, 1)
    half, half_slot = secrets.token_hex(16), at.slot(stolen)
    half_data = trial_bytes(half, half_slot, "participant", seed=2)
    check(announced(stolen, half, half_slot, half_data).status == 200, "it holds a place and an upload that is not finished")
    at.world.admin.must("POST", f"/stations/{stolen.identity['id']}/revoke")
    for method, path, body in (("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN}), ("POST", f"/uploads/{half}/commit", None),
                               ("POST", "/station/report", {})):
        status = stolen.ask(method, path, body).status
        check(status in (401, 403), f"{method} {path} with its token: {status}")
    check(trial in at.trials(), "its trials stay")
    check(at.train(other, 3)[3].status == 200, "the trainee goes on at another station")
    at.world.admin.must("POST", f"/accounts/{at.trainee.identity['id']}/badge", {"badge": "B-1", "pin": "8642"})
    check(other.ask("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN}).status != 200, "a PIN that was seen there is changed")
    check(at.verified().returncode == 0, "verify holds")
    at.stop()


def yesterday(setup):
    print("Records restored to yesterday")
    sent = setup.folder / f"anchors-{secrets.token_hex(4)}"
    at = Department(setup, options=["--anchors-to", sent])
    at.train(at.stations[0], 1)
    backup = at.world.folder / "backup"
    setup.must_run("backup", "--data", at.world.data, "--out", backup)
    lost = at.train(at.stations[0], 2)
    at.world.server.stop()
    restored = at.world.folder / "restored"
    setup.must_run("restore", "--from", backup, "--data", restored)
    check(at.verified(data=restored).returncode == 0, "the restored folder is whole")
    ended = at.verified("--anchors", sent, data=restored)
    check(ended.returncode == 1, f"held against the anchors sent elsewhere, it lacks rows: {(ended.stdout + ended.stderr).splitlines()[0][:110]}")
    at.world.server.data = restored
    at.world.server.start()
    for person in (at.faculty, at.trainee, at.world.admin):
        at.world.renew(person)
    check(lost[0] not in at.trials(), "today's trial is not in it")
    check(hand_over(at.stations[0], *lost[:3]).status == 404, "its place was given to the station after the backup: it is refused at first")
    check(at.slot(at.stations[0]) == lost[1], "the trainee signs in at that station, which gets the same place again")
    answer = hand_over(at.stations[0], *lost[:3])
    check(answer.status == 200 and lost[0] in at.trials(), f"the station hands it over again ({answer.status})")
    check(at.verified(data=restored).returncode == 0, "and verify holds")
    at.world.server.stop(signal.SIGTERM)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-drill-"))
    setup = Setup(options.bin.resolve(), folder, "sqlite", "nothing")
    try:
        for step in (disk_full, clock_wrong, certificate_expired, station_stolen, yesterday):
            step(setup)
    finally:
        setup.stop()
        shutil.rmtree(folder, ignore_errors=True)
    print(json.dumps({"drill": "as the runbook says"}))


if __name__ == "__main__":
    main()
