// model.glb as three.js' GLTFLoader reads it in a browser: every house with its name, what is drawn, a picture.
//   node model_viewer.mjs MODEL.glb NODE_MODULES PICTURE.png > what_was_seen.json
// The browser is Debian's chromium, or the one that CHROMIUM names. Exit code 77: browser or packages are absent.
// Everything comes from a server of this program's own on the local host; the network is not used.
import { createReadStream, existsSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { extname, join, normalize } from 'node:path';
import { pathToFileURL } from 'node:url';

const [model, modules, picture] = process.argv.slice(2);
if (!picture) {
  console.error('usage: node model_viewer.mjs MODEL.glb NODE_MODULES PICTURE.png');
  process.exit(1);
}
const absent = (what) => {
  console.error(`absent: ${what}`);
  process.exit(77);
};
const browser_file = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser'].find((f) => f && existsSync(f));
if (!browser_file) absent('chromium (or name a browser in CHROMIUM)');
for (const name of ['three', 'playwright-core'])
  if (!existsSync(join(modules, name))) absent(`npm package ${name}: npm install with tests/validators/package.json`);

const IMPORTS = { three: '/modules/three/build/three.module.js', 'three/addons/': '/modules/three/examples/jsm/' };
const PAGE = `<!doctype html><meta charset="utf-8"><title>model</title>
<script type="importmap">${JSON.stringify({ imports: IMPORTS })}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
try {
  const gltf = await new GLTFLoader().loadAsync('/model.glb');
  const seen = { houses: [], meshes: 0, triangles: 0, empty: 0, smooth: 0 };
  // GLTFLoader makes names unique and free of blanks; that of the file stays in userData.
  for (const house of gltf.scene.children) seen.houses.push([house.userData.id, house.userData.name, house.children.length]);
  gltf.scene.traverse((object) => {
    if (!object.isMesh) return;
    seen.meshes += 1;
    const count = object.geometry.index.count / 3;
    seen.triangles += count;
    if (count === 0) seen.empty += 1;
    if (!object.material.flatShading && !object.geometry.attributes.normal) seen.smooth += 1;
  });
  const scene = new THREE.Scene();
  scene.background = new THREE.Color('#c9d9e6');
  scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x888877, 2));
  const sun = new THREE.DirectionalLight(0xffffff, 2);
  sun.position.set(-1, 2, 1);
  scene.add(sun);
  const box = new THREE.Box3().setFromObject(gltf.scene), middle = box.getCenter(new THREE.Vector3());
  const reach = box.getSize(new THREE.Vector3()).length() / 2;
  const camera = new THREE.PerspectiveCamera(40, 1.6, 1, 10 * reach);
  camera.position.set(middle.x - reach, middle.y + 1.2 * reach, middle.z + 1.4 * reach);
  camera.lookAt(middle);
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(960, 600);
  renderer.render(scene, camera);
  seen.drawn = renderer.info.render.triangles;
  seen.picture = renderer.domElement.toDataURL('image/png');
  window.seen = seen;
} catch (error) {
  window.seen = { error: String(error?.stack ?? error) };
}
</script>`;
const TYPES = { '.js': 'text/javascript', '.mjs': 'text/javascript' };
const server = createServer((request, response) => {
  const path = decodeURIComponent(request.url.split('?')[0]);
  if (path === '/' || path === '/favicon.ico') {
    response.setHeader('content-type', 'text/html');
    return response.end(path === '/' ? PAGE : '');
  }
  const file = path === '/model.glb' ? model : join(modules, normalize(path.replace(/^\/modules/, '')));
  if ((path !== '/model.glb' && !path.startsWith('/modules/')) || !existsSync(file) || !statSync(file).isFile()) {
    response.statusCode = 404;
    return response.end();
  }
  response.setHeader('content-type', TYPES[extname(file)] ?? 'application/octet-stream');
  createReadStream(file).pipe(response);
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

const { chromium } = createRequire(pathToFileURL(join(modules, 'x.js')))('playwright-core');
const browser = await chromium.launch({
  executablePath: browser_file,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist',
    '--disable-dev-shm-usage', '--disable-background-networking'],
});
const messages = [];
let seen;
try {
  const page = await browser.newPage();
  page.on('console', (m) => ['error', 'warning'].includes(m.type()) && messages.push(m.text()));
  page.on('pageerror', (error) => messages.push(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction('window.seen', null, { timeout: 600_000 });
  seen = await page.evaluate('window.seen');
} finally {
  await browser.close();
  server.close();
}
if (seen.error) {
  console.error(seen.error);
  process.exit(1);
}
writeFileSync(picture, Buffer.from(seen.picture.split(',')[1], 'base64'));
delete seen.picture;
// What the software renderer says about itself is not about the model.
seen.messages = messages.filter((m) => !/GPU stall|GL Driver Message|swiftshader|WebGL-0x/i.test(m));
console.log(JSON.stringify(seen));
