#!/usr/bin/python3
"""Volumes that a real tractus-server imports from a real PACS: Orthanc with its DICOMweb plugin, as Debian has them.

    tests/dicomweb/pulled.py --bin build/release/bin

A study is found, its series are listed, one becomes a volume, without the patient; Orthanc sends one; then the PACS refuses, is down, lies: each
is one line, and nothing is changed by it. Exit 0: all is as it should be. It takes a minute."""
import argparse
import io
import json
import shutil
import signal
import sys
import tempfile
import time
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "attack"), str(HERE.parent / "notifications")]
import series  # noqa: E402
from peers import PASSWORD, TOKEN, USER, Front, Orthanc  # noqa: E402
from receivers import certificate  # noqa: E402
from wire import Client  # noqa: E402
from world import Setup, World  # noqa: E402

FINE, COARSE, OTHER = "2.25.314159", "2.25.314160", "2.25.314161"  # series: two of one study, one of another
OTHER_STUDY = "2.25.271828"
DONE_S = 60
NAMING = [series.PATIENT["name"], series.PATIENT["id"], series.PATIENT["birth"], series.PATIENT["hospital"], series.STUDY_UID, FINE]


def check(holds, what):
    print(("  ok    " if holds else "  WRONG ") + what, flush=True)
    if not holds:
        raise SystemExit(1)


def fill(orthanc):
    shape = {"side": 64, "spacing_mm": 0.5}
    orthanc.store(series.series(FINE, 48, **shape, thickness_mm=1.0, description="bone 1.0", number_of_series=2))
    orthanc.store(series.series(COARSE, 16, **shape, thickness_mm=3.0, description="soft 3.0", number_of_series=3))
    orthanc.store(series.series(OTHER, 8, **shape, thickness_mm=2.0, description="cervical", number_of_series=1, study=OTHER_STUDY,
                                date="20250601", study_description="CT neck", patient=series.PATIENT | {"id": "PID-2"}))


def settings_file(folder, base, **more):
    """The server's settings of a PACS; secrets in files of their own."""
    folder.mkdir()
    for name in ("password_file", "token_file"):
        if name in more:
            (folder / name).write_text(more[name] + "\n")
            more[name] = name
    path = folder / "pacs.json"
    path.write_text(json.dumps({"format": "tractus-pacs/1", "base": base} | more))
    return path


def served(setup, name, base, **more):
    return World(setup, options=["--log-requests", "--pacs", settings_file(setup.folder / name, base, **more)])


def wish(series_uid=FINE, study=series.STUDY_UID, name="L3"):
    return {"study_uid": study, "series_uid": series_uid, "name": name, "source": "simulated"}


def imported(person, **which):
    """The import once it has ended."""
    begun = person.must("POST", "/pacs/imports", wish(**which))
    end = time.monotonic() + DONE_S
    while (seen := person.must("GET", f"/pacs/imports/{begun['id']}"))["state"] in ("fetching", "reading"):
        if time.monotonic() > end:
            raise RuntimeError(f"an import has not ended after {DONE_S} s: {seen}")
        time.sleep(0.05)
    return seen


