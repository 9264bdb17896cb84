import type { CoreStage } from "../core/types";
import { run } from "./actions";
import { busy, found, stale } from "./state";

const ACTIONS: Record<CoreStage, [string, string]> = {
  align: ["Align", "Align again"],
  keypoints: ["Find keypoints", "Find keypoints again"],
  pose: ["Pose the body", "Pose the body again"],
  register: ["Register", "Register again"],
};

/** Runs one stage by itself (and those before it that are missing), or runs it again. */
export function RunStage({ stage }: { stage: CoreStage }) {
  const done = found.value[stage] !== null;
  return (
    <>
      {stale.value.has(stage) && (
        <p class="note">A change has made this stage out of date. Run it again to see its result.</p>
      )}
      <div class="buttons">
        <button
          type="button"
          class={done ? "" : "main"}
          disabled={busy.value !== null}
          onClick={() => void run(stage)}
        >
          {ACTIONS[stage][done ? 1 : 0]} <kbd>S</kbd>
        </button>
        {stage !== "register" && <RegisterAll main={done} />}
      </div>
    </>
  );
}

/** Runs all stages that are left, and shows the result. */
export function RegisterAll({ main }: { main: boolean }) {
  return (
    <button
      type="button"
      class={main ? "main" : ""}
      disabled={busy.value !== null}
      title="All stages that are left"
      onClick={() => void run("register", "results")}
    >
      Register <kbd>R</kbd>
    </button>
  );
}
