// characters.js  Which character is shown: one of the page's, or one's own.
import {sortFiles} from './files.js';
import {loadLook} from './look.js';
import {kOwn} from './settings.js';

async function read(file) {
  try {
    return await file.arrayBuffer();
  } catch {
    throw new Error(`${file.name} cannot be read.`);
  }
}

export class Characters {
  // show(look): what the page does when the engine has another character; look: null: without its colours.
  constructor(engine, options, fetchBytes, show) {
    Object.assign(this, {engine, options, fetchBytes, show, name: null, look: null, turn: 0, isLoading: false});
  }

  // What is asked for last counts. Throws where it cannot be read, and nothing has changed; where its colours cannot be read it is
  // shown without them, and throws.
  async take(name, readBoth) {
    const turn = ++this.turn, {pack, look} = await readBoth();
    if (turn !== this.turn) return;
    this.engine.open(pack, ...this.options());
    const mine = this.engine.description;
    let loaded = null;
    this.name = name;
    this.isLoading = true;  // the figure is still that of another scene
    try {
      if (look) loaded = await loadLook(look, mine);
    } finally {
      if (this.engine.description === mine) this.setLook(loaded);
    }
  }

  // Whatever is on its way is not wanted any more.
  stay() { ++this.turn; }

  setLook(look) {
    const before = this.look;
    this.look = look;
    this.isLoading = false;
    this.show(look);
    before?.dispose();
  }

  takeNamed(name) {
    return this.take(name, async () => {
      const [pack, look] = await Promise.all([this.fetchBytes(`characters/${name}.sinew`), this.fetchBytes('characters/creature.glb')]);
      return {pack, look};
    });
  }

  // Returns the pack's name, or null where only its colours came.
  async takeFiles(files) {
    const {pack, look} = sortFiles(files, this.name === kOwn);
    if (!pack) {
      const mine = this.engine.description, loaded = await this.told(look.name, read(look).then((bytes) => loadLook(bytes, mine)));
      if (this.engine.description === mine) this.setLook(loaded);
      return null;
    }
    const before = this.engine.description;
    try {
      await this.take(kOwn, async () => ({pack: await read(pack), look: look && (await read(look))}));
    } catch (error) {
      const isShown = this.engine.description !== before;
      throw new Error(isShown ? `${look.name}: ${error.message}. The character is shown without its colours.` : `${pack.name}: ${error.message}.`, {cause: isShown});
    }
    return pack.name;
  }

  told(name, promise) {
    return promise.catch((error) => { throw new Error(`${name}: ${error.message}.`); });
  }
}
