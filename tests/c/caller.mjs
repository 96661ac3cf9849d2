// caller.mjs  node caller.mjs LIBRARY INCLUDE PACK: what the callers of this folder play, through koffi, which npm has
// put into the folder that this runs in. Structs and functions are read out of sinew.h: nothing is written twice.
import fs from 'node:fs';
import { createRequire } from 'node:module';

const skipped = 77;
let koffi;
try {
  koffi = createRequire(`${process.cwd()}/`)('koffi');
} catch {
  console.error('skipped: npm could not install koffi');
  process.exit(skipped);
}

const [library, include, pack] = process.argv.slice(2);
const version = fs.readFileSync(`${include}/sinew/version.h`, 'utf8');
const header = fs.readFileSync(`${include}/sinew/sinew.h`, 'utf8')
  .replace(/\/\*.*?\*\//gs, '').replace(/\\\n/g, ' ');

const constants = {};
for (const [, name, value] of version.matchAll(/#define (SINEW_VERSION_\w+) (\d+)/g)) constants[name] = Number(value);
for (const [, name, value] of header.matchAll(/(SINEW_\w+) = (\d+)/g)) constants[name] = Number(value);

const lib = koffi.load(library);
const types = {};
for (const [, name] of header.matchAll(/typedef uint32_t (sinew_\w+);/g)) types[name] = koffi.alias(name, 'uint32_t');

// Arrays and lists of one type become a field each; a function is a pointer.
function fields(body) {
  const out = {};
  body = body.replace(/\w+\*? \(\*(\w+)\)\([^)]*\);/g, 'void* $1;').replace(/void\* \(\*(\w+)\)\([^)]*\);/g, 'void* $1;');
  for (const declaration of body.split(';').map((part) => part.trim()).filter(Boolean)) {
    const [, type, names] = declaration.match(/^((?:const )?\w+\**)\s+(.*)$/s);
    for (const name of names.split(',').map((part) => part.trim())) {
      const sizes = [...name.matchAll(/\[(\d+)\]/g)].map((match) => Number(match[1]));
      let field = type.includes('*') ? 'void*' : type;
      for (const size of sizes.reverse()) field = koffi.array(field, size);
      out[name.replace(/\[.*/, '')] = field;
    }
  }
  return out;
}
for (const [, name, body] of header.matchAll(/typedef struct (sinew_\w+) \{(.*?)\} \1;/gs))
  types[name] = koffi.struct(name, fields(body));

const sinew = {};
for (const [, declaration] of header.matchAll(/SINEW_API ([^;]+);/g)) {
  const name = declaration.match(/(sinew_\w+)\(/)[1];
  const marked = declaration.replace(/\s+/g, ' ').replace(/(?<!const )(sinew_\w+\* out)\b/g, '_Out_ $1')
    .replace(/float\* out/g, '_Out_ float* out');
  sinew[name] = lib.func(marked.replace(/(sinew_matrix34|float)\* out/g, 'void* out').replace(/_Out_ void/g, 'void'));
}
const layout = header.match(/#define SINEW_LAYOUT\s+(.*)/)[1]
  .replace(/\(uint32_t\)/, '').replace(/sizeof\((\w+)\)/g, (_, name) => koffi.sizeof(types[name]))
  .replace(/(\d)u\b/g, '$1').replace(/SINEW_VERSION\b/,
    constants.SINEW_VERSION_MAJOR * 10000 + constants.SINEW_VERSION_MINOR * 100 + constants.SINEW_VERSION_PATCH);

function check(status) {
  if (status !== constants.SINEW_OK) throw new Error(sinew.sinew_message());
}
const made = (call) => { const out = {}; check(call(out)); return out; };

const world = made((out) => sinew.sinew_create_world(Function(`return ${layout}`)() >>> 0, sinew.sinew_default_world_def(), out));
const asset = made((out) => sinew.sinew_load_asset_file(world, pack, out));
const info = made((out) => sinew.sinew_get_asset_info(world, asset, out));
const instance = made((out) =>
  sinew.sinew_create_instance(world, { ...sinew.sinew_default_instance_def(), asset }, out));
const joints = new Float32Array(12 * info.joint_count), places = new Float32Array(3 * info.vertex_count);
check(sinew.sinew_bind_pose(world, asset, joints, info.joint_count));
for (let frame = 0; frame < 60; ++frame) {
  const pose = sinew.sinew_default_pose();
  pose.joints = joints;
  pose.joint_count = info.joint_count;
  pose.root.position_m[1] = 0.01 * (frame % 20);
  check(sinew.sinew_set_pose(world, instance, pose));
  check(sinew.sinew_step(world, Math.fround(1 / 60), null));
}
check(sinew.sinew_read_positions(world, instance, constants.SINEW_SPACE_CHARACTER, places, info.vertex_count));
for (const place of places) console.log(place);
check(sinew.sinew_destroy_world(world));
if (sinew.sinew_step(world, 0, null) !== constants.SINEW_STALE_ID) throw new Error('a world lived on');
