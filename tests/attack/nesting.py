"""Item 1: documents that a parser stumbles over, sent to every route with a body by everybody who may."""
import io
import json
import random
import zipfile

from catalogue import body_of, routes_of
from report import attack, expect
from wire import Client, websocket, websocket_frame

DEEP = 120_000
ONLY_TELL = {"checkScenario", "checkEffect"}  # they answer 200 and say in the answer what is wrong with a document that can be read


def documents():
    """(what it is, bytes, can be read as JSON)"""
    return [("nested arrays", b"[" * DEEP + b"]" * DEEP, False),
            ("nested objects", b'{"a":' * DEEP + b"1" + b"}" * DEEP, False),
            ("nesting that is not closed", b"[" * DEEP, False),
            ("a field nested 4000 deep", b'{"name":' + b"[" * 1900 + b"]" * 1900 + b"}", False),
            ("the same key twice", b'{"name":"one","name":"two"}', False),
            ("invalid UTF-8", b'{"name":"\xc3\x28\xff","role":"trainee"}', False),
            ("a surrogate by itself", b'{"name":"\\ud800"}', False),
            ("a number beyond any double", b'{"name":1e999999,"seed":1e400}', False),
            ("a number of 3000 digits", b'{"seed":' + b"9" * 3000 + b"}", True),
            ("20 000 keys", json.dumps({f"key{n}": 0 for n in range(20_000)}).encode(), True),
            ("100 000 elements", b"[" + b"0," * 99_999 + b"0]", True),
            ("two documents", b'{"a":1}{"a":1}', False),
            ("a zero byte", b'{"name":"a\x00b"}', False)]


def callers(world, route):
    return [world.nobody("127.0.0.11")] if route.open else [world.people[role] for role in route.roles if role in world.people]


def own_ids(world):
    ids = world.ours.ids()
    return {"id": world.spare, "trial_id": ids["trial"], "account_id": world.spare, "name": "S01", "part": "report.html"}


def sent(world, route, client, body, values):
    return client.ask(route.method, route.address(values), body, headers=route.headers())


def wrong_with(world, answer, must_refuse=True):
    """What is wrong with the answer to a document that nobody should take; "" when nothing is."""
    if answer.status == 0 and not world.healthy():
        world.restart()
        return "the server died"
    if answer.status == 0:
        return "no answer"
    refused = 400 <= answer.status < 500 or answer.status == 503
    return "" if refused or not must_refuse and answer.status < 300 else str(answer)[:120]


def throw_at_every_route(world, chosen, fields=lambda route: []):
    values, wrong, requests = own_ids(world), [], 0
    for route in routes_of(world):
        if not route.takes_json or route.id == "signOut":
            continue
        for client in callers(world, route):
            for what, body, readable in chosen + fields(route):
                answer = sent(world, route, client, body, values)
                requests += 1
                if seen := wrong_with(world, answer, not (readable and route.id in ONLY_TELL)):
                    wrong.append(f"{what} to {route.method} {route.path}: {seen}")
    print(f"      {requests} requests", flush=True)
    expect(not wrong, f"{len(wrong)}: " + "; ".join(sorted(wrong, key=lambda line: "died" not in line)[:8]))


def nested_fields(route):
    """A good body, with each of its fields in turn nested deeper than anything needs."""
    body = body_of(route, random.Random(3))
    if not isinstance(body, dict):
        return []
    deep = b"[" * 60_000 + b"]" * 60_000
    return [(f"a nested /{key}", json.dumps(body | {key: "HERE"}).encode().replace(b'"HERE"', deep, 1), False) for key in body]


@attack("1: JSON nested a hundred thousand deep is sent to every route with a body, by every role that may")
def nested_documents(world):
    throw_at_every_route(world, [one for one in documents() if "nest" in one[0]], nested_fields)


@attack("1: wide, long, doubled and broken JSON is sent to every route with a body, by every role that may")
def broken_documents(world):
    throw_at_every_route(world, [one for one in documents() if "nest" not in one[0]])


@attack("1: a good body with its first key doubled is sent to every route")
def doubled_keys(world):
    values, wrong = own_ids(world), []
    for route in routes_of(world):
        body = body_of(route, random.Random(2)) if route.takes_json else None
        if not isinstance(body, dict) or not body:
            continue
        key = next(iter(body))
        text = f"{{{json.dumps(key)}:{json.dumps(body[key])},".encode() + json.dumps(body).encode()[1:]
        for client in callers(world, route):
            if seen := wrong_with(world, sent(world, route, client, text, values)):
                wrong.append(f"{route.method} {route.path}: {seen}")
    expect(not wrong, f"{len(wrong)} took it: " + "; ".join(wrong[:6]))


def zipped(files):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return out.getvalue()


@attack("1: a zip of a few kilobytes whose set.json is nested goes to the model lab")
def nested_set(world):
    deep = b"[" * 4_000_000 + b"]" * 4_000_000  # 8 kB once it is compressed
    for what in (deep, b'{"format":"tractus-measurements/1","rig":"probing","trials":' + deep + b"}",
                 b'{"format":"tractus-measurements/1","rig":"probing","trials":[{"id":"a","file":"a.csv","notes":' + deep + b"}]}",
                 b'{"a":' * 1_000_000):
        answer = world.people["researcher"].ask("POST", "/lab/measurements?name=nested", zipped({"set.json": what, "a.csv": "t_s\n0\n"}),
                                                kind="application/octet-stream")
        expect(world.healthy(), f"the zip with {what[:60]!r} ended the server")
        expect(400 <= answer.status < 500, f"the zip: {answer}")


@attack("1: models, effects and plans of an analysis nest what they hold")
def nested_files(world):
    nested = json.loads("[" * 900 + "]" * 900)
    model = {"format": "tractus-model/1", "rig": "probing", "name": "nested", "base": {"layers": nested}, "effects": []}
    effect = {"format": "tractus-effect/1", "id": "expression:deep", "rig": "probing", "adds_to": "fz_N", "parameters": {},
              "formula": "(" * 20_000 + "1" + ")" * 20_000}
    plan = {"plan": {"format": "tractus-plan/1", "title": "deep", "question": "q", "subject": "participant", "analyses": nested}}
    for path, body in (("/lab/models", model), ("/lab/effects/check", effect), ("/cohort/plans", plan),
                       ("/lab/effects/check", effect | {"formula": "-" * 30_000 + "1"}),
                       ("/lab/effects/check", effect | {"formula": "1?" * 10_000 + "1" + ":1" * 10_000})):
        answer = world.people["researcher"].ask("POST", path, body)
        expect(world.healthy(), f"{path}: the server died")
        expect(answer.status in (200, 400, 413), f"{path}: {answer}")
        expect(answer.status != 200 or not answer.json().get("ok", True), f"{path}: took {answer}")


@attack("1: a station says nested JSON on its live line")
def nested_live_frame(world):
    for payload in (b"[" * 30_000, b'{"kind":"state","state":' + b"[" * 20_000 + b"]" * 20_000 + b"}", b"[" * DEEP + b"]" * DEEP):
        line = websocket(world.target, "/api/v1/live/station", world.ours.station.credentials)
        expect(line, "the station's own line is refused")
        line.settimeout(3)
        try:
            line.sendall(websocket_frame(payload))
            line.recv(4096)
        except OSError:
            pass
        line.close()
        expect(Client(world.target).ask("GET", "/health").status == 200, "the live line ended the server")
