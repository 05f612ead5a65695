#!/usr/bin/env python3
"""The clients in Python and R: trial files against the golden ones, and a server of the test's own that cuts connections."""
import functools
import http.server
import io
import json
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import types
import unittest
import unittest.mock
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests/golden"
sys.path.insert(0, str(ROOT / "deploy/clients/python"))

import tractus_client
from tractus_client import Server, TractusError, read_cohort, read_trial
from tractus_client.tables import parse_table

try:
    import numpy
except ImportError:
    numpy = None

try:
    import h5py
except ImportError:
    h5py = None

R_SOURCES = 'for (file in list.files("%s", full.names = TRUE)) source(file)\n' % (ROOT / "deploy/clients/r/R")


@functools.cache
def has_r(*packages):
    if not shutil.which("Rscript"):
        return False
    checks = "".join(f'library("{name}");' for name in packages)
    return subprocess.run(["Rscript", "-e", checks or "1"], capture_output=True).returncode == 0


def run_r(program):
    with tempfile.NamedTemporaryFile("w", suffix=".R") as file:
        file.write(R_SOURCES + program)
        file.flush()
        return subprocess.run(["Rscript", file.name], capture_output=True, text=True, timeout=120)


def maker():
    """The functions of the golden files' make.py: an independent writer of packed samples."""
    module = types.ModuleType("make")
    exec((GOLDEN / "trial-format-2/make.py").read_text().split("\nfor ")[0], module.__dict__)
    return module


def zstd_raw(content):
    """A frame of one raw block of any size below 128 KiB (RFC 8878, 3.1.1): one segment, its size in four bytes."""
    return struct.pack("<IBI", 0xFD2FB528, 0xA0, len(content)) + struct.pack("<I", len(content) << 3 | 1)[:3] + content


def whole_lengths(content):
    at = 16
    while at + 20 <= len(content):
        length = struct.unpack_from("<I", content, at + 4)[0]
        if not any(content[at:at + 20]) or at + 20 + length > len(content):
            return
        yield length
        at += 20 + length


GOLDEN_TRIALS = [("trial-format-1", "palpation"), ("trial-format-1-probing", "probing")]


