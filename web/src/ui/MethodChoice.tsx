import { useSignal } from "@preact/signals";
import type { Settings } from "../core/types";
import { change } from "./actions";
import { Choice } from "./Choice";
import { busy, settings } from "./state";
import "./inputs.css";

const METHODS: [Settings["method"], string][] = [
  ["ours", "Fast"],
  ["paper", "As published"],
  ["paper-cpu", "As published, CPU"],
];

/** Iterations of each stage, and by Adam of these, that a method stands for (settings_of() in core/pipeline). */
const ITERATIONS = {
  paper: { iterations: 6000, adam_iterations: 6000 },
  "paper-cpu": { iterations: 2000, adam_iterations: 100 },
};
const MOST = 1_000_000;

/** Pictures that a registration looks at: chosen, or as the method says. */
export function viewCount({ method, views }: Settings): 2 | 8 {
  return views ?? (method === "ours" ? 8 : 2);
}

/** Our stages or the published ones, with the published solver's numbers. */
export function MethodChoice() {
  const { method } = settings.value;
  return (
    <>
      <Choice
        label="Method"
        value={method}
        options={METHODS}
        disabled={busy.value !== null}
        onChange={(chosen) =>
          void change({
            method: chosen,
            views: undefined,
            iterations: undefined,
            adam_iterations: undefined,
          })
        }
      />
      {method !== "ours" && <Iterations method={method} />}
    </>
  );
}

function Iterations({ method }: { method: keyof typeof ITERATIONS }) {
  const { iterations, adam_iterations } = { ...ITERATIONS[method], ...given(settings.value) };
  return (
    <>
      <p class="quiet">
        Every stage as published: PCA alignment, two pictures, the learnt pose prior, Chamfer distance. Takes
        minutes.
      </p>
      <Count
        label="Iterations of each stage"
        value={iterations}
        least={1}
        onChange={(value) => void changeNext({ iterations: value })}
      />
      <Count
        label="Of these by Adam, the rest by L-BFGS"
        value={adam_iterations}
        least={0}
        onChange={(value) => void changeNext({ adam_iterations: value })}
      />
    </>
  );
}

/** Changes settings as soon as the change before has been taken over. */
async function changeNext(changed: Partial<Settings>): Promise<void> {
  while (busy.value) await new Promise((resolve) => setTimeout(resolve, 20));
  await change(changed);
}

/** The numbers that were set by hand. */
function given({ iterations, adam_iterations }: Settings): { iterations?: number; adam_iterations?: number } {
  return {
    ...(iterations !== undefined && { iterations }),
    ...(adam_iterations !== undefined && { adam_iterations }),
  };
}

interface CountProps {
  label: string;
  value: number;
  least: number;
  onChange(value: number): void;
}

function Count({ label, value, least, onChange }: CountProps) {
  /** What is being typed: the page may be drawn anew meanwhile. */
  const draft = useSignal<string | null>(null);
  return (
    <label class="count">
      {label}
      <input
        type="number"
        min={least}
        max={MOST}
        step={1}
        value={draft.value ?? value}
        onInput={({ currentTarget }) => {
          draft.value = currentTarget.value;
        }}
        onChange={({ currentTarget: input }) => {
          const accepted = input.value !== "" && input.checkValidity();
          if (accepted) onChange(input.valueAsNumber);
          draft.value = null;
          if (!accepted) input.value = String(value);
        }}
      />
    </label>
  );
}
