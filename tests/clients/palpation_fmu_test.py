#!/usr/bin/env python3
"""Models of the palpation rig exported as FMUs with the part of the volume that they reach, run by the importer of fmu_test.py and in
Octave, against `tractus replay`.

    tests/clients/palpation_fmu_test.py --bin build/release/bin
"""
import argparse
import csv
import ctypes
import json
import math
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import fmu_test
from fmu_test import CLOSE, ROOT, Exported, largest_difference, row_of, tractus

OUTPUTS = ("fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm", "deflection_x_m", "deflection_y_m", "converged")
# Of every stage at which an effect acts, numbers within what a search finds.
EFFECTS = {"contact_friction": {"coefficient": 0.2, "bends_shank": 0.5}, "contact_damping": {"damping_Ns_per_m": 5.0, "bends_shank": 1.0},
           "contact_hysteresis": {"loss": 0.15}, "contact_nonlinearity": {"exponent": 1.1, "reference_gradient_per_m": 500.0},
           "pose_offset": {"offset_m": [2e-4, -1e-4, 1e-4]}, "probe_inertia": {"mass_kg": 0.02, "centre_m": 0.05},
           "probe_weight": {"mass_kg": 0.03, "centre_m": 0.04}, "sensor_bias": {"force_N": [0.1, -0.2, 0.05], "torque_Nm": [0.001, 0.002, -0.003]},
           "shank_curvature": {"bow_m": 5e-4, "direction_rad": 0.4}, "time_delay": {"delay_s": 0.0137}, "tip_ball": {"radius_m": 7e-4}}


class Palpation(Exported):
    def setUp(self):
        super().setUp()
        self.set = self.folder / "set"

    def make_set(self, *options):
        """SIMULATED: strokes in a drilled block of porous bone, oblique and off the origin, at 100 Hz, 4 kHz, 100 Hz and 1 kHz."""
        subprocess.run(["/usr/bin/python3", "-B", ROOT / "tests/golden/palpation/make_set.py", self.set, "--seconds", "0.8", "--trials", "4", *options],
                       check=True, timeout=120)
        return json.loads((self.set / "model.json").read_text())

    def model(self, *options, effects=None):
        content = self.make_set(*options)
        content["effects"] = [{"id": key, "parameters": values} for key, values in (effects or {}).items()]
        return content

    def write(self, content, name="bone"):
        (self.folder / f"{name}.json").write_text(json.dumps(content))
        return self.folder / f"{name}.json"

    def exported(self, content, *options, name="bone"):
        path = self.write(content, name)
        said = tractus("fmu", path, "--out", path.with_suffix(".fmu"), "--measurements", self.set, *options)
        return fmu_test.Fmu(path.with_suffix(".fmu"), self.folder / f"{name} of 100 %20"), said

    def rows(self, instance, motion, first=0):
        t = motion["t_s"]
        for k in range(first, len(t)):
            self.assertEqual(instance.set(**row_of(motion, k)), 0, instance.said)
            yield instance.get(*OUTPUTS)
            if k + 1 < len(t):
                self.assertEqual(instance.step(t[k], t[k + 1] - t[k]), 0, instance.said)

    def run_over(self, instance, motion):
        instance.start(motion)
        return list(self.rows(instance, motion))

    def agree(self, found, wanted):
        """Each channel to 1e-9 of the largest force, torque or deflection."""
        scales = {"_N": max(abs(v) for c in ("fx_N", "fy_N", "fz_N") for v in wanted[c]),
                  "_Nm": max(abs(v) for c in ("tx_Nm", "ty_Nm", "tz_Nm") for v in wanted[c]),
                  "_m": max(abs(v) for c in ("deflection_x_m", "deflection_y_m") for v in wanted[c]), "converged": 1.0}
        self.assertGreater(scales["_N"], 0.1)
        for k, name in enumerate(OUTPUTS):
            scale = next(value for suffix, value in scales.items() if name.endswith(suffix))
            worst = max(abs(row[k] - value) for row, value in zip(found, wanted[name], strict=True))
            self.assertLess(worst / scale, CLOSE, name)


