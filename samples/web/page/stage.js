// stage.js  Camera, light, floor and ball; draws skinning left of the line and Sinew right of it.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const kFieldOfView_deg = 32;
const kLineBytes = 28;  // sinew_debug_line: six floats and a colour
const kMostLines = 20000;

function colorOf(variable) { return new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(variable).trim()); }

export class NoDrawing extends Error {}

function makeContext(canvas) {
  const context = canvas.getContext('webgl2', {antialias: true, alpha: false, stencil: false, powerPreference: 'high-performance'});
  if (!context) throw new NoDrawing('This browser gives the page no WebGL 2 to draw with. It may be switched off, or the graphics driver blocked.');
  return context;
}

function makeFloor() {
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial({opacity: 0.28}));
  floor.rotation.x = -Math.PI / 2;
  floor.receiveShadow = true;
  return floor;
}

function makeLines() {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6 * kMostLines), 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(new Uint8Array(8 * kMostLines), 4, true));
  const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({vertexColors: true, transparent: true, depthTest: false}));
  lines.frustumCulled = false;
  return lines;
}

export class Stage {
  constructor(canvas) {
    this.renderer = new THREE.WebGLRenderer({canvas, context: makeContext(canvas)});
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(kFieldOfView_deg, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.maxPolarAngle = 1.62;
    this.sun = new THREE.DirectionalLight(0xfff3e2, 2.4);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.bias = -0.0005;
    this.sun.shadow.normalBias = 0.01;
    this.floor = makeFloor();
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(1, 32, 24), new THREE.MeshStandardMaterial({color: 0xc8452f, roughness: 0.5}));
    this.ball.castShadow = true;
    this.ball.visible = false;
    this.lines = makeLines();
    this.grid = null;
    this.scene.add(new THREE.HemisphereLight(0xdfe8f2, 0x8d7d68, 1.3), this.sun, this.sun.target, this.floor, this.ball, this.lines);
    this.figure = null;
    this.height_m = 1;
    this.gone = [];       // figures whose programs the next picture may still use
    this.isStale = true;  // the picture is not that of what is there
    this.paint();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.paint());
    new ResizeObserver(() => this.fit()).observe(canvas.parentElement);
    this.fit();
  }

  paint() {
    this.scene.background = colorOf('--paper');
    this.renderer.setClearColor(this.scene.background);
    if (!this.figure) this.renderer.clear();
    if (this.grid) this.grid.material.color = colorOf('--line');
    this.isStale = true;
  }

  fit() {
    const {clientWidth, clientHeight} = this.renderer.domElement.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));  // which a zoom of the page changes
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    // The middle of the view is the middle of what the bar below leaves free.
    this.isStale = true;
    const covered = clientHeight - document.getElementById('transport').offsetTop;
    this.free = 1 - covered / clientHeight;
    this.camera.setViewOffset(clientWidth, clientHeight, 0, covered / 2, clientWidth, clientHeight);
  }

  // Another character, or another number of them.
  show(figure, height_m, figures) {
    if (this.figure) this.scene.remove(this.figure.mesh), this.gone.push(this.figure);
    this.figure = figure;
    this.height_m = height_m;
    this.scene.add(figure.mesh);
    const across_m = 1.1 * height_m * Math.ceil(Math.sqrt(figures)), reach_m = Math.max(2.2 * height_m, across_m);
    const middle = new THREE.Vector3(0, height_m / 2, figures > 1 ? -across_m / 2 : 0);
    this.sun.target.position.copy(middle);
    this.sun.position.copy(middle).add(new THREE.Vector3(0.5, 1.2, 0.75).multiplyScalar(reach_m * 1.5));
    Object.assign(this.sun.shadow.camera, {left: -reach_m, right: reach_m, top: reach_m, bottom: -reach_m, near: reach_m / 100, far: 5 * reach_m});
    this.sun.shadow.camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.01 * height_m;
    this.floor.scale.setScalar(20 * reach_m);
    if (this.grid) this.scene.remove(this.grid), this.grid.dispose();
    this.grid = new THREE.GridHelper(20 * height_m * Math.ceil(reach_m / height_m / 4), 20 * Math.ceil(reach_m / height_m / 4));
    this.grid.material = new THREE.LineBasicMaterial({color: colorOf('--line')});
    this.grid.position.y = -0.001 * height_m;
    this.scene.add(this.grid);
    Object.assign(this.camera, {near: 0.02 * height_m, far: 100 * reach_m});
    this.camera.updateProjectionMatrix();
    this.controls.minDistance = 0.3 * height_m;
    this.controls.maxDistance = 12 * reach_m;
  }

  // The view of a character from its front, a little to the side; of a crowd over its heads.
  frame(figures) {
    const h = this.height_m, {box, facesBack} = this.figure, size = box.getSize(new THREE.Vector3()), middle = box.getCenter(new THREE.Vector3());
    const across_m = 1.1 * h * Math.ceil(Math.sqrt(figures)), narrow = Math.max(1, 0.85 / this.camera.aspect);
    const large_m = Math.max(h, 0.8 * size.x, 0.9 * size.z);
    const far_m = figures > 1 ? 1.45 * across_m + 2.2 * large_m : 2.6 * large_m;
    this.controls.target.set(figures > 1 ? 0 : middle.x, middle.y - 0.02 * h, figures > 1 ? -0.32 * across_m : middle.z);
    const from = new THREE.Vector3(0.35, figures > 1 ? 0.6 : 0.16, facesBack && figures === 1 ? -1 : 1).normalize();
    this.camera.position.copy(this.controls.target).addScaledVector(from, (far_m * narrow) / this.free);
    this.controls.update();
  }

  place() { return [...this.camera.position.toArray(), ...this.controls.target.toArray()].map((x) => Number(x.toFixed(3))); }
  goTo(place) {
    this.camera.position.fromArray(place);
    this.controls.target.fromArray(place, 3);
    this.controls.update();
  }

  // The camera, as the engine's scheduler counts what is seen.
  view() {
    const [x, y, z, w] = this.camera.quaternion.toArray();
    return [...this.camera.position.toArray(), x, y, z, w, (this.camera.fov * Math.PI) / 180, this.camera.aspect];
  }

  ray(clientX, clientY) {
    const {left, top, width, height} = this.renderer.domElement.getBoundingClientRect();
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height), this.camera);
    return caster.ray;
  }

  setLines(engine, parts) {
    const count = parts ? engine.calls.scene_draw_lines(parts) : 0, geometry = this.lines.geometry;
    if (count) {
      const from = new DataView(engine.calls.memory.buffer, engine.calls.scene_lines(), kLineBytes * count);
      const {position, color} = geometry.attributes;
      for (let i = 0; i < count; ++i) {
        for (let k = 0; k < 6; ++k) position.array[6 * i + k] = from.getFloat32(kLineBytes * i + 4 * k, true);
        const rgba = from.getUint32(kLineBytes * i + 24, true);
        for (let k = 0; k < 8; ++k) color.array[8 * i + k] = (rgba >>> (24 - 8 * (k % 4))) & 255;
      }
      position.needsUpdate = color.needsUpdate = true;
    }
    geometry.setDrawRange(0, 2 * count);
    this.lines.visible = count > 0;
  }

  // split: 0..1 of the width; left of it skinning.
  drawIfStale(split) {
    this.controls.update();
    if (this.isStale && this.figure) this.draw(split);
    this.isStale = false;
    for (const figure of this.gone.splice(0)) figure.dispose();
  }

  // What is drawn is to be made anew.
  forget() {
    if (this.figure) this.scene.remove(this.figure.mesh), this.figure.dispose();
    for (const figure of this.gone.splice(0)) figure.dispose();
    this.figure = null;
  }

  draw(split) {
    const {clientWidth: width, clientHeight: height} = this.renderer.domElement;
    const x = Math.round(split * width), has_lines = this.lines.visible;
    this.renderer.setScissorTest(true);
    for (const [from, to, isSinew] of [[0, x, false], [x, width, true]]) {
      if (to <= from) continue;
      this.figure.choose(isSinew);
      this.lines.visible = has_lines && isSinew;
      this.renderer.setScissor(from, 0, to - from, height);
      this.renderer.render(this.scene, this.camera);
    }
    this.lines.visible = has_lines;
  }
}
