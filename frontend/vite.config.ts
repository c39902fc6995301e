import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import react from '@vitejs/plugin-react';
import type { Plugin } from 'vite';
import { defineConfig } from 'vitest/config';

const server = process.env.PARLEY_SERVER ?? 'http://127.0.0.1:8400';

/** Writes the worker that keeps the page's own files on the device, with the list of those files in it. */
const shellWorker = (): Plugin => ({
  name: 'shell-worker',
  apply: 'build',
  generateBundle(_options, bundle) {
    const source = readFileSync(new URL('./src/worker/shell-worker.js', import.meta.url), 'utf8');
    const files = Object.keys(bundle).filter((name) => name.startsWith('assets/')).sort();
    const version = createHash('sha256').update(source).update(files.join()).digest('hex').slice(0, 12);
    this.emitFile({
      type: 'asset',
      fileName: 'shell-worker.js',
      source: source
        .replace('__SHELL_VERSION__', version)
        .replace("['__SHELL_FILES__']", JSON.stringify(files.map((name) => `/${name}`))),
    });
  },
});

export default defineConfig({
  plugins: [react(), shellWorker()],
  resolve: { alias: { '@': fileURLToPath(new URL('./src', import.meta.url)) } },
  // The server puts a fresh value in its place; what styles itself at run time finds it there.
  html: { cspNonce: '__CSP_NONCE__' },
  build: {
    outDir: '../src/parley/web/static',
    emptyOutDir: true,
    // Nothing is inlined: the page's security policy allows files of its own server only.
    assetsInlineLimit: 0,
    target: 'es2022',
    chunkSizeWarningLimit: 1000,
  },
  server: {
    proxy: {
      '/api': { target: server, changeOrigin: true, ws: true },
      '/socket.io': { target: server, changeOrigin: true, ws: true },
    },
  },
  test: {
    environment: 'jsdom',
    maxWorkers: '100%', // on two cores it would be one
    include: ['src/**/*.test.{ts,tsx}'],
    setupFiles: ['src/test-setup.ts'],
    css: { modules: { classNameStrategy: 'non-scoped' } },
  },
});