@unittest.skipUnless(numpy, "NumPy is not installed")
class TrialFilesInPython(unittest.TestCase):
    def test_golden_files_give_every_number(self):
        for folder, rig in GOLDEN_TRIALS:
            expected = json.loads((GOLDEN / folder / "expected.json").read_text())
            for path in (GOLDEN / folder / "small.trial", GOLDEN / f"trial-format-2/{rig}.trial"):
                trial = read_trial(path)
                self.assertTrue(trial.sealed)
                self.assertEqual(len(trial.samples), len(expected["samples"]))
                for got, wanted in zip(trial.samples, expected["samples"]):
                    for name, value in wanted.items():
                        self.assertEqual(got[name].tolist(), value, f"{path} {name}")
                self.assertEqual([event["kind"] for event in trial.events], [event["kind"] for event in expected["events"]])
                self.assertEqual(trial.header["operator"], expected["header"]["operator"])

    def test_torn_files_give_their_whole_frames(self):
        for path in [GOLDEN / folder / "torn.trial" for folder, _ in GOLDEN_TRIALS] + list(GOLDEN.glob("trial-format-2/*-torn.trial")):
            trial = read_trial(path)
            self.assertEqual((len(trial.samples), len(trial.events), trial.sealed, trial.complete), (5, 1, False, False))

    def test_a_changed_byte_is_found(self):
        """In a sealed file by its SHA-256, in a torn one by the frame's checksum; never numbers from a damaged file."""
        for path in (GOLDEN / "trial-format-2/palpation.trial", GOLDEN / "trial-format-2/palpation-torn.trial"):
            content = path.read_bytes()
            whole = 16 + sum(20 + length for length in whole_lengths(content))  # bytes of a torn frame count for nothing
            for at in range(20, whole, 97):
                changed = bytearray(content)
                changed[at] ^= 1
                with tempfile.NamedTemporaryFile() as file:
                    file.write(changed)
                    file.flush()
                    with self.assertRaises(TractusError, msg=f"{path.name} byte {at}"):
                        read_trial(file.name)

    def test_random_bits_are_unpacked_as_they_were_packed(self):
        make, draw = maker(), random.Random(7)
        head = json.loads(next(payload for kind, payload in make.frames((GOLDEN / "trial-format-2/probing.trial").read_bytes()) if kind == b"HEAD"))
        for size, columns, rig in ((136, make.PALPATION, "palpation"), (64, make.PROBING, "probing")):
            out, before, whole = b"tractus-trial/2\n", [bytes(size)] * 2, b""
            payloads = [(b"HEAD", json.dumps({**head, "rig": rig}).encode())]
            for count in (1, 2, 3, 40000 // size):
                samples = [draw.randbytes(size) for _ in range(count)]
                payloads.append((b"PACK", struct.pack("<I", count) + zstd_raw(make.planes(samples, before, columns))))
                before, whole = (before + samples)[-2:], whole + b"".join(samples)
            for number, (kind, payload) in enumerate(payloads):
                front = struct.pack("<4sIII", kind, len(payload), number, make.crc32c(payload))
                out += front + struct.pack("<I", make.crc32c(front)) + payload
            with tempfile.NamedTemporaryFile() as file:
                file.write(out)
                file.flush()
                self.assertEqual(read_trial(file.name).samples.tobytes(), whole)

    def test_what_is_no_trial_file_is_refused_in_words(self):
        with self.assertRaisesRegex(TractusError, "not a trial file of Tractus"):
            read_trial(__file__)
        with self.assertRaisesRegex(TractusError, "No such file"):
            read_trial("/nowhere.ttrial")


@unittest.skipUnless(has_r("jsonlite"), "R with jsonlite is not installed")
class TrialFilesInR(unittest.TestCase):
    def test_golden_files_give_every_number(self):
        program = """
for (pair in list(c("trial-format-1", "palpation"), c("trial-format-1-probing", "probing"))) {
  expected <- jsonlite::fromJSON(file.path(golden, pair[1], "expected.json"), simplifyVector = FALSE)$samples
  for (path in file.path(golden, c(file.path(pair[1], "small.trial"), paste0("trial-format-2/", pair[2], ".trial")))) {
    trial <- read_ttrial(path)
    stopifnot(trial$sealed, nrow(trial$samples) == length(expected))
    for (i in seq_along(expected)) for (name in names(expected[[i]])) {
      wanted <- unlist(expected[[i]][[name]])
      columns <- if (length(wanted) > 1) paste0(name, "_", seq_along(wanted) - 1) else name
      stopifnot(unlist(trial$samples[i, columns], use.names = FALSE) == wanted)
    }
  }
  torn <- read_ttrial(file.path(golden, paste0("trial-format-2/", pair[2], "-torn.trial")))
  stopifnot(nrow(torn$samples) == 5, length(torn$events) == 1, !torn$sealed, !torn$complete)
}
refused <- tryCatch(read_ttrial("%s"), error = conditionMessage)
stopifnot(grepl("not a trial file of Tractus", refused))
cat("all numbers agree")
""" % __file__
        ran = run_r(f'golden <- "{GOLDEN}"\n' + program)
        self.assertEqual(ran.stdout, "all numbers agree", ran.stderr)


DICTIONARY = ("table,column,type,unit,meaning\r\ntrials,trial,text,,\r\ntrials,case,text,,\r\ntrials,days,number,d,\r\n"
              "trials,correct,truth,,\r\ntrials,rig,text,,\r\nprobing,t_s,number,s,\r\nprobing,x_m,number,m,\r\n")
# A pseudonym that a careless reader takes for a number, a title with a quote, a comma and a line break, and no value.
TRIALS = 'trial,case,days,correct,rig\r\n12e5,"L3 ""left"", \nsecond line",1.5,1,probing\r\n00ff,plain,0,,probing\r\n'
# Three people of a study: B is right 1 of 2 times, and in 1 of 1 with a breach; a trial of A does not count. Counted by hand.
STUDY = ("trial,participant,level,experience_years,case,simulated,counts,correct\r\n1,B,resident,0,Hard,1,1,0\r\n"
         "2,B,resident,0,Lateral breach,1,1,1\r\n3,A,senior,6,\"In, out and in again\",1,1,\r\n4,A,senior,6,Lateral breach,1,0,1\r\n"
         "5,C,fellow,0.33,Soft,1,1,1\r\n")
STUDY_DICTIONARY = "".join(f"trials,{column},{kind},,\r\n" for column, kind in (
    ("participant", "text"), ("level", "text"), ("experience_years", "number"), ("simulated", "truth"), ("counts", "truth")))
STUDY_TABLE = """participant level years recognised of breaches of
A senior 6 0 1 0 1
C fellow 0.33 1 1 0 0
B resident 0 1 2 1 1
"""
TITLE = 'L3 "left", \nsecond line'


def npy(rows):
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({len(rows)}, {len(rows[0])}), }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode() + b"".join(struct.pack(f"<{len(row)}d", *row) for row in rows)


