// What a browser does at a launch: signs in at the platform, follows the link to the tool, posts the platform's form. It keeps the cookies
// of each site and, as RFC 6265bis says, sends those without SameSite=None on no POST from another site. Prints one line of JSON:
// {"visited": [addresses], "cookies": {name: value}}, the tool's cookies. Usage: node browser.mjs ISSUER TOOL CLIENT_ID NAME [--again]
// --again: the platform's form is sent twice; the cookies are those after the second time.
const [issuer, tool, client, name, again] = process.argv.slice(2);
const jars = new Map();
const visited = [];

function keep(url, response) {
  const jar = jars.get(url.origin) ?? new Map();
  for (const line of response.headers.getSetCookie()) {
    const [pair, ...attributes] = line.split(';').map((part) => part.trim());
    const [key, ...value] = pair.split('=');
    const lower = attributes.map((one) => one.toLowerCase());
    if (lower.includes('max-age=0') || value.join('=') === '') jar.delete(key);
    else
      jar.set(key, {
        value: value.join('='),
        anywhere: lower.includes('samesite=none') && lower.includes('secure'),
      });
  }
  jars.set(url.origin, jar);
}

async function visit(address, {form, from} = {}) {
  const url = new URL(address);
  visited.push(url.origin + url.pathname + (url.pathname === '/' ? url.search : ''));
  const foreign = from !== undefined && new URL(from).hostname !== url.hostname;
  const sent = [...(jars.get(url.origin) ?? [])].filter(([, cookie]) => !(foreign && form) || cookie.anywhere);
  const response = await fetch(url, {
    method: form ? 'POST' : 'GET',
    redirect: 'manual',
    headers: {
      cookie: sent.map(([key, {value}]) => `${key}=${value}`).join('; '),
      ...(form
        ? {
            'content-type': 'application/x-www-form-urlencoded',
            origin: new URL(from).origin,
          }
        : {}),
    },
    body: form ? new URLSearchParams(form).toString() : undefined,
  });
  keep(url, response);
  return {url, response, text: await response.text()};
}

const inputs = (html) =>
  Object.fromEntries([...html.matchAll(/<input type="hidden" name="([^"]+)" value="([^"]*)"/g)].map((m) => [m[1], m[2]]));

/** Follows redirects, and fills in the platform's forms, until the path. */
async function goOn(at, until) {
  for (let step = 0; step < 20; ++step) {
    const to = at.response.headers.get('location');
    if (to) {
      const next = new URL(to, at.url);
      if (next.origin === tool && !next.pathname.startsWith('/api/')) {
        visited.push(next.origin + next.pathname + next.search);
        return at;
      }
      at = await visit(next);
      continue;
    }
    const action = /<form[^>]*action="([^"]+)"/.exec(at.text)?.[1];
    if (!action || at.url.pathname === until) return at;
    const target = new URL(action, at.url);
    const form = target.origin === tool ? inputs(at.text) : {prompt: 'login', login: name, password: 'any'};
    const before = at;
    at = await visit(target, {form, from: before.url});
    if (again && target.origin === tool) {
      jars.get(tool).delete('tractus_session');
      at = await visit(target, {form, from: before.url});
    }
  }
  return at;
}

const signIn = `${issuer}/auth?client_id=course&response_type=code&scope=openid&redirect_uri=${encodeURIComponent(`${issuer}/course`)}`;
await goOn(await visit(signIn), '/course');
const begin = new URLSearchParams({
  iss: issuer,
  login_hint: name,
  target_link_uri: tool,
  client_id: client,
});
await goOn(await visit(`${tool}/api/v1/lti/login?${begin}`));
console.log(
  JSON.stringify({
    visited,
    cookies: Object.fromEntries([...(jars.get(tool) ?? [])].map(([key, {value}]) => [key, value])),
  }),
);
