import type { Item } from "./queue";

/** Columns of the table that the command line prints after a batch, units in their names. */
const COLUMNS = ["scan", "verdict", "confidence", "mean_mm", "p95_mm", "scan_p95_mm", "seconds", "remark"];

/** A field as RFC 4180 wants it. */
function field(value: string): string {
  return /[",\r\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value;
}

function number(value: number | null, decimals: number): string {
  return value === null ? "NA" : value.toFixed(decimals);
}

function row(item: Item): string[] {
  const { outcome, error } = item;
  if (error) return [item.folder, "error", "NA", "NA", "NA", "NA", "NA", `${error.code}: ${error.message}`];
  if (!outcome) return [item.folder, "waiting", "NA", "NA", "NA", "NA", "NA", ""];
  return [
    item.folder,
    outcome.verdict.status,
    number(outcome.verdict.confidence, 4),
    number(outcome.mean_mm, 4),
    number(outcome.p95_mm, 4),
    number(outcome.scan_p95_mm, 4),
    number(outcome.seconds, 3),
    outcome.verdict.reasons.join("; "),
  ];
}

/** One row a scan, in the order of the queue; NA where there is no number. */
export function batchCsv(items: readonly Item[]): string {
  return [COLUMNS, ...items.map(row)].map((each) => `${each.map(field).join(",")}\n`).join("");
}

/** One row a measurement: the tables of single scans below each other, the scan's folder in front. */
export function measurementsCsv(tables: readonly (readonly [folder: string, csv: string])[]): string {
  const rows = tables.flatMap(([folder, csv], i) => {
    const [header, ...lines] = csv.trimEnd().split("\n");
    const named = lines.map((line) => `${field(folder)},${line}`);
    return i === 0 ? [`scan,${header}`, ...named] : named;
  });
  return rows.map((row) => `${row}\n`).join("");
}
