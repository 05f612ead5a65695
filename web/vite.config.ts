import react from '@vitejs/plugin-react';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';
import type { Connect, Plugin } from 'vite';
import { configDefaults, defineConfig } from 'vitest/config';
import { makeFixture } from './test/fixture/api.ts';

/** Development without a server: the fixture answers /api in the dev server itself. */
function fixtureApi(): Plugin {
  return {
    name: 'fixture-api',
    apply: 'serve',
    configureServer(server) {
      const handle = makeFixture();
      const serve: Connect.NextHandleFunction = (request, response, next) => {
        if (request.url?.startsWith('/api/')) void handle(request, response);
        else next();
      };
      server.middlewares.use(serve);
    },
  };
}

/** Text that is worth compressing, and from which size on. */
const kText = /\.(html|js|css|svg|json)$/;
const kWorth_bytes = 256;

/** Beside each file of text its copies FILE.br and FILE.gz, which the server sends to browsers that read them. */
function compressedCopies(): Plugin {
  let folder = '';
  return {
    name: 'compressed-copies',
    apply: 'build',
    configResolved({ root, build }) {
      folder = join(root, build.outDir);
    },
    closeBundle() {
      for (const name of readdirSync(folder, { recursive: true, encoding: 'utf8' })) {
        if (!kText.test(name)) continue;
        const file = join(folder, name),
          text = readFileSync(file);
        if (text.length < kWorth_bytes) continue;
        const quality = { [constants.BROTLI_PARAM_QUALITY]: constants.BROTLI_MAX_QUALITY };
        writeFileSync(`${file}.br`, brotliCompressSync(text, { params: quality }));
        writeFileSync(`${file}.gz`, gzipSync(text, { level: constants.Z_BEST_COMPRESSION }));
      }
    },
  };
}

// TRACTUS_URL: a running tractus-server to develop against; without it the fixture's simulated trials are shown.
const server = process.env.TRACTUS_URL;

export default defineConfig({
  plugins: [react(), compressedCopies(), ...(server || process.env.VITEST ? [] : [fixtureApi()])],
  resolve: { alias: { '@': fileURLToPath(new URL('./src', import.meta.url)) } },
  server: server ? { proxy: { '/api': server } } : {},
  build: {
    target: 'es2022',
    // The server answers with a policy that allows no data: or inline code, so nothing is inlined.
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1200,
    // The server's pages, and the page that a station shows on its own screen.
    rolldownOptions: {
      input: ['index.html', 'kiosk.html'],
      // What every page needs of libraries is one file: it packs better than many, and stays the same from one version to the next.
      output: {
        codeSplitting: {
          groups: [
            {
              name: 'libraries',
              test: /node_modules\/(react|react-dom|scheduler|@tanstack\/(react-query|query-core)|wouter)\//,
            },
          ],
        },
      },
    },
    modulePreload: { polyfill: false }, // every browser that runs es2022 preloads modules itself
  },
  test: {
    environment: 'jsdom',
    include: ['src/**/*.test.{ts,tsx}', 'test/fixture/*.test.ts', 'test/language/*.test.ts'],
    exclude: [...configDefaults.exclude, 'test/e2e/**'],
    testTimeout: 20_000, // other work on the machine slows a test down
    restoreMocks: true,
  },
});
