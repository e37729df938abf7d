// Makes the bundle: node build.mjs FOLDER. The same sources and package-lock.json give the same bytes.
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? 'bundle';
mkdirSync(out, { recursive: true });
const common = {
  absWorkingDir: here,
  bundle: true,
  minify: true,
  charset: 'utf8',
  target: ['es2022', 'chrome110', 'firefox115', 'safari16.4'],
  logLevel: 'warning',
  write: false,
};
const script = await build({
  ...common,
  entryPoints: ['src/start.ts'],
  format: 'iife',
  globalName: 'BlockrandView',
  legalComments: 'none',
  metafile: true,
  outfile: 'viewer.js',
  // Tiles come through our own reader: the formats of older tilesets stay out.
  alias: { 'three/addons/loaders/GLTFLoader.js': './src/no_gltf_loader.ts' },
  banner: {
    js: '/* Blockrand viewer, GPL-3.0-or-later; it holds three.js and others: LICENSES.txt. Built from viewer/ of the repository. */',
  },
});
const style = await build({ ...common, entryPoints: ['src/viewer.css'], outfile: 'viewer.css' });
writeFileSync(join(out, 'viewer.js'), script.outputFiles[0].contents);
writeFileSync(join(out, 'viewer.css'), style.outputFiles[0].contents);
cpSync(join(here, 'src/index.html'), join(out, 'index.html'));

// The packages of which something is in the bundle, and their licences word for word.
const packages = new Set();
for (const [path, { bytesInOutput }] of Object.entries(Object.values(script.metafile.outputs)[0].inputs)) {
  const found = path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
  if (found && bytesInOutput) packages.add(found[1]);
}
const texts = [...packages].sort().map((name) => {
  const folder = join(here, 'node_modules', name);
  const told = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const file = readdirSync(folder).find((f) => /^licen[cs]e/i.test(f));
  if (!file || !existsSync(join(folder, file))) throw new Error(`${name} has no licence file`);
  return `${name} ${told.version} (${told.license})\n\n${readFileSync(join(folder, file), 'utf8').trim()}\n`;
});
if (script.metafile && Object.keys(script.metafile.inputs).some((path) => path.includes('meshopt_decoder')))
  texts.push(readFileSync(join(here, 'src/meshopt_licence.txt'), 'utf8'));
const head =
  'Blockrand viewer: GPL-3.0-or-later, the licence of the repository.\n\nviewer.js holds parts of the following packages:\n';
writeFileSync(join(out, 'LICENSES.txt'), [head, ...texts].join(`\n${'-'.repeat(80)}\n\n`));
