// The published solver's energy while it works: one curve for each of its parts.
import { signal } from "@preact/signals";

export interface Curve {
  name: string;
  /** in the order of the iterations */
  points: { iteration: number; value: number }[];
}

/** More points than can be told apart are thinned to half. */
const MOST = 400;

export const curves = signal<readonly Curve[]>([]);

export function clear(): void {
  curves.value = [];
}

export function add({ curve, iteration, value }: { curve: string; iteration: number; value: number }): void {
  const known = curves.value.find(({ name }) => name === curve);
  const last = known?.points.at(-1);
  if (last && last.iteration >= iteration) return;
  let points = [...(known?.points ?? []), { iteration, value }];
  if (points.length > MOST) points = points.filter((_, i) => i % 2 === 0 || i === points.length - 1);
  const others = curves.value.filter(({ name }) => name !== curve);
  curves.value = [...others, { name: curve, points }];
}
