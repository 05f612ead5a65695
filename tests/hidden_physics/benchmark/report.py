"""The table of a generation as text, JSON and one HTML page with the reliability curve."""
from __future__ import annotations

import dataclasses
import html
import json
import pathlib

import plan
import recordings
import scoring

RATES = [  # key, words
    ("nothing_said_nothing", "nothing hidden: says so"),
    ("false_alarm", "nothing hidden: false alarm"),
    ("single_exact", "one hidden: exact"),
    ("single_named_in", "one hidden: named, perhaps with others"),
    ("pair_both_exact", "two hidden: both and nothing else"),
    ("pair_both_named_in", "two hidden: both named"),
    ("outside_announced", "outside the catalogue: announced"),
    ("outside_right", "outside: announced, nothing wrong named"),
    ("undetectable_right", "below 2 %: nothing or the truth"),
    ("wrong_effect_named", "a wrong effect named"),
    ("useless_effect_named", "an effect named that lowers nothing"),
    ("intervals_hold_truth", "90 % intervals that hold the truth"),
    ("right_model_close", "right model in compare at most 1.05 floors"),
    ("right_model_phases_close", "right model, worst phase at most 1.2 floors"),
    ("answered", "answered"),
]
NUMBERS = [
    ("stated_mean", "stated probability, mean", "{:.3f}"),
    ("brier", "Brier score of it", "{:.3f}"),
    ("calibration_error", "expected calibration error", "{:.3f}"),
    ("held_out_over_floor", "held-out error / true floor, median and 90th percentile", "{:.2f}"),
    ("right_model_over_floor", "right model's error / true floor, median and 90th percentile", "{:.2f}"),
    ("stated_floor_over_floor", "stated floor / true floor, median", "{:.2f}"),
    ("judged_share", "share of the fresh samples that compare judges, median and 10th percentile", "{:.2f}"),
    ("cpu_s", "processor time of an answer, median and 90th percentile, s", "{:.1f}"),
    ("wall_s", "wall time of an answer, median and 90th percentile, s", "{:.1f}"),
]


def outcomes_of(place: pathlib.Path) -> dict:
    """Every solver's outcomes, in the order of the sets' names."""
    catalogue = json.loads((place / "catalogue.json").read_text()) if (place / "catalogue.json").exists() else None
    if not (place / "answers").is_dir():
        return {}
    if catalogue is None:
        raise SystemExit(f"hidden-physics: {place / 'catalogue.json'} is missing: run one set first")
    found = {}
    for folder in sorted((place / "answers").iterdir()):
        for path in sorted(folder.glob("*.json")):
            truth = json.loads((place / "truth" / path.name).read_text())
            outcome = scoring.outcome(truth, json.loads(path.read_text()), catalogue[truth["rig"]])
            found.setdefault(folder.name, []).append(outcome)
    return found


def shown_rate(r: scoring.Rate) -> str:
    if not r.count:
        return "-"
    low, high = r.interval
    return f"{r.hits}/{r.count} {100 * r.hits / r.count:.0f} % ({100 * low:.0f}-{100 * high:.0f})"


def shown(value, form) -> str:
    if value is None or value == [None, None]:
        return "-"
    return ", ".join(form.format(v) for v in (value if isinstance(value, list) else [value]))