class AgainstReplay(Palpation):
    def compare(self, content, *options):
        fmu, _ = self.exported(content, *options)
        replayed = self.replay(self.set)
        self.assertEqual(len(replayed), 4)
        for motion, wanted in replayed:
            instance = fmu.instance()
            self.agree(self.run_over(instance, motion), wanted)
            instance.free()

    def test_the_published_law_agrees_on_both_fields(self):
        self.compare(self.model())
        shutil.rmtree(self.set)
        shutil.rmtree(self.folder / "bone-replayed")
        shutil.rmtree(self.folder / "bone of 100 %20")
        self.compare(self.model("--field", "potential"))

    def test_forces_agree_with_effects_of_every_stage(self):
        self.compare(self.model(effects=EFFECTS))

    def test_a_fitted_model_agrees(self):
        start, fitted = self.write(self.model("--measured"), "start"), self.folder / "bone.json"
        tractus("fit", "--model", start, "--measurements", self.set, "--add", "contact_friction", "--add", "sensor_bias", "--out", fitted)
        content = json.loads(fitted.read_text())
        self.assertEqual({effect["id"] for effect in content["effects"]}, {"contact_friction", "sensor_bias"})
        self.assertNotEqual(content["base"]["radius_m"], 7e-4)
        self.compare(content)

    def test_each_effect_alone_agrees_with_a_set_that_says_where_down_is(self):
        content = self.make_set()
        index = json.loads((self.set / "set.json").read_text())
        index["down"] = [0.3, -2.0, 0.4]  # of any length
        index["trials"] = index["trials"][1:2]
        (self.set / "set.json").write_text(json.dumps(index))
        plain = None
        for key, values in {"none": {}, **EFFECTS, "shank_taper": {"tip_radius_m": 5e-4, "handle_radius_m": 9e-4}}.items():
            content["effects"] = [] if key == "none" else [{"id": key, "parameters": values}]
            fmu, _ = self.exported(content, name=key)
            self.write(content, key)
            [(motion, wanted)] = self.replay(self.set, key)
            found = self.run_over(fmu.instance(), motion)
            self.agree(found, wanted)
            plain = plain or found
            if key != "none":
                self.assertGreater(max(abs(a[k] - b[k]) for a, b in zip(found, plain) for k in range(3)), 1e-3, key)

    def test_a_formula_of_a_user_agrees(self):
        content = self.make_set()
        content["effects"] = [{"id": "expression:drag", "parameters": {"c": 4.0}, "expression": {
            "format": "tractus-effect/1", "id": "expression:drag", "rig": "palpation", "adds_to": "f_N", "formula": "c * v_m_s * opacity",
            "parameters": {"c": {"unit": "N*s/m", "initial": 1, "low": 0, "high": 100}}}}]
        self.compare(content)

    def test_other_parameters_are_those_of_another_model(self):
        content = self.model(effects={"contact_friction": EFFECTS["contact_friction"]})
        fmu, _ = self.exported(content)
        content["base"] |= {"radius_m": 8e-4, "force_factor_Nm": 0.004, "pose_offset_m": [1e-4, 0, -2e-4]}
        content["effects"][0]["parameters"]["coefficient"] = 0.4
        self.write(content, "other")
        motion, wanted = self.replay(self.set, "other")[1]
        instance = fmu.instance()
        self.assertEqual(instance.set(**{"base.radius_m": 8e-4, "base.force_factor_Nm": 0.004, "base.pose_offset_m[1]": 1e-4,
                                         "base.pose_offset_m[3]": -2e-4, "effects.contact_friction.coefficient": 0.4}), 0)
        self.agree(self.run_over(instance, motion), wanted)

    def test_instances_run_beside_each_other_and_a_kept_state_goes_on(self):
        fmu, _ = self.exported(self.model(effects=EFFECTS))
        motion, wanted = self.replay(self.set)[3]
        one, two, state = fmu.instance(), fmu.instance(), ctypes.c_void_p()
        for instance in (one, two):
            instance.start(motion)
        beside = list(zip(self.rows(one, motion), self.rows(two, motion)))
        self.agree([a for a, _ in beside], wanted)
        self.assertEqual([a for a, _ in beside], [b for _, b in beside])
        one.do("fmi2Reset")
        one.start(motion)
        rows = self.rows(one, motion)
        for _ in range(300):
            next(rows)
        rest = [next(rows)]
        one.do("fmi2GetFMUstate", ctypes.byref(state))
        rest += list(rows)
        one.do("fmi2SetFMUstate", state)
        self.assertEqual(list(self.rows(one, motion, 300)), rest)
        one.do("fmi2FreeFMUstate", ctypes.byref(state))


