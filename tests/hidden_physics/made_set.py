"""What a generator of the hidden-physics benchmark makes, and how it becomes a folder of files."""
from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

MOST_DECIMALS = 15


@dataclass
class MadeSet:
    """One simulated measurement set with the model that a user would compare it with, and the truth about it."""
    model: dict  # the base model alone, tractus-model/1
    stated: dict  # further members of set.json
    trials: list  # (trial id, {column name: values}) in the order of the file
    extra_files: dict = field(default_factory=dict)  # path inside the folder of measurements: bytes
    truth: dict = field(default_factory=dict)


def decimals(values: np.ndarray) -> int:
    """The fewest digits after the point that write every value as it is."""
    for digits in range(MOST_DECIMALS):
        if np.array_equal(np.round(values, digits), values):
            return digits
    return MOST_DECIMALS


def csv_text(columns: dict) -> str:
    """A trial as plain decimal text; the author of the values sets their digits by rounding them."""
    formats = ",".join(f"%.{decimals(np.asarray(values, float))}f" for values in columns.values())
    rows = zip(*(np.asarray(values, float).tolist() for values in columns.values()))
    return "\n".join([",".join(columns), *(formats % row for row in rows)]) + "\n"


def write(made: MadeSet, folder) -> None:
    """Writes model.json, truth.json and measurements/ (set.json, a CSV for each trial, extra files)."""
    folder = Path(folder)
    measurements = folder / "measurements"
    measurements.mkdir(parents=True, exist_ok=True)
    (folder / "model.json").write_text(json.dumps(made.model, indent=1) + "\n")
    (folder / "truth.json").write_text(json.dumps(made.truth, indent=1) + "\n")
    index = {"format": "tractus-measurements/1", "rig": made.model["rig"], **made.stated,
             "trials": [{"id": name, "file": f"{name}.csv"} for name, _ in made.trials]}
    (measurements / "set.json").write_text(json.dumps(index, indent=1) + "\n")
    for name, columns in made.trials:
        (measurements / f"{name}.csv").write_text(csv_text(columns))
    for name, content in made.extra_files.items():
        path = measurements / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
