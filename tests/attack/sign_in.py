"""Items 5, 6 and parts of 10: locking others out, exhausting the server by signing in, staying in, and taking accounts over."""
import json
import secrets
import socket
import threading
import time

from identity_provider import Provider
from report import NotTried, attack, expect
from world import PIN, VICTIM, World
from wire import Client

MOST_HEALTH_S = 1.0  # that the health route may take, whatever others do
PATIENCE_S = 60.0    # that a person with the right password may be slowed


def sign_in(world, name, password, source):
    return Client(world.target, source=source).ask("POST", "/session", {"name": name, "password": password})


def slowed(ask, patience_s=PATIENCE_S):
    """Asks until the answer is no "wait", as long as a patient person would: slowed is no attack, shut out is one."""
    end = time.monotonic() + patience_s
    while (answer := ask()).status in (429, 503):
        wait_s = float(answer.header("retry-after") or 1)
        if time.monotonic() + wait_s > end:
            return answer
        time.sleep(max(wait_s, 0.2))
    return answer


def wrong_passwords(world, name, addresses, each):
    def from_one(last):
        for _ in range(each):
            sign_in(world, name, "not the password", f"127.0.5.{last + 1}")
    together([threading.Thread(target=from_one, args=(last,)) for last in range(addresses)])


def together(threads):
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)


@attack("5: a name that looks like a badge is tried at the pages until the badge is locked")
def badge_by_name(world):
    for name in (f"badge {world.theirs.badge}", f"badge:{world.theirs.badge}", world.theirs.badge):
        wrong_passwords(world, name, 2, 6)
    answer = slowed(lambda: world.theirs.station.ask("POST", "/work/sign-in", {"badge": world.theirs.badge, "pin": PIN}))
    expect(answer.status == 200, f"the badge's owner at the station: {answer}")


@attack("5: the name \"station enrolment\" is tried at the pages until no station can be enrolled")
def enrolment_by_name(world):
    wrong_passwords(world, "station enrolment", 3, 11)
    code = world.admin.must("POST", "/stations/codes", {"name": "after the attack"})["code"]
    for source in ("127.0.5.1", "127.0.0.1"):
        client = Client(world.target, source=source)
        answer = slowed(lambda: client.ask("POST", "/stations/enrol", {"code": code, "token_sha256": secrets.token_hex(32)}))
        expect(answer.status in (201, 401), f"enrolment from {source}: {answer}")


@attack("5: a hundred wrong passwords from ten addresses lock somebody else's account")
def account_by_strangers(world):
    name = f"{VICTIM} faculty"
    wrong_passwords(world, name, 10, 11)
    answer = slowed(lambda: sign_in(world, name, world.passwords[name], "127.0.0.77"))
    expect(answer.status == 200, f"the owner with the right password, from an address of her own: {answer}")


@attack("5: one address tries one password for many names, without end")
def many_names_from_one_address(world):
    answers = [sign_in(world, f"nobody {n}", "Summer26!", "127.0.6.1") for n in range(60)]
    expect(any(answer.status == 429 for answer in answers), "60 names failed from one address, and it is not slowed")
    other = slowed(lambda: sign_in(world, "director", world.passwords["director"], "127.0.6.2"))
    expect(other.status == 200, f"the next address along pays for it: {other}")


@attack("5: one station tries one PIN for many badges, without end")
def many_badges_from_one_station(world):
    thief = world.station("stolen station")
    thief.line.source = "127.0.6.9"
    answers = [thief.ask("POST", "/work/sign-in", {"badge": str(5000 + n), "pin": "1234"}) for n in range(60)]
    expect(any(answer.status == 429 for answer in answers), "60 badges failed at one station, and it is not slowed")
    honest = slowed(lambda: world.theirs.station.ask("POST", "/work/sign-in", {"badge": world.theirs.badge, "pin": PIN}))
    expect(honest.status == 200, f"another station pays for it: {honest}")