class Refusals(Palpation):
    def refused(self, instance, status, words):
        self.assertEqual(status, 3)  # fmi2Error
        self.assertRegex(instance.said[-1], words)
        self.assertEqual(instance.said[-1].count("\n"), 0)

    def read(self, instance):
        return instance.call("fmi2GetReal", *instance.references(["fx_N"]), (ctypes.c_double * 1)())

    def test_leaving_the_carried_part_is_an_error_and_changes_nothing(self):
        fmu, _ = self.exported(self.model(), "--margin", "0.5")
        field = json.loads((fmu.folder / "resources/field.json").read_text())
        volume = field["volume"]
        ways = []  # towards the sides at which the part ends before the volume does, by the whole volume
        for axis in range(3):
            whole = volume["dims"][axis] * volume["spacing_m"][axis]
            along = volume["directions"][3 * axis:3 * axis + 3]
            ways += [[-whole * c for c in along]] if field["begin"][axis] > 0 else []
            ways += [[whole * c for c in along]] if field["end"][axis] < volume["dims"][axis] else []
        self.assertGreater(len(ways), 2)
        motion, wanted = self.replay(self.set)[3]
        instance, found = fmu.instance(), []
        instance.start(motion)
        for row in self.rows(instance, motion):
            found.append(row)
            if len(found) == 400:
                here = row_of(motion, 399)
                for way in ways:
                    away = {name: here[name] + by for name, by in zip(("px_m", "py_m", "pz_m"), way)}
                    self.assertEqual(instance.set(**away), 0)
                    self.refused(instance, self.read(instance), r"leaves the part of the volume that this FMU carries: the tip is at \(.*larger --margin")
                    self.refused(instance, instance.step(motion["t_s"][399], 0.001), "leaves the part of the volume")
                self.assertEqual(instance.set(**here), 0)
        self.agree(found, wanted)

    def test_what_is_no_pose_and_no_step_is_refused(self):
        fmu, _ = self.exported(self.model())
        motion, _ = self.replay(self.set)[3]
        instance = fmu.instance()
        instance.start(motion)
        self.assertEqual(instance.set(qw=0.3, qx=0.0, qy=0.0, qz=0.0), 0)
        self.refused(instance, self.read(instance), "qw to qz: the quaternion's length is 0.3, 1 is expected")
        instance.set(**row_of(motion, 0))
        self.refused(instance, instance.set(px_m=math.nan), "px_m")
        self.refused(instance, instance.step(motion["t_s"][0], 1.5), "a step of 1.5 s at .* at most 1 s")
        instance = fmu.instance()
        self.assertEqual(instance.set(**{"down[3]": 0.0}), 0)
        instance.setup(0.0)
        instance.do("fmi2EnterInitializationMode")
        self.refused(instance, instance.call("fmi2ExitInitializationMode"), "down: .*a direction is expected")
        instance.set(**{"down[3]": -1.0, "base.length_m": 30.0})
        self.refused(instance, instance.call("fmi2ExitInitializationMode"), "length_m: 30")

    def test_damaged_and_missing_files_give_no_instance(self):
        fmu, _ = self.exported(self.model())

        def said():
            instance = fmu.instance()
            self.assertIsNone(instance.component.value)
            return instance.said[-1]
        for name, words in (("opacity.f32", "not those of the export|opacity.f32"), ("field.json", "changed since the export"),
                            ("model.json", "changed since the export|model.json")):
            path = fmu.folder / "resources" / name
            whole = path.read_bytes()
            for content in (b"", whole[:-4], bytes([whole[0] ^ 1]) + whole[1:]):
                path.write_bytes(content)
                self.assertRegex(said(), words)
            path.unlink()
            self.assertRegex(said(), words)
            path.write_bytes(whole)
        fmu.instance().free()

    def test_what_cannot_be_exported_is_refused_in_one_line(self):
        content = self.make_set()
        path, out = self.write(content), self.folder / "x.fmu"

        def said(*words, model=path):
            text = tractus("fmu", model, "--out", out, *words, expect=2)
            self.assertEqual(text.count("\n"), 1, text)
            self.assertFalse(out.exists())
            return text
        self.assertRegex(said(), "takes a part of its volume along: give --measurements .* or --box")
        self.assertRegex(said("--box", "0,0,0", "1,1,1"), 'names no "volume"')
        self.assertRegex(said("--measurements", self.folder / "none"), "none")
        self.assertRegex(said("--measurements", self.set, "--margin", "wide"), "--margin")
        self.assertRegex(said("--measurements", self.set, "--margin", "-1"), "--margin: below 0")
        self.assertRegex(said("--box", "0,0,0", "1,1,1", "--margin", "1"), "--margin goes with --measurements")
        content["volume"] = "set/bone.nrrd"
        self.assertRegex(said("--box", "900,0,0", "901,1,1", model=self.write(content, "far")), "outside the volume")
        content["effects"] = [{"id": "time_delay", "parameters": {"delay_s": -0.01}}]
        self.assertRegex(said("--measurements", self.set, model=self.write(content, "early")), "time_delay: a delay of -0.01 s")
        probing = self.write(fmu_test.PLAIN, "probing")
        self.assertRegex(said("--measurements", self.set, model=probing), "a model of the probing rig has no volume")


