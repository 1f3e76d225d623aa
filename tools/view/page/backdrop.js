// Draws everything that stands still once for a place of the camera, and then only copies it. Most of a thousand
// objects stand still, so a frame costs only its moving parts.
import * as THREE from "three";

const SAMPLES = 4; // per pixel

// A picture of `content`, with depths, and the sheet that lays it over the whole view.
class Layer {
  constructor(content, isVeil) {
    this.world = new THREE.Scene().add(content);
    this.target = new THREE.WebGLRenderTarget(1, 1, { samples: SAMPLES, depthTexture: new THREE.DepthTexture(1, 1, THREE.FloatType) });
    const material = new THREE.ShaderMaterial({
      uniforms: { picture: { value: this.target.texture }, depths: { value: this.target.depthTexture } },
      depthFunc: THREE.AlwaysDepth, depthWrite: !isVeil, transparent: isVeil, premultipliedAlpha: true,
      vertexShader: "void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }",
      fragmentShader: `uniform sampler2D picture; uniform highp sampler2D depths;
        void main() {
          ivec2 at = ivec2(gl_FragCoord.xy);
          gl_FragColor = texelFetch(picture, at, 0);
          gl_FragDepth = texelFetch(depths, at, 0).r;
        }`,
    });
    this.sheet = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
    this.sheet.frustumCulled = false;
    this.sheet.renderOrder = isVeil ? 4 : -100; // a veil lies over moving parts
  }

  // Colours are final: the target converts nothing.
  draw(renderer, camera, colour, opacity) {
    const { x, y } = renderer.getDrawingBufferSize(new THREE.Vector2());
    this.target.setSize(x, y);
    renderer.setClearColor(new THREE.Color().setStyle(colour, THREE.LinearSRGBColorSpace), opacity);
    renderer.setRenderTarget(this.target);
    renderer.render(this.world, camera);
    renderer.setRenderTarget(null);
  }
}

export class Backdrop extends THREE.Group {
  // `still` stands before or behind moving parts; `veil` is transparent in front of them.
  constructor(still, veil) {
    super();
    this.still = new Layer(still, false);
    this.veil = new Layer(veil, true);
    this.add(this.still.sheet, this.veil.sheet);
    this.veiling = veil;
  }

  // Draws again when `key`, which holds all that the picture depends on, has changed. `background()`: CSS.
  update(renderer, camera, key, background) {
    if (key === this.key) return;
    this.key = key;
    this.still.draw(renderer, camera, background(), 1);
    this.veil.sheet.visible = this.veiling.visible;
    if (this.veiling.visible) this.veil.draw(renderer, camera, "#000000", 0);
  }
}
