// settings.js  All that can be set, what it is at first, and how it is written into the page's address.

export const kDefaults = {
  character: 'creature', clip: '', speed: 1, figures: 1, budget: 16.25, tier: 'all', split: 0.5,
  wind: 0, from: 90, gust: 0.3, gustHz: 0.5, gravity: 9.8,
  ball: false, body: false,
  showTiers: false, showRegions: false, showNodes: false, showRods: false, showProxies: false, showTouches: false, showBounds: false,
  playing: true, camera: '',
};
export const kPart = {intensity: 1, stiffness: 1, damping: 1, displacement: 1, enabled: true};
export const kNoBudget_ms = 16.25;  // beyond the slider's last budget
export const kOwn = 'own';           // a character that the page was given, which no address has
export const kWhole = '*';                 // the name of all parts together
const kPartPrefix = 'part.';

const kRanges = {
  speed: [0.02, 1], figures: [1, 144], budget: [0, kNoBudget_ms], split: [0, 1], wind: [0, 40], from: [0, 360], gust: [0, 1], gustHz: [0.1, 4],
  gravity: [-20, 30], intensity: [0, 2], stiffness: [0.01, 100], damping: [0.01, 100], displacement: [0, 4],
};

// A value of the default's kind and in its range, or the default.
function mended(name, text, fallback) {
  if (typeof fallback === 'boolean') return text === '1' ? true : text === '0' ? false : fallback;
  if (typeof fallback === 'string') return text;
  const value = Number(text), [least, most] = kRanges[name];
  if (!Number.isFinite(value) || text === '') return fallback;
  const held = Math.min(most, Math.max(least, value));
  return name === 'figures' ? Math.round(held) : held;
}
const written = (value) => (typeof value === 'boolean' ? (value ? '1' : '0') : typeof value === 'number' ? String(Number(value.toPrecision(4))) : value);

export class Settings {
  constructor(hash) {
    this.values = {};
    this.parts = new Map();  // of a part's name what differs from kPart
    this.listeners = [];
    this.readHash(hash);
  }

  readHash(hash) {
    Object.assign(this.values, kDefaults);
    this.parts.clear();
    for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ''))) {
      if (Object.hasOwn(kDefaults, name)) this.values[name] = mended(name, text, kDefaults[name]);
      if (name.startsWith(kPartPrefix)) this.readPart(name.slice(kPartPrefix.length), text.split(','));
    }
  }

  readPart(part, texts) {
    const names = Object.keys(kPart);
    this.parts.set(part, Object.fromEntries(names.map((name, i) => [name, mended(name, texts[i] ?? '', kPart[name])])));
  }

  hash() {
    const out = new URLSearchParams();
    for (const [name, value] of Object.entries(this.values)) if (value !== kDefaults[name] && value !== kOwn) out.set(name, written(value));
    for (const [part, values] of this.parts)
      if (Object.keys(kPart).some((name) => values[name] !== kPart[name])) out.set(kPartPrefix + part, Object.values(values).map(written).join(','));
    const text = String(out);
    return text ? `#${text}` : '';
  }

  get(name) { return this.values[name]; }
  set(name, value) {
    if (this.values[name] === value) return;
    this.values[name] = value;
    this.listeners.forEach((listener) => listener(name));
  }

  part(name) { return this.parts.get(name) ?? {...kPart}; }
  setPart(name, values) {
    this.parts.set(name, values);
    this.listeners.forEach((listener) => listener(kPartPrefix + name));
  }
  forgetParts() {
    this.parts.clear();
    this.listeners.forEach((listener) => listener(kPartPrefix + kWhole));
  }

  listen(listener) { this.listeners.push(listener); }
}
