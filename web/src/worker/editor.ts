// The editors' questions to the core, with arrays copied out of its memory.
import type { EditorAnswer, EditorRequest } from "../editor/requests";
import type { PaintExchanges } from "../paint/requests";
import type { ArrayReference, Core } from "./core";

interface CutReport {
  positions: ArrayReference;
  normals: ArrayReference;
  indices: ArrayReference;
}
interface PreviewReport {
  body: ArrayReference;
  faces: ArrayReference;
}

interface PaintMeshReport extends Omit<PaintExchanges["paint_template"]["answer"], "mesh"> {
  positions: ArrayReference;
  indices: ArrayReference;
  normals?: ArrayReference;
  source?: ArrayReference;
}
interface SuggestReport {
  names: string[];
  scan: ArrayReference;
  template: ArrayReference;
}

function paintMesh(core: Core, request: EditorRequest): EditorAnswer {
  const { positions, normals, indices, source, ...answer } = core.edit<PaintMeshReport>(request);
  const mesh = {
    positions: core.floats(positions),
    indices: core.integers(indices),
    ...(normals && { normals: core.floats(normals) }),
  };
  return { ...answer, mesh, ...(source && { source: core.integers(source) }) };
}

export function answerEditor(core: Core, request: EditorRequest): EditorAnswer {
  if (request.do === "preview") {
    const begin = performance.now();
    const { body, faces, ...answer } = core.edit<PreviewReport>(request);
    const work_ms = performance.now() - begin;
    const mesh = { positions: core.floats(body), indices: core.integers(faces) };
    return { ...answer, work_ms, body: mesh } as unknown as EditorAnswer;
  }
  if (request.do === "cut") {
    const { positions, normals, indices } = core.edit<CutReport>(request);
    return {
      mesh: {
        positions: core.floats(positions),
        normals: core.floats(normals),
        indices: core.integers(indices),
      },
    };
  }
  if (request.do === "paint_scan" || request.do === "paint_template") return paintMesh(core, request);
  if (request.do === "paint_pick")
    return { vertices: core.integers(core.edit<{ vertices: ArrayReference }>(request).vertices) };
  if (request.do === "paint_suggest") {
    const { names, scan, template } = core.edit<SuggestReport>(request);
    return { names, scan: core.octets(scan), template: core.octets(template) };
  }
  return core.edit<EditorAnswer>(request);
}
