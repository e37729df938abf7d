// Pages in a headless Chromium: what axe-core finds in them, and whether report.html does what it says.
//   node pages.mjs NODE_MODULES axe PAGE.html …   findings that are serious or critical, light and dark, at two widths
//   node pages.mjs NODE_MODULES report PAGE.html  search, sorting, colours, the map
// Prints JSON. Ends with 77 where Chromium or a package is absent.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, what, ...pages] = process.argv.slice(2);
const need = createRequire(path.join(path.resolve(modules), '..', 'package.json'));
const program = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser'].find(p => p && fs.existsSync(p));
let chromium, axe;
try {
  chromium = need('playwright-core').chromium;
  axe = fs.readFileSync(need.resolve('axe-core'), 'utf8');
} catch (error) {
  console.error(`playwright-core and axe-core: npm install with tests/validators/package.json (${error.message.split('\n')[0]})`);
  process.exit(77);
}
if (!program) {
  console.error('chromium is not installed');
  process.exit(77);
}
const browser = await chromium.launch({ executablePath: program, args: ['--no-sandbox', '--disable-dev-shm-usage', '--disable-background-networking'] });
const messages = [];

async function open(file, width, colorScheme, javaScriptEnabled = true) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme, javaScriptEnabled });
  const page = await context.newPage();
  page.on('console', m => messages.push(`${path.basename(file)}: ${m.text()}`));
  page.on('pageerror', e => messages.push(`${path.basename(file)}: ${e.message}`));
  await page.goto(pathToFileURL(path.resolve(file)).href);
  return page;
}

async function findings(file) {
  const found = [];
  for (const [width, scheme] of [[1400, 'light'], [1400, 'dark'], [390, 'light']]) {
    const page = await open(file, width, scheme);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    if (wide > 0) found.push({ file, width, scheme, rule: 'wider than the window', at: `${wide} px` });
    // The one house that is chosen brings its facts with it; footprints by the thousand say nothing new to axe.
    await page.evaluate(() => {
      for (const d of document.querySelectorAll('details')) d.open = true;
      const first = document.querySelector('#house-table button.link');
      if (first) first.click();
      document.querySelectorAll('.footprints path').forEach((p, i) => { if (i > 50) p.remove(); });
      document.querySelectorAll('.objects').forEach(list => list.querySelectorAll('li').forEach((item, i) => { if (i > 10) item.remove(); }));
      document.querySelectorAll('.marks circle').forEach(c => c.remove());
    });
    await page.evaluate(axe);
    const result = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
    for (const v of result.violations)
      if (['serious', 'critical'].includes(v.impact))
        found.push({ file, width, scheme, rule: v.id, help: v.help, at: v.nodes.slice(0, 3).map(n => n.html.slice(0, 160)) });
    await page.context().close();
  }
  return found;
}

async function uses_of(file) {
  const out = {};
  const page = await open(file, 1400, 'light');
  const rows = () => page.$$eval('#house-table tbody tr', all => all.map(r => Array.from(r.cells).map(c => c.textContent)));
  out.houses = JSON.parse(await page.$eval('#house-data', e => e.textContent)).houses;
  out.rows = await rows();
  // Sorting, by every column, both ways.
  out.sorted = {};
  const heads = await page.$$('#house-table thead th');
  for (let column = 0; column < heads.length; ++column) {
    for (let times = 0; times < 2; ++times) {
      await (await heads[column].$('button')).click();
      const way = await heads[column].getAttribute('aria-sort');
      out.sorted[`${column} ${way}`] = (await rows()).map(r => r[column]);
      out.sorted_heads = await page.$$eval('#house-table th[aria-sort]', all => all.length);
    }
  }
  await page.reload();
  // Search: by id, by address, for nothing.
  const find = async words => {
    await page.fill('#house-search', words);
    return { hits: await page.$$eval('#house-hits button', all => all.map(b => b.textContent)), rows: await rows(),
             found: await page.textContent('#house-found'), count: await page.textContent('#house-count') };
  };
  const some = out.houses.find(h => h[1] !== '') || out.houses[0];
  out.wanted = some;
  out.by_id = await find(some[0]);
  out.by_address = await find(some[1]);
  out.none = await find('no such house anywhere');
  await find(some[0]);
  await page.press('#house-search', 'Enter');
  const card = () => page.$eval('#house-card', c => c.hidden ? null : c.textContent);
  out.card = await card();
  out.chosen = await page.$$eval('.footprints path.chosen', all => all.map(p => p.id));
  out.ring = await page.$eval('.ring', c => [c.getAttribute('cx'), c.getAttribute('cy')]);
  out.zoomed = await page.$eval('#map-svg', m => m.getAttribute('viewBox'));
  await page.click('#house-card button.link');
  out.row_chosen = await page.$$eval('#house-table tr.chosen', all => all.map(r => r.id));
  await page.click('#house-card .close');
  out.closed = await card();
  // A click on a footprint; the keyboard.
  await page.reload();
  const clickable = await page.$('.footprints path[id]');
  if (clickable) {
    out.clicked = await clickable.getAttribute('id');
    await clickable.dispatchEvent('click');
    out.card_of_click = await card();
    await page.focus('.frame');
    await page.keyboard.press('ArrowRight');
    out.card_of_key = await card();
    await page.keyboard.press('Escape');
    out.card_after_escape = await card();
  }
  // Colours: every radio button shows its own legend, in the colours of the map. Without the script as well.
  for (const script of [true, false]) {
    const p = await open(file, 1400, 'light', script);
    const themes = out[script ? 'themes' : 'themes_without_script'] = [];
    for (const label of await p.$$('.themes > label')) {
      await label.click();
      themes.push(await p.evaluate(() => {
        const letter = document.querySelector('.themes > input:checked').id.slice(3);
        const legends = Array.from(document.querySelectorAll('.legend')).filter(l => getComputedStyle(l).display !== 'none');
        const colour = Object.fromEntries(Array.from(legends[0].querySelectorAll('rect')).map(r => [r.className.baseVal.slice(1), getComputedStyle(r).fill]));
        const wrong = Array.from(document.querySelectorAll('.footprints path')).filter(path => {
          const k = path.className.baseVal.split(' ').find(c => c[0] === letter).slice(1);
          return getComputedStyle(path).fill !== colour[k];
        }).length;
        return { letter, legends: legends.map(l => l.className), wrong, colours: new Set(Object.values(colour)).size, classes: Object.keys(colour).length };
      }));
    }
    if (!script) {
      out.rows_without_script = await p.$$eval('#house-table tbody tr', all => all.length);
      out.links_without_script = await p.$$eval('#house-table tbody a', all => all.length);
    }
    await p.context().close();
  }
  // A block of the table of floor areas is shown on the map.
  const block = await page.$('.blocks tbody a');
  if (block) {
    await block.click();
    out.block = await page.evaluate(() => {
      const target = document.querySelector('.block-outlines path:target');
      return target ? { id: target.id, stroke: getComputedStyle(target).stroke, view: document.getElementById('map-svg').getAttribute('viewBox') } : null;
    });
  }
  return out;
}

let answer = [];
if (what === 'axe')
  for (const page of pages) answer.push(...await findings(page));
else
  answer = await uses_of(pages[0]);
await browser.close();
console.log(JSON.stringify({ answer, messages }));
