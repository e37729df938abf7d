// The page of `blockrand view` in a browser: every function is used as a reader would, and what is seen is checked.
//   node view_page.mjs URL FOLDER [NODE_MODULES] > what_was_seen.json
// URL: a served build of LoD3 with its lists of places and explanations. FOLDER: takes the screenshots. NODE_MODULES: where
// playwright-core and axe-core are (tests/validators/package.json); default build/release/node_modules.
// Exit code 1: a check failed, told on stderr; 77: browser or packages are absent. The last line of stdout is JSON: time of the
// first picture, times between pictures while moving, bytes of the tiles.
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { difference, distance, hue_of, picture_reader } from './view_page_pictures.mjs';

const [url, pictures, given_modules] = process.argv.slice(2);
if (!pictures) {
  console.error('usage: node view_page.mjs URL FOLDER [NODE_MODULES]');
  process.exit(1);
}
const absent = (what) => {
  console.error(`absent: ${what}`);
  process.exit(77);
};
const modules = resolve(
  given_modules ?? join(dirname(fileURLToPath(import.meta.url)), '../../build/release/node_modules'),
);
const browser_file = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser'].find(
  (f) => f && existsSync(f),
);
if (!browser_file) absent('chromium (or name a browser in CHROMIUM)');
if (!existsSync(join(modules, 'playwright-core')))
  absent('npm package playwright-core: npm install with tests/validators/package.json');
const require = createRequire(pathToFileURL(join(modules, 'x.js')));
const { chromium } = require('playwright-core');
const axe_source = existsSync(join(modules, 'axe-core')) ? require('axe-core').source : null;
mkdirSync(pictures, { recursive: true });

const WIDE = { width: 1400, height: 900 },
  NARROW = { width: 390, height: 844 };
const PATIENCE = 180_000; // ms: software draws, perhaps beside other work
const problems = [];
let checks = 0;
const check = (holds, what, seen) => {
  ++checks;
  if (!holds) {
    problems.push(what);
    console.error(`FAILED: ${what}${seen === undefined ? '' : `: ${JSON.stringify(seen)}`}`);
  }
};

const browser = await chromium.launch({
  executablePath: browser_file,
  args: [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--ignore-gpu-blocklist',
    '--disable-dev-shm-usage',
    '--disable-background-networking',
  ],
});
const foreign = new Set(),
  messages = [];
let expected_errors = false; // while files are taken away on purpose

async function open(address, options = {}) {
  const context = await browser.newContext({ viewport: WIDE, ...options });
  await context.grantPermissions(['clipboard-read', 'clipboard-write']).catch(() => {});
  const page = await context.newPage();
  page.on('request', (request) => {
    const to = new URL(request.url());
    if (!['data:', 'blob:', 'file:'].includes(to.protocol) && to.host !== new URL(url).host) foreign.add(to.href);
  });
  page.on('console', (m) => m.type() === 'error' && !expected_errors && messages.push(m.text()));
  page.on('pageerror', (error) => messages.push(String(error)));
  if (options.prepare) await options.prepare(page);
  await page.goto(address);
  return page;
}
const state = (page) => page.evaluate('window.blockrandView ? blockrandView.state() : null');
async function until(page, test, what) {
  for (const end = Date.now() + PATIENCE; Date.now() < end; await page.waitForTimeout(60)) {
    const now = await state(page);
    if (now && test(now)) return now;
  }
  check(false, `waited in vain: ${what}`, await state(page));
  return state(page);
}
const settled = async (page) => {
  await page.waitForTimeout(120);
  return until(page, (s) => s.settled, 'a complete picture');
};
async function ready(page) {
  await until(page, (s) => s, 'the page starts');
  await page.evaluate('blockrandView.ready');
  return settled(page);
}

const pixels = await picture_reader(browser);
/** The picture of the houses alone, without what lies above it. */
const VIEW = { x: 330, y: 150, width: 660, height: 640 };
async function shot(page, name, clip = VIEW) {
  await page.screenshot({ path: join(pictures, `${name}.png`) });
  return pixels(await page.screenshot({ clip }));
}
const told = await (await fetch(new URL('view.json', url))).json();
const places = (await Promise.all(told.places.map(async (path) => (await fetch(new URL(path, url))).text())))
  .flatMap((text) => text.split('\n'))
  .filter(Boolean)
  .map((line) => line.split('\t'));
