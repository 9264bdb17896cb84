import { setView, type ViewOptions, view } from "./state";

type Switch = { [K in keyof ViewOptions]: ViewOptions[K] extends boolean ? K : never }[keyof ViewOptions];

const SWITCHES: [Switch, string][] = [
  ["showScan", "Scan"],
  ["showBody", "Body"],
  ["heatMap", "Error colours"],
  ["wireframe", "Wireframe"],
  ["split", "Split view"],
];

/** What the 3D view shows of the result. */
export function ViewControls() {
  const options = view.value;
  return (
    <section class="view-controls" aria-label="View options">
      <div class="checks">
        {SWITCHES.map(([key, text]) => (
          <label class="check" key={key}>
            <input
              type="checkbox"
              checked={options[key]}
              onChange={(event) => setView({ [key]: event.currentTarget.checked })}
            />
            {text}
          </label>
        ))}
      </div>
      <Opacity label="Scan opacity" of="scanOpacity" />
      <Opacity label="Body opacity" of="bodyOpacity" />
    </section>
  );
}

function Opacity({ label, of }: { label: string; of: "scanOpacity" | "bodyOpacity" }) {
  return (
    <label class="slider">
      {label}
      <input
        type="range"
        min={0.1}
        max={1}
        step={0.05}
        value={view.value[of]}
        onInput={(event) => setView({ [of]: Number(event.currentTarget.value) })}
      />
    </label>
  );
}
