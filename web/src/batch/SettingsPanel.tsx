import type { Axis, Gender, Settings, Unit } from "../core/types";
import { Choice } from "../ui/Choice";
import * as queue from "./queue";
import { keeping, keepingFailed, keptCount, setKeeping } from "./store";

const BODIES: [Gender, string][] = [
  ["neutral", "Neutral"],
  ["female", "Female"],
  ["male", "Male"],
];
const METHODS: [Settings["method"], string][] = [
  ["ours", "Fast"],
  ["paper", "As published"],
  ["paper-cpu", "As published, CPU"],
];
const DETAIL: [Settings["detail"], string][] = [
  ["off", "Body model only"],
  ["vertex", "Per vertex"],
];
const UNITS: [Unit | "auto", string][] = [
  ["auto", "Auto"],
  ["m", "m"],
  ["cm", "cm"],
  ["mm", "mm"],
  ["in", "inch"],
];
const UP: [Axis | "auto", string][] = [
  ["auto", "Auto"],
  ["y", "+Y"],
  ["z", "+Z"],
  ["x", "+X"],
  ["-y", "−Y"],
  ["-z", "−Z"],
  ["-x", "−X"],
];

/** What holds for the whole batch. */
export function SettingsPanel() {
  const start = queue.itemOf(queue.startFrom.value);
  return (
    <aside aria-label="Settings for all scans">
      <h2>Settings for all scans</h2>
      <SettingsChoices
        settings={queue.settingsForAll.value}
        onChange={(settings) => {
          queue.settingsForAll.value = settings;
        }}
      />
      <p class="quiet">They count for scans that are still to do. Choose a scan to give it its own.</p>
      <h3>Start</h3>
      {start ? (
        <p>
          Every other scan starts from the body of <strong>{start.folder}</strong>.{" "}
          <button
            type="button"
            onClick={() => {
              queue.startFrom.value = null;
            }}
          >
            Find each by itself
          </button>
        </p>
      ) : (
        <p class="quiet">
          Each scan is found by itself. When one person was scanned many times in one pose, open a registered
          scan’s details to start the others from it.
        </p>
      )}
      <h3>Keep results</h3>
      <label class="check">
        <input
          type="checkbox"
          checked={keeping.value}
          onChange={(event) => void setKeeping(event.currentTarget.checked)}
        />
        Keep results in this browser when the page is closed
      </label>
      <p class="quiet">
        {keeping.value && keptCount.value > 0 && `${keptCount.value} kept. `}
        On this computer only, without the scans themselves. Switching it off deletes what was kept.
      </p>
      {keepingFailed.value && (
        <p class="problem" role="alert">
          {keepingFailed.value}
        </p>
      )}
    </aside>
  );
}

interface ChoicesProps {
  settings: Settings;
  disabled?: boolean;
  onChange(settings: Settings): void;
}

export function SettingsChoices({ settings, disabled = false, onChange }: ChoicesProps) {
  const set = (change: Partial<Settings>) => onChange({ ...settings, ...change });
  return (
    <>
      <Choice
        label="Method"
        value={settings.method}
        options={METHODS}
        disabled={disabled}
        onChange={(method) => set({ method })}
      />
      <Choice
        label="Body model"
        value={settings.gender}
        options={BODIES}
        disabled={disabled}
        onChange={(gender) => set({ gender })}
      />
      <Choice
        label="Detail"
        value={settings.detail}
        options={DETAIL}
        disabled={disabled}
        onChange={(detail) => set({ detail })}
      />
      <Choice
        label="Unit"
        value={settings.units}
        options={UNITS}
        disabled={disabled}
        onChange={(units) => set({ units })}
      />
      <Choice
        label="Up"
        value={settings.up}
        options={UP}
        disabled={disabled}
        onChange={(up) => set({ up })}
      />
    </>
  );
}
