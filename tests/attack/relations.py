"""Items 2, 3 and 4: who reaches whom. Each single attack first; then every route with the ids of strangers."""
import random
import secrets
import time

from catalogue import plain_value, routes_of, sample
from report import NotTried, attack, expect
from trial_file import hand_over, trial_bytes
from world import VICTIM, json_text, quoted


@attack("2: faculty puts a stranger into a cohort of her own and reads the stranger's trials")
def stranger_into_cohort(world):
    faculty, theirs = world.ours.faculty, world.theirs
    faculty.ask("POST", f"/cohorts/{world.ours.cohort}/people", {"name": f"{VICTIM} trainee"})
    seen = faculty.ask("GET", f"/trials/{theirs.trial}")
    listed = faculty.ask("GET", "/trials?limit=200").body.decode()
    expect(seen.status in (403, 404), f"the stranger's trial: {seen.status}")
    expect(theirs.trial not in listed, "the stranger's trial is in faculty's list")
    badge = faculty.ask("POST", f"/accounts/{theirs.ids()['account']}/badge", {"badge": "666", "pin": "6666"})
    expect(badge.status in (403, 404), f"the stranger's badge is set: {badge.status}")


@attack("2: faculty and a trainee find strangers by searching, counting, or with an administrator's cursor")
def stranger_by_search(world):
    for person in (world.ours.faculty, world.ours.trainee):
        for rows in ("trials", "assignments"):
            found = person.must("GET", f"/{rows}?search={quoted(VICTIM)}&limit=200")
            expect(found["total"] == 0 and found[rows] == [], f"{rows} of {VICTIM}: {found['total']} are counted")
            cursor = world.admin.must("GET", f"/{rows}?limit=1")["next"] or ""
            own = {row["id"] for row in person.must("GET", f"/{rows}?limit=200")[rows]}
            behind = {row["id"] for row in person.must("GET", f"/{rows}?limit=200&cursor={cursor}")[rows]}
            expect(behind <= own, f"{rows} behind an administrator's cursor: {behind - own}")
    for secret in ("password_hash", "pseudonym", "id", "(select 1)"):
        answer = world.admin.ask("GET", f"/accounts?sort={quoted(secret)}")
        expect(answer.status == 400, f"accounts are sorted by {secret}: {answer.status}")


@attack("2: faculty takes over a trainee of no cohort, sets badge and PIN, and signs in with them at a station")
def stranger_by_badge(world):
    faculty, account = world.ours.faculty, world.stranger.identity["id"]
    faculty.ask("POST", f"/cohorts/{world.ours.cohort}/people", {"name": f"{VICTIM} of no cohort"})
    faculty.ask("POST", f"/accounts/{account}/badge", {"badge": "777", "pin": "7777"})
    inside = world.ours.station.ask("POST", "/work/sign-in", {"badge": "777", "pin": "7777"})
    expect(inside.status != 200, "the badge that faculty chose signs the stranger in")


@attack("2: faculty makes another faculty's trainee hers by a new cohort, an assignment or the list of people")
def stranger_by_assignment(world):
    faculty = world.ours.faculty
    mine = faculty.must("POST", "/cohorts", {"name": f"trap {secrets.token_hex(4)}"})["id"]
    body = {"title": "trap", "cases": [{"scenario": {"tuned": "hard"}}], "people": [f"{VICTIM} trainee"]}
    tried = [faculty.ask("POST", f"/cohorts/{mine}/people", {"name": f"{VICTIM} trainee"}),
             faculty.ask("POST", "/assignments", body),
             faculty.ask("POST", "/assignments", body | {"people": [], "cohort": world.theirs.cohort}),
             faculty.ask("POST", f"/assignments/{world.ours.assignment}/people", {"name": f"{VICTIM} trainee"})]
    there = faculty.ask("GET", f"/cohorts/{mine}").body.decode()
    inside = f"{VICTIM} trainee" in there and '"part":"trainee"' in there
    expect(not inside, "the stranger is a trainee of the new cohort")
    for answer in tried[1:]:
        expect(answer.status >= 400, f"an assignment took the stranger: {answer}")


