"""Item 10 on the wire: heads that two programs read differently, forged addresses, weak ciphers, missing headers."""
import socket
import ssl
import time

from catalogue import routes_of
from nesting import zipped
from processes import ROOT
from relations import agree, analysed
from report import NotTried, attack, expect
from wire import Client, Line, Target, read_answer, request_bytes
from world import ROLES, World

SMUGGLED = b"GET /api/v1/smuggled HTTP/1.1\r\nHost: x\r\n\r\n"


def raw_head(client, method, path, headers, kind="application/json"):
    """A request's head alone, with the client's credentials."""
    return request_bytes(method, "/api/v1" + path, client.headers(headers, kind)).replace(b"Content-Length: 0\r\n", b"")


def answers_of(target, data, patience_s=3):
    """All that comes back on one connection, and whether the other side closed it."""
    made = target.connect(patience_s=patience_s)
    made.sendall(data)
    out, closed = b"", False
    try:
        while piece := made.recv(65536):
            out += piece
        closed = True
    except (TimeoutError, socket.timeout):
        pass
    except OSError:
        closed = True
    made.close()
    return out, closed


CODINGS = [b"identity", b"gzip", b"xchunked", b"chunked, gzip", b"gzip, chunked", b"\x0bchunked", b"chunked\x00", b"chunKed, identity",
           b"deflate", b"chunked;q=1", b"\"chunked\"", b"chunked chunked", b"cow"]


@attack("10: an unknown Transfer-Encoding is taken for no body, so that the body is the next request")
def unknown_transfer_codings(world):
    for coding in CODINGS:
        field = b"Transfer-Encoding: " + coding
        for fields in (field, field + b"\r\nContent-Length: 5", field.replace(b":", b" :", 1)):
            out, closed = answers_of(world.target, b"GET /api/v1/health HTTP/1.1\r\nHost: x\r\n" + fields + b"\r\n\r\n" + SMUGGLED)
            first = out[:12].decode(errors="replace")
            expect(out.count(b"HTTP/1.1 ") <= 1, f"{fields!r}: two answers, the second to the body")
            expect(first[9:12] in ("400", "501", "") and closed, f"{fields!r}: {first}, {'closed' if closed else 'left open'}")


BAD_HOSTS = {"none": b"", "two": b"Host: a\r\nHost: b\r\n", "two that are the same": b"Host: a\r\nHost: a\r\n",
             "one in two spellings": b"Host: a\r\nhost: b\r\n"}


@attack("10: a request has no Host, or two")
def hosts(world):
    for what, fields in BAD_HOSTS.items():
        out, closed = answers_of(world.target, b"GET /api/v1/health HTTP/1.1\r\n" + fields + b"\r\n")
        expect(out[9:12] == b"400", f"{what}: {out[:15]!r}")


BARE_LINE_FEED = b"X: a\n\nGET / HTTP/1.1"  # nginx takes it for the end of a line, as RFC 9112 section 2.2 lets it
ODD_LENGTHS = [b"Content-Length: 0\r\nContent-Length: 45", b"Content-Length: +0", b"Content-Length: 0x0", b"Content-Length: -1",
               b"Content-Length: 0, 45", b"Content-Length: 18446744073709551616", BARE_LINE_FEED,
               b"Transfer-Encoding: chunked\r\nContent-Length: 3", b"Content-Length: 0\x00"]


@attack("two lengths, a length with a sign, a bare line feed or two framings hide a second request")
def odd_lengths(world):
    for fields in ODD_LENGTHS:
        if world.proxy and fields == BARE_LINE_FEED:
            continue
        out, closed = answers_of(world.target, b"POST /api/v1/session HTTP/1.1\r\nHost: x\r\n" + fields + b"\r\n\r\n" + SMUGGLED)
        count = out.count(b"HTTP/1.1 ")
        expect(count <= 1 and closed, f"{fields!r}: {count} answers, {'closed' if closed else 'left open'}")


