// hand.js  What pulls: pointers and arrow keys, on a figure or on the ball.
import {Plane, Sphere, Vector3} from 'three';

const kKeyReach = 0.35;  // of the height
const kKeys = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
const kMostPickedOnHover = 16;

export class Hand {
  // isPlaying(): nothing is pulled while it does not. grabbed(): is told when something is.
  constructor(stage, engine, isPlaying, grabbed) {
    Object.assign(this, {stage, engine, isPlaying, grabbed, held: null, keys: new Set(), ball: null});
    const canvas = stage.renderer.domElement;
    this.canvas = canvas;
    // Before the view's own controls hear of it.
    canvas.parentElement.addEventListener('pointerdown', (event) => this.grab(event), {capture: true});
    canvas.addEventListener('pointermove', (event) => (this.held ? this.pull(event) : this.hover(event)));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) canvas.addEventListener(end, (event) => this.letGo(event));
    canvas.addEventListener('keydown', (event) => this.press(event, true));
    canvas.addEventListener('keyup', (event) => this.press(event, false));
    canvas.addEventListener('blur', () => { this.keys.clear(), this.pullByKeys(); });
  }

  // What lies under the pointer: {figure, at} or {ball, at}.
  find(event) {
    if (!this.engine.description) return null;
    const ray = this.stage.ray(event.clientX, event.clientY), {calls} = this.engine;
    const onBall = this.ball && ray.intersectSphere(new Sphere(this.stage.ball.position, this.stage.ball.scale.x), new Vector3());
    const figure = calls.scene_pick(...ray.origin.toArray(), ...ray.direction.toArray());
    if (figure < 0) return onBall ? {ball: true, at: onBall} : null;
    const at = ray.at(calls.scene_picked_m(), new Vector3());
    return onBall && onBall.distanceTo(ray.origin) < at.distanceTo(ray.origin) ? {ball: true, at: onBall} : {figure, at};
  }

  grab(event) {
    if (event.target !== this.canvas || event.button !== 0 || event.isHandedOn) return;
    if (this.held) return this.handOn();
    if (!this.isPlaying()) return;
    const found = this.find(event);
    if (!found) return;
    event.stopPropagation();
    const away = this.stage.camera.getWorldDirection(new Vector3());
    this.held = {...found, pointer: event.pointerId, last: event, plane: new Plane().setFromNormalAndCoplanarPoint(away, found.at), ballAt: this.ball?.clone()};
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus({preventScroll: true});
    this.canvas.classList.add('grabs');
    this.grabbed();
  }

  pull(event) {
    if (event.pointerId !== this.held.pointer) return;
    this.held.last = event;
    const to = this.stage.ray(event.clientX, event.clientY).intersectPlane(this.held.plane, new Vector3());
    if (!to) return;
    const by = to.sub(this.held.at).clampLength(0, 3 * this.stage.height_m);
    if (this.held.ball) this.ball.copy(this.held.ballAt).add(by), this.moveBall();
    else this.engine.calls.scene_pull(this.held.figure, ...by.toArray());
  }

  letGo(event) {
    if (!this.held || event.pointerId !== this.held.pointer) return;
    if (!this.held.ball) this.engine.calls.scene_let_go();
    this.held = null;
    this.canvas.classList.remove('grabs');
  }

  // A second finger has come: both turn and near the view.
  handOn() {
    const {last} = this.held;
    this.letGo(last);
    const {pointerId, pointerType, clientX, clientY, pageX, pageY} = last;
    const first = new PointerEvent('pointerdown', {pointerId, pointerType, clientX, clientY, pageX, pageY, button: 0, buttons: 1, bubbles: true});
    first.isHandedOn = true;
    this.canvas.dispatchEvent(first);
  }

  hover(event) {
    if (!this.isPlaying()) return this.canvas.classList.remove('can-grab');
    if (event.buttons || this.engine.figures > kMostPickedOnHover) return;
    this.canvas.classList.toggle('can-grab', this.find(event) !== null);
  }

  press(event, isDown) {
    if (!Object.hasOwn(kKeys, event.key) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (isDown === this.keys.has(event.key)) return;
    isDown ? this.keys.add(event.key) : this.keys.delete(event.key);
    this.pullByKeys();
    this.grabbed();
  }

  pullByKeys() {
    if (!this.keys.size) return this.engine.calls.scene_let_go();
    const right = new Vector3().setFromMatrixColumn(this.stage.camera.matrixWorld, 0), by = new Vector3();
    for (const key of this.keys) by.addScaledVector(right, kKeys[key][0]).y += kKeys[key][1];
    this.engine.calls.scene_pull(0, ...by.multiplyScalar(kKeyReach * this.stage.height_m).toArray());
  }

  setBall(on) {
    const h = this.stage.height_m;
    this.ball = on ? (this.ball ?? new Vector3(0.1 * h, 0.34 * h, 0.75 * h)) : null;
    this.stage.ball.visible = on;
    this.stage.ball.scale.setScalar(0.12 * h);
    this.moveBall();
  }
  moveBall() {
    const radius_m = this.ball ? this.stage.ball.scale.x : 0;
    this.engine.calls.scene_set_ball(...(this.ball ?? new Vector3()).toArray(), radius_m);
  }
}
