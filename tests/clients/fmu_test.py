#!/usr/bin/env python3
"""Models exported as FMUs, run by an importer of this test's own (ctypes, after FMI 2.0.5) and in Octave, against `tractus replay`.

    tests/clients/fmu_test.py --bin build/release/bin
"""
import argparse
import csv
import ctypes
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
CLOSE = 1e-9  # of the largest force of the recording

LAYERS = [{"start_m": 0.0, "thickness_m": 0.048, "stiffness_N_per_m": 90.0, "damping_Ns_per_m": 60.0, "equilibrium_m": 0.04},
          {"start_m": 0.048, "thickness_m": 0.05, "stiffness_N_per_m": 220.0, "damping_Ns_per_m": 35.0, "equilibrium_m": 0.03}]


def model(name, effects, layers=LAYERS):
    return {"format": "tractus-model/1", "rig": "probing", "name": name, "base": {"layers": layers},
            "effects": [{"id": key, "parameters": values} for key, values in effects.items()]}


REMEMBERS = model('play, "hysteresis" & <delay>', {
    "backlash": {"gap_m": 3e-4, "damping_share": 1.0}, "hysteresis": {"stiffness_N_per_m": 2e4, "yield_displacement_m": 2e-4},
    "viscoelastic_relaxation": {"stiffness_N_per_m": 80.0, "time_constant_s": 0.3},
    "stribeck_friction": {"friction_N": 4.0, "breakaway_N": 6.0, "stribeck_velocity_m_s": 0.01},
    "bouc_wen": {"stiffness_N_per_m": 3e3, "yield_displacement_m": 5e-4, "shape": 0.5}, "inertia": {"mass_kg": 0.4},
    "time_delay": {"delay_s": 0.0137}, "sensor_drift": {"range_N": 0.3}})
TURNS = model("turning", {
    "rotation_coupling": {"coefficient_s_per_rad": 0.2}, "coulomb_friction": {"friction_N": 2.0}, "torque_crosstalk": {"coefficient_per_m": 5.0},
    "rotary_coulomb_friction": {"torque_Nm": 0.01}, "rotary_bias": {"torque_Nm": 0.002}, "time_delay": {"delay_s": 0.004}})
FORMULA = model("formula", {"hysteresis": {"stiffness_N_per_m": 2e4, "yield_displacement_m": 2e-4}})
FORMULA["effects"].append({"id": "expression:drag", "parameters": {"c": 40.0, "d": 3e-4}, "expression": {
    "format": "tractus-effect/1", "id": "expression:drag", "rig": "probing", "adds_to": "fz_N",
    "formula": "c * v_m_s * (1 + dahl(x_m, d) / d) + 0.1 * base_N * sign(v_m_s)",
    "parameters": {"c": {"unit": "N*s/m", "initial": 1, "low": 0, "high": 100}, "d": {"unit": "m", "initial": 1e-3, "low": 1e-6, "high": 1}}}})
PLAIN = model("plain", {"hysteresis": {"stiffness_N_per_m": 2e4, "yield_displacement_m": 2e-4}})


def tractus(*words, expect=0):
    ran = subprocess.run([BIN / "tractus", *map(str, words)], capture_output=True, text=True, timeout=120)
    if ran.returncode != expect:
        raise AssertionError(f"tractus {words}: {ran.returncode}\n{ran.stdout}{ran.stderr}")
    return ran.stderr if expect else ran.stdout


def table(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}


LOGGER = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p)


class Callbacks(ctypes.Structure):
    _fields_ = [("logger", LOGGER), ("allocate", ctypes.c_void_p), ("release", ctypes.c_void_p), ("finished", ctypes.c_void_p),
                ("environment", ctypes.c_void_p)]


class Fmu:
    """An unpacked FMU and its functions."""

    def __init__(self, path, folder):
        self.folder = Path(folder)
        with zipfile.ZipFile(path) as file:
            file.extractall(self.folder)
        self.description = xml.etree.ElementTree.parse(self.folder / "modelDescription.xml").getroot()
        self.guid = self.description.get("guid")
        self.references = {v.get("name"): int(v.get("valueReference")) for v in self.description.find("ModelVariables")}
        self.inputs = [v.get("name") for v in self.description.find("ModelVariables") if v.get("causality") == "input"]
        name = self.description.find("CoSimulation").get("modelIdentifier")
        self.library = ctypes.CDLL(str(self.folder / f"binaries/linux64/{name}.so"))
        self.library.fmi2Instantiate.restype = ctypes.c_void_p

    def instance(self, **others):
        return Instance(self, **others)


