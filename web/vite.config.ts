import react from '@vitejs/plugin-react';
import { fileURLToPath } from 'node:url';
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

// TRACTUS_URL: a running tractus-server to develop against; without it the fixture's simulated trials are shown.
const server = process.env.TRACTUS_URL;

export default defineConfig({
  plugins: [react(), ...(server || process.env.VITEST ? [] : [fixtureApi()])],
  resolve: { alias: { '@': fileURLToPath(new URL('./src', import.meta.url)) } },
  server: server ? { proxy: { '/api': server } } : {},
  build: {
    target: 'es2022',
    // The server answers with a policy that allows no data: or inline code, so nothing is inlined.
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1200,
  },
  test: {
    environment: 'jsdom',
    include: ['src/**/*.test.{ts,tsx}', 'test/fixture/*.test.ts'],
    exclude: [...configDefaults.exclude, 'test/e2e/**'],
    restoreMocks: true,
  },
});
