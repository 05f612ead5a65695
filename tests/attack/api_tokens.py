"""Personal API tokens: doing more with one than it says, keeping one alive, and wearing the server out with guesses."""
import secrets
import time

from report import attack, expect
from wire import Client


def token_of(world, person, scopes, **more):
    """A token that the person makes with the password, valid for an hour."""
    name = person.identity["name"]
    wish = {"name": "script", "scopes": scopes, "expires_utc_us": int((time.time() + 3600) * 1e6), "password": world.passwords[name]}
    return person.must("POST", "/tokens", wish | more)


def bearer(world, token, **more):
    client = Client(world.target, {"Authorization": f"Bearer {token}"} | more)
    return client


@attack("a thief of a trainee's token makes more tokens, changes the account, and reads what no scope has")
def beyond_the_scope(world):
    trainee = world.ours.trainee
    thief = bearer(world, token_of(world, trainee, ["trials:read"])["token"])
    expect(thief.ask("GET", "/trials").status == 200, "the token does not work at all")
    password = world.passwords[trainee.identity["name"]]
    tries = [("POST", "/tokens", {"name": "more", "scopes": ["trials:read"], "expires_utc_us": int((time.time() + 99) * 1e6), "password": password}),
             ("GET", "/tokens", None), ("POST", "/session/password", {"old": password, "new": secrets.token_urlsafe(12)}),
             ("DELETE", "/session", None), ("GET", "/audit", None), ("GET", "/accounts", None), ("GET", "/session/consent", None),
             ("GET", "/export/key.csv", None), ("GET", "/assignments", None)]
    for method, path, body in tries:
        answer = thief.ask(method, path, body)
        expect(answer.status in (403, 404), f"{method} {path}: {answer}")


@attack("an administrator's token with every scope reaches accounts, the pseudonym key and the audit trail")
def every_scope(world):
    scopes = [one["scope"] for one in world.admin.must("GET", "/tokens")["scopes"]]
    thief = bearer(world, token_of(world, world.admin, scopes)["token"])
    for path in ("/accounts", "/accounts/tokens", "/export/key.csv", "/audit", "/consents", "/tokens"):
        answer = thief.ask("GET", path)
        expect(answer.status in (403, 404), f"{path}: {answer}")


@attack("a token goes with a cookie of another person, and with the header twice")
def two_credentials(world):
    token = token_of(world, world.ours.trainee, ["trials:read"])["token"]
    cookie = world.people["faculty"].credentials["Cookie"]
    answer = bearer(world, token, Cookie=cookie).ask("GET", "/trials")
    expect(answer.status in (400, 401), f"token and cookie: {answer}")


@attack("a token outlives its account, a reset password and its revocation; a stranger revokes it")
def long_lived(world):
    person = world.account(f"leaver {secrets.token_hex(4)}", "trainee")
    path = f"/accounts/{person.identity['id']}"
    made = token_of(world, person, ["trials:read"])
    thief = bearer(world, made["token"])
    answer = world.ours.trainee.ask("DELETE", f"/tokens/{made['entry']['id']}")
    expect(answer.status == 404, f"a stranger revokes: {answer}")
    for state in ("disabled", "active"):
        world.admin.must("POST", path + "/state", {"state": state})
        answer = thief.ask("GET", "/trials")
        expect(answer.status == 401, f"account {state}: {answer}")


@attack("guessed tokens by the hundred: others of the same network are served, the rest is told to wait")
def guesses(world):
    token = token_of(world, world.ours.trainee, ["trials:read"])["token"]
    seen = {bearer(world, "tractus_" + secrets.token_hex(32)).ask("GET", "/trials").status for _ in range(80)}
    expect(seen <= {401, 429, 503}, f"guesses are answered {seen}")
    answer = bearer(world, token).ask("GET", "/trials")
    expect(answer.status == 200, f"a valid token of the same network: {answer}")
