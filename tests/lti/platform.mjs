// A learning platform for the tests: listens on a free port, prints its issuer, then reads lines of JSON from standard input.
//   {"tool": "http://127.0.0.1:8480", "client_id": "…"}     once: where the tool is; answered with "ready"
//   {"launch": {"assignment": "…", "deployment": "…"}}      what the next launches say; answered with "ready"
//   {"away": true}                                          the gradebook answers 500 from now on; answered with "ready"
//   {"scores": true}                                        answered with the scores that the gradebook took, as JSON
// Real, by npm's certified oidc-provider: sessions, sign-in, the authorisation endpoint (prompt=none, response_mode=form_post, redirect
// address, state, nonce), the id_token and the key set, access tokens by private_key_jwt against the tool's key set. Written here, after
// 1EdTech's published examples: the claims of LTI 1.3 (Core, section 5.3), and a gradebook of one line item, which takes a score with
// a token of the right scope only and checks its fields (AGS 2.0, section 3.4).
import {createServer} from 'node:http';
import {createInterface} from 'node:readline';

import Provider, {interactionPolicy} from 'oidc-provider';

// Standard output is for answers alone; what the library has to say goes beside it.
const answer = (line) => process.stdout.write(`${line}\n`);
console.log = console.info = console.warn = console.error;

const kScore = 'https://purl.imsglobal.org/spec/lti-ags/scope/score';
const claim = (name) => `https://purl.imsglobal.org/spec/lti/claim/${name}`;
const pair = await crypto.subtle.generateKey(
  {
    name: 'RSASSA-PKCS1-v1_5',
    modulusLength: 2048,
    publicExponent: new Uint8Array([1, 0, 1]),
    hash: 'SHA-256',
  },
  true,
  ['sign', 'verify'],
);
const signingKey = {
  ...(await crypto.subtle.exportKey('jwk', pair.privateKey)),
  use: 'sig',
  alg: 'RS256',
  kid: 'one',
};
delete signingKey.key_ops;
delete signingKey.ext;

// The tool has an http address of this machine, as native clients have, and is none.
const policy = interactionPolicy.base();
policy.get('consent').checks.remove('native_client_prompt');

let issuer = '',
  provider = null,
  launch = {},
  away = false;
const scores = [];

function launchClaims(subject) {
  return {
    sub: subject,
    [claim('message_type')]: 'LtiResourceLinkRequest',
    [claim('version')]: '1.3.0',
    [claim('deployment_id')]: launch.deployment,
    [claim('target_link_uri')]: launch.tool,
    [claim('resource_link')]: {id: 'link-1', title: 'Feel the wall'},
    [claim('roles')]: ['http://purl.imsglobal.org/vocab/lis/v2/membership#Learner'],
    [claim('context')]: {
      id: 'course-1',
      type: ['http://purl.imsglobal.org/vocab/lis/v2/course#CourseOffering'],
    },
    [claim('custom')]: {assignment: launch.assignment},
    'https://purl.imsglobal.org/spec/lti-ags/claim/endpoint': {
      scope: [kScore],
      lineitems: `${issuer}/items?course=1`,
      lineitem: `${issuer}/items/7?course=1`,
    },
  };
}

const configuration = (tool, clientId) => ({
  clients: [
    {
      client_id: clientId,
      application_type: 'native',
      redirect_uris: [`${tool}/api/v1/lti/launch`],
      response_types: ['id_token'],
      grant_types: ['implicit', 'client_credentials'],
      token_endpoint_auth_method: 'private_key_jwt',
      token_endpoint_auth_signing_alg: 'RS256',
      jwks_uri: `${tool}/api/v1/lti/keys`,
      scope: `openid ${kScore}`,
    },
    {
      client_id: 'course',
      client_secret: 'of a test',
      redirect_uris: [`${issuer}/course`],
    },
  ],
  scopes: ['openid', kScore],
  responseTypes: ['id_token', 'code'],
  cookies: {keys: ['of a test']},
  features: {
    devInteractions: {enabled: true},
    clientCredentials: {enabled: true},
    resourceIndicators: {enabled: false},
  },
  jwks: {keys: [signingKey]},
  pkce: {required: () => false},
  fetch: (url, {dispatcher: _toPublicAddressesAlone, ...options}) => fetch(url, options), // the tool is on this machine
  claims: {openid: Object.keys(launchClaims(''))},
  conformIdTokenClaims: false,
  interactions: {policy},
  findAccount: (_context, id) => ({
    accountId: id,
    claims: () => launchClaims(id),
  }),
  // The course's own tools need no consent of the person.
  async loadExistingGrant(context) {
    const grant = new context.oidc.provider.Grant({
      clientId: context.oidc.client.clientId,
      accountId: context.oidc.session.accountId,
    });
    grant.addOIDCScope('openid');
    await grant.save();
    return grant;
  },
});

/** What is wrong with a score (AGS 2.0, section 3.4.1); empty: nothing. */
function faultOf(score) {
  const known = ['userId', 'scoreGiven', 'scoreMaximum', 'activityProgress', 'gradingProgress', 'timestamp', 'comment'];
  const foreign = Object.keys(score).find((key) => !known.includes(key));
  if (foreign) return `unknown field ${foreign}`;
  if (!(score.scoreMaximum > 0) || !(score.scoreGiven >= 0)) return 'scoreGiven and scoreMaximum are numbers';
  if (!['Initialized', 'Started', 'InProgress', 'Submitted', 'Completed'].includes(score.activityProgress)) return 'activityProgress';
  if (!['FullyGraded', 'Pending', 'PendingManual', 'Failed', 'NotReady'].includes(score.gradingProgress)) return 'gradingProgress';
  if (!/^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d+(Z|[+-]\d\d:\d\d)$/.test(score.timestamp)) return 'timestamp with parts of a second';
  return typeof score.userId === 'string' ? '' : 'userId';
}

async function takeScore(request, response) {
  if (away) return response.writeHead(500).end();
  const token = await provider.ClientCredentials.find((request.headers.authorization ?? '').replace('Bearer ', ''));
  if (!token?.isValid || !token.scope?.split(' ').includes(kScore)) return response.writeHead(401).end();
  if (request.headers['content-type'] !== 'application/vnd.ims.lis.v1.score+json') return response.writeHead(415).end();
  let text = '';
  for await (const piece of request) text += piece;
  const score = JSON.parse(text);
  const fault = faultOf(score);
  if (!fault) scores.push(score);
  return response.writeHead(fault ? 400 : 204, fault).end();
}

const server = createServer((request, response) => {
  const {pathname} = new URL(request.url, issuer);
  if (pathname === '/course') return response.writeHead(200).end('the course');
  if (pathname === '/items/7/scores' && request.method === 'POST') return takeScore(request, response);
  return provider ? provider.callback()(request, response) : response.writeHead(503).end();
});

server.listen(0, '127.0.0.1', () => {
  issuer = `http://localhost:${server.address().port}`; // another site than the tool's 127.0.0.1
  const lines = createInterface({input: process.stdin});
  lines.on('line', (line) => {
    const said = JSON.parse(line);
    if (said.tool) {
      provider = new Provider(issuer, configuration(said.tool, said.client_id));
      provider.on('grant.error', (_context, error) => console.error(error));
    }
    if (said.launch) launch = said.launch;
    if ('away' in said) away = said.away;
    answer(said.scores ? JSON.stringify(scores) : 'ready');
  });
  lines.on('close', () => process.exit(0));
  answer(issuer);
});
