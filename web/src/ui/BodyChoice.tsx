import type { Gender } from "../core/types";
import { ownBody } from "../models/own";
import { change } from "./actions";
import { Choice } from "./Choice";
import { OwnModels } from "./OwnModels";
import { busy, settings } from "./state";

const BODIES: [Gender, string][] = [
  ["neutral", "Neutral"],
  ["female", "Female"],
  ["male", "Male"],
];

export function BodyChoice() {
  return (
    <>
      {!ownBody.value && (
        <Choice
          label="Body model"
          value={settings.value.gender}
          options={BODIES}
          disabled={busy.value !== null}
          onChange={(gender) => void change({ gender })}
        />
      )}
      <OwnModels />
    </>
  );
}
