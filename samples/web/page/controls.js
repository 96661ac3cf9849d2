// controls.js  The panel: each control shows one setting and changes it.
import {kNoBudget_ms, kWhole} from './settings.js';

const kUnits = {
  speed: (x) => `${x.toFixed(2)}×`, figures: (x) => String(x), budget: (x) => (x >= kNoBudget_ms ? 'no limit' : `${x.toFixed(2)} ms`),
  wind: (x) => `${x} m/s`, from: (x) => `${x}°`, gust: (x) => `${Math.round(100 * x)} %`, gustHz: (x) => `${x.toFixed(1)} Hz`, gravity: (x) => `${x.toFixed(1)} m/s²`,
  intensity: (x) => `${Math.round(100 * x)} %`, stiffness: (x) => `×${Number(x.toPrecision(2))}`, damping: (x) => `×${Number(x.toPrecision(2))}`,
  displacement: (x) => `${Math.round(100 * x)} %`,
};
const isLog = (control) => 'log' in control.dataset;

function valueOf(control) {
  if (control.type === 'checkbox') return control.checked;
  if (control.type !== 'range') return control.value;
  return isLog(control) ? 10 ** Number(control.value) : Number(control.value);
}

function showIn(control, name, value) {
  if (control.type === 'checkbox') control.checked = value;
  else control.value = isLog(control) ? Math.log10(value) : value;
  const output = control.parentElement.querySelector('output');
  if (output) output.textContent = kUnits[name](value);
  if (control.type === 'range') control.setAttribute('aria-valuetext', output.textContent);
}

function fillSelect(select, entries) {
  const had = select.value;
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
  select.value = entries.some(([value]) => value === had) ? had : entries[0][0];
}

export class Controls {
  constructor(settings) {
    this.settings = settings;
    this.keyed = [...document.querySelectorAll('[data-key]')];
    this.ofPart = [...document.querySelectorAll('[data-part]')];
    this.part = document.getElementById('part');
    for (const control of this.keyed) control.addEventListener('input', () => settings.set(control.dataset.key, valueOf(control)));
    for (const control of this.ofPart)
      control.addEventListener('input', () => settings.setPart(this.part.value, {...settings.part(this.part.value), [control.dataset.part]: valueOf(control)}));
    this.part.addEventListener('input', () => this.show());
    document.getElementById('reset-parts').addEventListener('click', () => settings.forgetParts());
    settings.listen(() => this.show());
  }

  // What this character has.
  fill(description) {
    const clips = description.clips.map(({name}, i) => [name || `clip ${i + 1}`, name || `clip ${i + 1}`]);
    fillSelect(document.querySelector('[data-key=clip]'), [...clips, ['(shaken)', 'bind pose, shaken'], ['(turning)', 'bind pose, turning'], ['(still)', 'bind pose, still']]);
    const parts = [...description.regions.map(({name}) => [name, name]), ...description.rods.map(({name}) => [name, `${name} (rod)`])];
    fillSelect(this.part, [[kWhole, 'all of it'], ...parts]);
    const has = {showRegions: description.regions.length, showNodes: description.regions.length, showRods: description.rods.length, showProxies: description.proxyCount, body: description.proxyCount};
    for (const [key, count] of Object.entries(has)) {
      const control = document.querySelector(`[data-key=${key}]`);
      control.disabled = count === 0;
      control.parentElement.title = count ? '' : 'This character has none';
    }
    this.show();
  }

  show() {
    for (const control of this.keyed) {
      const value = this.settings.get(control.dataset.key);
      if (value !== '') showIn(control, control.dataset.key, value);  // else what the page has chosen is shown
    }
    const part = this.settings.part(this.part.value || kWhole);
    for (const control of this.ofPart) showIn(control, control.dataset.part, part[control.dataset.part]);
  }
}
