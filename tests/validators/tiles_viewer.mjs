// A build's tileset as a viewer shows it in a browser: everything loaded, where it stands, a picture.
//   node tiles_viewer.mjs BUILD NODE_MODULES PICTURE.png [VIEWER] > what_was_seen.json
// VIEWER: three, NASA's 3d-tiles-renderer (tiles_viewer_page.mjs), or cesium, CesiumJS (cesium_viewer_page.mjs); default three.
// The browser is Debian's chromium, or the one that CHROMIUM names. Exit code 77: browser or packages are absent.
// Everything comes from a server of this program's own on the local host; the network is not used.
import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const [build, modules, picture, viewer = 'three'] = process.argv.slice(2);
if (!picture || !['three', 'cesium'].includes(viewer)) {
  console.error('usage: node tiles_viewer.mjs BUILD NODE_MODULES PICTURE.png [three | cesium]');
  process.exit(1);
}
const absent = (what) => {
  console.error(`absent: ${what}`);
  process.exit(77);
};
const browser_file = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser'].find((f) => f && existsSync(f));
if (!browser_file) absent('chromium (or name a browser in CHROMIUM)');
for (const name of [...{ three: ['3d-tiles-renderer', 'three'], cesium: ['cesium'] }[viewer], 'playwright-core'])
  if (!existsSync(join(modules, name))) absent(`npm package ${name}: npm install with tests/validators/package.json`);

// The page needs what its scripts import by name; package.json of the renderer says where that lies.
const IMPORTS = {
  three: '/modules/three/build/three.module.js',
  'three/addons/': '/modules/three/examples/jsm/',
  '3d-tiles-renderer': '/modules/3d-tiles-renderer/build/index.js',
  '3d-tiles-renderer/plugins': '/modules/3d-tiles-renderer/build/index.plugins.js',
  '3d-tiles-renderer/src/': '/modules/3d-tiles-renderer/src/',
};
// CesiumJS as its package has it built: one script, which fetches its workers and tables from beside it.
const CESIUM = '/modules/cesium/Build/Cesium/';
const SCRIPTS = {
  three: `<script type="importmap">${JSON.stringify({ imports: IMPORTS })}</script>
<script type="module" src="/page/tiles_viewer_page.mjs"></script>`,
  cesium: `<script>window.CESIUM_BASE_URL = '${CESIUM}';</script><script src="${CESIUM}Cesium.js"></script>
<script type="module" src="/page/cesium_viewer_page.mjs"></script>`,
};
const PAGE = `<!doctype html><meta charset="utf-8"><title>tiles</title><style>body{margin:0}</style>
${SCRIPTS[viewer]}`;
const ROOTS = { modules, build, page: dirname(fileURLToPath(import.meta.url)) };
const TYPES = { '.wasm': 'application/wasm', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json', '.glb': 'model/gltf-binary' };

const missing = [];
const server = createServer((request, response) => {
  const path = decodeURIComponent(request.url.split('?')[0]);
  if (path === '/' || path === '/favicon.ico') {
    response.setHeader('content-type', 'text/html');
    return response.end(path === '/' ? PAGE : '');
  }
  const [, root, rest] = path.match(/^\/(\w+)(\/.*)$/) ?? [];
  const file = ROOTS[root] && join(ROOTS[root], normalize(rest));
  if (!file || !existsSync(file) || !statSync(file).isFile()) {
    missing.push(path);
    response.statusCode = 404;
    return response.end();
  }
  response.setHeader('content-type', TYPES[extname(file)] ?? 'application/octet-stream');
  createReadStream(file).pipe(response);
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

// playwright-core is CommonJS: found from the folder that holds it, wherever this file lies.
const { chromium } = createRequire(pathToFileURL(join(modules, 'x.js')))('playwright-core');
const browser = await chromium.launch({
  executablePath: browser_file,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
    '--disable-dev-shm-usage', '--disable-background-networking'],
});
const messages = [];
let seen;
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.on('console', (m) => ['error', 'warning'].includes(m.type()) && messages.push(m.text()));
  page.on('pageerror', (error) => messages.push(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction('window.seen', null, { timeout: 600_000 });
  seen = await page.evaluate('window.seen');
  await page.screenshot({ path: picture });
} finally {
  await browser.close();
  server.close();
}
// What the software renderer says about itself is not about the tileset.
const about_tiles = messages.filter((m) => !/GPU stall|GL Driver Message|swiftshader|WebGL-0x/i.test(m));
console.log(JSON.stringify({ ...seen, missing, messages: about_tiles }));
