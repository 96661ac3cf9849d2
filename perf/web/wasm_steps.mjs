// wasm_steps.mjs  node wasm_steps.mjs PAGE FIGURES STEPS: what native_steps plays, by the page's module; prints the same. V8 has compiled it
// whole after the first half, which is not counted.
import fs from 'node:fs';

const [folder, figures, steps] = process.argv.slice(2);
const {loadEngine} = await import(`${folder}/engine.js`);
const engine = await loadEngine(fs.readFileSync(`${folder}/sinew.wasm`));
engine.open(new Uint8Array(fs.readFileSync(`${folder}/characters/creature.sinew`)).buffer, Number(figures), 0);
engine.must(engine.calls.scene_set_clip(2));
const times = [[], []];
for (let i = 0; i < 2 * steps; ++i) {
  const begin_ms = performance.now();
  engine.step(1 / 60);
  if (i < steps) continue;
  times[0].push(engine.report().stepUs);
  times[1].push(1000 * (performance.now() - begin_ms));
}
console.log(times.map((all) => all.sort((a, b) => a - b)[all.length >> 1].toFixed(2)).join(' '));
