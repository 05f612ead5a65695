/** A tractus-server of its own for one test file: a fresh data folder, the built pages, a free port, gone afterwards. */
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, openSync, rmSync, writeFileSync } from 'node:fs';
import { createServer, type AddressInfo } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const kRoot = fileURLToPath(new URL('../../..', import.meta.url));
const kFolders = [process.env.TRACTUS_BIN, `${kRoot}build/release/bin`, `${kRoot}build/dev/bin`];

/** The newest place that has all of them; undefined where they are not built. */
export function programs(...names: string[]): string | undefined {
  return kFolders.find((folder) => folder !== undefined && names.every((name) => existsSync(join(folder, name))));
}

async function freePort(): Promise<number> {
  const server = createServer();
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address() as AddressInfo;
  await new Promise((resolve) => server.close(resolve));
  return port;
}

export interface Served {
  readonly url: string;
  readonly folder: string;
  readonly log: string;
  readonly account: { readonly name: string; readonly password: string };
  readonly stop: () => Promise<void>;
}

const kPassword = 'a password for the tests';

/** `dist` is built by the run's set-up. */
export async function serveReal(bin: string, words: readonly string[] = []): Promise<Served> {
  const folder = mkdtempSync(join(tmpdir(), 'tractus-e2e-')),
    data = join(folder, 'data'),
    password = join(folder, 'password');
  writeFileSync(password, kPassword);
  const program = join(bin, 'tractus-server');
  execFileSync(program, ['init', '--data', data, '--admin-name', 'admin', '--password-file', password]);
  const log = join(folder, 'server.log');
  const port = await freePort(),
    url = `http://127.0.0.1:${port}`;
  const process_ = spawn(
    program,
    ['serve', '--plain', '--data', data, '--listen', `127.0.0.1:${port}`, '--web', `${kRoot}web/dist`, ...words],
    { stdio: ['ignore', 'ignore', openSync(log, 'a')] },
  );
  for (let i = 0; i < 200; ++i) {
    const answered = await fetch(`${url}/api/v1/session`).then(
      () => true,
      () => false,
    );
    if (answered) break;
    if (process_.exitCode !== null) throw new Error('tractus-server has ended');
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  return {
    url,
    folder,
    log,
    account: { name: 'admin', password: kPassword },
    stop: async () => {
      const ended = new Promise((resolve) => process_.once('exit', resolve));
      process_.kill();
      await ended;
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
