"""The rows of a run as figures, as text and as a page of its own."""
import html

from .figures import percentile, reliability, wilson

GOALS = {
    "probing": {"single exact": 0.95, "nothing: complete": 0.98, "outside announced": 0.85, "both of two": 0.80},
    "palpation": {"single exact": 0.85, "nothing: complete": 0.98, "outside announced": 0.85, "both of two": 0.80},
}


def rates(rows):
    """Name → (hits, count)."""
    def of(kinds, key):
        chosen = [r for r in rows if r["kind"] in kinds]
        return sum(bool(r.get(key)) for r in chosen), len(chosen)
    return {
        "single exact": of(("single",), "right"),
        "single named": of(("single",), "named"),
        "single with a second effect": of(("single",), "extra"),
        "nothing: complete": of(("none", "base_wrong"), "right"),
        "  base supplied as is": of(("none",), "right"),
        "  base far off": of(("base_wrong",), "right"),
        "outside announced": of(("outside",), "right"),
        "both of two": of(("pair",), "right"),
        "both of two, perhaps more": of(("pair",), "named"),
        "at least one of two": of(("pair",), "one"),
    }


def spread(values):
    return {"count": len(values), "median": percentile(values, 0.5), "p90": percentile(values, 0.9)}


def summary(rows):
    """Everything that is printed, as numbers."""
    seen = [r for r in rows if not r["unseen"]]
    found = [r for r in rows if r["kind"] in ("single", "pair") and r.get("right")]
    errors = [p for r in found for p in r.get("parameters", [])]
    inside = [p[3] for p in errors if p[3] is not None]
    claims = [c for r in rows for c in r.get("claims", []) if c[0] is not None]
    answers = [(r["stated"], r["right"]) for r in rows if r.get("stated") is not None]
    ranked = [c for r in rows for c in r.get("ranked", []) if c[0] is not None]
    per = {}
    for p in errors:
        per.setdefault("%s.%s" % (p[0], p[1]), []).append(p[2])
    return {
        "sets": len(rows), "failed": sum(r["answer"] == "failed" for r in rows), "unseen": len(rows) - len(seen),
        "rates": {name: {"hits": h, "count": n, "interval": wilson(h, n)} for name, (h, n) in rates(rows).items()},
        "rates_without_unseen":
            {name: {"hits": h, "count": n, "interval": wilson(h, n)} for name, (h, n) in rates(seen).items()},
        "single_by_condition": by_condition(rows),
        "parameter_error": spread([p[2] for p in errors]),
        "parameter_error_by_name": {name: spread(v) for name, v in sorted(per.items())},
        "coverage_90": {"count": len(inside), "rate": sum(inside) / len(inside) if inside else None},
        "held_out_over_floor": spread([r["held_out_over_floor"] for r in found if "held_out_over_floor" in r]),
        "held_out_over_attainable":
            spread([r["held_out_over_attainable"] for r in found if "held_out_over_attainable" in r]),
        "stated_floor_over_true": spread([r["stated_floor_over_true"] for r in rows if "stated_floor_over_true" in r]),
        "reliability_of_answers": reliability(answers), "reliability_of_effects": reliability(claims),
        "reliability_of_rankings": reliability(ranked),
        "wall_s": spread([r["wall_s"] for r in rows]) | {"max": max([r["wall_s"] for r in rows], default=None)},
    }


def by_condition(rows):
    """Exact answers among sets of one effect, for each condition that some of them share."""
    out = {}
    for r in rows:
        for condition in r["conditions"] if r["kind"] == "single" else []:
            hits, count = out.get(condition, (0, 0))
            out[condition] = hits + bool(r["right"]), count + 1
    return {name: {"hits": h, "count": n, "interval": wilson(h, n)} for name, (h, n) in sorted(out.items())}


def confusion(rows):
    """(truth labels, answer labels, counts). Pairs stand together."""
    counts = {}
    for r in rows:
        label = "two effects" if r["kind"] == "pair" else r["truth"]
        answer = r["answer"]
        if r["kind"] == "pair" and r["right"]:
            answer = "both"
        counts[label, answer] = counts.get((label, answer), 0) + 1
    truths = sorted({t for t, _ in counts})
    return truths, sorted({a for _, a in counts}, key=lambda a: (a not in truths, a)), counts


def text_matrix(rows):
    truths, answers, counts = confusion(rows)
    lines = ["truth (rows) against answer (columns)"]
    lines += ["  %2d  %s" % (i + 1, a) for i, a in enumerate(answers)]
    lines.append("%-24s" % "" + "".join("%4d" % (i + 1) for i in range(len(answers))))
    for t in truths:
        lines.append("%-24s" % t + "".join("%4s" % (counts.get((t, a)) or "·") for a in answers))
    return "\n".join(lines)


def number(value, form="%.3g"):
    return "–" if value is None else form % value


def rate_line(name, entry, goal):
    interval = entry["interval"]
    if interval is None:
        return "  %-38s none" % name
    mark = "" if goal is None else "   goal %.0f %% %s" % (100 * goal, "met" if interval[0] >= goal else "MISSED")
    return "  %-38s %3d/%-3d = %5.1f %%  (%.1f–%.1f)%s" % (
        name, entry["hits"], entry["count"], *(100 * x for x in interval), mark)


