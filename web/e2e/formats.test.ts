import { gzipSync } from "node:zlib";
import { describe, expect } from "vitest";
import { boxObj, pick, test } from "./harness";

type Triple = [number, number, number];

/** The box of boxObj() as numbers, quads cut in two. */
function box(): { vertices: Triple[]; faces: Triple[] } {
  const vertices: Triple[] = [];
  const faces: Triple[] = [];
  for (const line of boxObj(1.75).toString().split("\n")) {
    const [word, ...numbers] = line.split(" ");
    const [a, b, c, d] = numbers.map(Number) as [number, number, number, number];
    if (word === "v") vertices.push([a, b, c]);
    if (word === "f") faces.push([a - 1, b - 1, c - 1], [a - 1, c - 1, d - 1]);
  }
  return { vertices, faces };
}

const { vertices, faces } = box();
const points = vertices.map((each) => `${each.join(" ")}\n`).join("");

function ply(): Buffer {
  const header =
    `ply\nformat ascii 1.0\nelement vertex ${vertices.length}\nproperty float x\nproperty float y\nproperty float z\n` +
    `element face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n`;
  return Buffer.from(header + points + faces.map((face) => `3 ${face.join(" ")}\n`).join(""));
}

function off(): Buffer {
  const triangles = faces.map((face) => `3 ${face.join(" ")}\n`).join("");
  return Buffer.from(`OFF\n${vertices.length} ${faces.length} 0\n${points}${triangles}`);
}

function stl(): Buffer {
  const file = Buffer.alloc(84 + 50 * faces.length);
  file.writeUInt32LE(faces.length, 80);
  for (const [i, face] of faces.entries()) {
    for (const [k, value] of face.flatMap((v) => vertices[v]!).entries())
      file.writeFloatLE(value, 84 + 50 * i + 12 + 4 * k);
  }
  return file;
}

function pcd(): Buffer {
  const header =
    "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" +
    `WIDTH ${vertices.length}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS ${vertices.length}\nDATA ascii\n`;
  return Buffer.from(header + points);
}

function glb(): Buffer {
  const positions = Buffer.from(new Float32Array(vertices.flat()).buffer);
  const indices = Buffer.from(new Uint32Array(faces.flat()).buffer);
  const extent = (pick: (...values: number[]) => number) =>
    [0, 1, 2].map((k) => pick(...vertices.map((v) => v[k]!)));
  const document = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
    buffers: [{ byteLength: positions.length + indices.length }],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: positions.length },
      { buffer: 0, byteOffset: positions.length, byteLength: indices.length },
    ],
    accessors: [
      {
        ...{ bufferView: 0, componentType: 5126, count: vertices.length, type: "VEC3" },
        ...{ min: extent(Math.min), max: extent(Math.max) },
      },
      { bufferView: 1, componentType: 5125, count: 3 * faces.length, type: "SCALAR" },
    ],
  };
  const text = JSON.stringify(document);
  const chunk = (kind: string, content: Buffer) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(content.length, 0);
    head.write(kind, 4, "latin1");
    return Buffer.concat([head, content]);
  };
  const body = Buffer.concat([
    chunk("JSON", Buffer.from(text.padEnd(4 * Math.ceil(text.length / 4)))),
    chunk("BIN\0", Buffer.concat([positions, indices])),
  ]);
  const head = Buffer.alloc(12);
  head.write("glTF", 0, "latin1");
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + body.length, 8);
  return Buffer.concat([head, body]);
}

/** Name and content, and the numbers of vertices and faces that the page is to tell. */
const FILES: [string, Buffer, string, string][] = [
  ["box.ply", ply(), "36", "64"],
  ["box.obj", boxObj(1.75), "36", "64"],
  // Each facet has corners of its own.
  ["box.stl", stl(), "192", "64"],
  ["box.off", off(), "36", "64"],
  ["box.glb", glb(), "36", "64"],
  ["box.xyz", Buffer.from(points), "36", "none"],
  ["box.pcd", pcd(), "36", "none"],
  ["box.ply.gz", gzipSync(ply()), "36", "64"],
  ["box.xyz.gz", gzipSync(Buffer.from(points)), "36", "none"],
];

describe("every format of the command line", () => {
  test("is opened by the page", async ({ page }) => {
    for (const [name, buffer, vertexCount, faceCount] of FILES) {
      await pick(page, { name, buffer });
      await page.getByText(name, { exact: true }).waitFor();
      const panel = await page.locator("aside").innerText();
      expect(panel, name).toMatch(new RegExp(`Vertices\\s+${vertexCount}\\s+Faces\\s+${faceCount}`));
    }
  });
});
