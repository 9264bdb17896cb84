// Scans made from the sample or the body model, for cases that need a certain one.
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

interface Ply {
  header: string;
  vertices: number;
  faces: number;
  /** a vertex: three floats first, then what else it has */
  points: Buffer;
  stride: number;
  /** a byte and three integers a face */
  triangles: Buffer;
}

/** A binary PLY of triangles whose vertices begin with three floats. */
export function readPly(file: Buffer): Ply {
  const end = file.indexOf("end_header\n") + "end_header\n".length;
  const header = file.subarray(0, end).toString();
  const count = (element: string) => Number(new RegExp(`element ${element} (\\d+)`).exec(header)![1]);
  const [vertices, faces] = [count("vertex"), count("face")];
  const stride = (file.length - end - 13 * faces) / vertices;
  const points = Buffer.from(file.subarray(end, end + stride * vertices));
  return { header, vertices, faces, points, stride, triangles: file.subarray(end + stride * vertices) };
}

/** The scan twice, `apart` along its third axis: an automatic registration cannot tell whom to take. */
export function twoPeople(file: Buffer, apart: number): Buffer {
  const { header, vertices, faces, points, stride, triangles } = readPly(file);
  const other = Buffer.from(points);
  for (let i = 0; i < vertices; ++i)
    other.writeFloatLE(points.readFloatLE(stride * i + 8) + apart, stride * i + 8);
  const others = Buffer.from(triangles);
  for (let i = 0; i < faces; ++i)
    for (let k = 0; k < 3; ++k) {
      const at = 13 * i + 1 + 4 * k;
      others.writeInt32LE(triangles.readInt32LE(at) + vertices, at);
    }
  const twice = header
    .replace(`vertex ${vertices}`, `vertex ${2 * vertices}`)
    .replace(`face ${faces}`, `face ${2 * faces}`);
  return Buffer.concat([Buffer.from(twice), points, other, triangles, others]);
}

/** Numbers of the standard normal distribution from a seed (mulberry32, Box and Muller). */
function normal(seed: number): () => number {
  let state = seed;
  const uniform = () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
  return () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());
}

/** Noise on every coordinate, in the file's unit. */
export function noisy(file: Buffer, deviation: number, seed: number): Buffer {
  const { header, vertices, points, stride, triangles } = readPly(file);
  const random = normal(seed);
  for (let i = 0; i < vertices; ++i)
    for (let k = 0; k < 3; ++k) {
      const at = stride * i + 4 * k;
      points.writeFloatLE(points.readFloatLE(at) + deviation * random(), at);
    }
  return Buffer.concat([Buffer.from(header), points, triangles]);
}

/**
 * A scan of the body model in a pose (72 axis-angle numbers), and where its joints are, both in metres.
 * @param seed of its shape and heading
 */
export function scanOfModel(
  root: string,
  folder: string,
  pose: readonly number[],
  seed: number,
  vertices: number,
): { scan: Buffer; joints: Record<string, [number, number, number]> } {
  mkdirSync(folder, { recursive: true });
  const poses = join(folder, "pose.csv");
  writeFileSync(poses, `${pose.join(",")}\n`);
  const { status, stderr } = spawnSync(`${root}/build/native/vitruvian-make-scans`, [
    `${root}/models/generated/body.vbm`,
    poses,
    folder,
    ...[seed, 1, vertices].map(String),
  ]);
  if (status !== 0) throw new Error(`vitruvian-make-scans: ${stderr}`);
  const { joints } = JSON.parse(readFileSync(join(folder, "body_000.truth.json"), "utf8"));
  return { scan: readFileSync(join(folder, "body_000.ply")), joints };
}
