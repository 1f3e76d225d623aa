// The three-dimensional view: camera, lights, bodies, zones, lines, clicks.
import * as THREE from "three";
import { OrbitControls } from "orbit";
import { AskedPath } from "./asked_path.js";
import { Backdrop } from "./backdrop.js";
import { Bodies } from "./bodies.js";
import { PairLines } from "./pair_lines.js";
import { Seen } from "./seen.js";
import { StopGhosts } from "./stop_ghosts.js";
import { Visuals } from "./visuals.js";
import { ZoneShells } from "./zone_shells.js";
import { css } from "./format.js";

const DIRECTIONS = { cell: [1.0, -1.25, 0.75], top: [0, -0.001, 1], front: [0, -1, 0.02], side: [1, 0, 0.02] };
const CLICK_PIXELS = 5;
const LARGE = 500; // parts: in larger cells only the still picture has smooth outlines, which costs no frame time
const ROUNDING = 1e-7; // m
// When frames take longer than this, ms, they are drawn with fewer pixels, down to this share.
const SLOW_FRAME = 34, LEAST_SHARPNESS = 0.4;
const FADE_AGAIN_MS = 250; // between searches for bodies that hide moving ones
// Checks of the first view take at most KEEPING_SHARE of the time. The view grows by GROWTH as soon as a moving body is farther out than
// INSIDE, where 1 is the view's edge.
const KEEPING_SHARE = 0.05, GROWTH = 1.15, INSIDE = 0.95;
// A pair fills this share of the view, or less where its gap is small beside its objects or this length, m.
const GAP_SHARE = 0.45, OBJECT_SHARE = 0.6, LEAST_LOOK = 0.03;
const ALONG = 0.6; // cosine between view and gap, above which the gap would be seen from its end

// Without a graphics card, smooth outlines cost a third of a frame's time.
function isDrawnInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2"), names = gl?.getExtension("WEBGL_debug_renderer_info");
  const isSo = /swiftshader|llvmpipe|software/i.test(names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "");
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return isSo;
}

