/** 3D body on its ground, rendered by three.js with poses of the server. */

import { svg } from "/app/dom.js";
import { colour } from "/charts/style.js";
import { labelTexture, markTexture } from "/space/textures.js";

const VIEW = 35; // field of view of the camera [degrees]
const FIRST = { turned: -1.1, raised: 0.3 };
const [LOWEST, HIGHEST] = [0.03, 1.5];
const FINEST = 2; // largest number of canvas pixels per pixel of the page

/** Picture of one body, rendered on request. */
export class Stage {
  /** @param {any} three @param {HTMLCanvasElement} canvas @param {SpaceModel} model */
  constructor(three, canvas, model) {
    this.three = three;
    this.canvas = canvas;
    this.model = model;
    const context = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!context) throw new Error("this browser cannot draw in 3D (WebGL 2 is off)");
    this.renderer = new three.WebGLRenderer({ canvas, context });
    this.scene = new three.Scene();
    this.camera = new three.PerspectiveCamera(VIEW, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    /** @type {[any, string][]} */
    this.paints = []; // [material, variable of the page]
    this.body = new three.Group();
    this.scene.add(this.body);
    this.touching = /** @type {any[]} */ ([]);
    this.build();
    this.turned = 0;
    this.raised = 0;
    this.near = 1;
    this.fine = 0; // pixels of the canvas per pixel of the page; 0: those of the screen
    this.look(FIRST);
    this.repaint();
  }

  /** Add the constant objects to the scene. */
  build() {
    const { three, model, scene, body } = this;
    const skin = new three.BufferGeometry();
    skin.setAttribute("position", new three.BufferAttribute(model.points, 3));
    skin.setIndex(new three.BufferAttribute(model.faces, 1));
    if (model.colours) skin.setAttribute("color", new three.BufferAttribute(model.colours, 4, true));
    skin.computeBoundingSphere();
    this.size = skin.boundingSphere.center.length() + skin.boundingSphere.radius;
    this.skin = this.painted(new three.MeshLambertMaterial({ flatShading: true, side: three.DoubleSide }), "--space-body");
    body.add(new three.Mesh(skin, this.skin));
    if (model.mended) this.patch(model.mended);
    this.frame();
    this.lay();
    const sun = new three.DirectionalLight(0xffffff, 2.2);
    sun.position.set(0.5, -0.8, 1.2);
    this.camera.add(sun, sun.target);
    scene.add(this.camera, new three.HemisphereLight(0xffffff, 0x888888, 1.6));
    this.base = this.line(loop(model.base), "--space-base", body);
    this.support = this.line([], "--space-base");
    this.plumb = this.line([[0, 0, 0], [0, 0, 0]], "--space-plumb", scene, true);
    this.dots([[0, 0, 0]], "dot", "--space-plumb");
    this.touching = ["--space-holds", "--space-slides"].map((paint) => this.contacts(paint));
    this.place(null, [0, 0, model.height]);
  }

