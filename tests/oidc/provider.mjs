// A real OpenID provider for the sign-in tests: listens on a free port, prints its issuer, then reads lines from standard input: first
// the address that it may send browsers back to, then "NAME GROUP…", the groups of a person from then on. Anybody may sign in there by any name: whom the server lets in is the
// server's to decide.
import {createServer} from 'node:http';
import {createInterface} from 'node:readline';

import Provider from 'oidc-provider';

const [algorithm = 'RS256'] = process.argv.slice(2);
const kinds = {
  RS256: {name: 'RSASSA-PKCS1-v1_5', modulusLength: 2048, publicExponent: new Uint8Array([1, 0, 1]), hash: 'SHA-256'},
  ES256: {name: 'ECDSA', namedCurve: 'P-256'},
};
const pair = await crypto.subtle.generateKey(kinds[algorithm], true, ['sign', 'verify']);
const signingKey = {...(await crypto.subtle.exportKey('jwk', pair.privateKey)), use: 'sig', alg: algorithm, kid: 'one'};
delete signingKey.key_ops;
delete signingKey.ext;

const groups = new Map();
let answer = (_request, response) => response.writeHead(503).end();
const server = createServer((request, response) => answer(request, response));
server.listen(0, '127.0.0.1', () => {
  const issuer = `http://127.0.0.1:${server.address().port}`;
  const lines = createInterface({input: process.stdin});
  lines.on('line', (line) => {
    const [name, ...its] = line.split(' ');
    if (!name.startsWith('http')) {
      groups.set(name, its);
      console.log('ready');
      return;
    }
    const redirect = line;
    const base = new URL(redirect).origin;
    const provider = new Provider(issuer, {
      clients: [{
        client_id: 'tractus',
        client_secret: 'secret of a test',
        redirect_uris: [redirect],
        post_logout_redirect_uris: [`${base}/`],
        id_token_signed_response_alg: algorithm,
      }],
      cookies: {keys: ['of a test']},
      features: {devInteractions: {enabled: true}, rpInitiatedLogout: {enabled: true}},
      jwks: {keys: [signingKey]},
      pkce: {required: () => true},
      claims: {openid: ['sub', 'name', 'groups']},
      conformIdTokenClaims: false,
      findAccount: (_context, id) => ({accountId: id, claims: () => ({sub: id, name: id, groups: groups.get(id) ?? []})}),
    });
    answer = provider.callback();
    console.log('ready');
  });
  lines.on('close', () => process.exit(0));
  console.log(issuer);
});
