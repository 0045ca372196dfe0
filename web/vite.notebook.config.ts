import { readFileSync } from 'node:fs'
import { defineConfig } from 'vite'

const licence = readFileSync('public/licenses.txt', 'utf8').match(/== three\.js\n([\s\S]*?)\n== /)?.[1]

// The view for notebooks: one file with all it needs, since a notebook gives it to the browser as text.
export default defineConfig({
  publicDir: false,
  build: {
    outDir: `${process.env.BUILD ?? '../src/flexapod'}/notebook/static`,
    emptyOutDir: true,
    target: 'es2022',
    modulePreload: false,
    chunkSizeWarningLimit: 900,
    rollupOptions: {
      input: 'src/notebook/main.ts',
      preserveEntrySignatures: 'strict',
      output: { entryFileNames: 'view.js', codeSplitting: false, postBanner: `/* Contains three.js.\n${licence}*/` },
    },
  },
})
