import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import * as painting from "../paint/painting";
import * as paint from "../paint/state";
import { displayName, millimetres } from "../result/format";
import { lazyPart } from "../ui/lazy";
import { busy } from "../ui/state";
import * as editing from "./editing";
import { FileButton } from "./FileButton";
import { JOINTS } from "./skeleton";
import * as state from "./state";
import { alignHandles, boxHandles } from "./tools";

const PaintPanel = lazyPart(async () => (await import("../paint/PaintPanel")).PaintPanel);

const TOOLS: [state.Tool, string][] = [
  ["joints", "Joints"],
  ["align", "Align"],
  ["cut", "Cut away"],
  ["paint", "Regions"],
];

export function EditorPanel() {
  const working = busy.value !== null;
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
      const { undo, redo } = state.tool.value === "paint" ? painting : editing;
      if (event.key.toLowerCase() === "z") void (event.shiftKey ? redo() : undo());
      else if (event.key.toLowerCase() === "y") void redo();
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", onKeyDown);
    return () => removeEventListener("keydown", onKeyDown);
  }, []);
  const { done, undone } = state.history.value;
  const painted = state.tool.value === "paint";
  const ready = done.length > 0 || (painted && paint.completeness.value.whole > 0);
  return (
    <div class="editor-panel">
      <fieldset class="buttons tabs" aria-label="Tool">
        {TOOLS.map(([tool, name]) => (
          <button
            type="button"
            key={tool}
            disabled={working}
            aria-pressed={state.tool.value === tool}
            onClick={() => void editing.open(tool)}
          >
            {name}
          </button>
        ))}
      </fieldset>
      {state.trouble.value && (
        <p class="problem" role="alert">
          {state.trouble.value}
        </p>
      )}
      {state.tool.value === "joints" && <Joints />}
      {state.tool.value === "align" && <Align />}
      {state.tool.value === "cut" && <Cut />}
      {painted && <PaintPanel />}
      {done.length > 0 && (
        <details>
          <summary>{done.length === 1 ? "1 edit" : `${done.length} edits`}</summary>
          <div class="editor-list">
            <ol>
              {done.map((edit, i) => (
                <li key={i}>{edit.label ?? edit.edit}</li>
              ))}
            </ol>
          </div>
        </details>
      )}
      <h3>Project</h3>
      <p class="quiet">Settings and edits in one file; the command line replays it with --project.</p>
      <div class="buttons">
        <button type="button" disabled={working} onClick={() => void editing.saveProject()}>
          Save project
        </button>
        <FileButton label="Open project…" onFile={(file) => void editing.openProject(file)} />
      </div>
      <div class="editor-actions">
        <div class="buttons">
          {!painted && (
            <>
              <button type="button" disabled={done.length === 0} onClick={editing.undo} title="Ctrl+Z">
                Undo
              </button>
              <button
                type="button"
                disabled={undone.length === 0}
                onClick={editing.redo}
                title="Ctrl+Shift+Z"
              >
                Redo
              </button>
            </>
          )}
          <button
            type="button"
            class="main"
            disabled={working || !ready}
            onClick={() => void editing.registerEdited()}
          >
            Register with these {painted ? "regions" : "edits"}
          </button>
          <button
            type="button"
            onClick={() => {
              editing.close();
              void editing.apply();
            }}
          >
            Done
          </button>
        </div>
      </div>
    </div>
  );
}

function Joints() {
  const joint = state.selected.value;
  const placed = state.keypoints.value?.joints[joint];
  const touched = editing.touched();
  const isLocked = state.locked.value.has(joint);
  const preview = state.preview.value;
  return (
    <>
      <p class="quiet">
        Drag a joint in any view; hold <kbd>Shift</kbd> to move it finely. Arrow keys move the chosen one.
        Ball: seen; diamond: derived from others; blue cube: placed by hand; ring: not known, drag it to use
        it. Red, yellow and green say how sure it is.
      </p>
      <div class="checks">
        <Check label="Snap to the middle of the body" signal={state.snaps} />
        <Check label="Move the whole limb" signal={state.wholeLimb} />
        <Check label="Show the posed body" signal={state.showBody} />
      </div>
      <fieldset class="joint-list" aria-label="Joints">
        {JOINTS.map((name) => (
          <button
            type="button"
            key={name}
            class={/^(left|right)_/.test(name) ? "" : "centre"}
            aria-pressed={name === joint}
            onClick={() => {
              state.selected.value = name;
            }}
          >
            {displayName(name)}
            {touched.has(name) && " ■"}
            {state.locked.value.has(name) && " (locked)"}
          </button>
        ))}
      </fieldset>
      <div class="buttons">
        <button type="button" aria-pressed={isLocked} onClick={() => editing.lock(joint)}>
          {isLocked ? "Unlock" : "Lock"}
        </button>
        <button type="button" disabled={!touched.has(joint)} onClick={() => editing.reset(joint)}>
          Reset joint
        </button>
        <button type="button" disabled={!placed} onClick={() => editing.leaveOut(joint)}>
          Leave out
        </button>
        <button type="button" disabled={touched.size === 0} onClick={() => editing.reset()}>
          Reset all
        </button>
      </div>
      <div class="buttons">
        <button type="button" onClick={() => void editing.sides("left")}>
          Left limbs → right
        </button>
        <button type="button" onClick={() => void editing.sides("right")}>
          Right limbs → left
        </button>
        <button type="button" onClick={() => void editing.sides()}>
          Swap left and right
        </button>
      </div>
      {preview && (
        <p
          class="quiet"
          data-rate={preview.rate}
          data-work-ms={preview.workMs}
          data-answer-ms={preview.answerMs}
        >
          The posed body's joints lie {millimetres(preview.errorMm)} mm from these on average.
        </p>
      )}
      <div class="buttons">
        <button type="button" onClick={editing.exportKeypoints}>
          Export keypoints
        </button>
        <FileButton label="Import keypoints…" onFile={(file) => void editing.importKeypoints(file)} />
      </div>
    </>
  );
}