def peer_in_trail(world, target, source, headers):
    """The address that the audit trail keeps of a refused request."""
    client = Client(target, world.people["technician"].credentials, source=source)
    client.ask("POST", f"/accounts/{world.spare}/state", {"state": "active"}, headers=headers)
    rows = world.admin.must("GET", "/audit?limit=20")["rows"]
    return next((row["peer"] for row in rows if row["who"] == "technician" and row["what"].startswith("refused")), "")


@attack("10: X-Forwarded-For is believed from anybody who reaches the server beside its proxy")
def forged_forwarded_for(world):
    with World(world.setup, front="proxy") as side:
        side.people["technician"], side.spare = side.account("technician", "technician"), "0" * 32
        direct = Target(side.server.port)
        seen = peer_in_trail(side, direct, "127.0.0.33", {"X-Forwarded-For": "203.0.113.77"})
    expect(seen, "the refused request is not in the audit trail")
    expect(seen != "203.0.113.77", "the trail holds the address that the attacker wrote")


@attack("10: X-Forwarded-For changes the address that the trail keeps, as the server is set up here")
def forwarded_for_as_set_up(world):
    seen = peer_in_trail(world, world.target, "127.0.0.34", {"X-Forwarded-For": "203.0.113.78"})
    expect("203.0.113.78" not in seen, f"the trail holds {seen}")


def encrypted(world, function):
    if world.target.authority:
        return function(world)
    with World(world.setup, front="tls") as side:
        return function(side)


@attack("10: signing in over TLS is answered without Strict-Transport-Security")
def strict_transport(world):
    def seen(side):
        good = side.nobody().ask("POST", "/session", {"name": "admin", "password": side.admin_password})
        bad = side.nobody().ask("POST", "/session", {"name": "admin", "password": "wrong password"})
        rest = [side.admin.ask("GET", path) for path in ("/session", "/trials", "/nothing", "/health")]
        return [answer.header("strict-transport-security") for answer in (good, bad, *rest)]
    missing = [number for number, header in enumerate(encrypted(world, seen)) if "max-age" not in header]
    expect(not missing, f"answers without it (0 good sign-in, 1 bad, 2 … others): {missing}")


WEAK = ["ECDHE-ECDSA-AES128-SHA", "ECDHE-ECDSA-AES256-SHA", "ECDHE-RSA-AES128-SHA", "ECDHE-RSA-AES256-SHA", "AES128-SHA", "AES256-SHA",
        "ECDHE-ECDSA-AES128-SHA256", "ECDHE-RSA-AES128-SHA256", "AES128-SHA256", "AES128-GCM-SHA256", "DHE-RSA-AES128-SHA", "NULL-SHA256"]


def handshake(port, version, cipher):
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    try:
        context.set_ciphers(f"{cipher}:@SECLEVEL=0")
        context.minimum_version = context.maximum_version = version
    except (ssl.SSLError, ValueError):
        return False
    with socket.create_connection(("127.0.0.1", port), 10) as made:
        try:
            context.wrap_socket(made).close()
            return True
        except (ssl.SSLError, OSError):
            return False


@attack("10: a client speaks TLS 1.0 or 1.1, or TLS 1.2 with CBC and SHA-1 or without forward secrecy")
def weak_ciphers(world):
    def seen(side):
        old = [str(version) for version in (ssl.TLSVersion.TLSv1, ssl.TLSVersion.TLSv1_1) if handshake(side.target.port, version, "ALL")]
        return old + [cipher for cipher in WEAK if handshake(side.target.port, ssl.TLSVersion.TLSv1_2, cipher)]
    taken = encrypted(world, seen)
    expect(not taken, "taken: " + ", ".join(taken))


@attack("10: an answer to somebody who signed in, or a report, may be kept by a cache")
def cache_control(world):
    agree(world, "metrics")
    analysis = analysed(world)[0]
    reports = [("researcher", f"/lab/runs/{finished_diagnosis(world)}/report"),
               *(("researcher", f"/cohort/analyses/{analysis}/{part}") for part in ("report.html", "result.json", "data.csv"))]
    values, kept = {"id": world.ours.trial}, []
    asked = reports + [(role, route.address(values)) for route in routes_of(world) if route.method == "GET" and not route.open
                       for role in ROLES if role in route.roles]
    for role, path in asked:
        answer = world.people[role].ask("GET", path)
        cache = answer.header("cache-control")
        expect(answer.status == 200 or (role, path) not in reports, f"the suite's report cannot be read: {answer}")
        if answer.status == 200 and not ("no-store" in cache or "private" in cache):
            kept.append(f"{role}: {path}: {cache or 'no Cache-Control'}")
    expect(not kept, f"{len(kept)}: " + "; ".join(kept[:6]))


