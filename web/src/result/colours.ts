// The error colours: viridis (perceptually even, safe for colour-blind eyes), sRGB 0..1.
const ANCHORS: readonly (readonly [number, number, number])[] = [
  [0.267, 0.0049, 0.3294],
  [0.2826, 0.1409, 0.4575],
  [0.2539, 0.2653, 0.53],
  [0.2068, 0.3718, 0.5531],
  [0.1636, 0.4711, 0.5581],
  [0.1276, 0.5669, 0.5506],
  [0.1347, 0.6586, 0.5176],
  [0.2669, 0.7488, 0.4406],
  [0.4775, 0.8214, 0.3182],
  [0.7414, 0.8734, 0.1496],
  [0.9932, 0.9062, 0.1439],
];

/** Colour of `t` in 0..1; values outside are clamped, NaN is the low end. */
export function viridis(t: number): [number, number, number] {
  const x = Math.min(Math.max(t || 0, 0), 1) * (ANCHORS.length - 1);
  const i = Math.min(Math.floor(x), ANCHORS.length - 2);
  const [a, b] = [ANCHORS[i]!, ANCHORS[i + 1]!];
  const f = x - i;
  return [a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2])];
}

export function toCss([r, g, b]: readonly [number, number, number]): string {
  return `rgb(${Math.round(r * 255)} ${Math.round(g * 255)} ${Math.round(b * 255)})`;
}

/** Colour of a keypoint's confidence 0..1: the same scale, so that one legend reads for both. */
export function confidenceColour(confidence: number): string {
  return toCss(viridis(0.25 + 0.75 * confidence));
}

/** A round upper end of the scale, in mm, that leaves at most 2 % of the values above it. */
export function legendMaximum(valuesMm: Float32Array): number {
  if (valuesMm.length === 0) return 10;
  const sorted = Float32Array.from(valuesMm).sort();
  const high = sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * 0.98))]!;
  for (const round of [1, 2, 5, 10, 20, 50, 100, 200, 500]) if (high <= round) return round;
  return 1000;
}
