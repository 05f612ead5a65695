/** Before the tests: against TRACTUS_URL, or else the pages, built anew unless PAGES_ARE_BUILT, served with the fixture. */
import type { TestProject } from 'vitest/node';
import { execFileSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { kAccount } from '../fixture/api.ts';
import { serveFixture } from '../fixture/server.ts';

declare module 'vitest' {
  export interface ProvidedContext {
    url: string;
    account: { name: string; password: string };
    /** The fixture is known to the last number; a real server is asked. */
    fixture: boolean;
  }
}

const kRoot = fileURLToPath(new URL('../..', import.meta.url));

export default async function setup(project: TestProject) {
  const url = process.env.TRACTUS_URL;
  if (url) {
    const name = process.env.TRACTUS_USER,
      password = process.env.TRACTUS_PASSWORD;
    if (!name || !password) throw new Error('TRACTUS_URL needs TRACTUS_USER and TRACTUS_PASSWORD');
    project.provide('url', url.replace(/\/$/, ''));
    project.provide('account', { name, password });
    project.provide('fixture', false);
    return;
  }
  // In a process of its own: within the test runner the libraries would be built for testing, and slow.
  if (!process.env.PAGES_ARE_BUILT)
    execFileSync('npm', ['run', '--silent', 'build', '--', '--logLevel', 'warn'], {
      cwd: kRoot,
      stdio: 'inherit',
      env: { ...process.env, NODE_ENV: 'production', VITEST: '' },
    });
  const { url: served, server } = await serveFixture(`${kRoot}/dist`);
  project.provide('url', served);
  project.provide('account', kAccount);
  project.provide('fixture', true);
  return () => server.close();
}
