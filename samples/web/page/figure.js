// figure.js  All figures of a scene as one instanced mesh.
import * as THREE from 'three';
import {depthMaterial, kTexels, makeUniforms, soften} from './soft_material.js';

const kTierColors = {0: [0.6, 0.58, 0.55, 0.8], 1: [0.93, 0.6, 0.2, 0.7], 2: [0.25, 0.55, 0.3, 0.6], 4: [0.25, 0.5, 0.85, 0.6]};
const kNoColor = [0, 0, 0, 0];
const kClay = 0xc9a58a;

function makeTexture(texels, format, type, makeArray) {
  const rows = Math.max(1, Math.ceil(texels / kTexels));
  const texture = new THREE.DataTexture(makeArray(4 * kTexels * rows), kTexels, rows, format, type);
  texture.needsUpdate = true;
  return texture;
}
const floatTexture = (texels) => makeTexture(texels, THREE.RGBAFormat, THREE.FloatType, (n) => new Float32Array(n));
const halfTexture = (texels) => makeTexture(texels, THREE.RGBAFormat, THREE.HalfFloatType, (n) => new Uint16Array(n));

function upload(texture, from) {
  texture.image.data.set(from);
  texture.needsUpdate = true;
}

// Eight joints and weights of each vertex, as two attributes of four.
function addSkin(geometry, engine) {
  const {vertexCount, skinJoints, skinWeights, skinStride} = engine.description;
  const arrays = {jointsA: Uint16Array, jointsB: Uint16Array, weightsA: Float32Array, weightsB: Float32Array};
  const attributes = Object.fromEntries(Object.entries(arrays).map(([name, Type]) => [name, new Type(4 * vertexCount)]));
  const memory = engine.calls.memory.buffer;
  for (let v = 0; v < vertexCount; ++v) {
    const joints = new Uint16Array(memory, skinJoints + v * skinStride, 8), weights = new Float32Array(memory, skinWeights + v * skinStride, 8);
    attributes.jointsA.set(joints.subarray(0, 4), 4 * v), attributes.jointsB.set(joints.subarray(4), 4 * v);
    attributes.weightsA.set(weights.subarray(0, 4), 4 * v), attributes.weightsB.set(weights.subarray(4), 4 * v);
  }
  for (const [name, array] of Object.entries(attributes)) geometry.setAttribute(name, new THREE.BufferAttribute(array, 4));
}

// Which of the moved vertices, and of which soft part, a vertex is; -1: none.
function addParts(geometry, engine) {
  const {vertexCount, movedCount, moved, regions} = engine.description;
  const movedIndex = new Float32Array(vertexCount).fill(-1), regionIndex = new Float32Array(vertexCount).fill(-1);
  engine.words(moved, movedCount).forEach((vertex, i) => { movedIndex[vertex] = i; });
  regions.forEach((region, i) => engine.words(region.vertices, region.vertexCount).forEach((vertex) => { regionIndex[vertex] = i; }));
  geometry.setAttribute('movedIndex', new THREE.BufferAttribute(movedIndex, 1));
  geometry.setAttribute('regionIndex', new THREE.BufferAttribute(regionIndex, 1));
}

function makeGeometry(engine) {
  const {vertexCount, triangleCount, positions, normals, triangles, primitives} = engine.description;
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(engine.floats(positions, 3 * vertexCount).slice(), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(engine.floats(normals, 3 * vertexCount).slice(), 3));
  geometry.setIndex(new THREE.BufferAttribute(engine.words(triangles, 3 * triangleCount).slice(), 1));
  addSkin(geometry, engine);
  addParts(geometry, engine);
  primitives.forEach((primitive, i) => geometry.addGroup(3 * primitive.firstTriangle, 3 * primitive.triangleCount, i));
  geometry.instanceCount = engine.figures;
  return geometry;
}

export class Figure {
  // look: of look.js, or null: clay.
  constructor(engine, look) {
    const {jointCount, movedCount, primitives} = engine.description;
    this.uniforms = makeUniforms();
    this.posed = floatTexture(3 * jointCount * engine.figures);
    this.shown = floatTexture(3 * jointCount * engine.figures);
    this.displacements = halfTexture(movedCount * engine.figures);
    this.normals = halfTexture(movedCount);
    this.tints = new THREE.DataTexture(new Uint8Array(4 * 256), 256, 1);
    const values = {softJoints: this.shown, softDisplacements: this.displacements, softNormals: this.normals, softTints: this.tints,
      softJointCount: jointCount, softMovedCount: movedCount};
    for (const [name, value] of Object.entries(values)) this.uniforms[name].value = value;
    const geometry = makeGeometry(engine);
    const clay = () => new THREE.MeshStandardMaterial({color: kClay, roughness: 0.75, side: THREE.DoubleSide});
    const materials = primitives.map((_, i) => soften(look?.materials[i]?.clone() ?? clay(), this.uniforms));
    for (const [name, attribute] of Object.entries(look?.attributes ?? {})) geometry.setAttribute(name, attribute);
    geometry.computeBoundingBox();
    this.box = geometry.boundingBox;  // of the bind pose
    this.facesBack = look?.facesBack ?? false;
    this.mesh = new THREE.Mesh(geometry, materials);
    this.mesh.frustumCulled = false;  // its bounds are those of the bind pose
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.customDepthMaterial = depthMaterial(this.uniforms);
  }

  // What the step has left.
  read(engine, showsTiers) {
    const {jointCount, movedCount} = engine.description, {calls, figures} = engine;
    upload(this.posed, engine.floats(calls.scene_posed_joints(), 12 * jointCount * figures));
    upload(this.shown, engine.floats(calls.scene_shown_joints(), 12 * jointCount * figures));
    upload(this.displacements, engine.halves(calls.scene_displacements(), 4 * movedCount * figures));
    upload(this.normals, engine.halves(calls.scene_normals(), 4 * movedCount));
    const tiers = engine.bytes(calls.scene_tiers(), 2 * figures), tints = this.tints.image.data;
    for (let i = 0; i < figures; ++i) tints.set((showsTiers ? kTierColors[tiers[2 * i]] : kNoColor).map((c) => 255 * c), 4 * i);
    this.tints.needsUpdate = true;
  }

  showRegions(on) { this.uniforms.softHasRegions.value = on; }

  // As skinning alone has it, or Sinew.
  choose(isSinew) {
    this.uniforms.softIsShown.value = isSinew;
    this.uniforms.softJoints.value = isSinew ? this.shown : this.posed;
  }

  dispose() {
    this.mesh.geometry.dispose();
    for (const material of this.mesh.material) material.dispose();
    this.mesh.customDepthMaterial.dispose();
    for (const texture of [this.posed, this.shown, this.displacements, this.normals, this.tints]) texture.dispose();
  }
}