const seen = {};

/** Clicks over the picture until a house answers. */
async function click_a_house(page, box = VIEW, tap = false) {
  for (const [x, y] of [
    [0.5, 0.6],
    [0.3, 0.7],
    [0.7, 0.65],
    [0.4, 0.5],
    [0.6, 0.8],
    [0.2, 0.55],
    [0.8, 0.5],
    [0.5, 0.75],
  ]) {
    const at = [box.x + x * box.width, box.y + y * box.height];
    if (tap) await page.touchscreen.tap(...at);
    else await page.mouse.click(...at);
    await page.waitForTimeout(400);
    const { house } = await state(page);
    if (house) return house;
  }
  return null;
}
const panel_text = (page) => page.evaluate("document.querySelector('.bv-panel')?.innerText ?? ''");

async function axe(page, where) {
  if (!axe_source) return;
  await page.evaluate(axe_source);
  const found = await page.evaluate(
    "axe.run(document, { resultTypes: ['violations'] }).then((r) => r.violations.map((v) => [v.impact, v.id, v.nodes.map((n) => n.target.join(' ')).slice(0, 4)]))",
  );
  const serious = found.filter(([impact]) => ['serious', 'critical'].includes(impact));
  check(serious.length === 0, `axe-core, ${where}`, serious);
  (seen.axe ??= {})[where] = { serious: serious.length, others: found.length - serious.length };
}

// ---- the parts

async function first_picture_and_orbit(page) {
  const first = await ready(page);
  seen.first_picture_ms = Math.round(first.first_picture_ms);
  const picture = await shot(page, '01_first');
  check(first.shown.length > 0 && first.triangles > 1000, 'houses are shown', first);
  check(picture.colours > 300, 'the picture shows more than ground', picture.colours);
  check((await page.innerText('.bv-attribution')).includes('OpenStreetMap'), 'the source of the data is told');
  check((await page.innerText('.blockrand-view h1')) === told.name, 'the name of the build is told');
  check(first.failures.length === 0, 'no failure', first.failures);

  await page.mouse.move(660, 480);
  await page.mouse.down({ button: 'right' });
  for (let i = 1; i <= 8; ++i) {
    await page.mouse.move(660 + 25 * i, 480);
    await page.waitForTimeout(30);
  }
  await page.mouse.up({ button: 'right' });
  const turned = await settled(page);
  check(
    distance(turned.target, first.target) < 5 && distance(turned.camera, first.camera) > 40,
    'the right button turns about the middle',
    [first.camera, turned.camera],
  );
  const after = await shot(page, '02_turned');
  check(difference(picture, after) > 0.05, 'the turned picture is another', difference(picture, after));
  await page.mouse.move(660, 480);
  await page.mouse.wheel(0, -400);
  const nearer = await settled(page);
  // Movements run out within a time, however long a picture takes.
  const last = (await page.evaluate('blockrandView.frameTimes()')).slice(-5);
  const frame = last.reduce((sum, time) => sum + time, 0) / Math.max(1, last.length);
  check(
    (nearer.pictures - turned.pictures) * frame < 2500 + 12 * frame,
    'a movement takes few pictures where they are slow',
    [nearer.pictures - turned.pictures, frame],
  );
  check(
    distance(nearer.camera, nearer.target) < 0.95 * distance(turned.camera, turned.target),
    'the wheel goes nearer',
  );
  await page.focus('.blockrand-view canvas');
  for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowUp');
  const moved = await settled(page);
  check(distance(moved.target, nearer.target) > 3, 'arrow keys move', [nearer.target, moved.target]);
  for (let i = 0; i < 3; ++i) await page.keyboard.press('q');
  for (let i = 0; i < 3; ++i) await page.keyboard.press('+');
  const keyed = await settled(page);
  check(distance(keyed.camera, keyed.target) < 0.8 * distance(moved.camera, moved.target), 'plus goes nearer');
  check(distance(keyed.direction, moved.direction) > 0.2, 'Q turns');
  await page.click('button:has-text("Overview")');
  await page.waitForTimeout(1700);
  const back = await settled(page);
  check(distance(back.camera, first.camera) < 1, 'Overview goes back', [first.camera, back.camera]);
}

