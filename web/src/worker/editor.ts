// The editors' questions to the core, with arrays copied out of its memory.
import type { EditorAnswer, EditorRequest } from "../editor/requests";
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

export function answerEditor(core: Core, request: EditorRequest): EditorAnswer {
  if (request.do === "preview") {
    const { body, faces, ...answer } = core.edit<PreviewReport>(request);
    const mesh = { positions: core.floats(body), indices: core.integers(faces) };
    return { ...answer, body: mesh } as unknown as EditorAnswer;
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
  return core.edit<EditorAnswer>(request);
}
