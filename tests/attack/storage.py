"""Items 7, 8, 9 and the disk's part of 10: memory, records edited by hand, who may read the files."""
import itertools
import math
import os
import secrets
import signal
import threading
import time

from forgeries import FORGERIES
from report import NotTried, attack, expect
from sign_in import together
from transport import raw_head
from trial_file import announced
from wire import Client
from world import World

BODY_BYTES, BODIES = 192 << 20, 4
MOST_BODIES_BYTES = 160 << 20  # that four bodies may add together to resident memory
MOST_ANNOUNCED_BYTES = 512 << 20


def send_body(world, size):
    """A measurement set of zeros, as fast as it is taken; whether it ended well is of no matter here."""
    client, piece = Client(world.target, world.people["researcher"].credentials), bytes(1 << 20)
    made = world.target.connect()
    made.sendall(raw_head(client, "POST", "/lab/measurements?name=large", {"Content-Length": size}, "application/octet-stream"))
    try:
        made.sendall(b"PK\x03\x04")
        for _ in range(size // len(piece) - 1):
            made.sendall(piece)
    except OSError:
        pass  # refused: also an answer
    time.sleep(1)
    made.close()


@attack("7: four measurement sets of 192 MiB are sent at once and kept in memory")
def bodies_in_memory(world):
    world.server.reset_peak()
    before = world.server.resident_bytes()
    together([threading.Thread(target=send_body, args=(world, BODY_BYTES)) for _ in range(BODIES)])
    grown = world.server.peak_bytes() - before
    print(f"      memory rose by {grown >> 20} MiB", flush=True)
    expect(grown < MOST_BODIES_BYTES, f"memory rose by {grown >> 20} MiB")


def begin_body(world, size):
    made = world.target.connect(patience_s=5)
    client = Client(world.target, world.people["researcher"].credentials)
    made.sendall(raw_head(client, "POST", "/lab/measurements?name=slow", {"Content-Length": size}, "application/octet-stream"))
    try:
        made.sendall(b"PK\x03\x04" + bytes(60_000))
    except OSError:
        pass
    return made


@attack("7: one session begins forty bodies of 256 MiB, sends none of them to the end, and holds up everybody")
def many_slow_bodies(world):
    held = [begin_body(world, 256 << 20) for _ in range(40)]
    time.sleep(0.5)
    began = time.monotonic()
    answer = world.people["director"].ask("GET", "/trials")
    took_s = time.monotonic() - began
    for made in held:
        made.close()
    expect(answer.status == 200 and took_s < 2, f"another person's request took {took_s:.1f} s: {answer.status}")


def prepared(side):
    """Something of everything that is forged."""
    side.furnish()
    gone = side.account("gone", "trainee").identity["id"]
    side.admin.must("POST", f"/accounts/{gone}/state", {"state": "disabled"})
    revoked = side.station("revoked").identity["id"]
    side.admin.must("POST", f"/stations/{revoked}/revoke")
    side.ours.trainee.must("POST", "/session/consent", {"tier": "metrics"})
    side.theirs.trainee.must("POST", "/session/consent", {"tier": "none"})
    plan = {"format": "tractus-plan/1", "title": "a plan", "question": "does it hold?", "subject": "participant",
            "analyses": [{"id": "one", "question": "a question", "method": "ols", "formula": "probing_force_mean ~ number"}]}
    side.people["researcher"].must("POST", "/cohort/plans", {"plan": plan})


def verified(side, folder):
    """What verify says of a folder: (exit status, its words)."""
    ended = side.setup.run("verify", "--data", folder)
    return ended.returncode, (ended.stdout + ended.stderr).strip()


def cut_off(folder, run_sql, rows):
    """The last rows of the audit trail and the anchors that know of them, as if they had never been."""
    last = int(run_sql("select max(number) from audit")[0][0]) - rows
    run_sql(f"delete from audit where number > {last}")
    for file in folder.glob("audit.*"):
        kept = [line for line in file.read_text().splitlines(True) if int(line.split()[0]) <= last]
        file.write_text("".join(kept)) if kept else file.unlink()


@attack("8: somebody with the disk edits scores, answers, roles, consents and places, and verify says that nothing is wrong")
def forged_records(world):
    with World(world.setup, front="plain") as side:
        prepared(side)
        side.server.stop()
        code, words = verified(side, side.data)
        expect(code == 0, f"verify before any forgery: {words[:300]}")
        unseen, untouched = [], []
        for number, (what, sql) in enumerate(FORGERIES):
            folder, run_sql = side.copy(number)
            before = digest(run_sql, sql)
            run_sql(sql)
            if digest(run_sql, sql) == before:
                untouched.append(what)
            elif verified(side, folder)[0] == 0:
                unseen.append(what)
        side.server.start()
    expect(not untouched, "the suite's forgery changed nothing: " + "; ".join(untouched))
    expect(not unseen, f"{len(unseen)} of {len(FORGERIES)}: " + "; ".join(unseen))


def digest(run_sql, sql):
    words = sql.split()
    table = words[2] if words[0] in ("insert", "delete") else words[1]
    return sorted(map(str, run_sql(f"select * from {table}")))


def quiet_change(side):
    """A trainee becomes an administrator: what the attacker wants nobody to know."""
    account = side.admin.must("POST", "/accounts", {"name": "quiet", "role": "trainee"})["account"]["id"]
    side.admin.must("POST", f"/accounts/{account}/role", {"role": "admin"})
    side.server.stop()


@attack("8: the newest audit rows and the anchors that know of them are cut off together")
def cut_trail(world):
    seen = {}
    with World(world.setup, front="plain") as side:
        quiet_change(side)
        for rows in (1, 2):
            folder, run_sql = side.copy(rows)
            cut_off(folder, run_sql, rows)
            seen[rows] = verified(side, folder)
        side.server.start()
    for rows, (code, words) in seen.items():
        expect(code != 0, f"{rows} rows are cut off, and verify says: {words[:200]}")


@attack("8: all anchors are taken away")
def no_anchors(world):
    with World(world.setup, front="plain") as side:
        quiet_change(side)
        folder, _ = side.copy(1)
        for file in folder.glob("audit.*"):
            file.unlink()
        code, words = verified(side, folder)
        side.server.start()
    expect(code != 0 or "anchor" in words, f"verify says: {words[:200]}")


@attack("8: an anchor is written by hand for a trail that was cut off")
def forged_anchor(world):
    with World(world.setup, front="plain") as side:
        quiet_change(side)
        folder, run_sql = side.copy(1)
        run_sql("delete from audit where number = (select max(number) from audit)")
        number, chain = run_sql("select number, hash from audit order by number desc limit 1")[0]
        for file in folder.glob("audit.*"):
            last = file.read_text().splitlines()[-1].split()
            file.write_text(" ".join([number, chain, *last[2:]]) + "\n")
        code, words = verified(side, folder)
        side.server.start()
    expect(code != 0, f"the anchor is believed: {words[:200]}")


PUBLIC = {"authority.pem", "server.pem"}  # certificates are shown to everybody who connects


def open_modes(folder):
    """Files and folders that the group or others may read, write or enter."""
    out = []
    for path in [folder, *sorted(folder.rglob("*"))]:
        try:
            mode = path.lstat().st_mode & 0o777
        except FileNotFoundError:  # the server ended a body's file meanwhile
            continue
        if mode & 0o077 and not path.is_symlink() and path.name not in PUBLIC:
            out.append(f"{path.relative_to(folder.parent)} {mode:04o}")
    return out


def umask_of_a_shell(function):
    before = os.umask(0o022)
    try:
        return function()
    finally:
        os.umask(before)


@attack("9: the data folder was there before init, open to everybody on the machine")
def folder_from_before(world):
    def made():
        with World(world.setup, front="plain", prepare=lambda path: path.mkdir(mode=0o755)) as side:
            side.furnish()
            side.admin.ask("POST", "/backups")
            time.sleep(1.5)
            open_files = open_modes(side.data)
        return open_files
    open_files = umask_of_a_shell(made)
    expect(not open_files, f"{len(open_files)}: " + ", ".join(open_files[:8]))


@attack("9: temporary folders are open to everybody, or stay behind when the server is killed")
def temporary_folders(world):
    def made():
        with World(world.setup, front="plain") as side:
            side.people["researcher"] = side.account("researcher", "researcher")
            threads = [threading.Thread(target=send_body, args=(side, 128 << 20)) for _ in range(2)]
            for thread in threads:
                thread.start()
            seen, end = set(), time.monotonic() + 4
            while time.monotonic() < end and any(thread.is_alive() for thread in threads):
                seen |= set(open_modes(side.setup.temporary)[1:]) | set(open_modes(side.data))
            side.server.stop(signal.SIGKILL)
            for thread in threads:
                thread.join(30)
            leave_behind(side)
            side.server.start()
            time.sleep(0.5)
            left = [str(path.name) for path in side.setup.temporary.iterdir() if path.name.startswith("tractus")]
            left += [str(path.relative_to(side.data)) for path in side.data.rglob("*.spool")]
        return sorted(seen), left
    seen, left = umask_of_a_shell(made)
    expect(not seen, f"open while it serves: {', '.join(seen[:6])}")
    expect(not left, f"left behind after the next start: {', '.join(left[:6])}")


def leave_behind(side):
    """Kills the server in the midst of reading a measurement set, where temporary folders are in use."""
    side.server.start()
    from nesting import zipped
    body = zipped({"set.json": b'{"format":"tractus-measurements/1","trials":[]}', "a.csv": b"t_s,x_m,fz_N\n" + b"0,0,0\n" * 2_000_000})
    client = Client(side.target, side.people["researcher"].credentials, patience_s=5)
    sender = threading.Thread(target=client.ask, args=("POST", "/lab/measurements?name=x", body, "application/octet-stream"))
    sender.start()
    end = time.monotonic() + 3
    while time.monotonic() < end and not any(path.name.startswith("tractus") for path in side.setup.temporary.iterdir()):
        time.sleep(0.002)
    side.server.stop(signal.SIGKILL)
    sender.join(30)


@attack("10: a station announces more trials than the disk has room for, all together")
def announced_more_than_the_disk(world):
    def free_bytes():
        disk = os.statvfs(world.data)
        return disk.f_bavail * disk.f_frsize
    most = free_bytes()
    if most > 2000 * MOST_ANNOUNCED_BYTES:
        raise NotTried(f"{most >> 30} GiB are free: {math.ceil(most / MOST_ANNOUNCED_BYTES)} announcements would be needed")
    with World(world.setup) as side:
        station = side.station("greedy 0")
        slot = side.published_case()
        for n in itertools.count():
            if n % 200 == 199:
                station = side.station(f"greedy {n}")
            told = {"case_id": slot, "size_bytes": MOST_ANNOUNCED_BYTES, "sha256": secrets.token_hex(32)}
            most = max(most, free_bytes())  # other programs free room meanwhile
            answer = station.ask("PUT", f"/uploads/{secrets.token_hex(16)}", told)
            most = max(most, free_bytes())
            expect(answer.status in (200, 429, 503), f"announcement {n}: {answer}")
            if answer.status != 200:
                break
            expect((n + 1) * MOST_ANNOUNCED_BYTES < most, f"{n + 1} × 512 MiB were taken, at most {most >> 20} MiB were free")


@attack("a station sends pieces of an upload at wrong places, too long, and of another station")
def odd_pieces(world):
    trial_id, slot = secrets.token_hex(16), world.ours.next_slot()["slot"]
    answer = announced(world.ours.station, trial_id, slot, bytes(4000))
    expect(answer.status == 200, f"an announced piece: {answer}")
    for offset, body in ((5000, b"x"), (0, b"x" * 10), (4000, b"x" * 10), (4000, b"")):
        answer = world.ours.station.ask("PATCH", f"/uploads/{trial_id}?offset_bytes={offset}", body, headers={"X-Crc32c": "00000000"})
        expect(400 <= answer.status < 500, f"{len(body)} bytes at {offset}: {answer}")
    for method, tail in (("GET", ""), ("POST", "/commit"), ("PATCH", "?offset_bytes=4000")):
        answer = world.theirs.station.ask(method, f"/uploads/{trial_id}{tail}", headers={"X-Crc32c": "00000000"})
        expect(answer.status in (400, 404), f"{method} by another station: {answer}")
