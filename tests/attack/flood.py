"""Ten thousand mutated requests, from a seed: heads, bodies, paths and queries, archives, trial files. Each block ends with the
server up, its memory as before, and `verify` clean (world.end_attack)."""
import io
import json
import multiprocessing
import random
import socket
import struct
import time
import warnings
import zipfile
import zlib

from catalogue import body_of, plain_value, routes_of
from nesting import zipped
from report import attack, expect
from trial_file import hand_over, sealed, trial_bytes
from wire import Client, read_answer, request_bytes

SEED = 20261122
PROCESSES = 3
TRIALS_A_STATION = 150  # so many uploads may one station leave unfinished, and some more
SOURCE = "127.0.11.{}"  # the floods come from addresses of their own, so that what slows them slows nobody else
# Their failures slow an account or end a session that the suite needs; `sign_in` attacks them.
LEFT_OUT = {"changePassword", "confirmCodes", "endCodes", "beginCodes", "signOut", "makeBackup", "verifyBackup", "resetPassword",
            "setAccountState", "setAccountRole", "revokeStation", "signInAtStation", "enrolStation"}
HEAD_PATHS = ["/api/v1/session", "/api/v1/trials?limit=5", "/", "/index.html", "/api/v1/cases", "*", "http://x/api/v1/health"]
ODD_FIELDS = [{}, {"Range": "bytes=0-5,9-"}, {"Expect": "100-continue"}, {"Connection": "upgrade"}, {"Cookie": "a=b;" * 50},
              {"Accept-Encoding": "x" * 2000}, {"If-None-Match": "\"x"}, {"Upgrade": "websocket"}]
ODD_TEXTS = ["", " ", "\0", "\n", "'", "\"", "';drop table accounts;--", "../../../etc/passwd", "%00", "\u202e", "\ud7ff", "🦴" * 50, "a" * 5000,
             "NaN", "null", "=1+1", "<script>", "-1", "1e308", "{}", "[]", "\\u0000", "/", "..", "\x7f", "é" * 200]
ODD_VALUES = [None, True, False, 0, -1, 1, 2**31, 2**53 + 1, 2**63, 2**64, -2**63, 1e308, -1e308, 1e-320, 0.1, [], {}, [[]], [None], {"": None}]


def odd_text(draw):
    return draw.choice(ODD_TEXTS) if draw.random() < 0.7 else "".join(chr(draw.randrange(1, 0xD7FF)) for _ in range(draw.randrange(40)))


def odd_value(draw):
    return odd_text(draw) if draw.random() < 0.5 else draw.choice(ODD_VALUES)


def places_of(value, path=()):
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from places_of(value[key], path + (key,))
    if isinstance(value, list):
        for at in range(len(value)):
            yield from places_of(value[at], path + (at,))


def replaced(value, path, by):
    if not path:
        return by
    out = dict(value) if isinstance(value, dict) else list(value)
    out[path[0]] = replaced(value[path[0]], path[1:], by)
    return out


def mutated_json(value, draw):
    """The text of the value with one to four of its parts others, or broken as text."""
    for _ in range(draw.randint(1, 4)):
        path = draw.choice(list(places_of(value)))
        value = replaced(value, path, odd_value(draw))
    text = json.dumps(value, ensure_ascii=draw.random() < 0.5).encode("utf-8", "surrogatepass")
    return mutated_bytes(text, draw) if draw.random() < 0.3 else text


def mutated_bytes(data, draw):
    out = bytearray(data)
    for _ in range(draw.randint(1, 4)):
        at = draw.randrange(len(out) + 1)
        how = draw.randrange(5)
        if how == 0 and out:
            out[at % len(out)] = draw.randrange(256)
        elif how == 1:
            del out[at:at + draw.randrange(1, 16)]
        elif how == 2:
            out[at:at] = bytes(draw.randrange(256) for _ in range(draw.randrange(1, 8)))
        elif how == 3:
            out[at:at] = out[at:at + 32] * draw.randrange(1, 20)
        else:
            del out[at:]
    return bytes(out)


def one_shot(target, source, raw, method):
    """The answer on a connection of its own, whose sending side ends with the request where that can be said."""
    made = target.connect(source, patience_s=2)
    try:
        made.sendall(raw)
        if not target.authority:
            made.shutdown(socket.SHUT_WR)
        return read_answer(made.makefile("rb"), method)
    except (OSError, ValueError):
        return None
    finally:
        made.close()


