// page.mjs  node page.mjs TEST BUILD: one of the tests below, on the page in BUILD/page. Pictures go to BUILD/pictures.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import {kDesk, kPhone, message, moves, openPage, withBrowser} from './browser.mjs';

const [name, build, native] = process.argv.slice(2);
const folder = `${build}/page`, npm = `${build}/npm`, pictures = `${build}/pictures`;
fs.mkdirSync(pictures, {recursive: true});
const picture = (page, file) => page.screenshot({path: `${pictures}/${file}.png`});
const packOf = (file) => ({name: file, mimeType: 'application/octet-stream', buffer: fs.readFileSync(`${folder}/characters/${file}`)});
const damaged = (file, damage) => { const pack = packOf(file); damage(pack.buffer); return pack; };

// Steps that are played by the test alone.
const play = (page, steps) => page.evaluate((n) => {
  sinewPage.settings.set('playing', false);
  for (let i = 0; i < n; ++i) sinewPage.stepBy(1 / 60);
}, steps);
const root = (page) => page.evaluate(() => {
  const {engine} = sinewPage;
  return [...engine.positions(0)].slice(0, 3);
});
const choose = async (page, files) => {
  await page.evaluate(() => sinewPage && document.querySelector('#message button').click());
  await page.setInputFiles('#files', files);
};
const told = async (page) => {
  await page.waitForFunction(() => !document.getElementById('message').hidden, null, {timeout: 20000});
  return message(page);
};

async function drop(page, files) {
  const data = await page.evaluateHandle((all) => {
    const transfer = new DataTransfer();
    for (const {name, base64} of all) transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
    return transfer;
  }, files.map((file) => ({name: file.name, base64: file.buffer.toString('base64')})));
  await page.dispatchEvent('#stage', 'dragenter', {dataTransfer: data});
  await page.dispatchEvent('#stage', 'drop', {dataTransfer: data});
}