def timed_health(world, until, took_s):
    client = Client(world.direct, source="127.0.0.88")
    while not until.is_set():
        began = time.monotonic()
        if client.ask("GET", "/health").status == 200:
            took_s.append(time.monotonic() - began)
        else:
            took_s.append(60.0)
        time.sleep(0.02)


def beside(world, threads):
    """The longest time that the health route took while the threads ran, in seconds."""
    until, took_s = threading.Event(), []
    watcher = threading.Thread(target=timed_health, args=(world, until, took_s))
    watcher.start()
    together(threads)
    until.set()
    watcher.join(60)
    return max(took_s, default=60.0)


@attack("5: two hundred sign-ins at once hold up everybody else")
def parallel_sign_ins(world):
    statuses = []

    def one(n):
        statuses.append(sign_in(world, f"crowd {n % 40}", "not the password", f"127.0.7.{n + 1}").status)

    longest_s = beside(world, [threading.Thread(target=one, args=(n,)) for n in range(200)])
    print(f"      health took {longest_s:.2f} s at most; answers {sorted(set(statuses))}", flush=True)
    expect(set(statuses) <= {401, 429, 503}, f"answers: {sorted(set(statuses))}")
    expect(longest_s < MOST_HEALTH_S, f"the health route took {longest_s:.2f} s meanwhile")


class HangingProvider:
    """Takes connections and never answers."""

    def __init__(self):
        self.socket = socket.create_server(("127.0.0.1", 0), backlog=64)
        self.issuer = f"http://127.0.0.1:{self.socket.getsockname()[1]}"


def write_settings(folder, issuer):
    (folder / "client.secret").write_text("secret of a test\n")
    path = folder / "oidc.json"
    path.write_text(json.dumps({"format": "tractus-oidc/1", "issuer": issuer, "client_id": "tractus",
                                "client_secret_file": "client.secret"}))
    return ["--oidc", path]


@attack("6: the provider of identities hangs, and people try to sign in by it")
def hanging_provider(world):
    folder = world.setup.folder / "hanging"
    folder.mkdir()
    provider = HangingProvider()
    with World(world.setup, options=write_settings(folder, provider.issuer)) as side:
        statuses = []

        def one(n):
            statuses.append(Client(side.target, source=f"127.0.8.{n + 1}").ask("GET", "/session/oidc/start").status)

        threads = [threading.Thread(target=one, args=(n,)) for n in range(12)]
        longest_s = beside(side, threads)
        began = time.monotonic()
        again = side.nobody().ask("GET", "/session/oidc/start")
        again_s = time.monotonic() - began
        began = time.monotonic()
        password = sign_in(side, "admin", side.admin_password, "127.0.0.1")
        password_s = time.monotonic() - began
    provider.socket.close()
    print(f"      health took {longest_s:.2f} s at most; the next sign-in {again_s:.2f} s: {again.status}", flush=True)
    expect(longest_s < MOST_HEALTH_S, f"health took {longest_s:.2f} s while twelve people waited for the provider")
    expect(password.status == 200 and password_s < 3, f"signing in by password took {password_s:.1f} s: {password}")
    expect(again_s < 1, f"after the provider failed, the next one who asks waits {again_s:.1f} s for it again")


def browser(world, provider):
    """Signs in by the provider, as a browser does; the session's cookie."""
    client = world.nobody()
    begun = client.ask("GET", "/session/oidc/start")
    if begun.status != 302:
        raise NotTried(f"the provider of the suite is not taken: {begun}")
    attempt = begun.header("set-cookie").split(";")[0]
    back = provider.vouch(begun.header("location"))
    client.credentials = {"Cookie": attempt}
    landed = client.ask("GET", "/api/v1/session/oidc/callback?" + back)
    cookies = [line.split(";")[0] for line in landed.header("set-cookie").split("\n")]
    client.credentials = {"Cookie": next((one for one in cookies if one.startswith("tractus_session=")), "none=1")}
    return client


