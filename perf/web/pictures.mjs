// pictures.mjs  node pictures.mjs BUILD FOLDER: the pictures of samples/web/README.md. BUILD: of tests/samples/web/put_together.sh.
import {openPage, withBrowser} from '../../tests/samples/web/browser.mjs';

const [build, out] = process.argv.slice(2);
const kPictures = {
  dragged: ['clip=(still)', 10, () => sinewPage.engine.calls.scene_pull(0, 0.4, 0.05, 0)],
  crowd: ['figures=100&budget=4&split=0&showTiers=1', 400, () => {}],
  simulated: ['character=creature_rods&showRegions=1&showNodes=1&showRods=1&showTouches=1&ball=1&split=0&clip=(still)', 60,
    () => { sinewPage.hand.ball.set(0.05, 0.36, 0.3), sinewPage.hand.moveBall(); }],
};

await withBrowser({folder: `${build}/page`, npm: `${build}/npm`}, async ({browser, address}) => {
  for (const [name, [settings, steps, before]] of Object.entries(kPictures)) {
    const page = await openPage(browser, address, {hash: `#playing=0&${settings}`, viewport: {width: 1120, height: 640}});
    await page.waitForFunction(() => window.sinewPage?.characters.look, null, {timeout: 60000});
    await page.evaluate(before);
    // What has been asked to be drawn is drawn first: the software that draws takes the cores.
    await page.evaluate(() => sinewPage.stage.renderer.getContext().readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4)));
    await page.evaluate((count) => {
      for (let i = 0; i < count; ++i) sinewPage.stepBy(1 / 60);
      sinewPage.showNumbers();
      document.getElementById('hint').hidden = true;
    }, steps);
    await page.waitForTimeout(500);
    await page.screenshot({path: `${out}/web_${name}.jpg`, type: 'jpeg', quality: 82, timeout: 120000});
    await page.context().close();
  }
});
