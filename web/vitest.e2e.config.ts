import { defineConfig } from 'vitest/config';

/**
 * The built pages in Chromium; with MEASURE=1 their figures instead of their tests. One file after the other, unless the command line says
 * otherwise: the browser draws on the processor. The limits only end what hangs: a busy machine may take long.
 */
export default defineConfig({
  test: {
    environment: 'node',
    include: [process.env.MEASURE ? 'test/e2e/*.measure.ts' : 'test/e2e/**/*.test.ts'],
    globalSetup: ['test/e2e/build.ts'],
    fileParallelism: false,
    testTimeout: 180_000,
    hookTimeout: 180_000,
    expect: { poll: { timeout: 15_000 } },
  },
});