@attack("2: faculty builds an assignment on the protocol of another faculty's assignment")
def strangers_protocol(world):
    body = {"title": "copied", "protocol": world.theirs.assignment, "cohort": world.ours.cohort}
    answer = world.ours.faculty.ask("POST", "/assignments", body)
    expect(answer.status >= 400, f"an assignment that she does not lead is her protocol: {answer.status}")


QUESTION = {"method": "ols", "formula": "probing_force_mean ~ number"}


def agree(world, tier):
    world.ours.trainee.must("POST", "/session/consent", {"tier": tier})


@attack("3: a researcher reads trials of people who agreed to nothing, with their real ids, in the cohort table")
def cohort_table(world):
    agree(world, "metrics")
    for role in ("researcher", "admin"):
        for query in ("", f"?study={world.theirs.assignment}"):
            text = world.people[role].ask("GET", f"/cohort/table{query}").body.decode()
            for what, marker in (("trial of somebody who agreed to nothing", world.theirs.trial),
                                 ("participant who agreed to nothing", world.theirs.participant),
                                 ("real id of a trial", world.ours.trial),
                                 ("code by which faculty know the participant", world.ours.participant)):
                expect(marker not in text, f"/cohort/table{query} by the {role}: the {what} is in it")


def finished(client, run):
    for _ in range(300):
        answer = client.must("GET", f"/cohort/analyses/{run}")
        if answer["state"] in ("done", "failed"):
            return answer
        time.sleep(0.1)
    raise NotTried("the analysis takes more than 30 s")


def analysed(world):
    """The data of an analysis that was asked for by a formula, as text; empty where it had none."""
    researcher = world.people["researcher"]
    run = researcher.must("POST", "/cohort/analyses", QUESTION)["id"]
    done = finished(researcher, run)
    parts = {part: researcher.ask("GET", f"/cohort/analyses/{run}/{part}") for part in ("data.csv", "result.json", "report.html")}
    return run, json_text(done), parts


@attack("3: a researcher reads them in the data, the result and the report of an analysis")
def analysis_data(world):
    agree(world, "metrics")
    run, told, parts = analysed(world)
    for part, text in [("the answer", told)] + [(part, answer.body.decode(errors="replace")) for part, answer in parts.items()]:
        for marker in (world.theirs.trial, world.theirs.participant, world.ours.finished_trial, world.ours.trial, world.ours.participant):
            expect(marker not in text, f"analysis {run}: {part} holds {marker}")


@attack("3: a researcher keeps the data of an analysis after the trainee withdrew")
def analysis_after_withdrawal(world):
    agree(world, "metrics")
    run, _, parts = analysed(world)
    rows = parts["data.csv"].body.decode(errors="replace").splitlines()[1:]
    if not rows:
        raise NotTried("the analysis had no rows")
    agree(world, "none")
    after = world.people["researcher"].ask("GET", f"/cohort/analyses/{run}/data.csv")
    kept = [row for row in rows if row in after.body.decode(errors="replace")]
    expect(after.status >= 400 or not kept, f"data.csv still gives {len(kept)} rows of who agreed to nothing")


@attack("3: the export, its arrays and its zip give what nobody agreed to")
def export_without_consent(world):
    agree(world, "summary")
    researcher = world.people["researcher"]
    for path in ("/export/trials.csv", "/export/scores.csv", "/export/cohort.zip?tier=full", "/export/summary.csv"):
        body = researcher.ask("GET", path).body
        for marker in (world.theirs.trial, world.ours.trial, world.theirs.participant, f"{VICTIM} trainee"):
            expect(marker.encode() not in body, f"{path} holds {marker}")
    rows = researcher.ask("GET", "/export/trials.csv").body.decode().splitlines()
    expect(len(rows) == 1, f"trials.csv has {len(rows) - 1} rows, and nobody agreed to more than counts")