class Instance:
    def __init__(self, fmu, guid=None, resources=None, kind=1):
        self.fmu, self.said = fmu, []
        self.callbacks = Callbacks(LOGGER(lambda *words: self.said.append((words[4] % words[5]).decode())))
        address = (resources or fmu.folder / "resources").as_uri()
        self.component = ctypes.c_void_p(fmu.library.fmi2Instantiate(
            b"one", kind, (guid or fmu.guid).encode(), address.encode(), ctypes.byref(self.callbacks), 0, 1))

    def call(self, name, *words):
        return getattr(self.fmu.library, name)(self.component, *words)

    def do(self, name, *words):
        status = self.call(name, *words)
        if status != 0:
            raise AssertionError(f"{name}: status {status}: {self.said}")

    def setup(self, start_s, stop_s=None):
        self.do("fmi2SetupExperiment", 0, ctypes.c_double(0.0), ctypes.c_double(start_s), int(stop_s is not None), ctypes.c_double(stop_s or 0.0))

    def references(self, names):
        return (ctypes.c_uint * len(names))(*[self.fmu.references[name] for name in names]), ctypes.c_size_t(len(names))

    def set(self, **values):
        return self.call("fmi2SetReal", *self.references(list(values)), (ctypes.c_double * len(values))(*values.values()))

    def slopes(self, **values):
        ones = (ctypes.c_int * len(values))(*[1] * len(values))
        return self.call("fmi2SetRealInputDerivatives", *self.references(list(values)), ones, (ctypes.c_double * len(values))(*values.values()))

    def get(self, *names):
        out = (ctypes.c_double * len(names))()
        self.do("fmi2GetReal", *self.references(names), out)
        return list(out)

    def step(self, t_s, length_s):
        return self.call("fmi2DoStep", ctypes.c_double(t_s), ctypes.c_double(length_s), 1)

    def start(self, motion):
        self.setup(motion["t_s"][0], motion["t_s"][-1])
        self.do("fmi2EnterInitializationMode")
        self.set(**row_of(motion, 0))
        self.do("fmi2ExitInitializationMode")

    def run(self, motion):
        """Force and torque at each row."""
        self.start(motion)
        return list(self.rows(motion))

    def rows(self, motion, first=0):
        t = motion["t_s"]
        for k in range(first, len(t)):
            self.set(**row_of(motion, k))
            yield self.get("fz_N", "tz_Nm")
            if k + 1 < len(t) and self.step(t[k], t[k + 1] - t[k]) != 0:
                raise AssertionError(self.said)

    def free(self):
        self.call("fmi2FreeInstance")


def row_of(motion, k):
    return {name: values[k] for name, values in motion.items() if name != "t_s"}


def largest_difference(found, wanted):
    """Of the largest wanted."""
    return max(abs(a - b) for a, b in zip(found, wanted, strict=True)) / max(map(abs, wanted))


