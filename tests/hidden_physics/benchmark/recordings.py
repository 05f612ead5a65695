"""Real recordings of machines, each with the model that a user would begin with and what is published of it.

They have no truth with numbers for every part, and are therefore not scored among the sets: the table shows what was
named, and by how much the held-out error fell. Two lie in the repository under their own licences; EMPS does not, as it
states none: whoever has its files gives their folder.
"""
from __future__ import annotations

import json
import pathlib
import shutil
import struct
import zlib
from dataclasses import dataclass

import numpy as np

import jobs

DATA = pathlib.Path(__file__).resolve().parents[2] / "data/force"
EMPS_SOURCE = ("EMPS is no part of the repository (A. Janot, M. Gautier, M. Brunot: Data Set and Reference Models of "
               "EMPS, 2019; https://www.nonlinearbenchmark.org): download it and give the folder that holds "
               "DATA_EMPS.mat with --emps DIR")
EMPS_N_PER_V, EMPS_MASS_KG, EMPS_VISCOUS = 35.15, 95.1, 203.5  # as published
EMPS_START_M, EMPS_TRIAL_S = 0.05, 2.5  # the carriage starts there, so that all of its way lies in the layer
LONGEST_TRAVEL_M = 1.0  # a layer lies between 0 and this


@dataclass(frozen=True)
class Recording:
    """A real recording: its files, and the effects that its authors or a published model give it."""
    name: str
    model: pathlib.Path
    measurements: pathlib.Path
    published: tuple
    source: str


IN_REPOSITORY = [
    Recording("friction_damper", DATA / "friction_damper_ccbysa/model.json", DATA / "friction_damper_ccbysa/damper",
              ("hysteresis", "backlash"), "banded rotary friction damper, Coble et al. 2022, CC BY-SA 4.0"),
    *(Recording(f"cable_tool_{run}", DATA / "cable_tool_odbl/model.json", DATA / f"cable_tool_odbl/drum/{run}",
                ("coulomb_friction", "hysteresis"), "cable-driven surgical tool, O'Neill et al. 2018, ODbL 1.0")
      for run in ("light_fast", "loaded_fast")),
]


def mat_arrays(path: pathlib.Path) -> dict:
    """The real double arrays of a MATLAB 5 file, by name (MathWorks, MAT-File Format, level 5)."""
    content, found, at = path.read_bytes(), {}, 128
    if content[126:128] != b"IM":
        raise ValueError(f"{path} is no little-endian MATLAB 5 file")

    def element(data, start):
        """Type and content of the element at this place, and where the next one begins; small ones are packed."""
        kind, size = struct.unpack_from("<II", data, start)
        if kind >> 16:
            return kind & 0xffff, data[start + 4:start + 4 + (kind >> 16)], start + 8
        return kind, data[start + 8:start + 8 + size], start + 8 + size + (0 if kind == 15 else -size % 8)

    while at + 8 <= len(content):
        kind, data, at = element(content, at)
        if kind == 15:  # compressed
            kind, data, _ = element(zlib.decompress(data), 0)
        if kind != 14:  # a matrix
            continue
        flags, shape, name, values, place = None, None, None, None, 0
        for part in range(4):
            if place + 8 > len(data):
                break
            numbers, value, place = element(data, place)
            if part == 0:
                flags = value
            elif part == 1:
                shape = np.frombuffer(value, "<i4")
            elif part == 2:
                name = value.decode()
            else:
                codes = {1: "<i1", 2: "<u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8"}
                values = np.frombuffer(value, codes[numbers]) if numbers in codes else None
        if values is not None and flags[0] == 6:  # class double
            found[name] = values.astype(float).reshape(shape, order="F")
    return found


def emps_recording(folder: pathlib.Path, target: pathlib.Path) -> Recording:
    """Writes EMPS as a measurement set: force of the drive in N, position moved into the layer, cut into trials."""
    source = folder / "DATA_EMPS.mat"
    if not source.is_file():
        raise SystemExit(f"hidden-physics: {source} is missing. {EMPS_SOURCE}")
    arrays = mat_arrays(source)
    missing = [name for name in ("t", "qm", "vir") if name not in arrays]
    if missing:
        raise SystemExit(f"hidden-physics: {source} has no array {missing[0]}. {EMPS_SOURCE}")
    t, x, volts = (arrays[name].ravel() for name in ("t", "qm", "vir"))
    force = volts * float(arrays.get("gtau", np.array(EMPS_N_PER_V)).ravel()[0])
    shutil.rmtree(target, ignore_errors=True)
    (target / "emps").mkdir(parents=True)
    trials, size = [], round(EMPS_TRIAL_S / float(np.median(np.diff(t))))
    for k, begin in enumerate(range(0, len(t) - size // 2, size)):
        rows = zip(t[begin:begin + size] - t[begin], EMPS_START_M + x[begin:begin + size], force[begin:begin + size])
        lines = "\n".join(f"{a:.6f},{b:.8f},{c:.5f}" for a, b, c in rows)
        (target / "emps" / f"part{k + 1:02d}.csv").write_text(f"t_s,x_m,fz_N\n{lines}\n")
        trials.append({"id": f"part{k + 1:02d}", "file": f"part{k + 1:02d}.csv"})
    index = {"format": "tractus-measurements/1", "rig": "probing", "name": "EMPS", "simulated": False, "trials": trials}
    (target / "emps/set.json").write_text(json.dumps(index))
    layer = {"start_m": 0.0, "thickness_m": LONGEST_TRAVEL_M, "stiffness_N_per_m": 0.0,
             "damping_Ns_per_m": EMPS_VISCOUS, "equilibrium_m": 0.0}
    model = {"format": "tractus-model/1", "rig": "probing", "name": "servo axis", "base": {"layers": [layer]},
             "fixed": [f"/base/layers/0/{n}" for n in ("start_m", "thickness_m", "stiffness_N_per_m", "equilibrium_m")],
             "effects": [{"id": "inertia", "parameters": {"mass_kg": EMPS_MASS_KG}}]}
    (target / "model.json").write_text(json.dumps(model))
    return Recording("emps", target / "model.json", target / "emps", ("coulomb_friction", "sensor_bias"),
                     "servo axis, Janot et al. 2019")


def answered(recording: Recording, program: str, place: pathlib.Path, label: str, threads: int) -> None:
    """Asks the program about a recording unless it has answered."""
    path = place / "recordings" / label / f"{recording.name}.json"
    if not path.exists():
        out = jobs.run_program([program, "diagnose", "--model", str(recording.model), "--measurements",
                                str(recording.measurements), "--threads", str(threads), "--json"])
        out.update(published=list(recording.published), source=recording.source)
        jobs.write_json(path, out)


def rows_of(folder: pathlib.Path) -> list:
    """The table of one program's answers to recordings."""
    rows = [["recording", "published", "verdict", "named", "stated", "held-out error: base", "final", "floor"]]
    for path in sorted(folder.glob("*.json")):
        out = json.loads(path.read_text())
        answer = out.get("answer")
        if answer is None:
            rows.append([path.stem, "+".join(out["published"]), out["failed"][:80], "-", "-", "-", "-", "-"])
            continue
        steps = answer["steps"]
        rows.append([path.stem, "+".join(out["published"]), answer["verdict"],
                     "+".join(e["id"] for e in answer["effects"]) or "nothing", f"{answer['probability']:.2f}",
                     f"{steps[0]['held_out_rmse']:.4g}", f"{steps[-1]['held_out_rmse']:.4g}",
                     f"{answer['base']['noise_floor']:.4g}"])
    return rows
