import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { explain } from "../core/explain";
import type { Gender } from "../core/types";
import { displayName } from "../result/format";
import { Choice } from "../ui/Choice";
import { Model } from "./formulas";
import * as posing from "./posing";
import { PLAIN_VIEW, Scene } from "./Scene";
import "./teach.css";

const GENDERS: [Gender, string][] = [
  ["neutral", "Neutral"],
  ["female", "Female"],
  ["male", "Male"],
];
const FIRST_COMPONENTS = 10;
const AXES = ["about X (nod)", "about Y (turn)", "about Z (lean)"];
/** Of joints without known limits. */
const HALF_TURN = Math.PI;

/** The body model itself: its shape and its joints on sliders. */
export function BodyPage() {
  useEffect(() => {
    void posing.loadBody();
  }, []);
  const { posed, body, problem } = posing;
  return (
    <main class="learn body">
      <Scene
        label="Body model"
        draws={[
          (viewer) => {
            viewer.setOptions(PLAIN_VIEW, 10);
            if (!posed.value || !body.value) return;
            const isFirst = viewer.moveBody({ positions: posed.value.positions, indices: body.value.faces });
            if (isFirst) viewer.fit();
            viewer.setSkeleton(posed.value.joints);
          },
        ]}
      >
        {posed.value && (
          <p class="probe" role="status">
            Standing height {posed.value.height_m.toFixed(3)} m
          </p>
        )}
      </Scene>
      <aside aria-label="Body model">
        <h2>Body model</h2>
        {problem.value && (
          <div class="problem" role="alert">
            <strong>{explain(problem.value).what}</strong> {explain(problem.value).mend}
            <p class="detail">{problem.value.message}</p>
          </div>
        )}
        {body.value ? <Sliders /> : !problem.value && <p class="quiet">Loading the body model…</p>}
      </aside>
    </main>
  );
}

function Sliders() {
  const body = posing.body.value!;
  const all = useSignal(false);
  const count = all.value ? posing.shape.value.length : FIRST_COMPONENTS;
  return (
    <>
      <p class="quiet">
        Every registered body is this mesh under some numbers: shape components β that say how people differ,
        and one turn θ for each joint. Its vertices are a mean body T, changed in shape, corrected for the
        pose, and bent (W) at its joints J:
      </p>
      <Model />
      <Choice
        label="Population"
        value={posing.gender.value}
        options={GENDERS}
        onChange={(gender) => {
          posing.gender.value = gender;
        }}
      />
      <div class="row">
        <h3>Shape</h3>
        <button type="button" onClick={posing.resetShape}>
          Mean shape
        </button>
      </div>
      <p class="quiet">In standard deviations from the population’s mean.</p>
      {posing.shape.value.slice(0, count).map((value, k) => (
        <Slider
          key={k}
          label={`Component ${k + 1}`}
          value={value}
          low={-3}
          high={3}
          text={value.toFixed(1)}
          onChange={(chosen) => posing.setShape(k, chosen)}
        />
      ))}
      {posing.shape.value.length > FIRST_COMPONENTS && (
        <label class="check">
          <input
            type="checkbox"
            checked={all.value}
            onChange={(event) => {
              all.value = event.currentTarget.checked;
            }}
          />
          All {posing.shape.value.length} components
        </label>
      )}
      <div class="row">
        <h3>Joints</h3>
        <button type="button" onClick={posing.resetPose}>
          Rest pose
        </button>
      </div>
      <p class="quiet">Within the limits that the fit keeps to, in degrees.</p>
      {body.joints.map((joint, j) => (
        <details key={joint.name}>
          <summary>{displayName(joint.name)}</summary>
          {AXES.map((axis, a) => (
            <Slider
              key={axis}
              label={`${displayName(joint.name)} ${axis}`}
              shown={axis}
              value={posing.turns.value[j]?.[a] ?? 0}
              low={Math.min(joint.low_rad?.[a] ?? -HALF_TURN, 0)}
              high={Math.max(joint.high_rad?.[a] ?? HALF_TURN, 0)}
              text={`${Math.round(((posing.turns.value[j]?.[a] ?? 0) * 180) / Math.PI)}°`}
              onChange={(chosen) => posing.setTurn(j, a, chosen)}
            />
          ))}
        </details>
      ))}
    </>
  );
}

interface SliderProps {
  label: string;
  shown?: string;
  value: number;
  low: number;
  high: number;
  text: string;
  onChange(value: number): void;
}

function Slider({ label, shown = label, value, low, high, text, onChange }: SliderProps) {
  return (
    <label class="slider with-figure">
      <span>{shown}</span>
      <input
        type="range"
        aria-label={label}
        aria-valuetext={text}
        min={low}
        max={high}
        step={(high - low) / 120}
        value={value}
        onInput={(event) => onChange(Number(event.currentTarget.value))}
      />
      <span class="figure">{text}</span>
    </label>
  );
}
