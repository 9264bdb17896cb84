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

/** The surface with all vertices of a cell of a grid in one: what touches grows together. @param cell file's unit */
export function merged(file: Buffer, cell: number): Buffer {
  const { vertices, faces, points, stride, triangles } = readPly(file);
  const place = (i: number) => [0, 4, 8].map((at) => points.readFloatLE(stride * i + at));
  const cells = new Map<string, number>();
  const group: number[] = [];
  const sums: number[][] = [];
  for (let i = 0; i < vertices; ++i) {
    const at = place(i);
    const key = at.map((value) => Math.floor(value / cell)).join();
    const own = cells.get(key) ?? cells.size;
    if (own === cells.size) {
      cells.set(key, own);
      sums.push([0, 0, 0, 0]);
    }
    group.push(own);
    [...at, 1].forEach((value, k) => {
      sums[own]![k]! += value;
    });
  }
  const kept = new Map<string, number[]>();
  for (let i = 0; i < faces; ++i) {
    const face = [1, 5, 9].map((at) => group[triangles.readInt32LE(13 * i + at)]!);
    if (new Set(face).size === 3) kept.set([...face].sort((a, b) => a - b).join(), face);
  }
  const header = [
    "ply",
    "format binary_little_endian 1.0",
    `element vertex ${sums.length}`,
    ...["x", "y", "z"].map((axis) => `property float ${axis}`),
    `element face ${kept.size}`,
    "property list uchar int vertex_indices",
    "end_header\n",
  ].join("\n");
  const corners = Buffer.alloc(12 * sums.length);
  sums.forEach(([x, y, z, count], i) => {
    [x!, y!, z!].forEach((sum, k) => {
      corners.writeFloatLE(sum / count!, 12 * i + 4 * k);
    });
  });
  const rows = Buffer.alloc(13 * kept.size);
  [...kept.values()].forEach((face, i) => {
    rows.writeUInt8(3, 13 * i);
    face.forEach((corner, k) => {
      rows.writeInt32LE(corner, 13 * i + 1 + 4 * k);
    });
  });
  return Buffer.concat([Buffer.from(header), corners, rows]);
}

/** Places of a PLY's vertices. */
export function placesOf(file: Buffer): [number, number, number][] {
  const { vertices, points, stride } = readPly(file);
  return Array.from({ length: vertices }, (_, i) => [
    points.readFloatLE(stride * i),
    points.readFloatLE(stride * i + 4),
    points.readFloatLE(stride * i + 8),
  ]);
}
