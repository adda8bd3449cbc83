// Makes dist/ from src/: the same bytes every time, for `cargo build` to embed. `npm ci && npm run build`
import { build } from 'esbuild';
import { mkdir, readFile, writeFile } from 'node:fs/promises';

await mkdir('dist', { recursive: true });
await build({
  entryPoints: ['src/main.js'],
  outfile: 'dist/view.js',
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  charset: 'ascii',
  legalComments: 'inline',
});
const licence = await readFile('node_modules/three/LICENSE', 'utf8');
const { version } = JSON.parse(await readFile('node_modules/three/package.json', 'utf8'));
await writeFile('dist/LICENSES.txt', `This page contains three.js ${version} (https://threejs.org):\n\n${licence.replaceAll('\r\n', '\n').trim()}\n`);