def do_study_trial(world, name):
    """The participant's next trial at our station."""
    taken = world.ours.station.must("POST", f"/studies/{world.study}/participants/{name}/take")
    slot, trial_id = taken["trials"][0]["slot"], secrets.token_hex(16)
    answer = hand_over(world.ours.station, trial_id, slot, trial_bytes(trial_id, slot, name, seed=40))
    expect(answer.status == 200, f"the study's trial is not taken: {answer}")
    world.wait_for_scores()


@attack("3: a study tells which scenario a trial had before the participant is through")
def scenarios_before_the_end(world):
    do_study_trial(world, "S01")
    researcher = world.people["researcher"]
    for person in researcher.must("GET", f"/studies/{world.study}")["participants"]:
        told = [slot for slot in person["slots"] if slot["scenario"] is not None]
        expect(not told, f"the study tells it: {told}")
    researcher.must("POST", "/consents", {"study": world.study, "participant": "S01", "tier": "metrics", "basis": "form 1"})
    table = researcher.ask("GET", f"/cohort/table?study={world.study}").body.decode().splitlines()
    column = table[0].split(",").index("case") if table and "case" in table[0] else -1
    for row in table[1:]:
        expect(column < 0 or row.split(",")[column] == "", f"the cohort table tells a case before the participant is through: {row[:160]}")
    export = researcher.ask("GET", f"/export/trials.csv?study={world.study}").body.decode().splitlines()
    column = export[0].split(",").index("case")
    for row in export[1:]:
        expect(row.split(",")[column] == "", f"the export tells a case before the participant is through: {row[:160]}")


@attack("3: the secret part of a scenario is downloaded by those who are blind to it")
def scenario_part(world):
    cases = {case["id"] for case in world.people["researcher"].must("GET", "/cases")["cases"]}
    cases |= {one["id"] for one in world.ours.faculty.must("GET", "/scenarios")["tuned"]}
    for role in ("station", "trainee", "technician", "director"):
        for case in cases:
            answer = world.people[role].ask("GET", f"/cases/{case}/parts/scenario.json")
            expect(answer.status != 200, f"the {role} reads scenario.json: {answer}")


STUDY_DEEDS = [("POST", "/state", {"state": "paused", "reason": "attack"}), ("GET", "", None), ("GET", "/events", None),
               ("POST", "/participants", {"name": "S66"}), ("POST", "/participants/{participant}/state", {"state": "paused"}),
               ("POST", "/participants/{participant}/release", {"reason": "attack"}),
               ("POST", "/trials/{trial}/invalid", {"reason": "attack"})]


@attack("4: a researcher pauses, reads, enrols into and invalidates faculty's assignments by the routes of studies")
def study_routes_on_assignments(world):
    researcher, theirs = world.people["researcher"], world.theirs
    before = world.admin.must("GET", f"/assignments/{theirs.assignment}")
    worked = []
    for method, tail, body in STUDY_DEEDS:
        path = f"/studies/{theirs.assignment}" + tail.format(**theirs.ids())
        answer = researcher.ask(method, path, body)
        if answer.status < 400:
            worked.append(f"{method} {tail or '(the assignment)'}")
    researcher.ask("POST", f"/studies/{theirs.assignment}/state", {"state": "running"})
    researcher.ask("POST", f"/studies/{theirs.assignment}/participants/{theirs.participant}/state", {"state": "running"})
    after = world.admin.must("GET", f"/assignments/{theirs.assignment}")
    expect(not worked, "taken: " + ", ".join(worked))
    expect(before == after, "the assignment is another one afterwards")


