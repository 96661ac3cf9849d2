// measure.mjs  node measure.mjs BUILD NATIVE_STEPS: what the page costs. BUILD: of tests/samples/web/put_together.sh.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import zlib from 'node:zlib';
import {moves, openPage, withBrowser} from '../../tests/samples/web/browser.mjs';

const [build, native] = process.argv.slice(2);
const folder = `${build}/page`, npm = `${build}/npm`, here = new URL('.', import.meta.url).pathname;
const kRounds = 7, kFigures = 16, kSteps = 600, kCrowd = 100, kBudget_ms = 4;
const median = (all) => [...all].sort((a, b) => a - b)[all.length >> 1];

function sizes() {
  const bytes = fs.readFileSync(`${folder}/sinew.wasm`), kb = (n) => `${Math.round(n / 1000)} kB`;
  console.log(`sinew.wasm: ${kb(bytes.length)}, gzip ${kb(zlib.gzipSync(bytes, {level: 9}).length)}, brotli ${kb(zlib.brotliCompressSync(bytes).length)}`);
}

// Both on one core, in turns.
function againstNative() {
  const ratios = [[], []], times = {native: [[], []], wasm: [[], []]};
  for (let round = 0; round < kRounds; ++round) {
    const run = (...command) => execFileSync('taskset', ['-c', '0', ...command], {encoding: 'utf8'}).trim().split(' ').map(Number);
    const of_native = run(native, `${folder}/characters/creature.sinew`, String(kFigures), String(kSteps), 'sse4');
    const of_wasm = run(process.execPath, `${here}/wasm_steps.mjs`, folder, String(kFigures), String(kSteps));
    for (const k of [0, 1]) times.native[k].push(of_native[k]), times.wasm[k].push(of_wasm[k]), ratios[k].push(of_wasm[k] / of_native[k]);
  }
  ['step', 'frame with poses and reads'].forEach((what, k) =>
    console.log(`${kFigures} creatures, ${what}: SSE4 ${median(times.native[k])} us, WebAssembly ${median(times.wasm[k])} us, ratio ${median(ratios[k]).toFixed(2)} (${Math.min(...ratios[k]).toFixed(2)} to ${Math.max(...ratios[k]).toFixed(2)})`));
}

// In a tab of a browser that has been running for a while.
async function firstMotion(browser, address) {
  const times_ms = [];
  for (let round = 0; round < kRounds; ++round) {
    const page = await openPage(browser, 'about:blank');
    await page.waitForTimeout(1500);
    await page.goto(address);
    await moves(page);
    times_ms.push(await page.evaluate(() => performance.getEntriesByName('first motion')[0].startTime));
    await page.context().close();
  }
  console.log(`first motion: median ${Math.round(median(times_ms))} ms after opening (${times_ms.map(Math.round).join(', ')}), drawn by software on the same two cores`);
}

async function crowd(browser, address) {
  const page = await openPage(browser, address, {hash: `#figures=${kCrowd}&budget=${kBudget_ms}&split=0&playing=0`});
  await page.waitForFunction(() => window.sinewPage?.characters.look, null, {timeout: 60000});
  const reports = await page.evaluate(async () => {
    const reports = [];
    // What has been asked to be drawn is drawn: the software that draws takes the cores.
    sinewPage.stage.renderer.getContext().readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4));
    for (let i = 0; i < 900; ++i) {
      sinewPage.engine.step(1 / 60);
      reports.push(sinewPage.engine.report());
      if (i % 60 === 0) await new Promise((resolve) => setTimeout(resolve));
    }
    return reports.slice(300);
  });
  const of = (name) => reports.map((report) => report[name]), mean = (all) => all.reduce((sum, x) => sum + x, 0) / all.length;
  console.log(`${kCrowd} creatures, ${kBudget_ms} ms: expected error ${mean(of('expectedError')).toFixed(3)} of skinning's, step ${(median(of('stepUs')) / 1000).toFixed(2)} ms, ` +
    ['network', 'modal', 'extrapolated', 'skinned', 'hidden'].map((tier) => `${mean(of(tier)).toFixed(0)} ${tier}`).join(', '));
  const drawn = await page.evaluate(async () => {
    const begin = performance.now();
    let pictures = 0;
    for (; performance.now() < begin + 8000; ++pictures) {
      sinewPage.stepBy(1 / 60), sinewPage.stage.draw(0);
      sinewPage.stage.renderer.getContext().readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4));  // until it is drawn
    }
    return (1000 * pictures) / (performance.now() - begin);
  });
  console.log(`${kCrowd} creatures: ${drawn.toFixed(1)} pictures a second, drawn by software on the same two cores`);
}

sizes();
againstNative();
await withBrowser({folder, npm}, async ({browser, address}) => {
  await firstMotion(browser, address);
  await crowd(browser, address);
});
