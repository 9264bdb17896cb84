// The 3D view. World frame: the body frame (metres, Y up). Draws only when something changed.
import {
  AmbientLight,
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  GridHelper,
  Group,
  HemisphereLight,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Raycaster,
  Scene,
  SphereGeometry,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { acceleratedRaycast, computeBoundsTree, disposeBoundsTree } from "three-mesh-bvh";
import type { Keypoint, Matrix, Mesh as MeshData, ScanData, Vec3 } from "../core/types";
import { confidenceColour, viridis } from "../result/colours";
import { columnMajor } from "../result/transform";
import type { ViewOptions } from "../ui/state";
import { bodyAxes, disposeAxes } from "./axes";

BufferGeometry.prototype.computeBoundsTree = computeBoundsTree;
BufferGeometry.prototype.disposeBoundsTree = disposeBoundsTree;
Mesh.prototype.raycast = acceleratedRaycast;

const SCAN_COLOUR = 0xb9bcc2;
const BODY_COLOUR = 0xe0a458;
const SKELETON_COLOUR = 0xb3261e;
const COMPILE_MS = 150;
const KEYPOINT_RADIUS_M = 0.014;
/** Parent of each of the 24 joints, in SMPL's order; the root has none. */
const PARENTS = [-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21];

export type Direction = "front" | "back" | "left" | "right" | "top";

export class Viewer {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(35, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly scanRoot = new Group();
  private readonly scanOrigin = new Vector3();
  private readonly bodyRoot = new Group();
  private readonly keypointRoot = new Group();
  private readonly skeletonRoot = new Group();
  private readonly axesRoot = new Group();
  private readonly grid = new GridHelper(4, 16);
  private readonly observer: ResizeObserver;
  private options: ViewOptions | null = null;
  private legendMaximumMm = 10;
  private errorsMm: Float32Array | null = null;
  private frame = 0;
  /** Whether materials may have come that the graphics driver has not seen. */
  private uncompiled = true;

  /** @throws Error when the browser has no WebGL. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setScissorTest(true);
    // Asking the driver whether it is content would wait for it.
    this.renderer.debug.checkShaderErrors = false;
    this.scanRoot.matrixAutoUpdate = false;
    const key = new DirectionalLight(0xffffff, 1.4);
    key.position.set(0.6, 1, 1);
    this.camera.add(key);
    this.scene.add(
      this.camera,
      new AmbientLight(0xffffff, 0.7),
      new HemisphereLight(0xffffff, 0x777788, 1.1),
      this.scanRoot,
      this.bodyRoot,
      this.keypointRoot,
      this.skeletonRoot,
      this.axesRoot,
      this.grid,
    );
    this.grid.visible = false;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.request());
    this.observer = new ResizeObserver(() => this.request());
    this.observer.observe(canvas);
    this.look("front");
  }

  setDark(dark: boolean): void {
    for (const material of [this.grid.material].flat()) {
      material.transparent = true;
      material.opacity = dark ? 0.25 : 0.35;
    }
    this.request();
  }

  /** @param scan null removes it */
  setScan(scan: ScanData | null): void {
    this.uncompiled = true;
    clear(this.scanRoot);
    const mesh = scan?.mesh;
    this.scanOrigin.set(...(scan?.origin ?? ([0, 0, 0] as const)));
    if (mesh && mesh.positions.length > 0) {
      const geometry = geometryOf(mesh);
      if (mesh.indices.length > 0) {
        this.scanRoot.add(
          new Mesh(
            geometry,
            new MeshLambertMaterial({ color: SCAN_COLOUR, side: DoubleSide, transparent: true }),
          ),
        );
      } else {
        const material = new PointsMaterial({ color: SCAN_COLOUR, size: 1.5, sizeAttenuation: false });
        this.scanRoot.add(new Points(geometry, material));
      }
      this.setBodyFromScan(null);
      this.fit();
    }
    this.apply();
  }

  /** @param matrix null: not known yet; the scan is then shown on its own axes, scaled to a person's size */
  setBodyFromScan(matrix: Matrix | null): void {
    if (matrix) {
      this.scanRoot.matrix.fromArray(columnMajor(matrix));
      this.scanRoot.matrix.multiply(new Matrix4().makeTranslation(this.scanOrigin));
    } else {
      this.scanRoot.matrix.identity();
      this.scanRoot.updateMatrixWorld(true);
      const box = new Box3().setFromObject(this.scanRoot);
      if (!box.isEmpty()) {
        const size = box.getSize(new Vector3());
        const scale = 1.75 / Math.max(size.x, size.y, size.z, 1e-9);
        const centre = box.getCenter(new Vector3()).multiplyScalar(-scale);
        this.scanRoot.matrix.makeScale(scale, scale, scale).setPosition(centre);
        // Most scans lie with their longest extent upright: show those whose longest is Z standing.
        if (size.z > size.y) this.scanRoot.matrix.premultiply(new Matrix4().makeRotationX(-Math.PI / 2));
      }
    }
    this.scanRoot.matrixWorldNeedsUpdate = true;
    this.scanRoot.updateMatrixWorld(true);
    this.grid.visible = matrix !== null && this.scanRoot.children.length > 0;
    if (this.grid.visible) this.grid.position.y = new Box3().setFromObject(this.scanRoot).min.y;
    this.request();
  }

  /** @param mesh body frame; @param errorsMm a vertex, or null when there are none to show */
  setBody(mesh: MeshData | null, errorsMm: Float32Array | null): void {
    clear(this.bodyRoot);
    this.errorsMm = errorsMm;
    if (mesh && mesh.positions.length > 0) {
      const material = new MeshLambertMaterial({ color: BODY_COLOUR, side: DoubleSide, transparent: true });
      const geometry = geometryOf({ ...mesh, indices: mesh.indices.slice() });
      // Only the body is picked. The tree reorders the triangles, hence the copy; a large scan's would hold up the page.
      geometry.computeBoundsTree();
      this.bodyRoot.add(new Mesh(geometry, material));
    }
    this.paint();
    this.apply();
  }

  setKeypoints(keypoints: readonly Keypoint[]): void {
    this.uncompiled = true;
    clear(this.keypointRoot);
    const seen = keypoints.filter((keypoint) => keypoint.position_m !== null);
    if (seen.length > 0) {
      const geometry = new SphereGeometry(KEYPOINT_RADIUS_M, 16, 12);
      const dots = new InstancedMesh(geometry, new MeshBasicMaterial({ depthTest: false }), seen.length);
      dots.renderOrder = 1;
      seen.forEach((keypoint, i) => {
        dots.setMatrixAt(i, new Matrix4().makeTranslation(new Vector3(...keypoint.position_m!)));
        dots.setColorAt(i, new Color(confidenceColour(keypoint.confidence).replaceAll(" ", ",")));
      });
      this.keypointRoot.add(dots);
    }
    this.request();
  }

  /** @param joints of the 24, body frame; none removes the skeleton */
  setSkeleton(joints: readonly Vec3[]): void {
    this.uncompiled = true;
    clear(this.skeletonRoot);
    if (joints.length >= PARENTS.length) {
      const ends = PARENTS.flatMap((parent, joint) =>
        parent < 0 ? [] : [...joints[parent]!, ...joints[joint]!],
      );
      const bones = new BufferGeometry().setAttribute(
        "position",
        new BufferAttribute(new Float32Array(ends), 3),
      );
      const dots = new BufferGeometry().setAttribute(
        "position",
        new BufferAttribute(new Float32Array(joints.flat()), 3),
      );
      const look = { color: SKELETON_COLOUR, depthTest: false, transparent: true };
      this.skeletonRoot.add(
        new LineSegments(bones, new LineBasicMaterial(look)),
        new Points(dots, new PointsMaterial({ ...look, size: 7, sizeAttenuation: false })),
      );
      for (const part of this.skeletonRoot.children) part.renderOrder = 2;
    }
    this.request();
  }

  /** Shows the body's directions beside the aligned scan. */
  setAxes(shown: boolean): void {
    this.uncompiled = true;
    disposeAxes(this.axesRoot);
    if (shown) {
      this.axesRoot.add(bodyAxes(new Box3().setFromObject(this.scanRoot)));
      this.fit();
    }
    this.request();
  }

  setOptions(options: ViewOptions, legendMaximumMm: number): void {
    const repaint = options.heatMap !== this.options?.heatMap || legendMaximumMm !== this.legendMaximumMm;
    this.options = options;
    this.legendMaximumMm = legendMaximumMm;
    if (repaint) this.paint();
    this.apply();
  }

  /** Turns the camera to a side of the body, everything in sight. */
  look(direction: Direction): void {
    const from = {
      front: [0, 0, 1],
      back: [0, 0, -1],
      left: [1, 0, 0],
      right: [-1, 0, 0],
      top: [0, 1, 0.001],
    }[direction] as [number, number, number];
    this.camera.position.copy(this.controls.target).add(new Vector3(...from));
    this.fit();
  }

  /** Moves the camera, keeping its direction, until everything is in sight. */
  fit(): void {
    const box = new Box3();
    for (const root of [this.scanRoot, this.bodyRoot, this.axesRoot]) {
      if (root.visible && root.children.length > 0) box.union(new Box3().setFromObject(root));
    }
    if (box.isEmpty()) box.set(new Vector3(-0.5, -0.9, -0.2), new Vector3(0.5, 0.9, 0.2));
    const centre = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    const aspect = this.aspect();
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const width = Math.hypot(size.x, size.z);
    const distance = Math.max(size.y / 2 / half, width / 2 / half / aspect) * 1.12 + width / 2;
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(direction, distance);
    this.controls.update();
    this.request();
  }

  /** Turns the camera round the body by angles in radians. */
  orbit(azimuth: number, elevation: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new Vector3(0, 1, 0), azimuth);
    const side = new Vector3().crossVectors(new Vector3(0, 1, 0), offset).normalize();
    const turned = offset.clone().applyAxisAngle(side, -elevation);
    if (Math.abs(turned.clone().normalize().y) < 0.99) offset.copy(turned);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.request();
  }

  /** @param factor above 1: nearer */
  zoom(factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target).divideScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.request();
  }

  /** Vertex of the body nearest to what lies under a point of the canvas (CSS pixels from its upper left corner). */
  pickBody(x: number, y: number): number | null {
    const mesh = this.bodyRoot.children[0] as Mesh | undefined;
    const { left, width, height } = this.pane(x);
    if (!mesh || !this.options?.showBody || (this.options.split && left === 0)) return null;
    const pointer = new Vector2(((x - left) / width) * 2 - 1, 1 - (y / height) * 2);
    const caster = new Raycaster();
    caster.firstHitOnly = true;
    caster.setFromCamera(pointer, this.camera);
    const hit = caster.intersectObject(mesh)[0];
    if (!hit?.face) return null;
    const position = mesh.geometry.getAttribute("position");
    const distance = (i: number) =>
      hit.point.distanceToSquared(new Vector3().fromBufferAttribute(position, i));
    return [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => distance(a) - distance(b))[0]!;
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.observer.disconnect();
    this.controls.dispose();
    for (const root of [this.scanRoot, this.bodyRoot, this.keypointRoot, this.skeletonRoot]) clear(root);
    disposeAxes(this.axesRoot);
    this.renderer.dispose();
  }

  private aspect(): number {
    const { clientWidth, clientHeight } = this.canvas;
    const panes = this.options?.split ? 2 : 1;
    return Math.max(clientWidth, 1) / panes / Math.max(clientHeight, 1);
  }

  private pane(x: number): { left: number; width: number; height: number } {
    const { clientWidth, clientHeight } = this.canvas;
    if (!this.options?.split) return { left: 0, width: clientWidth, height: clientHeight };
    const width = clientWidth / 2;
    return { left: x < width ? 0 : width, width, height: clientHeight };
  }

  /** Body colours: the error scale, or plain. */
  private paint(): void {
    this.uncompiled = true;
    const mesh = this.bodyRoot.children[0] as Mesh<BufferGeometry, MeshLambertMaterial> | undefined;
    if (!mesh) return;
    const coloured = this.options?.heatMap === true && this.errorsMm !== null && this.errorsMm.length > 0;
    if (coloured) {
      const colours = new Float32Array(this.errorsMm!.length * 3);
      const colour = new Color();
      this.errorsMm!.forEach((error, i) => {
        colour.setRGB(...viridis(error / this.legendMaximumMm), SRGBColorSpace).toArray(colours, 3 * i);
      });
      mesh.geometry.setAttribute("color", new BufferAttribute(colours, 3));
    } else {
      mesh.geometry.deleteAttribute("color");
    }
    mesh.material.vertexColors = coloured;
    mesh.material.color.set(coloured ? 0xffffff : BODY_COLOUR);
    mesh.material.needsUpdate = true;
    this.request();
  }

  private apply(): void {
    const options = this.options;
    if (!options) return;
    this.scanRoot.visible = options.showScan;
    this.bodyRoot.visible = options.showBody;
    this.keypointRoot.visible = options.showKeypoints;
    for (const [root, opacity] of [
      [this.scanRoot, options.scanOpacity],
      [this.bodyRoot, options.bodyOpacity],
    ] as const) {
      const object = root.children[0] as Mesh<BufferGeometry, MeshLambertMaterial> | undefined;
      if (!object) continue;
      object.material.opacity = opacity;
      object.material.transparent = opacity < 1;
      object.material.depthWrite = opacity === 1;
      object.renderOrder = opacity < 1 ? 1 : 0;
      if (root === this.bodyRoot) object.material.wireframe = options.wireframe;
    }
    this.request();
  }

  private request(): void {
    if (this.frame === 0) {
      this.frame = requestAnimationFrame(() => {
        this.frame = 0;
        this.draw();
      });
    }
  }

  /** Lets the driver compile what is new without anyone waiting, then draws. */
  private compile(): void {
    this.uncompiled = false;
    const draw = () => this.request();
    if (this.renderer.extensions.has("KHR_parallel_shader_compile")) {
      this.renderer.compileAsync(this.scene, this.camera).then(draw, draw);
    } else {
      // Such a driver does not tell when it is ready.
      this.renderer.compile(this.scene, this.camera);
      setTimeout(draw, COMPILE_MS);
    }
  }

  private draw(): void {
    if (this.uncompiled) {
      this.compile();
      return;
    }
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = this.aspect();
    this.camera.updateProjectionMatrix();
    if (!this.options?.split) {
      this.drawPane(0, width, height);
      return;
    }
    const { scanRoot, bodyRoot } = this;
    const shown = [scanRoot.visible, bodyRoot.visible] as const;
    [scanRoot.visible, bodyRoot.visible] = [true, false];
    this.drawPane(0, width / 2, height);
    [scanRoot.visible, bodyRoot.visible] = [false, true];
    this.drawPane(width / 2, width / 2, height);
    [scanRoot.visible, bodyRoot.visible] = shown;
  }

  private drawPane(left: number, width: number, height: number): void {
    this.renderer.setViewport(left, 0, width, height);
    this.renderer.setScissor(left, 0, width, height);
    this.renderer.render(this.scene, this.camera);
  }
}

function geometryOf({ positions, normals, indices }: MeshData): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  if (indices.length > 0) {
    geometry.setIndex(new BufferAttribute(indices, 1));
    if (normals) geometry.setAttribute("normal", new BufferAttribute(normals, 3));
    else geometry.computeVertexNormals();
  }
  return geometry;
}

function clear(root: Group): void {
  for (const child of [...root.children]) {
    const { geometry, material } = child as Mesh;
    geometry.disposeBoundsTree?.();
    geometry.dispose();
    for (const each of [material].flat()) each.dispose();
    root.remove(child);
  }
}
