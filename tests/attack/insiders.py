"""What people with an account can wear out, and what the wall and a backup tell: found beside the numbered items."""
import hashlib
import json
import threading
import time

from report import attack, expect
from sign_in import MOST_HEALTH_S, beside
from wire import Client, websocket, websocket_frame
from world import VICTIM, World, run_sqlite


@attack("5: faculty sets a hundred badges with PINs at once, each of which is hashed")
def parallel_badges(world):
    account, statuses = world.ours.ids()["account"], []

    def one(n):
        client = Client(world.target, world.ours.faculty.credentials, f"127.0.13.{n + 1}")
        statuses.append(client.ask("POST", f"/accounts/{account}/badge", {"badge": world.ours.badge, "pin": f"{1000 + n}"}).status)

    longest_s = beside(world, [threading.Thread(target=one, args=(n,)) for n in range(100)])
    print(f"      health took {longest_s:.2f} s at most; answers {sorted(set(statuses))}", flush=True)
    expect(longest_s < MOST_HEALTH_S, f"the health route took {longest_s:.2f} s meanwhile")


@attack("a trainee fills the audit trail with refused requests, until nobody finds anything in it")
def refusals_without_end(world):
    def newest():
        return world.admin.must("GET", "/audit?limit=1")["rows"][0]["number"]
    before = newest()
    for number in range(400):
        world.ours.trainee.ask("GET" if number % 2 else "POST", f"/accounts/{number}/role" if number % 4 == 0 else "/accounts")
    expect(newest() - before < 100, f"400 refused requests made {newest() - before} rows")


FORMULAS = ["probing_force_mean ~ " + "*".join(["number", "experience_years", "correct", "simulated"] * 6),
            "probing_force_mean ~ " + "(" * 900 + "number" + ")" * 900, "probing_force_mean ~ " + "+".join(["number"] * 400),
            "probing_force_mean ~ " + "*".join(f"C(participant)" for _ in range(30)), "~", "probing_force_mean ~ number ^ 99999999"]


@attack("a researcher asks for an analysis whose formula grows without end")
def endless_formulas(world):
    world.ours.trainee.must("POST", "/session/consent", {"tier": "metrics"})
    researcher = world.people["researcher"]
    for formula in FORMULAS:
        for method in ("ols", "lmm", "anova"):
            answer = researcher.ask("POST", "/cohort/analyses", {"method": method, "formula": formula})
            expect(answer.status in (201, 400), f"{method} {formula[:60]}: {answer}")
    end = time.monotonic() + 60
    while "queued" in (states := states_of(world)) or "running" in states:
        expect(world.server.alive(), "the server died of a formula")
        expect(time.monotonic() < end, "an analysis is at work after 60 s")
        time.sleep(0.3)


def states_of(world):
    """How the analyses stand that run without a plan: by the figures that the server gives to those who keep it running."""
    text = Client(world.direct, world.admin.credentials).ask("GET", "/server/metrics").body.decode()
    waiting = next((line for line in text.splitlines() if line.startswith("tractus_jobs_waiting ")), "x 0")
    return "running" if float(waiting.split()[1]) > 0 else "done"


@attack("faculty learns from the wall who stands at another cohort's station, and on which case")
def wall(world):
    theirs = world.theirs
    slot = theirs.next_slot()["slot"]
    line = websocket(world.target, "/api/v1/live/station", theirs.station.credentials)
    expect(line, "their station's own line is refused")
    trial = {"trial_id": "d" * 32, "rig": "probing", "case_id": slot, "t_s": 1.0, "samples": 10, "late_ticks": 0}
    told = {"kind": "state", "state": "trial", "version": "1", "device": "sim-rig", "simulated": True, "trial": trial}
    line.sendall(websocket_frame(json.dumps(told).encode()))
    time.sleep(0.5)
    path = f"/stations/{theirs.ids()['station']}"
    own, other = theirs.faculty.must("GET", path), world.ours.faculty.must("GET", path)
    line.close()
    expect(own["trial"] and own["trial"]["person"], f"their own faculty is not told who it is: {own['trial']}")
    expect(not other["trial"]["person"], f"a stranger is told: {other['trial']}")
    shown = json.dumps(other)
    expect("hard" not in shown.lower() and slot not in shown, f"a stranger is told the case: {other['trial']}")


@attack("8: a backup is edited, its list of checksums too, and restored")
def forged_backup(world):
    with World(world.setup, front="plain") as side:
        side.account(f"{VICTIM} trainee", "trainee")
        side.setup.must_run("backup", "--data", side.data, "--out", side.folder / "backup")
        backup = side.folder / "backup"
        run_sqlite(backup / "tractus.db", f"update accounts set role = 'admin' where name = '{VICTIM} trainee'")
        manifest = json.loads((backup / "backup.json").read_text())
        manifest["database_sha256"] = hashlib.sha256((backup / "tractus.db").read_bytes()).hexdigest()
        (backup / "backup.json").write_text(json.dumps(manifest))
        ended = side.setup.run("restore", "--from", backup, "--data", side.folder / "restored")
    expect(ended.returncode != 0, f"restored, and nothing is said: {(ended.stdout + ended.stderr).strip()[:200]}")


@attack("8: a backup's list of files names one outside of it, or a link")
def escaping_backup(world):
    with World(world.setup, front="plain") as side:
        side.setup.must_run("backup", "--data", side.data, "--out", side.folder / "backup")
        backup = side.folder / "backup"
        manifest = json.loads((backup / "backup.json").read_text())
        secret = hashlib.sha256((side.data / "secret.key").read_bytes()).hexdigest()
        for name in ("../data/secret.key", str(side.data / "secret.key")):
            (backup / "backup.json").write_text(json.dumps(manifest | {"files": manifest["files"] | {name: secret}}))
            ended = side.setup.run("restore", "--from", backup, "--data", side.folder / "restored")
            expect(ended.returncode != 0 and not (side.folder / "restored").exists(), f"{name} is taken")