  /** Faces that close holes, in another colour and with their edges. @param {Float32Array} corners */
  patch(corners) {
    const { three, body } = this;
    const faces = new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(corners, 3));
    const nearer = { side: three.DoubleSide, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 };
    body.add(new three.Mesh(faces, this.painted(new three.MeshBasicMaterial(nearer), "--space-mended")));
    body.add(new three.LineSegments(new three.WireframeGeometry(faces), this.painted(new three.LineBasicMaterial(), "--surface")));
  }

  /** View target: mean of all positions of the center, and the visible distance. */
  frame() {
    const [low, high] = [[0, 0, this.model.height], [0, 0, this.model.height]];
    const centres = this.model.motion?.centre ?? [];
    for (let k = 0; k < centres.length; k += 1) {
      low[k % 3] = Math.min(low[k % 3], centres[k]);
      high[k % 3] = Math.max(high[k % 3], centres[k]);
    }
    this.middle = new this.three.Vector3(...low.map((value, k) => 0.5 * (value + high[k])));
    this.reach = this.size + 0.5 * Math.hypot(...low.map((value, k) => high[k] - value));
  }

  /** The ground: a plane, and lines at a round distance. */
  lay() {
    const { three, scene, reach } = this;
    const far = 6 * reach;
    const gap = 10 ** Math.round(Math.log10(reach / 2));
    const ends = [];
    const count = Math.min(200, Math.ceil(far / gap));
    for (let k = -count; k <= count; k += 1) {
      const [at, end] = [k * gap, count * gap];
      ends.push([at, -end, 0], [at, end, 0], [-end, at, 0], [end, at, 0]);
    }
    const lines = new three.BufferGeometry().setFromPoints(ends.map((end) => new three.Vector3(...end)));
    scene.add(new three.LineSegments(lines, this.painted(new three.LineBasicMaterial(), "--space-line")));
    const plane = new three.Mesh(
      new three.PlaneGeometry(2 * count * gap, 2 * count * gap),
      this.painted(new three.MeshBasicMaterial({ polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }), "--surface-2"),
    );
    scene.add(plane);
    for (const [name, x, y] of /** @type {[string, number, number][]} */ ([["x", 1, 0], ["y", 0, 1]])) {
      this.line([[0, 0, 0], [1.15 * this.size * x, 1.15 * this.size * y, 0]], "--space-axis");
      this.label(name, [1.2 * this.size * x, 1.2 * this.size * y, 0.01 * this.size], scene, 0.035);
    }
    this.clear = new three.Color();
  }

  /** @param {any} material @param {string} paint */
  painted(material, paint) {
    this.paints.push([material, paint]);
    return material;
  }

  /** @param {number[][]} points @param {string} paint @param {any} [into] @param {boolean} [seenThrough] */
  line(points, paint, into = this.scene, seenThrough = false) {
    const { three } = this;
    const geometry = new three.BufferGeometry().setFromPoints(points.map((point) => new three.Vector3(...point)));
    const line = new three.Line(geometry, this.painted(new three.LineBasicMaterial({ depthTest: !seenThrough }), paint));
    line.frustumCulled = false;
    if (seenThrough) line.renderOrder = 1;
    into.add(line);
    return line;
  }

  /** Marks on the body that keep their size on the screen.
   * @param {number[][]} positions @param {string} shape @param {string} paint */
  dots(positions, shape, paint) {
    const { three } = this;
    const seenThrough = shape === "dot";
    const geometry = new three.BufferGeometry().setFromPoints(positions.map((position) => new three.Vector3(...position)));
    const material = new three.PointsMaterial({
      map: markTexture(three, shape), size: 15, sizeAttenuation: false, transparent: true, alphaTest: 0.4,
      depthTest: !seenThrough,
    });
    const points = new three.Points(geometry, this.painted(material, paint));
    points.renderOrder = 2;
    this.body.add(points);
    return points;
  }

  /** Visible vertices of the hull, initially none. @param {string} paint */
  contacts(paint) {
    if (!this.model.hull) return null;
    const { three } = this;
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(this.model.hull, 3));
    geometry.setIndex(new three.BufferAttribute(new Uint32Array(this.model.hull.length / 3), 1));
    geometry.setDrawRange(0, 0);
    const material = new three.PointsMaterial({
      map: markTexture(three, "dot"), size: 13, sizeAttenuation: false, transparent: true, alphaTest: 0.4,
      depthTest: false,
    });
    const points = new three.Points(geometry, this.painted(material, paint));
    [points.renderOrder, points.frustumCulled] = [3, false];
    this.body.add(points);
    return points;
  }

  /** Image of the view for a file, at the resolution of a screen. */
  photograph() {
    this.fine = FINEST;
    this.repaint();
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const picture = svg("image", { width, height, href: this.canvas.toDataURL() });
    this.fine = 0;
    this.repaint();
    return svg("svg", { viewBox: `0 0 ${width} ${height}` }, picture);
  }

  /** Show the sticking and the sliding vertices of the hull. @param {number[]} holding @param {number[]} sliding */
  touch(holding, sliding) {
    [holding, sliding].forEach((vertices, k) => {
      const { geometry } = this.touching[k];
      for (let i = 0; i < vertices.length; i += 1) geometry.index.array[i] = vertices[i];
      geometry.index.needsUpdate = true;
      geometry.setDrawRange(0, vertices.length);
    });
  }

  /** Place the body: attitude (x, y, z, s), null for that of the file, and center [m].
   * @param {ArrayLike<number> | null} turn @param {number[]} centre */
  place(turn, centre) {
    if (turn) this.body.quaternion.fromArray(turn);
    this.body.position.fromArray(centre);
    this.hang();
  }

  /** Draw the plumb line from the centre of mass. */
  hang() {
    const { x, y, z } = this.body.position;
    const ends = this.plumb.geometry.attributes.position;
    ends.setXYZ(0, x, y, z);
    ends.setXYZ(1, x, y, 0);
    ends.needsUpdate = true;
  }

  /** Draw a support polygon on the ground, in place of the base that the body has in its file.
   * @param {number[][]} corners */
  standOn(corners) {
    const { three } = this;
    this.base.visible = false;
    const points = loop(corners.map(([x, y]) => [x, y, 0.001 * this.size]));
    this.support.geometry.dispose();
    this.support.geometry = new three.BufferGeometry().setFromPoints(points.map((point) => new three.Vector3(...point)));
  }

  /** Text on a plate, of constant size on the screen.
   * @param {string} text @param {number[]} position @param {any} into @param {number} size */
  label(text, position, into, size) {
    const { three } = this;
    const label = new three.Sprite(new three.SpriteMaterial({
      map: labelTexture(three, text), sizeAttenuation: false, depthTest: into === this.scene,
    }));
    label.position.fromArray(position);
    label.scale.setScalar(size);
    if (into === this.scene) label.center.set(0.5, 0); // on the ground
    label.renderOrder = 4;
    into.add(label);
  }

  /** Number edges on the body. @param {SpaceEdge[]} edges */
  number(edges) {
    for (const { name, from, to } of edges) {
      this.line([from, to], "--space-holds", this.body, true);
      this.label(name.replace(" deg", "\u00b0"), from.map((value, k) => 0.5 * (value + to[k])), this.body, edges.length > 8 ? 0.03 : 0.045);
    }
    this.dots(edges.map(({ from }) => from), "dot", "--space-base");
  }

  /** Colour the body by its energy landscape, or not. @param {boolean} on */
  colourful(on) {
    this.skin.vertexColors = on && Boolean(this.model.colours);
    this.skin.needsUpdate = true;
    this.repaint();
  }

  /** Look from a direction: from x towards y, and above the ground [rad]; near: distance / first distance. */
  look({ turned = this.turned, raised = this.raised, near = this.near }) {
    this.turned = turned;
    this.raised = Math.min(HIGHEST, Math.max(LOWEST, raised));
    this.near = Math.min(4, Math.max(0.15, near));
  }

  /** Update the size of the canvas, and draw. */
  resize() {
    const { clientWidth: wide, clientHeight: high } = this.canvas;
    if (!wide || !high) return;
    const fine = this.fine || Math.min(window.devicePixelRatio || 1, FINEST);
    this.renderer.setPixelRatio(fine);
    this.renderer.setSize(wide, high, false);
    this.camera.aspect = wide / high;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Update the colours from the page, and draw. */
  repaint() {
    for (const [material, paint] of this.paints) {
      material.color.set(material === this.skin && material.vertexColors ? "#ffffff" : colour(paint));
    }
    this.renderer.setClearColor(this.clear.set(colour("--surface")));
    this.resize();
  }

  draw() {
    const { camera, middle, reach, near, turned, raised } = this;
    const narrow = Math.min(1, camera.aspect);
    const far = (1.05 * near * reach) / (Math.sin((VIEW * Math.PI) / 360) * narrow);
    const level = Math.cos(raised);
    camera.position.set(
      middle.x + far * level * Math.cos(turned), middle.y + far * level * Math.sin(turned), middle.z + far * Math.sin(raised),
    );
    camera.near = 0.01 * far;
    camera.far = far + 12 * reach;
    camera.lookAt(middle);
    camera.updateProjectionMatrix();
    this.renderer.render(this.scene, camera);
  }

  /** Release the memory of the graphics card. */
  dispose() {
    this.scene.traverse((/** @type {any} */ node) => {
      node.geometry?.dispose();
      node.material?.map?.dispose();
      node.material?.dispose();
    });
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}

/** @param {number[][]} points */
const loop = (points) => (points.length ? [...points, points[0]] : []);