@attack("4: a researcher makes an analysis, a plan or an export of an assignment as if it were a study")
def study_questions_of_assignments(world):
    researcher = world.people["researcher"]
    agree(world, "none")
    listed = researcher.ask("GET", "/studies").body.decode()
    expect(world.theirs.assignment not in listed, "an assignment is in the list of studies")
    answer = researcher.ask("GET", f"/cohort/table?study={world.theirs.assignment}")
    expect(answer.status >= 400 or answer.body.count(b"\n") <= 1, f"the table of an assignment without consent: {answer}")
    answer = researcher.ask("POST", "/cohort/analyses", QUESTION | {"study": world.theirs.assignment})
    expect(answer.status >= 400 or finished(researcher, answer.json()["id"])["state"] == "failed", "an analysis of it is made")


@attack("4: a station takes an assignment's places without badge and PIN")
def take_assigned_places(world):
    theirs = world.theirs
    for family in (world.ours, theirs):
        for ahead in ("", "?ahead=400"):
            answer = family.station.ask("POST", f"/studies/{theirs.assignment}/participants/{theirs.participant}/take{ahead}")
            expect(answer.status >= 400, f"{family.name} station: {answer}")


@attack("a station hands over a trial for a place that another station holds")
def strangers_slot(world):
    slot, trial_id = world.theirs.slot, secrets.token_hex(16)
    answer = hand_over(world.ours.station, trial_id, slot, trial_bytes(trial_id, slot, "forged", seed=66))
    expect(answer.status >= 400, f"the forged trial is taken: {answer}")


def whole_of_theirs(world):
    """All that an administrator can see of the other family: what no attack may change."""
    admin, theirs, out = world.admin, world.theirs, {}
    for path in (f"/cohorts/{theirs.cohort}", f"/assignments/{theirs.assignment}", f"/trials/{theirs.trial}",
                 f"/trials/{theirs.trial}/comments"):
        out[path] = admin.must("GET", path)
    accounts = admin.must("GET", "/accounts")["accounts"]
    out["accounts"] = [one for one in accounts if VICTIM in one["name"]]
    out["consents"] = [one for one in admin.must("GET", "/consents")["consents"] if VICTIM in (one["account"] or "")]
    out["stations"] = [one["revoked_utc_us"] for one in admin.must("GET", "/stations")["stations"] if VICTIM in one["name"]]
    out["ticket"] = theirs.next_slot()["slot"]
    out["session"] = theirs.trainee.ask("GET", "/session").status
    out["trials that our faculty sees"] = theirs.trial in world.ours.faculty.ask("GET", "/trials?limit=200").body.decode()
    return out


def bodies_for(route, ids, draw):
    """A body of the schema whose texts are what names a stranger."""
    if not route.takes_json:
        return [None]
    out = []
    for value in ids.values():
        body = sample(route.body_schema, route.schemas, draw)
        if isinstance(body, dict):
            for key, held in list(body.items()):
                if isinstance(held, str) and held in ("a", "0" * 32, "tuned", "x y z", "2026"):
                    body[key] = value
                elif isinstance(held, list):
                    body[key] = [value]
        out.append(body)
    return out


# Signing out and choosing a password change the attacker alone; a scenario's check answers with what it was sent.
LEFT_OUT = {"signOut", "changePassword", "signIn", "beginCodes", "confirmCodes", "endCodes", "enrolStation", "signOutAtStation"}


def leaks(answer, found):
    text = answer.body.decode(errors="replace")
    return [what for secret, what in found.items() if secret in text]


def own_ids(world):
    """An object of the attacker's own for each kind of path, so that only the body names a stranger."""
    ours = world.ours.ids()
    return {"cohorts": ours["cohort"], "assignments": ours["assignment"], "trials": ours["trial"], "accounts": ours["account"],
            "stations": ours["station"], "studies": world.study, "uploads": ours["trial"]}


