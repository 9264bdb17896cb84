// The graphics card behind the view. A question to a card that is at work makes the page wait for it, so everything
// that asks (sizes, programs, new geometry) is done piece by piece, each when the card has nothing left to do.
import {
  type BufferGeometry,
  type Camera,
  type Material,
  type Mesh,
  type Object3D,
  type Scene,
  SRGBColorSpace,
  WebGLRenderer,
} from "three";

/** Between two looks at whether the card has finished. */
const POLL_MS = 4;
/** A card that has not finished by then is not waited for any longer. */
const PATIENCE_MS = 5000;
/** Geometries with more vertices go to the card before they are drawn. */
const LARGE = 20_000;

/** What three.js knows of a material's program; its uniforms are asked of the card at the first call. */
interface Compiled {
  currentProgram?: { getUniforms(): unknown; getAttributes(): unknown };
}

/** The canvas's graphics context, with hardly any memory yet. @throws Error when the browser has no WebGL. */
export function createContext(canvas: HTMLCanvasElement): WebGL2RenderingContext {
  [canvas.width, canvas.height] = [1, 1];
  // As three.js asks for it.
  const context = canvas.getContext("webgl2", { alpha: true, antialias: true, stencil: false });
  if (!context) throw new Error("no WebGL 2");
  return context;
}

export class Graphics {
  readonly renderer: WebGLRenderer;
  private frame = 0;
  private preparing = false;
  /** Whether something came that the card has not seen. */
  private fresh = true;
  private disposed = false;
  private readonly uploaded = new WeakSet<BufferGeometry>();

  /** @param context from createContext(). @param paint draws the panes. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    private readonly scene: Scene,
    private readonly camera: Camera,
    private readonly paint: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, context, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setScissorTest(true);
    // Asking the driver whether it is content would wait for it.
    this.renderer.debug.checkShaderErrors = false;
  }

  /** Draws soon. @param fresh materials or geometries came, which the card gets first */
  request(fresh = false): void {
    this.fresh ||= fresh;
    if (this.frame !== 0 || this.preparing || this.disposed) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      if (this.canvas.clientWidth === 0 || this.canvas.clientHeight === 0) return;
      if (this.fresh) void this.prepare();
      else this.draw();
    });
  }

  dispose(): void {
    this.disposed = true;
    cancelAnimationFrame(this.frame);
    this.renderer.dispose();
  }

  private draw(): void {
    this.resize();
    this.paint();
  }

  /** Takes the canvas's size over, where it changed: the card is asked for new memory. */
  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ratio = this.renderer.getPixelRatio();
    if (this.canvas.width === Math.floor(width * ratio) && this.canvas.height === Math.floor(height * ratio))
      return;
    this.renderer.setSize(width, height, false);
  }

  /** Gives the card what is new, then draws. */
  private async prepare(): Promise<void> {
    this.preparing = true;
    const steps = [
      () => this.resize(),
      () => this.renderer.compile(this.scene, this.camera),
      () => this.askPrograms(),
      () => this.upload(),
    ];
    while (this.fresh && !this.disposed) {
      this.fresh = false;
      for (const step of steps) {
        await this.idle();
        if (this.disposed) return;
        step();
      }
      await this.idle();
    }
    this.preparing = false;
    this.request();
  }

  private askPrograms(): void {
    for (const { material } of drawn(this.scene)) {
      for (const each of [material].flat()) {
        const { currentProgram } = this.renderer.properties.get(each) as Compiled;
        currentProgram?.getUniforms();
        currentProgram?.getAttributes();
      }
    }
  }

  /** Hands over large geometries by drawing none of their triangles. */
  private upload(): void {
    const large = drawn(this.scene)
      .map(({ geometry }) => geometry)
      .filter((each) => each.attributes.position!.count > LARGE && !this.uploaded.has(each));
    if (large.length === 0) return;
    const ranges = large.map(({ drawRange: { start, count } }) => [start, count] as const);
    for (const each of large) each.setDrawRange(0, 0);
    this.paint();
    large.forEach((each, i) => {
      each.setDrawRange(...ranges[i]!);
      this.uploaded.add(each);
    });
  }

  /** Resolves when the card has done all it was told. */
  private async idle(): Promise<void> {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return;
    gl.flush();
    const begin = performance.now();
    do {
      await new Promise((resolve) => setTimeout(resolve, POLL_MS));
    } while (
      !this.disposed &&
      gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED &&
      performance.now() - begin < PATIENCE_MS
    );
    gl.deleteSync(fence);
  }
}

/** Everything below `root` that has a geometry and is shown. */
function drawn(root: Object3D): { geometry: BufferGeometry; material: Material | Material[] }[] {
  const found: Mesh[] = [];
  root.traverseVisible((each) => {
    if ("geometry" in each && "material" in each) found.push(each as Mesh);
  });
  return found;
}
