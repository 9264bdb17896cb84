import { useEffect } from "preact/hooks";
import { FileButton } from "../editor/FileButton";
import { displayName, integer } from "../result/format";
import { busy } from "../ui/state";
import { colourOf, type Pair } from "./labels";
import * as painting from "./painting";
import * as state from "./state";
import "./paint.css";

const TOOLS: [state.Tool, string, string][] = [
  ["brush", "Brush", "b"],
  ["lasso", "Lasso", "l"],
  ["part", "Part", "p"],
  ["turn", "Turn", "t"],
];
const SEGMENTS =
  "hips left_upper_leg right_upper_leg spine left_leg right_leg spine1 left_foot right_foot spine2 left_toe_base right_toe_base neck left_shoulder right_shoulder head left_arm right_arm left_forearm right_forearm left_hand right_hand left_hand_index right_hand_index".split(
    " ",
  );
const TYPING = "select, textarea, dialog, input:not([type=radio], [type=checkbox], [type=range])";

export function PaintPanel() {
  useEffect(() => {
    const onKeyDown = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey || busy.value) return;
      if ((event.target as HTMLElement).closest(TYPING)) return;
      const tool = TOOLS.find(([, , key]) => key === event.key)?.[0];
      if (tool) state.tool.value = tool;
      else if (event.key === "e") state.erasing.value = !state.erasing.value;
      else if (event.key === "[") state.radius.value = Math.max(state.radius.value - 3, state.SMALLEST);
      else if (event.key === "]") state.radius.value = Math.min(state.radius.value + 3, state.LARGEST);
      else if (event.key === ",") painting.choose(-1);
      else if (event.key === ".") painting.choose(1);
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", onKeyDown);
    return () => removeEventListener("keydown", onKeyDown);
  }, []);
  const working = busy.value !== null;
  const { whole, lacking } = state.completeness.value;
  return (
    <>
      <p class="quiet">
        Paint what belongs together in one colour on the scan and on the body: it is matched with each other
        only. Nothing is painted through the body. Drag with the right button or two fingers to turn.
      </p>
      {state.trouble.value && (
        <p class="problem" role="alert">
          {state.trouble.value}
        </p>
      )}
      <fieldset class="buttons tabs" aria-label="Paint with">
        {TOOLS.map(([tool, name, key]) => (
          <button
            type="button"
            key={tool}
            title={key.toUpperCase()}
            aria-pressed={state.tool.value === tool}
            onClick={() => {
              state.tool.value = tool;
            }}
          >
            {name}
          </button>
        ))}
        <button
          type="button"
          title="E; or hold Shift while painting"
          aria-pressed={state.erasing.value}
          onClick={() => {
            state.erasing.value = !state.erasing.value;
          }}
        >
          Erase
        </button>
      </fieldset>
      {state.tool.value === "brush" && (
        <label class="brush-size" title="Wheel over a view; [ and ]">
          Size
          <input
            type="range"
            min={state.SMALLEST}
            max={state.LARGEST}
            value={state.radius.value}
            onInput={(event) => {
              state.radius.value = Number(event.currentTarget.value);
            }}
          />
          <span class="figure">{state.radius.value} px</span>
        </label>
      )}
      {state.tool.value === "part" && (
        <p class="quiet">Click a part of the body: all of it is painted, hidden sides too.</p>
      )}
      <Regions />
      <div class="buttons">
        <button type="button" disabled={working} onClick={() => painting.addPair()}>
          Add region
        </button>
        <button
          type="button"
          disabled={state.done.value.length === 0}
          title="Ctrl+Z"
          onClick={() => void painting.undo()}
        >
          Undo
        </button>
        <button
          type="button"
          disabled={state.undone.value.length === 0}
          title="Ctrl+Shift+Z"
          onClick={() => void painting.redo()}
        >
          Redo
        </button>
      </div>
      {lacking.length > 0 && (
        <p class="note">
          {whole === 0 ? "No region" : whole === 1 ? "One region" : `${whole} regions`} painted on both sides;{" "}
          {lacking.map(({ name }) => name).join(", ")} will be left out.
        </p>
      )}
      <Suggestions disabled={working} />
      <div class="checks">
        <label class="check">
          <input
            type="checkbox"
            checked={state.stance.value === "rest"}
            disabled={working}
            onChange={(event) => void painting.setStance(event.currentTarget.checked ? "rest" : "posed")}
          />
          Body with its limbs spread
        </label>
        <label class="check">
          <input
            type="checkbox"
            checked={state.together.value}
            onChange={(event) => {
              state.together.value = event.currentTarget.checked;
            }}
          />
          Turn both views together
        </label>
      </div>
      <div class="buttons">
        <button type="button" disabled={whole === 0} onClick={painting.exportFile}>
          Export regions
        </button>
        <FileButton label="Import regions…" onFile={(file) => void painting.importFile(file)} />
      </div>
    </>
  );
}

function Regions() {
  const { pairs, selected } = state;
  const chosen = pairs.value.find(({ id }) => id === selected.value);
  if (pairs.value.length === 0) return <p class="quiet">No region yet: painting makes the first one.</p>;
  return (
    <>
      <ul class="region-list" aria-label="Regions">
        {pairs.value.map((pair) => (
          <Region key={pair.id} pair={pair} />
        ))}
      </ul>
      {chosen && (
        <div class="region-name">
          <label for="region-name">Name</label>
          <input
            id="region-name"
            type="text"
            maxLength={80}
            value={chosen.name}
            onChange={(event) => painting.rename(chosen.id, event.currentTarget.value.trim())}
          />
          <button
            type="button"
            aria-label={`Remove ${chosen.name}`}
            onClick={() => painting.remove(chosen.id)}
          >
            Remove
          </button>
        </div>
      )}
    </>
  );
}

function Region({ pair: { id, name } }: { pair: Pair }) {
  const { scan, template } = state.painted.value.get(id) ?? { scan: 0, template: 0 };
  const count = (title: string, vertices: number) => (
    <span class={vertices > 0 ? "count" : "count missing"}>
      {title} {vertices > 0 ? integer(vertices) : "missing"}
    </span>
  );
  return (
    <li>
      <button
        type="button"
        class="choose"
        aria-pressed={id === state.selected.value}
        onClick={() => {
          state.selected.value = id;
        }}
      >
        <span class="swatch" style={{ background: colourOf(id) }} aria-hidden="true" />
        {name}
        {count("scan", scan)}
        {count("body", template)}
      </button>
    </li>
  );
}

function Suggestions({ disabled }: { disabled: boolean }) {
  return (
    <div class="buttons">
      <button
        type="button"
        disabled={disabled}
        title="A region for each of the body's 24 parts, of what is not painted yet"
        onClick={() => void painting.suggest()}
      >
        Suggest all 24 parts
      </button>
      <select
        aria-label="Suggest one part"
        disabled={disabled}
        value=""
        onChange={(event) => {
          const segment = event.currentTarget.value;
          event.currentTarget.value = "";
          if (segment) void painting.suggest(segment);
        }}
      >
        <option value="">One part…</option>
        {SEGMENTS.map((segment) => (
          <option key={segment} value={segment}>
            {displayName(segment)}
          </option>
        ))}
      </select>
    </div>
  );
}