def questions(world, route, draw):
    """(path, body): strangers in the path with any body, then the attacker's own in the path with strangers in the body."""
    ids = world.theirs.ids()
    bodies = bodies_for(route, ids, draw)
    if "{" in route.path or not route.takes_json:
        for value in ids.values():
            yield route.address(choose=lambda parameter: stranger_or_plain(parameter, value)), bodies[0]
    own = own_ids(world).get(route.path.removeprefix("/api/v1/").split("/")[0])
    if route.takes_json and (own or "{" not in route.path):
        for body in bodies:
            yield route.address(choose=lambda parameter: own if parameter["in"] == "path" else plain_value(parameter)), body


def asked_about_strangers(world):
    """Everything that was told of them."""
    draw, found, told, cells = random.Random(14), world.theirs.secrets(), set(), 0
    for route in routes_of(world):
        for role in ("faculty", "researcher", "trainee", "station"):
            if route.id in LEFT_OUT or role not in route.roles:
                continue
            for path, body in questions(world, route, draw):
                answer = world.people[role].ask(route.method, path, body, headers=route.headers())
                cells += 1
                for what in leaks(answer, found):
                    told.add(f"{role}: {route.method} {route.path} told {what}")
    print(f"      {cells} requests", flush=True)
    return told


@attack("every route that takes an id, in its path, query or body, is asked for strangers by dishonest insiders")
def relation_matrix(world):
    before = whole_of_theirs(world)
    told = asked_about_strangers(world)
    after = whole_of_theirs(world)
    told |= {f"{key} changed" for key in before if before[key] != after[key]}
    expect(not told, f"{len(told)}: " + "; ".join(sorted(told)[:12]))


def stranger_or_plain(parameter, value):
    if parameter["in"] == "path" or parameter["name"] in ("study", "parent", "model", "measurements"):
        return value
    return plain_value(parameter)


# deploy/large/nginx.conf.template answers 404 itself: a process's figures are not for those who come through the proxy.
KEPT_BY_NGINX = "/api/v1/server/metrics"


@attack("every route is called by every role, by nobody, and with somebody else's kind of credentials")
def role_matrix(world):
    values, cells, worked = {}, 0, []
    station, cookie = world.people["station"].credentials["Authorization"], world.people["trainee"].credentials["Cookie"]
    swapped = [{"Authorization": "Bearer " + cookie.split("=")[1]}, {"Cookie": "tractus_session=" + station.split()[1]},
               {"Authorization": "Bearer " + world.ours.ticket}, {"Cookie": "tractus_session=" + world.ours.ticket},
               {"Authorization": "Bearer " + "0" * 64}, {"Authorization": "Basic YWRtaW46YWRtaW4="}, {"Authorization": "Bearer "}]
    for route in routes_of(world):
        if route.open:
            continue
        kept = world.front == "nginx" and route.path == KEPT_BY_NGINX
        for role, client in world.people.items():
            if role in route.roles:
                continue
            answer = client.ask(route.method, route.address(values), headers=route.headers())
            cells += 1
            if answer.status != (404 if kept else 403):
                worked.append(f"{role}: {route.method} {route.path}: {answer.status}")
        for credentials in [{}] + swapped:
            nobody = world.nobody()
            nobody.credentials = credentials
            answer = nobody.ask(route.method, route.address(values), headers=route.headers())
            cells += 1
            if answer.status != (404 if kept else 401):
                worked.append(f"{list(credentials)}: {route.method} {route.path}: {answer.status}")
            nobody.line.close()
    print(f"      {cells} cells", flush=True)
    expect(not worked, f"{len(worked)} of {cells}: " + "; ".join(worked[:8]))


@attack("a route that nobody wrote down is asked for, with and without credentials")
def unknown_routes(world):
    for path in ("/api/v1/nothing", "/api/v2/trials", "/api/v1/trials/", "/api/v1//trials", "/api", "/api/v1/accounts/x/y/z"):
        for method in ("GET", "POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PROPFIND"):
            answer = world.nobody().ask(method, path)
            expect(answer.status in (400, 401, 404, 405), f"{method} {path} by nobody: {answer}")
            expect(quoted(VICTIM) not in answer.body.decode(errors="replace"), path)
