import type { Settings } from "../core/types";
import { change } from "./actions";
import { Choice } from "./Choice";
import { busy, settings } from "./state";

const DETAILS: [Settings["detail"], string][] = [
  ["off", "Off"],
  ["vertex", "Per vertex"],
];

/** Whether single vertices may leave the body model to meet the scan. */
export function DetailChoice() {
  return (
    <Choice
      label="Detail"
      value={settings.value.detail}
      options={DETAILS}
      disabled={busy.value !== null}
      onChange={(detail) => void change({ detail })}
    />
  );
}
