// Types of the API and names of the effects from the server's own description, into src/api/generated.
// TRACTUS_OPENAPI names the description; without it, the server built beside this folder is asked for it.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import openapiTS, { astToString } from 'openapi-typescript';

const root = fileURLToPath(new URL('..', import.meta.url));
const servers = ['release', 'dev'].map((preset) => `${root}../build/${preset}/bin/tractus-server`);

function fail(message) {
  console.error(`generate: ${message}`);
  process.exit(2);
}

function description() {
  const file = process.env.TRACTUS_OPENAPI;
  if (file) return existsSync(file) ? readFileSync(file, 'utf8') : fail(`${file}: there is no such file`);
  const server = servers.find(existsSync);
  if (!server) fail('build tractus-server first, or name its description in TRACTUS_OPENAPI');
  return execFileSync(server, ['openapi'], { encoding: 'utf8', maxBuffer: 64 << 20 });
}

let parsed;
try {
  parsed = JSON.parse(description());
} catch (reason) {
  fail(`the description is not JSON: ${reason.message}`);
}
const types = astToString(await openapiTS(parsed, { arrayLength: true }));
mkdirSync(`${root}src/api/generated`, { recursive: true });
writeFileSync(`${root}src/api/generated/schema.ts`, types);
writeFileSync(
  `${root}src/api/generated/effect-labels.ts`,
  `export const effectLabels: Readonly<Record<string, string | undefined>> = ${JSON.stringify(parsed['x-effect-labels'], null, 2)};\n`,
);