class Flood:
    """One process's part of a block: its draw, its people, and what it has seen."""

    def __init__(self, world, number):
        self.world, self.number, self.trials = world, number, 0
        self.draw = random.Random(SEED * 100 + number)
        self.source = SOURCE.format(number + 1)
        self.people = {role: self.own_session(role, client) for role, client in world.people.items()}
        self.routes = [route for route in routes_of(world) if route.id not in LEFT_OUT]

    def own_session(self, role, client):
        """Somebody of the role, whose session is this flood's alone: it may be ended by what is sent."""
        if role == "station":
            return Client(self.world.target, client.credentials, self.source)
        name = client.identity["name"]
        return self.world.signed_in(name, self.world.passwords[name], self.source)

    def ask(self, route, method, path, body=None):
        role = self.draw.choice([role for role in route.roles if role in self.people] or ["admin"])
        answer = self.people[role].ask(method, path, body, headers=route.headers())
        if answer.status == 401 and role != "station":
            self.people[role] = self.own_session(role, self.people[role])
        return answer

    def json_body(self):
        route = self.draw.choice([route for route in self.routes if route.takes_json and route.id != "signIn"])
        path = route.address(choose=lambda parameter: plain_value(parameter) if self.draw.random() < 0.8 else odd_value(self.draw))
        return self.ask(route, route.method, path, mutated_json(body_of(route, self.draw), self.draw))

    def path_and_query(self):
        route = self.draw.choice([route for route in self.routes if not route.takes_json])
        path = route.address(choose=lambda parameter: odd_value(self.draw) if self.draw.random() < 0.7 else plain_value(parameter))
        if self.draw.random() < 0.3:
            path = mutated_bytes(path.encode("utf-8", "replace"), self.draw).decode("latin-1")
        path = "/api" + path.removeprefix("/api").replace(" ", "%20").replace("\r", "").replace("\n", "")
        method = route.method if self.draw.random() < 0.9 else self.draw.choice(["GET", "HEAD", "PUT", "DELETE"])
        return self.ask(route, method, path)

    def head(self):
        credentials = self.draw.choice(list(self.people.values())).headers()
        method = self.draw.choice(["GET", "GET", "HEAD", "POST", "DELETE", "BREW", "get", "CONNECT", "PRI"])
        headers = credentials | self.draw.choice(ODD_FIELDS)
        raw = request_bytes(method, self.draw.choice(HEAD_PATHS), headers, self.draw.choice([b"", b"{}"]))
        return one_shot(self.world.target, self.source, mutated_bytes(raw, self.draw) + b"\r\n\r\n", method)

    def archive(self):
        broken = mutated_bytes(zipped({"set.json": b"{}", "a.csv": b"t_s\n0\n"}), self.draw)
        body = odd_zip(self.draw) if self.draw.random() < 0.7 else broken
        path = self.draw.choice(["/lab/measurements?name=odd", "/lab/measurements?name=odd", "/volumes?name=odd"])
        return self.people["researcher"].ask("POST", path, body, kind="application/octet-stream")

    def trial(self):
        if self.trials % TRIALS_A_STATION == 0:
            self.station = self.world.station(f"flood {self.number} {self.trials}", self.people["admin"])
        self.trials += 1
        trial_id = "%032x" % self.draw.getrandbits(128)
        return hand_over(self.station, trial_id, self.world.case, odd_trial(trial_id, self.world.case, self.draw))


ODD_NAMES = ["a.csv", "../a.csv", "/etc/cron.d/a", "a/../../b", "..\\a", "C:\\a", "a" * 300, "a\0b", ".", "..", "link", "x/" * 200]
ODD_HEADERS = [{}, {"probe": {}}, {"rate_Hz": -1}, {"started_utc_us": 2**63}, {"extra": {"a": [[[]]]}}, {"rig": "palpation"},
               {"id": "0" * 32}, {"unknown": 1}]


