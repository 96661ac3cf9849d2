// main.js  Puts the page together: loads, plays, draws.
import {Characters} from './characters.js';
import {Controls} from './controls.js';
import {loadEngine} from './engine.js';
import {Figure} from './figure.js';
import {listenForFiles} from './files.js';
import {Hand} from './hand.js';
import {Plot} from './plot.js';
import {kDefaults, kNoBudget_ms, kOwn, kWhole, Settings} from './settings.js';
import {Split} from './split.js';
import {NoDrawing, Stage} from './stage.js';

const kBakedGravity_m_s2 = 9.80665;  // which the slider's first value stands for
const kLongestFrame_s = 0.1, kFrameStep_s = 1 / 60;
const kMotions = {'(still)': -1, '(shaken)': -2, '(turning)': -3};
const kOfScene = ['figures', 'ball', 'body'];  // what the engine has another scene for
const kTouchBody = 1, kTouchBall = 2;
const kAll = 0, kRegion = 1, kRod = 2;
const kDebugParts = {showNodes: 1, showRods: 2, showProxies: 4, showTouches: 8, showBounds: 16};
const kBest = {all: 2, modal: 4, skinning: 0};

const element = (id) => document.getElementById(id);

function say(sentence) {
  element('message').hidden = !sentence;
  element('message').firstElementChild.textContent = sentence ?? '';
}

// Once what the page has asked for before it had this module.
function fetchBytes(address) {
  const asked = window.sinewAsked[address];
  delete window.sinewAsked[address];
  return asked ?? window.sinewAsk(address);
}

class Page {
  // Made while the engine and the character are on their way.
  constructor() {
    this.settings = new Settings(location.hash);
    this.stage = new Stage(element('picture'));
    this.controls = new Controls(this.settings);
    this.split = new Split(this.settings);
    this.plot = new Plot(element('plot'));
    this.controls.show();
    this.isChanged = true;  // by a setting, since the last step
    this.needsScene = false;  // another number of figures, or other contacts
    this.frames = [];       // when the last second's were drawn, ms
    this.pictures = 0;
    this.frame_ms = null;
  }

  touches() { return (this.settings.get('body') ? kTouchBody : 0) | (this.settings.get('ball') ? kTouchBall : 0); }
  budget_us() { return this.settings.get('budget') >= kNoBudget_ms ? Infinity : 1000 * this.settings.get('budget'); }

  // The engine's scene has become another.
  rebuild() {
    this.stage.show(new Figure(this.engine, this.characters.look), this.engine.description.height, this.engine.figures);
    this.plot.clear();
    this.made = Object.fromEntries(kOfScene.map((name) => [name, this.settings.get(name)]));
    this.applyAll();
    this.stepBy(0);
  }

  showCharacter() {
    this.controls.fill(this.engine.description);
    this.rebuild();
    this.frameView();
  }

  frameView() {
    this.stage.frame(this.engine.figures);
    this.isViewOwn = false;  // by hand
    this.writeAddress();
  }

  // What is refused is as it was, in the panel too.
  change() {
    this.needsScene = false;
    const figures = this.engine.figures;
    try {
      this.engine.change(this.settings.get('figures'), this.touches());
      this.rebuild();
      if (this.engine.figures !== figures) this.frameView();
    } catch (error) {
      Object.assign(this.settings.values, this.made);
      this.controls.show();
      say(error.message);
    }
  }

  applyAll() {
    this.hand.setBall(this.settings.get('ball'));
    for (const name of ['clip', 'budget', 'tier', 'gravity', 'showRegions']) this.apply(name);
    this.applyParts();
  }

  applyParts() {
    const {regions, rods} = this.engine.description;
    const set = (kind, index, name) => {
      const {intensity, stiffness, damping, displacement, enabled} = this.settings.part(name);
      this.engine.must(this.engine.calls.scene_set_part(kind, index, intensity, stiffness, damping, displacement, enabled ? 1 : 0));
    };
    set(kAll, 0, kWhole);
    regions.forEach(({name}, i) => set(kRegion, i, name));
    rods.forEach(({name}, i) => set(kRod, i, name));
  }

  clip() {
    const wanted = this.settings.get('clip'), {clips} = this.engine.description;
    const index = clips.findIndex(({name}, i) => (name || `clip ${i + 1}`) === wanted);
    if (index >= 0) return index;
    if (Object.hasOwn(kMotions, wanted)) return kMotions[wanted];
    this.settings.values.clip = kDefaults.clip;  // another character's
    return clips.length ? this.liveliest(clips) : kMotions['(shaken)'];
  }
  // At first something that swings, where there is a clip of such a name.
  liveliest(clips) {
    for (const word of [/(^|[^a-z])hop/i, /jump|dance/i, /run|gallop/i, /walk/i]) {
      const index = clips.findIndex(({name}) => word.test(name));
      if (index >= 0) return index;
    }
    return 0;
  }