def cohort_zip():
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as file:
        file.writestr("cohort.json", json.dumps({"format": "tractus-cohort/1", "tier": "full"}))
        file.writestr("dictionary.csv", DICTIONARY)
        file.writestr("trials.csv", TRIALS)
        file.writestr("summary.csv", "participant\r\n")
        file.writestr("scores.csv", "trial,score,value,unit\r\n")
        file.writestr("samples/12e5.npy", npy([(0.0, 1.0), (0.001, 2.0)]))
        file.writestr("padding", random.Random(3).randbytes(300_000))
    return out.getvalue()


class CuttingServer(http.server.ThreadingHTTPServer):
    """Answers as the export's routes do, and cuts an answer after `cut_bytes` as often as `cuts` says."""

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.content, self.cuts, self.cut_bytes, self.runs, self.tag = cohort_zip(), 0, 40_000, 0, None
        self.stopped, self.stopped_by = 0, None
        threading.Thread(target=self.serve_forever, daemon=True).start()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_address[1]}"


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def say(self, content, status=200, kind="application/json", **headers):
        self.send_response(status)
        for name, value in {"Content-Type": kind, "Content-Length": len(content), **headers}.items():
            self.send_header(name.replace("_", "-"), value)
        self.end_headers()
        if self.server.cuts > 0:
            self.server.cuts -= 1
            content = content[:min(self.server.cut_bytes, len(content) // 2)]
            self.close_connection = True
        self.wfile.write(content)

    def say_cohort(self):
        """Goes on from a byte for who names the tag of what is here (RFC 9110, 13.1.5 and 14.2)."""
        content, tag = self.server.content, self.server.tag
        tagged = {"ETag": tag} if tag else {}
        if tag is None or self.headers["If-Range"] != tag:
            return self.say(content, kind="application/zip", **tagged)
        first = int(self.headers["Range"].removeprefix("bytes=").removesuffix("-"))
        self.say(content[first:], 206, "application/zip", Content_Range=f"bytes {first}-{len(content) - 1}/{len(content)}", **tagged)

    def refuse(self, status, error, code):
        self.say(json.dumps({"error": error, "code": code}).encode(), status)

    def do_POST(self):
        if self.path == "/api/v1/cohort/analyses/abc/stop":
            self.server.stopped += 1
            return self.say(json.dumps({"id": "abc", "state": "cancelled"}).encode())
        asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        if asked.get("formula") == "correct ~ nothing":
            return self.refuse(400, "formula: there is no column nothing", "bad_input")
        self.server.runs = 3
        self.say(json.dumps({"id": "abc", "state": "queued"}).encode(), 201)

    def do_GET(self):
        server, path = self.server, self.path.removeprefix("/api/v1")
        if self.headers["Authorization"] != "Bearer tractus_good":
            return self.refuse(401, "the token is not valid", "unauthorised")
        if path == "/export/dictionary.csv":
            return self.say((DICTIONARY + STUDY_DICTIONARY).encode(), kind="text/csv")
        if path == "/export/trials.csv?study=demo-study":
            return self.say(STUDY.encode(), kind="text/csv")
        if path.startswith("/export/trials.csv"):
            return self.say(TRIALS.encode(), kind="text/csv")
        if path.startswith("/export/trials/12e5/"):
            return self.say(npy([(0.0, 1.0), (0.001, 2.0)]), kind="application/octet-stream")
        if path.startswith("/export/trials/"):
            return self.refuse(403, "the person consented to the tier metrics", "forbidden")
        if path == "/export/cohort.zip?tier=full":
            return self.say_cohort()
        if path.startswith("/export/cohort.zip"):
            return self.refuse(400, "tier: summary, metrics, reduced or full is expected", "bad_input")
        if path == "/cohort/analyses/abc" and server.stopped_by:
            return self.say(json.dumps({"id": "abc", "state": "cancelled", "error": f"stopped by {server.stopped_by}"}).encode())
        if path == "/cohort/analyses/abc":
            server.runs -= 1
            return self.say(json.dumps({"id": "abc", "state": "running" if server.runs else "done", "result": {"p": 0.5}}).encode())
        self.refuse(404, "no route of the API has this address", "not_found")


class AgainstACuttingServer(unittest.TestCase):
    def setUp(self):
        self.peer = CuttingServer()
        self.folder = tempfile.TemporaryDirectory()
        self.to = Path(self.folder.name) / "cohort.zip"
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(self.peer.server_close)
        self.addCleanup(self.peer.shutdown)
        self.server = Server(self.peer.url, token="tractus_good")

    def test_tables_keep_texts_and_numbers_apart(self):
        trials = self.server.trials()
        self.assertEqual(trials[0], {"trial": "12e5", "case": TITLE, "days": 1.5, "correct": True, "rig": "probing"})
        self.assertEqual(trials[1], {"trial": "00ff", "case": "plain", "days": 0.0, "correct": None, "rig": "probing"})
        self.assertEqual([row["trial"] for row in self.server.trials(case="plain")], ["00ff"])

    def test_the_stream_passes_over_who_did_not_consent(self):
        got = [(trial["trial"], len(samples)) for trial, samples in self.server.stream()]
        self.assertEqual(got, [("12e5", 2)])

    def test_a_cohort_is_there_when_it_is_whole(self):
        seen = []
        self.server.cohort(self.to, tier="full", progress=seen.append)
        self.assertEqual(self.to.read_bytes(), self.peer.content)
        self.assertEqual(seen[-1], 1.0)
        with read_cohort(self.to) as cohort:
            self.assertEqual(cohort.trials[0]["case"], TITLE)
            self.assertEqual([tuple(row) for row in cohort.samples("12e5")], [(0.0, 1.0), (0.001, 2.0)])
            with self.assertRaisesRegex(TractusError, "no samples"):
                cohort.samples("00ff")

    @unittest.skipUnless(h5py and shutil.which("h5dump"), "h5py or h5dump is not installed")
    def test_a_cohort_becomes_one_hdf5_file(self):
        """Read back by the HDF Group's own h5dump."""
        self.to.write_bytes(self.peer.content)
        to = self.to.with_suffix(".h5")
        with read_cohort(self.to) as cohort:
            cohort.write_hdf5(to)

        def dumped(*options):
            text = subprocess.run(["h5dump", *options, to], capture_output=True, text=True, check=True).stdout
            return " ".join(text.split())
        samples = dumped("-p", "-d", "/samples/12e5")
        self.assertIn("H5T_IEEE_F64LE DATASPACE SIMPLE { ( 2, 2 ) / ( 2, 2 ) } STORAGE_LAYOUT { CHUNKED ( 2, 2 )", samples)
        self.assertIn("DATA { (0,0): 0, 1, (1,0): 0.001, 2 }", samples)
        self.assertIn('(0): "t_s", "x_m"', samples)
        self.assertIn('(0): "s", "m"', samples)
        self.assertIn("DATA { (0): 1.5, 0 }", dumped("-d", "/trials/days"))
        self.assertIn('ATTRIBUTE "unit"', dumped("-d", "/trials/days"))
        self.assertIn("DATA { (0): 1, -1 }", dumped("-d", "/trials/correct"))
        self.assertIn('(0): "12e5", "00ff"', dumped("-d", "/trials/trial"))
        self.assertIn('(0): "tractus-cohort-hdf5/1"', dumped("-a", "/format"))

    def test_a_cut_answer_is_no_answer(self):
        self.peer.cuts = 1
        with self.assertRaisesRegex(TractusError, "broke after 40000 of [0-9]+ bytes"):
            self.server.cohort(self.to, tier="full")
        self.assertEqual(list(Path(self.folder.name).iterdir()), [])
        self.peer.cuts = 1
        with self.assertRaisesRegex(TractusError, "the connection broke"):
            self.server.samples("12e5")
        self.peer.cuts = 1
        with self.assertRaisesRegex(TractusError, "the connection broke"):
            self.server.trials()

    def test_a_cohort_goes_on_where_the_connection_broke(self):
        self.peer.tag, self.peer.cuts = '"one"', 3
        seen = []
        self.server.cohort(self.to, tier="full", progress=seen.append)
        self.assertEqual(self.to.read_bytes(), self.peer.content)
        self.assertEqual(seen, sorted(seen))  # nothing came twice
        self.assertEqual([path.name for path in Path(self.folder.name).iterdir()], ["cohort.zip"])

    def test_a_cohort_that_is_another_one_by_then_begins_anew(self):
        self.peer.tag, self.peer.cuts = '"one"', 1

        def is_another(_):
            self.peer.tag, self.peer.content = '"two"', bytes(reversed(self.peer.content))
        self.server.cohort(self.to, tier="full", progress=lambda share: is_another(share) if self.peer.tag == '"one"' else None)
        self.assertEqual(self.to.read_bytes(), self.peer.content)

    @unittest.skipUnless(has_r("jsonlite", "curl"), "R with jsonlite and curl is not installed")
    def test_r_goes_on_where_the_connection_broke(self):
        self.peer.tag, self.peer.cuts = '"one"', 3
        ran = run_r(f"""
tractus_cohort(tractus_server("{self.peer.url}", "tractus_good"), "{self.to}", tier = "full")
""")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(self.to.read_bytes(), self.peer.content)
        self.assertEqual([path.name for path in Path(self.folder.name).iterdir()], ["cohort.zip"])

    def test_an_analysis_is_awaited(self):
        self.assertEqual(self.server.analyse("anova", "correct ~ level")["result"], {"p": 0.5})
        with self.assertRaisesRegex(TractusError, "no column nothing"):
            self.server.analyse("anova", "correct ~ nothing")

    def test_an_analysis_that_another_stopped_says_who(self):
        self.peer.stopped_by = "fay"
        with self.assertRaisesRegex(TractusError, "^the analysis was stopped by fay$"):
            self.server.analyse("anova", "correct ~ level")

    @unittest.skipUnless(has_r("jsonlite", "curl"), "R with jsonlite and curl is not installed")
    def test_in_r_an_analysis_that_another_stopped_says_who(self):
        self.peer.stopped_by = "fay"
        ran = run_r(f'''
tractus_analyse(tractus_server("{self.peer.url}", "tractus_good"), "anova", "correct ~ level")
''')
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn("Error: the analysis was stopped by fay", ran.stderr)

    def test_an_analysis_ends_with_its_waiting(self):
        with unittest.mock.patch("tractus_client.server.time.sleep", side_effect=KeyboardInterrupt):
            with self.assertRaises(KeyboardInterrupt):
                self.server.analyse("anova", "correct ~ level")
        self.assertEqual(self.peer.stopped, 1)

    @unittest.skipUnless(has_r("jsonlite", "curl"), "R with jsonlite and curl is not installed")
    def test_in_r_an_analysis_ends_with_its_waiting(self):
        ran = run_r(f"""
server <- tractus_server("{self.peer.url}", "tractus_good")
Sys.sleep <- function(s) signalCondition(structure(class = c("interrupt", "condition"), list()))
tryCatch(tractus_analyse(server, "anova", "correct ~ level"), interrupt = function(condition) cat("interrupted"))
""")
        self.assertEqual((ran.returncode, ran.stdout), (0, "interrupted"), ran.stderr)
        self.assertEqual(self.peer.stopped, 1)

    def test_what_cannot_be_asked_is_said_in_words(self):
        with self.assertRaisesRegex(TractusError, "the token is not valid; .*make a new one"):
            Server(self.peer.url, token="tractus_bad").trials()
        with self.assertRaisesRegex(TractusError, "cannot be reached: .*refused"):
            Server("http://127.0.0.1:9", token="tractus_good").trials()
        with self.assertRaisesRegex(TractusError, "no token"):
            Server(self.peer.url, token=" ")
        with self.assertRaisesRegex(TractusError, "no token"):
            Server(self.peer.url, token="two\nlines")
        with self.assertRaisesRegex(TractusError, "https://"):
            Server("tractus.example", token="tractus_good")
        with self.assertRaisesRegex(TractusError, "not a cohort"):
            read_cohort(__file__)
        self.assertNotIn("tractus_good", repr(self.server))

    @unittest.skipUnless(has_r("jsonlite", "curl"), "R with jsonlite and curl is not installed")
    def test_r_does_the_same(self):
        ran = run_r(f"""
server <- tractus_server("{self.peer.url}", "tractus_good")
trials <- tractus_trials(server)
stopifnot(identical(trials$trial, c("12e5", "00ff")), trials$days == c(1.5, 0), is.na(trials$correct[2]))
stopifnot(identical(trials$case[1], "L3 \\"left\\", \\nsecond line"))
got <- tractus_each_trial(server, function(trial, samples) dim(samples))
stopifnot(identical(names(got), "12e5"), got[["12e5"]] == c(2, 2))
tractus_cohort(server, "{self.to}", tier = "full")
stopifnot(tractus_analyse(server, "anova", "correct ~ level")$result$p == 0.5)
cohort <- read_cohort("{self.to}")
stopifnot(identical(cohort$trials$case, trials$case), cohort$samples("12e5")[2, ] == c(0.001, 2))
for (wrong in list(quote(tractus_trials(tractus_server("{self.peer.url}", "tractus_bad"))), quote(tractus_server("tractus.example", "x")),
                   quote(tractus_server("{self.peer.url}", "")), quote(tractus_trials(tractus_server("http://127.0.0.1:9", "x"))),
                   quote(tractus_cohort(server, "{self.to}2", tier = "none")), quote(cohort$samples("00ff")), quote(read_cohort("{__file__}"))))
  cat(tryCatch(eval(wrong), error = conditionMessage), "\\n")
cat(capture.output(print(server)))
""")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(self.to.read_bytes(), self.peer.content)
        for words in ("tier: summary, metrics", "the token is not valid; ", "https://", "no token", "cannot be reached", "no samples", "not a cohort"):
            self.assertIn(words, ran.stdout)
        self.assertNotIn("tractus_good", ran.stdout)


class Documents(unittest.TestCase):
    """The notebook and the R Markdown of deploy/clients/notebooks, run against a study of the test's own."""

    def run_document(self, name):
        peer = CuttingServer()
        self.addCleanup(peer.server_close)
        self.addCleanup(peer.shutdown)
        clients = ROOT / "deploy/clients"
        return subprocess.run([sys.executable, "-B", ROOT / "tests/clients/run_document.py", clients / "notebooks" / name, clients],
                              env={**os.environ, "TRACTUS_URL": peer.url, "TRACTUS_TOKEN": "tractus_good"},
                              capture_output=True, text=True, timeout=120)

    def test_the_notebook_counts_as_by_hand(self):
        ran = self.run_document("twelve_trials.ipynb")
        self.assertEqual(ran.stdout, STUDY_TABLE, ran.stderr)

    @unittest.skipUnless(has_r("jsonlite", "curl"), "R with jsonlite and curl is not installed")
    def test_the_r_markdown_counts_as_by_hand(self):
        ran = self.run_document("twelve_trials.Rmd")
        self.assertEqual(ran.stdout, STUDY_TABLE, ran.stderr)


class Packages(unittest.TestCase):
    def test_pip_installs_the_package(self):
        python = next((p for p in (sys.executable, shutil.which("python3")) if p and subprocess.run(
            [p, "-c", "import pip, setuptools, wheel"], capture_output=True).returncode == 0), None)
        if not python:
            self.skipTest("pip, setuptools and wheel are not installed")
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder) / "source"  # pip builds beside the sources
            shutil.copytree(ROOT / "deploy/clients/python", source)
            ran = subprocess.run([python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--no-build-isolation",
                                  "--disable-pip-version-check", "--target", f"{folder}/site", source], capture_output=True, text=True)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            said = subprocess.run([python, "-c", "import tractus_client; print(tractus_client.__file__)"], cwd=folder,
                                  env={"PYTHONPATH": f"{folder}/site"}, capture_output=True, text=True)
            self.assertTrue(said.stdout.startswith(f"{folder}/site"), said.stdout + said.stderr)

    @unittest.skipUnless(has_r("jsonlite", "curl"), "R with jsonlite and curl is not installed")
    def test_r_installs_the_package(self):
        with tempfile.TemporaryDirectory() as folder:
            ran = subprocess.run(["R", "CMD", "INSTALL", "--no-docs", f"--library={folder}", ROOT / "deploy/clients/r"], capture_output=True, text=True)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            said = subprocess.run(["Rscript", "-e", f'library(tractus, lib.loc = "{folder}"); cat(is.function(read_ttrial))'],
                                  capture_output=True, text=True)
            self.assertEqual(said.stdout, "TRUE", said.stderr)


if __name__ == "__main__":
    unittest.main()
