import { kStages, type Stage } from "../core/types";
import { type Done, progressOf, stage } from "./state";

export const STAGE_NAMES: Record<Stage, string> = {
  scan: "Scan",
  align: "Align",
  keypoints: "Keypoints",
  pose: "Pose",
  register: "Register",
  results: "Results",
};

const SAID: Record<Done, string> = {
  waiting: "not done",
  working: "working",
  done: "done",
  stale: "out of date",
  failed: "failed",
};
const MARK: Record<Done, string> = { waiting: "", working: "…", done: "✓", stale: "↻", failed: "!" };

/** The stages in their order, each with its state. */
export function StageRail() {
  return (
    <nav aria-label="Stages">
      <ol>
        {kStages.map((name, i) => {
          const done = progressOf.value[name];
          return (
            <li key={name}>
              <button
                type="button"
                class={`stage ${done}`}
                aria-current={stage.value === name ? "step" : undefined}
                onClick={() => {
                  stage.value = name;
                }}
              >
                <span class="number" aria-hidden="true">
                  {MARK[done] || i + 1}
                </span>
                {STAGE_NAMES[name]}
                <span class="unseen">, {SAID[done]}</span>
              </button>
            </li>
          );
        })}
      </ol>
    </nav>
  );
}