def odd_zip(draw):
    """Traversal, links, doubled names, lying sizes, bombs."""
    warnings.simplefilter("ignore")  # doubled names are meant
    out, good = io.BytesIO(), b'{"format":"tractus-measurements/1","rig":"probing","trials":[{"id":"a","file":"a.csv"}]}'
    with zipfile.ZipFile(out, "w", draw.choice([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])) as archive:
        archive.writestr("set.json", draw.choice([good, mutated_bytes(good, draw), b"[" * 50_000]))
        for _ in range(draw.randrange(4)):
            info = zipfile.ZipInfo(draw.choice(ODD_NAMES))
            if draw.random() < 0.3:
                info.external_attr = 0o120777 << 16  # a symbolic link
            archive.writestr(info, draw.choice([b"/etc/passwd", b"t_s,x_m,fz_N\n0,0,1\n", b"t_s,x_m,fz_N\n" + b"0" * 300_000]))
    data = bytearray(out.getvalue())
    if draw.random() < 0.3:  # sizes in the central directory that lie
        at = data.rfind(b"PK\x01\x02")
        data[at + 20:at + 28] = struct.pack("<II", draw.choice([0, 5, 0xFFFFFFFF]), draw.choice([0, 0xFFFFFFFF, 1 << 30]))
    return bytes(data)


def odd_trial(trial_id, slot, draw):
    whole = trial_bytes(trial_id, slot, draw.choice(["x", "a" * 300, "\u0000"]), draw.choice([1, 20, 40]), fields=draw.choice(ODD_HEADERS))
    if draw.random() < 0.5:
        return mutated_bytes(whole, draw)
    kinds = [draw.choice([b"HEAD", b"EVNT", b"SAMP", b"PACK", b"XXXX"]) for _ in range(draw.randrange(1, 5))]
    payloads = [(kind, mutated_bytes(zlib.compress(whole[:200]), draw)) for kind in kinds]
    return sealed([(b"HEAD", mutated_json({"format": "tractus-trial/2", "id": trial_id}, draw))] + payloads, draw.choice([0, 1, 2**40]))


def part_of_block(world, kind, number, count, out):
    """Runs in a process of its own; what it saw goes into the queue."""
    flood, seen, odd = Flood(world, number), {}, []
    for _ in range(count):
        answer = getattr(flood, kind)()
        status = answer.status if answer else 0
        seen[status] = seen.get(status, 0) + 1
        broke = status >= 500 and status not in (501, 503, 505)
        told = answer and str(world.setup.folder).encode() in answer.body  # where its files are is nobody's business
        if (broke or told) and len(odd) < 5:
            odd.append(("an internal error: " if broke else "a path of the server's disk: ") + str(answer)[:300])
    out.put((seen, odd))


def block(world, kind, count):
    """So many mutated requests of a kind, over all processes."""
    out, statuses, odd = multiprocessing.Queue(), {}, []
    base = {"json_body": 0, "path_and_query": 10, "head": 20, "archive": 30, "trial": 40}[kind]
    share = count // PROCESSES + 1
    parts = [multiprocessing.Process(target=part_of_block, args=(world, kind, base + n, share, out), daemon=True)
             for n in range(PROCESSES)]
    began = time.monotonic()
    for part in parts:
        part.start()
    for _ in parts:
        seen, strange = out.get(timeout=300)
        odd += strange
        for status, number in seen.items():
            statuses[status] = statuses.get(status, 0) + number
    for part in parts:
        part.join(10)
    total, took_s = sum(statuses.values()), time.monotonic() - began
    print(f"      {total} requests in {took_s:.0f} s: {dict(sorted(statuses.items()))}", flush=True)
    expect(not odd, " | ".join(odd[:3]))
    expect(total >= count, f"{total} of {count} requests were made")


@attack("3500 bodies grown from the schemas of the catalogue and mutated")
def mutated_bodies(world):
    block(world, "json_body", 3500)


@attack("2500 paths and queries, mutated")
def mutated_paths(world):
    block(world, "path_and_query", 2500)


@attack("2800 request heads, mutated byte by byte")
def mutated_heads(world):
    block(world, "head", 2800)


@attack("600 archives with traversal, links, doubled names, lying sizes and bombs")
def mutated_archives(world):
    block(world, "archive", 600)


@attack("700 trial files whose frames, checksums and contents lie")
def mutated_trials(world):
    world.case = world.published_case()
    block(world, "trial", 700)


@attack("zip bombs: a gigabyte in a megabyte, and a zip within a zip")
def bombs(world):
    for data in (zipped({"set.json": b"{}", "a.csv": bytes(400 << 20)}), zipped({f"{n}/set.json": b"{}" for n in range(20_000)}),
                 zipped({"set.json": zipped({"set.json": bytes(50 << 20)})})):
        for path in ("/lab/measurements?name=bomb", "/volumes?name=bomb"):
            answer = world.people["researcher"].ask("POST", path, data, kind="application/octet-stream")
            expect(400 <= answer.status < 500 or answer.status == 503, f"{path}: {answer}")
