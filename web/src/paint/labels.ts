// Who paints what: a label for each vertex of scan and template (0: none, else a pair's id), changed by strokes that can
// be undone.
import type { RegionSet } from "../core/edits";
import type { Side } from "./requests";

/** A region of the scan and the one of the template that belongs to it. */
export interface Pair {
  /** 1 or more; its label */
  readonly id: number;
  readonly name: string;
}

export type Labels = Readonly<Record<Side, Uint16Array>>;

/** What one command does to the labels of a side; vertices are told apart. */
export interface Change {
  readonly side: Side;
  readonly vertices: Uint32Array;
  readonly before: Uint16Array;
  readonly after: Uint16Array;
}

/** A step of undo. */
export interface Command {
  readonly label: string;
  readonly pairs?: { readonly before: readonly Pair[]; readonly after: readonly Pair[] };
  readonly changes: readonly Change[];
}

export const SIDES: readonly Side[] = ["scan", "template"];
export const MOST_PAIRS = 65_535;

/** Distinct also to colour-blind eyes (Okabe and Ito), then by the golden angle. */
const COLOURS = ["#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e6b400", "#56b4e9", "#7a4fbf", "#8c564b"];

/** Hexadecimal colour of a pair. */
export function colourOf(id: number): string {
  const known = COLOURS[id - 1];
  if (known) return known;
  const hue = (id * 137.508) % 360;
  const channel = (n: number) => {
    const k = (n + hue / 30) % 12;
    const value = 0.48 - 0.3 * Math.max(-1, Math.min(k - 3, 9 - k, 1));
    return Math.round(255 * value)
      .toString(16)
      .padStart(2, "0");
  };
  return `#${channel(0)}${channel(8)}${channel(4)}`;
}

export function emptyLabels(scan: number, template: number): Labels {
  return { scan: new Uint16Array(scan), template: new Uint16Array(template) };
}

export function redo(labels: Labels, { changes }: Command): void {
  for (const { side, vertices, after } of changes) set(labels[side], vertices, after);
}

export function undo(labels: Labels, { changes }: Command): void {
  for (const { side, vertices, before } of [...changes].reverse()) set(labels[side], vertices, before);
}

function set(labels: Uint16Array, vertices: Uint32Array, values: Uint16Array): void {
  for (let i = 0; i < vertices.length; ++i) labels[vertices[i]!] = values[i]!;
}

/** Sets labels at once and remembers what was there before. */
export class Brushwork {
  private readonly vertices: number[] = [];
  private readonly before: number[] = [];

  constructor(
    private readonly labels: Labels,
    readonly side: Side,
  ) {}

  /** Vertices that have the label already, or that there are not, are left alone. */
  paint(vertices: ArrayLike<number>, label: number): void {
    const labels = this.labels[this.side];
    for (let i = 0; i < vertices.length; ++i) {
      const vertex = vertices[i]!;
      const old = labels[vertex];
      if (old === undefined || old === label) continue;
      this.vertices.push(vertex);
      this.before.push(old);
      labels[vertex] = label;
    }
  }

  /** What was done, or null when nothing was. A vertex that was painted twice counts once. */
  change(): Change | null {
    const labels = this.labels[this.side];
    const seen = new Uint8Array(labels.length);
    const first = this.vertices.flatMap((vertex, i) => {
      if (seen[vertex]) return [];
      seen[vertex] = 1;
      return [i];
    });
    if (first.length === 0) return null;
    const vertices = Uint32Array.from(first, (i) => this.vertices[i]!);
    return {
      side: this.side,
      vertices,
      before: Uint16Array.from(first, (i) => this.before[i]!),
      after: Uint16Array.from(vertices, (vertex) => labels[vertex]!),
    };
  }

  /** As if nothing had been done. */
  abandon(): void {
    for (let i = this.vertices.length - 1; i >= 0; --i)
      this.labels[this.side][this.vertices[i]!] = this.before[i]!;
  }
}

/** Number of vertices of each pair. */
export function counts(labels: Labels): ReadonlyMap<number, Record<Side, number>> {
  const found = new Map<number, Record<Side, number>>();
  for (const side of SIDES)
    for (const label of labels[side]) {
      if (label === 0) continue;
      let count = found.get(label);
      if (!count) {
        count = { scan: 0, template: 0 };
        found.set(label, count);
      }
      count[side] += 1;
    }
  return found;
}

/** Vertices of a pair on a side, ascending. */
export function verticesOf(labels: Labels, side: Side, id: number): number[] {
  const found: number[] = [];
  labels[side].forEach((label, vertex) => {
    if (label === id) found.push(vertex);
  });
  return found;
}

/** The pairs that are painted on both sides; null when there are none. */
export function regionsOf(
  pairs: readonly Pair[],
  labels: Labels,
  hashes: Pick<RegionSet, "scan_sha256" | "model_sha256">,
): RegionSet | null {
  const painted = new Map(
    pairs.map(({ id, name }) => [
      id,
      { name, scan_vertices: [] as number[], template_vertices: [] as number[] },
    ]),
  );
  labels.scan.forEach((id, vertex) => void (id > 0 && painted.get(id)?.scan_vertices.push(vertex)));
  labels.template.forEach((id, vertex) => void (id > 0 && painted.get(id)?.template_vertices.push(vertex)));
  const whole = [...painted.values()].filter(
    ({ scan_vertices, template_vertices }) => scan_vertices.length > 0 && template_vertices.length > 0,
  );
  return whole.length > 0 ? { ...hashes, pairs: whole } : null;
}

/** The command that puts other pairs and their regions in place of all that is painted. Changes the labels. */
export function replaced(
  before: readonly Pair[],
  labels: Labels,
  { pairs: given }: Pick<RegionSet, "pairs">,
  label: string,
): Command {
  const after = given.map(({ name }, i) => ({ id: i + 1, name }));
  const changes = SIDES.flatMap((side) => {
    const work = new Brushwork(labels, side);
    const old = [...labels[side].keys()].filter((vertex) => labels[side][vertex] !== 0);
    work.paint(old, 0);
    for (const [i, pair] of given.entries())
      work.paint(side === "scan" ? pair.scan_vertices : pair.template_vertices, i + 1);
    return work.change() ?? [];
  });
  return { label, pairs: { before, after }, changes };
}

/**
 * The command that adds a pair for each of some segments, of what is not painted yet. Changes the labels.
 * @param segments of each vertex, an index into `names`
 */
export function suggested(
  before: readonly Pair[],
  labels: Labels,
  segments: Readonly<Record<Side, Uint8Array>>,
  names: readonly string[],
  wanted: readonly number[],
  label: string,
): Command {
  const first = nextId(before);
  const ids = new Map(wanted.map((segment, i) => [segment, first + i]));
  const changes = SIDES.flatMap((side) => {
    const work = new Brushwork(labels, side);
    for (const [segment, id] of ids) {
      const own: number[] = [];
      segments[side].forEach((each, vertex) => {
        if (each === segment && labels[side][vertex] === 0) own.push(vertex);
      });
      work.paint(own, id);
    }
    return work.change() ?? [];
  });
  const added = wanted.map((segment) => ({
    id: ids.get(segment)!,
    name: names[segment] ?? `Part ${segment}`,
  }));
  return { label, pairs: { before, after: [...before, ...added] }, changes };
}

export function nextId(pairs: readonly Pair[]): number {
  return Math.max(0, ...pairs.map(({ id }) => id)) + 1;
}
