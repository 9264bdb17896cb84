import type { Stage } from "../core/types";
import { busy, scan } from "../ui/state";
import * as editing from "./editing";
import { FileButton } from "./FileButton";
import * as state from "./state";
import { trouble } from "./state";

/** What can be done by hand at a stage. */
export function HandTools({ stage }: { stage: Stage }) {
  if (!scan.value) return null;
  const working = busy.value !== null;
  const button = (tool: state.Tool, name: string) => (
    <button type="button" disabled={working} onClick={() => void editing.open(tool)}>
      {name}
    </button>
  );
  const edits = state.history.value.done.length;
  return (
    <section aria-label="By hand">
      <h3>By hand</h3>
      {trouble.value && (
        <p class="problem" role="alert">
          {trouble.value}
        </p>
      )}
      {edits > 0 && (
        <p class="note">
          {edits === 1 ? "1 edit" : `${edits} edits`} by hand; open the editor to see or undo.
        </p>
      )}
      <div class="buttons">
        {stage === "scan" && button("cut", "Cut away…")}
        {stage === "scan" && (
          <FileButton label="Open project…" onFile={(file) => void editing.openProject(file)} />
        )}
        {stage === "align" && button("align", "Align by hand…")}
        {(stage === "keypoints" || stage === "pose" || stage === "results") &&
          button("joints", "Edit the joints…")}
        {(stage === "pose" || stage === "register" || stage === "results") &&
          button("paint", "Paint regions…")}
      </div>
    </section>
  );
}
