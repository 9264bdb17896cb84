// Copies what the core tells about bodies and lessons out of its memory.
import type {
  BodyDescription,
  BodyParameters,
  LessonData,
  LessonSettings,
  LessonStep,
  PosedBody,
} from "../core/teaching";
import type { ArrayReference, Core } from "./core";

type BodyReport = Omit<BodyDescription, "faces"> & { faces: ArrayReference };
type PosedReport = Omit<PosedBody, "positions"> & { body: ArrayReference };
type StepReport = Omit<LessonStep, "joints" | "pairs"> & { joints: ArrayReference; pairs: ArrayReference };
type LessonReport = Omit<LessonData, "steps" | "residual_m" | "unchanged_residual_m"> & {
  steps: StepReport[];
  residual_m: ArrayReference;
  unchanged_residual_m: ArrayReference;
};

export function bodyOf(core: Core): BodyDescription {
  const report = core.body<BodyReport>();
  return { ...report, faces: core.integers(report.faces) };
}

export function poseBody(core: Core, parameters: BodyParameters): PosedBody {
  const { body, ...report } = core.poseBody<PosedReport>(parameters);
  return { ...report, positions: core.floats(body) };
}

export async function lessonOf(core: Core, settings: LessonSettings): Promise<LessonData> {
  const report = await core.lesson<LessonReport>(settings);
  return {
    ...report,
    steps: report.steps.map((step) => ({
      ...step,
      joints: core.floats(step.joints),
      pairs: core.floats(step.pairs),
    })),
    residual_m: core.floats(report.residual_m),
    unchanged_residual_m: core.floats(report.unchanged_residual_m),
  };
}
