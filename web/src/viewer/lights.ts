import { AmbientLight, DirectionalLight, HemisphereLight, type Light } from "three";

/** Lights for views in which people work on a scan: even all round, with a little shape. */
export function workLights(): Light[] {
  const key = new DirectionalLight(0xffffff, 1.2);
  key.position.set(1, 1, 1);
  const fill = new DirectionalLight(0xffffff, 0.6);
  fill.position.set(-1, 0.4, -1);
  return [key, fill, new AmbientLight(0xffffff, 0.7), new HemisphereLight(0xffffff, 0x777788, 1)];
}