def reliability_lines(title, table):
    bins, error = table
    lines = ["%s: expected calibration error %s" % (title, number(error))]
    lines += ["  stated %4.2f–%4.2f  mean %.3f  true %.3f (%.2f–%.2f)  of %d" % (
        b["from"], b["to"], b["stated"], b["true"], *b["interval"], b["count"]) for b in bins]
    return lines


def text(rows, rig):
    s = summary(rows)
    lines = [text_matrix(rows), "", "%d sets, %d without an answer; all of them:" % (s["sets"], s["failed"])]
    lines += [rate_line(n, e, GOALS[rig].get(n)) for n, e in s["rates"].items()]
    lines.append("without the %d whose effect cannot be told from the base:" % s["unseen"])
    lines += [rate_line(n, e, GOALS[rig].get(n)) for n, e in s["rates_without_unseen"].items()]
    lines.append("single exact, by what the set is like:")
    lines += [rate_line(n, e, None) for n, e in s["single_by_condition"].items()]
    p, h, c = s["parameter_error"], s["held_out_over_floor"], s["coverage_90"]
    lines += ["", "parameter error, exact answers: median %s, p90 %s (%d values; goal median 0.10)" % (
        number(p["median"]), number(p["p90"]), p["count"])]
    lines += ["  %-48s median %-8s p90 %-8s of %d" % (n, number(e["median"]), number(e["p90"]), e["count"])
              for n, e in s["parameter_error_by_name"].items()]
    lines.append("90 %% intervals that hold the truth: %s of %d" % (number(c["rate"]), c["count"]))
    lines.append("held-out error over the true floor: median %s, p90 %s (goal 1.10)" % (
        number(h["median"], "%.4g"), number(h["p90"], "%.4g")))
    h = s["held_out_over_attainable"]
    lines.append("  over what the true law leaves on the sampled motion: median %s, p90 %s" % (
        number(h["median"], "%.4g"), number(h["p90"], "%.4g")))
    f = s["stated_floor_over_true"]
    lines.append("stated floor over the true one: median %s, p90 %s" % (number(f["median"]), number(f["p90"])))
    lines += reliability_lines("probabilities of whole answers", s["reliability_of_answers"])
    lines += reliability_lines("probabilities of the effects named", s["reliability_of_effects"])
    lines += reliability_lines("probabilities of every rank", s["reliability_of_rankings"])
    w = s["wall_s"]
    lines.append("wall time: median %s s, p90 %s s, longest %s s" % tuple(number(w[k]) for k in ("median", "p90", "max")))
    lines += ["", "wrong:"] + [wrong_line(r) for r in rows if not r["right"]]
    return "\n".join(lines)


def wrong_line(row):
    return "  seed %-6s %-9s %-34s → %-12s %s%s%s" % (
        row["seed"], row["kind"], row["truth"], row.get("verdict", row["answer"]),
        " + ".join(row.get("ids", [])), "  [%s]" % row["error"] if "error" in row else "",
        "  (%s)" % row["unseen"] if row["unseen"] else "")


def matrix_svg(rows):
    truths, answers, counts = confusion(rows)
    cell, left, top = 30, 210, 190
    width, height = left + cell * len(answers) + 20, top + cell * len(truths) + 20
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" font-family="sans-serif" font-size="12">'
           % (width, height)]
    for j, a in enumerate(answers):
        x = left + cell * j + cell / 2 + 4
        out.append('<text transform="translate(%g,%g) rotate(-60)">%s</text>' % (x, top - 8, html.escape(a)))
    for i, t in enumerate(truths):
        total = sum(counts.get((t, a), 0) for a in answers)
        y = top + cell * i
        out.append('<text x="%d" y="%g" text-anchor="end">%s</text>' % (left - 8, y + cell / 2 + 4, html.escape(t)))
        for j, a in enumerate(answers):
            n = counts.get((t, a), 0)
            shade = n / total
            out.append('<rect x="%g" y="%g" width="%d" height="%d" fill="rgb(%d,%d,%d)" stroke="#ddd"/>' % (
                left + cell * j, y, cell, cell, 255 - 225 * shade, 255 - 155 * shade, 255 - 75 * shade))
            if n:
                out.append('<text x="%g" y="%g" text-anchor="middle" fill="%s">%d</text>' % (
                    left + cell * j + cell / 2, y + cell / 2 + 4, "#fff" if shade > 0.5 else "#222", n))
    return "\n".join(out + ["</svg>"])


def page(rows, rig):
    return ('<!doctype html><meta charset="utf-8"><title>Blind test of the model lab: %s</title>'
            '<body style="font-family:sans-serif;margin:2em;max-width:75em"><h1>Blind test of the model lab: %s</h1>'
            '<p>%d simulated sets, seeds %s to %s. Rows: what was hidden; columns: what was answered.</p>%s<pre>%s</pre>'
            % (rig, rig, len(rows), min(r["seed"] for r in rows), max(r["seed"] for r in rows), matrix_svg(rows),
               html.escape(text(rows, rig))))