class Contents(Palpation):
    def test_the_part_that_is_reached_is_carried_alone_and_the_same_model_gives_the_same_file(self):
        content = self.make_set()
        fmu, said = self.exported(content, "--margin", "1")
        again, _ = self.exported(content, "--margin", "1 mm", name="again")
        self.assertEqual((self.folder / "bone.fmu").read_bytes(), (self.folder / "again.fmu").read_bytes())
        field = json.loads((fmu.folder / "resources/field.json").read_text())
        self.assertEqual(field["volume"]["dims"], [44, 48, 60])
        wide = [b - a for a, b in zip(field["begin"], field["end"])]
        self.assertIn(" × ".join(map(str, wide)) + " voxels of the field", said)
        self.assertEqual((fmu.folder / "resources/opacity.f32").stat().st_size, 4 * math.prod(wide))
        self.assertLess(math.prod(wide), 44 * 48 * 60)
        self.assertNotIn("volume", json.loads((fmu.folder / "resources/model.json").read_text()))

    def test_a_box_is_carried_as_it_is_given(self):
        """Voxels (4.6, 9.2, 13.5) to (30.3, 35.9, 50.1) of a block without rotation: two before are read, three behind."""
        content = self.make_set()
        head, data = (self.set / "bone.nrrd").read_bytes().split(b"\n\n", 1)
        lines = [b"space directions: (0.4,0,0) (0,0.5,0) (0,0,0.25)" if line.startswith(b"space directions") else
                 b"space origin: (10,20,30)" if line.startswith(b"space origin") else line for line in head.split(b"\n")]
        (self.folder / "block.nrrd").write_bytes(b"\n".join(lines) + b"\n\n" + data)
        content["volume"] = "block.nrrd"
        path = self.write(content)
        box = [f"{10 + 0.4 * i},{20 + 0.5 * j},{30 + 0.25 * k}" for i, j, k in ((4.6, 35.9, 13.5), (30.3, 9.2, 50.1))]
        tractus("fmu", path, "--out", self.folder / "box.fmu", "--box", *box)
        fmu = fmu_test.Fmu(self.folder / "box.fmu", self.folder / "box")
        field = json.loads((fmu.folder / "resources/field.json").read_text())
        self.assertEqual((field["begin"], field["end"]), ([2, 7, 11], [34, 39, 54]))

    def test_the_description_names_units_and_frames(self):
        fmu, _ = self.exported(self.model(effects=EFFECTS))
        variables = {v.get("name"): v for v in fmu.description.find("ModelVariables")}
        units = {u.get("name"): u.find("BaseUnit").attrib for u in fmu.description.find("UnitDefinitions")}
        [motion, *_] = self.replay(self.set)
        self.assertEqual(set(fmu.inputs), set(motion[0]) - {"t_s"})
        for name in OUTPUTS:
            self.assertEqual(variables[name].get("causality"), "output")
        for name, unit in (("px_m", {"m": "1"}), ("vx_m_s", {"m": "1", "s": "-1"}), ("alpha_z_rad_s2", {"rad": "1", "s": "-2"}),
                           ("ty_Nm", {"kg": "1", "m": "2", "s": "-2"}), ("base.youngs_modulus_Pa", {"kg": "1", "m": "-1", "s": "-2"})):
            self.assertEqual(units[variables[name].find("Real").get("unit")], unit, name)
        self.assertIn("in V", variables["omega_x_rad_s"].get("description"))
        self.assertIn("p_V = p + q p_H q*", variables["qw"].get("description"))
        self.assertIn("in H", variables["tz_Nm"].get("description"))
        self.assertEqual(variables["qw"].find("Real").get("start"), "1")
        self.assertEqual(variables["effects.time_delay.delay_s"].find("Real").get("min"), "0")
        self.assertEqual(len(fmu.description.find("ModelStructure").find("Outputs")), len(OUTPUTS))