async function a_house(page) {
  const before = await shot(page, '03_before');
  const house = await click_a_house(page);
  check(house !== null, 'a click chooses a house');
  if (!house) return;
  await page.waitForTimeout(500);
  const now = await settled(page);
  const after = await shot(page, '04_house');
  check(difference(before, after) > 0.0005, 'the chosen house is marked', difference(before, after));
  check(decodeURIComponent(page.url()).includes(`#house=${house}`), 'the address keeps the house', page.url());
  check(now.on_screen !== null, 'the marker stands over it');
  const text = await panel_text(page);
  const tile = places.find(([id]) => id === house)?.[1];
  const explained =
    tile && told.explained ? (await (await fetch(new URL(`${told.explained}${tile}.json`, url))).json())[house] : null;
  if (told.explained) check(explained, 'there is an explanation of the house', house);
  if (explained) {
    check(text.includes(explained.title), 'the title of the explanation is shown', [
      explained.title,
      text.slice(0, 200),
    ]);
    check(
      explained.lines.every((line) => text.replace(/\s+/g, ' ').includes(line.replace(/\s+/g, ' ').trim())),
      'all lines are shown',
    );
  }
  check((await page.locator('.bv-panel tbody tr').count()) > 6, 'attributes are listed');
  const link = await page.getAttribute('.bv-panel a', 'href');
  check(
    /^https:\/\/www\.openstreetmap\.org\/(node|way|relation)\/\d+$/.test(link) && house.endsWith(link.split('/').pop()),
    'it links to OpenStreetMap',
    link,
  );
  await page.click('button:has-text("Copy link")');
  await page.waitForTimeout(200);
  const copied = await page.evaluate('navigator.clipboard.readText().catch(() => null)');
  check(copied === page.url(), 'the link is copied', copied);
  await page.click('[aria-label="Close the house"]');
  check((await state(page)).house === null && !page.url().includes('house='), 'closing gives the house up');
}

async function colours(page) {
  let before = await shot(page, '05_as_built');
  for (const [name, label] of [
    ['style', 'Style'],
    ['era', 'Era'],
    ['storeys', 'Storeys'],
    ['storeys_source', 'Source of storeys'],
    ['roof_source', 'Source of roof shape'],
  ]) {
    await page.locator('.bv-modes label', { has: page.locator(`input[value="${name}"]`) }).click();
    await settled(page);
    await page.waitForTimeout(200);
    const now = await state(page),
      picture = await shot(page, `06_${name}`);
    check(now.colour === name && page.url().includes(`colour=${name}`), `${label} is chosen`, page.url());
    check(
      now.legend.length > 0 && now.legend.every((entry) => entry.label && entry.count > 0),
      `${label} has a legend`,
      now.legend,
    );
    check(await page.locator('.bv-legend li').first().isVisible(), `the legend of ${label} is seen`);
    check(difference(before, picture) > 0.02, `${label} looks different`, difference(before, picture));
    const most = now.legend.reduce((a, b) => (a.count > b.count ? a : b)),
      hue = hue_of(most.colour);
    if (hue !== null) {
      const share = [-2, -1, 0, 1, 2].reduce((sum, step) => sum + picture.hues[(Math.floor(hue) + step + 36) % 36], 0);
      check(share > 0.03, `houses have the legend's colour of "${most.label}"`, share);
    }
    before = picture;
  }
  await page.locator('.bv-modes label', { has: page.locator('input[value="built"]') }).click();
  check((await settled(page)).legend.length === 0, 'as built has no legend');
}

