// Robots that state how they stop, as ghosts where they come to stand if they are told to stop at the report that is
// shown. A ghost has one colour, which says whether the robot stops clear from its present speed. What hardly goes on has
// none.
import * as THREE from "three";
import { matrixOf } from "./bodies.js";
import { css } from "./format.js";

const STANDSTILL = "standstill/"; // kStandstillFrames of monitor/visual/cell_markers.hpp
const OPACITY = 0.3;
const HARDLY = 0.01; // m and rad
const BEHIND = 8; // surfaces that stay where they are, as those of a link that turns about its own axis, lie behind the robot

export class StopGhosts extends THREE.Group {
  constructor(scene, bodies) {
    super();
    this.bodies = bodies;
    this.poses = new Map(); // by object
    this.materials = scene.robots.map(() => new THREE.MeshBasicMaterial({
      transparent: true, opacity: OPACITY, depthWrite: false, polygonOffset: true, polygonOffsetFactor: BEHIND, polygonOffsetUnits: BEHIND,
    }));
    scene.robots.forEach(({ stopping }, robot) => {
      for (const object of stopping) for (const part of bodies.ofObject[object]) this.addGhost(object, part, this.materials[robot]);
    });
  }

  addGhost(object, part, material) {
    const { parts, shapes } = this.bodies, ghost = new THREE.Mesh(shapes[parts[part].mesh], material);
    ghost.matrixAutoUpdate = false;
    ghost.renderOrder = 2;
    ghost.userData = { object, part };
    this.add(ghost);
  }

  // Takes [name of a frame, pose] of all that was sent.
  move(transforms) {
    const { index } = this.bodies, found = transforms.filter(([name]) => name.startsWith(STANDSTILL) && !index.has(name));
    this.poses = new Map(found.map(([name, pose]) => [index.get(name.slice(STANDSTILL.length)), matrixOf(pose)]));
  }

  // `stops` are those of the message about separations.
  update(stops = []) {
    if (!this.visible || !this.children.length) return;
    const { bodies, poses } = this;
    this.materials.forEach((material, robot) => material.color.set(css(colourOf(stops.find((stop) => stop.robot === robot)))));
    for (const ghost of this.children) {
      const { object, part } = ghost.userData, pose = poses.get(object);
      ghost.visible = pose !== undefined && bodies.isShown(object) && goesOn(bodies.poses[object], pose);
      if (!ghost.visible) continue;
      ghost.matrix.multiplyMatrices(pose, bodies.local[part]);
      ghost.matrixWorldNeedsUpdate = true;
    }
  }
}

const colourOf = ({ validity = 0, scaling } = {}) => (validity === 0 ? "--lost" : scaling < 1 ? "--alarm" : "--good");
const goesOn = ({ elements: here }, { elements: there }) => here.some((value, i) => Math.abs(value - there[i]) > HARDLY);