def found_in_files(folder, texts):
    """Where under a folder one of the texts stands."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return [f"{path}: {text}" for path in files for text in texts if text.encode() in path.read_bytes()]


def zipped(files):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as packed:
        for number, file in enumerate(files):
            packed.writestr(f"{number}.dcm", file)
    return out.getvalue()


class Things:
    """What must be as it was after something was refused."""

    def __init__(self, world):
        self.world, self.before = world, None
        self.before = self.now()

    def now(self):
        data = self.world.data
        return {"volumes": self.world.admin.must("GET", "/volumes"), "objects": sorted(path.name for path in (data / "objects").rglob("*")),
                "left": [str(path) for path in data.rglob("*.dcm")]}

    def unchanged(self):
        return self.now() == self.before


# --- what works -------------------------------------------------------------------------------------------------------------------


def found(world, faculty):
    check(faculty.must("GET", "/pacs")["address"].endswith("/dicom-web"), "the page is told that there is a PACS")
    by_id = faculty.must("POST", "/pacs/studies", {"patient_id": series.PATIENT["id"]})
    study = {"uid": series.STUDY_UID, "date": "2024-03-14", "description": "CT lumbar spine", "modalities": ["CT"], "series": 2, "files": 64}
    check(by_id == {"studies": [study], "more": False}, f"a study is found by the patient's id: {by_id}")
    check(not [text for text in NAMING[:4] if text in json.dumps(by_id)], "the answer does not say whose it is")
    for what, search in (("day", {"from": "2024-01-01", "to": "2024-12-31"}), ("last day", {"to": "2024-12-31"}), ("description", {"description": "lumbar spine"})):
        check(faculty.must("POST", "/pacs/studies", search)["studies"] == [study], f"and by {what}")
    check(len(faculty.must("POST", "/pacs/studies", {"from": "2000-01-01"})["studies"]) == 2, "both studies lie after 2000")
    check(len(faculty.must("POST", "/pacs/studies", {"from": "2000-01-01", "offset": 1})["studies"]) == 1, "a page begins where it is told to")
    check(faculty.must("POST", "/pacs/studies", {"patient_id": "nobody"})["studies"] == [], "nobody has no study")
    for body in ({}, {"patient_id": "*"}, {"description": "a\\b"}, {"from": "20240101"}, {"from": "2024-01-01", "offset": -1}, {"patient_id": "x", "limit": 5}):
        check(faculty.ask("POST", "/pacs/studies", body).status == 400, f"a search is refused: {body}")
    told = faculty.must("POST", "/pacs/series", {"study_uid": series.STUDY_UID})["series"]
    fine, coarse = sorted(told, key=lambda one: one["number"])
    check((fine["uid"], fine["modality"], fine["description"], fine["files"]) == (FINE, "CT", "bone 1.0", 48), f"series say what they are: {fine}")
    check((fine["row_spacing_m"], fine["column_spacing_m"], fine["thickness_m"], coarse["thickness_m"]) == (0.0005, 0.0005, 0.001, 0.003),
          "with spacing and thickness, in metres")
    for uid in ("", "1/../../../tools/shutdown", "1?x=1", "1 2", "..", "x" * 70):
        check(faculty.ask("POST", "/pacs/series", {"study_uid": uid}).status == 400, f"what is no UID is refused: {uid[:30]!r}")


def made(world, faculty):
    ended = imported(faculty)
    check(ended["state"] == "done" and ended["files"] == 48 and ended["error"] == "", f"a series becomes a volume: {ended}")
    volume = faculty.must("GET", f"/volumes/{ended['volume']}")
    check((volume["state"], volume["format"], volume["modality"], volume["dims"], volume["made_by"]) == ("held", "DICOM", "CT", [64, 64, 48], "fay"),
          "held for review, as an uploaded one")
    check([round(one, 6) for one in volume["spacing_m"]] == [0.0005, 0.0005, 0.001], f"with its geometry: {volume['spacing_m']}")
    check(volume["range"] == [0, 10 * 63 + 63 + 47], f"and its voxels: {volume['range']}")
    report = faculty.must("GET", f"/volumes/{ended['volume']}/report")
    name = next(one for one in report["attributes"] if one["tag"] == "(0010,0010)")
    check(report["files"] == 48 and name["done"] == "removed" and name["count"] == 48, f"de-identified: {name}")
    again = faculty.ask("POST", "/volumes?name=again&source=test", zipped(series.series(
        FINE, 48, side=64, spacing_mm=0.5, thickness_mm=1.0, description="bone 1.0", number_of_series=2)), kind="application/octet-stream")
    check(again.status == 409, f"the same series as a zip is the same volume, bit by bit: {again}")
    twice = imported(faculty)
    check(twice["state"] == "failed" and "already on this server" in twice["error"], f"and not taken a second time: {twice['error']}")
    check(imported(faculty, series_uid=COARSE)["state"] == "done", "the other series is another volume")


def guarded(world, faculty):
    ended = imported(faculty, series_uid=OTHER, study=OTHER_STUDY)
    director, trainee = world.account("dora", "director"), world.account("tom", "trainee")
    check(director.ask("GET", f"/pacs/imports/{ended['id']}").status == 404, "an import is shown to nobody but who began it")
    for method, path, body in (("GET", "/pacs", None), ("POST", "/pacs/studies", {"patient_id": "x"}), ("POST", "/pacs/series", {"study_uid": "1"}),
                               ("POST", "/pacs/imports", wish()), ("GET", f"/pacs/imports/{ended['id']}", None)):
        check(trainee.ask(method, path, body).status == 403 and world.nobody().ask(method, path, body).status == 401,
              f"{method} {path.split('/imports/')[0]} is for no trainee and no stranger")
    rows = world.admin.must("GET", "/audit?limit=200")["rows"]
    searches = [row for row in rows if row["what"] == "findPacsStudies" and row["who"] == "fay"]
    check(len(searches) >= 6, f"each search is in the audit trail: {len(searches)}")
    check([row["who"] for row in rows if row["what"] == "addVolume"].count("fay") == 3, "and each volume")
    check(not [text for text in NAMING if text in json.dumps(rows)], "without the patient and the study")
    world.server.stop()
    left = found_in_files(world.folder, [*NAMING, PASSWORD])
    check(not left, f"neither stands in a file of the server, database and log included: {left}")
    world.server.start()


# --- what does not ----------------------------------------------------------------------------------------------------------------


def refusals(person, things, words, *, both=True):
    """A search (or with `both`, that and an import) is refused in one line with these words, and nothing is changed."""
    errors = []
    if both:
        answer = person.ask("POST", "/pacs/studies", {"patient_id": "x"})
        errors.append(answer.json()["error"] if answer.status in (400, 413, 503) else str(answer))
    errors.append(imported(person)["error"])
    check(all(words in error and "\n" not in error and len(error) < 300 for error in errors), f"{' | '.join(errors)}")
    check(things.unchanged(), "and nothing is changed")


def lied_to(world, front):
    things = Things(world)
    both = {"fails": "answered 500", "redirects": "answered 302: it sends elsewhere", "sends_a_page": 'sent the type "text/html"'}
    lists = {"sends_an_object": "sent no list", "sends_no_json": "the answer of the PACS", "sends_an_endless_list": "is too long"}
    bodies = {"has_another_boundary": "has no part with the boundary that it states", "has_no_boundary": "without a boundary",
              "ends_too_early": "ends before its last boundary", "closes_too_early": "does not answer", "sends_other_parts": "image/jpeg",
              "sends_rubbish_as_dicom": "the upload", "sends_no_part": "sent no file", "sends_endless_headers": "headers have no end",
              "sends_endless_parts": "more than 4096 files", "sends_an_endless_part": "more than 1024 MiB"}
    for front.lie, words in both.items():
        refusals(world.admin, things, words)
    for front.lie, words in lists.items():
        answer = world.admin.ask("POST", "/pacs/studies", {"patient_id": "x"})
        check(answer.status in (400, 413) and words in answer.body.decode(), f"{front.lie}: {answer}")
    before_bytes = world.server.resident_bytes()
    for front.lie, words in bodies.items():
        started = time.monotonic()
        refusals(world.admin, things, words, both=False)
        print(f"        ({time.monotonic() - started:.1f} s)")
    grown_MiB = (world.server.resident_bytes() - before_bytes) >> 20
    check(grown_MiB < 64, f"endless bodies take no memory: {grown_MiB} MiB more")
    front.lie = ""


def killed(world, front):
    things, front.lie = Things(world), "falls_silent"
    world.admin.must("POST", "/pacs/imports", wish())
    check(front.silent.wait(10), "a transfer is under way")
    time.sleep(0.5)
    check(things.now()["left"], "its files lie in the scratch folder")
    world.server.stop(signal.SIGKILL)
    world.server.start()
    world.renew(world.admin)
    check(things.unchanged(), "a server that was killed meanwhile leaves nothing of them once it is started again")
    ended = world.setup.run("verify", "--data", world.data)
    check(ended.returncode == 0, "and verify finds nothing wrong")
    front.lie = ""


def token_of(world, name, *scopes):
    """An API token of the person, and the client that has it."""
    made = world.people[name].must("POST", "/tokens", {
        "name": "pacs", "scopes": list(scopes), "expires_utc_us": int((time.time() + 86400) * 1e6), "password": world.passwords[name]})
    return made["token"], Client(world.target, {"Authorization": f"Bearer {made['token']}"})


def body_of(files, boundary="b"):
    parts = [f"--{boundary}\r\nContent-Type: application/dicom\r\n\r\n".encode() + file + b"\r\n" for file in files]
    return b"".join(parts) + f"--{boundary}--\r\n".encode()


def sent(world, orthanc):
    """A PACS that sends by itself."""
    world.people["fay"] = world.account("fay", "faculty")
    token, fay = token_of(world, "fay", "volumes:write")
    base = f"http://127.0.0.1:{world.server.port}/api/v1/dicom-web/"
    status, said = orthanc.send(OTHER, base, token)
    check(status == 200, f"Orthanc sends a series by STOW-RS: {said[:200]}")
    volume = world.admin.must("GET", "/volumes")["volumes"][0]
    check((volume["state"], volume["dims"], volume["made_by"], volume["source"]) == ("held", [64, 64, 8], "fay", "sent by STOW-RS"),
          f"which is held for review: {volume['name']}")
    things = Things(world)
    status, said = orthanc.send(OTHER, base, token)
    check(status != 200 and things.unchanged(), f"and is not taken a second time: {said[:200]}")
    one = series.series("2.25.99", 4, side=16, spacing_mm=1.0, thickness_mm=2.0, description="", number_of_series=1)
    kind = 'multipart/related; type="application/dicom"; boundary=b'
    answer = fay.ask("POST", "/dicom-web/studies", body_of(one), kind=kind)
    told = [item["00081155"]["Value"][0] for item in answer.json()["00081199"]["Value"]] if answer.status == 200 else []
    check(told == [f"2.25.99.{number}" for number in (1, 2, 3, 4)] and answer.header("content-type") == "application/dicom+json",
          f"the answer names the instances, as the standard says: {answer}")
    things = Things(world)
    two = one[:2] + series.series("2.25.98", 2, side=16, spacing_mm=1.0, thickness_mm=2.0, description="", number_of_series=2)
    for what, sent_kind, body in (("two series", kind, body_of(two)), ("no multipart", "application/dicom", one[0]), ("no DICOM", kind, body_of([b"hello"])),
                                  ("another boundary", kind, body_of(one, "c")), ("half a body", kind, body_of(one)[:3000]), ("nothing", kind, b"")):
        answer = fay.ask("POST", "/dicom-web/studies", body, kind=sent_kind)
        check(answer.status == 400 and things.unchanged(), f"{what} is refused: {answer}")
    check(token_of(world, "fay", "volumes:read")[1].ask("POST", "/dicom-web/studies", body_of(one), kind=kind).status == 403, "a token needs the scope")
    check(fay.ask("POST", "/pacs/studies", {"patient_id": "x"}).status == 403, "and no token searches the PACS")
    world.server.stop()
    left = found_in_files(world.folder, NAMING[:4])
    check(not left, f"the patient stands in no file of the server: {left}")
    world.server.start()


def run(setup):
    orthanc = Orthanc(setup.folder)
    try:
        fill(orthanc)
        with served(setup, "basic", orthanc.base, user=USER, password_file=PASSWORD) as world:
            faculty = world.account("fay", "faculty")
            found(world, faculty)
            made(world, faculty)
            guarded(world, faculty)
        with served(setup, "wrong", orthanc.base, user=USER, password_file="wrong") as world:
            refusals(world.admin, Things(world), f"the PACS at {orthanc.base} answered 401: check its user and password")
        with World(setup) as world:
            sent(world, orthanc)
        pem, key = certificate(setup.folder)
        front = Front(orthanc, (pem, key))
        with served(setup, "stranger", front.base, token_file=TOKEN) as world:
            refusals(world.admin, Things(world), "does not answer: SSL")
            check(front.asked == [], "whose certificate nobody vouches for is told no token")
        with served(setup, "expired", front.base, token_file="expired", authority=str(pem)) as world:
            refusals(world.admin, Things(world), f"the PACS at {front.base} answered 401: check its token")
        with served(setup, "token", front.base, token_file=TOKEN, authority=str(pem)) as world:
            lied_to(world, front)
            killed(world, front)
            check(imported(world.admin)["state"] == "done", "by a token over TLS, a series becomes a volume")
            orthanc_asked = len(front.asked)
            front.stop()
            refusals(world.admin, Things(world), "does not answer")
            check(len(front.asked) == orthanc_asked, "which was down")
    finally:
        orthanc.stop()
    with World(setup) as world:
        check(world.admin.must("GET", "/pacs")["address"] is None, "without a PACS the page is told so")
        answer = world.admin.ask("POST", "/pacs/studies", {"patient_id": "x"})
        check(answer.status == 409 and b"--pacs" in answer.body, f"and a search says how to state one: {answer}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="tractus-dicomweb-"))
    setup = Setup(options.bin.resolve(), folder, "sqlite", "nothing")
    try:
        run(setup)
    finally:
        setup.stop()
        shutil.rmtree(folder, ignore_errors=True)
    print("volumes from a PACS: as they should be")


if __name__ == "__main__":
    main()
