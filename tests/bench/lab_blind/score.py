"""One answer of the lab against the truth of its set."""
import math

# Outside kinds that a later catalogue may know by a name of its own: naming one is as good as announcing it.
ALSO_CALLED = {
    "direction_damping": {"direction_damping", "direction_asymmetry"},
    "load_friction": {"load_friction"},
    "bone_texture": {"bone_texture"},
    "tract_wear": {"tract_wear"},
    "stiffness_nonlinearity": {"stiffness_nonlinearity"},
    "porous_stiffness": {"porous_stiffness", "density_stiffness"},
    "bone_compliance": {"bone_compliance"},
}
ANGLES = {"phase_rad", "direction_rad"}
NOT_PARAMETERS = {"of_hand", "bends_shank"}
# Free together with the base's force factor, so no data can tell it.
NOT_SCORED = NOT_PARAMETERS | {"reference_gradient_per_m"}
# Below this share of the noise floor an effect, with the base refitted, moves the RMSE by less than 2 %.
UNSEEN = 0.2


def truth_label(truth):
    ids = [e["id"] for e in truth["effects"]]
    if truth["kind"] in ("none", "base_wrong"):
        return truth["kind"]
    return " + ".join(sorted(ids))


def hidden_from_all(truth):
    """Why a set is scored apart, or None. Mostly: what is left after the base has moved to hide it, against the noise."""
    if truth.get("accepted") is False:
        return "the generator could not bring it to 4-10 % at a plausible size"
    for effect in truth["effects"]:
        if effect["projected_rms"] < UNSEEN * truth["floor"]:
            return "%s leaves %.3g after the base is refitted, noise %.3g" % (
                effect["id"], effect["projected_rms"], truth["floor"])
    return None


def parameter_errors(effect, answer):
    """(name, relative error, inside the 90 % interval or None) of each parameter that the answer gives."""
    out = []
    for name, true in effect["parameters"].items():
        given = answer.get("parameters", {}).get(name)
        if name in NOT_SCORED or given is None:
            continue
        value, sd = (given.get("value"), given.get("sd")) if isinstance(given, dict) else (given, None)
        if value is None:
            continue
        trues, values = (true, value) if isinstance(true, list) else ([true], [value])
        if not isinstance(values, list) or len(values) != len(trues):
            continue
        wrong = [v - t for v, t in zip(values, trues)]
        if name in ANGLES:
            wrong = [(w + math.pi) % (2 * math.pi) - math.pi for w in wrong]
            size = 2 * math.pi
        else:
            size = math.sqrt(sum(t * t for t in trues)) or 1.0
        error = math.sqrt(sum(w * w for w in wrong)) / size
        sds = sd if isinstance(sd, list) else [sd] * len(wrong) if sd is not None else None
        inside = None
        if sds and all(s is not None for s in sds):
            inside = sum(abs(w) <= 1.645 * s for w, s in zip(wrong, sds)) / len(wrong)
        out.append((name, error, inside))
    return out


def answered_label(answer):
    ids = sorted(e["id"] for e in answer.get("effects", []))
    if not ids:
        return answer.get("verdict", "?")
    return ids[0] if len(ids) == 1 else "several"


def judged(truth, ids, verdict):
    """What the answer got right, by kind of truth."""
    wanted = {e["id"] for e in truth["effects"]}
    if truth["kind"] in ("none", "base_wrong"):
        return {"right": verdict == "complete" and not ids, "alarm": bool(ids) or verdict != "complete"}
    if truth["kind"] == "outside":
        known = any(ids & ALSO_CALLED.get(i, set()) for i in wanted)
        return {"right": known or verdict in ("unexplained", "partly"), "named": known}
    return {"right": ids == wanted, "named": wanted <= ids, "one": bool(wanted & ids), "extra": bool(ids - wanted)}


def conditions(truth):
    """What a set is like, in words, for rates by condition."""
    out = ["supplied base model " + str(truth.get("supplied"))]
    if truth.get("stuck_share", 0) > 0.02:
        out.append("hand stuck by friction")
    out += [word for key, word in (("air", "begins in air"), ("averaging", "samples averaged")) if truth.get(key)]
    out += ["%s %s" % (key, truth[key]) for key in ("field", "volume") if key in truth]
    if truth.get("jumps", 0) > 0.004:
        out.append("shank snaps")
    for effect in truth["effects"]:
        for variant in sorted(NOT_PARAMETERS & set(effect["parameters"])):
            out.append("%s, %s %g" % (effect["id"], variant, effect["parameters"][variant]))
    return out


def score(truth, answer, wall_s):
    """A row of the table. `answer` is the program's JSON, or {"error": text}."""
    row = {"seed": truth["seed"], "kind": truth["kind"], "truth": truth_label(truth), "wall_s": wall_s,
           "unseen": hidden_from_all(truth), "strengths": [e["strength"] for e in truth["effects"]],
           "conditions": conditions(truth), "fixed": truth.get("fixed", [])}
    if "error" in answer:
        return row | {"answer": "failed", "error": answer["error"], "right": False}
    ids = {e["id"] for e in answer.get("effects", [])}
    verdict = answer.get("verdict", "?")
    row |= judged(truth, ids, verdict)
    row |= {"answer": answered_label(answer), "verdict": verdict, "ids": sorted(ids)}
    wanted = {e["id"] for e in truth["effects"]}
    row["stated"] = answer.get("probability")
    row["claims"] = [[e.get("probability"), e["id"] in wanted] for e in answer.get("effects", [])]
    row["ranked"] = [[e.get("probability"), e["id"] in wanted] for e in answer.get("ranking", [])]
    row["first"] = answer["ranking"][0]["id"] if answer.get("ranking") else None
    row["parameters"] = []
    for effect in truth["effects"]:
        for given in answer.get("effects", []):
            if given["id"] == effect["id"]:
                row["parameters"] += [[effect["id"], *p] for p in parameter_errors(effect, given)]
    steps = answer.get("steps") or []
    if steps and steps[-1].get("held_out_rmse") is not None:
        row["held_out_over_floor"] = steps[-1]["held_out_rmse"] / truth["floor"]
        # What the true law leaves on the motion as it was sampled: jumps within a sample are in it.
        row["held_out_over_attainable"] = steps[-1]["held_out_rmse"] / truth.get("attainable", truth["floor"])
        row["base_over_floor"] = (answer.get("base", {}).get("held_out_rmse") or 0) / truth["floor"]
    stated = answer.get("base", {}).get("noise_floor")
    if stated:
        row["stated_floor_over_true"] = stated / truth["floor"]
    return row
