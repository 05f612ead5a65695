#!/usr/bin/python3
"""What people and programs are told of by a real tractus-server, through a real mail server (aiosmtpd) and a receiver of webhooks.

    tests/notifications/told.py --bin build/release/bin

The mail server hangs, refuses and comes back; a receiver answers 500 and is slow; the server is killed while it sends. Exit 0: all is
as it should be. It takes three minutes, most of them waiting for the next attempt."""
import argparse
import json
import secrets
import shutil
import signal
import socket
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "attack"))
from receivers import MailServer, Webhooks, is_signed, settings_file  # noqa: E402
from trial_file import hand_over, trial_bytes  # noqa: E402
from world import PIN, Setup, World  # noqa: E402

RIGHT, WRONG = 60, 2  # shared/assessment/trainee_test.cpp: sixty right answers make a trainee competent, two wrong ones a relapse
LOOKS_EVERY_S, AT_ONCE_S, RETRY_S = 30, 10, 150  # a retry comes a minute later, or two after a kill


def check(holds, what):
    print(("  ok    " if holds else "  WRONG ") + what, flush=True)
    if not holds:
        raise SystemExit(1)


def within(seconds, condition):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


class Hospital:
    """People of one cohort, a station, and both receivers."""

    def __init__(self, setup):
        self.folder = Path(tempfile.mkdtemp(dir=setup.folder))
        self.mail, self.hooks = MailServer(self.folder), Webhooks()
        settings = settings_file(self.folder, self.mail, ["hospital.example"])
        self.world = World(setup, options=["--mail", settings, "--webhook-network", "127.0.0.1"])
        self.faculty, self.trainee = self.world.account("fay", "faculty"), self.world.account("tom", "trainee", badge="B-1", pin=PIN)
        self.station = self.world.station("station-1")
        cohort = self.faculty.must("POST", "/cohorts", {"name": "year 1"})["id"]
        self.cohort, self.done = cohort, 0
        self.world.admin.must("POST", f"/cohorts/{cohort}/people", {"name": "tom"})

    def assign(self, title, repeats=1, **more):
        return self.faculty.must("POST", "/assignments", {
            "title": title, "cases": [{"scenario": {"tuned": "hard"}}, {"scenario": {"tuned": "soft"}}], "repeats": repeats, "seed": 1,
            "cohort": self.cohort} | more)["id"]

    def train(self, trials, breach):
        ticket = self.station.must("POST", "/work/sign-in", {"badge": "B-1", "pin": PIN})["ticket"]
        for _ in range(trials):
            self.done += 1  # a trial's time of start: each is later than those before
            slot, trial = self.station.must("POST", "/work/next", {"ticket": ticket})["trial"]["slot"], secrets.token_hex(16)
            answer = hand_over(self.station, trial, slot, trial_bytes(trial, slot, "participant", seed=self.done, breach=breach))
            if answer.status != 200:
                raise RuntimeError(f"a trial is not taken: {answer}")

    def choose(self, client, name, *kinds):
        client.must("POST", "/session/notifications", {"address": f"{name}@hospital.example", "choices": [
            {"kind": kind, "delivery": "immediate"} for kind in kinds]})

    def webhook(self, path, *kinds):
        made = self.world.admin.must("POST", "/webhooks", {"url": f"http://127.0.0.1:{self.hooks.port}{path}", "kinds": list(kinds)})
        return made["webhook"]["id"], made["secret"]

    def failed_self_test(self, at_utc_us):
        self.station.must("POST", "/station/report", {"self_test": {"at_utc_us": at_utc_us, "passed": False, "checks": []}})

    def outbox(self):
        return self.world.admin.must("GET", "/webhooks")

    def subjects(self, to):
        return [one["message"]["Subject"] for one in self.mail.messages if one["to"] == [f"{to}@hospital.example"]]

    def stop(self):
        self.world.__exit__(None, None, None)
        self.mail.stop()
        self.hooks.stop()


def released(at):
    first = at.assign("Week 1: Gefühl für die Wand", release="held")
    at.faculty.must("POST", f"/assignments/{first}/release", {"release": "released"})
    check(not within(LOOKS_EVERY_S + 3, lambda: at.mail.attempts or at.hooks.calls), "nobody who did not choose is told of anything")
    at.choose(at.trainee, "tom", "released")
    second = at.assign("Week 2: Gefühl für die Wand", release="held")
    at.faculty.must("POST", f"/assignments/{second}/release", {"release": "released"})
    about = lambda: [one for one in at.mail.messages if "Week 2" in one["message"].get_content()]  # noqa: E731
    check(within(AT_ONCE_S + LOOKS_EVERY_S, about), "a trainee is told of released results by e-mail")
    got = about()[0]
    message, text = got["message"], got["message"].get_content()
    check(got["to"] == ["tom@hospital.example"] and got["from"] == "tractus@hospital.example", "from and to the stated addresses")
    check(message["Subject"] == "Tractus: results are released", f"the subject is fixed: {message['Subject']}")
    check("Week 2: Gefühl für die Wand" in text and f"https://tractus.hospital.example/assignments/{second}" in text,
          f"title and page stand in the text, umlauts whole: {text!r}")
    check("tom" not in text.replace("tom@hospital.example", ""), "no name of a person stands in it")
    check(at.mail.logins and all(right and encrypted for right, encrypted in at.mail.logins), "signed in, over TLS alone")
    refused = at.trainee.ask("POST", "/session/notifications", {"address": "tom@elsewhere.example", "choices": []})
    check(refused.status == 400 and b"hospital.example" in refused.body, "an address of another domain is refused, with the domains that are allowed")


