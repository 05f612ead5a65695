/** axe-core's rules on a page. */
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import type { Page } from 'playwright-core';

const kAxe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

interface AxeRun {
  violations: { id: string; help: string; nodes: { target: string[]; failureSummary: string }[] }[];
}

type Run = (options: object) => Promise<AxeRun>;

/** The rules whose answer depends on the colour scheme. */
const kOfColours = ['color-contrast', 'link-in-text-block'];

/** Through the debugger, which the page's policy on scripts does not concern. */
export async function accessibilityFaults(page: Page, rules: 'all' | 'of colours' = 'all'): Promise<string[]> {
  await page.evaluate(kAxe);
  const options = rules === 'all' ? {} : { runOnly: kOfColours };
  const run = await page.evaluate((asked) => (window as unknown as { axe: { run: Run } }).axe.run(asked), options);
  return run.violations.flatMap(({ id, help, nodes }) =>
    nodes.map((node) => `${id}: ${help}: ${node.target.join(' ')} ${node.failureSummary}`),
  );
}
