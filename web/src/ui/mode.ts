import { signal } from "@preact/signals";

/** What the page is used for. */
export type Mode = "scan" | "batch" | "learn" | "body";

export const MODES: readonly (readonly [Mode, string, string])[] = [
  ["scan", "One scan", "Register one scan, stage by stage"],
  ["batch", "Batch", "Register many scans one after the other"],
  ["learn", "Learn", "See how the method works, on any scan"],
  ["body", "Body", "The body model itself: shape and joints on sliders"],
];

export const mode = signal<Mode>("scan");
