// What a browser does at sign-in: follows redirects, keeps each site's cookies, fills in the provider's forms. Prints one line of
// JSON: {"visited":[addresses],"cookies":{of the server}}. Usage: node browser.mjs START_ADDRESS NAME [--tamper state|code|nocookie]
const [start, name, , tamper] = process.argv.slice(2);
const jars = new Map();
const visited = [];

function keep(url, response) {
  const jar = jars.get(url.origin) ?? new Map();
  for (const line of response.headers.getSetCookie()) {
    const [pair, ...attributes] = line.split(';');
    const [key, ...value] = pair.split('=');
    const gone = attributes.some((a) => a.trim().toLowerCase() === 'max-age=0') || value.join('=') === '';
    if (gone) jar.delete(key);
    else jar.set(key, value.join('='));
  }
  jars.set(url.origin, jar);
}

async function visit(address, form) {
  const url = new URL(address);
  visited.push(url.origin + url.pathname + (url.pathname === '/' ? url.search : ''));
  const cookies = [...(jars.get(url.origin) ?? [])].map(([k, v]) => `${k}=${v}`).join('; ');
  const response = await fetch(url, {
    method: form ? 'POST' : 'GET',
    redirect: 'manual',
    headers: {cookie: cookies, ...(form ? {'content-type': 'application/x-www-form-urlencoded'} : {})},
    body: form ? new URLSearchParams(form).toString() : undefined,
  });
  keep(url, response);
  return {url, response, text: await response.text()};
}

const home = new URL(start).origin;
let at = await visit(start);
for (let step = 0; step < 20; ++step) {
  const to = at.response.headers.get('location');
  if (to) {
    const next = new URL(to, at.url);
    const back = next.origin === home && next.pathname.endsWith('/callback');
    if (back && tamper === 'state') next.searchParams.set('state', 'another');
    if (back && tamper === 'code') next.searchParams.set('code', 'another');
    if (back && tamper === 'nocookie') jars.delete(home);
    if (next.origin === home && !back) {
      visited.push(next.origin + next.pathname + next.search);
      break;
    }
    at = await visit(next);
    continue;
  }
  const action = /<form[^>]*action="([^"]+)"/.exec(at.text);
  if (!action) break;
  const prompt = /name="prompt" value="([^"]+)"/.exec(at.text);
  const form = prompt?.[1] === 'login' ? {prompt: 'login', login: name, password: 'any'} : {prompt: prompt?.[1] ?? ''};
  at = await visit(new URL(action[1], at.url), form);
}
console.log(JSON.stringify({visited, cookies: Object.fromEntries(jars.get(home) ?? [])}));
