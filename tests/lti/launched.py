#!/usr/bin/python3
"""Launches, scores and statements of a real tractus-server, with an authorisation server and a learning record store that others wrote.

    tests/lti/launched.py --bin build/release/bin

The platform's sign-in, tokens and keys are npm's certified oidc-provider, its claims and gradebook are ours (platform.mjs says which is
which); the record store is npm's @learninglocker/xapi-statements (record_store.mjs). `npm ci --ignore-scripts` here first. Exit 0: all is
as it should be. It takes half a minute."""
import argparse
import json
import secrets
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "attack"))
from trial_file import hand_over, trial_bytes  # noqa: E402
from wire import Client  # noqa: E402
from world import PIN, Setup, World  # noqa: E402

DONE_S = 120  # the server looks every 30 s, and a busy machine is slow
CLIENT, DEPLOYMENT = "tractus-of-a-test", "d-1"


def check(holds, what):
    print(("  ok    " if holds else "  WRONG ") + what, flush=True)
    if not holds:
        raise SystemExit(1)


def within(seconds, condition):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.2)
    return True


class Peer:
    """A script of Node.js that answers each line with a line."""

    def __init__(self, script):
        self.process = subprocess.Popen(["node", "--no-warnings", str(HERE / script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address.startswith("http"):
            raise RuntimeError(f"{script} does not start: run npm ci --ignore-scripts in tests/lti first")

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().strip()

    def stop(self):
        self.process.stdin.close()
        self.process.wait(10)


class Course:
    """A cohort of one trainee, whose assignment a course of the platform links to."""

    def __init__(self, setup):
        self.platform, self.records = Peer("platform.mjs"), Peer("record_store.mjs")
        self.world = World(setup, options=["--webhook-network", "127.0.0.1", "--webhook-network", "::1"])
        self.admin, self.tool = self.world.admin, f"http://127.0.0.1:{self.world.server.port}"
        self.faculty, self.trainee = self.world.account("fay", "faculty"), self.world.account("tom", "trainee", badge="B-1", pin=PIN)
        self.station, self.done = self.world.station("station-1"), 0
        cohort = self.faculty.must("POST", "/cohorts", {"name": "year 1"})["id"]
        self.admin.must("POST", f"/cohorts/{cohort}/people", {"name": "tom"})
        self.assignment = self.faculty.must("POST", "/assignments", {
            "title": "Gefühl für die Wand", "cases": [{"scenario": {"tuned": "hard"}}, {"scenario": {"tuned": "soft"}}], "seed": 1,
            "cohort": cohort, "release": "held"})["id"]
        self.platform.say(json.dumps({"tool": self.tool, "client_id": CLIENT}))
        self.platform.say(json.dumps({"launch": {"assignment": self.assignment, "deployment": DEPLOYMENT, "tool": self.tool}}))

    def launch(self, name, *more):
        said = subprocess.run(["node", "--no-warnings", str(HERE / "browser.mjs"), self.platform.address, self.tool, CLIENT, name, *more],
                              capture_output=True, text=True, timeout=60)
        if said.returncode != 0:
            raise RuntimeError(said.stderr)
        return json.loads(said.stdout)

    def train(self, breach):
        ticket = self.station.must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
        self.done += 1
        slot, trial = self.station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"], secrets.token_hex(16)
        answer = hand_over(self.station, trial, slot, trial_bytes(trial, slot, "participant", seed=self.done, breach=breach))
        if answer.status != 200:
            raise RuntimeError(f"a trial is not taken: {answer}")

    def outbox(self):
        return self.admin.must("GET", "/webhooks")

    def stop(self):
        self.world.__exit__(None, None, None)
        self.platform.stop()
        self.records.stop()


def launched(at):
    issuer = at.platform.address
    unknown = at.launch("student-7")
    check(unknown["visited"][-1] == f"{at.tool}/?sign_in=launch_failed", f"a platform that nobody registered is refused: {unknown['visited'][-1]}")
    platform = at.admin.must("POST", "/lti/platforms", {
        "issuer": issuer, "client_id": CLIENT, "deployments": [DEPLOYMENT], "authorization_url": f"{issuer}/auth",
        "token_url": f"{issuer}/token", "keys_url": f"{issuer}/jwks"})
    unknown = at.launch("student-7")
    check(unknown["visited"][-1] == f"{at.tool}/?sign_in=launch_unknown", f"a person whom nobody linked is refused: {unknown['visited'][-1]}")
    check("tractus_session" not in unknown["cookies"], "and gets no session")
    newest = at.admin.must("GET", "/audit?limit=1")["rows"][0]
    check(newest["what"] == "refused: ltiLaunch" and newest["detail"]["subject"] == "student-7", f"the audit trail says who asked: {newest['detail']}")
    at.admin.must("POST", f"/lti/platforms/{platform['id']}/people", {"account": "tom", "subject": "student-7"})
    opened = at.launch("student-7")
    check(opened["visited"][-1] == f"{at.tool}/assignments/{at.assignment}", f"a linked person lands on the assignment: {opened['visited'][-1]}")
    person = Client(at.world.target, {"Cookie": f"tractus_session={opened['cookies']['tractus_session']}"})
    who = person.must("GET", "/session")
    check((who["name"], who["role"]) == ("tom", "trainee"), f"in an ordinary session: {who}")
    again = at.launch("student-7", "--again")
    check(again["visited"][-1] == f"{at.tool}/?sign_in=launch_failed" and "tractus_session" not in again["cookies"],
          "the same form sent twice opens nothing the second time")
    at.platform.say(json.dumps({"launch": {"assignment": at.assignment, "deployment": "d-2", "tool": at.tool}}))
    check(at.launch("student-7")["visited"][-1] == f"{at.tool}/?sign_in=launch_failed", "another deployment is refused")


def stated(at):
    at.admin.must("POST", "/record-store", {"endpoint": at.records.address, "key": "key", "secret": "secret"})
    at.world.renew(at.trainee)  # the link ended the sessions
    at.trainee.must("POST", "/session/consent", {"tier": "metrics"})
    at.train(breach=False)
    at.train(breach=True)
    at.world.wait_for_scores()
    check(json.loads(at.platform.say('{"scores": true}')) == [], "no score is sent while the results are held")
    at.faculty.must("POST", f"/assignments/{at.assignment}/release", {"release": "released"})
    scores = lambda: json.loads(at.platform.say('{"scores": true}'))  # noqa: E731
    check(within(DONE_S, scores), f"the gradebook takes a score once they are released: {at.outbox()['deliveries']}")
    score = scores()[0]
    check({key: score[key] for key in ("userId", "scoreGiven", "scoreMaximum", "activityProgress", "gradingProgress")} ==
          {"userId": "student-7", "scoreGiven": 1, "scoreMaximum": 2, "activityProgress": "Completed", "gradingProgress": "FullyGraded"},
          f"one of two answers is right: {score}")
    kept = lambda: json.loads(at.records.say("statements"))  # noqa: E731
    check(within(DONE_S, lambda: len(kept()) == 2), f"the record store takes a statement of each trial: {at.outbox()['deliveries']}")
    statements = sorted(kept(), key=lambda one: one["result"]["score"]["scaled"])
    check([one["verb"]["id"].rsplit("/", 1)[1] for one in statements] == ["failed", "passed"], "failed and passed, as ADL's vocabulary says")
    check({one["object"]["id"] for one in statements} == {f"{at.tool}/assignments/{at.assignment}"}, "of the assignment")
    accounts = [one["actor"]["account"] for one in statements]
    check(accounts[0] == accounts[1] and accounts[0]["homePage"] == f"{at.tool}/", f"by one account: {accounts[0]}")
    check("tom" not in json.dumps(statements), "whose name does not stand in it")
    check(not [one for one in at.outbox()["deliveries"] if one["state"] != "sent"], "everything was sent at the first attempt")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-lti-"))
    setup = Setup(options.bin.resolve(), folder, "sqlite", "nothing")
    try:
        at = Course(setup)
        launched(at)
        stated(at)
        at.stop()
    finally:
        setup.stop()
        shutil.rmtree(folder, ignore_errors=True)
    print("launches, scores and statements: as they should be")


if __name__ == "__main__":
    main()
