// Small pictures of scans and bodies, drawn out of sight by one renderer that is used again.
import {
  AmbientLight,
  Box3,
  BufferAttribute,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  OrthographicCamera,
  Points,
  PointsMaterial,
  Scene,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Mesh as MeshData, ScanData } from "../core/types";
import { viridis } from "../result/colours";
import { geometryOf } from "../viewer/parts";

const SIDE = 160;
const COLOUR = 0xb9bcc2;
/** Upper end of the error colours in a picture, mm. */
const COLOURS_UP_TO_MM = 20;

export interface Pictures {
  /** The scan as it lies in its file. */
  scan(scan: ScanData): Promise<Blob>;
  /** The registered body, coloured by its distance to the scan, from the front. */
  body(body: MeshData, errorsMm: Float32Array): Promise<Blob>;
}

/** @throws Error when the browser has no WebGL. */
export function createPictures(): Pictures {
  const canvas = document.createElement("canvas");
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(1);
  renderer.setSize(SIDE, SIDE, false);
  renderer.outputColorSpace = SRGBColorSpace;
  const scene = new Scene();
  const light = new DirectionalLight(0xffffff, 2.2);
  light.position.set(0.5, 0.8, 1);
  const root = new Group();
  scene.add(new AmbientLight(0xffffff, 1.1), light, root);
  const camera = new OrthographicCamera();

  const shoot = async (object: Mesh | Points): Promise<Blob> => {
    root.add(object);
    root.updateMatrixWorld(true);
    const box = new Box3().setFromObject(root);
    const [centre, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
    const half = Math.max(size.x, size.y, 1e-6) * 0.54;
    Object.assign(camera, { left: -half, right: half, top: half, bottom: -half });
    camera.near = 0;
    camera.far = 4 * (size.z + half);
    camera.position.set(centre.x, centre.y, centre.z + 2 * (size.z + half));
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
    root.remove(object);
    object.geometry.dispose();
    (object.material as MeshLambertMaterial).dispose();
    renderer.renderLists.dispose();
    return new Promise((resolve, reject) =>
      canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png"),
    );
  };

  return {
    scan({ mesh }) {
      const object =
        mesh.indices.length > 0
          ? new Mesh(geometryOf(mesh), new MeshLambertMaterial({ color: COLOUR, side: DoubleSide }))
          : new Points(
              geometryOf(mesh),
              new PointsMaterial({ color: COLOUR, size: 1, sizeAttenuation: false }),
            );
      object.applyMatrix4(standing(object));
      return shoot(object);
    },
    body(body, errorsMm) {
      const geometry = geometryOf(body);
      const colours = new Float32Array(3 * errorsMm.length);
      const colour = new Color();
      errorsMm.forEach((error, i) => {
        colour.setRGB(...viridis(error / COLOURS_UP_TO_MM), SRGBColorSpace).toArray(colours, 3 * i);
      });
      geometry.setAttribute("color", new BufferAttribute(colours, 3));
      return shoot(new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide })));
    },
  };
}

/** Most scans lie with their longest extent upright: those whose longest is Z are shown standing. */
function standing(object: Mesh | Points): Matrix4 {
  const size = new Box3().setFromObject(object).getSize(new Vector3());
  return size.z > size.y ? new Matrix4().makeRotationX(-Math.PI / 2) : new Matrix4();
}
