// soft_material.js  Any of three's materials, drawing Sinew's vertices: bind position plus displacement, skinned by eight joints.
import * as THREE from 'three';

export const kTexels = 1024;  // in a row of a texture that is read by a running number

const kDeclarations = `
uniform highp sampler2D softJoints, softDisplacements, softNormals, softTints;
uniform int softJointCount, softMovedCount;
uniform bool softIsShown, softHasRegions;
attribute vec4 jointsA, jointsB, weightsA, weightsB;
attribute float movedIndex, regionIndex;
varying vec4 softTint;

vec4 softTexel(sampler2D of, int i) { return texelFetch(of, ivec2(i % ${kTexels}, i / ${kTexels}), 0); }

void softAdd(float joint, float weight, inout mat3x4 rows) {
  if (weight == 0.0) return;
  int first = 3 * (gl_InstanceID * softJointCount + int(joint + 0.5));
  for (int r = 0; r < 3; ++r) rows[r] += weight * softTexel(softJoints, first + r);
}
mat3x4 softRows() {
  mat3x4 rows = mat3x4(0.0);
  for (int k = 0; k < 4; ++k) softAdd(jointsA[k], weightsA[k], rows);
  if (weightsB.x != 0.0)
    for (int k = 0; k < 4; ++k) softAdd(jointsB[k], weightsB[k], rows);
  return rows;
}
bool softMoves() { return softIsShown && movedIndex >= 0.0; }
vec3 softNormal(vec3 bind, mat3x4 rows) {
  if (softMoves() && gl_InstanceID == 0) bind = softTexel(softNormals, int(movedIndex + 0.5)).xyz;
  return normalize(bind * mat3(rows));
}
vec3 softPosition(vec3 bind, mat3x4 rows) {
  if (softMoves()) bind += softTexel(softDisplacements, gl_InstanceID * softMovedCount + int(movedIndex + 0.5)).xyz;
  return vec4(bind, 1.0) * rows;
}
vec4 softTintOf() {
  if (softHasRegions && regionIndex >= 0.0) return vec4(0.5 + 0.5 * cos(6.2832 * (0.381966 * regionIndex + vec3(0.0, 0.33, 0.67))), 0.7);
  return texelFetch(softTints, ivec2(gl_InstanceID, 0), 0);
}
`;

// One set of uniforms for all materials of a figure.
export function makeUniforms() {
  return {
    softJoints: {value: null}, softDisplacements: {value: null}, softNormals: {value: null}, softTints: {value: null},
    softJointCount: {value: 0}, softMovedCount: {value: 0}, softIsShown: {value: true}, softHasRegions: {value: false},
  };
}

export function soften(material, uniforms) {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = kDeclarations + shader.vertexShader
      .replace('void main() {', 'void main() {\nmat3x4 rows = softRows();')
      .replace('#include <beginnormal_vertex>', 'vec3 objectNormal = softNormal(normal, rows);')
      .replace('#include <begin_vertex>', 'vec3 transformed = softPosition(position, rows); softTint = softTintOf();');
    shader.fragmentShader = 'varying vec4 softTint;\n' + shader.fragmentShader
      .replace('#include <color_fragment>', '#include <color_fragment>\ndiffuseColor.rgb = mix(diffuseColor.rgb, softTint.rgb, softTint.a);');
  };
  material.customProgramCacheKey = () => 'soft';
  return material;
}

export function depthMaterial(uniforms) {
  return soften(new THREE.MeshDepthMaterial({depthPacking: THREE.RGBADepthPacking}), uniforms);
}
