import { MODES, mode } from "./mode";
import * as state from "./state";
import { type Theme, theme } from "./theme";

export function Header() {
  return (
    <header>
      <img src="./icon.svg" alt="" width={28} height={28} />
      <h1>Vitruvian</h1>
      <fieldset class="modes" aria-label="What to do">
        {MODES.map(([value, name, what]) => (
          <button
            type="button"
            key={value}
            title={what}
            aria-pressed={mode.value === value}
            onClick={() => {
              mode.value = value;
            }}
          >
            {name}
          </button>
        ))}
      </fieldset>
      <p class="claim">Your scan never leaves this computer.</p>
      <label class="theme">
        <span class="unseen">Theme</span>
        <select
          value={theme.value}
          onChange={(event) => {
            theme.value = event.currentTarget.value as Theme;
          }}
        >
          <option value="system">System theme</option>
          <option value="light">Light</option>
          <option value="dark">Dark</option>
        </select>
      </label>
      <button
        type="button"
        onClick={() => {
          state.helpOpen.value = true;
        }}
      >
        Keys
      </button>
      <button
        type="button"
        onClick={() => {
          state.aboutOpen.value = true;
        }}
      >
        About
      </button>
    </header>
  );
}