const HANDLES: [state.Handle, string][] = [
  ["rotate", "Turn"],
  ["translate", "Move"],
  ["scale", "Scale"],
];

function HandleChoice() {
  return (
    <>
      <fieldset class="buttons tabs" aria-label="Handles">
        {HANDLES.map(([value, name]) => (
          <button
            type="button"
            key={value}
            aria-pressed={state.handle.value === value}
            onClick={() => {
              state.handle.value = value;
            }}
          >
            {name}
          </button>
        ))}
      </fieldset>
      <div class="checks">
        <Check label="In steps: 15°, 1 cm, 5 %" signal={state.steps} />
      </div>
    </>
  );
}

const TURNS: ["x" | "y" | "z", string][] = [
  ["y", "about up"],
  ["z", "about front"],
  ["x", "about left"],
];

function Align() {
  const turn = (axis: "x" | "y" | "z", degrees: number) => {
    const matrix = alignHandles.value?.turned(axis, (degrees * Math.PI) / 180);
    if (matrix) editing.align(matrix, `Turn ${degrees}° about ${axis}`);
  };
  return (
    <>
      <p class="quiet">
        Turn, move or scale the scan with the handles in the third view until it stands upright, faces the
        front view and has a person's size. Scaling changes the unit.
      </p>
      <HandleChoice />
      {TURNS.map(([axis, name]) => (
        <fieldset class="buttons" key={axis} aria-label={`Turn ${name}`}>
          {[-90, -15, 15, 90].map((degrees) => (
            <button
              type="button"
              key={degrees}
              aria-label={`Turn ${degrees} degrees ${name}`}
              onClick={() => turn(axis, degrees)}
            >
              {degrees > 0 ? `+${degrees}°` : `−${-degrees}°`}
            </button>
          ))}
          <span class="quiet">{name}</span>
        </fieldset>
      ))}
      <div class="buttons">
        <button
          type="button"
          disabled={!state.edited.value.body_from_scan}
          onClick={() => editing.align(null, "Align as found")}
        >
          As found
        </button>
        <button type="button" onClick={editing.exportAlignment}>
          Export alignment
        </button>
      </div>
    </>
  );
}

function Cut() {
  return (
    <>
      <p class="quiet">
        Cut a chair, a floor or another person away before registering. Lasso: draw round it in any view. Box:
        put the box round it with the handles in the third view, then cut.
      </p>
      <fieldset class="buttons tabs" aria-label="Cut with">
        {(["lasso", "box"] as const).map((value) => (
          <button
            type="button"
            key={value}
            aria-pressed={state.cutter.value === value}
            onClick={() => {
              state.cutter.value = value;
              state.handle.value = "translate";
            }}
          >
            {value === "lasso" ? "Lasso" : "Box"}
          </button>
        ))}
      </fieldset>
      <fieldset class="buttons tabs" aria-label="What is cut away">
        {(["inside", "outside"] as const).map((value) => (
          <button
            type="button"
            key={value}
            aria-pressed={state.cutSide.value === value}
            onClick={() => {
              state.cutSide.value = value;
            }}
          >
            {value === "inside" ? "What is inside" : "All that is outside"}
          </button>
        ))}
      </fieldset>
      {state.cutter.value === "box" && (
        <>
          <HandleChoice />
          <div class="buttons">
            <button
              type="button"
              onClick={() => {
                const box = boxHandles.value?.boxFromScan();
                if (box) editing.cut({ remove: state.cutSide.value, box_from_scan: box });
              }}
            >
              Cut
            </button>
          </div>
        </>
      )}
    </>
  );
}

function Check({ label, signal }: { label: ComponentChildren; signal: { value: boolean } }) {
  return (
    <label class="check">
      <input
        type="checkbox"
        checked={signal.value}
        onChange={(event) => {
          signal.value = event.currentTarget.checked;
        }}
      />
      {label}
    </label>
  );
}