async function sun(page) {
  await page.click('button:has-text("Sun")');
  const set = (label, value) =>
    page.evaluate(
      ([l, v]) => {
        const input = document.querySelector(`[aria-label="${l}"]`);
        input.value = v;
        input.dispatchEvent(new Event('input', { bubbles: true }));
      },
      [label, value],
    );
  await set('Date', 172);
  let highest = -9,
    at_noon = null;
  for (let minutes = 600; minutes < 900; minutes += 10) {
    await set('Time of day', minutes);
    const { altitude, azimuth } = (await state(page)).sun;
    if (altitude > highest) [highest, at_noon] = [altitude, azimuth];
  }
  const wanted = 90 - Math.abs(told.centre.lat - 23.44);
  check(Math.abs((highest * 180) / Math.PI - wanted) < 0.4, 'at midsummer the sun is as high as the latitude says', [
    (highest * 180) / Math.PI,
    wanted,
  ]);
  if (told.centre.lat > 24)
    check(Math.abs((at_noon * 180) / Math.PI - 180) < 5, 'at its highest it is in the south', at_noon);
  await set('Time of day', 540);
  await settled(page);
  const morning = await shot(page, '07_morning');
  await set('Time of day', 1080);
  await settled(page);
  const evening = await shot(page, '08_evening');
  check(difference(morning, evening) > 0.1, 'shadows move', difference(morning, evening));
  await set('Date', 355);
  await set('Time of day', 1380);
  await settled(page);
  const night = await shot(page, '09_night');
  check(night.light < 0.55 * morning.light, 'nights are darker', [morning.light, night.light]);
  check(/below the horizon/.test(await page.innerText('section[aria-label="Sun"]')), 'it is told that the sun has set');
  await set('Date', 135);
  await set('Time of day', 915);
  await page.click('button:has-text("Sun")');
  await settled(page);
}

async function walk(page) {
  await page.click('button:has-text("Walk")');
  await page.waitForTimeout(300);
  const start = await settled(page);
  const at_eye_height = (s) => Math.abs(s.camera[1] - s.ground - 1.7) < 0.01;
  const plane = -(start.camera[0] ** 2 + start.camera[2] ** 2) / (2 * 6371000);
  check(start.walking && at_eye_height(start), 'one walks at eye height', [start.camera, start.ground]);
  // A build with --terrain has ground through the feet of its houses, one without stands on the plane.
  check(
    start.hilly ? start.ground > plane + 0.1 : Math.abs(start.ground - plane) < 0.01,
    'the ground is where the houses stand',
    [start.hilly, start.ground, plane],
  );
  await shot(page, '10_walk');
  // A step is as long as a frame at most, and a frame of a busy machine takes seconds: the key is held for a way, not
  // for a time.
  await page.keyboard.down('KeyW');
  await until(page, (s) => distance(s.camera, start.camera) > 1, 'W walks a metre');
  await page.keyboard.up('KeyW');
  const gone = await settled(page);
  const step = gone.camera.map((v, i) => v - start.camera[i]);
  check(Math.hypot(...step) > 1, 'W walks', step);
  check(step[0] * start.direction[0] + step[2] * start.direction[2] > 0.9 * Math.hypot(step[0], step[2]), 'forwards');
  check(at_eye_height(gone), 'on the ground', [gone.camera, gone.ground]);
  await page.mouse.move(700, 500);
  await page.mouse.down();
  await page.mouse.move(900, 480, { steps: 4 });
  await page.mouse.up();
  const looked = await settled(page);
  check(distance(looked.direction, gone.direction) > 0.1, 'the mouse looks around', [gone.direction, looked.direction]);
  await page.keyboard.press('Escape');
  await page.waitForTimeout(1700);
  const left = await settled(page);
  check(!left.walking && left.camera[1] > 20, 'Escape leaves', left.camera);
}

async function search(page) {
  const place = places.find(([, , , , , address]) => /\d/.test(address)) ?? places[0];
  const [id, , , , , address] = place;
  const field = page.locator('.bv-search input');
  if (address) {
    await field.fill(address.split(',')[0].toLowerCase().replace('straße', 'str.'));
    await until(page, (s) => s.found.includes(id), `the search finds ${address}`);
    await page.waitForTimeout(100);
    await page.screenshot({ path: join(pictures, '11_search.png') });
    check((await page.innerText('.bv-status')).includes('found'), 'the number of hits is read out');
    check((await page.locator('#bv-hits li').count()) > 0, 'hits are listed');
  }
  await field.fill(id);
  await until(page, (s) => s.found[0] === id, 'the id is found');
  await field.press('ArrowDown');
  await field.press('Enter');
  await page.waitForTimeout(1700);
  const there = await settled(page);
  await page.waitForTimeout(600);
  check(there.house === id, 'it is chosen', there.house);
  check(
    there.on_screen &&
      there.on_screen[0] > 0 &&
      there.on_screen[0] < WIDE.width &&
      there.on_screen[1] > 0 &&
      there.on_screen[1] < WIDE.height,
    'it is in the picture',
    there.on_screen,
  );
  check(distance(there.camera, there.target) < 250, 'one has flown there', distance(there.camera, there.target));
  check((await panel_text(page)).includes('Attributes'), 'its panel is filled', await panel_text(page));
  check(
    (await shot(page, '12_found')).colours > 100 && there.triangles > 1000,
    'the picture shows it',
    there.triangles,
  );
  check(distance(there.camera, [0, 0, 0]) < 100_000, 'near the middle of the build', there.camera);
  await axe(page, 'wide, with a house');
  await field.fill('no such street 99');
  await page.waitForTimeout(600);
  check((await page.innerText('.bv-search')).includes('Nothing found'), 'what is not there is told');
  await field.fill('');
  return id;
}

