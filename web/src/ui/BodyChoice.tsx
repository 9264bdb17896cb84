import type { Gender } from "../core/types";
import { change } from "./actions";
import { Choice } from "./Choice";
import { busy, settings } from "./state";

const BODIES: [Gender, string][] = [
  ["neutral", "Neutral"],
  ["female", "Female"],
  ["male", "Male"],
];

export function BodyChoice() {
  return (
    <Choice
      label="Body model"
      value={settings.value.gender}
      options={BODIES}
      disabled={busy.value !== null}
      onChange={(gender) => void change({ gender })}
    />
  );
}