export class SceneView {
  // Callbacks: pairChosen(pair), pairLookedAt(pair), objectChosen(object or undefined); picksBodies() is true while
  // clicks choose bodies only.
  constructor(scene, on) {
    this.on = on;
    this.cell = scene;
    this.element = document.getElementById("scene");
    const canvas = document.getElementById("view");
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: scene.parts.length < LARGE && !isDrawnInSoftware() });
    this.sharpness = Math.min(window.devicePixelRatio, 2);
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(38, 1, 0.01, 400);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.15;
    this.controls.addEventListener("start", () => (this.follows = undefined));
    this.follows = { side: "cell", moving: true }; // what the view shows by itself, until a person moves it
    this.reached = new THREE.Box3(); // where moving parts have been
    this.bodies = new Bodies(scene);
    this.shells = new ZoneShells(scene);
    this.lines = new PairLines(document.getElementById("labels"), on.pairChosen, on.pairLookedAt);
    this.visuals = new Visuals(this.bodies);
    this.seen = new Seen(scene, this.bodies);
    this.askedPath = new AskedPath(this.bodies);
    this.stopGhosts = new StopGhosts(scene, this.bodies);
    this.backdrop = new Backdrop(this.bodies.still, this.bodies.veil);
    this.world.add(this.backdrop, this.bodies, this.visuals, this.shells, this.seen, this.askedPath, this.stopGhosts, this.lines);
    this.clicks(canvas);
    this.changes = 0;
    new ResizeObserver(() => this.resizeSoon()).observe(this.element);
    this.resize();
    this.retheme();
  }

  // A canvas of another size is empty, so it gets its size right before it is drawn.
  resizeSoon() {
    this.isResized = true;
    ++this.changes;
  }
  resize() {
    this.isResized = false;
    this.size = { width: this.element.clientWidth, height: this.element.clientHeight };
    this.renderer.setPixelRatio(this.sharpness);
    this.renderer.setSize(this.size.width, this.size.height, false);
    this.camera.aspect = this.size.width / Math.max(1, this.size.height);
    this.camera.updateProjectionMatrix();
  }

  retheme() {
    ++this.changes;
    this.askedPath.retheme();
    this.bodies.recolour();
    this.shells.recolour();
  }

  // Looks from this side at the whole cell, or first at its moving parts.
  fit(side = "cell", moving = false) {
    const sphere = this.sphere(moving) ?? this.sphere(false);
    if (!sphere) return;
    this.follows = { side, moving };
    this.lookFrom(new THREE.Vector3(...DIRECTIONS[side]), sphere.center, 1.12 * sphere.radius);
    this.surround();
  }
  // Puts the camera where a sphere fills the view.
  lookFrom(direction, centre, radius) {
    const narrow = Math.min(1, this.camera.aspect);
    const away = radius / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction.normalize(), away);
  }
  // Looks at the gaps of these pairs of a report, from the viewer's side but not along the first gap.
  lookAt(pairs) {
    const gaps = pairs.map(({ witness_a, witness_b }) => [witness_a, witness_b].map(({ x, y, z }) => new THREE.Vector3(x, y, z)));
    if (!gaps.length || !gaps.flat().every(({ x }) => Number.isFinite(x))) return;
    const { center, radius } = new THREE.Box3().setFromPoints(gaps.flat()).getBoundingSphere(new THREE.Sphere());
    const named = new Set(pairs.flatMap(({ pair }) => this.cell.pairs[pair].slice(0, 2)));
    const sizes = [...named].map((object) => this.bodies.bounds((each) => each === this.cell.objects[object]))
      .filter((box) => !box.isEmpty()).map((box) => box.getBoundingSphere(new THREE.Sphere()).radius);
    const towards = this.camera.position.clone().sub(this.controls.target).normalize();
    const gap = gaps[0][1].clone().sub(gaps[0][0]).normalize(), along = towards.dot(gap);
    if (Math.abs(along) > ALONG) towards.addScaledVector(gap, -along);
    if (towards.length() < 1e-3) towards.set(gap.y, -gap.x, 0.3);
    this.follows = undefined;
    this.lookFrom(towards, center, Math.max(radius / GAP_SHARE, sizes.length ? OBJECT_SHARE * Math.min(...sizes) : 0, LEAST_LOOK));
  }
  // Until a person moves the view, moving bodies stay in it.
  keepInView(nowMs) {
    if (!this.follows || !this.fitted || nowMs < this.keepAgainMs) return;
    const began = performance.now(), moving = this.movingBounds();
    this.keepAgainMs = nowMs + (performance.now() - began) / KEEPING_SHARE;
    if (moving.isEmpty()) return;
    this.reached.union(moving);
    const { min, max } = moving, corner = new THREE.Vector3();
    for (let i = 0; i < 8; ++i) {
      corner.set(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z).project(this.camera);
      if (Math.abs(corner.x) < INSIDE && Math.abs(corner.y) < INSIDE && Math.abs(corner.z) < 1) continue;
      const grown = this.reached.getSize(new THREE.Vector3()).multiplyScalar(0.5 * (GROWTH - 1));
      this.reached.expandByVector(grown);
      return this.fit(this.follows.side, this.follows.moving);
    }
  }
  movingBounds() {
    return this.bodies.bounds(({ fixed }) => !fixed);
  }
  // Grids are as large as the cell.
  surround() {
    const sphere = this.sphere(false);
    if (!sphere) return;
    for (const { material } of this.bodies.grids) {
      material.uniforms.centre.value.copy(sphere.center);
      material.uniforms.reach.value = sphere.radius;
    }
    ++this.bodies.stillChanges;
    this.fitted = true;
  }
  // True when the camera has its place, or when there is nothing to show yet.
  get isReady() {
    return (this.fitted || !this.sphere(false)) && !this.visuals.isLoading;
  }

  sphere(moving) {
    const bounds = moving ? this.movingBounds() : this.bodies.boundsWithoutFloors();
    bounds.union(this.reached);
    return bounds.isEmpty() ? undefined : bounds.getBoundingSphere(new THREE.Sphere());
  }

  // "x,y,z,tx,ty,tz", m, for addresses.
  get place() {
    return [...this.camera.position, ...this.controls.target].map((each) => each.toFixed(3)).join(",");
  }
  set place(text) {
    const numbers = text.split(",").map(Number);
    if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return;
    this.camera.position.set(...numbers.slice(0, 3));
    this.controls.target.set(...numbers.slice(3));
    this.follows = undefined;
  }

  // The points of a sensor. The first ones widen the view to what is seen around moving bodies.
  takeSeen(message, ns) {
    const isFirst = this.seen.sensors.every((sensor) => !sensor.ns);
    this.seen.take(message, ns);
    const moving = this.movingBounds();
    if (!isFirst || !this.follows || moving.isEmpty()) return;
    this.reached.union(this.seen.boundsNear(moving.getCenter(new THREE.Vector3())));
    this.fit(this.follows.side, this.follows.moving);
  }

  moved(transforms) {
    this.stopGhosts.move(transforms);
    if (!this.bodies.move(transforms) && this.fitted) return;
    if (this.follows) this.fit(this.follows.side, this.follows.moving);
    else this.surround();
  }

  // Draws only after a change: a recording that stands still costs nothing.
  draw(state, chosen, frozen, nowMs) {
    this.keepInView(nowMs);
    this.seen.ask(nowMs);
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.noteCamera();
    this.fadeHiding([state.reportNs, this.cameraChanges].join(), nowMs);
    const key = [state.reportNs, frozen, ...chosen, this.shells.visible, this.changes, this.bodies.stillChanges, this.cameraChanges, this.seen.changes].join();
    if (key === this.drawnKey) return (this.drawnMs = undefined);
    this.drawnKey = key;
    this.drawn = (this.drawn ?? 0) + 1;
    if (this.isResized) this.resize();
    this.bodies.lit(this.camera, this.controls.target);
    this.bodies.setLate(frozen || !state.lateObjects ? new Map() : state.lateObjects);
    this.visuals.update();
    this.shells.update(this.bodies, state.zoneStates());
    this.seen.update(state.timeNs);
    this.stopGhosts.update(state.separation?.stops);
    if (state.report) this.lines.update(state, chosen, this.camera, this.size, this.bodies);
    const still = [this.bodies.stillChanges, this.changes, this.cameraChanges].join();
    this.backdrop.update(this.renderer, this.camera, still, () => css("--scene"));
    this.renderer.render(this.world, this.camera);
    this.adapt(nowMs);
  }

  fadeHiding(key, nowMs) {
    if (!this.fitted || key === this.fadedKey || nowMs - this.fadedMs < FADE_AGAIN_MS) return;
    this.fadedKey = key;
    this.fadedMs = nowMs;
    this.bodies.fade(this.camera.position);
  }

  // Controls at rest still move the camera within rounding.
  noteCamera() {
    const { elements } = this.camera.matrixWorld;
    if (this.seenFrom?.every((value, i) => Math.abs(value - elements[i]) < ROUNDING)) return;
    this.seenFrom = [...elements];
    this.cameraChanges = (this.cameraChanges ?? 0) + 1;
  }

  // The canvas can be read until the script returns.
  redraw() {
    this.renderer.render(this.world, this.camera);
  }

  // Draws once more and waits for the end.
  finish() {
    this.drawnKey = undefined;
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  // Reduces the pixels on a slow machine, judged by the time between frames, since nothing waits for the drawing
  // itself.
  adapt(nowMs) {
    if (this.drawnMs !== undefined) {
      const took = nowMs - this.drawnMs;
      this.took = 0.9 * (this.took ?? took) + 0.1 * took;
      this.sinceAdapted = (this.sinceAdapted ?? 0) + 1;
    }
    this.drawnMs = nowMs;
    if (!(this.sinceAdapted > 20) || this.took < SLOW_FRAME || this.sharpness <= LEAST_SHARPNESS) return;
    this.sharpness = Math.max(LEAST_SHARPNESS, 0.7 * this.sharpness);
    this.sinceAdapted = 0;
    this.resizeSoon();
  }

  clicks(canvas) {
    let down;
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (down = [clientX, clientY]));
    canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (!down || Math.hypot(clientX - down[0], clientY - down[1]) > CLICK_PIXELS) return;
      const box = canvas.getBoundingClientRect();
      const x = clientX - box.left, y = clientY - box.top;
      const pair = this.on.picksBodies() ? undefined : this.lines.pairAt(x, y, this.camera, this.size);
      if (pair !== undefined) return this.on.pairChosen(pair);
      const raycaster = new THREE.Raycaster();
      raycaster.setFromCamera(new THREE.Vector2((x / box.width) * 2 - 1, 1 - (y / box.height) * 2), this.camera);
      this.on.objectChosen(this.bodies.objectAt(raycaster));
    });
    canvas.addEventListener("dblclick", ({ offsetX, offsetY }) => {
      const pair = this.lines.pairAt(offsetX, offsetY, this.camera, this.size);
      if (pair !== undefined) this.on.pairLookedAt(pair);
    });
  }
}
