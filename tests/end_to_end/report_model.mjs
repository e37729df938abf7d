// The model inside of a report that is opened from the disk: the button unpacks it and it is drawn.
//   node report_model.mjs REPORT.html NODE_MODULES
// Prints JSON: what the page was like before, how many colours the picture has, messages, addresses that it asked for.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { picture_reader } from './view_page_pictures.mjs';

const [report, modules] = process.argv.slice(2);
const absent = (what) => {
  console.error(`absent: ${what}`);
  process.exit(77);
};
const browser_file = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser'].find((f) => f && existsSync(f));
if (!browser_file) absent('chromium (or name a browser in CHROMIUM)');
if (!existsSync(join(modules, 'playwright-core'))) absent('npm package playwright-core');
const { chromium } = createRequire(pathToFileURL(join(modules, 'x.js')))('playwright-core');
const browser = await chromium.launch({
  executablePath: browser_file,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage'],
});
const page = await browser.newPage({ viewport: { width: 1400, height: 900 } });
const messages = [], foreign = [];
page.on('pageerror', (error) => messages.push(error.message));
page.on('console', (m) => m.type() === 'error' && messages.push(m.text()));
page.on('request', (r) => /^(file|blob|data):/.test(r.url()) || foreign.push(r.url()));
await page.goto(pathToFileURL(resolve(report)).href);
const before = (await page.locator('#blockrand-view').isHidden()) ? 'hidden' : 'shown';
await page.click('#show-model');
await page.waitForFunction(() => window.blockrandView, null, { timeout: 180000 });
await page.evaluate(() => window.blockrandView.ready);
const picture = await (await picture_reader(browser))(await page.locator('#blockrand-view').screenshot());
await browser.close();
console.log(JSON.stringify({ before, colours: picture.colours, messages, foreign }));
