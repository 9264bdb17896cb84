import { effect, signal } from "@preact/signals";

export type Theme = "system" | "light" | "dark";

const KEY = "vitruvian-theme";
const dark = matchMedia("(prefers-color-scheme: dark)");
const systemIsDark = signal(dark.matches);
dark.addEventListener("change", () => {
  systemIsDark.value = dark.matches;
});

function stored(): Theme {
  try {
    const value = localStorage.getItem(KEY);
    return value === "light" || value === "dark" ? value : "system";
  } catch {
    return "system";
  }
}

export const theme = signal<Theme>(stored());
/** The theme in force; what draws outside of CSS (the 3D view) listens to it. */
export const isDark = signal(false);

effect(() => {
  isDark.value = theme.value === "system" ? systemIsDark.value : theme.value === "dark";
  document.documentElement.dataset.theme = isDark.value ? "dark" : "light";
  try {
    if (theme.value === "system") localStorage.removeItem(KEY);
    else localStorage.setItem(KEY, theme.value);
  } catch {
    // Storage may be switched off; the choice then lasts as long as the page.
  }
});
