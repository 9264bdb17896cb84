// The published solver's energy while it works: one curve for each of its parts.
import { signal } from "@preact/signals";
import type { EnergyPoint } from "../core/messages";

export interface Curve {
  name: string;
  /** in the order of the iterations */
  points: { iteration: number; value: number }[];
}

/** More points than can be told apart are thinned to half. */
const MOST = 500;

export const curves = signal<readonly Curve[]>([]);

export function clear(): void {
  curves.value = [];
}

export function add(told: readonly EnergyPoint[]): void {
  const found = new Map(curves.value.map(({ name, points }) => [name, [...points]]));
  for (const { curve, iteration, value } of told) {
    const points = found.get(curve) ?? [];
    points.push({ iteration, value });
    found.set(curve, points);
  }
  curves.value = [...found].map(([name, points]) => ({ name, points: thinned(points) }));
}

/** Every other point, the last one kept, until they are few enough. */
export function thinned<T>(points: T[]): T[] {
  if (points.length <= MOST) return points;
  return thinned(points.filter((_, i) => i % 2 === 0 || i === points.length - 1));
}
