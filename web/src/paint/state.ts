// What the painter shows. Only painting.ts writes it, the choices of the panel apart.
import { computed, signal } from "@preact/signals";
import type { RegionSet } from "../core/edits";
import { type Command, counts, emptyLabels, type Labels, type Pair } from "./labels";
import type { PaintMesh } from "./requests";

export type Tool = "brush" | "lasso" | "part" | "turn";

export const scanMesh = signal<(PaintMesh & { source: Uint32Array }) | null>(null);
export const templateMesh = signal<PaintMesh | null>(null);

export const pairs = signal<readonly Pair[]>([]);
/** Changed in place: whoever reads it reads `revision` too. */
export const labels = signal<Labels>(emptyLabels(0, 0));
/** Grows with each change of the labels. */
export const revision = signal(0);
export const done = signal<readonly Command[]>([]);
export const undone = signal<readonly Command[]>([]);

/** id of the pair that is painted; 0: none */
export const selected = signal(0);
export const tool = signal<Tool>("brush");
export const erasing = signal(false);
/** pixels */
export const radius = signal(18);
export const SMALLEST = 2;
export const LARGEST = 150;
export const stance = signal<"posed" | "rest">("posed");
/** Both views turn together. */
export const together = signal(true);
export const trouble = signal("");

/** The regions that the registration was last given; what is painted now may differ. */
export const given = signal<RegionSet | null>(null);

export const painted = computed(() => {
  revision.value;
  return counts(labels.value);
});

/** Pairs that are painted on both sides, and those that lack one. */
export const completeness = computed(() => {
  const whole = pairs.value.filter(({ id }) => {
    const count = painted.value.get(id);
    return count && count.scan > 0 && count.template > 0;
  });
  return { whole: whole.length, lacking: pairs.value.filter((pair) => !whole.includes(pair)) };
});