def grid(rows: list) -> str:
    """Lines of aligned columns."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def table_of(groups: dict) -> list:
    """Rows of words and figures; a column for each group of outcomes."""
    computed = {name: scoring.figures(outcomes) for name, outcomes in groups.items()}
    rows = [["", *(f"{name} ({len(groups[name])})" for name in groups)]]
    for key, words in RATES:
        if any(c[key].count for c in computed.values()):
            rows.append([words, *(shown_rate(c[key]) for c in computed.values())])
    for key, words, form in NUMBERS:
        if any(c[key] not in (None, [None, None]) for c in computed.values()):
            rows.append([words, *(shown(c[key], form) for c in computed.values())])
    return rows


def by_effect(outcomes: list) -> list:
    """For each hidden effect of the detectable sets: how often it was named and what was said instead."""
    rows = [["hidden effect", "in sets", "right", "named", "wrong names, verdicts otherwise"]]
    groups: dict = {}
    for o in outcomes:
        if o.detectable:
            for key in o.hidden or (o.kind,):
                groups.setdefault((o.rig, len(o.hidden) == 2, key), []).append(o)
    for (rig, in_pair, key), group in sorted(groups.items()):
        said: dict = {}
        for o in group:
            if not o.right:
                what = "+".join(o.wrong) or ("missed " + "+".join(o.missed) if o.missed else o.verdict or "failed")
                said[what] = said.get(what, 0) + 1
        rows.append([f"{rig} {key}" + (" in a pair" if in_pair else ""), str(len(group)),
                     shown_rate(scoring.rate(o.right for o in group)), str(sum(key in o.named for o in group)),
                     ", ".join(f"{n} x {w}" for w, n in sorted(said.items(), key=lambda i: -i[1]))])
    return rows


def wrong_sets(outcomes: list) -> list:
    rows = [["set", "verdict", "named", "wrong", "missed", "stated", "gain of truth", "held-out/floor"]]
    for o in outcomes:
        if not o.right or o.useless:
            rows.append([o.set + ("" if o.detectable else " (below 2 %)"), o.failed[:60] or o.verdict,
                         "+".join(o.named) or "nothing", "+".join(o.wrong) or ("useless: " + "+".join(o.useless)
                                                                              if o.useless else "-"),
                         "+".join(o.missed) or "-", shown(o.probability, "{:.2f}"),
                         ", ".join(f"{g:.2f}" for g in o.gains.values()) or "-",
                         shown(o.held_out_over_floor, "{:.2f}")])
    return rows


def unhidden(catalogue: dict) -> list:
    """Effects of the program's catalogue that a full generator of their rig cannot hide, as rows."""
    rows = [["generator", "effects of the catalogue that it cannot hide"]]
    for rig, names in plan.GENERATORS.items():
        for name in sorted(set(names) - {"oscillators"}):  # the literature's oscillators have their own few
            module = plan.generator_module(name)
            made = {scoring.known_as(h, catalogue[rig]) for h in module.CATALOGUE + module.OUTSIDE}
            rows.append([name, ", ".join(sorted(set(catalogue[rig]) - made)) or "none"])
    return rows


def sections(place: pathlib.Path, generation: str) -> list:
    """(heading, rows) of the report, for text and page alike."""
    found = outcomes_of(place)
    rivals = {"best_single", "stlsq", "lasso_bic", "gaussian_process"}
    parts = []
    for rig in plan.GENERATORS:
        groups = {solver: [o for o in outcomes if o.rig == rig] for solver, outcomes in found.items()}
        groups = {solver: g for solver, g in sorted(groups.items(), key=lambda i: i[0] in rivals) if g}
        if groups:
            parts.append((f"{rig}: all generators, by solver", table_of(groups)))
    for solver, outcomes in found.items():
        if solver in rivals:
            continue
        generators = sorted({o.generator for o in outcomes})
        parts.append((f"{solver}: by generator", table_of({g: [o for o in outcomes if o.generator == g]
                                                           for g in generators})))
        parts.append((f"{solver}: by hidden effect", by_effect(outcomes)))
        stated = scoring.figures(outcomes)["reliability"]
        parts.append((f"{solver}: stated probability against how often it was right", [
            ["stated, mean", "right", "sets"], *([f"{p:.3f}", f"{r:.3f}", str(n)] for p, r, n in stated)]))
        if not plan.is_frozen(generation):
            parts.append((f"{solver}: answers that were not right", wrong_sets(outcomes)))
    if found:
        parts.append(("what the sets do not cover", unhidden(json.loads((place / "catalogue.json").read_text()))))
    for folder in sorted((place / "recordings").glob("*")):
        parts.append((f"{folder.name}: real recordings", recordings.rows_of(folder)))
    return parts


