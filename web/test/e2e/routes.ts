/** Every page that a feature's manifest names, with what a test fills into its address. */
import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const kFeatures = fileURLToPath(new URL('../../src/features/', import.meta.url));

/** Patterns such as "/trials/:id", as the manifests write them. */
export function everyRoute(): string[] {
  const found = readdirSync(kFeatures).flatMap((feature) => {
    const manifest = readFileSync(`${kFeatures}${feature}/manifest.tsx`, 'utf8');
    return [...manifest.matchAll(/\bpath: '([^']+)'/g)].map(([, path]) => path ?? '');
  });
  return found.sort();
}

/** Addresses of a pattern: itself without parameters, else those that the test has. Empty: the test has none. */
export function addressesOf(pattern: string, known: Readonly<Record<string, readonly string[]>>): readonly string[] {
  return known[pattern] ?? (pattern.includes(':') ? [] : [pattern]);
}