@unittest.skipUnless(shutil.which("octave-cli") and shutil.which("mkoctfile"), "Octave with liboctave-dev is not installed")
class InOctave(Palpation):
    def test_forces_agree_with_replay_and_leaving_the_part_is_refused_in_words(self):
        self.exported(self.model(effects=EFFECTS))
        (motion, wanted), *_ = self.replay(self.set)
        said = fmu_test.InOctave.octave(self, """
read = importdata('bone-replayed/motion/t00.csv', ',', 1);
motion = cell2struct(num2cell(read.data, 1), read.colheaders, 2);
forces = tractus_model('bone.fmu', motion);
dlmwrite('octave.csv', [forces.fx_N forces.fy_N forces.fz_N forces.tz_Nm], 'precision', '%.17g');
motion.px_m(40) = 1;
try
  tractus_model('bone.fmu', motion);
  disp('not refused');
catch refusal
  disp(refusal.message);
end
""")
        with open(self.folder / "octave.csv") as file:
            rows = [[float(cell) for cell in row] for row in csv.reader(file)]
        for k, name in enumerate(("fx_N", "fy_N", "fz_N", "tz_Nm")):
            self.assertLess(largest_difference([row[k] for row in rows], wanted[name]), CLOSE)
        self.assertRegex(said, "leaves the part of the volume")


if __name__ == "__main__":
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("--bin", type=Path, default=fmu_test.BIN, help="folder with the program tractus")
    options, rest = reader.parse_known_args()
    fmu_test.BIN = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])
