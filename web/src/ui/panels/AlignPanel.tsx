import type { Axis, Unit } from "../../core/types";
import { metres } from "../../result/format";
import { change } from "../actions";
import { Choice } from "../Choice";
import { RegisterHere } from "../RegisterHere";
import { busy as isBusy, result, scan, settings } from "../state";

const UNITS: [Unit | "auto", string][] = [
  ["auto", "Auto"],
  ["m", "m"],
  ["cm", "cm"],
  ["mm", "mm"],
  ["in", "inch"],
];
const AXES: [Axis | "auto", string][] = [
  ["auto", "Auto"],
  ["x", "+X"],
  ["-x", "−X"],
  ["y", "+Y"],
  ["-y", "−Y"],
  ["z", "+Z"],
  ["-z", "−Z"],
];

const isPlausible = (height: number) => height > 0.5 && height < 2.6;

export function AlignPanel() {
  const found = result.value;
  const busy = isBusy.value !== null;
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  const { unit, up, front } = settings.value;
  return (
    <>
      {found?.registration.alignment ? (
        <dl>
          <dt>Unit</dt>
          <dd>{found.registration.scan.unit}</dd>
          <dt>Up, front</dt>
          <dd>
            {found.registration.alignment.up}, {found.registration.alignment.front}
          </dd>
          <dt>Height of the scan</dt>
          <dd class={isPlausible(found.height_m) ? "" : "warn"}>
            {metres(found.height_m)}
            {!isPlausible(found.height_m) && " – is the unit right?"}
          </dd>
        </dl>
      ) : (
        <p class="quiet">
          Which way is up, which way the person faces, and in what unit the file counts: found from the scan,
          or set here.
        </p>
      )}
      <Choice
        label="Unit"
        value={unit}
        options={UNITS}
        disabled={busy}
        onChange={(value) => change({ unit: value })}
      />
      <Choice
        label="Up"
        value={up}
        options={AXES}
        disabled={busy}
        onChange={(value) => change({ up: value })}
      />
      <Choice
        label="Front"
        value={front}
        options={AXES}
        disabled={busy}
        onChange={(value) => change({ front: value })}
      />
      <RegisterHere stage="align" />
    </>
  );
}