  // A setting has changed.
  apply(name) {
    const {calls} = this.engine, {settings} = this;
    this.isChanged = true;
    if (name.startsWith('part.')) this.applyParts();
    if (name === 'clip') {
      const clip = this.clip();
      this.engine.must(calls.scene_set_clip(clip));
      const names = Object.fromEntries(Object.entries(kMotions).map(([text, index]) => [index, text]));
      element('transport').querySelector('[data-key=clip]').value = names[clip] ?? (this.engine.description.clips[clip].name || `clip ${clip + 1}`);
    }
    if (name === 'budget') this.engine.must(calls.scene_set_budget_us(this.budget_us()));
    if (name === 'tier') this.engine.must(calls.scene_set_best_tier(kBest[settings.get('tier')] ?? kBest.all));
    if (['wind', 'from', 'gust', 'gustHz', 'gravity'].includes(name)) this.applyAir();
    if (name === 'showRegions') this.stage.figure.showRegions(settings.get('showRegions'));
    if (kOfScene.includes(name)) this.needsScene = true;
    if (name === 'playing') this.showPlaying();
    if (name === 'character') this.wish(settings.get('character'));
  }

  applyAir() {
    const get = (name) => this.settings.get(name), from = (get('from') * Math.PI) / 180, wind = get('wind');
    const gravity = get('gravity') === kDefaults.gravity ? kBakedGravity_m_s2 : get('gravity');
    this.engine.must(this.engine.calls.scene_set_air(gravity, -wind * Math.sin(from), 0, -wind * Math.cos(from), get('gust'), get('gustHz')));
  }

  wish(character) { character === this.characters.name ? this.characters.stay() : this.takeNamed(character); }

  async takeNamed(name) {
    say(null);
    try {
      await this.characters.takeNamed(name);
    } catch (error) {
      say(error.message);
    }
    if (this.settings.get('character') === name) this.settings.set('character', this.characters.name);
  }

  async takeFiles(files) {
    say(null);
    const select = document.querySelector('[data-key=character]');
    try {
      const name = await this.characters.takeFiles(files);
      if (name) this.nameOwn(select, name);
    } catch (error) {
      if (error.cause) this.nameOwn(select, files.find(({name}) => /sinew$/i.test(name)).name);
      say(error.message);
    }
  }

  nameOwn(select, name) {
    [...select.options].find(({value}) => value === kOwn)?.remove();
    select.append(new Option(name, kOwn));
    select.value = kOwn;
    this.settings.set('character', kOwn);
  }

  stepBy(seconds) {
    this.isChanged = false;
    this.engine.must(this.engine.calls.scene_set_view(...this.stage.view()));
    this.engine.step(seconds);
    const report = this.engine.report();
    this.stage.figure.read(this.engine, this.settings.get('showTiers'));
    this.stage.ball.position.set(report.ballX, report.ballY, report.ballZ);
    if (seconds > 0) this.plot.add(report);
    const parts = Object.entries(kDebugParts).reduce((sum, [name, part]) => sum + (this.settings.get(name) ? part : 0), 0);
    this.stage.setLines(this.engine, parts);
    this.stage.isStale = true;
  }

  showPlaying() {
    element('play').textContent = this.settings.get('playing') ? 'Pause' : 'Play';
  }

  showNumbers() {
    const {frames} = this.plot, recent = frames.slice(-60);
    if (!recent.length) return;
    const mean = (of) => recent.reduce((sum, report) => sum + of(report), 0) / recent.length;
    element('numbers').firstElementChild.textContent =
      `${(mean((r) => r.stepUs) / 1000).toFixed(2)} ms a step, ${this.frames.length} pictures a second\n` +
      `expected error ${mean((r) => r.expectedError).toFixed(2)} of skinning's\n` +
      `${recent.at(-1).dormant} asleep, ${recent.at(-1).cut} cut for the deadline`;
    this.plot.draw(this.budget_us());
  }

  frame(now_ms) {
    requestAnimationFrame((ms) => this.frame(ms));
    const passed_s = this.frame_ms === null ? kFrameStep_s : (now_ms - this.frame_ms) / 1000;
    this.frame_ms = now_ms;
    this.frames = [...this.frames.filter((ms) => ms > now_ms - 1000), now_ms];
    if (this.characters.isLoading || this.isLost) return;
    if (this.needsScene) this.change();
    try {
      if (this.settings.get('playing')) this.stepBy(Math.min(kLongestFrame_s, passed_s) * this.settings.get('speed'));
      else if (this.isChanged) this.stepBy(0);
      this.stage.drawIfStale(this.settings.get('split'));
      this.markFirstMotion();
    } catch (error) {
      this.settings.set('playing', false);
      say(error.message);
    }
    if (++this.pictures % 6 === 0) this.showNumbers();
  }

