import type { Axis, Gender, Settings, Unit } from "../core/types";
import { Choice } from "../ui/Choice";
import * as queue from "./queue";
import { keeping, keepingFailed, setKeeping } from "./store";

const BODIES: [Gender, string][] = [
  ["neutral", "Neutral"],
  ["female", "Female"],
  ["male", "Male"],
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
