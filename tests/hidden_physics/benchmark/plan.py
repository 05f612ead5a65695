"""Which sets a generation holds: a pure function of its name, so that any number can be made anywhere.

A generation whose name begins with "frozen" is for the last measurement alone. Its report holds rates and names no set,
so that nothing can be tuned on it; whoever wants sets that nobody has seen makes up a name.
"""
from __future__ import annotations

import hashlib
import importlib
import json
import math
import pathlib
import re
import sys
from dataclasses import dataclass

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / "generators")]

PROBING = ["closed_loop_hand", "programmed_motor", "oscillators", "closed_loop_hand", "programmed_motor"]
PALPATION = ["point_cloud_probe"]
GENERATORS = {"probing": PROBING, "palpation": PALPATION}
# Of twenty sets: 4 with nothing hidden, 2 with wrong numbers only, 8 singles, 3 pairs, 3 outside the catalogue.
KINDS = ["one", "nothing", "outside", "one", "pair", "one", "nothing", "one", "parameters", "outside",
         "one", "nothing", "pair", "one", "one", "outside", "nothing", "one", "parameters", "pair"]
WEAKEST, STRONGEST = 0.005, 0.15  # shares of the channel's rms
SHARE_WITHIN = 1.2  # the generators need a range; a drawn strength is met within this factor
# One of these is a limit of another, so that a pair of them is one effect.
FAMILIES = [{"coulomb_friction", "stribeck_friction", "hysteresis"}, {"sensor_bias", "sensor_drift"},
            {"probe_weight", "sensor_bias"}, {"shank_curvature", "pose_offset"}]


@dataclass(frozen=True)
class PlannedSet:
    """One set: everything that its maker needs."""
    name: str
    generation: str
    rig: str
    generator: str
    kind: str  # nothing, parameters, one, pair, outside
    hidden: tuple
    seed: int
    shares: tuple

    @property
    def frozen(self) -> bool:
        return is_frozen(self.generation)


def is_frozen(generation: str) -> bool:
    return generation.startswith("frozen")


def random_of(*words):
    """A random source that depends on these words alone."""
    digest = hashlib.sha256("/".join(map(str, words)).encode()).digest()
    return np.random.default_rng(list(digest))


def generator_module(name: str):
    return importlib.import_module(name)


def cycled(generation, generator, what, ids, number):
    """The id of the given number where each round goes through all of them in an order of its own."""
    order = random_of(generation, generator, what, number // len(ids)).permutation(len(ids))
    return ids[order[number % len(ids)]]


def hidden_of(random, generation, generator, kind, number):
    """The ids that the set of this number of its kind and generator hides."""
    module = generator_module(generator)
    if kind in ("nothing", "parameters"):
        return ()
    if kind == "outside":
        return (cycled(generation, generator, kind, module.OUTSIDE, number),)
    first = cycled(generation, generator, kind, module.CATALOGUE, number)
    if kind == "one":
        return (first,)
    partners = [i for i in module.CATALOGUE if i != first and not any({i, first} <= family for family in FAMILIES)]
    return (first, str(random.choice(partners)))


def planned_sets(generation: str, rig: str, count: int) -> list:
    """The first sets of a rig in a generation; a longer list begins with the shorter one."""
    made, seen = [], {}
    for index in range(count):
        kind = KINDS[index % len(KINDS)]
        of_kind = seen[kind] = seen.get(kind, -1) + 1
        generator = GENERATORS[rig][of_kind % len(GENERATORS[rig])]
        number = seen[kind, generator] = seen.get((kind, generator), -1) + 1
        random = random_of(generation, rig, index)
        hidden = hidden_of(random, generation, generator, kind, number)
        strength = math.exp(random.uniform(math.log(WEAKEST), math.log(STRONGEST)))
        name = "-".join([f"{rig}{index + 1:04d}", generator, "+".join(hidden) or kind])
        made.append(PlannedSet(name, generation, rig, generator, kind, hidden, int(random.integers(2**31)),
                               (strength / SHARE_WITHIN, strength * SHARE_WITHIN)))
    return made


def named_sets() -> list:
    """The sets of named_sets.json: those to which a wrong, partial or silly answer was found, before it was mended."""
    listed = json.loads((pathlib.Path(__file__).parent / "named_sets.json").read_text())
    sets = []
    for entry in listed:
        rig, index = re.match(r"([a-z]+)(\d+)-", entry["name"]).groups()
        made = planned_sets(entry["generation"], rig, int(index))[-1]
        if made.name != entry["name"]:
            raise ValueError(f"named_sets.json: {entry['generation']} has {made.name} in the place of {entry['name']}")
        sets.append(made)
    return sets
