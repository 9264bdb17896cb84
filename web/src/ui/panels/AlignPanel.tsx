import type { Axis, Unit } from "../../core/types";
import { metres } from "../../result/format";
import { change } from "../actions";
import { Choice } from "../Choice";
import { RunStage } from "../RunStage";
import { found, busy as isBusy, scan, settings } from "../state";

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

const axisName = (axis: Axis) => AXES.find(([value]) => value === axis)?.[1] ?? axis;

const isPlausible = (height: number) => height > 0.5 && height < 2.6;

export function AlignPanel() {
  const { align } = found.value;
  const busy = isBusy.value !== null;
  if (!scan.value) return <p class="quiet">Open a scan first.</p>;
  const { units, up, front } = settings.value;
  return (
    <>
      <p class="quiet">
        Which way is up, which way the person faces, and in what unit the file counts: found from the scan, or
        set here.
      </p>
      <RunStage stage="align" />
      {align && (
        <dl>
          <dt>Unit</dt>
          <dd>{align.unit}</dd>
          <dt>Up</dt>
          <dd>{axisName(align.up)}</dd>
          <dt>Front</dt>
          <dd class={align.front_is_known ? "" : "warn"}>
            {align.front_is_known ? axisName(align.front) : "not recognised: set it below"}
          </dd>
          <dt>Height of the scan</dt>
          <dd class={isPlausible(align.height_m) ? "" : "warn"}>
            {metres(align.height_m)}
            {!isPlausible(align.height_m) && " – is the unit right?"}
          </dd>
        </dl>
      )}
      {align?.note && <p class="note">{align.note}</p>}
      <Choice
        label="Unit"
        value={units}
        options={UNITS}
        disabled={busy}
        onChange={(value) => void change({ units: value })}
      />
      <Choice
        label="Up"
        value={up}
        options={AXES}
        disabled={busy}
        onChange={(value) => void change({ up: value })}
      />
      <Choice
        label="Front"
        value={front}
        options={AXES}
        disabled={busy}
        onChange={(value) => void change({ front: value })}
      />
    </>
  );
}
