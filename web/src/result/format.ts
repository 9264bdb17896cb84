// Numbers and names as the page shows them.

/** "left_upper_leg" -> "Left upper leg" */
export function displayName(name: string): string {
  const words = name.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export function millimetres(value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  return value.toFixed(value < 10 ? 2 : 1);
}

export function metres(value: number): string {
  return `${value.toFixed(2)} m`;
}

export function seconds(milliseconds: number): string {
  return `${(milliseconds / 1000).toFixed(milliseconds < 9950 ? 1 : 0)} s`;
}

export function percent(share: number): string {
  return `${Math.round(share * 100)} %`;
}

export function bytes(count: number): string {
  if (count < 1000) return `${count} B`;
  if (count < 1e6) return `${(count / 1e3).toFixed(0)} kB`;
  return `${(count / 1e6).toFixed(1)} MB`;
}

/** 1234567 -> "1,234,567" */
export function integer(value: number): string {
  // The browser's own formatting takes longer at its first call than all else that opening a scan asks of the page.
  return value.toFixed(0).replace(/\B(?=(\d{3})+$)/g, ",");
}
