import { defineConfig } from 'vite'

// Names without hashes: the bundle is committed, and the server answers with ETags.
export default defineConfig({
  base: './',
  build: {
    outDir: `${process.env.BUILD ?? '../src/flexapod'}/web/static`,
    emptyOutDir: true,
    target: 'es2022',
    modulePreload: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 900,
    rollupOptions: {
      output: {
        entryFileNames: 'assets/[name].js',
        chunkFileNames: 'assets/[name].js',
        assetFileNames: 'assets/[name][extname]',
      },
    },
  },
  server: { proxy: { '/api': 'http://127.0.0.1:8765' } },
})
