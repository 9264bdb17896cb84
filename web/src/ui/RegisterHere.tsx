import type { Stage } from "../core/types";
import { register } from "./actions";
import { busy, result } from "./state";

/** The button that registers and then shows what `stage` found. */
export function RegisterHere({ stage }: { stage: Stage }) {
  const again = result.value !== null;
  return (
    <button
      type="button"
      class={again ? "" : "main"}
      disabled={busy.value !== null}
      onClick={() => void register(stage)}
    >
      {again ? "Register again" : "Register"} <kbd>R</kbd>
    </button>
  );
}
