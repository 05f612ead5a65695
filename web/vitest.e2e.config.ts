import { defineConfig } from 'vitest/config';

/** The built pages in Chromium; with MEASURE=1 their figures instead of their tests. One file after the other: the browser draws 3-D on the processor. */
export default defineConfig({
  test: {
    environment: 'node',
    include: [process.env.MEASURE ? 'test/e2e/*.measure.ts' : 'test/e2e/**/*.test.ts'],
    globalSetup: ['test/e2e/build.ts'],
    fileParallelism: false,
    testTimeout: 60_000,
    hookTimeout: 60_000,
  },
});
