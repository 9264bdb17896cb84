import { useEffect } from "preact/hooks";
import { explain } from "../core/explain";
import { kStages, type Stage } from "../core/types";
import { EditorPanel } from "../editor/EditorPanel";
import { HandTools } from "../editor/HandTools";
import { tool as editorTool } from "../editor/state";
import { seconds } from "../result/format";
import { cancel } from "./actions";
import { EnergyPlot } from "./EnergyPlot";
import { AlignPanel } from "./panels/AlignPanel";
import { KeypointsPanel } from "./panels/KeypointsPanel";
import { PosePanel } from "./panels/PosePanel";
import { RegisterPanel } from "./panels/RegisterPanel";
import { ResultsPanel } from "./panels/ResultsPanel";
import { ScanPanel } from "./panels/ScanPanel";
import { STAGE_NAMES } from "./StageRail";
import * as state from "./state";
import { useNow } from "./useNow";

/** The panel of the chosen stage, with the progress and the problem of the work under way. */
export function Inspector({ pick }: { pick: () => void }) {
  const stage = state.stage.value;
  if (editorTool.value) {
    return (
      <aside aria-label="Edit by hand">
        <h2>Edit by hand</h2>
        <Problem stage={stage} />
        <BusyBar />
        <EditorPanel />
      </aside>
    );
  }
  return (
    <aside aria-label={STAGE_NAMES[stage]}>
      <h2>{STAGE_NAMES[stage]}</h2>
      <Problem stage={stage} />
      <BusyBar />
      {stage === "scan" && <ScanPanel pick={pick} />}
      {stage === "align" && <AlignPanel />}
      {stage === "keypoints" && <KeypointsPanel />}
      {stage === "pose" && <PosePanel />}
      {stage === "register" && <RegisterPanel />}
      {stage === "results" && <ResultsPanel />}
      <HandTools stage={stage} />
    </aside>
  );
}

function BusyBar() {
  const busy = state.busy.value;
  const now = useNow(busy !== null);
  if (!busy) return null;
  const progress = state.progress.value;
  return (
    <div class="progress">
      <div class="row">
        <span>{state.doing.value}</span>
        <span class="quiet">{seconds(Math.max(now - busy.since, 0))}</span>
      </div>
      <progress aria-label={state.doing.value ?? ""} max={1} value={progress?.fraction ?? undefined} />
      <EnergyPlot />
      <button type="button" onClick={cancel}>
        Cancel <kbd>Esc</kbd>
      </button>
    </div>
  );
}

function Problem({ stage }: { stage: Stage }) {
  const problem = state.problem.value;
  useEffect(() => {
    if (problem && kStages.includes(problem.stage)) state.stage.value = problem.stage;
  }, [problem]);
  if (!problem || problem.stage !== stage) return null;
  const { what, mend, detail } = explain(problem.error);
  return (
    <div class={problem.error.code === "cancelled" ? "note" : "problem"} role="alert">
      <strong>{what}</strong> {mend}
      {problem.error.code !== "cancelled" && <p class="detail">{detail}</p>}
    </div>
  );
}
