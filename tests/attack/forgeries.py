"""What somebody with write access to the records edits: (what it amounts to, SQL that SQLite and PostgreSQL take)."""

OUR_TRAINEE = "name = 'Our trainee'"
LAST_TRIAL = "(select max(id) from trials)"
LAST_SCORED = "(select max(trial_id) from trial_metrics)"

TRAIL = [
    ("an audit row's detail is rewritten",
     "update audit set detail = '{}' where number = (select max(number) from audit where detail <> '{}')"),
    ("an audit row in the middle is taken out", "delete from audit where number = (select max(number) - 3 from audit)"),
    ("the name in an audit row is another one",
     "update audit set who = 'nobody' where number = (select max(number) - 1 from audit)"),
]

ASSESSMENT = [
    ("a score is better", f"update trial_metrics set value = value + 1 where trial_id = {LAST_SCORED}"),
    ("a score is taken away", f"delete from trial_metrics where trial_id = {LAST_SCORED}"),
    ("a trial's answer is right now", f"update trials set correct = 1 - coalesce(correct, 0) where id = {LAST_TRIAL}"),
    ("a trial's events are others", f"update trials set events = '[]' where id = {LAST_TRIAL}"),
    ("a trial was done another day", f"update trials set started_utc_us = 1 where id = {LAST_TRIAL}"),
    ("a study's place is done", "update study_slots set state = 'recorded' where state = 'waiting'"),
    ("a study's place has another scenario",
     "update study_slots set case_id = (select max(id) from cases) where case_id <> (select max(id) from cases)"),
    ("a trial that counted is invalid", "update study_trials set state = 'invalid' where state = 'counts'"),
    ("a study's event is away", "delete from study_events where number = 1"),
    ("an assignment's results are held back", "update assignments set release = 'held'"),
    ("a locked analysis plan is another one", "update analysis_plans set title = 'forged'"),
    ("a plan was locked before the data were seen", "update analysis_plans set data_seen = 0, trials_then = 0"),
]

ACCESS = [
    ("a trainee is an administrator", f"update accounts set role = 'admin' where {OUR_TRAINEE}"),
    ("a switched-off account is on again", "update accounts set state = 'active' where name = 'gone'"),
    ("an administrator has a trainee's password",
     f"update accounts set password_hash = (select password_hash from accounts where {OUR_TRAINEE}) where name = 'admin'"),
    ("one-time codes are asked for no longer", "update accounts set totp_confirmed = 1 - totp_confirmed where name = 'admin'"),
    ("a trainee has another one's PIN",
     f"update accounts set pin_hash = (select pin_hash from accounts where {OUR_TRAINEE}) where name = 'Victim trainee'"),
    ("everybody agreed to everything", "update consents set tier = 'full'"),
    ("a word on consent is away", "delete from consents"),
    ("a trainee leads the cohort",
     f"update cohort_people set part = 'faculty' where account_id = (select id from accounts where {OUR_TRAINEE})"),
    ("the trainees are no longer in their cohorts", "delete from cohort_people where part = 'trainee'"),
    ("a revoked station is let in again", "update stations set revoked_utc_us = null where name = 'revoked'"),
    ("an account is linked with another identity",
     "insert into oidc_subjects (issuer, subject, account_id, linked_utc_us, linked_by) "
     "select 'https://evil.example', 's', id, 1, 'admin' from accounts where name = 'admin'"),
]

FORGERIES = TRAIL + ASSESSMENT + ACCESS
