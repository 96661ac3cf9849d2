// browser.mjs  Opens the page in headless Chromium. Exits with 77, skipped, where the page was not put together, or there is no browser.
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';

const kSkipped = 77;
const kQuiet = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const kSoftwareDrawing = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
export const kDesk = {width: 1280, height: 800}, kPhone = {width: 390, height: 844};

export function skip(why) {
  console.error(`skipped: ${why}`);
  process.exit(kSkipped);
}

function findChromium() {
  return [process.env.SINEW_CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((path) => path && fs.existsSync(path));
}

// In a process of its own, as for a user.
async function serve(folder) {
  const server = spawn(process.execPath, [new URL('../../../samples/web/serve.mjs', import.meta.url).pathname, folder], {stdio: ['ignore', 'pipe', 'inherit']});
  for await (const line of server.stdout) return {server, address: /http:\S+/.exec(line)[0]};
  throw new Error('serve.mjs ended');
}

// folder: of the page; npm: where playwright-core is. use({browser, address}).
export async function withBrowser({folder, npm, drawing = kSoftwareDrawing}, use) {
  if (!fs.existsSync(`${folder}/sinew.wasm`)) skip('the page was not put together');
  let playwright;
  try {
    playwright = createRequire(`${npm}/`)('playwright-core');
  } catch {
    skip('npm could not install playwright-core');
  }
  const executablePath = findChromium();
  if (!executablePath) skip('there is no Chromium');
  const {server, address} = await serve(folder);
  const browser = await playwright.chromium.launch({executablePath, args: [...kQuiet, ...drawing]});
  try {
    await use({browser, address});
  } finally {
    await browser.close();
    server.kill();
  }
}

// A page whose console must stay clean: check() throws what it said.
export async function openPage(browser, address, {hash = '', viewport = kDesk, init, ...context} = {}) {
  const page = await (await browser.newContext({viewport, ...context})).newPage();
  const said = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) said.push(message.text()); });
  page.on('pageerror', (error) => said.push(error.stack));
  if (init) await page.addInitScript(init);
  await page.goto(address + hash);
  page.check = () => { if (said.length) throw new Error(`the console says: ${said.join('\n')}`); };
  page.isIgnored = (pattern) => { for (let i = said.length; i--;) if (pattern.test(said[i])) said.splice(i, 1); };
  return page;
}

export const moves = (page) => page.waitForFunction(() => window.sinewPage?.plot.frames.length > 2, null, {timeout: 60000});
export const message = (page) => page.evaluate(() => (document.getElementById('message').hidden ? '' : document.querySelector('#message span').textContent));
