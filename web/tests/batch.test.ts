import { beforeEach, describe, expect, it, test } from "vitest";
import { isScanName, scansAmong } from "../src/batch/files";
import * as queue from "../src/batch/queue";
import { batchCsv, measurementsCsv } from "../src/batch/table";
import { CoreError, defaultSettings } from "../src/core/types";

const file = (name: string, text = "x") => new File([text], name);

const start = { betas: [1], pose: [0, 0, 0], translation_m: [0, 1, 0] as const, model_sha256: "abc" };
const outcome: queue.Outcome = {
  verdict: { status: "doubtful", confidence: 0.5, reasons: ['a "bad", arm', "cold"] },
  mean_mm: 2.5,
  p95_mm: 7,
  scan_p95_mm: null,
  seconds: 3.25,
  start,
  files: new Blob(),
};

beforeEach(() => {
  queue.items.value = [];
  queue.startFrom.value = null;
});

describe("the queue", () => {
  it("names folders as the command line does, each once", () => {
    queue.add([file("a.ply"), file("a.obj"), file("a.ply.gz"), file("a-2.stl"), file(".ply")]);
    expect(queue.items.value.map(({ folder }) => folder)).toEqual(["a", "a-2", "a-3", "a-2-2", ".ply"]);
  });

  it("gives a kept result its file back, and only that file", () => {
    queue.add([file("a.ply", "1234")]);
    const { id: _, ...kept } = { ...queue.items.value[0]!, file: null, status: "done" as const, outcome };
    queue.items.value = [];
    queue.restore([kept]);
    queue.add([file("a.ply", "another length"), file("a.ply", "1234")]);
    expect(queue.items.value.map(({ status, file }) => [status, file?.size])).toEqual([
      ["done", 4],
      ["waiting", 14],
    ]);
  });

  it("lets others start from a body, but not that body from itself", () => {
    queue.add([file("a.ply"), file("b.ply")]);
    const [a, b] = queue.items.value as [queue.Item, queue.Item];
    queue.update(a.id, { status: "done", outcome });
    queue.startFrom.value = a.id;
    expect(queue.settingsOf(b)).toEqual({ ...defaultSettings, init: "file", start });
    expect(queue.settingsOf(a)).toEqual(defaultSettings);
    queue.remove(a.id);
    expect(queue.settingsOf(b)).toEqual(defaultSettings);
  });

  it("does not let a scan at work be removed", () => {
    queue.add([file("a.ply"), file("b.ply")]);
    queue.update(queue.items.value[0]!.id, { status: "working" });
    queue.removeAll();
    expect(queue.items.value.map(({ name }) => name)).toEqual(["a.ply"]);
  });
});

describe("the table", () => {
  it("has a row a scan, NA where there is no number, and quotes what needs it", () => {
    queue.add([file("a.ply"), file("b.ply"), file("c.ply")]);
    const [a, b] = queue.items.value as [queue.Item, queue.Item];
    queue.update(a.id, { status: "done", outcome });
    queue.update(b.id, { status: "error", error: new CoreError("bad_file", "b.ply:\nline 3") });
    expect(batchCsv(queue.items.value)).toBe(
      [
        "scan,verdict,confidence,mean_mm,p95_mm,scan_p95_mm,seconds,remark",
        'a,doubtful,0.5000,2.5000,7.0000,NA,3.250,"a ""bad"", arm; cold"',
        'b,error,NA,NA,NA,NA,NA,"bad_file: b.ply:\nline 3"',
        "c,waiting,NA,NA,NA,NA,NA,",
        "",
      ].join("\n"),
    );
  });
});

describe("a folder", () => {
  it("gives its scans in order, and nothing else", () => {
    const names = ["scan10.ply", "scan2.PLY.gz", ".hidden.ply", "notes.pdf", "Ærø.glb"];
    expect(names.filter(isScanName)).toEqual(["scan10.ply", "scan2.PLY.gz", "Ærø.glb"]);
    const picked = names.map((name) =>
      Object.defineProperty(file(name), "webkitRelativePath", { value: `day/${name}` }),
    );
    expect(scansAmong(picked).map(({ name }) => name)).toEqual(["Ærø.glb", "scan2.PLY.gz", "scan10.ply"]);
  });
});

test("measurements of all scans make one table, a row each", () => {
  const one = "id,name,value\nwaist,Waist girth,812.5\n";
  const two = 'id,name,value\nwaist,"Waist, natural",700\nhip,Hips,950\n';
  expect(
    measurementsCsv([
      ["a", one],
      ["b, c", two],
    ]),
  ).toBe(
    'scan,id,name,value\na,waist,Waist girth,812.5\n"b, c",waist,"Waist, natural",700\n"b, c",hip,Hips,950\n',
  );
});
