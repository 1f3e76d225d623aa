// The three-dimensional view: camera, lights, bodies, zones, lines, clicks.
import * as THREE from "three";
import { OrbitControls } from "orbit";
import { Backdrop } from "./backdrop.js";
import { Bodies } from "./bodies.js";
import { PairLines } from "./pair_lines.js";
import { ZoneShells } from "./zone_shells.js";
import { css } from "./format.js";

const DIRECTIONS = { cell: [1.0, -1.25, 0.75], top: [0, -0.001, 1], front: [0, -1, 0.02], side: [1, 0, 0.02] };
const CLICK_PIXELS = 5;
const LARGE = 500; // parts: in larger cells only the still picture has smooth outlines, which costs no frame time
const ROUNDING = 1e-7; // m
// When frames take longer than this, ms, they are drawn with fewer pixels, down to this share.
const SLOW_FRAME = 34, LEAST_SHARPNESS = 0.4;

export class SceneView {
  // Callbacks: pairChosen(pair), objectChosen(object or undefined).
  constructor(scene, on) {
    this.on = on;
    this.element = document.getElementById("scene");
    const canvas = document.getElementById("view");
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: scene.parts.length < LARGE });
    this.sharpness = Math.min(window.devicePixelRatio, 2);
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(38, 1, 0.01, 400);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.15;
    this.bodies = new Bodies(scene);
    this.shells = new ZoneShells(scene);
    this.lines = new PairLines(document.getElementById("labels"), on.pairChosen);
    this.backdrop = new Backdrop(this.bodies.still, this.bodies.veil);
    this.world.add(this.backdrop, this.bodies, this.shells, this.lines);
    this.clicks(canvas);
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.resize();
    this.retheme();
  }

  resize() {
    this.changes = (this.changes ?? 0) + 1;
    this.size = { width: this.element.clientWidth, height: this.element.clientHeight };
    this.renderer.setPixelRatio(this.sharpness);
    this.renderer.setSize(this.size.width, this.size.height, false);
    this.camera.aspect = this.size.width / Math.max(1, this.size.height);
    this.camera.updateProjectionMatrix();
  }

  retheme() {
    ++this.changes;
    this.bodies.recolour();
    this.shells.recolour();
  }

  // Looks from this side at the whole cell, or first at its moving parts.
  fit(side = "cell", moving = false) {
    const sphere = this.sphere(moving) ?? this.sphere(false);
    if (!sphere) return;
    const narrow = Math.min(1, this.camera.aspect);
    const away = (1.12 * sphere.radius) / Math.sin((this.camera.fov * Math.PI) / 360) / narrow;
    this.controls.target.copy(sphere.center);
    this.camera.position.copy(sphere.center).addScaledVector(new THREE.Vector3(...DIRECTIONS[side]).normalize(), away);
    this.surround();
  }
  // Grids are as large as the cell.
  surround() {
    const sphere = this.sphere(false);
    if (!sphere) return;
    for (const { material } of this.bodies.grids) {
      material.uniforms.centre.value.copy(sphere.center);
      material.uniforms.reach.value = sphere.radius;
    }
    this.bodies.refocus();
    ++this.bodies.stillChanges;
    this.fitted = true;
  }
  // True when the camera has its place, or when there is nothing to show yet.
  get isReady() {
    return this.fitted || !this.sphere(false);
  }

  sphere(moving) {
    const bounds = this.bodies.bounds(moving ? ({ fixed }) => !fixed : undefined);
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
    this.isPlaced = true;
  }

  moved(transforms) {
    if (!this.bodies.move(transforms) && this.fitted) return;
    if (this.isPlaced) this.surround();
    else this.fit("cell", true);
  }

  // Draws only after a change: a recording that stands still costs nothing.
  draw(state, chosen, frozen, nowMs) {
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.noteCamera();
    const key = [state.reportNs, frozen, ...chosen, this.shells.visible, this.changes, this.cameraChanges].join();
    if (key === this.drawnKey) return (this.drawnMs = undefined);
    this.drawnKey = key;
    this.drawn = (this.drawn ?? 0) + 1;
    if (this.drawn % 30 === 0) this.bodies.refocus();
    this.bodies.lit(this.camera, this.controls.target);
    this.bodies.setLate(frozen || !state.lateObjects ? new Map() : state.lateObjects);
    this.shells.update(this.bodies.poses, state.zoneStates());
    if (state.report) this.lines.update(state, chosen, this.camera, this.size);
    const still = [this.bodies.stillChanges, this.changes, this.cameraChanges].join();
    this.backdrop.update(this.renderer, this.camera, still, () => css("--scene"));
    this.renderer.render(this.world, this.camera);
    this.adapt(nowMs);
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
    this.resize();
  }

  clicks(canvas) {
    let down;
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (down = [clientX, clientY]));
    canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (!down || Math.hypot(clientX - down[0], clientY - down[1]) > CLICK_PIXELS) return;
      const box = canvas.getBoundingClientRect();
      const x = clientX - box.left, y = clientY - box.top;
      const pair = this.lines.pairAt(x, y, this.camera, this.size);
      if (pair !== undefined) return this.on.pairChosen(pair);
      const raycaster = new THREE.Raycaster();
      raycaster.setFromCamera(new THREE.Vector2((x / box.width) * 2 - 1, 1 - (y / box.height) * 2), this.camera);
      this.on.objectChosen(this.bodies.objectAt(raycaster));
    });
  }
}