  // For who measures how long it takes: the second picture is the first that moves.
  markFirstMotion() {
    if (this.plot.frames.length === 2 && !performance.getEntriesByName('first motion').length) performance.mark('first motion');
  }

  toggle() { this.settings.set('playing', !this.settings.get('playing')); }
  stepOnce() {
    this.settings.set('playing', false);
    this.stepBy(kFrameStep_s);
  }
  restart() {
    this.engine.must(this.engine.calls.scene_restart());
    this.stepBy(0);
  }

  address() {
    this.settings.values.camera = this.isViewOwn ? this.stage.place().join(',') : '';
    return location.pathname + location.search + this.settings.hash();
  }

  writeAddress() {
    clearTimeout(this.writing);
    this.writing = setTimeout(() => history.replaceState(null, '', this.address()), 300);
  }

  listen() {
    const {settings, stage} = this;
    settings.listen((name) => {
      try {
        this.apply(name);
      } catch (error) {
        say(error.message);
      }
      this.writeAddress();
    });
    stage.controls.addEventListener('start', () => { this.isViewOwn = true; });
    stage.controls.addEventListener('change', () => { this.isChanged = true, this.writeAddress(); });
    element('play').addEventListener('click', () => this.toggle());
    element('step').addEventListener('click', () => this.stepOnce());
    element('restart').addEventListener('click', () => this.restart());
    element('message').querySelector('button').addEventListener('click', () => say(null));
    element('link').addEventListener('click', () => this.copyLink());
    addEventListener('keydown', (event) => this.key(event));
    addEventListener('hashchange', () => location.reload());
    document.addEventListener('visibilitychange', () => { this.frame_ms = null; });
    listenForFiles((files) => this.takeFiles(files));
    const canvas = stage.renderer.domElement;
    canvas.addEventListener('webglcontextlost', () => {
      this.isLost = true;
      stage.forget();
      say('The graphics driver has taken the picture away; it comes back as soon as the driver does.');
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.isLost = false;
      say(null);
      this.rebuild();
    });
  }

  key(event) {
    // Space presses buttons, and letters choose in lists.
    const taken = {' ': /^(INPUT|SELECT|BUTTON|SUMMARY)$/, r: /^SELECT$/, R: /^SELECT$/}[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || taken?.test(event.target.tagName)) return;
    const does = {' ': () => this.toggle(), '.': () => this.stepOnce(), r: () => this.restart(), R: () => this.restart()}[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  }

  async copyLink() {
    history.replaceState(null, '', this.address());
    const button = element('link');
    try {
      await navigator.clipboard.writeText(location.href);
      button.textContent = 'Copied';
    } catch {
      button.textContent = 'In the address bar';
    }
    setTimeout(() => { button.textContent = 'Copy link'; }, 1500);
  }

  // Throws where there is no character.
  async start(engine, name) {
    this.engine = engine;
    this.hand = new Hand(this.stage, engine, () => this.settings.get('playing'), () => element('hint').classList.add('done'));
    const place = this.settings.get('camera').split(',').map(Number);
    this.characters = new Characters(engine, () => [this.settings.get('figures'), this.touches()], fetchBytes, () => this.showCharacter());
    await this.characters.takeNamed(name).catch((error) => {
      if (!engine.description) throw error;
      say(error.message);
    });
    if (place.length === 6 && place.every(Number.isFinite)) this.stage.goTo(place), this.isViewOwn = true;
    this.controls.show();
    this.apply('clip');
    this.showPlaying();
    this.listen();
    this.stepBy(0);
    requestAnimationFrame((ms) => this.frame(ms));
  }
}

async function start() {
  if (window.sinewLacks) return;
  say('Loading…');
  try {
    const asked = fetchBytes('sinew.wasm').then(loadEngine);
    asked.catch(() => {});  // told of below
    const page = new Page();
    const options = [...document.querySelectorAll('[data-key=character] option')].map(({value}) => value);
    const wanted = page.settings.get('character'), name = options.includes(wanted) ? wanted : kDefaults.character;
    page.settings.values.character = name;
    await page.start(await asked, name);
    if (element('message').firstElementChild.textContent === 'Loading…') say(null);
    window.sinewPage = page;  // for the console, and for tests
  } catch (error) {
    error instanceof NoDrawing ? window.sinewSayLack(error.message) : say(error.message);
  }
}
start();