def reliability_curve(bins: list) -> str:
    """An SVG: stated probability against share right, with Wilson intervals; the area of a point is its count."""
    size, pad = 320, 40

    def at(p, r):
        return pad + p * (size - 2 * pad), size - pad - r * (size - 2 * pad)

    most = max((n for _, _, n in bins), default=1)
    (x0, y0), (x1, y1) = at(0, 0), at(1, 1)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size} {size}" width="{size}" height="{size}" '
             'role="img" aria-label="reliability curve">',
             f'<path d="M{x0} {y1}V{y0}H{x1}" fill="none" stroke="#888"/>',
             f'<line x1="{x0}" y1="{y0}" x2="{x1}" y2="{y1}" stroke="#bbb" stroke-dasharray="4"/>',
             f'<text x="{(x0 + x1) / 2}" y="{size - 8}" text-anchor="middle" font-size="12">stated probability</text>',
             f'<text x="12" y="{(y0 + y1) / 2}" font-size="12" text-anchor="middle" '
             f'transform="rotate(-90 12 {(y0 + y1) / 2})">share right</text>']
    for value in (0, 0.5, 1):
        x, y = at(value, value)
        parts += [f'<text x="{x}" y="{y0 + 14}" text-anchor="middle" font-size="10">{value:g}</text>',
                  f'<text x="{x0 - 4}" y="{y + 3}" text-anchor="end" font-size="10">{value:g}</text>']
    for p, r, n in bins:
        (x, y), (low, high) = at(p, r), scoring.wilson(round(r * n), n)
        parts += [f'<line x1="{x:.1f}" y1="{at(p, low)[1]:.1f}" x2="{x:.1f}" y2="{at(p, high)[1]:.1f}" stroke="#36c"/>',
                  f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{2 + 6 * (n / most) ** 0.5:.1f}" fill="#36c">'
                  f'<title>{n} sets: stated {p:.3f}, right {r:.3f}</title></circle>']
    return "".join(parts) + "</svg>"


def page(title: str, parts: list, curves: dict) -> str:
    body = [f"<!doctype html><html lang=en><meta charset=utf-8><title>{html.escape(title)}</title><style>"
            "body{font:14px system-ui;margin:2em;max-width:80em}table{border-collapse:collapse}"
            "td,th{padding:2px 10px;text-align:left;border-bottom:1px solid #ddd}</style>",
            f"<h1>{html.escape(title)}</h1><p>Simulated measurements, real recordings apart. "
            "Rates with 95 % intervals (Wilson).</p>"]
    for solver, bins in curves.items():
        body.append(f"<figure>{reliability_curve(bins)}<figcaption>{html.escape(solver)}: a point is a tenth of the "
                    "scale, its area the number of sets</figcaption></figure>")
    for heading, rows in parts:
        cells = ["<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in row) + "</tr>"
                 for tag, row in [("th", rows[0]), *(("td", r) for r in rows[1:])]]
        body.append(f"<h2>{html.escape(heading)}</h2><table>{''.join(cells)}</table>")
    return "".join(body) + "</html>\n"


def as_json(value):
    if isinstance(value, scoring.Rate):
        return {"hits": value.hits, "count": value.count, "interval": list(value.interval)}
    if isinstance(value, dict):
        return {k: as_json(v) for k, v in value.items()}
    return value


def written(place: pathlib.Path, generation: str) -> str:
    """Writes table.txt, table.json and table.html into the generation's folder. Returns the text."""
    found = outcomes_of(place)
    parts = sections(place, generation)
    frozen = plan.is_frozen(generation)
    title = f"Hidden physics, generation {generation}" + (" (frozen: never tune on it)" if frozen else "")
    text = f"{title}\n" + "".join(f"\n## {heading}\n{grid(rows)}\n" for heading, rows in parts)
    (place / "table.txt").write_text(text)
    values = {solver: {rig: as_json(scoring.figures([o for o in outcomes if o.rig == rig])) for rig in plan.GENERATORS}
              for solver, outcomes in found.items()}
    sets = {} if frozen else {solver: [dataclasses.asdict(o) for o in outcomes] for solver, outcomes in found.items()}
    (place / "table.json").write_text(json.dumps({"generation": generation, "figures": values, "sets": sets}, indent=1))
    curves = {solver: scoring.figures(outcomes)["reliability"] for solver, outcomes in found.items()}
    (place / "table.html").write_text(page(title, parts, {s: bins for s, bins in curves.items() if bins}))
    return text