def finished_diagnosis(world):
    """A diagnosis of the model lab with its report; model and the first rows of the measurements from tests/data."""
    data = ROOT / "tests/data/force/cable_tool_odbl"
    rows = 1200  # the report is what is looked at, and the lab takes a minute for all of them
    files = {path.name: b"".join(path.read_bytes().splitlines(keepends=True)[:rows + 1]) for path in (data / "drum/light_fast").iterdir()}
    researcher = world.people["researcher"]
    kept = researcher.must("POST", "/lab/measurements?name=cable", zipped(files), kind="application/octet-stream")
    model = researcher.must("POST", "/lab/models", (data / "model.json").read_bytes())
    run = researcher.must("POST", "/lab/diagnoses", {"model": model["id"], "measurements": kept["id"]})["id"]
    for _ in range(3000):
        if researcher.must("GET", f"/lab/runs/{run}")["state"] not in ("queued", "running"):
            return run
        time.sleep(0.1)
    raise NotTried("the lab's diagnosis takes more than 300 s")


@attack("a page of another site sends a person's cookie: without X-Tractus nothing may change")
def forged_by_a_page(world):
    client = world.people["admin"]
    for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", "application/json"):
        headers = {"Host": "x", "Origin": "https://evil.example", "Content-Type": kind} | client.credentials
        answer = Line(world.target).exchange(request_bytes("POST", "/api/v1/cohorts", headers, b'{"name":"forged"}'), "POST")
        expect(answer.status == 403, f"{kind}: {answer}")


@attack("an answer tells more than it must: the server's version, a path of its disk, a stack, a frame for other sites")
def telling_headers(world):
    for path in ("/session", "/trials/" + "0" * 32, "/trials?limit=x", "/nothing", "/cases/%00", "/accounts"):
        answer = world.people["admin"].ask("GET", path)
        text = answer.body.decode(errors="replace")
        expect("/tmp/" not in text and str(world.data) not in text, f"{path}: {answer}")
        expect("nginx/" not in answer.header("server"), f"{path}: Server: {answer.header('server')}")
        expect(answer.header("x-content-type-options") == "nosniff", f"{path}: no X-Content-Type-Options")
        expect("access-control-allow-origin" not in answer.headers, f"{path}: other sites may read it")


@attack("four hundred connections send their heads a byte at a time, and others wait")
def slow_heads(world):
    held = []
    for number in range(400):
        made = world.direct.connect(source=f"127.0.10.{number % 200 + 1}", patience_s=5)
        made.sendall(b"GET /api/v1/health HT")
        held.append(made)
    began = time.monotonic()
    answer = Client(world.direct).ask("GET", "/health")
    took_s = time.monotonic() - began
    for made in held:
        made.close()
    expect(answer.status == 200 and took_s < 1, f"health took {took_s:.1f} s: {answer}")


@attack("a WebSocket is opened by another site's page, or by somebody without the right")
def foreign_websockets(world):
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
               "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="}
    admin, trainee, station = (world.people[role].credentials for role in ("admin", "trainee", "station"))
    for path, credentials in (("live", admin | {"Origin": "https://evil.example"}), ("live", trainee), ("live", station), ("live", {}),
                              ("live/station", admin), ("live/station", {})):
        made = world.target.connect(patience_s=5)
        made.sendall(request_bytes("GET", f"/api/v1/{path}", {"Host": "127.0.0.1"} | upgrade | credentials))
        answer = read_answer(made.makefile("rb"), "GET")
        made.close()
        expect(answer and answer.status in (401, 403), f"{path} with {sorted(credentials)}: {answer}")