const tests = {
  async the_creature_moves_without_a_word_on_the_console({browser, address}) {
    for (const [size, viewport] of [['desk', kDesk], ['phone', kPhone]])
      for (const colorScheme of ['light', 'dark']) {
        const page = await openPage(browser, address, {viewport, colorScheme});
        await moves(page);
        await page.waitForFunction(() => sinewPage.characters.look !== null);
        const before = await root(page);
        await play(page, 10);
        assert.notDeepEqual(await root(page), before);
        await picture(page, `${size}_${colorScheme}`);
        page.check();
        await page.context().close();
      }
  },

  async positions_are_those_of_the_native_library({browser, address}) {
    const page = await openPage(browser, address);
    await moves(page);
    const {base64, vertexCount, height} = await page.evaluate(async () => {
      const {loadEngine} = await import('./engine.js');
      const engine = await loadEngine(await (await fetch('sinew.wasm')).arrayBuffer());
      const kTouchBall = 2;
      engine.open(await (await fetch('characters/creature.sinew')).arrayBuffer(), 2, kTouchBall);
      const {calls} = engine;
      engine.must(calls.scene_set_clip(2));
      engine.must(calls.scene_set_air(9.80665, 6, 0, 3, 0.3, 0.5));
      calls.scene_set_ball(0.1, 0.3, 0.6, 0.12);
      for (let step = 0; step < 120; ++step) {
        if (step === 30) calls.scene_pull(0, 0.3, 0.2, 0.1), calls.scene_set_ball(0.1, 0.3, 0.3, 0.12);
        if (step === 60) calls.scene_let_go();
        engine.step(1 / 60);
      }
      const all = [0, 1].flatMap((figure) => [...new Uint8Array(engine.positions(figure).slice().buffer)]);
      return {base64: btoa(all.reduce((text, byte) => text + String.fromCharCode(byte), '')), ...engine.description};
    });
    const bytes = Buffer.from(base64, 'base64'), file = `${build}/native_positions`;
    execFileSync(native, [`${folder}/characters/creature.sinew`, String(vertexCount), file], {stdio: 'inherit'});
    const theirs = fs.readFileSync(file);
    assert.equal(bytes.length, theirs.length);
    let most = 0;
    for (let i = 0; i < bytes.length; i += 4) most = Math.max(most, Math.abs(bytes.readFloatLE(i) - theirs.readFloatLE(i)));
    console.log(`largest difference ${(most / height).toExponential(2)} of the height, after 2 seconds`);
    assert.ok(most < 1e-4 * height);
    page.check();
  },

  async files_that_cannot_be_shown_get_a_sentence_and_change_nothing({browser, address}) {
    const page = await openPage(browser, address);
    await moves(page);
    await page.waitForFunction(() => sinewPage.characters.look !== null);
    const text = (name) => ({name, mimeType: 'text/plain', buffer: Buffer.from('nothing')});
    const kVersionAt = 8;
    const cases = [
      [[text('notes.txt')], /notes\.txt cannot be shown: drop a \.sinew/],
      [[text('scene.gltf')], /exported as \.glb/],
      [[text('bad.sinew')], /^bad\.sinew: /],
      [[{name: 'empty.sinew', mimeType: '', buffer: Buffer.alloc(0)}], /^empty\.sinew: the file is empty/],
      [[damaged('creature.sinew', (bytes) => bytes.writeUInt32LE(3, kVersionAt))], /^creature\.sinew: .*version/],
      [[{...packOf('creature.sinew'), buffer: packOf('creature.sinew').buffer.subarray(0, 100000)}], /^creature\.sinew: /],
      [[damaged('creature.sinew', (bytes) => bytes.fill(255, 200000, 200100))], /^creature\.sinew: .*checksum/],
      [[packOf('creature.glb')], /needs its motion: bake it/],
    ];
    for (const [files, expected] of cases) {
      await choose(page, files);
      const sentence = await told(page);
      console.log(sentence);
      assert.match(sentence, expected);
      assert.equal(await page.evaluate(() => sinewPage.settings.get('character')), 'creature');
    }
    await picture(page, 'broken_file');
    const before = await root(page);
    await play(page, 10);
    assert.notDeepEqual(await root(page), before);
    page.check();
  },

  async a_character_of_ones_own_is_shown_with_its_colours({browser, address}) {
    const page = await openPage(browser, address);
    await moves(page);
    await page.waitForFunction(() => sinewPage.characters.look !== null);
    await drop(page, [{...packOf('creature_rods.sinew'), name: 'mine.sinew'}, packOf('creature.glb')]);
    await page.waitForFunction(() => sinewPage.settings.get('character') === 'own' && sinewPage.characters.look !== null);
    assert.equal(await page.evaluate(() => document.querySelector('[data-key=character]').selectedOptions[0].text), 'mine.sinew');
    assert.ok((await page.evaluate(() => sinewPage.engine.description.rods.length)) > 0);
    assert.ok(await page.evaluate(() => document.getElementById('over').hidden));
    assert.equal(await message(page), '');
    // Its colours later, or none at all, or those of another file.
    await choose(page, [packOf('creature_rods.sinew')]);
    await page.waitForFunction(() => sinewPage.characters.look === null);
    await picture(page, 'own_without_colours');
    await choose(page, [{name: 'broken.glb', mimeType: '', buffer: Buffer.from('glTF nothing')}]);
    assert.match(await told(page), /^broken\.glb: /);
    await choose(page, [packOf('creature.glb')]);
    await page.waitForFunction(() => sinewPage.characters.look !== null);
    await picture(page, 'own_with_colours');
    page.check();
  },

  async dragging_pulls_a_figure_and_lets_it_swing_back({browser, address}) {
    const page = await openPage(browser, address, {hash: '#clip=(still)&split=0'});
    await moves(page);
    const box = await page.locator('#picture').boundingBox(), x = box.x + box.width / 2, y = box.y + 0.55 * box.height;
    const before = await root(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 200, y - 60, {steps: 4});
    await play(page, 30);
    const pulled = await root(page);
    assert.ok(pulled[0] - before[0] > 0.15, `pulled by ${pulled[0] - before[0]} m`);
    await picture(page, 'dragged');
    await page.mouse.up();
    await play(page, 180);
    const after = await root(page);
    assert.ok(Math.hypot(...after.map((value, k) => value - before[k])) < 0.01);
    const camera = await page.evaluate(() => sinewPage.stage.camera.position.toArray());
    await page.mouse.move(box.x + 40, box.y + 200);  // beside it: the view turns
    await page.mouse.down();
    await page.mouse.move(box.x + 200, box.y + 220, {steps: 4});
    await page.mouse.up();
    await page.evaluate(() => sinewPage.stage.controls.update());
    assert.notDeepEqual(await page.evaluate(() => sinewPage.stage.camera.position.toArray()), camera);
    page.check();
  },

  async a_touch_drags_and_a_key_pulls({browser, address}) {
    const page = await openPage(browser, address, {viewport: kPhone, hasTouch: true, isMobile: true, hash: '#clip=(still)&split=0'});
    await moves(page);
    const before = await root(page), client = await page.context().newCDPSession(page);
    const box = await page.locator('#picture').boundingBox(), x = box.x + box.width / 2, y = box.y + 0.5 * box.height;
    const touch = (type, points) => client.send('Input.dispatchTouchEvent', {type, touchPoints: points});
    await touch('touchStart', [{x, y}]);
    await touch('touchMove', [{x: x + 40, y}]);
    await touch('touchMove', [{x: x + 80, y}]);
    await play(page, 30);
    assert.ok((await root(page))[0] - before[0] > 0.1);
    await touch('touchEnd', []);
    await play(page, 120);
    await page.focus('#picture');
    await page.keyboard.down('ArrowUp');
    await play(page, 30);
    assert.ok((await root(page))[1] - before[1] > 0.1);
    await page.keyboard.up('ArrowUp');
    await page.keyboard.press(' ');
    assert.equal(await page.evaluate(() => sinewPage.settings.get('playing')), true);
    await page.keyboard.press('.');
    assert.equal(await page.evaluate(() => sinewPage.settings.get('playing')), false);
    page.check();
  },

  async two_fingers_near_the_view_on_the_character_too({browser, address}) {
    const page = await openPage(browser, address, {viewport: kPhone, hasTouch: true, isMobile: true, hash: '#clip=(still)&split=0'});
    await moves(page);
    const client = await page.context().newCDPSession(page), box = await page.locator('#picture').boundingBox();
    const x = box.x + box.width / 2, y = box.y + 0.5 * box.height;
    const touch = (type, ...points) => client.send('Input.dispatchTouchEvent', {type, touchPoints: points.map(([px, id]) => ({x: px, y, id}))});
    const far = () => page.evaluate(() => (sinewPage.stage.controls.update(), sinewPage.stage.controls.getDistance()));
    const before = await far();
    await touch('touchStart', [x - 20, 1]);
    await touch('touchStart', [x - 20, 1], [x + 20, 2]);
    for (let apart = 20; apart < 120; apart += 20) await touch('touchMove', [x - apart, 1], [x + apart, 2]);
    await touch('touchEnd');
    assert.ok((await far()) < 0.8 * before, `${await far()} of ${before} m`);
    assert.equal(await page.evaluate(() => sinewPage.hand.held), null);
    page.check();
  },

  async what_was_asked_for_last_is_shown_and_what_is_refused_is_not({browser, address}) {
    const page = await openPage(browser, address);
    await moves(page);
    await page.route('**/creature_rods.sinew', async (route) => (await new Promise((resolve) => setTimeout(resolve, 1500)), route.continue()));
    await page.route('**/creature_touch.sinew', (route) => route.fulfill({status: 404}));
    const wish = (name) => page.evaluate((value) => sinewPage.settings.set('character', value), name);
    await wish('creature_rods'), await wish('creature');
    await page.waitForTimeout(2500);
    assert.equal(await page.evaluate(() => sinewPage.engine.description.rods.length), 0);
    await wish('creature_touch');
    assert.match(await told(page), /creature_touch\.sinew is not there/);
    assert.equal(await page.locator('[data-key=character]').inputValue(), 'creature');
    page.isIgnored(/404/);
    page.check();
  },

  async looks_of_hostile_files_get_a_sentence_and_send_for_nothing({browser, address}) {
    const page = await openPage(browser, address);
    await moves(page);
    await choose(page, [packOf('creature_rods.sinew')]);
    await page.waitForFunction(() => sinewPage.settings.get('character') === 'own');
    const binary = (json) => {
      const text = Buffer.from(json.padEnd(Math.ceil(json.length / 4) * 4)), header = Buffer.alloc(20);
      header.write('glTF'), header.writeUInt32LE(2, 4), header.writeUInt32LE(20 + text.length, 8), header.writeUInt32LE(text.length, 12), header.write('JSON', 16);
      return {name: 'hostile.glb', mimeType: '', buffer: Buffer.concat([header, text])};
    };
    const asset = '"asset":{"version":"2.0"}', requests = [];
    page.on('request', (request) => requests.push(request.url()));
    const files = [`{${asset}}`, 'null', '[]', `{${asset},"nodes":[{"mesh":7}],"meshes":[]}`, `{${asset},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]}`,
      `{${asset},"buffers":[{"uri":"http://127.0.0.1:9/x","byteLength":4}],"bufferViews":[{"buffer":0,"byteLength":4}]}`,
      `{${asset},"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"]}`];
    for (const file of files) {
      await choose(page, [binary(file)]);
      const sentence = await told(page);
      console.log(sentence);
      assert.match(sentence, /^hostile\.glb: it (is no binary glTF|has no mesh|is compressed)/);
      assert.doesNotMatch(sentence, /undefined|null|\.\./);
    }
    assert.deepEqual(requests.filter((url) => url.includes(':9/')), []);
    page.isIgnored(/./);
  },

  async the_server_answers_nonsense_and_lives({address}) {
    const {port} = new URL(address);
    for (const path of ['/%', '//', '/%00', '/../../etc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/nothing']) {
      const answer = await new Promise((resolve, reject) => http.get({port, host: '127.0.0.1', path}, (response) => resolve(response.statusCode)).on('error', reject));
      assert.ok([400, 404].includes(answer) || path === '//', `${path}: ${answer}`);
    }
    assert.equal((await fetch(address)).status, 200);
  },

  async every_control_goes_from_end_to_end({browser, address}) {
    const page = await openPage(browser, address, {hash: '#playing=0&character=creature_rods'});
    await page.waitForFunction(() => window.sinewPage?.characters.look);
    const broken = await page.evaluate(async () => {
      const broken = [];
      const isFinite = () => [...sinewPage.engine.positions(0)].every(Number.isFinite);
      const set = (control, value) => {
        if (control.type === 'checkbox') control.checked = value;
        else control.value = value;
        control.dispatchEvent(new Event('input', {bubbles: true}));
        for (let i = 0; i < 3; ++i) sinewPage.stepBy(1 / 60);
        if (!isFinite()) broken.push(`${control.dataset.key ?? control.dataset.part} ${value}`);
        if (!document.getElementById('message').hidden) broken.push(document.getElementById('message').textContent);
      };
      for (const control of document.querySelectorAll('[data-key], [data-part], #part')) {
        if (control.dataset.key === 'character') continue;
        const had = control.type === 'checkbox' ? control.checked : control.value;
        const values = control.type === 'checkbox' ? [!had] : control.type === 'range' ? [control.min, control.dataset.key === 'figures' ? 9 : control.max] : [...control.options].map(({value}) => value);
        for (const value of values) set(control, value);
        set(control, had);
      }
      return broken;
    });
    assert.deepEqual(broken, []);
    page.check();
  },

  async the_address_holds_what_is_set({browser, address}) {
    const page = await openPage(browser, `${address}#playing=0`);
    const isThere = (one) => one.waitForFunction(() => window.sinewPage);
    await isThere(page);
    const set = (selector, value) => page.locator(selector).evaluate((control, to) => {
      control.type === 'checkbox' ? (control.checked = to) : (control.value = to);
      control.dispatchEvent(new Event('input', {bubbles: true}));
    }, value);
    await page.locator('details').evaluateAll((all) => all.forEach((one) => { one.open = true; }));
    await set('[data-key=figures]', 4), await set('[data-key=budget]', 2), await set('[data-key=wind]', 12), await set('[data-key=clip]', 'shake');
    await set('[data-key=speed]', 0.25), await set('[data-key=ball]', true), await set('[data-key=showRegions]', true);
    await set('#part', 'belly'), await set('[data-part=intensity]', 2);
    await page.click('#link');
    const sent = page.url(), hash = await page.evaluate(() => sinewPage.settings.hash());
    assert.match(sent, /figures=4/);
    const other = await openPage(browser, sent);
    await isThere(other);
    assert.equal(await other.evaluate(() => sinewPage.settings.hash()), hash);
    assert.equal(await other.evaluate(() => sinewPage.engine.figures), 4);
    assert.equal(await other.locator('[data-key=clip]').inputValue(), 'shake');
    const nonsense = await openPage(browser, `${address}#figures=-5&wind=NaN&clip=toString&camera=1,2&part.belly=x&speed=&character=../../x&unknown=1&toString=1`);
    await isThere(nonsense);
    assert.equal(await nonsense.evaluate(() => sinewPage.engine.figures), 1);
    for (const one of [page, other, nonsense]) one.check();
  },

  async a_lost_context_and_a_hidden_tab_come_back({browser, address}) {
    const page = await openPage(browser, address);
    await moves(page);
    await page.evaluate(() => { window.lose = sinewPage.stage.renderer.getContext().getExtension('WEBGL_lose_context'), lose.loseContext(); });
    assert.match(await told(page), /graphics driver/);
    await page.evaluate(() => lose.restoreContext());
    await page.waitForFunction(() => document.getElementById('message').hidden);
    await page.waitForTimeout(500);
    await picture(page, 'restored');
    const isDrawn = await page.evaluate(() => {
      const {renderer} = sinewPage.stage, gl = renderer.getContext(), pixel = new Uint8Array(4), seen = new Set();
      sinewPage.stage.draw(0.5);
      for (let x = 0.3; x < 0.7; x += 0.02) gl.readPixels(x * gl.drawingBufferWidth, 0.45 * gl.drawingBufferHeight, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel), seen.add(pixel.join());
      return seen.size;
    });
    assert.ok(isDrawn > 4, `${isDrawn} colours`);
    page.isIgnored(/THREE.WebGLRenderer: Context (Lost|Restored)|WebGL/);
    // No frame for a minute is a pause and not a jump.
    const stepped = await page.evaluate(async () => {
      const longest = {seconds: 0}, stepBy = sinewPage.stepBy.bind(sinewPage);
      sinewPage.stepBy = (seconds) => { longest.seconds = Math.max(longest.seconds, seconds), stepBy(seconds); };
      sinewPage.frame_ms -= 60000;
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      document.dispatchEvent(new Event('visibilitychange'));
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      return longest.seconds;
    });
    assert.ok(stepped <= 0.1);
    page.check();
  },

  async nothing_shifts_and_nothing_overflows({browser, address}) {
    for (const viewport of [kDesk, kPhone, {width: 320, height: 568}, {width: 844, height: 390}]) {
      const page = await openPage(browser, address, {viewport});
      await moves(page);
      const shift = await page.evaluate(() => new Promise((resolve) => {
        let sum = 0;
        new PerformanceObserver((list) => list.getEntries().forEach(({value}) => { sum += value; })).observe({type: 'layout-shift', buffered: true});
        setTimeout(() => resolve(sum), 300);
      }));
      assert.ok(shift < 0.02, `layout shifts by ${shift} at ${viewport.width}`);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
      const stage = await page.locator('#stage').boundingBox(), bar = await page.locator('#transport').boundingBox();
      assert.ok(bar.x >= stage.x && bar.x + bar.width <= stage.x + stage.width && bar.y > stage.y, JSON.stringify({stage, bar}));
      page.check();
      await page.context().close();
    }
  },

  async what_the_browser_lacks_is_told_in_a_sentence({browser, address}) {
    const page = await openPage(browser, address, {init: () => { WebAssembly.validate = () => false; }});
    await page.waitForSelector('.cannot');
    assert.match(await page.textContent('.cannot'), /no WebAssembly SIMD/);
    await picture(page, 'without_simd');
    const plain = await openPage(browser, address, {javaScriptEnabled: false});
    assert.match(await plain.content(), /needs JavaScript/);
    page.check();
    await withBrowser({folder, npm, drawing: ['--disable-3d-apis']}, async ({browser: without, address: there}) => {
      const blind = await openPage(without, there);
      await blind.waitForSelector('.cannot');
      assert.match(await blind.textContent('.cannot'), /no WebGL 2/);
    });
  },

  async a_file_of_the_page_that_is_missing_is_named({browser, address}) {
    const context = await browser.newContext({viewport: kDesk});
    const page = await context.newPage();
    await page.route('**/creature.sinew', (route) => route.fulfill({status: 404}));
    await page.goto(address);
    assert.match(await told(page), /characters\/creature\.sinew is not there \(404\)/);
  },
};

if (!tests[name]) {
  console.error(`usage: node page.mjs TEST BUILD NATIVE; tests: ${Object.keys(tests).join(' ')}`);
  process.exit(2);
}
await withBrowser({folder, npm}, tests[name]);