def called(at):
    identity, secret = at.webhook("/good", "self_test_failed")
    at.webhook("/slow", "self_test_failed")
    at.webhook("/broken", "self_test_failed")
    at.hooks.delay_s["/slow"], at.hooks.status["/broken"] = 5.0, 500
    at.failed_self_test(5)
    check(within(AT_ONCE_S + LOOKS_EVERY_S, lambda: all(at.hooks.of(path) for path in ("/good", "/slow", "/broken"))), "each receiver is called")
    check(is_signed(at.hooks.of("/good")[0], secret), "with a signature as Standard Webhooks states it")
    check(not is_signed(at.hooks.of("/good")[0] | {"body": b"{}"}, secret), "that holds for no other content")
    body = json.loads(at.hooks.of("/good")[0]["body"])
    check(body["type"] == "self_test_failed" and "station-1" not in json.dumps(body), f"and the kind of event, without a name: {body}")
    at.world.admin.must("POST", f"/webhooks/{identity}/test")
    before = time.monotonic()
    check(within(AT_ONCE_S, lambda: len(at.hooks.of("/good")) == 2), f"a test arrives beside a slow and a broken receiver ({time.monotonic() - before:.1f} s)")
    check(within(AT_ONCE_S, lambda: any(one["state"] == "waiting" and "500" in one["error"] for one in at.outbox()["deliveries"])),
          "what a receiver refused waits, and the page says why")


def refused(at):
    at.mail.answer = "550 no such person"
    at.trainee.must("POST", "/session/notifications/test")
    check(within(AT_ONCE_S, lambda: any(one["state"] == "given up" for one in at.outbox()["deliveries"])), "a message refused for good is given up")
    acts = at.world.admin.must("GET", "/audit")
    check("giveUpDelivery" in json.dumps(acts), "aloud: it stands in the audit trail")
    at.mail.answer = "250 taken"


def killed(at):
    """A message is at the mail server when this server dies: it is sent again, recognisable by its Message-ID."""
    at.choose(at.faculty, "fay", "relapse")
    at.mail.delay_s, before = 5.0, len(at.mail.attempts)
    at.faculty.must("POST", "/session/notifications/test")
    check(within(AT_ONCE_S, lambda: len(at.mail.attempts) > before), "the mail server thinks about a message")
    started = time.monotonic()
    answered = at.faculty.ask("GET", "/session").status
    check(answered == 200 and time.monotonic() - started < 2.0, "pages are answered meanwhile")
    at.world.server.stop(signal.SIGKILL)
    at.mail.delay_s = 0.0
    at.world.server.start()
    for person in (at.faculty, at.trainee, at.world.admin):
        at.world.renew(person)
    return at.mail.attempts[-1][1]


def hung(setup):
    """A mail server that takes the connection and never speaks: everything else goes on."""
    with socket.socket() as deaf:
        deaf.bind(("127.0.0.1", 0))
        deaf.listen(8)
        at = Hospital(setup)
        settings = json.loads((at.folder / "mail.json").read_text())
        (at.folder / "mail.json").write_text(json.dumps(settings | {"server": f"smtp://127.0.0.1:{deaf.getsockname()[1]}"}))
        at.world.server.stop()
        at.world.server.start()
        for person in (at.trainee, at.world.admin):
            at.world.renew(person)
        at.choose(at.trainee, "tom", "released")
        at.trainee.must("POST", "/session/notifications/test")
        identity, _ = at.webhook("/good", "backup_failed")
        at.world.admin.must("POST", f"/webhooks/{identity}/test")
        check(within(AT_ONCE_S, lambda: at.hooks.of("/good")), "a webhook is called while the mail server hangs")
        times = []
        for _ in range(20):
            started = time.monotonic()
            check(at.trainee.ask("GET", "/session").status == 200, "a page is answered while the mail server hangs") if not times else at.trainee.ask("GET", "/session")
            times.append(time.monotonic() - started)
        check(max(times) < 1.0, f"nothing else is slowed: at most {1e3 * max(times):.0f} ms")
        check(within(30, lambda: any(one["channel"] == "mail" and one["error"] for one in at.outbox()["deliveries"])), "the hung attempt ends, and the page says why")
        at.stop()


def run(setup):
    at = Hospital(setup)
    released(at)
    called(at)
    refused(at)
    at.choose(at.faculty, "fay", "relapse")
    at.assign("training", repeats=20, release="at_once")
    at.assign("more training", repeats=20, release="at_once")
    at.train(RIGHT, breach=False)
    at.train(WRONG, breach=True)
    at.world.wait_for_scores()
    identity = killed(at)
    at.hooks.status["/broken"] = 204
    check(within(RETRY_S, lambda: "Tractus: a relapse is signalled" in at.subjects("fay")), f"a relapse reaches the trainee's faculty: {at.subjects('fay')}")
    check(within(RETRY_S, lambda: identity in [one["message"]["Message-ID"] for one in at.mail.messages]),
          "what was under way when the server was killed arrives, with the same Message-ID")
    check(within(RETRY_S, lambda: len(at.hooks.of("/broken")) > 1), "a receiver that answered 500 is called again")
    tried = {one["headers"].get("webhook-id") or one["headers"].get("Webhook-Id") for one in at.hooks.of("/broken")}
    check(len(tried) == 1, f"with the same webhook-id: {tried}")
    check(at.subjects("fay").count("Tractus: a relapse is signalled") == 1, "a relapse is told once")
    at.stop()
    hung(setup)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-told-"))
    setup = Setup(options.bin.resolve(), folder, "sqlite", "nothing")
    try:
        run(setup)
    finally:
        setup.stop()
        shutil.rmtree(folder, ignore_errors=True)
    print("who is told of what: as it should be")


if __name__ == "__main__":
    main()
