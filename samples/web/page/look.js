// look.js  Materials, texture coordinates and colours of the glTF that a pack was baked from.
import {BufferAttribute, LoadingManager} from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';

// In place of the loader's words, which are for programmers.
function sentenceOf(error) {
  const isCompressed = /draco|ktx2|meshopt/i.test(error?.message ?? '');
  return isCompressed ? 'it is compressed by Draco, meshopt or KTX2, which this page does not read; export it without' : 'it is no binary glTF that can be read here';
}
const retold = (promise) => promise.catch((error) => { throw new Error(sentenceOf(error)); });

// A file of one's own sends for nothing.
function makeLoader() {
  const manager = new LoadingManager();
  manager.setURLModifier((url) => (/^(data|blob):/.test(url) ? url : 'data:,'));
  return new GLTFLoader(manager);
}

function parse(bytes) {
  return new Promise((resolve, reject) => makeLoader().parse(bytes, '', resolve, reject));
}

// The file's mesh that a pack's one was: of its name, with as many vertices in each primitive.
function findMesh(json, pack, mesh, taken) {
  const nodes = json.nodes ?? [], meshOf = (node) => json.meshes?.[node.mesh];
  const primitives = pack.primitives.filter((primitive) => primitive.mesh === mesh);
  const fits = (node) => meshOf(node) && primitives.every(({index, vertexCount}) => {
    const position = meshOf(node).primitives?.[index]?.attributes?.POSITION;
    return json.accessors?.[position]?.count === vertexCount;
  });
  const name = pack.meshes[mesh].name;
  const candidates = nodes.filter((node) => !taken.has(node) && fits(node));
  const found = candidates.find((node) => node.name === name || meshOf(node).name === name) ?? candidates[0];
  if (found) taken.add(found);
  return found?.mesh;
}

const kAttributes = {TEXCOORD_0: 'uv', TEXCOORD_1: 'uv1', COLOR_0: 'color'};

async function addAttribute(look, parser, accessor, name, primitive, vertexCount) {
  const from = await parser.getDependency('accessor', accessor);
  const size = from.itemSize;
  look.attributes[name] ??= new BufferAttribute(new Float32Array(size * vertexCount).fill(1), size);
  const to = look.attributes[name];
  for (let i = 0; i < primitive.vertexCount; ++i)
    for (let k = 0; k < Math.min(size, to.itemSize); ++k) to.setComponent(primitive.firstVertex + i, k, from.getComponent(i, k));
}

async function addPrimitive(look, parser, pack, i, mesh) {
  const primitive = pack.primitives[i], {attributes, material} = parser.json.meshes[mesh].primitives[primitive.index];
  if (material !== undefined) {
    look.materials[i] = (await parser.getDependency('material', material)).clone();
    look.materials[i].vertexColors = attributes.COLOR_0 !== undefined;
  }
  for (const [of, name] of Object.entries(kAttributes))
    if (attributes[of] !== undefined) await addAttribute(look, parser, attributes[of], name, primitive, pack.vertexCount);
}

class Look {
  materials = [];   // of the pack's primitives
  attributes = {};  // of all its vertices
  facesBack = false;

  dispose() {
    const textures = new Set(this.materials.flatMap((material) => Object.values(material ?? {}).filter((value) => value?.isTexture)));
    for (const texture of textures) texture.dispose(), texture.source?.data?.close?.();
  }
}

async function fill(look, parser, pack, meshes) {
  for (let i = 0; i < pack.primitives.length; ++i) await addPrimitive(look, parser, pack, i, meshes[pack.primitives[i].mesh]);
}

// pack: Engine.description. Throws where the file cannot be read, or is another than the pack's.
export async function loadLook(bytes, pack) {
  const {parser} = await retold(parse(bytes));
  const taken = new Set(), meshes = pack.meshes.map((_, mesh) => findMesh(parser.json, pack, mesh, taken));
  const missing = meshes.findIndex((mesh) => mesh === undefined);
  if (missing >= 0) throw new Error(`it has no mesh "${pack.meshes[missing].name}" with the pack's vertices: bake the .sinew from this file again`);
  const look = new Look();
  look.facesBack = parser.json.extensions?.VRM !== undefined;  // VRM 0 faces -z
  await retold(fill(look, parser, pack, meshes));
  return look;
}