async function link(id) {
  const page = await open(new URL(`#house=${id}&colour=era`, url).href);
  await ready(page);
  await page.waitForTimeout(1500);
  const now = await settled(page);
  check(now.house === id && now.colour === 'era' && now.legend.length > 0, 'a link brings house and colours', [
    now.house,
    now.colour,
  ]);
  check((await panel_text(page)).includes('Attributes'), 'and the panel');
  await shot(page, '13_link');
  await page.context().close();
  const lost = await open(new URL('#house=w999999999999', url).href);
  await ready(lost);
  await lost.waitForTimeout(500);
  const failures = (await state(lost)).failures;
  check(
    failures.some((text) => text.includes('w999999999999')),
    'a house that is not there is named',
    failures,
  );
  await lost.context().close();
}

async function narrow() {
  const page = await open(url, { viewport: NARROW, hasTouch: true, isMobile: true });
  await ready(page);
  await page.screenshot({ path: join(pictures, '14_narrow.png') });
  check(
    (await page.evaluate('document.scrollingElement.scrollWidth')) <= NARROW.width,
    'nothing is wider than the page',
  );
  await page.click('button:has-text("Colours")');
  await page.locator('.bv-modes label', { has: page.locator('input[value="storeys"]') }).click();
  await settled(page);
  await page.screenshot({ path: join(pictures, '15_narrow_colours.png') });
  await axe(page, 'narrow, with colours');
  await page.click('button:has-text("Colours")');
  const house = await click_a_house(page, { x: 10, y: 250, width: 370, height: 420 }, true);
  check(house !== null, 'a tap chooses a house');
  await page.waitForTimeout(700);
  await settled(page);
  await page.screenshot({ path: join(pictures, '16_narrow_house.png') });
  const sheet = await page.locator('.bv-panel').boundingBox();
  check(
    sheet && sheet.width === NARROW.width && sheet.y > 0.4 * NARROW.height && sheet.y + sheet.height <= NARROW.height,
    'the panel is a sheet from below',
    sheet,
  );
  check(
    await page.evaluate(
      "(() => { const b = document.querySelector('.bv-attribution').getBoundingClientRect(); return document.elementFromPoint(b.x + b.width / 2, b.y + b.height / 2)?.className === 'bv-attribution'; })()",
    ),
    'the source of the data is not covered',
  );
  await axe(page, 'narrow, with a house');
  await page.context().close();
}

async function failures() {
  expected_errors = true;
  const failing = async (options, wanted, what) => {
    const page = await open(url, options);
    for (const end = Date.now() + 30_000; Date.now() < end && !(await state(page))?.failures.length; )
      await page.waitForTimeout(100);
    const shown = (await state(page))?.failures ?? [];
    check(
      shown.some((text) => text.includes(wanted)),
      what,
      shown,
    );
    await page.screenshot({ path: join(pictures, `17_failure_${wanted.replace(/\W/g, '_')}.png`) });
    await page.context().close();
  };
  const without = (pattern) => ({
    prepare: (page) => page.route(pattern, (route) => route.fulfill({ status: 404, body: 'no' })),
  });
  await failing(without(/view\.json/), 'view.json', 'a missing view.json is named');
  await failing(without(/tileset\.json/), 'tileset.json', 'a missing tileset is named');
  await failing(without(/\.glb/), '.glb', 'a missing tile is named');
  await failing(
    {
      prepare: (page) =>
        page.addInitScript(() => {
          HTMLCanvasElement.prototype.getContext = () => null;
        }),
    },
    'WebGL',
    'a browser without WebGL is told so',
  );
  expected_errors = false;
}