@attack("10: a session goes on after the account's link to the provider was taken away")
def session_after_unlinking(world):
    folder = world.setup.folder / "provider"
    folder.mkdir()
    provider = Provider(folder)
    with World(world.setup, front="plain", options=write_settings(folder, provider.issuer)) as side:
        account = side.admin.must("POST", "/accounts", {"name": "linked", "role": "technician"})["account"]["id"]
        side.admin.must("POST", f"/accounts/{account}/subject", {"subject": provider.subject})
        client = browser(side, provider)
        if client.ask("GET", "/session").status != 200:
            raise NotTried("signing in by the suite's provider does not work")
        side.admin.must("POST", f"/accounts/{account}/subject", {"subject": ""})
        after = client.ask("GET", "/session")
    provider.stop()
    expect(after.status == 401, f"after the link was taken away: {after}")


@attack("10: a ticket goes on after badge and PIN were taken away, changed, or the account got another role")
def ticket_after_badge(world):
    for what, path, body in (("badge taken away", "badge", {}), ("PIN changed", "badge", {"badge": "104", "pin": "9999"}),
                             ("role changed", "role", {"role": "technician"}), ("account off", "state", {"state": "disabled"})):
        name = f"leaver {secrets.token_hex(3)}"
        account = world.admin.must("POST", "/accounts", {"name": name, "role": "trainee", "badge": "104", "pin": PIN})["account"]["id"]
        ticket = world.ours.station.must("POST", "/work/sign-in", {"badge": "104", "pin": PIN})["ticket"]
        world.admin.must("POST", f"/accounts/{account}/{path}", body)
        answer = world.ours.station.ask("POST", "/work/next", {"ticket": ticket})
        world.admin.ask("POST", f"/accounts/{account}/badge", {})
        expect(answer.status in (401, 403), f"{what}: the ticket still works: {answer}")


@attack("10: a badge's ticket stands in clear in the audit trail")
def ticket_in_audit(world):
    ours = world.ours
    ours.ticket = ours.sign_in_at_station()
    ours.next_slot()
    ours.station.must("POST", "/work/sign-out", {"ticket": ours.sign_in_at_station()})
    rows = world.admin.must("GET", "/audit?limit=200")["rows"]
    for secret, what in ((ours.ticket, "ticket"), (PIN, "PIN"), (world.admin_password, "password")):
        held = [row["what"] for row in rows if secret in json.dumps(row["detail"])]
        expect(not held, f"the {what} stands in the rows {sorted(set(held))}")


@attack("10: whoever holds an administrator's session sets that administrator's password without the old one")
def own_password_reset(world):
    thief = world.account("second admin", "admin")
    answer = thief.ask("POST", f"/accounts/{thief.identity['id']}/password")
    expect(answer.status >= 400, f"the own password is reset: {answer}")
    expect(sign_in(world, "second admin", world.passwords["second admin"], "127.0.0.9").status == 200, "the old password no longer works")
    world.admin.must("POST", f"/accounts/{thief.identity['id']}/state", {"state": "disabled"})


@attack("a session goes on after sign-out, another password, another role, or switching the account off")
def sessions_end(world):
    for what, body in (("sign-out", None), ("role", {"role": "technician"}), ("password", None), ("state", {"state": "disabled"})):
        name = f"ends by {what} {secrets.token_hex(3)}"
        person = world.account(name, "director")
        other = world.signed_in(name, world.passwords[name])
        if what == "sign-out":
            person.must("DELETE", "/session")
        else:
            world.admin.must("POST", f"/accounts/{person.identity['id']}/{what}", body)
        for client in (person,) if what == "sign-out" else (person, other):
            expect(client.ask("GET", "/session").status == 401, f"the session is alive after {what}")


@attack("an account is found out by the time that a wrong password takes")
def names_by_time(world):
    def took_s(name):
        began = time.monotonic()
        sign_in(world, name, "x" * 12, "127.0.9.1")
        return time.monotonic() - began
    pairs = [(took_s(f"{VICTIM} trainee"), took_s(f"absent {n}")) for n in range(4)]
    known, unknown = (min(pair[side] for pair in pairs) for side in (0, 1))
    expect(0.4 < known / unknown < 2.5, f"a known name {known * 1e3:.0f} ms, an unknown one {unknown * 1e3:.0f} ms")
