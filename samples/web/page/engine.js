// engine.js  The WebAssembly module: engine/scene.h with strings and arrays in the place of addresses.

const kReport = ['stepUs', 'expectedError', 'network', 'modal', 'extrapolated', 'skinned', 'hidden', 'dormant', 'cut', 'ballX', 'ballY', 'ballZ'];
const kBadDescriptor = 8;  // WASI's

// Of what the C library asks its host for, a page has a clock, and no files.
function makeHost(memory) {
  const k2to32 = 4294967296;
  let words = new Uint32Array(0);
  // Asked many times a step: it makes nothing that would have to be collected.
  const put = (address, low, high) => {
    if (words.buffer !== memory().buffer) words = new Uint32Array(memory().buffer);
    words[address >>> 2] = low;
    words[(address >>> 2) + 1] = high;
    return 0;
  };
  const known = {
    clock_time_get(_clock, _precision, out) {
      const ns = Math.round(performance.now() * 1e6);
      return put(out, ns % k2to32, ns / k2to32);
    },
    environ_sizes_get(count, bytes) {
      new DataView(memory().buffer).setUint32(count, 0, true);
      new DataView(memory().buffer).setUint32(bytes, 0, true);
      return 0;
    },
    environ_get: () => 0,
    proc_exit(code) { throw new Error(`the engine stopped (${code})`); },
  };
  return {wasi_snapshot_preview1: new Proxy(known, {get: (functions, name) => functions[name] ?? (() => kBadDescriptor)})};
}

// bytes: of the module, or a promise of them.
export async function loadEngine(bytes) {
  let exports = null;
  const {instance} = await WebAssembly.instantiate(await bytes, makeHost(() => exports.memory));
  exports = instance.exports;
  exports._initialize();
  return new Engine(exports);
}

export class Engine {
  constructor(exports) {
    this.calls = exports;
    this.description = null;
  }

  // Memory grows, and arrays of it end then: they are made where they are used.
  // Beyond 2 GB addresses come as negative numbers.
  bytes(address, count) { return new Uint8Array(this.calls.memory.buffer, address >>> 0, count); }
  floats(address, count) { return new Float32Array(this.calls.memory.buffer, address >>> 0, count); }
  halves(address, count) { return new Uint16Array(this.calls.memory.buffer, address >>> 0, count); }
  words(address, count) { return new Uint32Array(this.calls.memory.buffer, address >>> 0, count); }
  text(address) {
    const all = new Uint8Array(this.calls.memory.buffer);
    return new TextDecoder().decode(all.slice(address >>> 0, all.indexOf(0, address >>> 0)));
  }

  // Throws what the engine says of a refusal.
  must(status) {
    if (status !== 0) throw new Error(this.text(this.calls.scene_message()));
  }

  open(pack, figures, touches) {
    const address = this.calls.scene_pack_bytes(pack.byteLength);
    if (address) this.bytes(address, pack.byteLength).set(new Uint8Array(pack));
    this.must(this.calls.scene_open(figures, touches));
    this.description = JSON.parse(this.text(this.calls.scene_description()));
    this.figures = figures;
  }

  change(figures, touches) {
    this.must(this.calls.scene_change(figures, touches));
    this.description = JSON.parse(this.text(this.calls.scene_description()));
    this.figures = figures;
  }

  step(seconds) { this.must(this.calls.scene_step(seconds)); }

  report() {
    const numbers = this.floats(this.calls.scene_report(), kReport.length);
    return Object.fromEntries(kReport.map((name, i) => [name, numbers[i]]));
  }

  positions(figure) { return this.floats(this.calls.scene_positions(figure), 3 * this.description.vertexCount); }
}