/** A report that carries its model: opened from disk, the viewer in a box of it. */
async function embedded() {
  const text = async (path) => (await fetch(new URL(path, url))).text();
  const files = {};
  let bytes = 0;
  const take = async (path) => {
    const data = Buffer.from(await (await fetch(new URL(path, url))).arrayBuffer());
    bytes += data.length;
    files[path] = data.toString('base64');
    return data;
  };
  await take(told.tileset);
  const contents = [];
  const walk_tiles = (tile) => {
    if (tile.content) contents.push(tile.content.uri);
    (tile.children ?? []).forEach(walk_tiles);
  };
  walk_tiles(JSON.parse(Buffer.from(files[told.tileset], 'base64')).root);
  for (const uri of contents)
    if (bytes < 60_000_000 && !uri.endsWith('.json'))
      await take(new URL(uri, new URL(told.tileset, 'http://x/')).pathname.slice(1));
  files['view.json'] = Buffer.from(JSON.stringify({ ...told, places: [], explained: null })).toString('base64');
  const folder = mkdtempSync(join(tmpdir(), 'view-page-'));
  writeFileSync(
    join(folder, 'report.html'),
    `<!doctype html><html lang="en"><meta charset="utf-8"><title>report</title>
<style>h2 { color: rgb(1, 2, 3); font-size: 30px } ${await text('viewer.css')}</style><h2 id="own">Report</h2>
<div id="blockrand-view" style="width:900px;height:600px"></div><p>after</p>
<script type="application/json" id="blockrand-embedded">${JSON.stringify({ files })}</script>
<script>${(await text('viewer.js')).replaceAll('</script', '<\\/script')}</script>
<script>BlockrandView.start(document.getElementById('blockrand-view'))</script></html>`,
  );
  const page = await open(pathToFileURL(join(folder, 'report.html')).href);
  const now = await ready(page);
  check(now.shown.length > 0 && now.failures.length === 0, 'a report shows its own model', now);
  check(
    (await page.evaluate(
      "getComputedStyle(document.getElementById('own')).color + getComputedStyle(document.getElementById('own')).fontSize",
    )) === 'rgb(1, 2, 3)30px',
    'the look of the report stays',
  );
  check((await page.title()) === 'report', 'its title stays');
  const wheel = async () => {
    const before = await state(page);
    await page.mouse.move(430, 420);
    await page.mouse.wheel(0, -300);
    return distance((await settled(page)).camera, before.camera);
  };
  check((await wheel()) < 1, 'the wheel scrolls the report at first');
  const house = await click_a_house(page, { x: 330, y: 250, width: 560, height: 330 });
  await page.focus('.blockrand-view canvas');
  check((await wheel()) > 5, 'with the focus it zooms');
  await page.waitForTimeout(500);
  check(house !== null && (await panel_text(page)).includes('Attributes'), 'a house there has attributes', house);
  await page.screenshot({ path: join(pictures, '18_report.png') });
  await page.context().close();
  rmSync(folder, { recursive: true });
}

try {
  const page = await open(url);
  await first_picture_and_orbit(page);
  await a_house(page);
  await colours(page);
  await sun(page);
  await walk(page);
  const id = await search(page);
  const times = (await page.evaluate('blockrandView.frameTimes()')).sort((a, b) => a - b);
  seen.frame_ms = {
    median: Math.round(times[times.length >> 1]),
    worst_tenth: Math.round(times[Math.floor(0.9 * times.length)]),
    counted: times.length,
  };
  seen.memory = await page.evaluate('blockrandView.memory()');
  await page.context().close();
  await link(id);
  await narrow();
  await failures();
  await embedded();
  check(foreign.size === 0, 'no request to another host', [...foreign]);
  // What the software renderer says about itself is not about the page.
  const own = messages.filter((m) => !/GPU stall|GL Driver Message|swiftshader|WebGL-0x/i.test(m));
  check(own.length === 0, 'no error on the console', own.slice(0, 5));
} finally {
  await browser.close();
}
console.log(JSON.stringify({ checks, failed: problems, axe_core: axe_source !== null, ...seen }));
process.exit(problems.length ? 1 : 0);
