import { unzipSync } from "fflate";
import { describe, expect, it } from "vitest";
import { legendMaximum, toCss, viridis } from "../src/result/colours";
import { stem, zipped } from "../src/result/download";
import { bytes, displayName, millimetres, seconds } from "../src/result/format";
import { histogram } from "../src/result/histogram";
import { columnMajor, transformPoint } from "../src/result/transform";

describe("colours", () => {
  it("run from dark to light without turning back", () => {
    const luminance = (t: number) => {
      const [r, g, b] = viridis(t);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    for (let i = 1; i <= 100; ++i) expect(luminance(i / 100)).toBeGreaterThan(luminance((i - 1) / 100));
  });

  it("clamp what lies outside and what is not a number", () => {
    expect(viridis(-3)).toEqual(viridis(0));
    expect(viridis(7)).toEqual(viridis(1));
    expect(viridis(Number.NaN)).toEqual(viridis(0));
    expect(toCss([0, 0.5, 1])).toBe("rgb(0 128 255)");
  });

  it("choose a round scale that a few outliers do not stretch", () => {
    const values = new Float32Array(1000).fill(1.4);
    values[0] = 400;
    expect(legendMaximum(values)).toBe(2);
    expect(legendMaximum(new Float32Array())).toBe(10);
  });
});

describe("histogram", () => {
  it("counts every value once, the far ones in the last bin", () => {
    const { counts } = histogram(Float32Array.of(0, 0.9, 1, 9.99, 10, 250), 10, 10);
    expect(counts).toEqual([2, 1, 0, 0, 0, 0, 0, 0, 0, 3]);
  });
});

describe("format", () => {
  it("shows numbers as people read them", () => {
    expect(millimetres(1.234)).toBe("1.23");
    expect(millimetres(123.45)).toBe("123.5");
    expect(millimetres(null)).toBe("–");
    expect(seconds(1530)).toBe("1.5 s");
    expect(seconds(12_400)).toBe("12 s");
    expect(bytes(999)).toBe("999 B");
    expect(bytes(250_000_000)).toBe("250.0 MB");
    expect(displayName("left_upper_leg")).toBe("Left upper leg");
  });
});

describe("transform", () => {
  const matrix = [
    [0, -2, 0, 10],
    [2, 0, 0, 20],
    [0, 0, 2, 30],
    [0, 0, 0, 1],
  ];

  it("takes rows, and gives columns to three.js", () => {
    expect(transformPoint(matrix, [1, 2, 3])).toEqual([6, 22, 36]);
    expect(columnMajor(matrix)).toEqual([0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1]);
  });
});

describe("download", () => {
  it("names the folder as the command line does", () => {
    expect(stem("person.ply")).toBe("person");
    expect(stem("person.v2.obj.gz")).toBe("person.v2");
    expect(stem("Ærø scan.PLY.GZ")).toBe("Ærø scan");
    expect(stem(".ply")).toBe(".ply");
  });

  it("zips every file into that folder, the same bytes each time", async () => {
    const files = [
      { name: "registration.json", data: new TextEncoder().encode("{}") },
      { name: "registered.ply", data: Uint8Array.of(0, 255, 7) },
    ];
    const zip = await zipped("a.ply.gz", files);
    expect(zip.name).toBe("a.zip");
    const entries = unzipSync(zip.data);
    expect(Object.keys(entries)).toEqual(["a/registration.json", "a/registered.ply"]);
    expect(entries["a/registered.ply"]).toEqual(Uint8Array.of(0, 255, 7));
    expect((await zipped("a.ply.gz", files)).data).toEqual(zip.data);
  });
});