class Exported(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def export(self, content, name="bone"):
        (self.folder / f"{name}.json").write_text(json.dumps(content))
        tractus("fmu", self.folder / f"{name}.json", "--out", self.folder / f"{name}.fmu")
        return Fmu(self.folder / f"{name}.fmu", self.folder / f"{name} of 100 %20")  # as a URI it has codes in it

    def replay(self, recordings, name="bone"):
        """The smoothed motion and the simulated forces of each trial."""
        out = self.folder / f"{name}-replayed"
        tractus("replay", "--model", self.folder / f"{name}.json", "--measurements", recordings, "--out", out)
        return [(table(path), table(out / "trials" / path.name)) for path in sorted((out / "motion").glob("*.csv"))]

    def simulated_set(self):
        """SIMULATED: sines in closed form, turning while it goes in and out, at 500 Hz for 4 s; forces that no law gives."""
        folder = self.folder / "set"
        folder.mkdir()
        with open(folder / "t.csv", "w") as file:
            file.write("t_s,x_m,theta_rad,fz_N,tz_Nm\n")
            for k in range(2000):
                t = k / 500
                file.write(f"{t},{0.05 + 0.008 * math.sin(3 * t)},{2 * math.sin(t)},{3 * math.sin(5 * t)},{0.05 * math.cos(2 * t)}\n")
        (folder / "set.json").write_text(json.dumps({"format": "tractus-measurements/1", "rig": "probing", "simulated": True,
                                                     "trials": [{"id": "t", "file": "t.csv"}]}))
        return folder


class AgainstReplay(Exported):
    def test_forces_agree_over_shipped_recordings_with_effects_that_remember(self):
        fmu, compared = self.export(REMEMBERS), 0
        for motion, wanted in self.replay(ROOT / "tests/data/force/friction_damper_ccbysa/damper"):
            instance = fmu.instance()
            found = [row[0] for row in instance.run(motion)]
            instance.free()
            self.assertLess(largest_difference(found, wanted["fz_N"]), CLOSE)
            compared += len(found)
        self.assertGreater(compared, 20000)

    def test_torques_agree_over_a_shipped_recording(self):
        fmu = self.export(TURNS)
        for motion, wanted in self.replay(ROOT / "tests/data/force/cable_tool_odbl/turning/light_slow"):
            found = [row[1] for row in fmu.instance().run(motion)]
            self.assertLess(largest_difference(found, wanted["tz_Nm"]), CLOSE)

    def test_force_and_torque_agree_while_the_probe_turns(self):
        fmu = self.export(TURNS)
        [(motion, wanted)] = self.replay(self.simulated_set())
        found = fmu.instance().run(motion)
        self.assertLess(largest_difference([row[0] for row in found], wanted["fz_N"]), CLOSE)
        self.assertLess(largest_difference([row[1] for row in found], wanted["tz_Nm"]), CLOSE)

    def test_a_formula_of_a_user_that_remembers_agrees(self):
        fmu = self.export(FORMULA)
        [(motion, wanted)] = self.replay(self.simulated_set())
        self.assertLess(largest_difference([row[0] for row in fmu.instance().run(motion)], wanted["fz_N"]), CLOSE)
        instance = fmu.instance()
        instance.set(**{"effects.'expression:drag'.c": 0.0})
        self.assertGreater(largest_difference([row[0] for row in instance.run(motion)], wanted["fz_N"]), 0.01)

    def test_other_parameters_are_those_of_another_model(self):
        fmu = self.export(PLAIN)
        other = json.loads(json.dumps(PLAIN))
        other["base"]["layers"][0]["stiffness_N_per_m"] = 45.0
        other["effects"][0]["parameters"]["yield_displacement_m"] = 1e-3
        self.export(other, "other")
        [(motion, wanted)] = self.replay(self.simulated_set(), "other")
        instance = fmu.instance()
        self.assertEqual(instance.set(**{"layers[1].stiffness_N_per_m": 45.0, "effects.hysteresis.yield_displacement_m": 1e-3}), 0)
        self.assertLess(largest_difference([row[0] for row in instance.run(motion)], wanted["fz_N"]), CLOSE)

    def test_instances_run_beside_each_other_and_begin_anew(self):
        fmu, another = self.export(REMEMBERS), self.export(TURNS, "turns")
        [(motion, wanted)] = self.replay(self.simulated_set())
        one, two, three = fmu.instance(), fmu.instance(), another.instance()
        for instance in (one, two, three):
            instance.start(motion)
        beside = [rows for rows in zip(one.rows(motion), two.rows(motion), three.rows(motion))]
        self.assertLess(largest_difference([a[0] for a, _, _ in beside], wanted["fz_N"]), CLOSE)
        self.assertEqual([a for a, _, _ in beside], [b for _, b, _ in beside])
        self.assertNotEqual([a for a, _, _ in beside], [c for _, _, c in beside])
        one.do("fmi2Reset")
        self.assertEqual(one.run(motion), [a for a, _, _ in beside])

    def test_a_kept_state_goes_on_from_there(self):
        fmu = self.export(REMEMBERS)
        [(motion, _)] = self.replay(self.simulated_set())
        instance, state = fmu.instance(), ctypes.c_void_p()
        instance.start(motion)
        rows = instance.rows(motion)
        for _ in range(700):
            next(rows)
        rest = [next(rows)]  # the generator steps when it is asked for the next row: row 701 is at hand, step 701 is not made
        instance.do("fmi2GetFMUstate", ctypes.byref(state))
        rest += list(rows)
        instance.do("fmi2SetFMUstate", state)
        self.assertEqual(list(instance.rows(motion, 700)), rest)
        instance.do("fmi2FreeFMUstate", ctypes.byref(state))
        self.assertIsNone(state.value)

    def test_inputs_go_on_with_their_derivatives(self):
        """An importer that sets inputs and slopes before a step, and reads after it, sees the forces of the step's end."""
        fmu = self.export(REMEMBERS)
        [(motion, wanted)] = self.replay(self.simulated_set())
        instance, t, found = fmu.instance(), motion["t_s"], []
        instance.start(motion)
        for k in range(len(t) - 1):
            here, there = row_of(motion, k), row_of(motion, k + 1)
            self.assertEqual(instance.set(**here), 0)
            self.assertEqual(instance.slopes(**{name: (there[name] - here[name]) / (t[k + 1] - t[k]) for name in here}), 0)
            self.assertEqual(instance.step(t[k], t[k + 1] - t[k]), 0)
            found.append(instance.get("fz_N")[0])
        self.assertLess(largest_difference(found, wanted["fz_N"][1:]), CLOSE)


class Refusals(Exported):
    """Status 3 is fmi2Error."""

    def refused(self, instance, status, words):
        self.assertEqual(status, 3)
        self.assertRegex(instance.said[-1], words)

    def test_what_is_no_number_or_no_time_is_refused_and_changes_nothing(self):
        fmu = self.export(PLAIN)
        [(motion, wanted)] = self.replay(self.simulated_set())
        instance, found = fmu.instance(), []
        self.refused(instance, instance.step(0.0, 0.001), "fmi2DoStep is not allowed while the model is instantiated")
        self.refused(instance, instance.call("fmi2SetupExperiment", 0, ctypes.c_double(0), ctypes.c_double(math.nan), 0, ctypes.c_double(0)), "numbers")
        instance.start(motion)
        for row in instance.rows(motion):
            found.append(row[0])
            if len(found) == 1000:
                t = motion["t_s"][999]
                for value in (math.nan, math.inf, -math.inf):
                    self.refused(instance, instance.set(v_m_s=1.0, x_m=value), "x_m: .*nan|inf")
                self.refused(instance, instance.set(rest_m_s=-1.0), "rest_m_s: -1 where a number in 0")
                self.refused(instance, instance.set(fz_N=1.0), "fz_N: an output")
                self.refused(instance, instance.set(**{"rotary.detent_Nm": 0.1}), "rotary.detent_Nm: a parameter is fixed")
                self.refused(instance, instance.slopes(x_m=math.nan), "a first derivative")
                for length in (-0.001, 0.0, math.nan, math.inf):
                    self.refused(instance, instance.step(t, length), "a step of")
                self.refused(instance, instance.step(t + 0.5, 0.001), "but the model is at")
                self.refused(instance, instance.call("fmi2GetReal", (ctypes.c_uint * 1)(9999), ctypes.c_size_t(1), (ctypes.c_double * 1)()), "9999")
                self.refused(instance, instance.call("fmi2SetReal", None, ctypes.c_size_t(1), None), "null")
                self.refused(instance, instance.call("fmi2GetInteger", (ctypes.c_uint * 1)(0), ctypes.c_size_t(1), (ctypes.c_int * 1)()), "nothing of the kind")
        self.assertLess(largest_difference(found, wanted["fz_N"]), CLOSE)
        instance.set(x_m=0.02, v_m_s=1e308)  # times 60 N·s/m is beyond a double
        self.refused(instance, instance.call("fmi2GetReal", (ctypes.c_uint * 1)(fmu.references["fz_N"]), ctypes.c_size_t(1), (ctypes.c_double * 1)()),
                     "beyond all measure")

    def test_a_model_that_cannot_run_says_why(self):
        fmu = self.export(REMEMBERS)
        instance = fmu.instance()
        instance.setup(0.0)
        instance.do("fmi2EnterInitializationMode")
        self.refused(instance, instance.call("fmi2ExitInitializationMode"), "sensor_drift runs over the whole trial")
        instance = fmu.instance()
        self.refused(instance, instance.set(**{"effects.hysteresis.yield_displacement_m": 1.0}), "yield_displacement_m: 1 where a number in 1e-06")
        self.assertEqual(instance.set(**{"layers[2].start_m": 0.01}), 0)
        instance.setup(0.0, 1.0)
        instance.do("fmi2EnterInitializationMode")
        self.refused(instance, instance.call("fmi2ExitInitializationMode"), "lies inside the layer before it")

    def test_damaged_and_missing_files_give_no_instance(self):
        fmu = self.export(PLAIN)
        carried = fmu.folder / "resources/model.json"
        whole = carried.read_bytes()

        def said(**others):
            instance = fmu.instance(**others)
            self.assertIsNone(instance.component.value)
            return instance.said[-1]
        self.assertRegex(said(kind=0), "not for model exchange")
        self.assertRegex(said(guid="{other}"), "of another model than guid {other}")
        self.assertRegex(said(resources=fmu.folder / "none"), "none/model.json: .*")
        for content in (b"", whole[:-40], whole.replace(b"90.0", b"91.0"), b"\xff" * 1000, b"[" * 100000):
            self.assertNotEqual(content, whole)
            carried.write_bytes(content)
            self.assertRegex(said(), "changed since the export")
        carried.unlink()
        carried.mkdir()
        self.assertRegex(said(), "model.json")

    def test_what_an_fmu_cannot_do_is_refused_at_the_export(self):
        palpation = {"format": "tractus-model/1", "rig": "palpation", "name": "p", "base": {}, "effects": []}
        for content, words in ((palpation, "palpation rig"), ({"format": "x"}, "format")):
            (self.folder / "m.json").write_text(json.dumps(content))
            said = tractus("fmu", self.folder / "m.json", "--out", self.folder / "m.fmu", expect=2)
            self.assertRegex(said, words)
            self.assertEqual(said.count("\n"), 1)
            self.assertFalse((self.folder / "m.fmu").exists())
        self.assertRegex(tractus("fmu", self.folder / "none.json", "--out", self.folder / "m.fmu", expect=2), "none.json")
        self.export(PLAIN)
        self.assertRegex(tractus("fmu", self.folder / "bone.json", "--out", self.folder / "nowhere/m.fmu", expect=2), "nowhere")


class Contents(Exported):
    def test_the_same_model_gives_the_same_file(self):
        self.export(REMEMBERS)
        shutil.copy(self.folder / "bone.json", self.folder / "again.json")
        tractus("fmu", self.folder / "again.json", "--out", self.folder / "again.fmu")
        self.assertEqual((self.folder / "bone.fmu").read_bytes(), (self.folder / "again.fmu").read_bytes())

    def test_the_description_names_every_number_with_unit_and_start(self):
        fmu = self.export(REMEMBERS)
        self.assertEqual(fmu.description.get("modelName"), REMEMBERS["name"])
        variables = {v.get("name"): v for v in fmu.description.find("ModelVariables")}
        units = {u.get("name"): u.find("BaseUnit").attrib for u in fmu.description.find("UnitDefinitions")}
        numbers = {f"effects.{e['id']}.{key}": value for e in REMEMBERS["effects"] for key, value in e["parameters"].items()}
        numbers |= {f"layers[{k + 1}].{key}": value for k, layer in enumerate(LAYERS) for key, value in layer.items()}
        for name, value in numbers.items():
            real = variables[name].find("Real")
            self.assertEqual(float(real.get("start")), value, name)
            self.assertTrue(variables[name].get("description"), name)
            self.assertEqual(variables[name].get("variability"), "fixed")
        stiffness = variables["layers[1].stiffness_N_per_m"].find("Real").get("unit")
        self.assertEqual(units[stiffness], {"kg": "1", "s": "-2"})  # N/m = kg/s²
        self.assertEqual(units["N·s/m"], {"kg": "1", "s": "-1"})
        self.assertEqual(units["N·m·s/rad"], {"kg": "1", "m": "2", "s": "-1", "rad": "-1"})
        self.assertEqual(units[variables["a_m_s2"].find("Real").get("unit")], {"m": "1", "s": "-2"})
        self.assertEqual(units["rad/s"], {"s": "-1", "rad": "1"})

    def test_a_number_without_a_meaning_is_described_by_its_effect_alone(self):
        descriptions = [v.get("description") or "" for v in self.export(FORMULA).description.find("ModelVariables")]
        self.assertEqual([text for text in descriptions if text == "" or text != text.strip(" :")], [])

    def test_the_shared_object_needs_the_c_library_alone_and_shows_fmi_alone(self):
        fmu = self.export(PLAIN)
        path = fmu.folder / "binaries/linux64/tractus_model.so"
        needed = re.findall(r"NEEDED.*\[(.*)\]", subprocess.run(["readelf", "-d", path], capture_output=True, text=True, check=True).stdout)
        self.assertLessEqual(set(needed), {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"})
        shown = subprocess.run(["nm", "-D", "--defined-only", path], capture_output=True, text=True, check=True).stdout.split("\n")
        names = {line.split()[2] for line in shown if line}
        self.assertEqual({name for name in names if not name.startswith("fmi2")}, set())
        # FMI 2.0.5, sections 2.1 and 4.2: what a slave exports.
        self.assertLessEqual({"fmi2" + word for word in (
            "GetTypesPlatform GetVersion SetDebugLogging Instantiate FreeInstance SetupExperiment EnterInitializationMode ExitInitializationMode "
            "Terminate Reset GetReal GetInteger GetBoolean GetString SetReal SetInteger SetBoolean SetString GetFMUstate SetFMUstate FreeFMUstate "
            "SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate GetDirectionalDerivative SetRealInputDerivatives GetRealOutputDerivatives "
            "DoStep CancelStep GetStatus GetRealStatus GetIntegerStatus GetBooleanStatus GetStringStatus").split()}, names)


@unittest.skipUnless(shutil.which("octave-cli") and shutil.which("mkoctfile"), "Octave with liboctave-dev is not installed")
class InOctave(Exported):
    def octave(self, program):
        scripts = self.folder / "matlab"
        if not scripts.exists():
            shutil.copytree(ROOT / "deploy/clients/matlab", scripts)
        ran = subprocess.run(["octave-cli", "--quiet", "--norc", "--eval", f"cd('{self.folder}'); addpath('{scripts}');\n{program}"],
                             capture_output=True, text=True, timeout=240)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        return ran.stdout

    def test_forces_agree_with_replay_and_wrong_use_is_refused_in_words(self):
        self.export(TURNS)
        [(_, wanted)] = self.replay(self.simulated_set())
        said = self.octave("""
read = importdata('bone-replayed/motion/t.csv', ',', 1);
motion = cell2struct(num2cell(read.data, 1), read.colheaders, 2);
forces = tractus_model('bone.fmu', motion);
dlmwrite('octave.csv', [forces.fz_N forces.tz_Nm], 'precision', '%.17g');
other = tractus_model('bone.fmu', motion, {'effects.coulomb_friction.friction_N', 20});
printf('%d\\n', max(abs(other.fz_N - forces.fz_N)) > 10);
model = tractus_model('bone.fmu');
found = model(strcmp({model.name}, 'layers[1].damping_Ns_per_m'));
printf('%s %g %s\\n', found.unit, found.start, found.causality);
derived = tractus_model('bone.fmu', struct('t_s', motion.t_s, 'x_m', motion.x_m));
given = tractus_model('bone.fmu', struct('t_s', motion.t_s, 'x_m', motion.x_m, 'v_m_s', motion.v_m_s));
printf('%d\\n', max(abs(derived.fz_N - given.fz_N)) < 0.05 * max(abs(given.fz_N)));
for wrong = {@() tractus_model('none.fmu'), @() tractus_model('bone.fmu', struct('x_m', 1)), ...
             @() tractus_model('bone.fmu', struct('t_s', [0 1]', 'depth', [0 1]')), ...
             @() tractus_model('bone.fmu', struct('t_s', [0 1]', 'x_m', [0 1 2]')), ...
             @() tractus_model('bone.fmu', struct('t_s', [0 1]', 'x_m', [0 NaN]')), ...
             @() tractus_model('bone.fmu', struct('t_s', [1 0]', 'x_m', [0 0]')), ...
             @() tractus_model('bone.fmu', struct('t_s', [0 1]'), {'mass', 1}), ...
             @() tractus_model('bone.fmu', struct('t_s', [0 1]'), {'rotary.detent_Nm', -1})}
  try
    wrong{1}();
    disp('not refused');
  catch refusal
    disp(refusal.message);
  end
end
""")
        with open(self.folder / "octave.csv") as file:
            rows = [[float(cell) for cell in row] for row in csv.reader(file)]
        self.assertLess(largest_difference([row[0] for row in rows], wanted["fz_N"]), CLOSE)
        self.assertLess(largest_difference([row[1] for row in rows], wanted["tz_Nm"]), CLOSE)
        lines = said.splitlines()
        self.assertEqual(lines[:3], ["1", "N·s/m 60 parameter", "1"])
        for line, words in zip(lines[3:], ("none.fmu: no such file", "the column t_s", "motion.depth: the model has no such input", "3 rows where t_s has 2",
                                           "v_m_s: nan", "a step of -1 s|stop after the start", "mass: the model has no such parameter",
                                           "rotary/detent_Nm: -1 is outside"), strict=True):
            self.assertRegex(line, words)


if __name__ == "__main__":
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("--bin", type=Path, default=BIN, help="folder with the program tractus")
    options, rest = reader.parse_known_args()
    BIN = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])
