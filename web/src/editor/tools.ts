// The handles that are in the view, for the buttons of the panel.
import { effect, signal } from "@preact/signals";
import type { AlignHandles, BoxHandles } from "./handles";
import { handle, steps } from "./state";

export const alignHandles = signal<AlignHandles | null>(null);
export const boxHandles = signal<BoxHandles | null>(null);

export function setAlign(handles: AlignHandles | null): void {
  alignHandles.value = handles;
}

export function setBox(handles: BoxHandles | null): void {
  boxHandles.value = handles;
}

effect(() => {
  alignHandles.value?.set(handle.value, steps.value);
  boxHandles.value?.set(handle.value, steps.value);
});
